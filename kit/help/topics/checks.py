"""Kinds of submission and the checks of each, as the grader's own command prints them: the kit does not import it."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Iterator, Mapping
from typing import Any, Final

from kit.document.blocks import CellStyle, Chapter, Column, Table
from kit.help.docstrings import docstring_blocks
from kit.help.topic import HelpTopic, Shelf, chapter
from kit.host.python_command import python_command

_COLUMNS: Final = tuple(
    Column(title, CellStyle.TEXT)
    for title in ("Check", "What a student reads", "No points, all points", "With")
)


def _chapters() -> tuple[Chapter, ...]:
    asked = python_command("grader", "checks", "--json")
    answer = json.loads(subprocess.run(asked, check=True, capture_output=True, text=True).stdout)
    return (
        chapter(
            "Kinds and checks",
            """
An assignment is a folder with a sheet, `assignment.yaml`, that names a kind of submission and its criteria; each criterion
names a check. `grader new FOLDER` makes a working one, `kit help teacher` goes on from there.

A check measures; between the two values below, points grow with the measure, and `share` in a criterion sets other values.
`with` in a criterion sets the parameters in the last column.
""",
            Table(
                "limits",
                "Limits of every program that runs, in the sheet's budget",
                (Column("Key", CellStyle.TEXT), Column("Meaning", CellStyle.TEXT)),
                tuple(answer["budget"].items()),
            ),
        ),
        *map(_kind_chapter, answer["kinds"]),
    )


def _kind_chapter(kind: Mapping[str, Any]) -> Chapter:
    table = Table(f"checks-{kind['kind']}", "", _COLUMNS, tuple(_check_rows(kind)))
    return chapter(f"Kind {kind['kind']}", *docstring_blocks(kind["about"]), table)


def _check_rows(kind: Mapping[str, Any]) -> Iterator[tuple[str, str, str, str]]:
    for each in kind["checks"]:
        anchors = f"{each['none']}; {each['full']}" if each["full"] else ""
        params = ", ".join(f"{name}: {default}" for name, default in each["with"].items())
        yield each["check"], each["feedback"], anchors, params


TOPIC: Final = HelpTopic(
    "Kinds of submission and their checks",
    "what the grader can grade, and what each check measures",
    Shelf.REFERENCE,
    _chapters,
)
