"""A teacher's own marks: points, extra points and comments of single students, in one YAML file that no regrade touches.

``ada@uni.example: {points: {reached: 4}, comments: {reached: "Within a hand."}, extra: 1, comment: "Neat.", final: 7}``: all
optional, by the student's e-mail address, id, login, name or group. A mark that no longer fits is reported with its line, and
left out.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from kit.world.documents import open_document

MAX_POINTS = 1e6


@dataclass(frozen=True, slots=True)
class ManualMark:
    """What a teacher has decided for one student."""

    location: str
    """File and line, for messages."""
    points: Mapping[str, float] = field(default_factory=dict)
    """By criterion, instead of the grader's."""
    comments: Mapping[str, str] = field(default_factory=dict)
    """By criterion."""
    extra: float = 0.0
    """Points on top; below 0 they are taken away."""
    comment: str = ""
    final: float | None = None
    """The final points, after lateness; None leaves what is computed."""


def read_marks(file: Path) -> Mapping[str, ManualMark]:
    """Reads the marks by student. Raises WorldError with all mistakes of the file."""
    with open_document(file) as section:
        marks = {}
        for student in section.keys():  # noqa: SIM118  # a section is no mapping
            given = section.section(student)
            points, comments = given.section("points", None), given.section("comments", None)
            marks[student] = ManualMark(
                str(given.location),
                {}
                if points is None
                else {each: points.number(each, minimum=0, maximum=MAX_POINTS) for each in points.keys()},  # noqa: SIM118
                {} if comments is None else {each: comments.text(each) for each in comments.keys()},  # noqa: SIM118
                given.number("extra", 0.0, minimum=-MAX_POINTS, maximum=MAX_POINTS),
                given.text("comment", ""),
                given.number("final", minimum=0, maximum=MAX_POINTS) if given.has("final") else None,
            )
            given.finish()
        return marks
