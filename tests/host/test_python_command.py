"""The kit's own processes start with no folder of a student's on their path."""

from __future__ import annotations

import ast
import subprocess
from pathlib import Path

import pytest

import grader
import kit
from kit.host.python_command import python_command

SOURCE_FILES = [file for each in (kit, grader) for file in sorted(Path(each.__path__[0]).rglob("*.py"))]


@pytest.mark.parametrize("module", ["kit", "grader"])
def test_a_file_in_the_current_folder_is_not_imported(tmp_path: Path, module: str) -> None:
    marks = tmp_path / "marks"
    marks.mkdir()
    for name in ("kit", "grader", "runpy", "json", "queue", "sitecustomize", "click"):
        (tmp_path / f"{name}.py").write_text(f"open({str(marks / name)!r}, 'w').close()\n")
    done = subprocess.run(
        python_command(module, "--help"), cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert [each.name for each in marks.iterdir()] == []


def _words(node: ast.AST) -> list[str]:
    """The words of a command written as a list or tuple: constants as they are, the rest as source."""
    items = node.elts if isinstance(node, ast.List | ast.Tuple) else []
    return [str(each.value) if isinstance(each, ast.Constant) else ast.unparse(each) for each in items]


def test_every_python_process_is_started_so() -> None:
    """-P, or another option that leaves the current folder out: found by the words of the command in the source."""
    commands = {
        f"{file}:{node.lineno}": words
        for file in SOURCE_FILES
        for node in ast.walk(ast.parse(file.read_text()))
        if isinstance(node, ast.List | ast.Tuple)
        and "sys.executable" in (words := _words(node))
        and len(words) > 1
    }
    starts = {place: words for place, words in commands.items() if {"-m", "-c"} & set(words)}
    assert len(starts) >= 3
    assert {place for place, words in starts.items() if not {"-P", "-I"} & set(words)} == set()
    assert [place for place, words in starts.items() if "-m" in words] == [
        place for place in starts if "python_command.py" in place
    ]
