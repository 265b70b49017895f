"""Nothing that a program says, or is called, leaves the grader as anything but text."""

from __future__ import annotations

import json
import re
from typing import Final
from xml.etree import ElementTree

import pytest

from grader.assignment import Assignment
from grader.grading import GradingOptions, grade
from grader.reports import FORMATS
from grader.submission import Submission
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import CriterionStatus, GradingVerdict
from tests.grader.test_attacks import ANNOTATION

HOSTILE: Final = (
    "\\x01\\x07\\x08\\x0c\\x1b[31m\\x1b]0;t\\x07\\x7f\\x85\\x9b31m\\u2028\\u202e\\u2066\\u200b\\ufeff\\ufffe\\uffff"
    "\\ud800\\udcff\\U000e0061\\u034f\\u3164\\U000e0100</script>]]>&<img>|`$(x)`::error::x\\n::set-output name=a::b\\r##[error]"
)
HEAD: Final = f"""
import os, sys
import rclpy
from rclpy.node import Node
from std_msgs.msg import String
TEXT = "{HOSTILE}"
rclpy.init()
"""
PLACES: Final = {
    "printed": "print(TEXT)",
    "bytes": "os.write(1, b'\\xff\\xfe\\x00' * 100); os.write(2, TEXT.encode('utf-8', 'surrogatepass'))",
    "an error": "raise ValueError(TEXT)",
    "an error's class": "raise type('\\u202eX\\x1b[31m', (Exception,), {})(TEXT)",
    "an error that interrupts": "class E(Exception):\n    def __str__(self): raise KeyboardInterrupt\nraise E(TEXT)",
    "a syntax error": "raise SyntaxError(TEXT, (__file__, -5, None, None))",
    "an error's cause": "raise OSError(1, TEXT, TEXT) from KeyError(TEXT)",
    "a group of errors": "raise ExceptionGroup(TEXT, [ValueError(TEXT)])",
    "its exit": "sys.exit(TEXT)",
    "a node": "Node(TEXT)",
    "a namespace": "Node('a', namespace=TEXT)",
    "a topic": "Node('a').create_publisher(String, TEXT, 10)",
    "a parameter": "Node('a').declare_parameter(TEXT, TEXT)",
    "a log": "Node('a').get_logger().info(TEXT)",
    "a module": "__import__(TEXT)",
    "an attribute": "getattr(rclpy, TEXT)",
    "a function": "def f(): 1 / 0\nf.__code__ = f.__code__.replace(co_name=TEXT, co_filename=__file__)\nf()",
    "a message": "n = Node('a')\nn.create_publisher(String, 'cmd_vel', 10).publish(String(data=TEXT))\nrclpy.spin_once(n)",
}  # fmt: skip


@pytest.mark.sampled(4)
@pytest.mark.parametrize("place", PLACES)
def test_no_text_of_a_program_leaves_as_anything_but_text(place: str, quick: Assignment) -> None:
    work = Submission("work", quick.submit, {quick.submit: f"{HEAD}{PLACES[place]}\n".encode()})
    result = grade(quick, work, GradingOptions(Level.LIMITED))
    assert result.verdict is GradingVerdict.FAIL
    for test in result.tests:
        assert test.status is not CriterionStatus.PROTOCOL_ERROR, "its own words disturb no communication"
        assert "crashed" not in test.rationale
    for form, kind in FORMATS.items():
        text = kind.write(result)
        assert text.encode("utf-8"), form
        assert all(sign.isprintable() or sign == "\n" for sign in text), form
        assert not set(text) & set("\u034f\u3164\U000e0100"), form
        if form == "junit":
            ElementTree.fromstring(text)
        if form == "json":
            json.loads(text)
        if form == "annotations":
            assert all(ANNOTATION.fullmatch(line) for line in text.splitlines()), text
        else:
            assert not re.search(r"^::|::set-output|##\[", text, re.MULTILINE), form
