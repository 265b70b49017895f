"""A policy as a ROS 2 node: one Python file with the arrays in it, which needs rclpy and numpy, and not the kit.

It runs in the kit's worlds as any controller does, and on a robot with a lidar.
"""

from __future__ import annotations

import base64
import math
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import replace
from importlib import import_module
from textwrap import wrap
from typing import Any, NamedTuple, cast

from kit.learning.environment.case_arrays import CaseArrays
from kit.learning.maps.batch_map import DRIVES
from kit.learning.maps.ray_directions import LEFT_RAYS
from kit.learning.policies.node_goals.goal_count import NodeCount
from kit.learning.policies.policy import Policy, PolicyError
from kit.learning.policies.policy_file import policy_bytes
from kit.learning.policies.policy_node_text import GOAL_PROGRAMS, can_count, node_text
from kit.learning.tasks.actions import DiscreteActions
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.observations import MAX_COORDINATE, MAX_TARGET_DISTANCE
from kit.sim.card_world import load_card_world
from kit.sim.plugins.laser import LaserParams
from kit.sim.plugins.model_tf_publisher import frame_in_world
from kit.world.catalogue import MapCard
from kit.world.records import Model


class RobotTopics(NamedTuple):
    """The topics of one robot, relative for one alone."""

    commands: str
    scans: str
    odometry: str


def format_policy_node(policy: Policy) -> str:
    """The file's text.

    PolicyError for a policy that needs what a node on a robot does not know, as ``node_refusals`` says.
    """
    task = policy.trained_on.resolve()
    policy.check_fits(task)
    if refused := node_refusals(task):
        raise PolicyError(f"no node can be written for this policy: {'; '.join(refused)}.")
    return node_text(_format_constants(policy, task), task.goal.kind if _is_counted(task) else None)


def node_refusals(task: LearningTask) -> tuple[str, ...]:
    """Why no node can carry out a policy of this task, which a race and a package do; empty where one can.

    UnsupportedWorld and WorldError for a world that nobody can learn in.
    """
    return tuple(_refusals(task))


def _refusals(task: LearningTask) -> Iterator[str]:
    seen, topics = task.observation, robot_topics(task)
    shared = {name for name in _all_topics(topics) if _all_topics(topics).count(name) > 1}
    if shared:
        yield (
            f"{' and '.join(task.robots_on(_first_card(task)))} share {', '.join(sorted(shared))}: give each of them a "
            "namespace of its own in the world's file"
        )
    if _is_counted(task):
        yield from _refusals_to_count(task)
    leader = task.map_cases()[0][1].targets.model
    if leader is not None and seen.target and not leader_frame(task):
        yield (
            f"a node is not told where {leader} is: give its model a plugin of the type ModelTfPublisher, with "
            "publish_tf_world: true"
        )


def _is_counted(task: LearningTask) -> bool:
    """Whether a node counts the task's goal."""
    return task.observation.achieved or task.goal.needs_count


def _refusals_to_count(task: LearningTask) -> Iterator[str]:
    goal, known = task.goal, CaseArrays(task).goal_cases
    if not can_count(goal.kind):
        yield f"agents see how much is achieved, which a node cannot count for the goal {goal.kind}"
    elif not goal.is_route and any(goal.node_facts(each) != goal.node_facts(known[0]) for each in known):
        yield "agents see how much is achieved, which a node can count for one case only, and there are several"


def _all_topics(topics: Sequence[RobotTopics]) -> list[str]:
    return [name for robot in topics for name in robot]


def node_count(task: LearningTask) -> NodeCount:
    """Counts the goal as the node of a policy of this task does. ValueError where none can: see ``node_refusals``."""
    if not _is_counted(task):
        return NodeCount({})
    goal = task.goal
    if not can_count(goal.kind):
        raise ValueError(f"a node cannot count the goal {goal.kind}")
    counts = vars(import_module(f"{GOAL_PROGRAMS}.{goal.kind}")).values()
    kind = next(each for each in counts if isinstance(each, type) and NodeCount in each.__bases__)
    return cast(NodeCount, kind(_goal_facts(task)))


def _goal_facts(task: LearningTask) -> dict[str, Any]:
    """What a node must know of the goal that it counts."""
    return {**task.goal.node_facts(CaseArrays(task).goal_cases[0]), "step_time": task.step_time}


def _first_card(task: LearningTask) -> MapCard:
    return task.map_cases()[0][0]


def _models(task: LearningTask) -> dict[str, Model]:
    """The models of the first case's world, by name."""
    card = _first_card(task)
    return {model.name: model for model in load_card_world(card).models}


def robot_topics(task: LearningTask) -> tuple[RobotTopics, ...]:
    """The topics of each robot, as the task's first world has them."""
    models, found = _models(task), []
    for name in task.robots_on(_first_card(task)):
        model = models[name]
        (drive,) = [each.params for each in model.plugins if isinstance(each.params, DRIVES)]
        (laser,) = [each.params for each in model.plugins if isinstance(each.params, LaserParams)]
        topics = RobotTopics(drive.topic, laser.topic, drive.odometry.odom_topic)
        found.append(topics if task.robots == 1 else RobotTopics(*map(model.topic, topics)))
    return tuple(found)


def leader_frame(task: LearningTask) -> str:
    """The frame on /tf of the model that is the target of the first case; empty where there is none."""
    name = task.map_cases()[0][1].targets.model
    return "" if name is None else frame_in_world(_models(task)[name])


def ray_angles(task: LearningTask) -> tuple[float, ...]:
    """The directions of the lidar's rays on the task's robots, in its frame [rad]."""
    _, batch_map = CaseArrays(task).maps[0]
    angles: tuple[float, ...] = batch_map.robot.ray_angles
    return angles


def _format_constants(policy: Policy, task: LearningTask) -> str:
    """Formats the constants of the template."""
    actions, arrays = task.actions, CaseArrays(task)
    if isinstance(actions, DiscreteActions):
        twists, bounds = actions.twists.tolist(), []
    else:
        twists, bounds = [], [list(map(float, actions.linear)), list(map(float, actions.angular))]
    seen, (single, _) = task.observation, task.observation.ray_tables(task.robots)
    title = f"{policy.trained_on.title}, {policy.steps:,} steps"
    values = {
        "TRAINED_ON": title,
        "STEP_TIME": task.step_time,
        "TWISTS": twists,
        "BOUNDS": bounds,
        "CHOICES": list(policy.choices),
        "TOPICS": [list(each) for each in robot_topics(task)],
        "RAYS": single.tolist(),
        "SECTORS": list(seen.sectors),
        "ANGLES": [round(angle, 6) for angle in arrays.robot.ray_angles],
        "PARTS": [part.name for part in seen.parts],
        "FRAMES": seen.frames,
        "CLIP": seen.clip,
        "SCALE": seen.scale,
        "TARGET_CLIP": MAX_TARGET_DISTANCE,
        "PLACE_CLIP": MAX_COORDINATE,
        "TARGETS": usual_targets(task),
        "TARGET_HEADING": float(task.map_cases()[0][1].targets.nominal.theta),
        "TARGET_RADIUS": float(task.target_radius),
        "LEADER_FRAME": leader_frame(task) if seen.target else "",
        "HULL": [] if task.measured_to == "axle" else [[list(c) for c in part] for part in arrays.robot.hull],
        "HEADING_TOLERANCE": math.pi if task.goal.heading_tolerance is None else task.goal.heading_tolerance,
        "GOAL": _goal_facts(task) if _is_counted(task) else {},
        "LEFT_RAYS": list(LEFT_RAYS) if seen.achieved else [],
    }
    lines = [f"{name} = {value!r}" for name, value in values.items()]
    acting = replace(policy, critic=None)  # all that a node needs
    packed = base64.b64encode(zlib.compress(policy_bytes(acting), 9)).decode()
    quoted = "\n".join(f'    "{part}"' for part in wrap(packed, 100))
    return "\n".join(lines) + f"\nPOLICY = (\n{quoted}\n)\n"


def usual_targets(task: LearningTask) -> list[float]:
    """x and y of the task's targets [m], one after the other; none where every episode has its own, or one that moves."""
    if not task.goal.has_standing_targets:
        return []
    found = {
        task.route(case) or tuple((each.x, each.y) for each in case.targets.poses)
        for _, case in task.map_cases()
    }
    is_one = len(found) == 1 and (task.goal.is_route or len(next(iter(found))) == 1)
    return [float(each) for place in found.pop() for each in place] if is_one else []
