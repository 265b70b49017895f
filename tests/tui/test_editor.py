"""Which editor opens a student's file, and where: the user's own, at the line of the error."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from kit.school.lessons import aside
from kit.school.lessons.aside import editor_arguments, has_easy_editor, keys_of_vi, run_and_copy
from tests.cases import every_case

FILE = Path("/home/ada/square.py")


@every_case(
    ("environment", "line", "arguments"),
    [
        ({"EDITOR": "nano"}, 12, ["nano", "+12", str(FILE)]),
        ({"EDITOR": "nano"}, 1, ["nano", str(FILE)]),
        ({"VISUAL": "code --wait", "EDITOR": "nano"}, 12, ["code", "--wait", str(FILE)]),
        ({"EDITOR": "/usr/bin/vim -u NONE"}, 3, ["/usr/bin/vim", "-u", "NONE", "+3", str(FILE)]),
        ({"EDITOR": "'open"}, 3, None),
    ],
)
def test_the_named_editor_opens_the_file(
    environment: dict[str, str], line: int, arguments: list[str] | None
) -> None:
    assert editor_arguments(environment, FILE, line) == arguments


def test_without_a_name_the_easiest_that_is_here(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(aside.shutil, "which", lambda name: name if name == "vi" else None)
    assert editor_arguments({}, FILE, 1) == ["vi", str(FILE)]
    assert not has_easy_editor({})
    assert ":wq" in keys_of_vi({}, ["vi", str(FILE)])
    assert keys_of_vi({"EDITOR": "vi"}, ["vi", str(FILE)]) == "", "who names it knows it"
    monkeypatch.setattr(aside.shutil, "which", lambda name: None)
    assert editor_arguments({}, FILE, 1) is None
    monkeypatch.setattr(aside.shutil, "which", lambda name: name)
    assert has_easy_editor({})
    assert keys_of_vi({}, ["nano", str(FILE)]) == ""


def test_what_a_command_prints_is_copied_and_returned(tmp_path: Path) -> None:
    program = "import os, sys; print(os.get_terminal_size().columns, sys.stdout.isatty()); print('x' * 100)"
    with (tmp_path / "terminal").open("wb", buffering=0) as out:
        printed = run_and_copy(
            [sys.executable, "-c", program], dict(os.environ), tmp_path, os.terminal_size((40, 9)), out
        )
    assert (tmp_path / "terminal").read_bytes() == printed
    assert printed.split()[:2] == [b"40", b"True"]
