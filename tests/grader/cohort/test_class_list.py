"""From results to a class: rosters of every platform, late works, own marks, files for platforms, pages, statistics."""

from __future__ import annotations

import csv
import io
import json
import os
import re
import sys
from datetime import UTC, datetime, timedelta
from html.parser import HTMLParser
from pathlib import Path
from zoneinfo import ZoneInfo

import pytest
from click.testing import CliRunner

from grader.__main__ import main
from grader.cohort.class_findings import class_blocks
from grader.cohort.class_list import ClassRules, ClassTable, class_table
from grader.cohort.exports import EXPORTS, for_canvas, for_moodle
from grader.cohort.feedback import write_feedback
from grader.cohort.gradebook import (
    MISSING,
    WAITING,
    GradebookRow,
    as_csv,
    as_json,
    gradebook_rows,
    late_text,
    read_json,
)
from grader.cohort.gradebook_changes import changes
from grader.cohort.lateness import DueDateExtension, LatePolicy, read_policy
from grader.cohort.marks import read_marks
from grader.cohort.queue import Queue
from grader.cohort.roster import owners_of, read_roster
from grader.cohort.statistics import class_document, discrimination
from grader.cohort.submission_times import SubmissionTime, read_submission_times
from kit.document.layout import document_lines, lines_of
from kit.world.problems import WorldError
from tests.grader.cohort.graded_class import graded_queue

ROSTERS = Path(__file__).parent / "rosters"
LISBON = ZoneInfo("Europe/Lisbon")
DUE = datetime(2026, 11, 30, 23, 59, 59, tzinfo=LISBON)


@pytest.fixture
def queue(tmp_path: Path) -> Queue:
    works = {"Ada Lima_4711_assignsubmission_file_": 1.0, "Bruno Sá_4712_assignsubmission_file_": 0.5}
    return graded_queue(tmp_path, works)


def by_name(table: ClassTable) -> dict[str, GradebookRow]:
    return {row.name: row for row in table.rows}


@pytest.mark.parametrize("file", sorted(ROSTERS.glob("*.csv")), ids=lambda file: file.stem)
def test_every_platforms_roster_is_read(file: Path) -> None:
    roster = read_roster(file)
    assert roster.platform == ("own" if file.stem == "own" else file.stem.partition("_")[0])
    students = list(roster.students.values())
    assert len(students) == 3
    assert students[0].name == "Ada Lima"
    ada = {"ada@uni.example", "100", "ada", "ada-lima", "4711", "9001"} & set(students[0].keys)
    assert len(ada) >= 1
    for key in students[1].keys:
        assert roster.find(key) == (students[1],)


@pytest.mark.parametrize(
    ("roster", "works"),
    [
        ("moodle_worksheet", ["Ada Lima_4711_assignsubmission_file_", "Bruno Sá_4712_assignsubmission_file"]),
        ("canvas", ["limaada_9001_77_controller", "sabruno_LATE_9002_78_controller"]),
        ("gradescope", ["ada@uni.example", "101"]),
        ("github", ["drive-on-ada-lima", "drive-on-brunosa"]),
        ("own", ["ADA", "Bruno_Sá"]),
        ("own", ["ada", "bruno"]),
    ],
)
def test_works_are_given_to_their_students(roster: str, works: list[str]) -> None:
    owners = owners_of(works, read_roster(ROSTERS / f"{roster}.csv"))
    assert [[each.name for each in owners.students[work]] for work in works] == [["Ada Lima"], ["Bruno Sá"]]
    assert not owners.ambiguous


@pytest.mark.parametrize(
    ("roster", "works"),
    [
        ("canvas", ["limaada_9001_77_x_9002_assignsubmission_file_", "sabruno_9002_78_controller"]),
        ("own", ["limaada_100_77_x_101_assignsubmission_file_", "101"]),
        ("moodle_worksheet", ["X_4711_assignsubmission_file_a_4712_assignsubmission_file_", "Y_4712_assignsubmission_file"]),
        ("github", ["drive-on-eve-brunosa", "drive-on-brunosa", "drive-on-ada-lima"]),
        ("github", ["drive-on-eve-brunosa", "drive-on-brunosa"]),
        ("own", ["Ada@bruno", "drive-bruno"]),
    ],
)  # fmt: skip
def test_what_a_student_chooses_of_a_name_means_no_other_student(roster: str, works: list[str]) -> None:
    owners = owners_of(works, read_roster(ROSTERS / f"{roster}.csv"))
    assert [each.name for each in owners.students[works[1]]] == ["Bruno Sá"]
    assert all(each.name != "Bruno Sá" for each in owners.students[works[0]])


def test_a_group_hands_in_one_work(tmp_path: Path) -> None:
    queue = graded_queue(tmp_path, {"red": 0.5, "chen": 1.0})
    table = by_name(class_table(queue, ClassRules(roster=read_roster(ROSTERS / "own.csv"))))
    assert {name: row.points for name, row in table.items()} == {"Ada Lima": 3, "Bruno Sá": 3, "Li Chen": 6}


def test_two_of_one_name_are_told_apart_or_said(tmp_path: Path) -> None:
    file = tmp_path / "class.csv"
    file.write_text("name,email\nAda Lima,ada@x.example\nAda Lima,ada2@x.example\n")
    queue = graded_queue(tmp_path, {"ada2@x.example": 1.0, "Ada Lima": 0.5})
    table = class_table(queue, ClassRules(roster=read_roster(file)))
    rows = by_name(table)
    assert rows["Ada Lima (ada2@x.example)"].points == 6
    assert rows["Ada Lima (ada@x.example)"].verdict == MISSING
    assert rows["Ada Lima"].student is None
    assert any("fits 2 students" in each for each in table.remarks)


def test_who_handed_in_nothing_has_a_row_and_strangers_are_said(tmp_path: Path) -> None:
    queue = graded_queue(tmp_path, {"ada": 1.0, "Grades-HW1.py": 0.0})
    times = {"ada": SubmissionTime(DUE, "ada"), "nobody": SubmissionTime(DUE, "nobody")}
    table = class_table(queue, ClassRules(roster=read_roster(ROSTERS / "own.csv"), submission_times=times))
    rows = by_name(table)
    assert {name for name, row in rows.items() if row.verdict == MISSING} == {"Bruno Sá", "Li Chen"}
    assert rows["Bruno Sá"].final is None
    assert any("1 time of no submission" in each for each in table.remarks)
    told = "\n".join(lines_of(class_blocks(table.rows)))
    assert "Grades-HW1" in told
    assert "2 handed in nothing" in told


def test_equal_works_are_marked_but_not_within_a_group(tmp_path: Path) -> None:
    queue = graded_queue(tmp_path, {"red": 0.5, "chen": 0.5})
    roster = read_roster(ROSTERS / "own.csv")
    assert "The same work" in "\n".join(
        lines_of(class_blocks(class_table(queue, ClassRules(roster=roster)).rows))
    )
    (tmp_path / "two").mkdir()
    alone = graded_queue(tmp_path / "two", {"red": 0.5, "chen": 1.0})
    assert "The same work" not in "\n".join(
        lines_of(class_blocks(class_table(alone, ClassRules(roster=roster)).rows))
    )


@pytest.mark.parametrize(
    ("late", "extension", "grace_days", "kept", "word"),
    [
        (timedelta(0), None, 0, 1.0, ""),
        (timedelta(minutes=9), None, 0, 1.0, ""),
        (timedelta(minutes=11), None, 0, 0.9, "11 min"),
        (timedelta(hours=25), None, 0, 0.8, "1 day 1 h"),
        (timedelta(hours=25), None, 1, 0.9, "1 day of them for nothing"),
        (timedelta(hours=20), None, 1, 1.0, "cost nothing"),
        (timedelta(hours=25), DueDateExtension(days=2), 0, 1.0, "by an extension"),
        (timedelta(hours=73), DueDateExtension(days=2), 0, 0.8, "after your extension"),
        (timedelta(days=9), DueDateExtension(until=DUE + timedelta(days=9)), 0, 1.0, "by an extension"),
        (timedelta(days=11), None, 0, 0.0, "0%"),
    ],
)
def test_lateness_says_how_late_and_what_it_costs(
    late: timedelta, extension: DueDateExtension | None, grace_days: int, kept: float, word: str
) -> None:
    policy = LatePolicy(DUE, 600, 0.1, 0.2, 10, LISBON, grace_days)
    found = policy.lateness(DUE + late, extension)
    assert found.kept == pytest.approx(kept)
    assert word in found.text()
    assert bool(found.text()) == bool(word)


def test_the_note_says_what_lateness_costs(queue: Queue) -> None:
    policy = LatePolicy(DUE, zone=LISBON)
    times = {"4712": SubmissionTime(DUE + timedelta(hours=25), "4712")}
    roster = read_roster(ROSTERS / "moodle_worksheet.csv")
    row = by_name(class_table(queue, ClassRules(policy, times, roster=roster)))["Bruno Sá"]
    assert (row.points, row.final) == (3, 2.4)
    assert "Late by 1 day 1 h" in late_text(row)
    assert "costs 0.6 of 3 points" in late_text(row)
    assert "costs 0.6 of 3 points" in as_csv([row])


@pytest.mark.parametrize(("due", "hours"), [("2026-10-24", 24.9), ("2027-03-27", 23.5)])
def test_a_change_of_clocks_costs_nobody_a_day(due: str, hours: float) -> None:
    at = datetime.fromisoformat(due).replace(hour=23, minute=59, second=59, tzinfo=LISBON)
    policy = LatePolicy(at, zone=LISBON)
    handed_in = at.astimezone(UTC) + timedelta(hours=hours)
    assert policy.lateness(handed_in).days == 1


def test_extensions_are_read_and_belong_to_somebody(tmp_path: Path, queue: Queue) -> None:
    rules = tmp_path / "late.yaml"
    rules.write_text(
        "due: 2026-11-30\nzone: Europe/Lisbon\nextensions:\n"
        "  ada@uni.example: 2026-12-01\n  Nobody Known: {days: 3}\n"
    )
    policy = read_policy(rules)
    times = read_submission_times(ROSTERS / "moodle_worksheet.csv", policy.zone)
    table = class_table(
        queue, ClassRules(policy, times, roster=read_roster(ROSTERS / "moodle_worksheet.csv"))
    )
    rows = by_name(table)
    assert rows["Ada Lima"].late == "In time by an extension."
    assert rows["Ada Lima"].final == 6
    assert rows["Bruno Sá"].late == ""
    assert any("late.yaml:5" in each and "nobody" in each for each in table.remarks)
    rules.write_text("due: 2026-11-30\nextensions: {ada: 2026-12-01}\n")
    with pytest.raises(WorldError, match="time zone"):
        read_policy(rules)


def test_own_marks_survive_and_say_where_they_do_not_fit(tmp_path: Path, queue: Queue) -> None:
    file = tmp_path / "marks.yaml"
    file.write_text(
        "bruno@uni.example:\n  points: {reached: 3, moves: 99, parks: 1}\n  comments: {reached: Near enough.}\n"
        "  extra: 0.5\n  comment: Neat.\n"
        "Li Chen: {final: 2}\nZoe: {extra: 1}\n"
    )
    roster = read_roster(ROSTERS / "moodle_worksheet_groups.csv")
    table = class_table(queue, ClassRules(roster=roster, marks=read_marks(file)))
    rows = by_name(table)
    bruno = rows["Bruno Sá"]
    assert bruno.tests == {"runs": 0.5, "moves": 1.0, "reached": 3.0}
    assert (bruno.points, bruno.final, bruno.marked) == (5.0, 5.0, ("reached",))
    assert rows["Li Chen"].final == 2
    remarks = "\n".join(table.remarks)
    for word in (
        "marks.yaml:2",
        "no criterion parks",
        "99 points for moves",
        "marks.yaml:7",
        "a mark for nobody",
    ):
        assert word in remarks
    assert "Near enough." in as_csv(table.rows)
    assert read_json(as_json(table.rows)) == table.rows


@pytest.mark.parametrize(
    "text", ["Ada: {point: 3}", "Ada: 3", "Ada: {points: {reached: -1}}", "Ada: {final: x}"]
)
def test_a_wrong_mark_is_named(text: str, tmp_path: Path) -> None:
    (tmp_path / "marks.yaml").write_text(text)
    with pytest.raises(WorldError, match=r"marks\.yaml:1"):
        read_marks(tmp_path / "marks.yaml")


@pytest.mark.parametrize("decimal_comma", [False, True])
def test_moodles_worksheet_comes_back_with_grades(queue: Queue, *, decimal_comma: bool) -> None:
    file = ROSTERS / "moodle_worksheet.csv"
    roster = read_roster(file)
    table = class_table(queue, ClassRules(roster=roster)).rows
    text = for_moodle(table, roster, "Drive on", 6.0, decimal_comma=decimal_comma)
    before = list(csv.DictReader(io.StringIO(file.read_text())))
    after = list(csv.DictReader(io.StringIO(text)))
    assert [row["Grade"] for row in after] == ["6", "3", ""]
    assert "is not met" in after[1]["Feedback comments"]
    changed = ("Grade", "Feedback comments")
    for was, now in zip(before, after, strict=True):
        assert {key: value for key, value in was.items() if key not in changed} == {
            key: value for key, value in now.items() if key not in changed
        }


def test_a_decimal_comma_stands_where_it_is_asked_for(tmp_path: Path) -> None:
    queue = graded_queue(tmp_path, {"Ada Lima_4711_assignsubmission_file_": 0.75})
    roster = read_roster(ROSTERS / "moodle_worksheet.csv")
    table = class_table(queue, ClassRules(roster=roster)).rows
    rows = list(csv.DictReader(io.StringIO(for_moodle(table, roster, "", 6.0, decimal_comma=True))))
    assert rows[0]["Grade"] == "4,5"
    cells = list(csv.DictReader(io.StringIO(as_csv(table, decimal_comma=True)), delimiter=";"))
    assert {row["final"] for row in cells} == {"4,5", ""}


def test_canvas_gets_its_own_rows_and_the_assignments_column(tmp_path: Path) -> None:
    queue = graded_queue(tmp_path, {"limaada_9001_1_controller": 0.75, "sabruno_LATE_9002_2_controller": 0.5})
    roster = read_roster(ROSTERS / "canvas.csv")
    text = for_canvas(
        class_table(queue, ClassRules(roster=roster)).rows, roster, "Drive on", 6.0, decimal_comma=False
    )
    rows = list(csv.reader(io.StringIO(text)))
    assert rows[0] == ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", "Drive on (345)"]
    assert rows[1][0] == "    Points Possible"
    assert [row[-1] for row in rows[1:]] == ["6", "4.5", "3", "", ""]
    assert rows[2][:5] == ["Lima, Ada", "9001", "100", "ada", "Robotics 1"]


class _Links(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found += [value or "" for name, value in attrs if name in ("src", "href")]
        assert tag not in ("script", "iframe", "link")


@pytest.mark.skipif(sys.platform != "linux", reason="names of any bytes")
def test_names_that_are_no_text_cost_a_class_nothing(tmp_path: Path) -> None:
    names = [os.fsdecode(each) for each in (b"\xff.py", b"\xfe.py", b"\xed\xa0\x80", b"z\xe9")]
    queue = graded_queue(tmp_path, dict.fromkeys(names, 1.0))
    table = class_table(queue, ClassRules()).rows
    assert len({row.name for row in table}) == len(names)
    assert write_feedback(queue, table, tmp_path / "pages") == len(names)
    for write in EXPORTS.values():
        assert write(table, None, "Quick", 6.0, decimal_comma=False).encode()


@pytest.mark.parametrize("form", [file.name for file in sorted(ROSTERS.glob("*.csv"))])
def test_nothing_of_a_platforms_export_comes_back_as_a_formula(form: str, tmp_path: Path) -> None:
    """Students chose the names there, and some fields more."""
    rows = list(csv.reader(io.StringIO((ROSTERS / form).read_text("utf-8-sig"))))
    cells = [[f"={cell}" if cell and not cell.startswith(" ") else cell for cell in row] for row in rows[1:]]
    out = io.StringIO()
    csv.writer(out).writerows([[*rows[0], "@more"], *([*row, "+cmd()"] for row in cells)])
    (file := tmp_path / form).write_text(out.getvalue())
    roster = read_roster(file)
    table = class_table(graded_queue(tmp_path, {"=1+1": 1.0}), ClassRules(roster=roster)).rows
    assert any(row.name.startswith("=") for row in table)
    for write in EXPORTS.values():
        written = list(csv.reader(io.StringIO(write(table, roster, "=t()", 6.0, decimal_comma=False))))
        assert any(cell.startswith("'=") for row in written for cell in row)
        assert not [cell for row in written for cell in row if cell.lstrip().startswith(("=", "+", "-", "@"))]


@pytest.mark.skipif(sys.platform != "linux", reason="names of any signs")
def test_no_name_leaves_as_anything_but_text(tmp_path: Path) -> None:
    names = ["a\n\n| b | c |\r\n::error::d", "\u202eevil\u2066", "\x1b[2Jada", "=1+1", '<img src=x>,"q']
    queue = graded_queue(tmp_path, dict.fromkeys(names, 1.0))
    table = class_table(queue, ClassRules()).rows
    write_feedback(queue, table, tmp_path / "pages")
    pages = {file: file.read_text() for file in (tmp_path / "pages").iterdir()}
    assert not any("<img" in text for file, text in pages.items() if file.suffix in (".html", ".md"))
    texts = list(pages.values())
    texts += [write(table, None, "Quick", 6.0, decimal_comma=False) for write in EXPORTS.values()]
    for text in texts:
        assert all(sign.isprintable() or sign in "\r\n" for sign in text), ascii(text)
        assert not re.search(r"^\s*(::|\| b|=1)", text, re.MULTILINE), text


def test_every_student_has_a_page_that_needs_no_network(tmp_path: Path, queue: Queue) -> None:
    file = tmp_path / "marks.yaml"
    file.write_text("bruno@uni.example: {comment: <b>Neat</b> & short., points: {reached: 3}}\n")
    roster = read_roster(ROSTERS / "moodle_worksheet_groups.csv")
    table = class_table(queue, ClassRules(roster=roster, marks=read_marks(file))).rows
    folder = tmp_path / "pages"
    assert write_feedback(queue, table, folder) == 3
    assert set(json.loads((folder / "_pages.json").read_text()).values()) == {
        "Ada Lima",
        "Bruno Sá",
        "Li Chen",
    }
    page = (folder / "101.html").read_text()
    links = _Links()
    links.feed(page)
    assert not [each for each in links.found if "//" in each]
    assert "Drive on" in page
    assert "&lt;b&gt;Neat" in page
    assert "#  x#" in page
    assert "What to try next" in page
    assert "#  x#" in (folder / "101.md").read_text()
    assert "handed in" in (folder / "102.html").read_text()
    assert "What to try next" not in (folder / "100.html").read_text()
    assert (folder / "_class.html").exists()
    assert folder.stat().st_mode & 0o077 == 0


def test_statistics_say_what_the_class_did_not_reach(tmp_path: Path) -> None:
    queue = graded_queue(tmp_path, {"a": 1.0, "b": 0.5, "c": 0.0, "d": 0.25})
    table = gradebook_rows(queue)
    text = "\n".join(document_lines(class_document(queue.assignment(), table)))
    assert "1 of 4" in text
    assert "0.44" in text  # the mean share
    assert "Worth explaining again" in text
    assert discrimination(table, "reached") == pytest.approx(1.0)


def test_what_is_not_graded_again_yet_is_no_change(queue: Queue) -> None:
    before = gradebook_rows(queue)
    queue.result_file(queue.entries()[1].key or "").unlink()
    after = gradebook_rows(queue)
    assert [row.verdict for row in after].count(WAITING) == 1
    lines = list(changes(before, after))
    assert len(lines) == 1
    assert lines[0].startswith("1 submission not graded again yet")


def test_the_verb_writes_all_of_it(tmp_path: Path, queue: Queue) -> None:
    command = ["gradebook", str(queue.folder), "--roster", str(ROSTERS / "moodle_worksheet.csv")]
    upload = tmp_path / "upload.csv"
    done = CliRunner().invoke(main, [*command, "--for", "moodle", "--output", str(upload)])
    assert done.exit_code == 0, done.output
    assert "1 handed in nothing" in done.stderr
    assert [row["Grade"] for row in csv.DictReader(io.StringIO(upload.read_text()))] == ["6", "3", ""]
    done = CliRunner().invoke(main, [*command, "--statistics"])
    assert re.search(r"Drive on|criterion by criterion", done.output)
    done = CliRunner().invoke(main, [*command, "--feedback", str(tmp_path / "pages")])
    assert done.exit_code == 0
    assert len(list((tmp_path / "pages").glob("[!_]*.html"))) == 3


@pytest.mark.parametrize("text", ["", "a,b\n1,2\n", "name,email\n"])
def test_what_is_no_roster_is_said(text: str, tmp_path: Path) -> None:
    (tmp_path / "class.csv").write_text(text)
    with pytest.raises(ValueError, match=r"class\.csv"):
        read_roster(tmp_path / "class.csv")


@pytest.mark.parametrize("encoding", ["utf-8", "cp1252", "utf-16"])
def test_what_a_student_typed_into_the_worksheet_costs_nobody_a_grade(tmp_path: Path, encoding: str) -> None:
    file = tmp_path / "worksheet.csv"
    with file.open("w", encoding=encoding, newline="") as opened:
        table = csv.writer(opened)
        table.writerow(["Identifier", "Full name", "Grade", "Online text", "Last modified (submission)"])
        table.writerow(["Participant 1", "Ada", "", "é" * 200_000, "Friday, 6 March 2026, 5:00 PM"])
    assert [each.name for each in read_roster(file).students.values()] == ["Ada"]
    assert set(read_submission_times(file, UTC)) == {"1"}
