"""What is told of a topic: its newest message, folded as little as there is room for."""

from __future__ import annotations

from kit.document.rows import row_text
from kit.msg.nav_msgs import Odometry
from kit.render.graph_drawing import GraphElement
from kit.ros.graph.snapshot import GraphState, TopicState
from kit.tui.rows.graph_rows import GraphUpdate, about

ODOM = GraphElement("item", "/odom")


def odometry_rows(room: int) -> list[str]:
    topic = TopicState("/odom", ("nav_msgs/msg/Odometry",), (), (), ())
    heard = GraphUpdate(GraphState(1, (), (topic,), ()), {}, "/odom", Odometry(), (), paused=False)
    return [row_text(each) for each in about(ODOM, heard, 120, room=room)]


def test_a_message_is_folded_as_little_as_there_is_room_for() -> None:
    least = odometry_rows(0)
    for room in range(len(least), 60):
        shown = odometry_rows(room)
        assert len(least) <= len(shown) <= room
    assert any("position: {x: 0.0, y: 0.0, z: 0.0}" in each for each in odometry_rows(30))
    assert len(odometry_rows(59)) > len(least)
