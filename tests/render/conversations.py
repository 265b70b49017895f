"""Conversations to draw: the maze as it is when the kit opens, and a dozen nodes that all have something to say."""

from __future__ import annotations

from kit.render.graph_data import GraphData, GraphItem

WORLD = "/flatland_server"


def item(label: str, senders: str, receivers: str, *broken: tuple[str, str]) -> GraphItem:
    """``label`` with ``()`` at its end is a service."""
    return GraphItem(
        label,
        label.removesuffix("()"),
        tuple(senders.split()),
        tuple(receivers.split()),
        frozenset(broken),
    )


def talk(*items: GraphItem, alone: str = "") -> GraphData:
    nodes = [node for each in items for node in (*each.senders, *each.receivers)]
    return GraphData(tuple(dict.fromkeys((*nodes, *alone.split()))), items)


MAZE = talk(
    item("/odom", WORLD, ""),
    item("/static_laser", WORLD, "/random_walk"),
    item("/collisions", WORLD, "/random_walk"),
    item("/teleopkeys", "/keys", ""),
    item("/cmd_vel", "/random_walk", WORLD),
    item("/move_model()", "/random_walk", WORLD),
)

DOZEN = talk(
    item("/r1/scan", WORLD, "/r1/driver /r1/localizer /mapper /safety"),
    item("/r2/scan", WORLD, "/r2/driver /r2/localizer /mapper /safety", (WORLD, "/safety")),
    item("/r1/odom", WORLD, "/r1/localizer"),
    item("/r2/odom", WORLD, "/r2/localizer"),
    item("/r1/pose", "/r1/localizer", "/planner /logger"),
    item("/r2/pose", "/r2/localizer", "/planner /logger"),
    item("/map", "/mapper", "/planner"),
    item("/r1/goal", "/planner", "/r1/driver"),
    item("/r2/goal", "/planner", "/r2/driver"),
    item("/r1/cmd_vel", "/r1/driver /teleop", WORLD),
    item("/r2/cmd_vel", "/r2/driver /teleop", WORLD),
    item("/stop", "/safety /watchdog", "/r1/driver /r2/driver"),
    item("/status", "/planner /r1/driver /r2/driver", "/recorder /watchdog"),
    item("/move_model()", "/planner /r1/driver", WORLD),
)
