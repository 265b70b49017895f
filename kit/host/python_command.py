"""The command that starts one of the kit's own modules in another Python process."""

from __future__ import annotations

import sys


def python_command(module: str, *arguments: str) -> list[str]:
    """Returns the command that runs ``module`` with this interpreter, as ``python -m`` does, but never with the current folder on
    the path: a student's ``queue.py`` that lies there would be imported in place of Python's.

    >>> python_command("kit", "run", "maze")[1:]
    ['-P', '-m', 'kit', 'run', 'maze']
    """
    return [sys.executable, "-P", "-m", module, *arguments]
