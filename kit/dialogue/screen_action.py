"""The actions that keys of a screen have."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ScreenAction:
    """An action that a key of a screen has."""

    id: str
    keys: str
    """Keys as the help page and the table print them."""
    label: str
    """Its word in the line at the bottom, and in the line mode."""
    help: str
    """What it does, in at most 52 characters, so that the help page fits into 74 columns."""
    bindings: tuple[tuple[str, str], ...] = ()
    """Textual's names of keys, comma-separated, and the Textual action they call. Empty: a widget reads the keys itself."""
    short: str = ""
    """The keys in the line at the bottom, where that is not the first of ``keys``."""
    has_priority: bool = False
    """Whether it comes before the focused widget."""

    @property
    def key_names(self) -> set[str]:
        """Textual's names of its keys."""
        return {key for keys, _ in self.bindings for key in keys.split(",")}

    @property
    def footer_keys(self) -> str:
        return self.short or self.keys.split()[0]


def digits(action: str, first: int, last: int) -> tuple[tuple[str, str], ...]:
    return tuple((str(number), f"{action}({number})") for number in range(first, last + 1))


def letter(
    id_: str, key: str, label: str, text: str, *, name: str = "", short: str = "", has_priority: bool = False
) -> ScreenAction:
    """An action of one key that calls the Textual action of its own name. ``name``: Textual's name of the key."""
    return ScreenAction(id_, key, label, text, ((name or key, id_),), short, has_priority)
