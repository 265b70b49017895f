"""Every lesson found in the folder: it reads, its exercises prove themselves, its outcomes are known."""

from __future__ import annotations

import re
import time
from collections import Counter
from pathlib import Path

import pytest
import yaml

from grader.grading import GradingOptions, grade
from grader.reading import read_assignment
from grader.self_test import STARTER, STARTER_SHARE, list_wrong_works, try_works, written_out
from grader.submission import Submission, read_submission
from kit.cli import VERBS
from kit.document.markup import parse_markup
from kit.host.sandbox.probe import highest_level_up_to
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import GradingResult
from kit.school.game.challenges import all_challenges
from kit.school.lessons.checking import install_exercise, read_solution, submission_path
from kit.school.lessons.reading import (
    ASSIGNMENT_FILE,
    lesson_names,
    lesson_number,
    lessons_folder,
    read_outcomes,
    read_units,
    solutions_folder,
)
from kit.school.lessons.records import Exercise, Lesson, StepKind
from kit.workspace import open_workspace
from tests.cases import every_case
from tests.driving_program import driving_program
from tests.exercise_checks import check_exercise
from tests.kit_content import kit_lesson
from tests.solutions.misconceptions import Misconception, misconceptions

NAMES = lesson_names()
MISCONCEPTIONS = Path(__file__).with_name("misconceptions")
"""By lesson and exercise: what the student of each wrong work must be told first."""
IN_TEXT = re.compile(r"`((?:kit|grader) [^`]+)`")
GREETING = re.compile(r"^ {4}((?:kit|grader) .+)$", re.MULTILINE)
NUMBER_IN_TEXT = re.compile(r"\b(?:lessons?|lição|lições)\s+[A-Z]?\d", re.IGNORECASE)
RIGHT_ANSWERS = re.compile(r"\bright: \[.*\]$", re.MULTILINE)
WITHOUT_SECRETS = ("drive", "reward")
"""A drive by hand is there once; a reward is judged on everything there is."""
AGREEING = re.compile(r"(yes|sim|right)\b", re.IGNORECASE)
BOLD = re.compile(r"\*\*[^*\d]+ [^*\d]+\*\*")
OPENER_MIN = 5
"""A lesson that is this short opens the course, and has one exercise."""
SLOWER = 3.0
"""How many times as long as promised a check may take on a machine that is busy with other tests."""


EXERCISES = [(name, exercise.name) for name in NAMES for exercise in kit_lesson(name).exercises]


def quickest_exercise(name: str) -> str:
    """The one whose check promises to be quickest: it is proven by default, the others with the long tests."""
    return min(kit_lesson(name).exercises, key=lambda exercise: exercise.seconds).name


def exercise_of(name: str, exercise: str) -> tuple[Lesson, Exercise]:
    lesson = kit_lesson(name)
    return lesson, next(each for each in lesson.exercises if each.name == exercise)


def test_there_are_at_least_thirteen_each_in_one_unit_with_a_number_of_its_own() -> None:
    assert len(NAMES) >= 13
    assert list(NAMES) == [name for unit in read_units() for name in unit.lessons]
    assert len({lesson_number(name) for name in NAMES}) == len(NAMES)
    assert all(unit.opener for unit in read_units())


def test_outcomes_are_no_sentences_and_end_without_a_full_stop() -> None:
    outcomes = [each for name in NAMES for each in kit_lesson(name).outcomes]
    assert [each for each in outcomes if each.endswith(".")] == []


def test_no_feedback_agrees_since_it_is_also_told_to_who_was_wrong() -> None:
    """``Right.`` or ``Not this time`` stand before it."""
    told = [
        option.feedback
        for name in NAMES
        for step in kit_lesson(name).steps
        for option in step.options
        if AGREEING.match(option.feedback)
    ]
    assert told == []


def test_no_code_has_marks_for_bold_words() -> None:
    """Code stands as it is written."""
    rows = [
        row
        for name in NAMES
        for step in kit_lesson(name).steps
        for block in parse_markup(step.text)
        if block.kind == "code"
        for row in block.lines
        if BOLD.search(row)
    ]
    assert rows == []


def test_no_text_says_a_number_that_may_change() -> None:
    """A text says ``lesson {number 01-drive}``, so that a lesson may be added before the one that it names. A right answer
    is found from its page, by ``test_answers_pty``."""
    texts = [
        each
        for each in sorted(lessons_folder().rglob("*"))
        if each.suffix in (".yaml", ".py") and each.name != "units.yaml"
    ]
    assert len(texts) > len(NAMES)
    told = {each: RIGHT_ANSWERS.sub("", each.read_text()) for each in texts}
    assert [each for each, text in told.items() if NUMBER_IN_TEXT.search(text)] == []


@every_case("name", NAMES)
def test_it_leads_from_prediction_to_making(name: str) -> None:
    lesson = kit_lesson(name)
    kind_names = [step.kind for step in lesson.steps]
    assert kind_names[0] is StepKind.PREDICT
    assert StepKind.EXPLAIN in kind_names
    # A prediction with a scene is run as soon as it is made.
    assert StepKind.RUN in kind_names or any(step.commands or step.scene for step in lesson.steps)
    assert (1 if lesson.minutes <= OPENER_MIN else 2) <= len(lesson.exercises) <= 4
    assert sum(exercise.seconds for exercise in lesson.exercises) <= lesson.minutes * 60


@pytest.mark.parametrize("name", NAMES)
def test_its_exercises_are_what_the_grader_reads(name: str) -> None:
    lesson = kit_lesson(name)
    for exercise in lesson.exercises:
        assignment = read_assignment(exercise.folder)
        assert assignment.submit == exercise.file
        assert assignment.level is Level.LIMITED
        hints = [len(criterion.hints) for criterion in assignment.criteria if criterion.points]
        assert min(hints) >= 1, exercise.name
        assert max(hints) >= 2, exercise.name
        assert assignment.has_secrets or assignment.kind in WITHOUT_SECRETS, exercise.name
        known = solutions_folder() / name / exercise.name / "wrong"
        assert len([each for each in known.iterdir() if each.name[0] not in "._"]) >= 2


def test_nothing_is_solved_that_is_not_asked() -> None:
    asked = {f"{name}/{exercise}" for name, exercise in EXERCISES}
    solved = {f"{each.parent.name}/{each.name}" for each in solutions_folder().glob("*/*") if each.is_dir()}
    challenges = {f"challenges/{each.id}" for each in all_challenges()}
    assert solved - challenges == asked


@pytest.mark.daily(3)
@pytest.mark.parametrize(
    ("name", "exercise"),
    [
        pytest.param(
            name,
            each,
            marks=[] if each == quickest_exercise(name) else [pytest.mark.long],
            id=f"{name}-{each}",
        )
        for name, each in EXERCISES
    ],
)
def test_the_starter_fails_politely_and_the_solution_passes(tmp_path: Path, name: str, exercise: str) -> None:
    """The starter fails politely, the solution earns everything."""
    lesson, task = exercise_of(name, exercise)
    file = install_exercise(open_workspace(tmp_path / "workspace"), lesson, task)
    if file.exists():
        starter = _graded(task, file)
        assert starter.verdict == "fail", starter
        lost = [each for each in starter.tests if not each.is_passed]
        assert all(each.status not in ("student_error", "timeout") for each in lost)
        assert any(each.rationale for each in lost)
        assert starter.points is not None
        assert starter.points <= STARTER_SHARE * starter.max_points
    if file.suffix != ".npz":
        _solve(lesson, task, file)
        solved = _graded(task, file)
        assert solved.verdict == "pass", [
            (each.id, each.status, each.rationale) for each in solved.tests if not each.is_passed
        ]


def _graded(task: Exercise, file: Path) -> GradingResult:
    """What a student's check finds, without the process that it starts for itself."""
    assignment = read_assignment(task.folder)
    submission = read_submission(submission_path(task, file), assignment.submit)
    return grade(
        assignment, submission, GradingOptions(Level.LIMITED, secret=True, examples=True)
    ).for_student()


def _solve(lesson: Lesson, task: Exercise, file: Path) -> None:
    for other, text in read_solution(lesson, task).items():
        (file.parent / other).parent.mkdir(parents=True, exist_ok=True)
        (file.parent / other).write_text(text)
    _take_what_is_no_text(lesson.name, task.name, file.parent)


@pytest.mark.daily(4)
@pytest.mark.parametrize(
    ("name", "exercise"),
    [
        pytest.param(
            name,
            each,
            # The first is a drive by hand.
            marks=[] if (name, each) == EXERCISES[1] else [pytest.mark.long],
            id=f"{name}-{each}",
        )
        for name, each in EXERCISES
    ],
)
def test_a_students_check_passes_the_solution_within_the_promised_time(
    tmp_path: Path, name: str, exercise: str
) -> None:
    lesson, task = exercise_of(name, exercise)
    file = install_exercise(open_workspace(tmp_path / "workspace"), lesson, task)
    if file.suffix == ".npz":
        pytest.skip("a drive by hand has no solution that is a text")
    _solve(lesson, task, file)
    began = time.monotonic()
    solved = check_exercise(task, file)
    took = time.monotonic() - began
    assert solved.is_passed, [
        (each.id, each.status, each.rationale) for each in solved.lost_criteria
    ] or solved.problem
    assert took <= SLOWER * task.seconds


@pytest.mark.daily(4)
@pytest.mark.long
@pytest.mark.parametrize("secret", [True, False], ids=["secret", "public"])
@pytest.mark.parametrize(("name", "exercise"), EXERCISES, ids=[f"{name}-{each}" for name, each in EXERCISES])
def test_an_untouched_starter_earns_at_most_a_fifth(name: str, exercise: str, secret: bool) -> None:
    _, task = exercise_of(name, exercise)
    if task.file.endswith(".npz"):
        pytest.skip("a drive by hand has no starter")
    assignment = read_assignment(task.folder)
    starter = task.folder / STARTER
    file = starter if starter.is_dir() else starter.with_suffix(Path(task.file).suffix)
    result = grade(
        assignment, read_submission(file, assignment.submit), GradingOptions(Level.LIMITED, secret=secret)
    )
    assert result.points is not None
    assert result.points <= STARTER_SHARE * result.max_points, {each.id: each.points for each in result.tests}


CONTROLLERS = [
    (name, exercise.name)
    for name in NAMES
    for exercise in kit_lesson(name).exercises
    if "kind: controller\n" in (exercise.folder / ASSIGNMENT_FILE).read_text()
]


@pytest.mark.daily(4)
@pytest.mark.long
@pytest.mark.parametrize(("speed", "rate"), [(0.0, 0.0), (0.3, 0.0), (0.6, 0.0), (0.0, 1.0)])
@pytest.mark.parametrize(("name", "exercise"), CONTROLLERS)
def test_standing_still_driving_straight_and_turning_earn_at_most_a_fifth(
    name: str, exercise: str, speed: float, rate: float
) -> None:
    _, task = exercise_of(name, exercise)
    assignment = read_assignment(task.folder)
    source = driving_program(speed, rate, name="probe")
    submission = Submission("probe", assignment.submit, {assignment.submit: source.encode()})
    result = grade(assignment, submission, GradingOptions(Level.LIMITED, secret=True))
    assert result.points is not None
    assert result.points <= STARTER_SHARE * result.max_points, {each.id: each.points for each in result.tests}


def test_every_exercise_has_works_for_its_misconceptions() -> None:
    found = misconceptions()
    assert {(each.lesson, each.exercise) for each in found} == set(EXERCISES)
    assert all(each.criteria for each in found)
    silent = [each for each in found if not each.sentence]
    assert {each.exercise for each in silent} <= {"flag"}, "a drive by hand has no lines to quote in"
    assert [each for each in found if each.sentence and _said(each.sentence) not in _words_of(each)] == []


def _words_of(work: Misconception) -> str:
    """Everything that a student reads of an exercise and its lesson."""
    folder = lessons_folder() / work.lesson
    files = [folder / "lesson.yaml", *sorted((folder / work.exercise).rglob("*"))]
    return _said(" ".join(file.read_text() for file in files if file.suffix in (".yaml", ".py")))


def _said(text: str) -> str:
    """Text without marks, line breaks and upper case."""
    return " ".join(re.sub(r"[`*“”\"#]", "", text).split()).casefold().strip(" .:")


KNOWN_MISTAKES = [
    (name, exercise.name)
    for name in NAMES
    for exercise in kit_lesson(name).exercises
    if "mistakes:" in (exercise.folder / ASSIGNMENT_FILE).read_text()
]


def test_several_exercises_know_mistakes() -> None:
    assert len(KNOWN_MISTAKES) >= 6


@pytest.mark.daily(4)
@pytest.mark.long
@pytest.mark.parametrize(("name", "exercise"), KNOWN_MISTAKES)
def test_every_known_mistake_is_made_by_a_wrong_work(name: str, exercise: str, tmp_path: Path) -> None:
    """What a student is told first about it is the hint for that mistake, and not the criterion's first."""
    _, task = exercise_of(name, exercise)
    assignment = read_assignment(task.folder)
    wanted = {(each.id, mistake.hint) for each in assignment.criteria for mistake in each.mistakes}
    told: set[tuple[str, str]] = set()
    solutions, ending = solutions_folder() / name / exercise, Path(assignment.submit).suffix
    for each in list_wrong_works(solutions / "wrong", ending):
        if wanted <= told:
            break
        work = written_out(each, solutions / f"solution{ending}", tmp_path)
        result = grade(
            assignment,
            read_submission(work, assignment.submit),
            GradingOptions(Level.LIMITED, secret=True, examples=True),
        )
        told |= {(each.id, each.hints[0]) for each in result.tests if each.hints}
    assert wanted <= told


def _take_what_is_no_text(name: str, exercise: str, folder: Path) -> None:
    whole = solutions_folder() / name / exercise / "solution"
    for each in whole.rglob("*") if whole.is_dir() else ():
        if each.is_file() and "__pycache__" not in each.parts:
            to = folder / each.relative_to(whole)
            to.parent.mkdir(parents=True, exist_ok=True)
            to.write_bytes(each.read_bytes())


@pytest.mark.daily(10)
@pytest.mark.long
@pytest.mark.parametrize(("name", "exercise"), EXERCISES, ids=[f"{name}-{each}" for name, each in EXERCISES])
def test_every_work_loses_what_it_was_written_for(name: str, exercise: str) -> None:
    _, task = exercise_of(name, exercise)
    assignment = read_assignment(task.folder)
    solutions = solutions_folder() / name / exercise
    level = highest_level_up_to(
        Level.FILTERED
    )  # that of a class: at the students' own, some are tried by default
    proofs = list(try_works(assignment, GradingOptions(level, secret=True), solutions))
    by_hand = task.file.endswith(".npz")  # a drive has no starter
    wrong = {
        each.name: each.problems
        for each in proofs
        if each.problems and not (by_hand and each.name.startswith(STARTER))
    }
    assert wrong == {}
    assert len(proofs) >= 4


@every_case("name", NAMES)
def test_every_command_in_a_text_stands_among_its_commands(name: str) -> None:
    lesson = kit_lesson(name)
    copied = {command.line for step in lesson.steps for command in step.commands}
    for step in lesson.steps:
        for line in (*IN_TEXT.findall(step.text), *GREETING.findall(step.text)):
            assert line in copied or _is_a_verb(line), f"step {step.number}: {line}"


def _is_a_verb(line: str) -> bool:
    """``kit quiz``, without anything more, names a verb and is no command to copy."""
    return line in {f"kit {verb}" for verb in VERBS}


def test_every_outcome_is_carried_and_once_described() -> None:
    carried = Counter(each for name in NAMES for each in kit_lesson(name).outcome_ids)
    assert set(carried) == set(read_outcomes())


@pytest.mark.daily(4)
@pytest.mark.long
@pytest.mark.parametrize(("name", "exercise"), EXERCISES, ids=[f"{name}-{each}" for name, each in EXERCISES])
def test_every_misconception_is_told_what_stands_beside_it(name: str, exercise: str, tmp_path: Path) -> None:
    """First of all, and of a criterion that it was written to lose. One that cannot be read gets no hint: its message names
    the line."""
    _, task = exercise_of(name, exercise)
    assignment = read_assignment(task.folder)
    solutions, ending = solutions_folder() / name / exercise, Path(assignment.submit).suffix
    own = {each.id: (*each.hints, *(one.hint for one in each.mistakes)) for each in assignment.criteria}
    wanted = told_words(name, exercise)
    others = {}
    for each in list_wrong_works(solutions / "wrong", ending):
        work = written_out(each, solutions / f"solution{ending}", tmp_path)
        result = grade(
            assignment,
            read_submission(work, assignment.submit),
            GradingOptions(Level.LIMITED, secret=True, examples=True),
        ).for_student()
        lost = next(one for one in result.tests if not one.is_passed)
        assert lost.id in each.name.partition("__")[0].split("+"), each.name
        assert lost.rationale, each.name
        is_unread = lost.status == "student_error"
        assert is_unread or (lost.hints and set(lost.hints) <= set(own[lost.id])), (each.name, lost.rationale)
        told = " ".join([lost.rationale, *lost.hints[:1]])
        if wanted[work_name(each)] not in " ".join(told.split()):
            others[each.name] = told
    assert others == {}


def told_words(name: str, exercise: str) -> dict[str, str]:
    """By wrong work: words of what its student must be told first, a reply, a hint or a message."""
    words: dict[str, str] = yaml.safe_load((MISCONCEPTIONS / name / f"{exercise}.yaml").read_text())
    return words


def work_name(work: Path) -> str:
    return work.name if work.is_dir() else work.stem


def test_words_stand_beside_every_misconception() -> None:
    for name, exercise in EXERCISES:
        wrong = solutions_folder() / name / exercise / "wrong"
        works = {work_name(each) for each in wrong.iterdir() if each.name[0] not in "._"}
        words = told_words(name, exercise)
        assert set(words) == works, exercise
        assert all(len(each.split()) >= 2 for each in words.values()), exercise
