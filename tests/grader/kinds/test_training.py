"""Settings of a training: what is read of them, what they are refused for, and what is said of what came out."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from grader.evidence.contract import EvidenceOptions, EvidenceRecord
from grader.evidence.training_results import (
    CaseOrder,
    StopRule,
    TrainingResult,
    TrainingResults,
    TrainingSettings,
)
from grader.grading import GradingOptions, grade
from grader.kinds.contract import read_submitted_yaml
from grader.kinds.training import kind as training
from grader.kinds.training.kind import CHECKS, StepsUsedParams, _read_settings, collect_evidence
from grader.reading import read_assignment
from grader.submission import Submission
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import CriterionStatus
from kit.school.lessons.reading import lessons_folder
from kit.world.problems import WorldError

ASSIGNMENT_TEXT = """
title: A table
kind: training
submit: training.yaml
level: 0
training: {task: turn, reward: progress, scale: 1.0, steps: 20000, seeds: [1, 2], episodes: 50}
checks:
  - {check: succeeds, points: 1}
  - {check: every_case, points: 1}
  - {check: reliable, points: 1}
  - {check: honest, points: 1}
  - {check: steps_used, points: 1}
"""
DESK = EvidenceOptions(Level.LIMITED, secret=False)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "table"
    made.mkdir()
    (made / "assignment.yaml").write_text(ASSIGNMENT_TEXT)
    return made


def trained(folder: Path, text: str, conditions: EvidenceOptions = DESK) -> EvidenceRecord:
    file = folder.parent / "training.yaml"
    file.write_text(text)
    return collect_evidence(read_assignment(folder), file, conditions)


@pytest.mark.long
def test_the_same_settings_make_the_same_trainings(folder: Path) -> None:
    one, two = (trained(folder, "batch: 5000\nsteps: 10000\n").content for _ in range(2))
    assert one == two
    assert [each.steps for each in one.trainings] == [10_000, 10_000]
    assert all(len(each.tests) == 2 for each in one.trainings)


@pytest.mark.long
def test_secret_seeds_take_the_place_of_the_others(folder: Path) -> None:
    text = "batch: 5000\nsteps: 5000\n"
    public = trained(folder, text).content
    (folder / "secret.yaml").write_text("seeds: [7]\n")
    record = trained(folder, text, EvidenceOptions(Level.LIMITED, secret=True))
    assert record.secret, "what these trainings show is not for students"
    secret = record.content
    assert len(secret.trainings) == 1
    assert secret.trainings[0].tests != public.trainings[0].tests


@pytest.mark.parametrize("is_own_check", [True, False])
def test_a_students_own_check_says_what_secret_trainings_found(folder: Path, is_own_check: bool) -> None:
    """They were shown while they ran, and no others are made; a grade at a level that confines says nothing of them."""
    (folder / "secret.yaml").write_text("seeds: [7]\n")
    assignment = read_assignment(folder)
    work = Submission("work", "training.yaml", {"training.yaml": b"batch: 1000\nsteps: 1000\n"})
    level = Level.LIMITED if is_own_check else Level.FILTERED
    progress: list[str] = []
    options = GradingOptions(level, secret=True, examples=is_own_check, show_progress=progress.append)
    found = grade(assignment, work, options)
    assert sum("exam: " in line and "tests" not in line for line in progress) == 1, progress
    told = next(each for each in found.tests if each.id == "succeeds")
    assert not told.is_passed
    assert ("The exams of the trainings: 0.28." in told.rationale) is is_own_check
    assert bool(told.actual) is is_own_check
    assert bool(told.replay) is is_own_check


@pytest.mark.long
def test_who_learns_one_side_only_fails_on_the_other(folder: Path) -> None:
    seen: TrainingResults = trained(folder, "train_on: [turn_a_to_b]\nbatch: 10000\n").content
    assert seen.worst_case == "turn_b_to_a"
    assert seen.pooled_count("turn_a_to_b").share - seen.pooled_count("turn_b_to_a").share > 0.2
    assert seen.success_lower_bound() < sum(seen.pooled_count(case).share for case in seen.budget.cases) / 2


def test_a_first_good_test_stops(folder: Path) -> None:
    seen: TrainingResults = trained(folder, "batch: 1000\ntest_episodes: 2\nstop: first\ngoal: 0.5\n").content
    assert seen.settings.stop is StopRule.FIRST
    assert any(each.steps < 20_000 for each in seen.trainings)
    assert all(each.claimed >= 0.5 for each in seen.trainings if each.steps < 20_000)


@pytest.mark.long
def test_the_best_policy_is_the_one_of_the_best_test(folder: Path) -> None:
    text = "batch: 2000\ntest_episodes: 100\nlearning_rate: [0.9, 0.9]\nkeep: {}\n"
    best, newest = (trained(folder, text.format(keep)).content for keep in ("best", "newest"))
    assert sum(each.accuracy for each in best.trainings) > sum(each.accuracy for each in newest.trainings)


@pytest.mark.long
def test_one_after_the_other_learns_both_halves_of_the_steps(folder: Path) -> None:
    seen: TrainingResults = trained(folder, "batch: 5000\norder: apart\n").content
    assert seen.settings.order is CaseOrder.APART
    first, last = seen.trainings[0].tests[0], seen.trainings[0].tests[-1]
    assert last.counts["turn_b_to_a"].share > first.counts["turn_b_to_a"].share
    assert "turn_a_to_b" in seen.picture()


@pytest.mark.long
def test_the_newest_policy_counts_for_what_is_remembered(folder: Path) -> None:
    """Keeping an older policy does not help one whose last training pushed out the first."""
    text = "batch: 5000\ntest_episodes: 100\nkeep: best\norder: {}\nlearning_rate: [0.3, {}]\n"
    apart, mixed = (
        CHECKS["remembers"].measure(trained(folder, text.format(*words)), None)
        for words in (("apart", 0.3), ("mixed", 0.02))
    )
    assert apart < mixed
    assert CHECKS["remembers"].anchors.share(apart) == 0.0


@pytest.mark.long
def test_a_training_is_tested_so_often_at_most(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(training, "MAX_TESTS", 10)
    text = "steps: 6005\nworlds: 5\ntest_episodes: 2\nbatch: {}\n"  # tests may fall on every fifth step
    refused = trained(folder, text.format(600)).failure
    assert refused is not None
    assert "at least 601" in refused.message
    seen: TrainingResults = trained(folder, text.format(601)).content
    assert [len(each.tests) for each in seen.trainings] == [10, 10]


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("", "empty"),
        ("batch: [", "YAML"),
        ("batch: 10", "at least"),
        ("batch: 5000\nsteps: 99999999", "at most"),
        ("batch: 5000\nstopp: first", "stop"),
        ("batch: 5000\nalgorithm: ppo", "q-learning"),
        ("batch: 5000\nlearning_rate: [2, 0]", "between 0 and 1"),
        ("batch: 5000\nlearning_rate: .nan", "list"),
        ("batch: 5000\ntrain_on: [left]", "turn_a_to_b"),
        ("batch: 5000\nedges: [0.3, 0.2]", "rise"),
        ("batch: 5000\nedges: [0.1, 0.2, 0.3, 0.4, 0.5]", "at most"),
        ("batch: 5000\nworlds: 257", "at most"),
        ("batch: 5000\ntest_episodes: 2001", "at most"),
        ("batch: !!python/object:os.system {}", "training.yaml"),
    ],
    ids=lambda value: value.splitlines()[-1] if value else "empty",
)
def test_what_cannot_be_trained_is_told_with_its_place(folder: Path, text: str, word: str) -> None:
    result = grade(
        read_assignment(folder),
        Submission("ada", "training.yaml", {"training.yaml": text.encode()}),
        GradingOptions(Level.LIMITED),
    )
    assert {test.status for test in result.tests} == {CriterionStatus.STUDENT_ERROR}
    assert word in result.tests[0].rationale
    assert "/tmp" not in result.tests[0].rationale


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("task: turn", "task: trun", "turn"),
        ("reward: progress", "reward: progres", "progress"),
        ("seeds: [1, 2]", "seeds: [1.5]", "whole number"),
        ("steps: 20000", "steps: 20000, algorithms: [q]", "no algorithm"),
        ("steps: 20000", "steps: 20000, algorithms: [ppo, sac]", "smooth-turn"),
    ],
)
def test_a_teachers_mistake_is_told_when_read(folder: Path, old: str, new: str, message: str) -> None:
    (folder / "assignment.yaml").write_text(ASSIGNMENT_TEXT.replace(old, new))
    with pytest.raises(WorldError, match=message):
        read_assignment(folder)


LOADED = """
import sys
from pathlib import Path
from grader.grading import GradingOptions, grade
from grader.reading import read_assignment
from grader.submission import read_submission
from kit.host.sandbox.sandbox_config import Level

sheet, file = map(Path, sys.argv[1:])
assignment = read_assignment(sheet)
result = grade(assignment, read_submission(file, assignment.submit), GradingOptions(Level.LIMITED))
assert result.points == 0, result
print(*sorted({"numba", "networkx", "torch", "pymunk", "PIL"} & sys.modules.keys()))
"""


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("exercise", "name"),
    [("12-training-strategies/forget", "training.yaml"), ("24-train-your-own/pays", "task.yaml")],
)
def test_yaml_that_cannot_be_read_loads_nothing_of_learning(exercise: str, name: str, tmp_path: Path) -> None:
    """A slip in the YAML of a training or a task is told in half a second."""
    file = tmp_path / name
    file.write_text("key:value\nother: [1, 2\n")
    done = subprocess.run(
        [sys.executable, "-c", LOADED, lessons_folder() / exercise, file],
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == ""


@pytest.mark.parametrize(
    ("is_stopped", "goal", "used"), [(True, 0.9, 0.25), (False, 0.9, 1.0), (True, 0.01, 1.0)]
)
def test_only_a_test_with_a_goal_saves_steps(
    folder: Path, *, is_stopped: bool, goal: float, used: float
) -> None:
    """A number of steps that went well with the seeds that were tried is no rule to stop."""
    settings = read_assignment(folder).task
    file = folder.parent / "training.yaml"
    file.write_text(f"batch: 5000\ngoal: {goal}\n")
    plan = read_submitted_yaml(file, lambda section: _read_settings(section, settings))
    assert isinstance(plan, TrainingSettings)
    trainings = (TrainingResult(1, 5_000, (), 1.0, {}, is_stopped),)
    evidence = EvidenceRecord(TrainingResults(settings, plan, trainings))
    assert CHECKS["steps_used"].measure(evidence, StepsUsedParams()) == used
