"""The table of all keys: the screens' bindings, lines of keys and help pages come from what each screen declares.

``python tests/tui/test_actions.py`` writes the shared actions into ``.github/CONTRIBUTING.md``, and prints all.
"""

from __future__ import annotations

import pkgutil
import re
from collections import defaultdict
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
from rich.cells import cell_len
from textual.screen import Screen

import kit.school
import kit.tui.screens
from kit.dialogue.actions import ScreenActions
from kit.dialogue.dialogue import Dialogue
from kit.dialogue.screen_action import ScreenAction
from kit.dialogue.shared_actions import ACTIONS, SHARED_IDS
from kit.school.lessons.lesson_dialogue import LessonDialogue
from kit.tui.rows.key_rows import footer, help_page
from kit.tui.screens.dialogs import WIDTH
from kit.tui.screens.dialogue import screen_actions_of
from tests.cases import every_case
from tests.tui.lesson_stage import row_text

CONTRIBUTING = Path(__file__).parents[2] / ".github/CONTRIBUTING.md"
HEAD = "| Keys | Action | What it does |"
SAY_THEIR_KEYS = ("HelpDialog", "MessageDialog", "NameDialog")
"""Dialogs that say on themselves what their keys do."""


def screen_classes() -> Iterator[type[Screen[Any]]]:
    """Every screen of the package."""
    for module in pkgutil.iter_modules(kit.tui.screens.__path__, f"{kit.tui.screens.__name__}."):
        for kind in vars(import_module(module.name)).values():
            if isinstance(kind, type) and issubclass(kind, Screen) and kind.__module__ == module.name:
                yield kind


SCREENS: dict[str, ScreenActions] = {}
"""The table of all keys: what each screen declares, by the screen's name."""
CLASSES: dict[str, list[type[Screen[Any]]]] = defaultdict(list)
for _kind in screen_classes():
    if hasattr(_kind, "screen_actions"):
        SCREENS[_kind.screen_actions.name] = _kind.screen_actions
        CLASSES[_kind.screen_actions.name].append(_kind)
DIALOGUES: dict[str, type[Dialogue]] = {}
"""Those that are asked on a screen, by name."""
for _module in pkgutil.walk_packages(kit.school.__path__, f"{kit.school.__name__}."):
    if _module.name.endswith("_dialogue"):
        for _dialogue in vars(import_module(_module.name)).values():
            if isinstance(_dialogue, type) and issubclass(_dialogue, Dialogue) and _dialogue is not Dialogue:
                DIALOGUES[_dialogue.name] = _dialogue
                SCREENS[_dialogue.name] = screen_actions_of(_dialogue)
ALL_ACTIONS = {action.id: action for screen in SCREENS.values() for action in screen.records}


def screens_of(action: ScreenAction) -> list[str]:
    return [name for name, screen in SCREENS.items() if action.id in screen.ids]


def shared_table() -> list[str]:
    """The rows of the table in CONTRIBUTING: the keys of each screen stand on its help page."""
    shared = (each for each in ACTIONS.values() if each.id in SHARED_IDS)
    return [HEAD, "|---|---|---|", *(f"| {each.keys} | {each.label} | {each.help} |" for each in shared)]


def whole_table() -> list[str]:
    """A row for each action of each screen, with the names of the screens that have it."""
    head = [f"{HEAD} Screens |", "|---|---|---|---|"]
    return head + [
        f"| {each.keys} | {each.label} | {each.help} | {', '.join(screens_of(each))} |"
        for each in ALL_ACTIONS.values()
    ]


def test_contributing_prints_the_shared_actions() -> None:
    text = CONTRIBUTING.read_text()
    assert "\n".join([*shared_table(), ""]) in text, "run python tests/tui/test_actions.py"


def test_every_screen_declares_its_actions() -> None:
    without = {kind.__name__ for kind in screen_classes() if not hasattr(kind, "screen_actions")}
    assert without == {
        *SAY_THEIR_KEYS,
        "Dialog",
        "WatchScreen",
        "SharedScreen",
        "DialogueScreen",
        "LessonScreen",
        "DefenceScreen",
    }
    for kinds in CLASSES.values():
        assert len({id(kind.screen_actions) for kind in kinds}) == 1  # type: ignore[attr-defined, unused-ignore]  # only screens that declare actions are among them


def test_an_action_is_declared_once_and_has_a_screen() -> None:
    declared = [*ACTIONS, *(each.id for screen in SCREENS.values() for each in screen.own)]
    assert sorted(declared) == sorted(set(declared)) == sorted(ALL_ACTIONS)


@every_case("name", SCREENS)
def test_a_screens_bindings_are_those_of_the_table(name: str) -> None:
    wanted: dict[str, str] = {}
    for action in SCREENS[name].records:
        for keys, call in action.bindings:
            wanted |= dict.fromkeys(keys.split(","), call)
    for kind in CLASSES[name]:
        inherited = {key for base in Screen.__mro__ for key in _bound(base)}
        found = {key: call for key, call in _merged(kind).items() if key not in inherited or key in wanted}
        assert found == wanted
        missing = {call.partition("(")[0] for call in wanted.values() if not call.startswith("app.")}
        assert {each for each in missing if not hasattr(kind, f"action_{each}")} == set()


def _bound(kind: type) -> set[str]:
    return set(kind._merge_bindings().key_to_bindings) if hasattr(kind, "_merge_bindings") else set()


def _merged(kind: type[Screen[object]]) -> dict[str, str]:
    found = kind._merge_bindings().key_to_bindings
    return {key: found[key][-1].action for key in found}


@every_case("name", SCREENS)
def test_no_key_of_a_screen_does_two_things(name: str) -> None:
    if name in DIALOGUES:
        return  # there a key means the one action that is possible: tests/dialogue/test_both_faces.py
    found = [key for action in SCREENS[name].records for key in action.key_names]
    assert sorted(found) == sorted(set(found))


@every_case("name", SCREENS)
def test_the_line_of_keys_ends_in_the_list_of_all_commands(name: str) -> None:
    screen = SCREENS[name]
    keys = {screen[each].footer_keys for each in screen.footer} | {"^P"}
    for width in (40, 80, 200):
        line = footer(screen, width)
        is_whole = {text for text, style in line if style == "press"} == keys
        assert "".join(text for text, _ in line).split()[-2:] == ["^P", "find" if is_whole else "more"]


def test_a_letter_that_screens_share_means_nothing_else() -> None:
    owners: dict[str, set[str]] = defaultdict(set)
    for screen in SCREENS.values():
        if not screen.drives:
            for action in screen.records:
                for key in action.key_names:
                    if len(key) == 1 and key.isalpha():
                        owners[key].add(action.id)
    shared = {key for key, ids in owners.items() if ids & SHARED_IDS}
    assert {key: owners[key] for key in shared if len(owners[key]) > 1} == {}


def test_enter_esc_question_mark_and_r_mean_the_same_everywhere() -> None:
    for screen in SCREENS.values():
        for action in screen.records:
            keys = action.key_names
            calls = {call.partition("(")[0] for _, call in action.bindings}
            assert "r" not in keys or action.id == "restart"
            assert "question_mark" not in keys or action.id == "help"
            assert "escape" not in keys or action.id == "back"
            assert "enter" not in keys or calls & {"next", "open", "back", "mark"}
    assert "r" not in ACTIONS["check"].key_names


@every_case("name", SCREENS)
def test_help_fits_its_dialog(name: str) -> None:
    for row in help_page(SCREENS[name]):
        assert cell_len(row_text(row)) <= WIDTH - 4
    for action in SCREENS[name].records:
        assert cell_len(action.keys) < 17


def test_a_long_note_goes_on_beside_its_keys() -> None:
    told = [row_text(each) for each in help_page(next(iter(SCREENS.values())), [("tag", "words " * 20)])]
    at = next(number for number, line in enumerate(told) if line.startswith(" tag"))
    column = told[at].index("words")
    assert len(told) > at + 1
    assert all(line.index("words") == column and len(line) <= WIDTH - 4 for line in told[at:])


@every_case("name", SCREENS)
@every_case("width", [60, 80, 200])
def test_the_line_of_keys_fits_and_names_the_way_out(name: str, width: int) -> None:
    text = row_text(footer(SCREENS[name], width)).rstrip()
    assert cell_len(text) <= width
    for each in {"back", "quit", "help"} & set(SCREENS[name].footer):
        assert SCREENS[name][each].label in text


@pytest.mark.parametrize("width", [60, 80])
@pytest.mark.parametrize("idle", [set(), {"predict", "drive_scene"}, {"questions", "drive"}])
def test_the_lessons_line_of_keys_fits_whatever_is_possible(idle: set[str], width: int) -> None:
    text = row_text(footer(screen_actions_of(LessonDialogue), width, without=idle)).rstrip()
    assert cell_len(text) <= width
    assert text.startswith("c check" if "predict" in idle else "1-4 predict")


if __name__ == "__main__":
    text = CONTRIBUTING.read_text()
    CONTRIBUTING.write_text(
        re.sub(re.escape(HEAD) + r".*\n(\|.*\n)*", lambda _: "\n".join(shared_table()) + "\n", text)
    )
    print(*whole_table(), sep="\n")
