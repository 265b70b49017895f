"""A file of functions may hold a node beside them."""

from __future__ import annotations

from pathlib import Path

from kit.host.student_functions import StudentFunctions


def test_the_import_names_of_ros_are_found(tmp_path: Path) -> None:
    file = tmp_path / "both.py"
    file.write_text(
        "from rclpy.node import Node\n\nclass Mine(Node):\n    pass\n\ndef twice(x):\n    return 2.0 * x\n"
    )
    with StudentFunctions(file) as functions:
        assert functions.call_json("twice", {"x": 1.5}) == 3.0
