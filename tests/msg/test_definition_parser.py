"""Texts of definitions: what they may hold, and what an error says about the others."""

from __future__ import annotations

import pytest

from kit.msg.class_builder import build_interface
from kit.msg.definition_parser import DefinitionError
from kit.msg.fields import FieldError
from kit.msg.interfaces import find_interface, find_message
from kit.msg.message import Action, Message
from tests.cases import every_case


def built(text: str, name: str = "my_msgs/msg/Sample") -> type[Message]:
    return build_interface(name, text, "Sample.msg", find_message, is_custom=True)  # type: ignore[return-value]  # a message, by its text


def test_every_kind_of_field_has_its_default() -> None:
    sample = built(
        """
        # A comment.
        float64 speed 1.5   # behind a field
        bool on true
        byte flag 7
        string label "a \\"b\\" c"
        string<=5 short
        int32[] numbers [1, -2, 0x10]
        float64[3] gains [1, 2.5, 3]
        string[<=2] words ["a, b", 'c']
        geometry_msgs/Point[2] corners
        bool[2] switches
        wstring wide
        """
    )
    message = sample()
    assert (message.speed, message.on, message.flag, message.label) == (1.5, True, b"\7", 'a "b" c')
    assert (message.short, message.wide) == ("", "")
    assert message.numbers.tolist() == [1, -2, 16]
    assert message.gains.tolist() == [1.0, 2.5, 3.0]
    assert message.words == ["a, b", "c"]
    assert (len(message.corners), message.switches) == (2, [False, False])
    message.numbers.append(4)
    message.words[0] = "changed"
    assert sample().numbers.tolist() == [1, -2, 16]
    assert sample().words == ["a, b", "c"]


def test_bounds_are_kept() -> None:
    sample = built("string<=3 name\nint8[<=2] few\nbool[2] pair\ngeometry_msgs/Point[<=1] points\n")
    assert sample(name="abc", few=[1, 2], pair=[True, False]).name == "abc"
    for wrong in ({"name": "abcd"}, {"few": [1, 2, 3]}, {"pair": [True]}):
        with pytest.raises(FieldError):
            sample(**wrong)
    assert sample.get_fields_and_field_types() == {
        "name": "string<3>",
        "few": "sequence<int8, 2>",
        "pair": "boolean[2]",
        "points": "sequence<geometry_msgs/Point, 1>",
    }


def test_constants_are_attributes() -> None:
    sample = built("uint8 A=1\nfloat32 HALF = 0.5\nstring NAME='x y'\nbool YES=true\nuint8 a\n")
    assert (sample.A, sample.HALF, sample.NAME, sample.YES) == (1, 0.5, "x y", True)
    assert list(sample.get_fields_and_field_types()) == ["a"]


@every_case(
    ("text", "place", "reason"),
    [
        ("float64", "1:1", "needs a type and a name"),
        ("\nfloat64 x-y", "2:1", "needs a type and a name"),
        ("floot64 x", "1:1", "my_msgs/msg/floot64"),
        ("geometry_msgs/Pont x", "1:1", "did you mean 'geometry_msgs/msg/Point'"),
        ("Header header", "1:1", "write std_msgs/Header"),
        ("time stamp", "1:1", "builtin_interfaces/Time"),
        ("int8 Speed", "1:6", "lower case"),
        ("int8 low=1", "1:6", "upper case"),
        ("int8 LOW=", "1:6", "no value"),
        ("int8 LOW=300", "1:10", "-128 to 127"),
        ("int8 x\nint8 x", "2:6", "used twice"),
        ("int8 x one", "1:8", "'one' is no int8"),
        ("int8[2] x [1, 2, 3]", "1:11", "exactly 2"),
        ("int8[] x 1", "1:10", "must be a list"),
        ("geometry_msgs/Point x 1", "1:23", "no default"),
        ("int8<=3 x", "1:1", "only strings"),
        ("int8[<=] x", "1:1", "needs a number"),
        ("int8[0] x", "1:1", "at least one"),
        ("int8[1000001] x", "1:1", "at most 1000000"),
        ("int8 x\n---\nint8 y", "2:1", "one '---' too many"),
    ],
)
def test_an_error_names_the_file_the_line_and_the_column(text: str, place: str, reason: str) -> None:
    with pytest.raises(DefinitionError, match=reason) as problem:
        built(text)
    assert str(problem.value).startswith(f"Sample.msg:{place}: ")


def test_a_service_needs_two_sections() -> None:
    with pytest.raises(DefinitionError, match=r"a \.srv file needs 2 sections"):
        built("int8 x", "my_msgs/srv/Sample")


def test_an_action_has_the_services_and_messages_that_carry_it() -> None:
    action = find_interface("example_interfaces/action/Fibonacci")
    assert issubclass(action, Action)
    assert action.Goal(order=3).order == 3
    impl = action.Impl
    request = impl.SendGoalService.Request(goal=action.Goal(order=5))
    assert len(request.goal_id.uuid) == 16
    assert list(impl.SendGoalService.Response.get_fields_and_field_types()) == ["accepted", "stamp"]
    assert impl.GetResultService.Response.get_fields_and_field_types() == {
        "status": "int8",
        "result": "example_interfaces/Fibonacci_Result",
    }
    assert find_interface("example_interfaces/action/Fibonacci_SendGoal") is impl.SendGoalService
    assert find_message("example_interfaces/action/Fibonacci_FeedbackMessage") is impl.FeedbackMessage
    with pytest.raises(NotImplementedError, match=r"Fibonacci\.Goal\(\)"):
        action()
