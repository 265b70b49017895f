"""Challenges from the list of levels: opened, edited, checked by key and by saving, with a medal kept and the next one at a key."""

from __future__ import annotations

import re
import threading
from collections.abc import Awaitable, Callable, Iterator
from pathlib import Path

import pytest
from textual.pilot import Pilot

from kit.controllers import prepare_workspace
from kit.school.game import leaderboard
from kit.school.game.challenge import AnswerSubmission, Challenge
from kit.school.game.challenge_kinds.exploit import ExploitTask, best_moves, shortest_moves
from kit.school.game.challenge_kinds.repair import RepairTask
from kit.school.game.challenge_kinds.training import TrainingTask
from kit.school.game.challenges import all_challenges, answers_folder, challenge_medals
from kit.school.game.judgement import Judgement
from kit.school.game.levels import CHALLENGES_WORLD
from kit.school.game.medal import Medal
from kit.school.progress import EventKind, ProgressJournal
from kit.tui.screens import file_editor
from kit.tui.screens.challenge import ChallengeScreen
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.levels import LevelsScreen
from kit.tui.screens.puzzle import PuzzleScreen
from tests.tui.lesson_stage import rows, seen, stage, until
from tests.waiting import wait_until_shown

Scene = Callable[[Pilot[None], LevelsScreen], Awaitable[None]]
FIRST = all_challenges()[0]
SECOND = all_challenges()[1]
PLAYED = [each for each in all_challenges() if each.task.board("") is not None]


@pytest.fixture
def journal(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[ProgressJournal]:
    monkeypatch.setenv(leaderboard.FOLDER_VARIABLE, str(tmp_path / "hall"))
    with ProgressJournal(tmp_path) as opened:
        yield opened


def visit(scene: Scene, journal: ProgressJournal, folder: Path, size: tuple[int, int] = (80, 24)) -> None:
    """The list of levels with the first challenge chosen."""

    async def from_challenges(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, LevelsScreen)
        await seen(pilot, "World 1 of")
        await pilot.press("left")  # before the first world is the last one
        await seen(pilot, CHALLENGES_WORLD.title)
        await scene(pilot, screen)

    workspace = prepare_workspace(folder)
    stage(lambda theme: LevelsScreen(theme, journal, workspace), from_challenges, size=size)


def answer_file(folder: Path, challenge: Challenge, name: str) -> Path:
    return answers_folder(prepare_workspace(folder)) / challenge.id / name


def choose(screen: LevelsScreen, kind: type) -> list[str]:
    """The keys that choose the first challenge of a kind."""
    return ["down"] * next(
        number for number, each in enumerate(all_challenges()) if isinstance(each.task, kind)
    )


def test_a_challenge_is_opened_answered_and_rewarded(journal: ProgressJournal, tmp_path: Path) -> None:
    assert isinstance(FIRST.task, ExploitTask)
    file = answer_file(tmp_path, FIRST, "moves.txt")

    async def scene(pilot: Pilot[None], levels: LevelsScreen) -> None:
        assert levels.chosen_challenge is FIRST
        await pilot.press("g", "a", "w")  # nothing drives a challenge
        assert pilot.app.screen is levels
        await pilot.press("enter")
        await until(pilot, lambda: isinstance(pilot.app.screen, ChallengeScreen), "the challenge")
        await seen(pilot, FIRST.story[:40])
        assert shortest_moves(FIRST.task) in file.read_text()
        await pilot.press("c")
        await seen(pilot, "no medal")  # the naive answer
        file.write_text(best_moves(FIRST.task))
        await seen(pilot, "gold (new)")  # saving it checks it
        await seen(pilot, "best answer")
        await seen(pilot, f"next   {SECOND.title}")
        await pilot.press("c")
        await until(
            pilot, lambda: "gold" in "".join(rows(pilot)) and "(new)" not in "".join(rows(pilot)), "not new"
        )
        await pilot.press("n")
        await seen(pilot, SECOND.story[:40])
        await pilot.press("escape")
        await until(pilot, lambda: pilot.app.screen is levels, "the list")
        assert levels.chosen_challenge is SECOND
        line = next(each for each in rows(pilot) if FIRST.title in each)
        assert " G " in line
        assert "gold 1 " in rows(pilot)[0]

    visit(scene, journal, tmp_path)
    assert challenge_medals(journal.events())[FIRST.id] is Medal.GOLD


def test_a_puzzle_is_played_by_keys_and_kept_in_its_file(journal: ProgressJournal, tmp_path: Path) -> None:
    assert isinstance(FIRST.task, ExploitTask)
    moves = best_moves(FIRST.task)
    names = {"l": "left", "r": "right", "u": "up", "d": "down"}
    file = answer_file(tmp_path, FIRST, "moves.txt")

    async def scene(pilot: Pilot[None], levels: LevelsScreen) -> None:
        await pilot.press("enter")
        await until(pilot, lambda: isinstance(pilot.app.screen, PuzzleScreen), "the puzzle")
        await seen(pilot, FIRST.story[:40])
        await pilot.press("left", *(names[each] for each in moves))
        assert "u undo" in rows(pilot)[-1]
        await pilot.press(*["u"] * (len(moves) + 1), *(names[each] for each in moves))
        await seen(pilot, "gold")  # what it is worth now
        assert challenge_medals(journal.events()) == {}, "nothing was handed in yet"
        await pilot.press("c")
        await seen(pilot, "gold (new)")
        assert moves in file.read_text()
        screen = pilot.app.screen
        assert isinstance(screen, PuzzleScreen)
        await seen(pilot, "▀██████████▀")  # the medal beside the board
        assert re.search("█ [.←→↑↓] {3}[.←→↑↓] {3}", "\n".join(rows(pilot))), "which keeps its size"
        await pilot.press("u")
        assert screen._flourish.number == 0
        assert "▀██████████▀" not in "\n".join(rows(pilot))
        await pilot.press("escape")
        await until(pilot, lambda: pilot.app.screen is levels, "the list")
        await until(pilot, lambda: f"\n{moves[:-1]}\n" in file.read_text(), "the file to be written")
        await pilot.press("enter")
        await seen(pilot, f"{len(moves) - 1} of {FIRST.task.max_moves} moves")
        file.write_text("r")
        await seen(pilot, f"1 of {FIRST.task.max_moves} moves")  # edited elsewhere

    visit(scene, journal, tmp_path)
    assert challenge_medals(journal.events())[FIRST.id] is Medal.GOLD


@pytest.mark.long
@pytest.mark.parametrize("size", [(80, 24), (120, 35), (200, 50)], ids=str)
@pytest.mark.parametrize("played", PLAYED, ids=lambda each: each.id)
def test_every_board_fits_and_answers_every_key(
    journal: ProgressJournal, tmp_path: Path, played: Challenge, size: tuple[int, int]
) -> None:
    async def scene(pilot: Pilot[None], levels: LevelsScreen) -> None:
        await pilot.press(*["down"] * all_challenges().index(played), "enter")
        await until(pilot, lambda: isinstance(pilot.app.screen, PuzzleScreen), "the puzzle")
        screen = pilot.app.screen
        assert isinstance(screen, PuzzleScreen)
        await seen(pilot, "now ")
        for key in (
            "right",
            "down",
            "space",
            "tab",
            "space",
            "left",
            "up",
            "pagedown",
            "u",
            "u",
            "u",
            "u",
            "u",
        ):
            await pilot.press(key)
        assert screen._top == 0
        assert len(screen._shown) <= size[1] - 2, "no row is out of sight"
        await pilot.press("escape")
        await until(pilot, lambda: pilot.app.screen is levels, "the list")

    visit(scene, journal, tmp_path, size)


def test_a_check_of_a_puzzle_that_is_not_solved_says_so(journal: ProgressJournal, tmp_path: Path) -> None:
    async def scene(pilot: Pilot[None], levels: LevelsScreen) -> None:
        await pilot.press("enter")
        await until(pilot, lambda: isinstance(pilot.app.screen, PuzzleScreen), "the puzzle")
        await seen(pilot, FIRST.story[:40])
        assert not any("judged" in line for line in rows(pilot))
        await pilot.press("right", "c")
        await seen(pilot, "check  . no medal")
        await pilot.press("escape")

    visit(scene, journal, tmp_path)


def test_an_answer_that_cannot_be_judged_says_why(journal: ProgressJournal, tmp_path: Path) -> None:
    file = answer_file(tmp_path, FIRST, "moves.txt")

    async def scene(pilot: Pilot[None], levels: LevelsScreen) -> None:
        await pilot.press("enter")
        await seen(pilot, FIRST.story[:40])
        file.write_text("lx")
        await seen(pilot, "is not a move")

    visit(scene, journal, tmp_path)
    assert challenge_medals(journal.events()) == {}


def test_the_editor_opens_the_answers_file(
    journal: ProgressJournal, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[Path] = []

    def edit(app: object, file: Path, line: int, terminal: object) -> str:
        opened.append(file)
        file.write_text("r")
        return "no editor here"

    monkeypatch.setenv("EDITOR", "some")
    monkeypatch.setattr(file_editor, "edit_aside", edit)

    async def scene(pilot: Pilot[None], levels: LevelsScreen) -> None:
        await pilot.press("enter")
        await seen(pilot, FIRST.story[:40])
        await pilot.press("e")
        await until(pilot, lambda: isinstance(pilot.app.screen, MessageDialog), "what went wrong")
        await pilot.press("escape")
        await seen(pilot, "the shortest way has")  # what was saved is checked

    visit(scene, journal, tmp_path)
    assert opened == [answer_file(tmp_path, FIRST, "moves.txt")]


def test_a_training_is_handed_in_by_its_name(journal: ProgressJournal, tmp_path: Path) -> None:
    async def scene(pilot: Pilot[None], levels: LevelsScreen) -> None:
        await pilot.press(*choose(levels, TrainingTask), "enter")
        await seen(pilot, "a training run of yours")
        assert "edit" not in rows(pilot)[-1]
        await pilot.press("c")
        await until(pilot, lambda: isinstance(pilot.app.screen, MessageDialog), "no runs yet")

    visit(scene, journal, tmp_path)


@pytest.mark.long
def test_a_check_shows_what_it_does_and_ends_when_the_challenge_is_left(
    journal: ProgressJournal, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ended = threading.Event()

    def long_check(task: RepairTask, submission: AnswerSubmission) -> Judgement:
        assert Path(submission.answer).is_file()
        try:
            while True:
                submission.show_progress("episode 2 of 5")
                ended.wait(0.01)
        finally:
            ended.set()

    monkeypatch.setattr(RepairTask, "judge", long_check)

    async def scene(pilot: Pilot[None], levels: LevelsScreen) -> None:
        keys = choose(levels, RepairTask)
        await pilot.press(*keys[1:], "enter")
        await until(pilot, lambda: isinstance(pilot.app.screen, ChallengeScreen), "the one before")
        await pilot.press("n")
        await until(pilot, lambda: pilot.app.screen is levels, "the list: a clock begins with the first look")
        assert [each for each in journal.events() if each.kind is not EventKind.NEWS] == []
        await pilot.press("enter")
        await seen(pilot, "the clock starts; gold until 300 s")
        await pilot.press("escape")
        await until(pilot, lambda: pilot.app.screen is levels, "the list: who looks away starts no clock")
        assert [each for each in journal.events() if each.kind is not EventKind.NEWS] == []
        await pilot.press("enter")
        await seen(pilot, "the clock starts; gold until 300 s")
        await pilot.press("enter")
        await until(pilot, lambda: isinstance(pilot.app.screen, ChallengeScreen), "the challenge")
        await seen(pilot, "convoy.launch.py")
        await seen(pilot, " s; gold until ")
        await pilot.press("c")
        await seen(pilot, "s: episode 2 of 5")
        await pilot.press("escape")
        await until(pilot, lambda: pilot.app.screen is levels, "the list")
        await wait_until_shown(pilot, ended.is_set, "the end of the check")

    visit(scene, journal, tmp_path)


@pytest.mark.long
@pytest.mark.parametrize("size", [(80, 24), (120, 35), (200, 50)], ids=str)
def test_every_challenge_fits(journal: ProgressJournal, tmp_path: Path, size: tuple[int, int]) -> None:
    async def scene(pilot: Pilot[None], levels: LevelsScreen) -> None:
        for each in all_challenges():
            await until(pilot, lambda each=each: levels.chosen_challenge is each, each.title)
            await until(pilot, lambda each=each: f">  {each.title}" in "\n".join(rows(pilot)), each.title)
            await seen(pilot, " ".join(each.story.split()[:4]))
            await seen(pilot, each.task_text.split()[-1])
            assert "c check" not in rows(pilot)[-1]
            await pilot.press("enter")
            if each.task.clock is not None:
                await seen(pilot, "the clock starts")
                await pilot.press("enter")
            await until(pilot, lambda: isinstance(pilot.app.screen, ChallengeScreen), each.title)
            await until(pilot, lambda: "c check" in rows(pilot)[-1], "its keys")
            await pilot.press("escape")
            await until(pilot, lambda: pilot.app.screen is levels, "the list")
            await pilot.press("down")

    visit(scene, journal, tmp_path, size)


@pytest.mark.parametrize("size", [(120, 35), (200, 50)], ids=str)
def test_what_the_answer_is_about_stands_beside_the_page(
    journal: ProgressJournal, tmp_path: Path, size: tuple[int, int]
) -> None:
    async def scene(pilot: Pilot[None], levels: LevelsScreen) -> None:
        await pilot.press(*choose(levels, TrainingTask), "enter")
        await seen(pilot, "a training run of yours")
        await seen(pilot, "◎")  # the target on the task's map
        target = next(each for each in rows(pilot) if "◎" in each)
        assert target.index("◎") > size[0] // 2, "beside the page"
        assert "…" not in "".join(rows(pilot)), "nothing of the page is cut"
        assert any("── lesson" in each for each in rows(pilot)) is (size[0] == 200)
        await pilot.press("escape")
        await until(pilot, lambda: pilot.app.screen is levels, "the list")
        chosen = next(
            number for number, each in enumerate(all_challenges()) if each is levels.chosen_challenge
        )
        await pilot.press(*choose(levels, RepairTask)[chosen:], "enter")
        await seen(pilot, "the clock starts")
        await pilot.press("enter")
        await seen(pilot, "def generate_launch_description")
        file = answer_file(tmp_path, levels.chosen_challenge or FIRST, "convoy.launch.py")
        file.write_text("# mended\n")
        await seen(pilot, "# mended")

    visit(scene, journal, tmp_path, size)


def test_a_puzzle_is_begun_anew_by_a_key_and_undo_brings_the_answer_back(
    journal: ProgressJournal, tmp_path: Path
) -> None:
    async def scene(pilot: Pilot[None], levels: LevelsScreen) -> None:
        await pilot.press("enter")
        await until(pilot, lambda: isinstance(pilot.app.screen, PuzzleScreen), "the puzzle")
        await pilot.press("right", "right", "down")
        await seen(pilot, "3 of 20 moves")
        await pilot.press("r")
        await seen(pilot, "0 of 20 moves")
        await pilot.press("u")
        await seen(pilot, "3 of 20 moves")
        await pilot.press("u")
        await seen(pilot, "2 of 20 moves")
        await pilot.press("r", "left")
        await seen(pilot, "1 of 20 moves")
        await pilot.press("u", "u")
        await seen(pilot, "0 of 20 moves")

    visit(scene, journal, tmp_path)


def test_on_80_columns_the_list_uses_all_rows_and_has_the_board_beside_it(
    journal: ProgressJournal, tmp_path: Path
) -> None:
    async def scene(pilot: Pilot[None], levels: LevelsScreen) -> None:
        await seen(pilot, "██@ . . . . . . . ██")
        shown = rows(pilot)
        below = max(number for number, each in enumerate(shown) if each[3:].startswith("The "))
        assert shown[below + 1].startswith(FIRST.title), "what is said of it comes right below"
        for each in all_challenges()[1:]:
            await pilot.press("down")
            await seen(pilot, f">  {each.title}")
            assert rows(pilot)[below + 1].startswith(each.title[:20]), "it stays where it is"

    visit(scene, journal, tmp_path)
