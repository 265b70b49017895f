"""How to do what a teacher does: make an assignment, try it, grade, read what a class learned."""

from __future__ import annotations

from typing import Final

from kit.document.blocks import Chapter
from kit.help.topic import Shelf, Topic, chapter


def _chapters() -> tuple[Chapter, ...]:
    return (
        chapter(
            "Make an assignment",
            """
    grader new one
    grader self-test one
    grader checks controller
    grader check one/solution.py --assignment one

`new` makes one that works, with a starter, a solution, wrong solutions and secret seeds. Change the sheet `one/assignment.yaml`
step by step; `self-test` says after each step whether the starter runs, the solution earns everything, and each wrong solution
loses the criterion in its name. `kit help checks` lists all kinds of submission and what each check measures.
""",
        ),
        chapter(
            "Grade a folder",
            """
    grader cohort handed_in --assignment one --queue grades --secret
    grader gradebook grades

`handed_in` holds one file, folder or archive for each student. Programs run confined; what a level keeps them from is in
`kit doctor`. After Ctrl-C the same command goes on. What could not be read has no grade and a sentence why, never 0.
`grader gradebook --late FILE` applies late rules; `--against` prints what has changed since an earlier gradebook.
""",
        ),
        chapter(
            "Grade every push",
            """
    grader ci github --assignment one --kit https://example.org/kit@v0.2.0

prints the workflow; `gitlab` likewise, `--write` puts it into its place. Anyone who can push can change it, so these results are
for practice; the grade comes from `grader cohort`.
""",
        ),
        chapter(
            "Read what a class learned",
            """
    kit class guide
    kit class report answers

`answers` holds what students exported with `kit progress export FILE`. The report has what they knew and learned, what was hard,
and how sure each number is; `--html`, `--csv` and `--json` write it to files.
""",
        ),
        chapter(
            "Make a lesson",
            """
A lesson is a folder of texts and exercises. `kit lesson --check FOLDER` reports every mistake with its place,
`kit lesson --from FOLDER` opens it. `kit help packages` says how a package brings lessons, checks and kinds of its own.
""",
        ),
    )


TOPIC: Final = Topic(
    "For teachers", "make an assignment, grade, read what a class learned", Shelf.HOW_TO, _chapters
)
