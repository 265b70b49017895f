"""The report formats: text, JSON, JUnit XML, Gradescope, check50, Classroom 50, GitHub Classroom and annotations, PrairieLearn,
and Markdown.

In JUnit XML ``failure`` is the student's, ``error`` the grader's; points are in properties and in the message. Gradescope gets
plain text, never HTML or markup.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator, Mapping
from datetime import UTC, datetime
from pathlib import PurePosixPath
from types import MappingProxyType
from typing import Any, Final
from xml.etree import ElementTree

from grader.reports.cleaning import clean_line, escape_markdown, fenced_block, plain, xml_text
from kit.document.blocks import Block, Text
from kit.document.layout import lines_of, text_blocks
from kit.results.grading_result import (
    CriterionResult,
    CriterionStatus,
    GradingResult,
    GradingVerdict,
    Visibility,
)
from kit.results.result_blocks import (
    INDENT,
    VERDICT_TEXTS,
    criterion_blocks,
    format_points,
    points_text,
    rounded_points,
)

LOG_LINES = 8
"""Lines of a program's output shown."""


def write_text(result: GradingResult, *, hints: int = 1) -> str:
    """Writes the result for people, in the lines of the kit's own renderer, with the totals and the notices below: printable
    characters only. ``hints``: how many hints of a criterion to show."""
    return "\n".join(lines_of(_blocks(result, hints))) + "\n"


def _blocks(result: GradingResult, hints: int) -> list[Block]:
    # What the JSON report shows of a result is clean: no terminal escapes, no commands of a CI runner.
    shown = GradingResult.from_dict(json.loads(write_json(result)))
    more_hints = f"For more help, add --hints {hints + 1}."
    blocks: list[Block] = []
    for test in shown.tests:
        blocks += criterion_blocks(test, hints=hints, more_hints=more_hints, log_lines=LOG_LINES)
        if test.teacher_note:
            note = clean_line(f"With secret seeds: {test.teacher_note}", 600)
            blocks.append(Text(note, indent=INDENT, is_tight=True))
    points = "No grade" if shown.points is None else f"{points_text(shown.points, shown.max_points)} points"
    fingerprint = f"{shown.submission[:8]}-{shown.assignment_version[:8]}"
    return [
        *blocks,
        Text(f"{points}. {VERDICT_TEXTS[shown.verdict]}"),
        *text_blocks(map(clean_line, shown.notices)),
        Text(f"level {shown.level}, seeds {shown.seeds}, fingerprint {fingerprint}", is_tight=True),
    ]


def write_json(result: GradingResult) -> str:
    """Writes the whole result as JSON, with cleaned texts."""
    return json.dumps(_clean_json(result.as_dict()), indent=2, sort_keys=True, allow_nan=False) + "\n"


def _clean_json(content: Any) -> Any:
    if isinstance(content, str):
        return plain(content, 20_000)
    if isinstance(content, dict):
        return {key: _clean_json(value) for key, value in content.items()}
    if isinstance(content, (list, tuple)):
        return [_clean_json(value) for value in content]
    return content


def write_check50(result: GradingResult) -> str:
    """Writes JSON as check50 does: ``passed`` is true, false, or null where nothing is known."""
    result = result.for_student()
    content = {
        "slug": clean_line(result.assignment),
        "version": result.grader_version,
        "results": [_check50_test(test) for test in result.tests],
    }
    return json.dumps(content, indent=2, allow_nan=False) + "\n"


def _check50_test(test: CriterionResult) -> dict[str, Any]:
    cause: dict[str, Any] | None = None
    if test.status is not CriterionStatus.PASS:
        cause = {"rationale": plain(test.rationale), "help": plain(test.hints[0]) if test.hints else None}
        if test.actual:
            cause |= {"expected": clean_line(test.expected), "actual": clean_line(test.actual)}
    return {
        "name": clean_line(test.id),
        "description": clean_line(test.title),
        "passed": test.status is CriterionStatus.PASS if test.is_judged else None,
        "log": plain(test.log).splitlines()[:100],
        "cause": cause,
        "data": {}
        if test.is_withheld
        else {"points": rounded_points(test.points), "max_points": test.max_points, **test.metrics},
        "dependency": test.depends_on,
    }


MAX_CLASSROOM_OUTPUT: Final = 500
"""Characters of output that Classroom keeps."""


def write_classroom(result: GradingResult) -> str:
    """Writes GitHub Classroom's runner result (version 3): the JSON whose base64 is a step's output ``result``.

    ``tests`` and ``max_score`` are always present, since its reporter reads them even if the run failed.
    """
    result = result.for_student()  # the log of the job is the student's to read
    content: dict[str, Any] = {
        "version": 3,
        "status": {GradingVerdict.PASS: "pass", GradingVerdict.FAIL: "fail", GradingVerdict.BROKEN: "error"}[
            result.verdict
        ],
        "max_score": round(result.max_points),
        "tests": []
        if result.verdict is GradingVerdict.BROKEN
        else [_classroom_test(test) for test in result.tests],
    }
    if result.verdict is GradingVerdict.BROKEN:
        content["message"] = "The grader failed. You lost no points: tell your teacher."
    return json.dumps(content, separators=(",", ":"), allow_nan=False)


def _classroom_test(test: CriterionResult) -> dict[str, Any]:
    earned = f" ({format_points(test.points)}/{format_points(test.max_points)})"
    return {
        "name": clean_line(test.title, 120) + ("" if test.is_withheld else earned),
        "status": "" if test.is_withheld else "pass" if test.status is CriterionStatus.PASS else "fail",
        "score": rounded_points(test.points),
        "message": clean_line(test.rationale, MAX_CLASSROOM_OUTPUT - 20),
        "output": plain(
            "\n".join(part for part in (test.rationale, *test.hints[:1]) if part), MAX_CLASSROOM_OUTPUT - 20
        ),
        "duration": 0,
    }


CLASSROOM50_VARIABLES: Final[Mapping[str, str]] = MappingProxyType(
    {
        "classroom": "CLASSROOM",
        "assignment": "ASSIGNMENT",
        "submission": "SUBMISSION_TAG",
        "commit": "COMMIT_URL",
        "release": "RELEASE_URL",
        "review": "REVIEW_URL",
    }
)
"""What Classroom 50's runner says in the environment, by the key of the result."""


def write_classroom50(result: GradingResult) -> str:
    """Writes the ``result.json`` of Classroom 50 (``classroom50/result/v1``), inside its runner, which says in the environment
    what it is about, and stamps the owner itself.

    A broken grader writes no score: the runner refuses that, and nobody gets 0.
    """
    result = result.for_student()
    told = {key: os.environ.get(name, "") for key, name in CLASSROOM50_VARIABLES.items()}
    told["review"] = told["review"] or told["commit"]
    tests = [
        {
            "test-name": clean_line(test.title, 120) + (" (shown later)" if test.is_withheld else ""),
            "passed": test.is_passed,
            "score": _whole_if_possible(test.points),
            "max-score": _whole_if_possible(test.max_points),
        }
        for test in result.tests
    ]
    started = datetime.fromisoformat(result.timing.started) if result.timing.started else datetime.now(UTC)
    content = {
        "schema": "classroom50/result/v1",
        **told,
        "datetime": started.astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "score": None if result.points is None else _whole_if_possible(result.points),
        "max-score": _whole_if_possible(result.max_points),
        "tests": tests,
    }
    return json.dumps(content, indent=2, allow_nan=False) + "\n"


def _whole_if_possible(points: float) -> float:
    rounded = rounded_points(points)
    return int(rounded) if float(rounded).is_integer() else rounded


MAX_ANNOTATIONS: Final = 10
"""Of each kind; GitHub shows no more of one step."""
_PLACE: Final = re.compile(r"(?P<file>[A-Za-z0-9_./-]+):(?P<line>\d+): ")


def write_annotations(result: GradingResult, work: str = "") -> str:
    """Writes GitHub's workflow commands: an annotation for each lost criterion, at the student's line where one is known.

    ``work``: the file or folder that was graded, relative to the repository.
    """
    result = result.for_student()
    lines = []
    for test in result.tests:
        if test.is_passed or not test.is_judged:
            continue
        place = _PLACE.match(test.rationale)
        where = {"title": clean_line(f"{test.title}: {points_text(test.points, test.max_points)}", 120)}
        if place is not None:
            folder = work if work and not PurePosixPath(work).suffix else str(PurePosixPath(work).parent)
            where = {"file": str(PurePosixPath(folder) / place["file"]), "line": place["line"], **where}
        told = ",".join(f"{key}={_escaped(value, is_property=True)}" for key, value in where.items())
        text = _escaped(plain("\n".join((test.rationale, *test.hints[:1])), 1000))
        lines.append(f"::{'warning' if test.points else 'error'} {told}::{text}")
    kinds = {
        kind: [line for line in lines if line.startswith(f"::{kind}")][:MAX_ANNOTATIONS]
        for kind in ("error", "warning")
    }
    points = (
        "no grade" if result.points is None else f"{points_text(result.points, result.max_points)} points"
    )
    later = [test.title for test in result.tests if test.is_withheld]
    points += f"; shown later: {clean_line(', '.join(later))}" if later else ""
    kinds["notice"] = [
        f"::notice title={_escaped(clean_line(result.assignment), is_property=True)}::{_escaped(points)}"
    ]
    return "".join(f"{line}\n" for each in kinds.values() for line in each)


def _escaped(text: str, *, is_property: bool = False) -> str:
    """What a workflow command may hold: nothing in it ends the command, or begins another."""
    for sign, code in (("%", "%25"), ("\r", "%0D"), ("\n", "%0A")):
        text = text.replace(sign, code)
    return text.replace(":", "%3A").replace(",", "%2C") if is_property else text


NOT_RUN: Final = (CriterionStatus.STUDENT_ERROR, CriterionStatus.SKIPPED)


def write_prairielearn(result: GradingResult) -> str:
    """Writes PrairieLearn's ``results.json``. Work that could not run at all is not gradable, which costs no attempt."""
    result = result.for_student()
    content: dict[str, Any] = {"gradable": True, "output": plain("\n".join(result.notices))}
    stopped = all(test.status in NOT_RUN for test in result.tests) and any(
        test.status is CriterionStatus.STUDENT_ERROR for test in result.tests
    )
    if result.verdict is GradingVerdict.BROKEN:
        content |= {"gradable": False, "message": "The grader failed. You lost no points: tell your teacher."}
    elif stopped:
        first = next(test for test in result.tests if test.status is CriterionStatus.STUDENT_ERROR)
        content |= {"gradable": False, "format_errors": [plain(first.rationale)]}
    else:
        most = result.max_points
        content["score"] = 0.0 if not most or result.points is None else min(1.0, result.points / most)
        content["tests"] = [_prairielearn_test(test) for test in result.tests]
    return json.dumps(content, indent=2, allow_nan=False) + "\n"


def _prairielearn_test(test: CriterionResult) -> dict[str, Any]:
    points = (
        {} if test.is_withheld else {"points": rounded_points(test.points), "max_points": test.max_points}
    )
    return {
        "name": clean_line(test.title),
        "description": clean_line(test.rationale),
        **points,
        "message": plain("\n".join(f"hint: {hint}" for hint in test.hints[:1])),
        "output": plain(test.log) + (f"\n{test.replay}" if test.replay else ""),
    }


def write_markdown(result: GradingResult) -> str:
    """Writes a job summary in Markdown: a table, the rationales and the worst episode."""
    return "\n".join(_markdown_lines(result.for_student())) + "\n"


def _markdown_lines(result: GradingResult) -> Iterator[str]:
    points = (
        "no grade"
        if result.points is None
        else f"{format_points(result.points)} of {format_points(result.max_points)} points"
    )
    yield f"## {escape_markdown(result.assignment)}: {points}"
    yield ""
    yield "| Test | Outcome | Points |"
    yield "| --- | --- | ---: |"
    for test in result.tests:
        earned = f"{test.status.value} | {format_points(test.points)}/{format_points(test.max_points)}"
        yield f"| {escape_markdown(test.title)} | {'later |' if test.is_withheld else earned} |"
    for test in result.tests:
        if test.rationale and test.status is not CriterionStatus.PASS:
            yield ""
            yield f"**{escape_markdown(test.title)}**: {escape_markdown(test.rationale, 600)}"
            for hint in test.hints[:1]:
                yield f"\nHint: {escape_markdown(hint, 600)}"
    worst = next((test for test in result.tests if test.replay), None)
    if worst is not None:
        yield ""
        yield fenced_block(worst.replay)
    for notice in result.notices:
        yield ""
        yield f"_{escape_markdown(notice)}_"


def write_junit(result: GradingResult) -> str:
    result = result.for_student()  # it lies beside the job's log, which is the student's to read
    broken = sum(test.status is CriterionStatus.GRADER_ERROR for test in result.tests)
    skipped = sum(test.status is CriterionStatus.SKIPPED for test in result.tests)
    failed = sum(test.is_judged and test.status is not CriterionStatus.PASS for test in result.tests)
    counts = {
        "tests": str(len(result.tests)),
        "failures": str(failed),
        "errors": str(broken),
        "skipped": str(skipped),
        "time": f"{result.timing.wall_s:.3f}",
    }
    root = ElementTree.Element("testsuites", {"name": "grader", **counts})
    suite = ElementTree.SubElement(
        root,
        "testsuite",
        {"name": _attribute(result.assignment), **counts, "timestamp": result.timing.started},
    )
    properties = ElementTree.SubElement(suite, "properties")
    for name, value in (
        ("points", "none" if result.points is None else format_points(result.points)),
        ("max_points", format_points(result.max_points)),
        ("verdict", result.verdict.value),
        ("level", str(result.level)),
        ("seeds", result.seeds),
        ("submission", result.submission),
        ("assignment_version", result.assignment_version),
    ):
        ElementTree.SubElement(properties, "property", {"name": name, "value": _attribute(value)})
    names: set[str] = set()
    for test in result.tests:
        _case(suite, test, result.assignment, names)
    ElementTree.indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def _case(suite: ElementTree.Element, test: CriterionResult, assignment: str, names: set[str]) -> None:
    name = clean_line(test.title, 120)
    while name in names:  # of two tests with one name GitLab keeps the first
        name += " (again)"
    names.add(name)
    case = ElementTree.SubElement(
        suite, "testcase", {"classname": _attribute(assignment), "name": _attribute(name), "time": "0"}
    )
    properties = ElementTree.SubElement(case, "properties")
    for key, points in () if test.is_withheld else (("points", test.points), ("max_points", test.max_points)):
        ElementTree.SubElement(properties, "property", {"name": key, "value": format_points(points)})
    earned = f"{format_points(test.points)} of {format_points(test.max_points)} points"
    message = _attribute(test.rationale if test.is_withheld else f"{earned}. {test.rationale}")
    if test.status is CriterionStatus.SKIPPED:
        ElementTree.SubElement(case, "skipped", {"message": message})
    elif test.status is CriterionStatus.GRADER_ERROR:
        ElementTree.SubElement(
            case, "error", {"type": test.status.value, "message": message}
        ).text = xml_text(test.log)
    elif test.status is not CriterionStatus.PASS:
        text = "\n".join(part for part in (test.rationale, *test.hints[:1]) if part)
        ElementTree.SubElement(
            case, "failure", {"type": test.status.value, "message": message}
        ).text = xml_text(text)
    if test.log and test.is_judged:
        ElementTree.SubElement(case, "system-out").text = xml_text(test.log)


def _attribute(text: str) -> str:
    return xml_text(clean_line(text, 600))


VISIBILITY_NAMES: Final[Mapping[Visibility, str]] = MappingProxyType(
    {
        Visibility.VISIBLE: "visible",
        Visibility.AFTER_DUE: "after_due_date",
        Visibility.AFTER_PUBLISHED: "after_published",
        Visibility.HIDDEN: "hidden",
    }
)


def write_gradescope(result: GradingResult) -> str:
    """Writes Gradescope's ``results.json``.

    Students see the tests whose visibility allows it: Gradescope withholds the others until it is time, and adds up the
    points by the same rules, so that no total is written where a test is not visible.

    A broken grader writes no score at all: Gradescope then reports the run as failed, and nobody gets 0.
    """
    result = result.without_secrets()
    content: dict[str, Any] = {
        "execution_time": round(result.timing.wall_s, 2),
        "output": plain("\n".join(result.notices)),
        "output_format": "text",
        "test_output_format": "text",
        "test_name_format": "text",
        "visibility": "visible",
        "stdout_visibility": "hidden",
        "extra_data": {
            "submission": result.submission,
            "assignment_version": result.assignment_version,
            "level": result.level,
            "seeds": result.seeds,
            "verdict": result.verdict.value,
        },
    }
    if result.verdict is GradingVerdict.BROKEN:
        content["output"] = "The grader failed. You lost no points: tell your teacher; it will run again."
    else:
        if all(test.visibility is Visibility.VISIBLE for test in result.tests):
            content["score"] = None if result.points is None else rounded_points(result.points)
        content["tests"] = [_test(number, test) for number, test in enumerate(result.tests, 1)]
    return json.dumps(content, indent=2, allow_nan=False) + "\n"


def _test(number: int, test: CriterionResult) -> dict[str, Any]:
    parts = [test.rationale]
    if test.actual and test.status is not CriterionStatus.PASS:
        parts.append(f"expected {test.expected}, got {test.actual}")
    parts += [f"hint: {hint}" for hint in test.hints[:1]]
    if test.log and test.is_judged:
        parts.append(f"what it printed:\n{test.log}")
    # The picture is the grader's own; cleaning would destroy its layout.
    score = {} if test.is_withheld else {"score": rounded_points(test.points), "max_score": test.max_points}
    outcome = {"status": "passed" if test.status is CriterionStatus.PASS else "failed"}
    output = "\n".join(plain(part) for part in parts if part) + (f"\n\n{test.replay}" if test.replay else "")
    return {
        "name": clean_line(test.title),
        "number": str(number),
        **score,
        **({} if test.is_withheld else outcome),
        "output": output,
        "output_format": "text",
        "name_format": "text",
        "tags": [] if test.is_withheld else [test.status.value],
        "visibility": VISIBILITY_NAMES[test.visibility],
    }
