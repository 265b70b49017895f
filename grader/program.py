"""Where the installed ``grader`` begins: not in ``__main__``, over which another package of the same name writes its own."""

from __future__ import annotations

from importlib import import_module
from typing import NoReturn

from kit.cli.process import refuse_if_written_over


def run() -> NoReturn:
    """Runs ``grader`` as this process, unless its files are another package's."""
    refuse_if_written_over("grader")
    raise SystemExit(import_module("grader.__main__").run())
