"""Every report says the same, and none carries out what a student wrote."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from xml.etree import ElementTree

import pytest

from grader.reports import FORMATS, cleaning
from grader.reports.formats.annotations import write_annotations
from grader.reports.formats.classroom import MAX_CLASSROOM_OUTPUT
from grader.reports.formats.classroom50 import write_classroom50
from kit.plain_text import without_formula
from kit.results.grading_result import CriterionResult, CriterionStatus, GradingResult, Visibility
from tests.cases import every_case

NASTY = {
    "workflow command": "::set-output name=result::x",
    "workflow command, later line": "fine\n   ::notice title=Autograding report::{}",
    "workflow command, colons left over": ":::add-mask::::x",
    "old command": "see ##[error]no",
    "azure command": "##vso[task.setvariable variable=x]y",
    "escape": "\x1b[2J\x1b]0;title\x07",
    "8-bit escape": "\x9b2J",
    "html": "<script>alert(1)</script><img src=x onerror=y>",
    "link": "[click](javascript:alert(1)) ![](http://x/y.png)",
    "mention": "@everyone @teacher",
    "fence": "```\n# out of the block\n```",
    "table": "a | b |\n| --- | --- |",
    "formula": '=HYPERLINK("http://x","y")',
    "right to left": "\u202egnp.exe",
    "nul": "a\x00b\ufffe\uffff",
    "lone surrogate": "\ud800",
    "cdata": "]]> &amp; <!-- -->",
}


def result(text: str, status: CriterionStatus = CriterionStatus.FAIL) -> GradingResult:
    nasty = CriterionResult(
        "reached",
        text,
        status,
        1.0,
        2.0,
        rationale=text,
        hints=(text, text),
        expected=text,
        actual=text,
        log=text,
    )
    hidden = CriterionResult(
        "h", "Hidden one", CriterionStatus.FAIL, 0.0, 1.0, Visibility.HIDDEN, rationale="s3cret", log="s3cret"
    )
    return GradingResult("reach", "v", "abc", "0.1", "public", 1, "linux", (nasty, hidden), (text,))


@every_case("text", NASTY.values(), ids=NASTY)
@every_case("form", FORMATS)
def test_what_a_student_wrote_gives_no_orders(form: str, text: str) -> None:
    report = FORMATS[form].write(result(text))
    report.encode("utf-8")
    for line in report.splitlines():
        if form == "annotations":  # each line is a command of its own, and nothing in it another
            assert re.match("::(error|warning|notice) ", line)
            line = line[2:].replace("::", "", 1)
        assert "::" not in line
        assert "##[" not in line
        assert "##vso[" not in line
    assert all(sign.isprintable() or sign == "\n" for sign in report)
    assert "\\u001b" not in report
    assert "\\u202e" not in report


@every_case("text", NASTY.values(), ids=NASTY)
def test_xml_and_json_can_be_read_again(text: str) -> None:
    root = ElementTree.fromstring(FORMATS["junit"].write(result(text)))
    assert (root.attrib["failures"], root.attrib["skipped"]) == ("1", "1"), "the hidden one is no failure"
    for form in ("json", "gradescope", "classroom", "prairielearn", "check50"):
        json.loads(FORMATS[form].write(result(text)))
    assert GradingResult.from_dict(json.loads(FORMATS["json"].write(result(text)))).points == 1.0


@every_case("text", NASTY.values(), ids=NASTY)
def test_markdown_stays_text(text: str) -> None:
    report = FORMATS["markdown"].write(result(text))
    assert "<" not in report.replace("&lt;", "")
    assert "@" not in report
    assert "](" not in report.replace("\\]\\(", "")
    rows = [line for line in report.splitlines() if line.startswith("| ") and "---" not in line]
    assert len(rows) == 3
    assert all(row.replace("\\|", "").count("|") == 4 for row in rows)


def test_a_block_of_code_cannot_be_left() -> None:
    block = cleaning.fenced_block("``` ````\nx")
    fence = block.splitlines()[0].removesuffix("text")
    assert len(fence) == 5
    assert block.count(fence) == 2


@every_case("text", ["=1+1", "+1+1", "-1+1", "@x", "\t=1", "%x", "|x", "\uff1d1", "\uff20x"])
def test_a_spreadsheet_computes_nothing(text: str) -> None:
    assert not cleaning.spreadsheet_cell(text).startswith(tuple("=+@|%\uff1d\uff20"))
    assert without_formula(f"{text}()").startswith("'")


@every_case("sign", ["x", ":"])  # a row of colons gets spaces, so that no runner takes it for a command
def test_text_is_cut_at_its_limit_and_says_so(sign: str) -> None:
    whole = cleaning.plain(sign * 10, cleaning.MAX_TEXT)
    assert cleaning.plain(sign * 10, len(whole)) == whole
    for cut in (cleaning.plain(sign * 11, len(whole)), cleaning.plain(sign * 10, len(whole) - 1)):
        assert cut.endswith("(shortened)")
        assert len(cut) <= len(whole) + len(cleaning.CUT_MARK)
    assert len(cleaning.plain(sign * 100_000)) == cleaning.MAX_TEXT + len(cleaning.CUT_MARK)


@every_case("sign", ["x", ":"])
def test_classroom_gets_no_more_than_it_keeps(sign: str) -> None:
    for length in (100, MAX_CLASSROOM_OUTPUT, 10_000):
        test = json.loads(FORMATS["classroom"].write(result(sign * length)))["tests"][0]
        for text in (test["message"], test["output"]):
            assert len(text) <= MAX_CLASSROOM_OUTPUT
            assert text.endswith("(shortened)") == (length > 100)


@every_case("form", ["junit", "classroom", "prairielearn", "check50", "markdown"])
def test_reports_for_students_hide_what_is_hidden(form: str) -> None:
    report = FORMATS[form].write(result("no"))
    assert "s3cret" not in report
    assert "Hidden one" in report


def test_gradescope_gets_the_visibility_and_not_a_broken_grade() -> None:
    content = json.loads(FORMATS["gradescope"].write(result("no")))
    assert [test["visibility"] for test in content["tests"]] == ["visible", "hidden"]
    assert sum(test["score"] for test in content["tests"]) == 1.0
    assert "score" not in content, "a total would tell what a hidden test earned"
    open_result = result("no")
    content = json.loads(FORMATS["gradescope"].write(replace(open_result, tests=open_result.tests[:1])))
    assert content["score"] == 1.0
    broken = json.loads(FORMATS["gradescope"].write(result("no", CriterionStatus.GRADER_ERROR)))
    assert "score" not in broken
    assert "tests" not in broken


def test_classroom_always_gets_tests_and_a_maximum() -> None:
    for status, expected in ((CriterionStatus.PASS, "pass"), (CriterionStatus.GRADER_ERROR, "error")):
        content = json.loads(FORMATS["classroom"].write(result("no", status)))
        assert (content["status"], content["max_score"]) == (expected, 2)
        assert isinstance(content["tests"], list)


def test_prairielearn_does_not_grade_what_did_not_run() -> None:
    stopped = CriterionResult(
        "a", "A", CriterionStatus.STUDENT_ERROR, 0.0, 1.0, rationale="work.py:3: SyntaxError"
    )
    later = CriterionResult("b", "B", CriterionStatus.SKIPPED, 0.0, 1.0, depends_on="a")
    content = json.loads(
        FORMATS["prairielearn"].write(GradingResult("r", "v", "s", "g", "public", 1, "p", (stopped, later)))
    )
    assert content["gradable"] is False
    assert content["format_errors"] == ["work.py:3: SyntaxError"]
    assert json.loads(FORMATS["prairielearn"].write(result("no")))["score"] == pytest.approx(1 / 2)


def test_check50_tells_failed_from_unknown() -> None:
    assert [test["passed"] for test in json.loads(FORMATS["check50"].write(result("no")))["results"]] == [
        False,
        None,
    ]
    broken = json.loads(FORMATS["check50"].write(result("no", CriterionStatus.GRADER_ERROR)))["results"]
    assert broken[0]["passed"] is None


def test_junit_tells_a_failure_from_an_error() -> None:
    root = ElementTree.fromstring(FORMATS["junit"].write(result("no", CriterionStatus.GRADER_ERROR)))
    assert (root.attrib["failures"], root.attrib["errors"]) == ("0", "1")
    names = [case.attrib["name"] for case in root.iter("testcase")]
    assert len(set(names)) == len(names)


@every_case("form", [name for name in FORMATS if name != "json"])
def test_points_are_shown_with_at_most_two_decimals(form: str) -> None:
    part = replace(result("no").tests[0], points=1.234567)
    assert part.metrics == {}
    report = FORMATS[form].write(replace(result("no"), tests=(part,)))
    assert "1.2345" not in report


def plain_result(*tests: CriterionResult) -> GradingResult:
    return GradingResult("reach", "v", "abc", "0.1", "public", 1, "linux", tests)


def test_an_annotation_holds_nothing_that_ends_or_begins_a_command() -> None:
    test = CriterionResult(
        "a",
        "A,b: 100%::error::x",
        CriterionStatus.STUDENT_ERROR,
        0.0,
        2.0,
        rationale="controller.py:7: bad\n::set-output name=x::y % \r\n##[error]",
    )
    text = write_annotations(plain_result(test), "work/controller.py")
    lines = text.splitlines()
    assert len(lines) == 2
    assert lines[0].startswith("::error file=work/controller.py,line=7,title=A%2Cb%3A 100%25")
    assert lines[0].count("::") == 2
    assert "\r" not in text
    assert lines[1].startswith("::notice title=")


def test_there_are_no_more_annotations_than_are_shown() -> None:
    tests = [
        CriterionResult(f"t{i}", f"t{i}", CriterionStatus.FAIL, 0.0, 1.0, rationale="no") for i in range(30)
    ]
    assert write_annotations(plain_result(*tests)).count("::error") == 10


def test_a_broken_grader_gives_classroom50_no_score() -> None:
    broken = CriterionResult("a", "a", CriterionStatus.GRADER_ERROR, 0.0, 1.0)
    assert json.loads(write_classroom50(plain_result(broken)))["score"] is None
