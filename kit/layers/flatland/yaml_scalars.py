"""Texts as YAML scalars and lists in one line."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Final

COMPUTED: Final = re.compile(r"\s*(\$|env\s*\(|param\s*\()")
_PLAIN: Final = re.compile(r"[A-Za-z_][\w./+-]*(?<![.])", re.ASCII)
_RESERVED_WORDS: Final = frozenset(["y", "n", "yes", "no", "on", "off", "true", "false", "null"])
_ESCAPES: Final[Mapping[str, str]] = {'"': '\\"', "\\": "\\\\"}


def format_scalar(text: str) -> str:
    """A YAML scalar that every reader takes for this text."""
    if _PLAIN.fullmatch(text) and text.lower() not in _RESERVED_WORDS:
        return text
    return (
        '"' + "".join(_ESCAPES.get(c) or (c if c.isprintable() else f"\\U{ord(c):08x}") for c in text) + '"'
    )


def format_flow_list(names: Iterable[str]) -> str:
    """``[a, b]``"""
    return f"[{', '.join(format_scalar(name) for name in names)}]"
