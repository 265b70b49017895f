"""Writes how launch tests ended as xUnit XML, which CI systems read."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final
from xml.etree import ElementTree as ET

from kit.launch.launch_test import TestedCase, TestedLaunch
from kit.workspace import write_atomically

COUNTED: Final = {"failures": "failure", "errors": "error", "skipped": "skipped"}


def write_xunit(file: Path, package: str, name: str, tested: Sequence[TestedLaunch]) -> None:
    """Writes a file with one suite for each launch. Raises OSError."""
    root = ET.Element("testsuites", name=f"{package}.{name}")
    for launch in tested:
        cases = launch.cases or (_case_of_launch(launch),)
        suite = ET.SubElement(root, "testsuite", {"name": f"{package}.{name}.launch_tests{launch.suffix}"})
        suite.attrib |= _counts(cases) | {"time": f"{sum(case.seconds for case in cases):.3f}"}
        for case in cases:
            element = ET.SubElement(
                suite, "testcase", {"classname": f"{package}.{case.case}", "name": case.name}
            )
            element.set("time", f"{case.seconds:.3f}")
            if case.outcome != "passed":
                ET.SubElement(element, case.outcome, {"message": case.message})
    every = [case for launch in tested for case in launch.cases or (_case_of_launch(launch),)]
    for key, value in _counts(every).items():
        root.set(key, value)
    ET.indent(root)
    write_atomically(file, ET.tostring(root, encoding="utf-8", xml_declaration=True) + b"\n")


def _case_of_launch(launch: TestedLaunch) -> TestedCase:
    """What stands for the tests of a launch that has run none."""
    outcome = "error" if launch.is_failed else "skipped"
    return TestedCase("Launch", f"launch{launch.suffix}", 0.0, outcome, launch.reason)


def _counts(cases: Sequence[TestedCase]) -> dict[str, str]:
    counts = {key: sum(case.outcome == outcome for case in cases) for key, outcome in COUNTED.items()}
    return {"tests": str(len(cases))} | {key: str(count) for key, count in counts.items()}
