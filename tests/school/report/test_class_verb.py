"""``kit class report``: what it prints, what it writes, what it exits with."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from kit.cli import main
from kit.school.report.class_report import CHAPTER_IDS
from tests.school.report.class_builder import NAMES, classroom


def report(*arguments: object) -> Result:
    result = CliRunner().invoke(main, ["class", "report", *map(str, arguments)])
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("class")
    for number, file in enumerate(classroom(made, 6)):
        file.rename(file.with_name(f"{number}.json"))  # a file may be named after its student
    return made


@pytest.mark.long
def test_nobody_is_named_unless_asked(folder: Path) -> None:
    quiet = report(folder).stdout
    assert not any(f" {name} " in quiet or f"{name}:" in quiet for name in NAMES[:6])
    assert "S1" in quiet
    named = report(folder, "--names", "--only", "experience,lessons").stdout
    assert all(name in named for name in NAMES[:6])


@pytest.mark.long
def test_everything_that_can_be_written(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "deep" / "er"
    result = report(
        folder, "--svg", out, "--csv", out, "--html", tmp_path / "page.html", "--json", tmp_path / "all.json"
    )
    assert result.exit_code == 0
    content = json.loads((tmp_path / "all.json").read_text())
    blocks = [block for chapter in content["chapters"] for block in chapter["blocks"]]
    for key, ending in (("table", "csv"), ("bars", "svg"), ("scatter", "svg"), ("histogram", "svg")):
        assert {block[key] for block in blocks if key in block} <= {
            each.stem for each in out.glob(f"*.{ending}")
        }
    assert (tmp_path / "page.html").read_text().startswith("<!DOCTYPE html>")
    assert "Class report" in result.stdout


def test_json_for_a_pipe_is_nothing_else(folder: Path) -> None:
    result = report(folder, "--json", "-", "--only", "quiz")
    assert [each["id"] for each in json.loads(result.stdout)["chapters"]] == ["quiz"]


@pytest.mark.parametrize("way", ["mean", "half", "scale"])
def test_the_division_can_be_chosen(folder: Path, way: str) -> None:
    assert report(folder, "--division", way, "--only", "experience").exit_code == 0


def test_no_progress_at_all(tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text("{}")
    result = report(tmp_path)
    assert result.exit_code == 1
    assert "a.json" in result.output
    assert "kit progress export" in result.output


@pytest.mark.long
def test_mistakes_of_the_command_line(folder: Path, tmp_path: Path) -> None:
    wrong = report(folder, "--only", "quizz")
    assert wrong.exit_code == 2
    assert "quiz" in wrong.output
    nowhere = report(folder, "--html", tmp_path / "gone" / "page.html")
    assert nowhere.exit_code == 2
    assert "page.html" in nowhere.output
    file = tmp_path / "file"
    file.write_text("")
    assert report(folder, "--svg", file / "under").exit_code == 2
    assert file.read_text() == ""


def test_help_lists_every_chapter() -> None:
    words = report("--help").output.replace(",", " ").split()
    assert set(CHAPTER_IDS) <= set(words) | {word.rstrip(".") for word in words}


def test_what_a_file_is_called_commands_no_terminal(tmp_path: Path) -> None:
    (tmp_path / "x\x1b]0;owned\x07.json").write_text("no export")
    found = report(tmp_path)
    assert "owned" in found.stderr
    assert all(sign.isprintable() or sign == "\n" for sign in found.output)
