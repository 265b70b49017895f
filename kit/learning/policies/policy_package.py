"""A policy as a ROS 2 package: a node, launch files, parameters and a world, for `kit launch` and for colcon on a robot."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Final

from kit.launch.package_creation import (
    PackageFrame,
    copy_world,
    new_package_folder,
    place_models,
    write_package_frame,
)
from kit.learning.environment.episode_start import EpisodeStart, first_start
from kit.learning.policies.policy import Policy
from kit.learning.policies.policy_node import RobotTopics, format_policy_node, robot_topics, usual_targets
from kit.learning.tasks.learning_task import LearningTask
from kit.run.scenario import BEACON
from kit.world.catalogue import WORLD_FILE

PROGRAM: Final = "policy"


DEPENDENCIES: Final = (
    "rclpy",
    "builtin_interfaces",
    "geometry_msgs",
    "nav_msgs",
    "sensor_msgs",
    "tf2_msgs",
    "python3-numpy",
    "launch_ros",
)


TEMPLATES: Final = "policy_package_files"


USUAL_TOPICS: Final = RobotTopics("cmd_vel", "scan", "odom")
"""What most robots call them."""


def create_policy_package(policy: Policy, name: str, destination: Path) -> Path:
    """Creates the package ``name`` in ``destination``, completely or not at all; returns its folder.

    Its program needs rclpy and numpy alone. Raises PackageError for a name that cannot be or a folder that is there, and
    PolicyError for a policy that no node can carry out.
    """
    program = format_policy_node(policy)
    task = policy.trained_on.resolve()
    names = task.robots_on(task.map_cases()[0][0])
    topics = [
        (topic, f"{name}_{usual}_topic", f"{name}/{usual}")
        if task.robots > 1
        else (topic, f"{usual}_topic", usual)
        for name, robot in zip(names, robot_topics(task), strict=True)
        for topic, usual in zip(robot, USUAL_TOPICS, strict=True)
    ]
    start = first_start(task)
    places = {**dict(zip(names, start.robots, strict=True)), BEACON: start.target}
    words = {
        "target": _target_line(task, start),
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
        place_models(folder / "world" / WORLD_FILE, places)
    return destination / name


def _target_line(task: LearningTask, start: EpisodeStart) -> str:
    """The line of the parameters that says where the target is; empty where the program knows it, or it moves."""
    if not task.goal.has_standing_targets or usual_targets(task) or task.map_cases()[0][1].targets.model:
        return ""
    return f"    target: [{start.target.x:.3f}, {start.target.y:.3f}]  # m, in the frame of odometry: of the world beside this\n"
