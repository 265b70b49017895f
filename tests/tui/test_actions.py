"""The table of actions: the screens' bindings, lines of keys and help pages come from it, and CONTRIBUTING prints it.

``python tests/tui/test_actions.py`` writes the shared actions into ``.github/CONTRIBUTING.md``, and prints all.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path

import pytest
from rich.cells import cell_len
from textual.screen import Screen

from kit.tui.actions import ACTIONS, SCREENS, SHARED_IDS, ScreenAction
from kit.tui.rows.key_rows import footer, help_page
from kit.tui.screens.challenge import ChallengeScreen
from kit.tui.screens.dialogs import WIDTH, Picker, TextScreen
from kit.tui.screens.fields import FieldsScreen
from kit.tui.screens.form import FormScreen
from kit.tui.screens.graph import GraphScreen
from kit.tui.screens.key_test import KeyTestScreen
from kit.tui.screens.launched import LaunchScreen
from kit.tui.screens.layers import CaseEditor, LayersScreen
from kit.tui.screens.leaderboard import LeaderboardScreen
from kit.tui.screens.lesson import LessonScreen
from kit.tui.screens.lesson_drive import RecordedDriveScreen, RecordingScreen, ReplayScreen
from kit.tui.screens.lesson_exercise import DefenceScreen
from kit.tui.screens.lessons import LessonsScreen
from kit.tui.screens.level_drive import DriveResultDialog, LevelDrive
from kit.tui.screens.levels import LevelsScreen
from kit.tui.screens.map_drawing import MapDrawingScreen
from kit.tui.screens.new_training import NewTrainingScreen
from kit.tui.screens.photo_corners import PhotoCornersScreen
from kit.tui.screens.play import PlayScreen
from kit.tui.screens.quiz import QuizScreen
from kit.tui.screens.shared_game import SharedGuestScreen, SharedHostScreen
from kit.tui.screens.start import StartScreen
from kit.tui.screens.training import TrainingScreen
from kit.tui.screens.trainings import TrainingsScreen
from tests.cases import every_case

CONTRIBUTING = Path(__file__).parents[2] / ".github/CONTRIBUTING.md"
HEAD = "| Keys | Action | What it does | Screens |"
CLASSES: dict[str, tuple[type[Screen[object]], ...]] = {
    "start": (StartScreen,),
    "lessons": (LessonsScreen,),
    "lesson": (LessonScreen,),
    "defence": (DefenceScreen,),
    "quiz": (QuizScreen,),
    "form": (FormScreen,),
    "levels": (LevelsScreen,),
    "challenge": (ChallengeScreen,),
    "leaderboard": (LeaderboardScreen,),
    "training": (TrainingScreen,),
    "trainings": (TrainingsScreen,),
    "new training": (NewTrainingScreen,),
    "map drawing": (MapDrawingScreen,),
    "photo corners": (PhotoCornersScreen,),
    "nodes": (GraphScreen,),
    "layers": (LayersScreen,),
    "case editor": (CaseEditor,),
    "text": (TextScreen,),
    "list": (Picker,),
    "drive": (PlayScreen,),
    "fields": (FieldsScreen,),
    "level": (LevelDrive,),
    "level result": (DriveResultDialog,),
    "shared game": (SharedHostScreen, SharedGuestScreen),
    "recorded drive": (RecordedDriveScreen,),
    "launch": (LaunchScreen,),
    "replay": (ReplayScreen, RecordingScreen),
    "key test": (KeyTestScreen,),
}  # type: ignore[dict-item, unused-ignore]  # screens that return something else


def keys_of(action: ScreenAction) -> set[str]:
    return {key for keys, _ in action.bindings for key in keys.split(",")}


def screens_of(action: ScreenAction) -> list[str]:
    return [name for name, screen in SCREENS.items() if action.id in screen.ids]


def table(ids: Iterable[str] = ACTIONS) -> list[str]:
    """The rows of the table of these actions."""
    rows = [HEAD, "|---|---|---|---|"]
    for action in map(ACTIONS.__getitem__, ids):
        where = "all" if len(screens_of(action)) == len(SCREENS) else ", ".join(screens_of(action))
        rows.append(f"| {action.keys} | {action.label} | {action.help} | {where} |")
    return rows


def shared_table() -> list[str]:
    """The rows of the table in CONTRIBUTING: a key of one screen alone stands on that screen's help page."""
    return table(each for each in ACTIONS if each in SHARED_IDS)


def test_contributing_prints_the_shared_actions() -> None:
    text = CONTRIBUTING.read_text()
    assert "\n".join(shared_table()) in text, "run python tests/tui/test_actions.py"


def test_every_screen_is_in_the_table() -> None:
    assert set(CLASSES) == set(SCREENS)
    assert {each for screen in SCREENS.values() for each in screen.ids} == set(ACTIONS)


@every_case("name", SCREENS)
def test_a_screens_bindings_are_those_of_the_table(name: str) -> None:
    wanted: dict[str, str] = {}
    for each in SCREENS[name].ids:
        for keys, call in ACTIONS[each].bindings:
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
    found = [key for each in SCREENS[name].ids for key in keys_of(ACTIONS[each])]
    assert sorted(found) == sorted(set(found))


def test_a_letter_that_screens_share_means_nothing_else() -> None:
    owners: dict[str, set[str]] = defaultdict(set)
    for screen in SCREENS.values():
        if not screen.drives:
            for each in screen.ids:
                for key in keys_of(ACTIONS[each]):
                    if len(key) == 1 and key.isalpha():
                        owners[key].add(each)
    shared = {key for key, ids in owners.items() if ids & SHARED_IDS}
    assert {key: owners[key] for key in shared if len(owners[key]) > 1} == {}


def test_enter_esc_question_mark_and_r_mean_the_same_everywhere() -> None:
    for screen in SCREENS.values():
        for each in screen.ids:
            keys = keys_of(ACTIONS[each])
            calls = {call.partition("(")[0] for _, call in ACTIONS[each].bindings}
            assert "r" not in keys or each == "restart"
            assert "question_mark" not in keys or each == "help"
            assert "escape" not in keys or each == "back"
            assert "enter" not in keys or calls & {"next", "open", "back", "mark"}
    assert "r" not in keys_of(ACTIONS["check"])


@every_case("name", SCREENS)
def test_help_fits_its_dialog(name: str) -> None:
    for row in help_page(name):
        assert cell_len("".join(text for text, _ in row)) <= WIDTH - 4
    for each in SCREENS[name].ids:
        assert cell_len(ACTIONS[each].keys) < 17


@every_case("name", SCREENS)
@every_case("width", [60, 80, 200])
def test_the_line_of_keys_fits_and_names_the_way_out(name: str, width: int) -> None:
    text = "".join(part for part, _ in footer(name, width)).rstrip()
    assert cell_len(text) <= width
    for each in {"back", "quit", "help"} & set(SCREENS[name].footer):
        assert ACTIONS[each].label in text


@pytest.mark.parametrize("width", [60, 80])
@pytest.mark.parametrize("idle", [set(), {"predict", "drive_scene"}, {"questions", "drive"}])
def test_the_lessons_line_of_keys_fits_whatever_is_possible(idle: set[str], width: int) -> None:
    text = "".join(part for part, _ in footer("lesson", width, without=idle)).rstrip()
    assert cell_len(text) <= width
    assert text.startswith("c check" if "predict" in idle else "1-4 predict")


if __name__ == "__main__":
    text = CONTRIBUTING.read_text()
    CONTRIBUTING.write_text(
        re.sub(re.escape(HEAD) + r"\n(\|.*\n)*", lambda _: "\n".join(shared_table()) + "\n", text)
    )
    print(*table(), sep="\n")
