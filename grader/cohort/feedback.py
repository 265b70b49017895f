"""A page for each student: the verdict, what earned which points, the worst run as a picture, and what to try next.

Made of what the student may see now; as HTML that needs no network, and as Markdown.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

from grader.assignment import Assignment
from grader.cohort.gradebook import MISSING, GradebookRow, late_text
from grader.cohort.queue import Queue
from grader.cohort.statistics import class_document
from grader.look_alikes import look
from grader.reports.cleaning import clean_line
from grader.reports.formats.json_report import write_json
from kit.document.blocks import Block, Chapter, Document, Picture, Text, Tone
from kit.document.html import document_to_html
from kit.document.markdown import document_to_markdown
from kit.results.grading_result import GradingResult
from kit.results.result_blocks import VERDICT_TEXTS, criterion_blocks, points_text, replay_lines
from kit.workspace import make_private_folder, write_atomically

PAGE_NAME: Final = re.compile(r"[^\w.@-]+")
WRITERS: Final = ((".html", document_to_html), (".md", document_to_markdown))
CLASS_PAGE: Final = "_class"
INDEX: Final = "_pages.json"


def write_feedback(queue: Queue, table: Sequence[GradebookRow], folder: Path) -> int:
    """Writes the pages of all students into the folder, the page on the class, and a list of whose page is which. Returns
    how many students have one. Raises OSError."""
    make_private_folder(folder)
    assignment = queue.assignment()
    keys = {entry.name: entry.key for entry in queue.entries()}
    pages: dict[str, str] = {}
    for row in table:
        key = keys.get(row.work)
        result = None if key is None else queue.result(key)
        name = _page_name(row, pages)
        pages[name] = clean_line(row.name)
        _write_feedback(folder, name, student_document(assignment, row, result))
    _write_feedback(folder, CLASS_PAGE, class_document(assignment, table))
    write_atomically(folder / INDEX, (json.dumps(pages, indent=1, ensure_ascii=False) + "\n").encode())
    return len(pages)


def _write_feedback(folder: Path, name: str, document: Document) -> None:
    for ending, writer in WRITERS:
        write_atomically(folder / f"{name}{ending}", writer(document).encode())


def _page_name(row: GradebookRow, taken: dict[str, str]) -> str:
    """A file name for a student, which no other has: the login, id or e-mail address, else the name."""
    known = row.student
    text = row.name if known is None else known.login or known.id or known.email or row.name
    base = PAGE_NAME.sub("-", look(text)).strip("-._")[:80] or "student"
    name, number = base, 1
    while name in taken:
        number += 1
        name = f"{base}-{number}"
    return name


def student_document(assignment: Assignment, row: GradebookRow, result: GradingResult | None) -> Document:
    """Returns one student's page, under the title of the assignment."""
    shown = None if result is None else GradingResult.from_dict(json.loads(write_json(result.for_student())))
    chapters = [Chapter("grade", clean_line(row.name), tuple(_grade_blocks(row, shown)))]
    if shown is not None:
        chapters.append(Chapter("criteria", "What earned which points", tuple(_criteria_blocks(row, shown))))
        if picture := replay_lines(shown.tests):
            chapters.append(Chapter("run", "Your worst run", (Picture(tuple(picture)),)))
        if next_steps := list(_next_steps(shown)):
            chapters.append(Chapter("next", "What to try next", tuple(next_steps)))
    return Document(assignment.title, tuple(chapters))


def _grade_blocks(row: GradebookRow, result: GradingResult | None) -> Iterator[Block]:
    if row.verdict == MISSING:
        yield Text("Nothing of yours has been handed in.", Tone.BOLD)
    elif result is None:
        yield Text("There is no grade yet.", Tone.BOLD)
        yield Text(row.note)
    else:
        yield Text(VERDICT_TEXTS[result.verdict], Tone.BOLD)
    withheld = result is not None and any(test.is_withheld for test in result.tests)
    if row.final is not None and not withheld:
        yield Text(f"{points_text(row.final, row.max_points)} points.")
    elif withheld:
        yield Text("Some of it is shown later, and so is the sum.")
    if row.late:
        yield Text(row.late if withheld else late_text(row))
    if row.extra:
        yield Text(
            f"Your teacher has {'added' if row.extra > 0 else 'taken away'} {abs(row.extra):g} points."
        )
    if comment := row.comments.get("", ""):
        yield Text(clean_line(comment, 2000), lead="Your teacher:")


def _criteria_blocks(row: GradebookRow, result: GradingResult) -> Iterator[Block]:
    for test in result.tests:
        yield from criterion_blocks(test)
        if test.id in row.marked and not test.is_withheld:
            points = points_text(row.tests[test.id], test.max_points)
            yield Text(f"{points} points.", lead="Set by your teacher:", indent=5, is_tight=True)
        if (comment := row.comments.get(test.id, "")) and not test.is_withheld:
            yield Text(clean_line(comment, 2000), lead="Your teacher:", indent=5, is_tight=True)


def _next_steps(result: GradingResult) -> Iterator[Block]:
    """The hints for the first criterion that was lost: one thing at a time."""
    lost = next((each for each in result.tests if not each.is_passed and each.is_judged), None)
    if lost is None:
        return
    yield Text(f"Begin with “{' '.join(lost.title.split())}”.")
    yield from (Text(hint) for hint in lost.hints)
