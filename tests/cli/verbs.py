"""``kit`` as a user types it, in this process."""

from __future__ import annotations

from click.testing import CliRunner, Result

from kit.cli import main


def kit(*arguments: object, code: int = 0) -> Result:
    """The verb's result, which must have this exit code and no traceback."""
    result = CliRunner().invoke(main, [str(each) for each in arguments], env={"COLUMNS": "80", "LINES": "24"})
    assert result.exit_code == code, result.output
    assert "Traceback" not in result.output
    return result
