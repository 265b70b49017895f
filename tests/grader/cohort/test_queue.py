"""Results that workers leave in a queue: one that is malformed, too large, late or another job's counts for nothing."""

from __future__ import annotations

import base64
import json
import os
import random
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from grader.__main__ import main
from grader.cohort.class_findings import attention_blocks
from grader.cohort.gradebook import WAITING, gradebook_rows
from grader.cohort.queue import Queue, QueueError, _incident_result, prepare_queue
from grader.grading import GradingOptions
from grader.reading import read_assignment
from kit.document.blocks import Text
from kit.host.job_executors import MAX_RESULT_BYTES
from kit.host.job_folder import JobExecutor
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import CriterionStatus, GradingResult, GradingVerdict
from tests.fuzz.damage import damage_json, nudge_json
from tests.grader.conftest import FORWARD, write_assignment


@pytest.fixture
def queue(tmp_path: Path) -> Queue:
    works = tmp_path / "in"
    works.mkdir()
    for number in range(2):
        (works / f"s{number}.py").write_text(FORWARD + f"# {number}\n")
    made = Queue(tmp_path / "queue")
    assignment = read_assignment(write_assignment(tmp_path / "quick"))
    prepare_queue(made, works, assignment, GradingOptions(Level.FILTERED, may_lower_level=False))
    return made


def passed(queue: Queue, key: str) -> GradingResult:
    """The result of a worker that found no fault."""
    result = _incident_result(queue, key)
    tests = tuple(
        replace(each, status=CriterionStatus.PASS, points=each.max_points, rationale="")
        for each in result.tests
    )
    return replace(result, tests=tests)


def saved(queue: Queue, key: str) -> dict[str, Any]:
    """What the worker's file holds."""
    queue.save_result(key, passed(queue, key))
    content: dict[str, Any] = json.loads(queue.result_file(key).read_bytes())
    assert queue.result(key) == passed(queue, key)
    return content


DAMAGES: dict[str, Callable[[dict[str, Any]], Any]] = {
    "no object": lambda content: [content],
    "nothing of it": lambda content: {},
    "another schema": lambda content: content | {"schema": 2},
    "words for a level": lambda content: content | {"level": "1"},
    "another level": lambda content: content | {"level": 0},
    "another assignment": lambda content: content | {"assignment_version": "0" * 64},
    "another submission": lambda content: content | {"submission": "0" * 64},
    "another grader": lambda content: content | {"grader_version": "9"},
    "secrets": lambda content: content | {"seeds": "public+secret"},
    "no criterion": lambda content: content | {"tests": []},
    "a criterion twice": lambda content: content | {"tests": content["tests"] * 2},
    "a text for criteria": lambda content: content | {"tests": "passed"},
    "more points": lambda content: content | {"tests": [content["tests"][0] | {"max_points": 1e6}, *content["tests"][1:]]},
    "points in words": lambda content: content | {"tests": [content["tests"][0] | {"points": "all"}]},
    "negative points": lambda content: content | {"tests": [content["tests"][0] | {"points": -1.0}, *content["tests"][1:]]},
    "points beyond the most": lambda content: content | {"tests": [content["tests"][0] | {"points": 99.0}, *content["tests"][1:]]},
    "points without end": lambda content: content | {"tests": [content["tests"][0] | {"points": 10**400}]},
    "a list for a title": lambda content: content | {"tests": [content["tests"][0] | {"title": ["x"]}]},
    "hints in one text": lambda content: content | {"tests": [content["tests"][0] | {"hints": "abc"}]},
    "an unknown field": lambda content: content | {"tests": [content["tests"][0] | {"bonus": 1.0}]},
    "an unknown status": lambda content: content | {"tests": [content["tests"][0] | {"status": "excellent"}]},
    "timing without words": lambda content: content | {"timing": []},
    "notices of numbers": lambda content: content | {"notices": [1]},
}  # fmt: skip


def test_a_result_that_is_none_or_another_jobs_is_not_read(queue: Queue) -> None:
    key, _ = queue.waiting()
    content = saved(queue, key)
    read = []
    for name, damage in DAMAGES.items():
        queue.result_file(key).write_text(json.dumps(damage(content)))
        if queue.result(key) is not None or not queue.is_waiting(key):
            read.append(name)
    assert read == []


TEXTS: dict[str, bytes] = {
    "nothing": b"",
    "half": b'{"schema": 1, "tests": [',
    "not UTF-8": b"\xff\xfe{}",
    "deep": b"[" * 100_000,
}


def test_a_file_that_is_no_result_is_not_read(queue: Queue) -> None:
    key, _ = queue.waiting()
    whole = json.dumps(saved(queue, key)).encode()
    file = queue.result_file(key)
    texts = {
        **TEXTS,
        "not a number": re.sub(rb'"wall_s": [^,}]+', b'"wall_s": NaN', whole),
        "infinite": re.sub(rb'"wall_s": [^,}]+', b'"wall_s": 1e999', whole),
        "too large": whole + b" " * (MAX_RESULT_BYTES + 1 - len(whole)),
    }
    assert len(set(texts.values())) == len(texts)
    for name, text in texts.items():
        file.write_bytes(text)
        assert queue.is_waiting(key), name
    file.unlink()
    os.mkfifo(file)
    assert queue.is_waiting(key), "a named pipe holds nobody"
    file.unlink()
    file.mkdir()
    assert queue.is_waiting(key)
    file.rmdir()
    file.write_bytes(whole + b" " * (MAX_RESULT_BYTES - len(whole)))
    assert not queue.is_waiting(key), "the largest that is read"


def test_the_result_of_another_submission_gives_it_no_grade(queue: Queue) -> None:
    first, second = queue.waiting()
    saved(queue, first)
    queue.result_file(second).write_bytes(queue.result_file(first).read_bytes())
    assert queue.waiting() == (second,)
    assert sorted(row.verdict for row in gradebook_rows(queue)) == ["pass", WAITING]


@pytest.mark.parametrize("way", [damage_json, nudge_json])
def test_whatever_is_changed_in_a_result_it_is_read_or_made_again(
    way: Callable[[random.Random, Any], Any], queue: Queue
) -> None:
    """Never an error; and what is read is a row of the gradebook."""
    key, _ = queue.waiting()
    content, rng = saved(queue, key), random.Random(39)
    for _ in range(300):
        queue.result_file(key).write_text(json.dumps(way(rng, content)))
        result = queue.result(key)
        if result is not None:
            assert result.points is None or 0 <= result.points <= queue.assignment().max_points
            assert result.as_dict()
            assert len(gradebook_rows(queue)) == 2


def test_a_result_that_is_not_read_is_named_with_its_file(queue: Queue) -> None:
    first, second = queue.waiting()
    for key in (first, second):
        saved(queue, key)
    queue.result_file(second).write_bytes(queue.result_file(first).read_bytes())
    (told,) = (row.note for row in gradebook_rows(queue) if row.verdict == WAITING)
    assert str(queue.result_file(second)) in told
    assert any(
        told in each.text for each in attention_blocks(gradebook_rows(queue)) if isinstance(each, Text)
    )
    queue.result_file(second).unlink()
    assert not attention_blocks(gradebook_rows(queue)), "a job that nobody has graded yet is no fault"


JOBS: dict[str, Callable[[dict[str, Any]], Any]] = {
    "no object": lambda content: [content],
    "nothing of it": lambda content: {},
    "another main file": lambda content: content | {"main": "x.py"},
    "another text": lambda content: content | {"files": {content["main"]: base64.b64encode(b"x").decode()}},
    "no text": lambda content: content | {"files": {content["main"]: "%"}},
    "outside": lambda content: content | {"files": {"../../x.py": content["files"][content["main"]]}, "main": "../../x.py"},
    "a list": lambda content: content | {"files": list(content["files"])},
    "numbers": lambda content: content | {"files": {content["main"]: 1}},
}  # fmt: skip


def test_a_job_that_is_damaged_or_another_works_is_not_graded_and_is_written_again(
    queue: Queue, tmp_path: Path
) -> None:
    key, other = queue.waiting()
    whole = queue.job(key).read_bytes()
    texts = {name: json.dumps(damage(json.loads(whole))).encode() for name, damage in JOBS.items()}
    for name, text in {**TEXTS, **texts, "another work": queue.job(other).read_bytes()}.items():
        queue.job(key).write_bytes(text)
        with pytest.raises(QueueError, match=key):
            queue.run_job(key)
        queue.record_loss(key)  # a worker that dies of it twice
        assert queue.is_waiting(key), name
        prepare_again(queue, tmp_path)
        assert queue.job(key).read_bytes() == whole, name
    queue.job(key).unlink()
    os.mkfifo(queue.job(key))
    with pytest.raises(QueueError, match=key):
        queue.run_job(key)
    prepare_again(queue, tmp_path)
    assert queue.submission(key).digest


def prepare_again(queue: Queue, folder: Path) -> None:
    options = GradingOptions(Level.FILTERED, may_lower_level=False)
    prepare_queue(queue, folder / "in", read_assignment(folder / "quick"), options)


MANIFESTS: dict[str, Callable[[dict[str, Any]], Any]] = {
    "no object": lambda content: [content],
    "nothing of it": lambda content: {},
    "more": lambda content: content | {"more": 1},
    "a word for a level": lambda content: content | {"level": "1"},
    "no level": lambda content: content | {"level": 9},
    "entries in one text": lambda content: content | {"entries": "abc"},
    "a key that is a path": lambda content: content | {"entries": [content["entries"][0] | {"key": "../../x"}]},
    "a key that is a number": lambda content: content | {"entries": [content["entries"][0] | {"key": 1}]},
    "an entry with more": lambda content: content | {"entries": [content["entries"][0] | {"more": 1}]},
    "names in one text": lambda content: content | {"passed_over": "abc"},
}  # fmt: skip


@pytest.mark.parametrize("command", ["gradebook", "work"])
def test_a_manifest_that_cannot_be_read_is_named_and_written_again(
    command: str, queue: Queue, tmp_path: Path
) -> None:
    file = queue.folder / "manifest.json"
    whole = file.read_bytes()

    def assert_refused(name: str) -> None:
        run = CliRunner().invoke(main, [command, str(queue.folder)])
        assert (run.exit_code, str(file) in run.output) == (2, True), (name, run.exception)

    for name, text in TEXTS.items():
        file.write_bytes(text)
        assert_refused(name)
    for name, damage in MANIFESTS.items():
        file.write_text(json.dumps(damage(json.loads(whole))))
        assert_refused(name)
    file.unlink()
    os.mkfifo(file)
    assert_refused("a named pipe")
    prepare_again(queue, tmp_path)
    assert file.read_bytes() == whole


def test_a_copy_of_the_assignment_that_cannot_be_read_is_said_and_made_again(
    queue: Queue, tmp_path: Path
) -> None:
    (queue.assignment_folder / "assignment.yaml").write_text("id: [}")
    for command in ("gradebook", "work"):
        run = CliRunner().invoke(main, [command, str(queue.folder)])
        assert (run.exit_code, "assignment.yaml:1" in run.output) == (2, True), run.exception
    prepare_again(queue, tmp_path)
    assert queue.assignment().version == read_assignment(tmp_path / "quick").version


def test_a_worker_with_another_version_of_the_grader_says_so(
    queue: Queue, monkeypatch: pytest.MonkeyPatch
) -> None:
    key, _ = queue.waiting()
    monkeypatch.setattr("grader.cohort.queue.grader_version", lambda: "9.9")
    with pytest.raises(QueueError, match=r"9\.9: install the same"):
        queue.run_job(key)


def test_work_says_what_is_left_without_a_result(queue: Queue, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(JobExecutor, "run", lambda executor, queue, keys, on_done: saved(queue, keys[0]))
    run = CliRunner().invoke(main, ["work", str(queue.folder)])
    assert (run.exit_code, run.output) == (3, "1 graded, 1 without a result\n")
    run = CliRunner().invoke(main, ["work", str(queue.folder)])
    assert (run.exit_code, run.output) == (0, "1 graded\n")


def test_what_lies_in_the_place_of_a_result_is_replaced_and_nothing_behind_it_is_touched(
    queue: Queue, tmp_path: Path
) -> None:
    first, second = queue.waiting()
    others = tmp_path / "others"
    others.write_text("mine")
    queue.result_file(first).symlink_to(others)
    os.mkfifo(queue.result_file(second))
    for key in (first, second):
        saved(queue, key)
    assert others.read_text() == "mine"
    assert queue.waiting() == ()


def test_no_verdict_is_lost_by_one_that_comes_late(queue: Queue) -> None:
    key, other = queue.waiting()
    saved(queue, key)
    queue.record_loss(key)  # the worker saved it and died before it could say so
    queue.save_result(key, _incident_result(queue, key))  # another worker that was given the job as well
    result = queue.result(key)
    assert result is not None
    assert result.verdict is GradingVerdict.PASS
    queue.record_loss(other)
    saved(queue, other)  # late, but a verdict
    assert {row.verdict for row in gradebook_rows(queue)} == {"pass"}


def test_who_has_no_result_after_all_workers_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assignment = write_assignment(tmp_path / "quick")
    works = tmp_path / "in"
    works.mkdir()
    (works / "a.py").write_text(FORWARD)
    monkeypatch.setattr(JobExecutor, "run", lambda executor, queue, keys, on_done: None)
    command = [
        "cohort",
        str(works),
        "--assignment",
        str(assignment),
        "--queue",
        str(tmp_path / "q"),
        "--level",
        "1",
    ]
    run = CliRunner().invoke(main, command)
    assert (run.exit_code, "run the same command" in run.output) == (3, True)
    prepared = CliRunner().invoke(main, [*command, "--executor", "none"])
    assert prepared.exit_code == 0, "it waits for shards"
