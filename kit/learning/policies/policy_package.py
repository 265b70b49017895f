"""A policy as a ROS 2 package: a node, launch files, parameters and a world, for `kit launch` and for colcon on a robot."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Final

from kit.launch.package_creation import PackageFrame, copy_world, new_package_folder, write_package_frame
from kit.learning.policies.policy import Policy
from kit.learning.policies.policy_node import TOPIC_PREFIXES, format_policy_node

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
