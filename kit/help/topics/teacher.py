"""How to do what a teacher does: make an assignment, hand it out, grade, give grades back, read what a class learned."""

from __future__ import annotations

from typing import Final

from kit.document.blocks import Chapter, Code
from kit.help.topic import HelpTopic, Shelf, chapter


def _chapters() -> tuple[Chapter, ...]:
    return (
        chapter(
            "Make an assignment",
            """
    grader new one
    grader self-test one --jobs 2
    grader help sheet
    grader checks controller
    grader check one/solution.py --assignment one

`new` makes one that works, with a starter, a solution, wrong solutions and secret seeds: `--kind` of another kind of submission,
`--from` of a lesson's exercise, such as `grader new two --from 11/your_reward`. Change the sheet `one/assignment.yaml` step by
step; `self-test` says after each step whether the starter runs, the solution earns everything, and each wrong solution loses
the criterion in its name. `grader help sheet` explains every key, `grader help tests` how to write tests of your own, and
`kit help checks` lists all kinds of submission and what each check measures.
""",
        ),
        chapter(
            "Hand it out",
            """
    grader release one --output one-for-students
    grader release one --output one.zip
    grader release one --output repo --repository --kit https://example.org/kit@v0.2.0

Students get everything but what stays with you: secret seeds, solution, wrong solutions, and criteria whose outcome they may
not see yet. It is refused where a secret would go out all the same: in another file, in an archive, as a passage of the
solution. They check their work with the public seeds, as often as they like.
""",
        ),
        chapter(
            "Grade a folder",
            """
    grader cohort handed_in --assignment one --queue grades --secret
    grader gradebook grades

`handed_in` holds one file, folder or archive for each student, as a platform's download has them. Moodle has two to fetch from
the assignment's page of submissions: "Download all submissions", which you unpack as `handed_in`, and "Download grading
worksheet", which is the roster below (tick "Offline grading worksheet" in the assignment's settings first). Programs run confined; what
a level keeps them from is in `kit doctor`. After Ctrl-C the same command goes on; after a change of words or points nothing is
run again. What could not be read has no grade and a sentence why, never 0. A cluster does the same with `--executor slurm`
and `--slurm account=NAME`, or `--executor dask`.
""",
        ),
        chapter(
            "Roster, late works, your own marks",
            """
    grader gradebook grades --roster class.csv --late late.yaml --times times.csv --json --output before.json
    grader gradebook grades --roster class.csv --statistics

The roster is your platform's export (Moodle's grading worksheet, Canvas's gradebook, Gradescope's or GitHub Classroom's
roster), or a table of your own with name, email, id, login and group. Who handed in nothing then has a row; what fits nobody is
said and stops nothing. `late.yaml` says when it was due, where a date alone is the end of that day:
""",
            Code(
                (
                    "due: 2026-11-30",
                    "zone: Europe/Lisbon",
                    "per_day: 0.1          # of the points, for each day begun",
                    "grace_days: 1         # costs nothing",
                    "extensions:",
                    "  ada@uni.example: 2026-12-07",
                    "  alan: {days: 2}",
                )
            ),
            "`marks.yaml` holds what you decide yourself. No regrade touches it, and what no longer fits is said:",
            Code(
                (
                    "ada@uni.example:",
                    "  points: {in_time: 2}",
                    "  comments: {in_time: As quick as the corner allows.}",
                    "alan: {extra: 1, comment: Well explained.}",
                )
            ),
        ),
        chapter(
            "Give the grades back",
            """
    grader gradebook grades --roster class.csv --marks marks.yaml --for moodle --output upload.csv
    grader gradebook grades --roster class.csv --marks marks.yaml --feedback pages
    grader gradebook grades --roster class.csv --marks marks.yaml --against before.json

The first writes the file that Moodle imports (`--for canvas` that of Canvas): where the roster is an export of the same
platform, its own rows with the grades filled in, and `--decimal-comma` where your site writes 7,5. In Moodle it goes back by
"Upload grading worksheet" on the same page. The second writes a page for
each student: what earned which points, the worst run as a picture, what to try next. The third prints what has changed since
an earlier gradebook, criterion by criterion.
""",
        ),
        chapter(
            "Grade every push",
            """
    grader ci github --assignment one --kit https://example.org/kit@v0.2.0

prints the workflow; `gitlab` and `classroom50` likewise, `--write` puts it into its place, `gradescope` makes an archive.
Repeat `--assignment` for a repository with several. Anyone who can push can change it, so these results are for practice; the
grade comes from `grader cohort`.
""",
        ),
        chapter(
            "Many accounts on one machine",
            """
    kit doctor --class 30

measures how many students this machine carries who drive and check at once, and says what more learners need before a deadline.
After each installation, `sudo kit warm --shared` compiles for all accounts what each would otherwise compile at its first
start.
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


TOPIC: Final = HelpTopic(
    "For teachers",
    "make an assignment, hand it out, grade, give grades back, read what a class learned",
    Shelf.HOW_TO,
    _chapters,
)
