"""Which file is taken for a controller."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.controllers import find_controller


@pytest.mark.parametrize("name", ["map.yaml", "notes.txt", "mine.py.orig", "drive.npz", "mine.pyc"])
def test_a_file_of_another_kind_is_no_program_though_python_could_read_it(tmp_path: Path, name: str) -> None:
    file = tmp_path / name
    file.write_text("image: map.png\nresolution: 0.04\n")
    with pytest.raises(LookupError, match=r"a controller is a Python file, NAME\.py"):
        find_controller(str(file))


@pytest.mark.parametrize("name", ["mine.py", "Mine.PY", "mine"])
def test_a_program_is_found_by_its_path(tmp_path: Path, name: str) -> None:
    file = tmp_path / name
    file.write_text('"""Drives."""\n')
    assert find_controller(str(file)).file == file
