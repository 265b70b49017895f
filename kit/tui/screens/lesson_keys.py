"""The keys of a lesson in words: the line at the bottom names those that work now."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from kit.tui.rows.key_rows import key_line, key_page
from kit.tui.widgets.text_rows import Row


@dataclass(frozen=True, slots=True)
class Possible:
    """What can be done at this instant."""

    choose: int = 0
    """Among so many options."""
    drive_scene: bool = False
    again: bool = False
    open: bool = False
    check: bool = False
    drive: bool = False
    hint: bool = False
    worst: bool = False
    printed: bool = False
    solution: bool = False
    begin_again: bool = False
    questions: bool = False
    next: bool = True
    back: bool = True


def keys(now: Possible, width: int) -> Row:
    """One row; where it is too long, what the help page says too is left out."""
    shown = [
        (f"1-{now.choose}", "foresee", bool(now.choose)),
        ("←↑↓→", "drive", now.drive_scene),
        ("d", "drive", now.drive),
        ("r", "check", now.check),
        ("h", "hint", now.hint),
        ("w", "worst run", now.worst),
        ("s", "solution", now.solution),
        ("p", "printed", now.printed),
        ("o", "open", now.open),
        ("k", "questions", now.questions),
        ("n", "on", now.next),
        ("b", "back", now.back),
        ("a", "again", now.again),
        ("x", "anew", now.begin_again),
        ("?", "help", True),
        ("Esc", "leave", True),
    ]
    fitting = [(key, text) for key, text, works in shown if works]
    while sum(len(key) + len(text) + 2 for key, text in fitting) > max(width, 40):
        least = next((key for key in DISPENSABLE if key in dict(fitting)), None)
        if least is None:
            break
        fitting = [(key, text) for key, text in fitting if key != least]
    return key_line(*fitting)


DISPENSABLE: Final = ("x", "a", "p", "o", "w", "s", "b")
ASK_BEGIN_AGAIN: Final = key_line(("y", "begin this exercise anew; what you have is kept"), ("n", "no"))
CHECKING_KEYS: Final = key_line(("n", "on"), ("b", "back"), ("Esc", "leave; each ends the check"))

LESSON_HELP: Final = key_page(
    (
        ("n  Enter", "on to the next step; nothing goes on by itself"),
        ("b", "back one step"),
        ("l", "all steps, to go to any"),
        ("up  down", "scroll the words, where there are more"),
        ("1  2  3  4", "foresee: the first choice is kept"),
        ("a", "the scene again, from its first instant"),
        ("arrows", "drive, in a scene that waits for you"),
        ("o", "open what a command opens, here"),
    ),
    (
        ("r", "check the exercise; saving the file does the same"),
        ("h", "a hint for what was lost first; three steps"),
        ("w", "what went wrong, as a moving picture or a still one"),
        ("p", "what your program printed"),
        ("d", "drive, where the exercise is a drive"),
        ("s", "one way to do it, once you have done it"),
        ("x", "begin the exercise anew; what you have is kept"),
    ),
    (("Esc  q", "leave; you come back to this step"),),
)
