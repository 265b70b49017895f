"""A file of functions may hold a node beside them."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.host.failure import StudentCodeError
from kit.host.student_functions import StudentFunctions
from kit.host.wire import MAX_RESULT_DEPTH


def test_the_import_names_of_ros_are_found(tmp_path: Path) -> None:
    file = tmp_path / "both.py"
    file.write_text(
        "from rclpy.node import Node\n\nclass Mine(Node):\n    pass\n\ndef twice(x):\n    return 2.0 * x\n"
    )
    with StudentFunctions(file) as functions:
        assert functions.call_json("twice", {"x": 1.5}) == 3.0


def test_a_result_of_more_items_than_anybody_looks_at_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "many.py"
    file.write_text("def many(count):\n    return [0] * int(count)\n")
    with StudentFunctions(file) as functions:
        assert functions.call_json("many", {"count": 100_000.0}) == [0.0] * 100_000
        with pytest.raises(StudentCodeError, match="many"):
            functions.call_json("many", {"count": 100_001.0})


def test_lists_in_lists_are_taken_up_to_a_depth(tmp_path: Path) -> None:
    file = tmp_path / "nested.py"
    file.write_text(
        "def nested(depth):\n    found = 1.0\n    for _ in range(int(depth)):\n        found = [found]\n    return found\n"
    )
    deepest: object = 1.0
    for _ in range(MAX_RESULT_DEPTH):
        deepest = [deepest]
    with StudentFunctions(file) as functions:
        assert functions.call_json("nested", {"depth": float(MAX_RESULT_DEPTH)}) == deepest
        with pytest.raises(StudentCodeError, match="nested"):
            functions.call_json("nested", {"depth": MAX_RESULT_DEPTH + 1.0})
