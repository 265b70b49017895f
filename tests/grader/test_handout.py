"""From an example to what students get: every kind has a complete example, and no secret of it goes out."""

from __future__ import annotations

import io
import re
import zipfile
from pathlib import Path

import pytest
import yaml
from click.testing import CliRunner

from grader.__main__ import main
from grader.kinds.contract import find_kind, kind_names
from grader.new_assignment import example_of_exercise, example_of_kind, make_assignment
from grader.reading import read_assignment
from grader.seeds import short_seeds_warning
from grader.sheet_keys import COMMON_KEYS
from grader.sheet_reference import asked_keys
from grader.student_version import ReleaseRefused, StudentVersion, student_version
from kit.school.lessons.reading import lesson_names, lessons_folder, read_lesson

LONG_SEED = 3_141_592_653_589_793_238
EXERCISES = [
    f"{name}/{exercise.name}"
    for name in lesson_names()
    for exercise in read_lesson(lessons_folder() / name).exercises
]


@pytest.fixture
def hall(tmp_path: Path) -> Path:
    """The controller's example, with a long secret seed."""
    folder = tmp_path / "hall"
    make_assignment(example_of_kind("controller"), folder)
    (folder / "secret.yaml").write_text(f"seeds:\n  there: [{LONG_SEED}]\n  back: [{LONG_SEED + 1}]\n")
    return folder


def released(folder: Path) -> StudentVersion:
    return student_version(read_assignment(folder))


@pytest.mark.parametrize("kind", kind_names())
def test_every_kind_has_an_example_with_all_its_works(kind: str, tmp_path: Path) -> None:
    done = CliRunner().invoke(main, ["new", str(tmp_path / "new"), "--kind", kind])
    assert done.exit_code == 0, done.output
    assert read_assignment(tmp_path / "new").kind == kind
    names = {each.name.partition(".")[0] for each in (tmp_path / "new").iterdir()}
    assert {"README", "assignment", "starter", "solution", "wrong"} <= names
    assert any((tmp_path / "new" / "wrong").iterdir())


@pytest.mark.parametrize("name", EXERCISES)
def test_every_exercise_becomes_an_assignment_of_which_no_secret_goes_out(name: str, tmp_path: Path) -> None:
    make_assignment(example_of_exercise(name), tmp_path / "new")
    version = student_version(read_assignment(tmp_path / "new"))
    assert "assignment.yaml" in version.files
    assert not [each for each in version.files if re.match(r"secret|solution|wrong|reference", each)]


def test_an_unknown_exercise_names_the_near_ones(tmp_path: Path) -> None:
    done = CliRunner().invoke(main, ["new", str(tmp_path / "new"), "--from", "11/your_rewrd"])
    assert done.exit_code == 2
    assert "your_reward" in done.output
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize("name", [None, *EXERCISES])
def test_a_new_assignment_has_secret_seeds_of_its_own(name: str | None, tmp_path: Path) -> None:
    example = example_of_kind("controller") if name is None else example_of_exercise(name)
    known = {
        seed
        for folder in example.folders
        if (folder / "assignment.yaml").exists()
        for seed in read_assignment(folder).secret_seeds
    }
    made = []
    for each in ("first", "second"):
        make_assignment(example, tmp_path / each)
        made.append(read_assignment(tmp_path / each).secret_seeds)
    assert not known.intersection(*made)
    assert not set(made[0]) & set(made[1])
    assert short_seeds_warning(made[0]) == ""


@pytest.mark.parametrize("shape", ["folder", "zip", "repository"])
def test_no_secret_byte_goes_out(shape: str, hall: Path, tmp_path: Path) -> None:
    target = tmp_path / ("out.zip" if shape == "zip" else "out")
    command = ["release", str(hall), "--output", str(target)]
    command += ["--repository", "--kit", "https://example.org/kit@v1"] if shape == "repository" else []
    done = CliRunner().invoke(main, command)
    assert done.exit_code == 0, done.output
    if shape == "zip":
        with zipfile.ZipFile(target) as archive:
            files = {each: archive.read(each) for each in archive.namelist()}
    else:
        files = {
            str(each.relative_to(target)): each.read_bytes() for each in target.rglob("*") if each.is_file()
        }
    solution = {line.strip() for line in (hall / "solution.py").read_text().splitlines() if len(line) > 30}
    solution -= {line.strip() for line in (hall / "starter.py").read_text().splitlines()}
    assert solution
    for name, data in files.items():
        assert str(LONG_SEED).encode() not in data, name
        assert LONG_SEED.to_bytes(8, "little") not in data, name
        assert not [line for line in solution if line.encode() in data], name
    assert any(name.endswith("starter.py") for name in files)
    if shape == "repository":
        assert files["work/controller.py"] == (hall / "starter.py").read_bytes()
        workflow = yaml.safe_load(files[".github/workflows/grade.yml"])
        assert "\nassignment work assignment\n" in workflow["jobs"]["grade"]["steps"][-3]["run"]
        assert read_assignment(target / "assignment").title == "Round the corner"
    if shape == "folder":
        assert read_assignment(target).public_version == read_assignment(hall).public_version


def _write(name: str, text: str) -> object:
    return lambda folder: (folder / name).write_text(text)


def _archive(folder: Path) -> None:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("notes.txt", f"seed {LONG_SEED}")
    (folder / "extra.zip").write_bytes(packed.getvalue())


LEAKS = {
    "a seed in the sheet": _write("notes.txt", f"use {LONG_SEED}\n"),
    "a seed with separators": _write("notes.txt", f"SEED = {LONG_SEED:_}\n"),
    "a seed in hexadecimal": _write("notes.txt", f"SEED = {LONG_SEED:#x}\n"),
    "a seed in a binary file": lambda folder: (folder / "a.bin").write_bytes(
        b"\xff\xfe" + LONG_SEED.to_bytes(8, "little")
    ),
    "a seed in an archive": _archive,
    "the secret file under another name": lambda folder: (folder / "old.txt").write_bytes(
        (folder / "secret.yaml").read_bytes()
    ),
    "a passage of the solution": lambda folder: (folder / "notes.txt").write_text(
        "\n".join((folder / "solution.py").read_text().splitlines()[18:27])
    ),
    "a link to the solution": lambda folder: (folder / "help.py").symlink_to("solution.py"),
    "a link out of the folder": lambda folder: (folder / "help.py").symlink_to("/etc/hostname"),
}


@pytest.mark.parametrize("leak", LEAKS)
def test_a_secret_that_would_go_out_is_refused_and_named(leak: str, hall: Path, tmp_path: Path) -> None:
    released(hall)
    LEAKS[leak](hall)  # type: ignore[operator]
    with pytest.raises(ReleaseRefused) as refused:
        released(hall)
    assert str(LONG_SEED) not in str(refused.value)
    done = CliRunner().invoke(main, ["release", str(hall), "--output", str(tmp_path / "out")])
    assert done.exit_code == 2
    assert not (tmp_path / "out").exists()


def test_a_text_of_the_secret_file_is_refused(tmp_path: Path) -> None:
    make_assignment(example_of_kind("answers"), tmp_path / "new")
    released(tmp_path / "new")
    with (tmp_path / "new" / "README.md").open("a") as card:
        card.write("\nAnd the discount?\nAfter the target nothing comes.\n")
    with pytest.raises(ReleaseRefused, match=r"README\.md"):
        released(tmp_path / "new")


def test_what_students_may_not_see_yet_is_not_in_their_sheet(hall: Path) -> None:
    sheet = (hall / "assignment.yaml").read_text()
    sheet = sheet.replace("title: It is quick\n", "title: It is quick\n    visibility: after_due\n")
    sheet = sheet.replace("# tests: [test_own.py]", "tests: [test_seen.py, test_later.py] #")
    (hall / "assignment.yaml").write_text(sheet)
    test = 'import pytest\n\n@pytest.mark.points(1{})\ndef test_{}(grading):\n    """Text."""\n'
    (hall / "test_seen.py").write_text(test.format("", "seen"))
    (hall / "test_later.py").write_text(test.format(', visibility="hidden"', "later"))
    version = released(hall)
    out = version.files["assignment.yaml"].decode()
    assert "It is quick" not in out
    assert "It touches nothing" in out
    assert "# budget:" in out  # the comments stay
    assert yaml.safe_load(out)["tests"] == ["test_seen.py"]
    assert "test_seen.py" in version.files
    assert "test_later.py" not in version.files
    assert version.hidden_criteria == ("in_time", "test_later.py")


def test_the_reference_stays_unless_it_is_asked_for(tmp_path: Path) -> None:
    make_assignment(example_of_kind("function"), tmp_path / "new")
    assignment = read_assignment(tmp_path / "new")
    assert "reference.py" not in student_version(assignment).files
    assert "reference.py" in student_version(assignment, with_reference=True).files


def test_every_key_that_the_reader_asks_for_has_a_meaning_and_no_other() -> None:
    common = set(COMMON_KEYS)
    for kind in kind_names():
        asked = {path for path in asked_keys(kind) if not path.startswith("budget.")}
        own = set(find_kind(kind).sheet_keys)
        assert asked - common - own == set(), kind
        assert own - asked == set(), kind
        assert common - asked == set(), kind


@pytest.mark.parametrize("kind", kind_names())
def test_the_reference_of_a_kind_shows_its_keys(kind: str) -> None:
    done = CliRunner().invoke(main, ["help", "sheet", kind])
    assert done.exit_code == 0, done.output
    assert "checks.points" in done.output
    assert max(map(len, done.output.splitlines())) <= 80
