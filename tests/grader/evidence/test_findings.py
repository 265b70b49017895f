"""What was found about a submission is judged anew to the same result, whatever has changed in what it is worth."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from grader import grading
from grader.assignment import Assignment
from grader.cohort.queue import Queue, judge_anew, prepare_queue
from grader.evidence.findings import Findings
from grader.grading import GradingOptions, grade, grade_and_keep, judge_findings
from grader.kinds.contract import kind_names
from grader.new_assignment import example_of_kind, make_assignment
from grader.reading import read_assignment
from grader.self_test import WorkRole, works_of, written_out
from grader.submission import Submission, read_submission
from kit.host.sandbox.sandbox_config import Level
from tests.grader.conftest import FORWARD, QUICK, write_assignment

DESK = GradingOptions(Level.LIMITED)
OWN_TEST = (
    'import pytest\n\n@pytest.mark.points(2, hints=["Go."])\ndef test_far(grading):\n    """Too near."""\n'
    '    assert all(drive.score.distance_m > 0.5 for drive in grading.evidence("moves"))\n'
)


def own(folder: Path) -> Path:
    write_assignment(folder, QUICK + "tests: [test_own.py]\n", "seeds: {turn: [4001, 4002]}\n")
    (folder / "test_own.py").write_text(OWN_TEST)
    return folder


def forward(speed: float) -> str:
    return FORWARD.replace("SPEED = 0.3", f"SPEED = {speed}")


def handed_in() -> Submission:
    return Submission("ada", "controller.py", {"controller.py": forward(0.3).encode()})


def through_json(findings: Findings | None) -> Findings:
    assert findings is not None
    return Findings.from_dict(json.loads(json.dumps(findings.as_dict(), allow_nan=False)))


def edited(folder: Path, pattern: str, text: str, file: str = "assignment.yaml") -> Assignment:
    old = (folder / file).read_text()
    new = re.sub(pattern, text, old)
    assert new != old
    (folder / file).write_text(new)
    return read_assignment(folder)


@pytest.mark.parametrize(
    "options", [DESK, replace(DESK, secret=True), replace(DESK, secret=True, examples=True)]
)
@pytest.mark.parametrize(
    "text", [forward(0.3), forward(0.02), "1/0\n", "def main(:\n", "import no_such_package\n"]
)
def test_findings_give_the_same_result_again(options: GradingOptions, text: str, tmp_path: Path) -> None:
    assignment = read_assignment(own(tmp_path / "own"))
    submission = Submission("ada", "controller.py", {"controller.py": text.encode()})
    result, findings = grade_and_keep(assignment, submission, options)
    again = judge_findings(assignment, submission, options, through_json(findings))
    assert again is not None
    assert again.tests == result.tests
    assert (again.steps, again.secret_steps, again.level, again.verdict) == (
        result.steps,
        result.secret_steps,
        result.level,
        result.verdict,
    )


CHANGES: dict[str, Callable[[Path], Assignment]] = {
    "points": lambda folder: edited(folder, r"points: 3", "points: 7"),
    "the title of a criterion": lambda folder: edited(
        folder, r"check: moves", "check: moves, title: It goes"
    ),
    "the title": lambda folder: edited(folder, r"title: Drive on", "title: Go on"),
    "a comment": lambda folder: edited(folder, r"level: 0", "level: 0  # of anybody"),
    "hints": lambda folder: edited(folder, r"hints: \[one, two, three\]", "hints: [four]"),
    "what earns everything": lambda folder: edited(folder, r"full: 0.5", "full: 5"),
    "visibility": lambda folder: edited(folder, r"check: reached", "check: reached, visibility: after_due"),
    "a criterion less": lambda folder: edited(folder, r"  - \{check: reached.*\n", ""),
    "the mark of a test": lambda folder: edited(folder, r"points\(2", "points(5", "test_own.py"),
    "the words of a test": lambda folder: edited(folder, r"Too near", "Not far", "test_own.py"),
}
"""Changes after which no program is run again."""


@pytest.mark.parametrize("change", CHANGES)
def test_what_is_judged_anew_is_what_a_new_grading_gives(
    change: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = own(tmp_path / "own")
    before = read_assignment(folder)
    _, findings = grade_and_keep(before, handed_in(), DESK)
    after = CHANGES[change](folder)
    assert after.evidence_version == before.evidence_version
    assert after.version != before.version
    truth = grade(after, handed_in(), DESK)
    monkeypatch.setattr(grading, "open_grading", None)  # nothing can be run
    again = judge_findings(after, handed_in(), DESK, through_json(findings))
    assert again is not None
    assert again.tests == truth.tests


@pytest.mark.parametrize(
    ("pattern", "text", "file"),
    [
        (r"time: 4", "time: 5", "assignment.yaml"),
        (r"seeds: \[1\]", "seeds: [2]", "assignment.yaml"),
        (r"level: 0", "level: 0\nbudget: {cpu: 30}", "assignment.yaml"),
        (r"4001", "4003", "secret.yaml"),
    ],
)
def test_what_decides_the_drives_changes_the_version(
    pattern: str, text: str, file: str, tmp_path: Path
) -> None:
    folder = own(tmp_path / "own")
    before = read_assignment(folder).evidence_version
    assert edited(folder, pattern, text, file).evidence_version != before


@pytest.mark.parametrize(
    ("pattern", "text", "file"),
    [
        (r"check: reached", "check: in_time", "assignment.yaml"),
        (r"> 0.5", "> 0.6", "test_own.py"),
    ],
)
def test_a_question_that_was_never_asked_is_not_guessed(
    pattern: str, text: str, file: str, tmp_path: Path
) -> None:
    folder = own(tmp_path / "own")
    _, findings = grade_and_keep(read_assignment(folder), handed_in(), DESK)
    assert (
        judge_findings(edited(folder, pattern, text, file), handed_in(), DESK, through_json(findings)) is None
    )


@pytest.mark.long_cases(
    "controller", "environment", "field", "launch", "policy", "reward", "task", "training", "world"
)
@pytest.mark.parametrize("kind", kind_names())
def test_every_kind_is_judged_anew(kind: str, tmp_path: Path) -> None:
    make_assignment(example_of_kind(kind), tmp_path / "new")
    assignment = replace(read_assignment(tmp_path / "new"), level=Level.LIMITED)
    options = GradingOptions(Level.LIMITED, secret=True)
    works = [each for each in works_of(assignment) if each.role is not WorkRole.STARTER]
    for number, work in enumerate(works[:3]):
        (tmp_path / str(number)).mkdir()
        file = written_out(work.file, work.solution, tmp_path / str(number))
        submission = read_submission(file, assignment.submit)
        result, findings = grade_and_keep(assignment, submission, options)
        again = judge_findings(assignment, submission, options, through_json(findings))
        assert again is not None
        assert again.tests == result.tests


def test_a_changed_word_regrades_a_class_without_a_program(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = own(tmp_path / "own")
    (tmp_path / "in").mkdir()
    for number in range(3):
        text = FORWARD.replace("SPEED = 0.3", f"SPEED = {0.1 * number}")
        (tmp_path / "in" / f"s{number}.py").write_text(text)
    options = replace(DESK, may_lower_level=False)
    queue = Queue(tmp_path / "queue")
    prepare_queue(queue, tmp_path / "in", read_assignment(folder), options)
    assert judge_anew(queue) == 0
    for key in queue.waiting():
        queue.run_job(key)
    after = edited(folder, "points: 3", "points: 4")
    monkeypatch.setattr(grading, "open_grading", None)
    prepare_queue(queue, tmp_path / "in", after, options)
    assert len(queue.waiting()) == 3
    assert judge_anew(queue) == 3
    assert queue.waiting() == ()
    results = [queue.result(entry.key or "") for entry in queue.entries()]
    assert {result.max_points for result in results if result is not None} == {9}
    files = sorted((queue.folder / "findings").iterdir())
    whole = json.loads(files[0].read_bytes())
    files[0].write_bytes(files[1].read_bytes())  # a worker has put another's there
    shutil.rmtree(queue.folder / "results")
    prepare_queue(queue, tmp_path / "in", after, options)
    assert judge_anew(queue) == 2
    odd = [
        {name: value} for name in ("evidence", "outcomes", "collected", "pieces") for value in ([1], "a", 1)
    ]
    odd += [
        {"pieces": [{**whole["pieces"][0], "measures": dict.fromkeys(whole["pieces"][0]["measures"], "a")}]}
    ]
    damages = [json.dumps(whole | each).encode() for each in odd]
    for damage in (b"", b"{}", b'{"level": 1e999}', b"[" * 100_000, *damages):
        files[0].write_bytes(damage)
        shutil.rmtree(queue.folder / "results")
        prepare_queue(queue, tmp_path / "in", after, options)
        assert judge_anew(queue) == 2, damage[:300]
    for damage in (b"", b"{}", b'{"level": 1e999}', b"[" * 100_000):
        for file in (queue.folder / "findings").iterdir():
            file.write_bytes(damage)
        shutil.rmtree(queue.folder / "results")
        prepare_queue(queue, tmp_path / "in", after, options)
        assert judge_anew(queue) == 0
