"""Results that workers leave in a queue: one that is malformed, too large, late or another job's counts for nothing."""

from __future__ import annotations

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
from grader.cohort.gradebook import WAITING, gradebook_rows
from grader.cohort.queue import Queue, _incident_result, prepare_queue
from grader.grading import GradingOptions
from grader.reading import read_assignment
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
