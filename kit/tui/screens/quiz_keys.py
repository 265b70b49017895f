"""The keys of the quiz in words, and how to read it."""

from __future__ import annotations

from typing import Final

from kit.tui.rows.key_rows import key_line, key_page

ASK_KEYS: Final = key_line(
    ("1 2 3", "choose"),
    ("0", "not sure"),
    ("s", "leave blank"),
    ("?", "help"),
    ("Esc", "leave, go on later"),
)
SURE_KEYS: Final = key_line(
    ("1 2 3 4", "how sure"),
    ("left", "another answer"),
    ("?", "help"),
    ("Esc", "leave, go on later"),
)
TOLD_KEYS: Final = key_line(("n", "next"), ("?", "help"), ("Esc", "leave, go on later"))
LAST_KEYS: Final = key_line(("n", "how it came out"), ("?", "help"), ("Esc", "leave"))
OVER_KEYS: Final = key_line(("Esc", "leave"))

QUIZ_HELP: Final = key_page(
    (
        ("1  2  3", "choose an answer, then say how sure you are: 1 to 4"),
        ("0", "I am not sure: counted by itself, not as wrong"),
        ("s  s", "leave the question blank"),
        ("left", "before you said how sure: another answer"),
        ("n  Enter", "the next question"),
        ("up  down", "scroll, where the window is small"),
        ("Esc  q", "leave; the same command goes on where you left"),
    ),
    (
        (">", "your choice"),
        ("+", "the right answer"),
        ("x", "your choice, where it is not right"),
    ),
    (
        ("what is kept", "every answer, once you have said how sure you are"),
        ("what comes back", "topics, after 1, 3, 7 and 21 days: kit quiz --today"),
    ),
)
