"""JUnit XML: ``failure`` is the student's, ``error`` the grader's; points are in properties and in the message."""

from __future__ import annotations

from typing import Final
from xml.etree import ElementTree

from grader.reports.cleaning import clean_line, xml_text
from grader.reports.report_format import ReportFormat
from kit.results.grading_result import CriterionResult, CriterionStatus, GradingResult
from kit.results.result_blocks import format_points


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
        {"name": _attribute_text(result.assignment), **counts, "timestamp": result.timing.started},
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
        ElementTree.SubElement(properties, "property", {"name": name, "value": _attribute_text(value)})
    names: set[str] = set()
    for test in result.tests:
        _add_case(suite, test, result.assignment, names)
    ElementTree.indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def _add_case(suite: ElementTree.Element, test: CriterionResult, assignment: str, names: set[str]) -> None:
    name = clean_line(test.title, 120)
    while name in names:  # of two tests with one name GitLab keeps the first
        name += " (again)"
    names.add(name)
    case = ElementTree.SubElement(
        suite,
        "testcase",
        {"classname": _attribute_text(assignment), "name": _attribute_text(name), "time": "0"},
    )
    properties = ElementTree.SubElement(case, "properties")
    for key, points in () if test.is_withheld else (("points", test.points), ("max_points", test.max_points)):
        ElementTree.SubElement(properties, "property", {"name": key, "value": format_points(points)})
    earned = f"{format_points(test.points)} of {format_points(test.max_points)} points"
    message = _attribute_text(test.rationale if test.is_withheld else f"{earned}. {test.rationale}")
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


def _attribute_text(text: str) -> str:
    return xml_text(clean_line(text, 600))


FORMAT: Final = ReportFormat("junit", write_junit)
