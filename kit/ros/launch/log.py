"""Loggers of a launch file, ``launch.logging``: their lines go where those of the launch itself go."""

from __future__ import annotations

import logging
import sys

_NAME = "launch"


def get_logger(name: str | None = None) -> logging.Logger:
    """Returns the logger of a name below that of the launch; it prints ``[INFO] [name]: text``."""
    root = logging.getLogger(_NAME)
    if not root.handlers:
        handler = logging.StreamHandler(sys.stdout)
        handler.setFormatter(logging.Formatter("[%(levelname)s] [%(name)s]: %(message)s"))
        root.addHandler(handler)
        root.setLevel(logging.INFO)
        root.propagate = False
    return root if name in (None, _NAME) else root.getChild(str(name).removeprefix(f"{_NAME}."))
