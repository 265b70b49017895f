"""The film of a student's own agent: their lines learn the floor, the robot drives as they learned, and mistakes are named."""

from __future__ import annotations

import shutil
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

from kit.host.sandbox.sandbox_config import INTERACTIVE_LEVEL
from kit.run.recording import load_recording
from kit.run.scenario import find_recorded_scenario
from kit.school.lessons.checking import STARTER
from kit.school.lessons.learning_playback import LearningPlayback
from kit.school.lessons.own_agent import FILM_FILE, OwnAgentError, OwnAgentFilm, describe_film, make_film
from kit.school.lessons.own_learners import StudentLines, make_own_learner
from kit.school.lessons.reading import lesson_names
from kit.school.lessons.records import LearningScene, Lesson
from tests.cases import every_case
from tests.kit_content import kit_lesson

SOLUTIONS = Path(__file__).parents[2] / "solutions"
STEPS = [
    pytest.param(lesson, step.own_agent, id=f"{lesson.name}-{step.number}")
    for name in lesson_names()
    for lesson in [kit_lesson(name)]
    for step in lesson.steps
    if step.own_agent is not None
]


def files_of(lesson: Lesson, scene: LearningScene, folder: Path, work: str = "solution.py") -> list[Path]:
    """A student's files, one folder for each exercise."""
    files = []
    for exercise in lesson.exercises:
        if exercise.name in scene.own:
            source = exercise.folder if work.startswith(STARTER) else SOLUTIONS / lesson.name / exercise.name
            file = folder / exercise.name / exercise.file
            file.parent.mkdir(parents=True)
            shutil.copyfile(source / work, file)
            files.append(file)
    return files


def tell_nobody(text: str) -> None:
    """How far it is, unread."""


def film_of(lesson: Lesson, scene: LearningScene, folder: Path) -> OwnAgentFilm:
    return make_film(scene, files_of(lesson, scene, folder), INTERACTIVE_LEVEL, tell_nobody)


def test_each_lesson_on_an_algorithm_has_a_film() -> None:
    assert {each.values[1].learners[0].algorithm for each in STEPS} == {"q-learning", "dqn", "ppo"}  # type: ignore[union-attr]


@pytest.mark.long
@pytest.mark.parametrize(("lesson", "scene"), STEPS)
def test_what_passes_learns_the_floor_and_drives_to_the_target(
    lesson: Lesson, scene: LearningScene, tmp_path: Path
) -> None:
    film = film_of(lesson, scene, tmp_path)
    assert film.is_solved
    assert film.moves == scene.world.shortest_path_length
    shown = LearningPlayback(film.scene)
    shown.finish()
    assert shown.is_over
    assert shown.learners[0].is_solved, "what is watched is what was learned"
    kept = load_recording(film.file)
    assert film.file.name == FILM_FILE
    place = find_recorded_scenario(kept.place, kept.case, film.file)
    assert place.case is not None
    [track] = [kept.track(name) for name in place.partners]
    assert np.hypot(*(track[-1, :2] - np.array(place.case.target))) < 0.2


@pytest.mark.long
@pytest.mark.parametrize(("lesson", "scene"), STEPS)
def test_a_starter_learns_nothing(lesson: Lesson, scene: LearningScene, tmp_path: Path) -> None:
    """Else the film would say nothing of the student's lines."""
    files = files_of(lesson, scene, tmp_path, f"{STARTER}.py")
    with suppress(OwnAgentError):
        assert not make_film(scene, files, INTERACTIVE_LEVEL, tell_nobody).is_solved


def q_learning() -> tuple[Lesson, LearningScene]:
    lesson, scene = STEPS[0].values
    assert isinstance(lesson, Lesson)
    assert isinstance(scene, LearningScene)
    return lesson, scene


@every_case(
    ("old", "new", "said"),
    [
        ("return values.index", "return 7 + 0 * values.index", "choose() returned 7"),
        ("def choose", "def chose", 'no function "choose"'),
        ("def choose", "def choose(:", "SyntaxError"),
        ("return values.index", "return 1 / 0 * values.index", "ZeroDivisionError"),
    ],
)
def test_a_mistake_in_the_lines_is_named(old: str, new: str, said: str, tmp_path: Path) -> None:
    lesson, scene = q_learning()
    [file] = files_of(lesson, scene, tmp_path / said[:6])
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new, 1))
    with pytest.raises(OwnAgentError) as raised:
        make_film(scene, [file], INTERACTIVE_LEVEL, tell_nobody)
    assert said in str(raised.value)


def test_the_same_answers_make_the_same_table(tmp_path: Path) -> None:
    lesson, scene = q_learning()
    with StudentLines(files_of(lesson, scene, tmp_path), INTERACTIVE_LEVEL) as lines:
        first = make_own_learner(scene.world, scene.learners[0], lines)
        for _ in range(60):
            first.step()
        kept = lines.kept_lines()
    again = make_own_learner(scene.world, scene.learners[0], kept.opened())
    for _ in range(60):
        again.step()
    np.testing.assert_array_equal(first.values, again.values)
    assert first.cell == again.cell


def test_a_robot_that_has_learned_no_way_stays_where_it_is(tmp_path: Path) -> None:
    """Nothing is said of a drive then, of which there is none."""
    lesson, scene = q_learning()
    [file] = files_of(lesson, scene, tmp_path)
    file.write_text(file.read_text().replace("drawn < epsilon", "False"))
    told: list[str] = []
    film = make_film(scene, [file], INTERACTIVE_LEVEL, told.append)
    assert not film.moves
    assert len(told) == 10, "how far it is, at each tenth"
    assert f"{scene.updates:,} of {scene.updates:,}" in told[-1]
    assert "stays there" in describe_film(film)
    assert "driven" not in describe_film(film)
