"""``python -m kit`` is ``kit``."""

from kit.cli import run

run()
