"""What players needed in puzzles: answers on the leaderboard's folder, judged anew; figures can neither be made up nor borrowed."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from kit.layers.planning import solve_layers
from kit.layers.requirements_file import read_requirements
from kit.school.game import leaderboard
from kit.school.game.challenge import AnswerSubmission
from kit.school.game.challenge_kinds.devices import DevicesTask, fewest_lasers
from kit.school.game.challenge_kinds.layers import LayersTask, format_plan
from kit.school.game.challenges import all_challenges
from kit.school.game.leaderboard import publish_drives, remove_own_entry
from kit.school.game.medal import Medal
from kit.school.game.players_histogram import LEAST_PLAYERS
from kit.school.game.shared_answers import MAX_ANSWER_BYTES, figures_needed, publish_answer, share_answer
from kit.tui.rows.challenge_rows import answers_needed_rows
from tests.tui.lesson_stage import row_text

LASERS = next(each for each in all_challenges() if each.task.kind == "devices")
LAYERS = next(each for each in all_challenges() if each.task.kind == "layers")
assert isinstance(LASERS.task, DevicesTask)
BEST = fewest_lasers(LASERS.task)


def lasers(more: int = 0) -> str:
    """The best answer, with so many lasers that are not needed."""
    return " ".join(f"{row},{column}" for row, column in (*BEST, *BEST[:1] * more))


@pytest.fixture
def board(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A leaderboard that this player has joined."""
    folder = tmp_path / "board"
    monkeypatch.setenv(leaderboard.FOLDER_VARIABLE, str(folder))
    publish_drives(folder, "Ada", {})
    return folder


def own_file(board: Path) -> Path:
    return board / f"{os.getuid()}.{LASERS.id}.txt"


def test_the_best_answer_stays_and_leaving_takes_it_off(board: Path) -> None:
    for more, needed in ((2, 2), (1, 1), (2, 1), (0, 0)):
        publish_answer(board, LASERS, lasers(more))
        assert figures_needed(board, LASERS) == [len(BEST) + needed]
    remove_own_entry(board)
    assert figures_needed(board, LASERS) == []
    assert not own_file(board).exists()


def test_who_has_not_joined_shares_nothing(tmp_path: Path) -> None:
    publish_answer(tmp_path / "board", LASERS, lasers())
    assert not own_file(tmp_path / "board").exists()


def test_a_plan_of_layers_is_shared_by_what_it_says_not_by_where_it_lies(board: Path, tmp_path: Path) -> None:
    assert isinstance(LAYERS.task, LayersTask)
    plan = tmp_path / "plan.yaml"
    fewest = solve_layers(read_requirements(LAYERS.task.file).case).assignment
    plan.write_text(format_plan(fewest))
    publish_answer(board, LAYERS, LAYERS.task.read_answer(plan))
    plan.unlink()
    assert figures_needed(board, LAYERS) == [len(fewest.layers)]


@pytest.mark.parametrize(
    "content",
    [b"", b"7", b"-1000000", b"1e308", b"\xff\xfe", b"0,0 0,0", b"9,9" * MAX_ANSWER_BYTES, str(Path(__file__)).encode()],
    ids=["empty", "figure", "negative", "huge", "bytes", "wall", "long", "path"],
)  # fmt: skip
def test_what_is_no_answer_counts_for_nothing(board: Path, content: bytes) -> None:
    own_file(board).write_bytes(content)
    assert figures_needed(board, LASERS) == []


def test_an_answer_behind_a_link_or_of_another_user_counts_for_nothing(board: Path, tmp_path: Path) -> None:
    publish_answer(board, LASERS, lasers())
    answer = own_file(board).read_bytes()
    own_file(board).unlink()
    (tmp_path / "answer.txt").write_bytes(answer)
    own_file(board).symlink_to(tmp_path / "answer.txt")
    assert figures_needed(board, LASERS) == []
    (board / "123456.json").write_bytes((board / f"{os.getuid()}.json").read_bytes())
    (board / f"123456.{LASERS.id}.txt").write_bytes(answer)
    assert figures_needed(board, LASERS) == []


def test_the_histogram_comes_with_the_fifth_player(board: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        leaderboard, "read_own", lambda file, user, limit: file.read_bytes()
    )  # of several users
    judgement = LASERS.task.judge(AnswerSubmission(lasers(), board))
    assert judgement.medal is Medal.GOLD
    assert judgement.comparison is not None
    for player in range(1, LEAST_PLAYERS):
        assert share_answer(LASERS, lasers(), judgement) == ()
        (board / f"{player}.json").write_text("{}")
        (board / f"{player}.{LASERS.id}.txt").write_text(lasers(player % 3))
    bins = share_answer(LASERS, lasers(), judgement)
    assert sum(each.count for each in bins) == LEAST_PLAYERS
    text = [row_text(each) for each in answers_needed_rows(bins, judgement.comparison, 74)]
    assert all(judgement.comparison.unit in each for each in text[1:])
    assert sum("you" in each for each in text) == 1
    naive = LASERS.task.judge(AnswerSubmission(LASERS.task.naive_answer(), board))
    assert share_answer(LASERS, LASERS.task.naive_answer(), naive) == ()
