"""``kit`` as a user types it, in this process."""

from __future__ import annotations

import click
from click.testing import CliRunner, Result

from kit.cli import main


def kit(*arguments: object, code: int = 0) -> Result:
    """The verb's result, which must have this exit code and no traceback."""
    return run_main(main, *arguments, code=code)


def run_main(command: click.Command, *arguments: object, code: int = 0) -> Result:
    """Likewise, of the command line of the kit or the grader."""
    words = [str(each) for each in arguments]
    result = CliRunner().invoke(command, words, env={"COLUMNS": "80", "LINES": "24"})
    assert result.exit_code == code, result.output
    assert "Traceback" not in result.output
    return result
