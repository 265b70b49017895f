"""A policy as a ROS 2 node: one Python file with the arrays in it, which needs rclpy and numpy, and not the kit.

It runs in the kit's worlds as any controller does, and on a robot with a lidar.

A policy as a ROS 2 package: a node, launch files, parameters and a world, for `kit launch` and for colcon on a robot.
"""

from __future__ import annotations

import base64
import zlib
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from string import Template
from textwrap import wrap
from typing import Final

from kit.launch.package_creation import PackageFrame, copy_world, new_package_folder, write_package_frame
from kit.learning.environment.case_arrays import CaseArrays
from kit.learning.policies.policies import Policy, PolicyError, policy_bytes
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


PROGRAM: Final = "policy"
DEPENDENCIES: Final = (
    "rclpy",
    "geometry_msgs",
    "nav_msgs",
    "sensor_msgs",
    "python3-numpy",
    "launch_ros",
)
TEMPLATES: Final = "policy_package_files"
LIDAR: Final = "static_laser"
"""What the kit's robots call their lidar's topic."""


def create_policy_package(policy: Policy, name: str, destination: Path) -> Path:
    """Creates the package ``name`` in ``destination``, completely or not at all; returns its folder.

    Its program needs rclpy and numpy alone. Raises PackageError for a name that cannot be or a folder that is there, and
    PolicyError for a policy that no node can carry out.
    """
    program = format_policy_node(policy)
    task = policy.trained_on.resolve()
    used = [(LIDAR, "scan_topic", "scan"), ("cmd_vel", "cmd_vel_topic", "cmd_vel")]
    seen = task.observation
    used += [("odom", "odom_topic", "odom")] * (seen.speeds or seen.own_pose or seen.target)
    topics = [
        (f"{prefix}{topic}", f"{prefix.replace('/', '_')}{argument}", f"{prefix}{usual}")
        for prefix in TOPIC_PREFIXES[task.robots]
        for topic, argument, usual in used
    ]
    words = {
        "name": name,
        "topics": repr(topics),
        "simulated": repr({argument: topic for topic, argument, _ in topics}),
        "max_scan_age": f"{max(0.5, 3 * task.step_time):g}",
    }
    frame = PackageFrame(
        name,
        PROGRAM,
        f"A policy trained on {policy.trained_on.title}, {policy.steps:,} steps",
        DEPENDENCIES,
        ("launch", "config", "world"),
    )
    with new_package_folder(name, destination, PROGRAM) as folder:
        write_package_frame(folder, frame)
        (folder / name / f"{PROGRAM}.py").write_text(program, encoding="utf-8")
        for template, file in (
            ("robot.launch.py", f"launch/{name}.launch.py"),
            ("simulation.launch.py", "launch/simulation.launch.py"),
            ("parameters.yaml", f"config/{name}.yaml"),
        ):
            path = folder / file
            path.parent.mkdir(exist_ok=True)
            text = files("kit.learning.policies").joinpath(TEMPLATES, f"{template}.template").read_text()
            path.write_text(Template(text).substitute(words), encoding="utf-8")
        copy_world(task.map_cases()[0][0].world_file, folder / "world")
    return destination / name
