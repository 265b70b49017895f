"""A whole course by its commands, from the template to the grades in Moodle and Canvas; each step's seconds are printed.

``pytest -s tests/grader/test_course.py`` shows them.
"""

from __future__ import annotations

import csv
import io
import json
import random
import tarfile
import time
import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import cycle
from pathlib import Path

import pytest
import yaml
from click.testing import CliRunner, Result

from grader.__main__ import main
from grader.cohort.queue import Queue
from tests.grader.conftest import FORWARD, LOCKS

HANDED_IN = 150
MISSING = 8
DIFFERENT = 60
SEED = 41
SECRET = 2_718_281_828_459_045_235
SHEET = """\
title: Along my hall
kind: controller
submit: controller.py
level: 1
trials:
  - {name: hall, place: hall/world.yaml, target: [4.25, 1.25], time: 3, seeds: [1]}
checks:
  - {check: runs, points: 1}
  - {check: moves, title: It goes on, points: 4, after: runs, share: {none: 0, full: 0.8, steps: 4}, hints: [Publish more often.]}
  - {check: bumps, points: 2, after: runs, share: {none: 2, full: 0}}
tests: [test_own.py]
budget: {start: 20, reply: 2, total: 10, cpu: 10}
"""
OWN_TEST = '''\
import pytest

@pytest.mark.points(3)
def test_keeps_to_its_side(grading):
    """The robot left its side of the hall."""
    assert all((drive.track[:, 1] > 0.6).all() for drive in grading.evidence("runs"))
'''
ROSTERS = Path(__file__).parent / "cohort" / "rosters"
HALL = "##########\n#S      T#\n#        #\n##########\n"


@contextmanager
def step(name: str) -> Iterator[None]:
    began = time.perf_counter()
    yield
    print(f"{time.perf_counter() - began:8.2f} s  {name}")


def invoke(*command: str, status: int = 0) -> Result:
    done = CliRunner().invoke(main, list(command))
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception
    assert done.exit_code == status, f"{command}\n{done.output}\n{done.exception!r}"
    return done


def released(folder: str) -> list[bytes]:
    """Every byte that students get: the names of the files too."""
    return [
        str(file).encode() + (file.read_bytes() if file.is_file() else b"")
        for file in Path(folder).rglob("*")
    ]


def zipped(file: str) -> list[bytes]:
    with zipfile.ZipFile(file) as archive:
        return [each.filename.encode() + archive.read(each) for each in archive.infolist()]


def program(number: int) -> str:
    return FORWARD.replace("SPEED = 0.3", f"SPEED = {0.05 + 0.01 * number:.2f}")


def _plain(folder: Path, text: str) -> None:
    (folder / "controller.py").write_text(text)


def _zip(folder: Path, text: str) -> None:
    with zipfile.ZipFile(folder / "work.zip", "w") as archive:
        archive.writestr("deep/in/here/controller.py", text)
        archive.writestr("__MACOSX/deep/._controller.py", b"\x00\x05")


def _tar(folder: Path, text: str) -> None:
    data = text.encode()
    with tarfile.open(folder / "work.tar.gz", "w:gz") as archive:
        entry = tarfile.TarInfo("controller.py")
        entry.size = len(data)
        archive.addfile(entry, io.BytesIO(data))


def _capital(folder: Path, text: str) -> None:
    (folder / "Controller.PY").write_text(text)


def _with_rubbish(folder: Path, text: str) -> None:
    _plain(folder, text)
    (folder / ".git").mkdir()
    (folder / ".git" / "config").write_text("[core]\n")
    (folder / "__pycache__").mkdir()
    (folder / "screenshot.png").write_bytes(b"\x89PNG")


def _tar_xz(folder: Path, text: str) -> None:
    with tarfile.open(folder / "work.tar.xz", "w:xz") as archive:
        data = text.encode()
        entry = tarfile.TarInfo("homework/controller.py")
        entry.size = len(data)
        archive.addfile(entry, io.BytesIO(data))


def _zip_in_zip(folder: Path, text: str) -> None:
    inner = io.BytesIO()
    with zipfile.ZipFile(inner, "w") as archive:
        archive.writestr("controller.py", text)
    with zipfile.ZipFile(folder / "all.zip", "w") as archive:
        archive.writestr("work.zip", inner.getvalue())


def _notebook(folder: Path, text: str) -> None:
    cell = {"cell_type": "code", "source": text, "metadata": {}, "outputs": [], "execution_count": None}
    content = {"cells": [cell], "metadata": {}, "nbformat": 4, "nbformat_minor": 5}
    (folder / "controller.ipynb").write_text(json.dumps(content))


def _backslashes(folder: Path, text: str) -> None:
    with zipfile.ZipFile(folder / "work.zip", "w") as archive:
        archive.writestr("work\\controller.py", text)


def _beside_environment(folder: Path, text: str) -> None:
    _plain(folder, text)
    for number in range(300):
        file = folder / ".venv" / "lib" / f"module_{number}.py"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("")


def _with_helper(folder: Path, text: str) -> None:
    _plain(folder, text)
    (folder / "helper.py").write_text("FACTOR = 2\n")


def _encoded(encoding: str) -> Callable[[Path, str], None]:
    return lambda folder, text: (folder / "controller.py").write_bytes(text.encode(encoding)) and None  # type: ignore[return-value]


GOOD: dict[str, Callable[[Path, str], None]] = {
    "plain": _plain,
    "zip in folders": _zip,
    "tar.gz": _tar,
    "capital letters": _capital,
    "beside rubbish": _with_rubbish,
    "with a byte order mark": _encoded("utf-8-sig"),
    "tar.xz": _tar_xz,
    "backslashes": _backslashes,
    "beside an environment": _beside_environment,
    "with a helper": _with_helper,
    "Windows lines": lambda folder, text: _plain(folder, text.replace("\n", "\r\n")),
}
BAD: dict[str, Callable[[Path], object]] = {
    "UTF-16": lambda folder: (folder / "controller.py").write_bytes(program(1).encode("utf-16")),
    "empty": lambda folder: (folder / "controller.py").write_bytes(b""),
    "a document": lambda folder: (folder / "report.docx").write_bytes(b"PK\x03\x04rest"),
    "no file": lambda folder: None,
    "cut off": lambda folder: (folder / "work.zip").write_bytes(b"PK\x03\x04" + b"\x00" * 30),
    "a notebook": lambda folder: _notebook(folder, program(1)),
    "a zip in a zip": lambda folder: _zip_in_zip(folder, program(1)),
    "rar": lambda folder: (folder / "work.rar").write_bytes(b"Rar!\x1a\x07\x01\x00rest"),
    "7z": lambda folder: (folder / "work.7z").write_bytes(b"7z\xbc\xaf\x27\x1crest"),
    "a wrong name": lambda folder: (folder / "my_homework.py").write_text(program(1)),
    "latin-1": lambda folder: (folder / "controller.py").write_bytes(f"# é\n{program(1)}".encode("latin-1")),
    "an endless loop": lambda folder: _plain(folder, "while True:\n    pass\n"),
    "a flood of print": lambda folder: _plain(folder, "while True:\n    print('x' * 1000)\n"),
    "a syntax error": lambda folder: _plain(folder, "def main(:\n"),
    "an exception": lambda folder: _plain(folder, "1/0\n"),
    "no such package": lambda folder: _plain(folder, "import tensorflow\n"),
}


@pytest.mark.long
@LOCKS
def test_a_course_from_the_template_to_the_grades(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    chance = random.Random(SEED)
    print()
    with step("template, own map, own criterion"):
        invoke("new", "task")
        from kit.cli import main as kit_main

        Path("hall.txt").write_text(HALL)
        made = CliRunner().invoke(
            kit_main, ["maps", "new", "hall", "--from", "hall.txt", "--workspace", "ws"]
        )
        assert made.exit_code == 0, made.output
        (found,) = Path("ws").rglob("hall/world.yaml")
        found.parent.rename("task/hall")
        Path("task/assignment.yaml").write_text(SHEET)
        Path("task/secret.yaml").write_text(f"seeds: {{hall: [{SECRET}]}}\n")
        Path("task/test_own.py").write_text(OWN_TEST)
        Path("task/solution.py").write_text(program(30))
    with step("release as a folder, a zip and a repository"):
        invoke("release", "task", "--output", "out")
        invoke("release", "task", "--output", "out.zip")
        invoke(
            "release",
            "task",
            "--output",
            "out-repository",
            "--repository",
            "--kit",
            "https://example.org/kit@v1",
        )
        for content in (*released("out"), *released("out-repository"), *zipped("out.zip")):
            assert all(each not in content for each in (str(SECRET).encode(), b"SPEED = 0.35"))
        assert Path("out/starter.py").exists()
        assert not Path("out/solution.py").exists()
    with step(f"{HANDED_IN} hand-ins, roster, times, rules, marks"):
        names = hand_in(chance)
        write_class(names, chance)
    cohort = ("cohort", "in", "--assignment", "task", "--queue", "queue", "--secret", "--level", "1")
    files = (
        "--roster",
        "worksheet.csv",
        "--late",
        "late.yaml",
        "--times",
        "times.csv",
        "--marks",
        "marks.yaml",
    )
    began = time.perf_counter()
    with step("grading"):
        invoke(*cohort, status=1)  # some cannot be read
    grading_s = time.perf_counter() - began
    queue = Queue(tmp_path / "queue")
    unreadable = sum(entry.key is None for entry in queue.entries())
    assert len(queue.entries()) == HANDED_IN
    assert 0 < unreadable < HANDED_IN / 5
    with step("gradebook"):
        invoke("gradebook", "queue", *files, "--json", "--output", "before.json")
    rows = {row["name"]: row for row in json.loads(Path("before.json").read_text())}
    assert len(rows) == HANDED_IN + MISSING
    assert sum(row["verdict"] == "missing" for row in rows.values()) == MISSING
    assert all(row["final"] is None for row in rows.values() if row["verdict"] in ("missing", "unreadable"))
    with step("the same files again"):
        assert "0 to grade" in invoke(*cohort, status=1).stderr

    began = time.perf_counter()
    with step("a changed title, hint and number of points: graded again"):
        sheet = SHEET.replace("It goes on", "It goes far").replace("Publish more often", "More often")
        Path("task/assignment.yaml").write_text(sheet.replace("points: 4", "points: 5"))
        again = invoke(*cohort, status=1)
    regrade_s = time.perf_counter() - began
    assert "judged anew by what was found before, 0 to grade" in again.stderr
    assert regrade_s < grading_s / 4
    changed = invoke("gradebook", "queue", *files, "--against", "before.json").stdout.splitlines()
    assert changed
    assert all("moves" in line for line in changed)
    assert sum("->" in line for line in changed) > HANDED_IN / 2
    with step("a changed criterion: what earns everything"):
        Path("task/assignment.yaml").write_text(sheet.replace("full: 0.8", "full: 0.6"))
        again = invoke(*cohort, status=1)
    assert "judged anew by what was found before, 0 to grade" in again.stderr

    with step("Moodle and Canvas, read back"):
        check_moodle(files)
        check_canvas(files)
    with step(f"{HANDED_IN + MISSING} pages"):
        invoke("gradebook", "queue", *files, "--feedback", "pages")
    pages = list(Path("pages").glob("[!_]*.html"))
    assert len(pages) == HANDED_IN + MISSING
    for page in (*pages, Path("pages/_class.html")):
        text = page.read_text()
        assert "Along my hall" in text
        assert str(SECRET) not in text
        assert "http://" not in text.replace("http://www.w3.org/2000/svg", "")
    assert "Close call, but it counts." in Path("pages/s001@uni.example.html").read_text()


def hand_in(chance: random.Random) -> list[str]:
    """Writes the hand-ins, in folders as Moodle's download has them, and returns the names of the students."""
    names = [f"Student {number:03} Sá" for number in range(HANDED_IN + MISSING)]
    good, bad = cycle(chance.sample(list(GOOD), len(GOOD))), cycle(chance.sample(list(BAD), len(BAD)))
    for number in range(HANDED_IN):
        folder = Path("in") / f"{names[number]}_{7000 + number}_assignsubmission_file_"
        folder.mkdir(parents=True)
        if number >= 10 and chance.random() < 0.2:
            BAD[next(bad)](folder)
        else:
            # Some have the program of another student, which is graded once.
            GOOD[next(good)](folder, program(number % DIFFERENT))
    return names


def _titles(file: str) -> list[str]:
    """The first line of a platform's real export; its source stands in the folder's README."""
    return next(csv.reader((ROSTERS / file).read_text(encoding="utf-8-sig").splitlines()))


def write_class(names: list[str], chance: random.Random) -> None:
    with Path("worksheet.csv").open("w", newline="", encoding="utf-8-sig") as file:
        writer = csv.writer(file)
        writer.writerow(_titles("moodle_worksheet.csv"))
        for number, name in enumerate(names):
            address = f"s{number:03}@uni.example"
            writer.writerow(
                [f"Participant {7000 + number}", name, address, "", "", "10.00", "Yes", "-", "-", ""]
            )
    with Path("canvas.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow([*_titles("canvas.csv")[:5], "Along my hall (345)"])
        writer.writerow(["    Points Possible", "", "", "", "", "10.00"])
        for number, name in enumerate(names):
            writer.writerow(
                [f"Sá, {name.removesuffix(' Sá')}", 7000 + number, number, f"s{number:03}", "1", ""]
            )
    with Path("times.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["name", "submitted"])
        for number in range(HANDED_IN):
            day, hour = (1, 3) if chance.random() < 0.1 else (30, chance.randrange(24))
            month = 12 if day == 1 else 11
            writer.writerow([f"s{number:03}@uni.example", f"2026-{month}-{day:02}T{hour:02}:30:00"])
    rules = {
        "due": "2026-11-30",
        "zone": "Europe/Lisbon",
        "per_day": 0.1,
        "extensions": {f"s{number:03}@uni.example": {"days": 2} for number in range(5)},
    }
    Path("late.yaml").write_text(yaml.safe_dump(rules))
    marks = {
        "s001@uni.example": {"points": {"bumps": 2}, "comment": "Close call, but it counts."},
        "s002@uni.example": {"extra": 1.5},
    }
    Path("marks.yaml").write_text(yaml.safe_dump(marks))


def check_moodle(files: tuple[str, ...]) -> None:
    invoke("gradebook", "queue", *files, "--for", "moodle", "--decimal-comma", "--output", "moodle.csv")
    book = json.loads(invoke("gradebook", "queue", *files, "--json").stdout)
    finals = {row["student"]["email"]: row["final"] for row in book}
    rows = list(csv.DictReader(io.StringIO(Path("moodle.csv").read_text())))
    assert list(rows[0]) == _titles("moodle_worksheet.csv")
    assert len(rows) == HANDED_IN + MISSING
    for row in rows:
        final = finals[row["Email address"]]
        shown = row["Grade"].replace(",", ".")
        assert (float(shown) if shown else None) == (
            None if final is None else pytest.approx(final, abs=0.005)
        )
    assert any("," in row["Grade"] for row in rows)


def check_canvas(files: tuple[str, ...]) -> None:
    canvas = ("--roster", "canvas.csv", *files[2:4], *files[6:])
    invoke("gradebook", "queue", *canvas, "--for", "canvas", "--output", "canvas_out.csv")
    rows = list(csv.reader(io.StringIO(Path("canvas_out.csv").read_text())))
    assert rows[0] == [*_titles("canvas.csv")[:5], "Along my hall (345)"]
    assert rows[1][0] == "    Points Possible"
    assert len(rows) == HANDED_IN + MISSING + 2
    assert sum(bool(row[-1]) for row in rows[2:]) > HANDED_IN / 2
