"""A student's file as a module, and what its exceptions say."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from kit.host.child.student_module import MAX_MESSAGE, StudentProgram, explain
from kit.host.failure import Failure
from tests.cases import every_case


def failure_of(source: bytes, folder: Path) -> Failure | None:
    program = StudentProgram(str(folder / "mine.py"), source)
    try:
        program.load("a_students_file")
    except Exception as problem:  # noqa: BLE001 - whatever the file raises is what is explained
        return explain(problem, program)
    finally:
        sys.modules.pop("a_students_file", None)
    return None


MISTAKES = {
    "an attribute": (b"import math\nmath.sqroot(2)\n", 2, "Did you mean 'sqrt'?"),
    "a local name": (b"def f():\n    speed = 1\n    return sped\nf()\n", 3, "Did you mean 'speed'?"),
    "a global name": (b"distance = 1\nprint(distanc)\n", 2, "Did you mean 'distance'?"),
    "a builtin": (b"print(lenn([]))\n", 1, "Did you mean 'len'?"),
    "a module not imported": (b"time.time()\n", 1, "import time"),
    "a module misspelt": (b"import numppy\n", 1, "Did you mean 'numpy'?"),
    "a module that is missing": (b"\nimport quite_unknown_xyz\n", 2, "install"),
    "Latin-1 in a comment": (b"x = 1\n# caf\xe9\n", 2, "UTF-8"),
    "UTF-16": ("x = 1\n".encode("utf-16"), 1, "UTF-8"),
    "a null byte": (b"x = 1\ny = 2\0\n", 2, "UTF-8"),
}


@every_case("case", MISTAKES)
def test_a_mistake_names_its_line_and_the_way_out(case: str, tmp_path: Path) -> None:
    source, line, way_out = MISTAKES[case]
    failure = failure_of(source, tmp_path)
    assert failure is not None
    assert (failure.file, failure.line) == ("mine.py", line)
    assert way_out in failure.message


def test_a_name_like_no_other_gets_no_guess(tmp_path: Path) -> None:
    failure = failure_of(b"qqzzxy\n", tmp_path)
    assert failure is not None
    assert "mean" not in failure.message


@pytest.mark.parametrize(
    "source",
    [b"# -*- coding: latin-1 -*-\n# caf\xe9\n", b"\xef\xbb\xbfx = 1\n", "x = 'é'\r\n".encode()],
    ids=["declared", "byte order mark", "CRLF"],
)
def test_what_python_itself_reads_is_read(source: bytes, tmp_path: Path) -> None:
    assert failure_of(source, tmp_path) is None


def test_the_text_of_an_exception_is_cut(tmp_path: Path) -> None:
    for length in (MAX_MESSAGE, MAX_MESSAGE + 1):
        failure = failure_of(f"raise ValueError('x' * {length})".encode(), tmp_path)
        assert failure is not None
        assert failure.message.count("x") == MAX_MESSAGE
