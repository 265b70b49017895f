"""How the lessons on ROS 2's tools and on systems are found out anew: the companion of ``derivations.py``."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Final

from kit.controllers import find_controller
from kit.msg.geometry_msgs import Twist
from kit.ros.node.node import create_graph_node
from kit.run.scenario import scenario_on_map
from kit.run.session import Session
from kit.school.lessons.records import LessonStep
from kit.world.catalogue import find_map
from tests.school.lessons.derivations import Claim

# Lesson 0: what this is about


def random_walk_rate(words: str, step: LessonStep, folder: Path) -> str:
    """Counts the commands of two simulated seconds."""
    commands: list[Twist] = []
    with Session(scenario_on_map(find_map("simple")), seed=1) as session:
        create_graph_node(session.graph, "counter").create_subscription(
            Twist, "/cmd_vel", commands.append, 10
        )
        session.drive_with(find_controller("random_walk"))
        session.wait_until_driven()
        commands.clear()
        for _ in range(200):
            session.runner.tick()
    return {20: "ten times a second"}[len(commands)]


SYSTEM_DERIVATIONS: Final[Mapping[str, Claim]] = MappingProxyType(
    {claim.__name__.replace("_", "-"): claim for claim in (random_walk_rate,)}
)
"""By the name that a claim's ``derived`` gives."""
SYSTEM_DEAR: Final[frozenset[str]] = frozenset()
"""Those that take more than a second: they run with the long tests."""
