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
    "an attribute that is set": (
        b"class Twist:\n    __slots__ = ('linear',)\ncommand = Twist()\ncommand.linear_x = 1\n",
        4,
        "Did you mean 'linear'?",
    ),
    "a parameter of another name": (b"def f(row):\n    return row\nf(line=1)\n", 3, "keep the names"),
    "a local name": (b"def f():\n    speed = 1\n    return sped\nf()\n", 3, "Did you mean 'speed'?"),
    "a global name": (b"distance = 1\nprint(distanc)\n", 2, "Did you mean 'distance'?"),
    "a builtin": (b"print(lenn([]))\n", 1, "Did you mean 'len'?"),
    "a module not imported": (b"time.time()\n", 1, "import time"),
    "a module misspelt": (b"import numppy\n", 1, "Did you mean 'numpy'?"),
    "a module that is missing": (b"\nimport quite_unknown_xyz\n", 2, "install"),
    "Latin-1 in a comment": (b"x = 1\n# caf\xe9\n", 2, "UTF-8"),
    "what append returns": (b"kept = [].append(1)\nkept[0]\n", 2, "as append does"),
    "a list times a number": (b"rate = 0.5\nrate * [1, 2]\n", 2, "one by one"),
    "a value for a place": (b"values = [0.5]\nvalues[max(values)]\n", 2, "index(value)"),
    "an index for two": (b"table = [[1]]\ntable[0, 0]\n", 2, "table[row][column]"),
    "a function not called": (b"len[[1]]\n", 1, "round brackets"),
    "a number for a list": (b"max(3.0)\n", 1, "a single number"),
    "no whole number": (b"range(3 / 1)\n", 1, "//"),
    "one place too far": (b"[1, 2][2]\n", 1, "n - 1"),
    "one character too far": (b"'ab'[2]\n", 1, "n - 1"),
    "the largest of nothing": (b"max([])\n", 1, "is empty here"),
    "two names for three": (b"a, b = 1, 2, 3\n", 1, "another number of names"),
    "the root of a negative number": (b"import math\nmath.sqrt(-1)\n", 2, "no negative number"),
    "a value not set yet": (b"def f():\n    return x\n    x = 1\nf()\n", 2, "further down"),
    "no self": (b"class A:\n    def f():\n        pass\nA().f()\n", 4, "self"),
    "a list in a set": (b"seen = set()\nseen.add([1, 2])\n", 2, "tuple(x)"),
    "called in place of handed over": (b"def f(x):\n    pass\nprint(f())\n", 3, "its name alone"),
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


def test_an_exception_without_a_text_of_its_own_is_told_all_the_same(tmp_path: Path) -> None:
    source = b"class Odd(TypeError):\n    def __str__(self):\n        raise ValueError\nraise Odd\n"
    failure = failure_of(source, tmp_path)
    assert failure is not None
    assert (failure.line, "Odd" in failure.message) == (4, True)


def test_a_message_of_the_kit_about_none_says_enough(tmp_path: Path) -> None:
    text = "the callback must return its response, not NoneType: end it with 'return response'"
    failure = failure_of(f'raise TypeError("{text}")'.encode(), tmp_path)
    assert failure is not None
    assert text in failure.message
    assert "append" not in failure.message


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
