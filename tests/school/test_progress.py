"""The journal: nothing confirmed is ever lost."""

from __future__ import annotations

import json
import random
import signal
import sqlite3
import subprocess
import sys
import time
from datetime import UTC, datetime
from pathlib import Path

import pytest

from kit.school.progress import FILE, EventKind, ProgressError, ProgressEvent, ProgressJournal
from kit.school.progress_export import read_export


def test_events_come_back_in_the_order_of_their_time(tmp_path: Path) -> None:
    with ProgressJournal(tmp_path) as progress:
        late = progress.add(EventKind.STEP, "b/1", now=datetime(2026, 2, 1, tzinfo=UTC))
        early = progress.add(
            EventKind.ANSWER, "q", {"chosen": None, "text": "ü"}, now=datetime(2026, 1, 1, tzinfo=UTC)
        )
    with ProgressJournal(tmp_path) as progress:
        assert progress.events() == [early, late]
        assert progress.events(EventKind.ANSWER) == [early]
        assert progress.events(subject="b/1") == [late]
        assert progress.notice == ""


def test_the_last_given_name_counts(tmp_path: Path) -> None:
    with ProgressJournal(tmp_path) as progress:
        assert progress.student_name == ""
        progress.add(EventKind.ABOUT, "name", {"value": "Ada"})
        progress.add(EventKind.ABOUT, "name", {"value": "Ada L"})
        assert progress.student_name == "Ada L"


def test_what_is_exported_comes_in_elsewhere_once(tmp_path: Path) -> None:
    here, there = tmp_path / "here", tmp_path / "there"
    here.mkdir()
    there.mkdir()
    with ProgressJournal(here) as progress:
        for number in range(30):
            progress.add(EventKind.STEP, f"01-drive/{number}")
        assert progress.export(tmp_path / "ada.json") == 30
        known = progress.events()
    with ProgressJournal(there) as other:
        own = other.add(EventKind.STEP, "02/1")
        events = read_export(tmp_path / "ada.json")
        assert (other.import_events(events), other.import_events(events)) == (30, 0)
        assert {each.uid for each in other.events()} == {own.uid, *(each.uid for each in known)}


BROKEN = {
    "cut": lambda text: text[: len(text) // 2],
    "not ours": lambda text: "[1, 2]",
    "newer": lambda text: text.replace('"version": 1', '"version": 99'),
    "kind": lambda text: text.replace('"step"', '"stop"'),
    "time": lambda text: text.replace("+00:00", ""),
    "empty": lambda text: "",
}


@pytest.mark.parametrize("name", BROKEN)
def test_a_damaged_export_is_refused_whole(tmp_path: Path, name: str) -> None:
    file = tmp_path / "ada.json"
    with ProgressJournal(tmp_path) as progress:
        progress.add(EventKind.STEP, "01/1")
        progress.export(file)
    file.write_text(BROKEN[name](file.read_text()))
    with pytest.raises(ProgressError, match=r"ada\.json"):
        read_export(file)


def test_a_damaged_journal_is_set_aside_and_what_can_be_read_is_kept(tmp_path: Path) -> None:
    with ProgressJournal(tmp_path) as progress:
        progress.import_events(
            ProgressEvent(
                f"{number:032x}",
                f"2026-01-01T00:00:{number % 60:02}+00:00",
                EventKind.STEP,
                f"lesson/{number}",
                {"x": "y" * 40},
            )
            for number in range(2000)
        )
    file = tmp_path / FILE
    content = bytearray(file.read_bytes())
    middle = len(content) // 2 // 4096 * 4096
    content[middle : middle + 8192] = b"\xff" * 8192
    file.write_bytes(content)
    with ProgressJournal(tmp_path) as progress:
        assert "damaged" in progress.notice
        assert 500 < len(progress.events()) < 2001
        progress.add(EventKind.STEP, "goes on")
    (aside,) = tmp_path.glob("progress.damaged-*.db")
    assert aside.read_bytes() == bytes(content)
    with ProgressJournal(tmp_path) as progress:
        assert progress.notice == ""


def _damaged(folder: Path, count: int = 2000) -> None:
    with ProgressJournal(folder) as progress:
        progress.import_events(
            ProgressEvent(
                f"{number:032x}",
                "2026-01-01T00:00:00+00:00",
                EventKind.STEP,
                f"lesson/{number}",
                {"x": "y" * 40},
            )
            for number in range(count)
        )
    content = bytearray((folder / FILE).read_bytes())
    middle = len(content) // 2 // 4096 * 4096
    content[middle : middle + 8192] = b"\xff" * 8192
    (folder / FILE).write_bytes(content)


@pytest.mark.parametrize("moment", ["os.link", "pathlib.Path.replace"])
def test_a_kill_while_it_is_set_aside_loses_nothing(
    tmp_path: Path, moment: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def killed(*_: object) -> None:
        raise KeyboardInterrupt

    _damaged(tmp_path)
    with monkeypatch.context() as patch:
        patch.setattr(moment, killed)
        with pytest.raises(KeyboardInterrupt):
            ProgressJournal(tmp_path)
    with ProgressJournal(tmp_path) as progress:
        assert "damaged" in progress.notice
        assert len(progress.events()) > 500


def test_a_full_disk_while_it_is_set_aside_loses_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise sqlite3.OperationalError("database or disk is full")

    _damaged(tmp_path)
    with monkeypatch.context() as patch:
        patch.setattr("kit.school.progress._insert_rows", full)
        with pytest.raises(ProgressError, match="full"):
            ProgressJournal(tmp_path)
    with ProgressJournal(tmp_path) as progress:
        assert len(progress.events()) > 500


@pytest.mark.parametrize("other", [False, True], ids=["taken away", "another in its place"])
def test_a_file_taken_away_while_it_is_open_loses_nothing(tmp_path: Path, other: bool) -> None:
    with ProgressJournal(tmp_path) as progress:
        first = progress.add(EventKind.STEP, "01/1")
        (tmp_path / FILE).unlink()
        if other:
            with ProgressJournal(tmp_path) as second:
                second.add(EventKind.STEP, "01/9")
        progress.add(EventKind.STEP, "01/2")
        known = [each.subject for each in progress.events()]
    assert sorted(known) == sorted(["01/1", "01/2", *(["01/9"] if other else [])])
    with ProgressJournal(tmp_path) as progress:
        assert first in progress.events()
        assert [each.subject for each in progress.events()] == known


ODD = {
    "time": ("yesterday", "{}"),
    "zone": ("2026-01-01T00:00:00", "{}"),
    "list": ("2026-01-01T00:00:00+00:00", "[]"),
    "nonsense": ("2026-01-01T00:00:00+00:00", "{"),
}


@pytest.mark.parametrize("name", ODD)
def test_a_row_that_somebody_wrote_is_left_alone(tmp_path: Path, name: str) -> None:
    with ProgressJournal(tmp_path) as progress:
        mine = progress.add(EventKind.STEP, "01/1")
    with sqlite3.connect(tmp_path / FILE) as other:
        other.execute(
            "INSERT INTO events (uid, at, kind, subject, content) VALUES ('u', ?, 'step', 's', ?)", ODD[name]
        )
    other.close()
    with ProgressJournal(tmp_path) as progress:
        assert progress.events() == [mine]


def test_times_of_another_zone_come_in_order(tmp_path: Path) -> None:
    file = tmp_path / "ada.json"
    with ProgressJournal(tmp_path) as progress:
        progress.add(EventKind.STEP, "later", now=datetime(2026, 1, 1, 8, tzinfo=UTC))
        progress.export(file)
        exported = file.read_text().replace("2026-01-01T08:00:00.000000+00:00", "2026-01-01T09:00:00+02:00")
        file.write_text(exported.replace(progress.events()[0].uid, "another").replace("later", "earlier"))
        progress.import_events(read_export(file))
        assert [each.subject for each in progress.events()] == ["earlier", "later"]


@pytest.mark.parametrize("content", [b"nonsense" * 200, b""], ids=["nonsense", "empty"])
def test_a_file_that_is_no_database_is_set_aside(tmp_path: Path, content: bytes) -> None:
    (tmp_path / FILE).write_bytes(content)
    with ProgressJournal(tmp_path) as progress:
        assert bool(progress.notice) is bool(content)
        progress.add(EventKind.STEP, "01/1")
        assert len(progress.events()) == 1


def test_another_database_is_not_taken_for_ours(tmp_path: Path) -> None:
    with sqlite3.connect(tmp_path / FILE) as other:
        other.execute("CREATE TABLE events (something TEXT)")
    other.close()
    with ProgressJournal(tmp_path) as progress:
        assert "damaged" in progress.notice


def test_a_folder_that_cannot_be_used_says_so(tmp_path: Path) -> None:
    with pytest.raises(ProgressError, match="nowhere"):
        ProgressJournal(tmp_path / "nowhere")


def test_an_answer_that_is_a_whole_book_is_refused(tmp_path: Path) -> None:
    with ProgressJournal(tmp_path) as progress:
        with pytest.raises(ProgressError, match="characters"):
            progress.add(EventKind.FORM, "q", {"value": "x" * 100_000})
        assert progress.events() == []


def test_an_event_of_a_newer_kit_is_kept_and_left_alone(tmp_path: Path) -> None:
    with ProgressJournal(tmp_path) as progress:
        progress.add(EventKind.STEP, "01/1")
    with sqlite3.connect(tmp_path / FILE) as other:
        other.execute(
            "INSERT INTO events (uid, at, kind, subject, content) VALUES ('u', '2030-01-01T00:00:00+00:00', 'song', 's', '{}')"
        )
    other.close()
    with ProgressJournal(tmp_path) as progress:
        assert len(progress.events()) == 1
        assert progress.notice == ""


STUDENT = """
import sys
from pathlib import Path
from kit.school.progress import EventKind, ProgressJournal
folder = Path(sys.argv[1])
kinds = [(EventKind.STEP, "01-drive/1", {}), (EventKind.ATTEMPT, "01-drive/flag", {"points": 1}), (EventKind.ANSWER, "item", {"chosen": 1})]
with ProgressJournal(folder) as journal:
    print("ready", flush=True)
    for turn in range(10**6):
        kind, subject, content = kinds[turn % 3]
        print(journal.add(kind, subject, content).uid, flush=True)
        if turn % 5 == 4:
            journal.export(folder / "export.json")
"""


def _killed(tmp_path: Path, moment: float) -> None:
    """A student's process is killed at some moment; what it had confirmed must be there."""
    program = [sys.executable, "-c", STUDENT, str(tmp_path)]
    with subprocess.Popen(program, stdout=subprocess.PIPE, text=True) as student:
        assert student.stdout is not None
        assert student.stdout.readline() == "ready\n"
        time.sleep(moment)
        student.send_signal(signal.SIGKILL)
        confirmed = [line.strip() for line in student.stdout if line.endswith("\n")]
    with ProgressJournal(tmp_path) as progress:
        assert progress.notice == ""
        known = {event.uid for event in progress.events()}
    assert set(confirmed) <= known
    exported = tmp_path / "export.json"
    if exported.exists():
        assert {event.uid for event in read_export(exported)} <= known
        assert json.loads(exported.read_text())["events"]


MOMENTS = [random.Random(7).uniform(0.0, 0.25) for _ in range(50)]


@pytest.mark.long
@pytest.mark.parametrize("round_", range(5))
def test_a_kill_loses_nothing_that_was_confirmed(tmp_path: Path, round_: int) -> None:
    for moment in MOMENTS[round_::5][:2]:
        _killed(tmp_path, moment)


@pytest.mark.long
def test_fifty_kills_lose_nothing_that_was_confirmed(tmp_path: Path) -> None:
    for moment in MOMENTS:
        _killed(tmp_path, moment)


@pytest.mark.parametrize(
    ("at", "is_read"),
    [
        ("9999-12-31T23:59:59+00:00", False),
        ("1999-12-31T23:59:59+00:00", False),
        ("2000-01-01T00:00:00+00:00", True),
        ("2099-12-31T23:59:59+00:00", True),
    ],
)
def test_an_entry_from_another_century_is_refused(at: str, is_read: bool, tmp_path: Path) -> None:
    """When its question is due again could not be computed, ever after."""
    journal, file = ProgressJournal(tmp_path), tmp_path / "export.json"
    journal.add(EventKind.STEP, "01-drive", {"step": 1})
    journal.export(file)
    content = json.loads(file.read_bytes())
    content["events"][0]["at"] = at
    file.write_text(json.dumps(content))
    if is_read:
        assert len(read_export(file)) == 1
        return
    with pytest.raises(ProgressError, match="another century"):
        read_export(file)
