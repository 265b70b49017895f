"""What README.md and the pages of lessons/ say is so. ``python tests/test_readme.py`` makes the README's moving picture, the
table of lessons and the teacher's guide again."""

from __future__ import annotations

import re
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from kit.cli import VERBS
from kit.help.topics import design
from kit.school.lessons.reading import lesson_names
from kit.school.lessons.teachers_guide import teachers_guide
from tests.cli.verbs import kit
from tests.help.page_commands import unknown_options
from tests.kit_content import kit_lesson

README = Path(__file__).parent.parent / "README.md"
LESSONS = Path(__file__).parent.parent / "lessons" / "README.md"
GUIDE = LESSONS.with_name("GUIDE.md")
FIRST, LAST = "<!-- lessons -->\n", "<!-- end of lessons -->\n"


def table() -> str:
    """The lessons, and what each covers."""
    rows = ["| Number | Lesson | Minutes | Exercises | Covers |", "|---|---|---|---|---|"]
    for name in lesson_names():
        lesson = kit_lesson(name)
        exercises = ", ".join(exercise.name for exercise in lesson.exercises)
        rows.append(
            f"| {lesson.number} | {name} | {lesson.minutes} | {exercises} | {', '.join(lesson.outcome_ids)} |"
        )
    return "\n".join(rows) + "\n"


def test_the_table_of_lessons_is_true() -> None:
    text = LESSONS.read_text()
    assert text[text.index(FIRST) + len(FIRST) : text.index(LAST)] == table()


def test_the_number_of_lessons_is_true() -> None:
    assert re.findall(r"(\d+) lessons\b", README.read_text()) == [str(len(lesson_names()))]


def test_the_teachers_guide_is_what_the_lessons_say() -> None:
    assert GUIDE.read_text() == teachers_guide(), "run python tests/test_readme.py"


PICTURE = README.parent / ".github" / "drive.svg"
DRIVER = README.parent / "tests" / "solutions" / "09-your-own-controller" / "wanderer" / "solution.py"


def make_picture(folder: Path) -> bytes:
    """The README's moving picture, by the commands that it names: a drive, recorded and drawn."""
    recording, picture = folder / "run.npz", folder / "drive.svg"
    drive = ["run", "racetrack", "--controller", DRIVER, "--seed", 1, "--steps", 8000, "--until-reached"]
    kit(*drive, "--record", recording)
    kit("replay", recording, "--export", picture, "--speed", 4, "--size", "640x400")
    return picture.read_bytes()


@pytest.mark.long
def test_the_moving_picture_is_a_drive_of_the_kit(tmp_path: Path) -> None:
    assert make_picture(tmp_path) == PICTURE.read_bytes(), "run python tests/test_readme.py"


def test_every_picture_that_it_shows_is_there() -> None:
    shown = re.findall(r"!\[.+\]\((.+)\)", README.read_text())
    assert shown == [".github/drive.svg"]
    assert all((README.parent / each).is_file() for each in shown)


def test_every_file_that_it_links_is_there() -> None:
    linked = re.findall(r"(?<!!)\[[^]]+\]\(([^)]+)\)", README.read_text())
    assert len(linked) >= 5
    assert all((README.parent / each).is_file() for each in linked)


def test_its_paths_have_five_lines() -> None:
    section = README.read_text().split("## Four paths")[1].split("\n## ")[0]
    paths = re.findall(r"^```\n(.*?)^```", section, re.M | re.S)
    assert [len(each.splitlines()) for each in paths] == [5, 5, 5, 5]


COMMAND = re.compile(r"^((?:kit|grader) .*?)(?:  |$)", re.M)


def test_every_command_and_option_it_names_exists() -> None:
    found = COMMAND.findall(README.read_text()) + re.findall(r"`((?:kit|grader) [^`]+)`", README.read_text())
    assert len(found) > 20
    for each in found:
        assert unknown_options(each) == set(), each


def test_every_benchmark_it_names_exists() -> None:
    named = re.findall(r"`python (tests/benchmarks/\S+)`", README.read_text())
    assert len(named) >= 3
    assert all((README.parent / each).is_file() for each in named)


def test_every_verb_it_names_exists() -> None:
    named = set(re.findall(r"`kit ([a-z]+)", README.read_text()))
    assert named <= set(VERBS)


ROOT = README.parent
CONTRIBUTING = ROOT / ".github" / "CONTRIBUTING.md"
PARTS = ("kit", "grader", "tests", "lessons", "maps", ".github")
PRODUCT_PATH = re.compile(r"`((?:kit|grader)/[\w/]+(?:\.py|/)?)`")


def walks() -> dict[str, list[list[str]]]:
    """The walks of CONTRIBUTING.md: by title, for each step the modules it names."""
    section = CONTRIBUTING.read_text().split("## Walks through the code")[1].split("\n## ")[0]
    titles = re.split(r"^\*\*(.+)\*\*$", section, flags=re.MULTILINE)[1:]
    return {
        title: [PRODUCT_PATH.findall(step) for step in re.split(r"^\d+\. ", text, flags=re.MULTILINE)[1:]]
        for title, text in zip(titles[::2], titles[1::2], strict=True)
    }


@pytest.mark.parametrize("title", list(walks()))
def test_a_walk_never_goes_back_to_a_room(title: str) -> None:
    steps = walks()[title]
    assert len(steps) >= 4
    rooms: list[str] = []
    for module in (module for step in steps for module in step):
        assert (ROOT / module).is_file(), module
        room = module.rpartition("/")[0] if module.startswith("grader/") else "/".join(module.split("/")[:2])
        if not rooms or rooms[-1] != room:
            assert room not in rooms or room == "grader", f"{title}: back to {room}"
            rooms.append(room)


@pytest.mark.parametrize(
    "text", [README, CONTRIBUTING, LESSONS, ROOT / "maps" / "README.md"], ids=lambda path: path.parent.name
)
def test_every_path_it_names_exists(text: Path) -> None:
    named = [path for path in PRODUCT_PATH.findall(text.read_text()) if "NAME" not in path]
    assert [path for path in named if not (ROOT / path).exists()] == []


NAMED_FILE = re.compile(r"`([\w./-]+\.(?:py|md|yaml|toml))`")
NAMED_CONSTANT = re.compile(r"`([A-Z][A-Z_]{3,})`")


def test_every_file_and_record_that_is_to_be_added_to_exists() -> None:
    section = CONTRIBUTING.read_text().split("## How to add")[1].split("\n## ")[0]
    files = {str(path.relative_to(ROOT)) for folder in PARTS for path in (ROOT / folder).rglob("*.*")}
    known = "".join("/" + file + "\n" for file in files)
    examples = re.compile(
        r"NAME|NN|MAP|\.pt\.|^(?:about|map|world|lesson|quiz|solution|wrong)\b|assignment\.yaml"
    )
    named = [file for file in NAMED_FILE.findall(section) if not examples.search(file)]
    assert len(named) >= 8
    assert [file for file in named if f"/{file}\n" not in known] == []
    sources = "".join(
        path.read_text() for folder in ("kit", "grader") for path in (ROOT / folder).rglob("*.py")
    )
    assert [
        name for name in NAMED_CONSTANT.findall(section) if not re.search(rf"^{name}\b", sources, re.M)
    ] == []


def test_the_drawing_names_every_room() -> None:
    drawing = design.DRAWING
    rooms = {
        path.stem
        for path in (ROOT / "kit").iterdir()
        if not path.name.startswith(("_", ".")) and path.suffix in ("", ".py")
    }
    drawn = set(re.findall(r"kit/(\w+)", drawing))
    assert drawn <= rooms | {"data"}
    assert rooms - {"data"} <= drawn


def test_the_readme_is_short() -> None:
    assert (
        len(README.read_text().split()) <= 1_400
    )  # of which the study's tables, made from its logs, take 250


if __name__ == "__main__":
    with TemporaryDirectory() as made:
        PICTURE.write_bytes(make_picture(Path(made)))
    text = LESSONS.read_text()
    head, tail = text.index(FIRST) + len(FIRST), text.index(LAST)
    LESSONS.write_text(text[:head] + table() + text[tail:])
    GUIDE.write_text(teachers_guide())
