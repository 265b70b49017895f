"""A launch file that repeats or contains itself without end is refused with its line, soon and in little memory."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

import pytest

from kit.ros.launch.actions import LogInfo, OpaqueFunction
from kit.ros.launch.bounds import MAX_ACTIONS, MAX_DEPTH, MAX_LOGGED, MAX_PROCESSES
from kit.ros.launch.context import LaunchError
from kit.ros.launch.description_sources import load_launch_file
from kit.ros.launch.entity import LaunchDescription
from kit.ros.launch.expressions import evaluate
from kit.ros.launch.frontend.markup_reader import read_launch_description
from kit.ros.launch.loops import ForLoop
from kit.ros.launch.processes import Node
from kit.ros.launch.service import LaunchService
from kit.ros.launch.settings import GroupAction
from tests.ros.launch.conftest import Play

DEEP = MAX_DEPTH + 1
XML = {
    "groups": "<launch>" + "<group>\n" * DEEP + "</group>" * DEEP + "</launch>",
    "substitutions": f'<launch>\n<let name="x" value="{"$(var " * DEEP}a{")" * DEEP}"/></launch>',
    "rounds": '<launch>\n<for len="1000000000" name="i"><log message="x"/></for></launch>',
    "rounds in rounds": '<launch>\n<for len="400" name="i">\n<for len="400" name="j"><log message="x"/></for></for></launch>',
    "texts": '<launch>\n<let name="x" value="aaaa"/>'
    + '<let name="x" value="$(var x)$(var x)"/>' * 60
    + "</launch>",
    "entities": '<!DOCTYPE l [\n<!ENTITY a "b">]><launch><log message="&a;"/></launch>',
}
YAML = {
    "itself": "launch:\n - group: &a\n   - group: *a\n",
    "aliases": "launch:\n - group: &a0\n   - log: {message: x}\n"
    + "".join(f" - group: &a{i + 1}\n   - group: *a{i}\n   - group: *a{i}\n" for i in range(40)),
    "brackets": "launch:\n" + "[" * 5000,
    "names": "launch:\n - log: {? [x]\n : y}\n",
    "a name": "launch:\n - {[a, b]: {message: x}}\n",
}  # fmt: skip


def carry_out(path: str, source: str) -> None:
    LaunchService(path, {}, environment={}).start(read_launch_description(path, source.encode()))


def refused(path: str, source: str) -> LaunchError:
    with pytest.raises(LaunchError) as caught:
        carry_out(path, source)
    return caught.value


@pytest.mark.parametrize("case", XML)
def test_xml_without_end(case: str) -> None:
    problem = refused("/l/a.launch.xml", XML[case])
    assert problem.location is not None
    assert (problem.location.file, problem.location.line > 1 or case == "names") == ("/l/a.launch.xml", True)


@pytest.mark.parametrize("case", YAML)
def test_yaml_without_end(case: str) -> None:
    problem = refused("/l/a.launch.yaml", YAML[case])
    assert problem.location is not None
    assert problem.location.line > 1


def test_what_is_large_and_ends_is_carried_out() -> None:
    half = MAX_DEPTH // 4
    carry_out("/l/a.launch.xml", f"<launch>{'<group>' * half}{'</group>' * half}</launch>")
    carry_out(
        "/l/a.launch.xml", '<launch><for len="500" name="i"><let name="x" value="$(index i)"/></for></launch>'
    )


def test_files_that_include_each_other_twice_and_again(tmp_path: Path) -> None:
    """2 to the 20 files, of 21."""
    for number in range(20):
        text = f'<include file="$(dirname)/{number + 1}.launch.xml"/>' * 2
        (tmp_path / f"{number}.launch.xml").write_text(f"<launch>{text}</launch>")
    (tmp_path / "20.launch.xml").write_text("<launch/>")
    first = tmp_path / "0.launch.xml"
    problem = refused(str(first), first.read_text())
    assert problem.location is not None
    assert Path(problem.location.file).parent == tmp_path


def test_what_a_description_in_python_contains_itself(play: type[Play]) -> None:
    itself = LaunchDescription([])
    itself.add_entity(itself)
    deep: Any = LogInfo(msg="x")
    for _ in range(DEEP):
        deep = GroupAction([deep])
    for entity in (itself, deep, again := OpaqueFunction(function=lambda context: [again])):
        with pytest.raises(LaunchError):
            play(entity)
    with pytest.raises(LaunchError):
        itself.get_launch_arguments()


def test_more_than_is_carried_out_at_once(play: type[Play]) -> None:
    node = Node(package="demo", executable="drive")
    assert play(*[node] * MAX_PROCESSES).kinds == ["process"] * MAX_PROCESSES
    log = LogInfo(msg="x" * 1000)
    for entities in (
        [node] * (MAX_PROCESSES + 1),
        [log] * (MAX_LOGGED // 1000),
        [ForLoop(MAX_ACTIONS + 1, function=lambda i: [])],
    ):
        with pytest.raises(LaunchError) as caught:
            play(*entities)
        assert caught.value.location is not None
        assert caught.value.location.file == __file__


def test_what_is_counted_begins_anew_with_each_answer(play: type[Play]) -> None:
    launch = play(LogInfo(msg="x"))
    launch.service.start(LaunchDescription([LogInfo(msg="y" * (MAX_LOGGED // 2))]))
    launch.service.start(LaunchDescription([LogInfo(msg="y" * (MAX_LOGGED // 2))]))


def test_an_expression_fails_with_its_own_words(tmp_path: Path) -> None:
    file = tmp_path / "a.launch.xml"
    file.write_text("<launch>\n<include file=\"$(eval '1/0')\"/></launch>")
    service = LaunchService(str(file), {}, environment={})
    with pytest.raises(LaunchError, match="ZeroDivisionError") as caught:
        service.start(load_launch_file(service.context, str(file)))
    assert caught.value.location is not None
    assert caught.value.location.line == 2


@pytest.mark.parametrize(
    "expression",
    [
        "9**9**9**9",
        "(-9)**9**9",
        "1 << 10**12",
        "2**60000 * 2**60000",
        "'a' * 10**12",
        "10**12 * (0,)",
        "factorial(10**9)",
        "comb(10**9, 10**8)",
        "perm(10**9)",
        "sum(range(10**12))",
        "[[[[0] * 1000] * 1000] * 1000] * 1000",
        "[n**9**9 for n in (9,)]",
        "next(n << 10**12 for n in (9,))",
        "(lambda n: n * 10**12)('a')",
    ],
)
def test_an_expression_whose_result_would_be_very_large_is_not_computed(expression: str) -> None:
    problem = refused(
        "/l/a.launch.xml", f'<launch>\n<log message="$(eval &quot;{escape(expression)}&quot;)"/></launch>'
    )
    assert problem.location is not None
    assert (problem.location.file, problem.location.line) == ("/l/a.launch.xml", 2)
    assert "ExpressionTooLarge" not in str(problem)


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("2**10 << 3", "8192"),
        ("1**10**30", "1"),
        ("0 << 10**9", "0"),
        ("2.5**2 * 'a'.count('a')", "6.25"),
        ("3 * [1]", "[1, 1, 1]"),
        ("factorial(5) + comb(4, 2) + perm(3)", "132"),
        ("pow(2, 3) + sum(range(10, 0, -3))", "30.0"),
        ("9 // 2 * -1", "-4"),
    ],
)
def test_an_expression_within_bounds_has_the_value_that_python_gives(expression: str, value: str) -> None:
    assert evaluate(expression, None) == value
