"""Exit codes: what a script may count on."""

from __future__ import annotations

from typing import Final

from kit.document.blocks import CellStyle, Chapter, Column, Table
from kit.help.topic import HelpTopic, Shelf, chapter

CODES: Final = (
    ("0", "It did what was asked.", "kit world check on a good world"),
    (
        "1",
        "It ran, and the answer is no: a check not passed, a controller or a training that failed, a plan of too many layers.",
        "grader check on work that does not pass",
    ),
    (
        "2",
        (
            "It could not begin or go on: an argument is wrong, a file cannot be read or written, or has mistakes. "
            "Standard error says which, and the way out."
        ),
        "kit run with a map that does not exist",
    ),
    (
        "3",
        (
            "No answer because of the machine or the kit: the grader itself failed, so that there is no grade. "
            "Never count it against a student."
        ),
        "grader check where the grader failed",
    ),
    (
        "129",
        "The terminal went away (SIGHUP). What was recorded so far is kept.",
        "a connection that is gone",
    ),
    ("130", "Ctrl-C (SIGINT). What was recorded so far is kept.", "Ctrl-C in kit run"),
    ("143", "It was asked to end (SIGTERM). What was recorded so far is kept.", "the end of a cluster's job"),
)
"""Code, meaning, an example."""


def _chapters() -> tuple[Chapter, ...]:
    columns = (
        Column("Code", CellStyle.TEXT),
        Column("Meaning", CellStyle.TEXT),
        Column("For example", CellStyle.TEXT),
    )
    return (
        chapter(
            "Codes of kit and grader",
            Table("exit-codes", "", columns, CODES),
            """
`kit COMMAND --help` and `grader COMMAND --help` say what 1 and 3 mean for one command where that is not plain:
`kit layers check` ends with 3 if the layers are right but not the fewest, a bridge that could not shut down with 3.

Results go to standard output, everything else to standard error; `--json`, where a command has it, prints the result for
programs. After Ctrl-C, a sweep, a cohort and a test go on where they were when the same command is typed again.
""",
        ),
    )


TOPIC: Final = HelpTopic("Exit codes", "what a script may count on", Shelf.REFERENCE, _chapters)
