"""The gradebook in the forms that learning platforms import: Moodle's grading worksheet, Canvas's gradebook.

Where the roster is an export of that platform, its own rows come back with the grade filled in, so that the platform finds every
student by its own numbers. Who has no grade gets none, never 0.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Final

from grader.cohort.gradebook import GradebookRow, as_csv, comment_text, late_text
from grader.cohort.roster import Roster
from grader.reports.cleaning import clean_line
from kit.plain_text import without_formula
from kit.results.result_blocks import format_points

MOODLE_GRADE: Final = "Grade"
MOODLE_MOST: Final = ("Maximum Grade", "Maximum grade")
MOODLE_FEEDBACK: Final = "Feedback comments"
MOODLE_COLUMNS: Final = ("Full name", "ID number", "Email address", MOODLE_GRADE, MOODLE_FEEDBACK)
"""Of a roster that is not Moodle's: for the import into its gradebook, by e-mail address or id number."""
CANVAS_COLUMNS: Final = ("Student", "ID", "SIS User ID", "SIS Login ID", "Section")
CANVAS_MOST: Final = "    Points Possible"


def for_moodle(
    table: Sequence[GradebookRow], roster: Roster | None, title: str, most: float, *, decimal_comma: bool
) -> str:
    """Returns Moodle's grading worksheet with grades and feedback; of another roster a table for its gradebook's import."""
    number = _number_writer(decimal_comma=decimal_comma)
    if roster is None or MOODLE_GRADE not in roster.titles or MOODLE_FEEDBACK not in roster.titles:
        rows = [
            [
                clean_line(row.name),
                "" if row.student is None else row.student.id,
                "" if row.student is None else row.student.email,
                number(row.final),
                feedback_text(row),
            ]
            for row in table
        ]
        return _table_text(MOODLE_COLUMNS, rows)
    places = {title: i for i, title in enumerate(roster.titles)}
    by_student = {row.student: row for row in table if row.student is not None}
    found = []
    for index, cells in enumerate(roster.rows):
        written = [*cells, *[""] * (len(roster.titles) - len(cells))]
        row = by_student.get(roster.students[index]) if index in roster.students else None
        if row is not None:
            written[places[MOODLE_GRADE]] = number(row.final)
            written[places[MOODLE_FEEDBACK]] = feedback_text(row)
            for each in MOODLE_MOST:
                if each in places:
                    written[places[each]] = written[places[each]] or number(most)
        found.append(written)
    return _table_text(roster.titles, found)


def for_canvas(
    table: Sequence[GradebookRow], roster: Roster | None, title: str, most: float, *, decimal_comma: bool
) -> str:
    """Returns a file for Canvas's gradebook import: the five columns that it knows students by, and the assignment's.

    The assignment's column is that of the roster whose title begins like the assignment's, with Canvas's number behind it.
    """
    number = _number_writer(decimal_comma=decimal_comma)
    if roster is None or roster.platform != "canvas":
        head = (*CANVAS_COLUMNS, clean_line(title))
        rows = [[CANVAS_MOST, *[""] * 4, number(most)]]
        for row in table:
            known = row.student
            rows.append(
                [
                    clean_line(row.name),
                    "" if known is None else known.number,
                    "" if known is None else known.id,
                    "" if known is None else known.login or known.email,
                    "",
                    number(row.final),
                ]
            )
        return _table_text(head, rows)
    column = next(
        (each for each in roster.titles if each.casefold().startswith(title.casefold())), clean_line(title)
    )
    kept = [i for i, each in enumerate(roster.titles) if each in (*CANVAS_COLUMNS, "Root Account")]
    by_student = {row.student: row for row in table if row.student is not None}
    rows = []
    for index, cells in enumerate(roster.rows):
        if not any(cell.strip() for cell in cells):
            continue
        written = [cells[i] if i < len(cells) else "" for i in kept]
        graded = by_student.get(roster.students[index]) if index in roster.students else None
        is_most = cells[0].strip().casefold() == CANVAS_MOST.strip().casefold()
        rows.append([*written, number(most) if is_most else "" if graded is None else number(graded.final)])
    return _table_text([*(roster.titles[i] for i in kept), column], rows)


def for_spreadsheet(
    table: Sequence[GradebookRow], roster: Roster | None, title: str, most: float, *, decimal_comma: bool
) -> str:
    """Returns the whole gradebook as CSV; with a decimal comma, columns are separated by semicolons."""
    return as_csv(table, decimal_comma=decimal_comma)


GradebookWriter = Callable[..., str]

EXPORTS: Final[Mapping[str, GradebookWriter]] = MappingProxyType(
    {"csv": for_spreadsheet, "moodle": for_moodle, "canvas": for_canvas}
)
"""(rows, roster, title, most points, ``decimal_comma``) -> the file's text, by platform."""


def feedback_text(row: GradebookRow) -> str:
    """What a student reads beside the grade, in one line: lateness, comments, and why points were lost."""
    return clean_line(" ".join(filter(None, (comment_text(row), late_text(row), row.feedback))), 1000)


def _number_writer(*, decimal_comma: bool) -> Callable[[float | None], str]:
    def write(number: float | None) -> str:
        text = "" if number is None else format_points(number)
        return text.replace(".", ",") if decimal_comma else text

    return write


def _table_text(titles: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Formats a table whose texts are no formulas, those of the platform's own export neither: students chose some of them."""
    out = io.StringIO()
    # In quotes, a cell stays one cell where another sign than the comma separates them.
    writer = csv.writer(out, lineterminator="\r\n", quoting=csv.QUOTE_ALL)
    writer.writerows([without_formula(cell) for cell in row] for row in (titles, *rows))
    return out.getvalue()
