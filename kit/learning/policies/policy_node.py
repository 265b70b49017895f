"""A policy as a ROS 2 node: one Python file with the arrays in it, which needs rclpy and numpy, and not the kit.

It runs in the kit's worlds as any controller does, and on a robot with a lidar.
"""

from __future__ import annotations

import base64
import zlib
from dataclasses import replace
from importlib.resources import files
from textwrap import wrap

from kit.learning.environment.case_arrays import CaseArrays
from kit.learning.policies.policy import Policy, PolicyError
from kit.learning.policies.policy_file import policy_bytes
from kit.learning.tasks.actions import DiscreteActions
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.observations import MAX_COORDINATE, MAX_TARGET_DISTANCE
from kit.plain_text import join_names

TOPIC_PREFIXES = {1: ("",), 2: ("left/", "right/")}
"""Before each robot's ``cmd_vel`` and ``static_laser``."""


NODE_PARTS = ("speeds", "last_action", "own_pose", "target")
"""Parts of the observation beside the scan that a node knows: from odometry, from what it has sent, from a parameter."""


LEARNED_MARK = "# --- what was learned ---\n"


def format_policy_node(policy: Policy) -> str:
    """The file's text.

    PolicyError for a policy that needs what a node on a robot does not know, such as who has arrived.
    """
    task = policy.trained_on.resolve()
    policy.check_fits(task)
    seen = task.observation
    unknown = [part.name for part in seen.parts if part.name not in NODE_PARTS]
    if unknown:
        raise PolicyError(
            f"this policy sees what a node does not know: {', '.join(unknown)}. A node knows rays, sectors and "
            f"{join_names(NODE_PARTS)}: leave the rest out of the task's observation, and train again."
        )
    if seen.target and task.goal.node_refusal:
        raise PolicyError(
            f"this policy sees its target, which a node cannot tell it: {task.goal.node_refusal}. Leave the target out of "
            "the task's observation, and train again."
        )
    if task.robots not in TOPIC_PREFIXES or not seen.sectors:
        raise PolicyError("a node can be written for one robot or two that see sectors of a scan.")
    template = files("kit.learning.policies").joinpath("policy_node_template.py").read_text()
    head, _, tail = template.partition(LEARNED_MARK)
    rest = tail.partition(LEARNED_MARK)[2]
    return head + LEARNED_MARK + _format_constants(policy, task) + LEARNED_MARK + rest


def ray_angles(task: LearningTask) -> tuple[float, ...]:
    """The directions of the lidar's rays on the task's robots, in its frame [rad]."""
    _, batch_map = CaseArrays(task).maps[0]
    angles: tuple[float, ...] = batch_map.robot.ray_angles
    return angles


def _format_constants(policy: Policy, task: LearningTask) -> str:
    """Formats the constants of the template."""
    actions = task.actions
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
        "TOPICS": list(TOPIC_PREFIXES[task.robots]),
        "RAYS": single.tolist(),
        "SECTORS": list(seen.sectors),
        "ANGLES": [round(angle, 6) for angle in ray_angles(task)],
        "PARTS": [part.name for part in seen.parts],
        "FRAMES": seen.frames,
        "CLIP": seen.clip,
        "SCALE": seen.scale,
        "TARGET_CLIP": MAX_TARGET_DISTANCE,
        "PLACE_CLIP": MAX_COORDINATE,
        "TARGET": _usual_target(task) if seen.target else [],
    }
    lines = [f"{name} = {value!r}" for name, value in values.items()]
    acting = replace(policy, critic=None)  # all that a node needs
    packed = base64.b64encode(zlib.compress(policy_bytes(acting), 9)).decode()
    quoted = "\n".join(f'    "{part}"' for part in wrap(packed, 100))
    return "\n".join(lines) + f"\nPOLICY = (\n{quoted}\n)\n"


def _usual_target(task: LearningTask) -> list[float]:
    """x and y of the task's target [m]; none where it has several, or one that moves."""
    found = {tuple(case.target) for _, case in task.map_cases() if len(case.targets.poses) == 1}
    is_one = len(found) == 1 and all(len(case.targets.poses) == 1 for _, case in task.map_cases())
    return [float(each) for each in found.pop()] if is_one else []
