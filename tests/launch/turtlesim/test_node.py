"""What turtlesim's tutorials rely on: how turtles move, what they draw, services, parameters and the action."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from kit.launch.turtlesim import paper as paper_module
from kit.launch.turtlesim.paper import SIDE_M, SPACING_M, Paper, Pen
from kit.msg.action_msgs import GoalStatus
from kit.msg.rcl_interfaces import Parameter as ParameterMessage
from kit.msg.rcl_interfaces import ParameterType, ParameterValue, SetParameters
from kit.msg.std_srvs import Empty
from kit.msg.turtlesim import (
    Color,
    Kill,
    RotateAbsolute,
    SetPen,
    Spawn,
    TeleportAbsolute,
    TeleportRelative,
)
from kit.ros.action.client import ActionClient
from tests.launch.turtlesim.conftest import Field

Make = Callable[..., Field]


def test_the_graph_is_turtlesim_s(field: Make) -> None:
    world = field()
    topics = dict(world.node.get_topic_names_and_types())
    for topic, kind in (("cmd_vel", "geometry_msgs/msg/Twist"), ("pose", "turtlesim/msg/Pose"),
                        ("color_sensor", "turtlesim/msg/Color")):  # fmt: skip
        assert topics[f"/turtle1/{topic}"] == [kind]
    services = dict(world.node.get_service_names_and_types())
    assert {
        "/clear", "/reset", "/spawn", "/kill", "/turtle1/set_pen", "/turtle1/teleport_absolute",
        "/turtle1/teleport_relative", "/turtle1/rotate_absolute/_action/send_goal",
    } <= services.keys()  # fmt: skip
    assert world.said == [
        "Starting turtlesim with node name /turtlesim",
        "Spawning turtle [turtle1] at x=[5.544444], y=[5.544444], theta=[0.000000]",
    ]


def test_a_command_holds_for_a_second(field: Make) -> None:
    world = field()
    world.command(2.0, 1.8)
    world.advance(0.5)
    assert (world.pose.linear_velocity, world.pose.angular_velocity) == pytest.approx((2.0, 1.8))
    assert world.pose.theta == pytest.approx(0.9, abs=0.05)
    world.advance(1.0)
    assert (world.pose.linear_velocity, world.pose.angular_velocity) == (0.0, 0.0)
    radius = math.hypot(world.pose.x - SIDE_M / 2, world.pose.y - SIDE_M / 2)
    assert radius == pytest.approx(2 * 2.0 / 1.8 * math.sin(0.9), abs=0.05), "the chord of an arc of 1.8 rad"


def test_poses_come_62_times_a_second(field: Make) -> None:
    world = field()
    count = 0

    def hear(_: object) -> None:
        nonlocal count
        count += 1

    from kit.msg.turtlesim import Pose

    world.node.create_subscription(Pose, "/turtle1/pose", hear, 10)
    world.advance(1.6)
    assert count == 100


def test_the_wall_clamps_and_warns(field: Make) -> None:
    world = field()
    for _ in range(5):
        world.command(3.0, 0.0)
        world.advance(0.9)
    assert world.pose.x == pytest.approx(SIDE_M, abs=1e-5)
    warning = next(text for text in world.said if "Oh no" in text)
    assert warning.startswith("Oh no! I hit the wall! (Clamping from [x=11.1")
    assert warning.endswith("y=5.544444])")
    assert world.pose.linear_velocity == 3.0, "it goes on trying"


def test_turtles_come_jump_and_go(field: Make) -> None:
    world = field()
    assert world.call(Spawn, "/spawn", x=2.0, y=3.0, theta=0.5, name="ada").name == "ada"
    assert world.call(Spawn, "/spawn", x=1.0, y=1.0, theta=0.0, name="").name == "turtle2"
    assert world.call(Spawn, "/spawn", x=1.0, y=1.0, theta=0.0, name="ada").name == ""
    assert world.call(Spawn, "/spawn", x=1.0, y=1.0, theta=0.0, name="9 lives").name == ""
    assert "A turtle named [ada] already exists" in world.said
    world.listen("ada")
    world.advance(0.1)
    assert (world.poses["ada"].x, world.poses["ada"].theta) == pytest.approx((2.0, 0.5))
    world.call(TeleportAbsolute, "/ada/teleport_absolute", x=4.0, y=5.0, theta=math.pi / 2)
    world.call(TeleportRelative, "/ada/teleport_relative", linear=2.0, angular=math.pi / 2)
    world.advance(0.1)
    assert (world.poses["ada"].x, world.poses["ada"].y) == pytest.approx((2.0, 5.0), abs=1e-4)
    assert abs(world.poses["ada"].theta) == pytest.approx(math.pi, abs=1e-4)
    world.call(Kill, "/kill", name="ada")
    assert "/ada/pose" not in dict(world.node.get_topic_names_and_types()) or not world.node.count_publishers(
        "/ada/pose"
    )
    world.call(Kill, "/kill", name="ada")
    assert "Tried to kill turtle [ada], which does not exist" in world.said
    world.call(Empty, "/reset")
    assert [body.model for body in world.turtlesim.bodies] == ["turtle1"]
    world.advance(0.1)
    assert (world.pose.x, world.pose.y) == pytest.approx((SIDE_M / 2, SIDE_M / 2))


def test_pens_draw_in_their_colour_and_the_sensor_reads_it(field: Make) -> None:
    world = field()
    colors = []
    world.node.create_subscription(Color, "/turtle1/color_sensor", colors.append, 10)
    world.advance(0.1)
    assert (colors[-1].r, colors[-1].g, colors[-1].b) == (69, 86, 255), "the background"
    world.command(1.0, 0.0)
    world.advance(0.5)
    assert (colors[-1].r, colors[-1].g, colors[-1].b) == (179, 184, 255), "its own line"
    world.call(SetPen, "/turtle1/set_pen", r=255, g=0, b=0, width=5)
    world.command(1.0, 0.0)
    world.advance(0.5)
    assert (colors[-1].r, colors[-1].g, colors[-1].b) == (255, 0, 0)
    assert [stroke.color for stroke in world.turtlesim.strokes] == [(179, 184, 255), (255, 0, 0)]
    first, second = world.turtlesim.strokes
    assert first.points[-1] == pytest.approx(second.points[0], abs=0.06)
    world.call(SetPen, "/turtle1/set_pen", off=1)
    world.command(1.0, 0.0)
    world.advance(0.5)
    assert len(world.turtlesim.strokes[-1].points) == len(second.points), "the pen is up"
    world.call(Empty, "/clear")
    assert not world.turtlesim.strokes


def test_the_background_is_a_parameter(field: Make) -> None:
    world = field("--ros-args", "-p", "background_r:=150", "-r", "__node:=green")
    assert "/green" in {handle.full_name for handle in world.graph.directory.nodes}
    assert world.turtlesim.node.get_parameter("background_r").value == 150
    value = ParameterValue(type=ParameterType.PARAMETER_INTEGER, integer_value=300)
    answer = world.call(
        SetParameters,
        "/green/set_parameters",
        parameters=[ParameterMessage(name="background_g", value=value)],
    )
    assert not answer.results[0].successful, "255 is the most"


def test_a_goal_turns_the_turtle_and_another_aborts_it(field: Make) -> None:
    world = field()
    client = ActionClient(world.node, RotateAbsolute, "/turtle1/rotate_absolute")
    remaining: list[float] = []
    goals = []

    def send(theta: float) -> None:
        goal = RotateAbsolute.Goal(theta=theta)
        future = client.send_goal_async(goal, lambda message: remaining.append(message.feedback.remaining))
        world.graph.run_due()
        goals.append((future.result(), future.result().get_result_async()))

    send(math.pi / 2)
    world.advance(0.5)
    assert world.pose.angular_velocity == 1.0
    send(-0.3)
    world.advance(2.0)
    assert goals[0][1].result().status == GoalStatus.STATUS_ABORTED
    assert goals[1][1].result().status == GoalStatus.STATUS_SUCCEEDED
    assert world.pose.theta == pytest.approx(-0.3, abs=0.025)
    assert goals[1][1].result().result.delta == pytest.approx(0.8, abs=0.05), "from 0.5 back to -0.3"
    assert remaining[0] == pytest.approx(math.pi / 2, abs=0.05)
    send(3.0)
    world.advance(0.3)
    goals[2][0].cancel_goal_async()
    world.advance(0.3)
    assert goals[2][1].result().status == GoalStatus.STATUS_CANCELED
    assert world.pose.angular_velocity == 0.0


def test_of_what_is_drawn_so_many_points_are_kept_and_the_oldest_go_first(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(paper_module, "MAX_POINTS", 10)
    paper, step = Paper(), 2 * SPACING_M

    def draw(pen: Pen, first: int, last: int) -> list[list[int]]:
        """Draws from one point of a row to another; returns the points that are left, stroke by stroke."""
        for number in range(first, last):
            paper.draw_line("turtle1", (number * step, 1.0), ((number + 1) * step, 1.0), pen)
        return [[round(x / step) for x in stroke.points[:, 0]] for stroke in paper.strokes]

    white, red = Pen(), Pen((255, 0, 0))
    assert draw(white, 0, 9) == [[*range(10)]]
    assert draw(white, 9, 10) == [[*range(1, 11)]]
    assert draw(red, 10, 11) == [[*range(3, 11)], [10, 11]]
    assert draw(red, 11, 17) == [[9, 10], [*range(10, 18)]]
    assert draw(red, 17, 18) == [[*range(10, 19)]]  # one point is no line
    assert draw(red, 18, 30) == [[*range(21, 31)]]
