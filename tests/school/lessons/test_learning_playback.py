"""A learning scene as it is played: the same each time, slow at first, to its end."""

from __future__ import annotations

from kit.learning.grid.grid_learner import GridLearnerSettings
from kit.learning.grid.grid_world import GridWorld
from kit.render.encode import AsciiEncoder
from kit.school.lessons.learning_playback import (
    MAX_CURVE_COLUMNS,
    MAX_CURVE_ROWS,
    LearningPlayback,
    plain_rows,
)
from kit.school.lessons.reading import find_lesson
from kit.school.lessons.records import LearningScene

SCENE = LearningScene(
    GridWorld(("S..G",)),
    (GridLearnerSettings(seed=1), GridLearnerSettings("sarsa", seed=1)),
    ("one", "other"),
    episodes=10,
    seconds=4.0,
)


def test_it_takes_its_time_and_ends_with_all_episodes() -> None:
    playback = LearningPlayback(SCENE)
    playback.advance_to(2.0)
    half = [each.updates for each in playback.learners]
    playback.advance_to(1.0)
    assert [each.updates for each in playback.learners] == half, "it never goes back"
    playback.finish()
    assert playback.is_over
    assert [each.episodes for each in playback.learners] == [10, 10]
    assert all(before < each.updates / 4 for before, each in zip(half, playback.learners, strict=True))


def test_single_steps_and_the_clock_lead_to_the_same_tables() -> None:
    by_step, by_time = LearningPlayback(SCENE), LearningPlayback(SCENE)
    while not by_step.is_over:
        before = by_step.time_s
        by_step.step()
        assert by_step.time_s >= before
    by_time.finish()
    for one, other in zip(by_step.learners, by_time.learners, strict=True):
        assert (one.values == other.values).all()


def test_a_frame_tells_the_episode_and_the_last_update() -> None:
    playback = LearningPlayback(SCENE)
    assert "Nothing is learned yet" in "\n".join(playback.frame(80, 8, AsciiEncoder()).rows())
    playback.step()
    shown = playback.frame(80, 8, AsciiEncoder()).rows()
    assert "one: 0 of 10 episodes" in shown[0]
    assert "Episode 1, step 1: reward 0" in shown[-1]


def test_there_is_room_for_a_curve_beside_or_below() -> None:
    playback = LearningPlayback(SCENE)
    playback.finish()
    for columns, rows in ((120, 12), (50, 24)):
        shown = playback.frame(columns, rows, AsciiEncoder()).rows()
        assert any(row.endswith(" 10 episodes") and "of" not in row for row in shown), (columns, rows)


def test_the_curve_grows_up_to_its_largest_size() -> None:
    playback = LearningPlayback(SCENE)
    playback.finish()

    def curve(columns: int, rows: int) -> list[str]:
        """The picture without the line of words below it."""
        shown = [each.rstrip() for each in playback.frame(columns, rows + 1, AsciiEncoder()).rows()]
        return "\n".join(shown[:-1]).rstrip().split("\n")

    wide = curve(300, 60)
    columns, rows = max(map(len, wide)), len(wide)
    left = wide[-1].index("+0")
    beside = left - 2  # of the curve; its scale stands in the first columns
    assert rows == MAX_CURVE_ROWS
    assert columns <= beside + MAX_CURVE_COLUMNS
    assert curve(beside + MAX_CURVE_COLUMNS, MAX_CURVE_ROWS) == wide
    assert curve(beside + MAX_CURVE_COLUMNS - 1, MAX_CURVE_ROWS) != wide
    assert curve(300, MAX_CURVE_ROWS - 1) != wide


def test_the_plain_form_says_in_words_what_the_tables_can_do() -> None:
    rows = plain_rows(SCENE)
    assert "one, after 10 episodes: the best moves reach the target in 3 steps; value at S 0." in "\n".join(
        rows
    )
    assert all(row.isascii() and len(row) <= 90 for row in rows)


def test_the_last_update_is_told_whole_where_the_picture_is_narrow_and_high() -> None:
    lesson = find_lesson("23")
    scene = next(step.learning for step in lesson.steps if step.learning is not None)
    playback = LearningPlayback(scene)
    for _ in range(12):
        playback.step()
    shown = " ".join(" ".join(playback.frame(38, 30, AsciiEncoder()).rows()).split())
    assert " ".join(playback.update_text(200).split()) in shown


def test_the_values_of_all_moves_are_shown_where_the_curve_has_room_too() -> None:
    playback = LearningPlayback(SCENE)
    playback.finish()
    shown = {size: "\n".join(playback.frame(*size, AsciiEncoder()).rows()) for size in ((118, 46), (118, 14))}
    assert all(" 10 episodes" in each for each in shown.values())
    large, small = (each.count(" 0 ") for each in shown.values())  # what the moves to the left are worth
    assert large > small
