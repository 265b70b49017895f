"""A teacher's own tests for points: functions ``test_*`` in files that ``assignment.yaml`` names under ``tests``.

They run under pytest, get the fixture ``grading``, and examine recordings that the grader made::

    @pytest.mark.points(3, after="reached", hints=["Drive on the right."])
    def test_keeps_to_the_right(grading):
        \"\"\"The robot left its side of the corridor.\"\"\"
        assert all((drive.track[:, 0] > 0.4).all() for drive in grading.evidence("runs"))

The docstring is the feedback, unless the assertion has a message of its own; a test's source is never shown. ``after`` names
the criterion or earlier test that must earn everything first. Only the files named are imported, since a student may work in the assignment's folder.
"""

from __future__ import annotations

import ast
import hashlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

from grader.assignment import TeacherTest
from kit.results.grading_result import Visibility

MARK: Final = "points"
MARK_HELP: Final = (
    f"{MARK}(number, after=None, visibility='visible', hints=()): what a teacher's test is worth"
)


def read_teacher_tests(file: Path) -> Iterator[TeacherTest]:
    """Yields the tests that a file declares, without running it. Raises ValueError, OSError, SyntaxError."""
    for node in ast.parse(file.read_text(encoding="utf-8"), file.name).body:
        if isinstance(node, ast.FunctionDef) and node.name.startswith("test_"):
            marks = [each for each in node.decorator_list if isinstance(each, ast.Call) and _is_mark(each)]
            yield _read_test(node, marks[0] if marks else None, file)


def _is_mark(call: ast.Call) -> bool:
    return isinstance(call.func, ast.Attribute) and call.func.attr == MARK


def _read_test(node: ast.FunctionDef, mark: ast.Call | None, file: Path) -> TeacherTest:
    text = " ".join((ast.get_docstring(node) or "").split())
    if mark is None:
        return TeacherTest(node.name, 0.0, text)
    try:
        (points,) = map(ast.literal_eval, mark.args)
        keywords = {word.arg: ast.literal_eval(word.value) for word in mark.keywords}
        test = TeacherTest(
            node.name,
            float(points),
            text,
            Visibility(keywords.pop("visibility", Visibility.VISIBLE.value)),
            tuple(map(str, keywords.pop("hints", ()))),
            None if (after := keywords.pop("after", None)) is None else str(after),
        )
    except (ValueError, TypeError):
        keywords = {"?": None}
    if keywords or not 0.0 <= test.points <= 1e6:
        raise ValueError(
            f"{file.name}:{mark.lineno}: {MARK} takes a number from 0 on, and after, visibility and hints"
        )
    return test


def tests_digest(files: Sequence[Path]) -> str:
    """Returns a digest of what decides the outcomes of tests: their code, without what they are worth and what they say to
    whom. Empty without files. Raises OSError, SyntaxError."""
    digest = hashlib.sha256()
    for file in files:
        tree = ast.parse(file.read_text(encoding="utf-8"), file.name)
        for node in tree.body:
            if isinstance(node, ast.FunctionDef) and node.name.startswith("test_"):
                node.decorator_list = [
                    each
                    for each in node.decorator_list
                    if not (isinstance(each, ast.Call) and _is_mark(each))
                ]
                if ast.get_docstring(node) is not None:
                    node.body = [*node.body[1:], ast.Pass()]
        digest.update(ast.unparse(tree).encode())
    return digest.hexdigest()[:32] if files else ""
