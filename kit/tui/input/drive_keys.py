"""The keys that drive, as one table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final


@dataclass(frozen=True, slots=True)
class DriveKey:
    """One row: the message name, the keys that send it, how a help screen calls them, and where it pushes."""

    name: str
    keys: tuple[str, ...]
    """Textual's key names."""
    label: str
    linear: int = 0
    """+1 forward, -1 backward."""
    angular: int = 0
    """+1 left (counter-clockwise), -1 right."""

    @property
    def pressed(self) -> str:
        """The message that says it went down."""
        return f"p_{self.name}"

    @property
    def released(self) -> str:
        return f"r_{self.name}"

    @property
    def moves(self) -> bool:
        return bool(self.linear or self.angular)

    def opposes(self, other: DriveKey) -> bool:
        """Whether the two push against each other."""
        return self.linear * other.linear + self.angular * other.angular < 0


DRIVE_KEYS: Final = (
    DriveKey("up", ("up", "w"), "Up or W", linear=1),
    DriveKey("down", ("down", "s"), "Down or S", linear=-1),
    DriveKey("left", ("left", "a"), "Left or A", angular=1),
    DriveKey("right", ("right", "d"), "Right or D", angular=-1),
    DriveKey("q", ("q",), "Q"),
    DriveKey("e", ("e",), "E"),
    DriveKey("f", ("f",), "F"),
    DriveKey("space", ("space",), "Space"),
    DriveKey("shift_l", ("left_shift",), "Left Shift"),
    DriveKey("shift_r", ("right_shift",), "Right Shift"),
    DriveKey("ctrl_l", ("left_control",), "Left Ctrl"),
    DriveKey("ctrl_r", ("right_control",), "Right Ctrl"),
    DriveKey("esc", ("escape",), "Esc"),
)
"""Every key that drives. No terminal needs to be able to send the lone Shift and Ctrl: only some do."""

_BY_KEY: Final[Mapping[str, DriveKey]] = MappingProxyType(
    {key: row for row in DRIVE_KEYS for key in row.keys}
)
_BY_NAME: Final[Mapping[str, DriveKey]] = MappingProxyType({row.name: row for row in DRIVE_KEYS})


def base_key(key: str) -> str:
    """The key under a chord: ``shift+up`` is ``up``, ``W`` is ``w``. A release may carry other modifiers."""
    bare = key.rpartition("+")[2]
    return bare.lower() if len(bare) == 1 else bare


def drive_key(key: str) -> DriveKey | None:
    """The row for a key as Textual names it, alone or with Shift or Ctrl, which drive too; None if it has none."""
    *modifiers, _ = key.split("+")
    return _BY_KEY.get(base_key(key)) if {"shift", "ctrl"}.issuperset(modifiers) else None


def named(name: str) -> DriveKey:
    """The row for a message name. KeyError if there is none."""
    return _BY_NAME[name]
