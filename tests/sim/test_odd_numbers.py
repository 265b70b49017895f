"""Worlds with numbers that no one would choose: what can be read, runs, and its poses stay numbers."""

from __future__ import annotations

import copy
import math
import random
import time
from collections.abc import Iterator
from typing import Any

import pytest

from kit.msg.geometry_msgs import Twist, Vector3
from kit.sim.simulation import Simulation
from kit.world.problems import WorldError
from tests.sim.workshop import Workshop

ODD = [0, -1, 1e12, -1e12, 1e-12, 1e-320, 1e9, 3, 1e-3, 0.5, math.pi, 100]
SECONDS = 5.0
"""For one world; the machine may be busy."""


def everything(workshop: Workshop) -> dict[str, Any]:
    """A model with every device, joint and shape."""
    base = [workshop.rectangle(-0.35, 0.05, -0.1, 0.1, friction=0.5, restitution=0.5), workshop.circle(0.1)]
    wheels = {"front": (0, 0), "left": (-0.3, 0.1), "right": (-0.3, -0.1), "tail": (-0.5, 0)}
    limits = {"acceleration_limit": 1, "deceleration_limit": 2, "velocity_limit": 3}
    return {
        "bodies": [{"name": "base", "footprints": base, "linear_damping": 0.1, "angular_damping": 0.1}]
        + [
            {"name": name, "pose": [*at, 0.1], "footprints": [workshop.circle(0.05, center=[0.01, 0])]}
            for name, at in wheels.items()
        ],
        "joints": [
            {
                "name": name,
                "type": "revolute" if name == "front" else "weld",
                "bodies": [{"name": "base", "anchor": list(at)}, {"name": name, "anchor": [0, 0]}],
                **({"limits": [-1, 1]} if name == "front" else {}),
                **({"frequency": 5, "damping": 0.5, "angle": 0.1} if name == "tail" else {}),
            }
            for name, at in wheels.items()
        ],
        "plugins": [
            {"type": "DiffDrive", "name": "d", "body": "base", "odometry": "encoders", "pub_rate": 5}
            | {"wheel_separation": 0.1, "wheel_error": 0.1, "wheel_slip": 0.1, "linear_dynamics": limits},
            {
                "type": "Laser",
                "name": "l",
                "body": "base",
                "range": 5,
                "noise_std_dev": 0.1,
                "origin": [0, 0, 0],
            }
            | {"angle": {"min": -1, "max": 1, "increment": 0.1}, "update_rate": 50},
            {
                "type": "Tween",
                "name": "t",
                "body": "tail",
                "delta": [1, 1, 1],
                "duration": 1,
                "easing": "backIn",
            },
            {"type": "Gps", "name": "g", "body": "base", "ref_lat": 40, "ref_lon": 8, "update_rate": 50},
            {"type": "Imu", "name": "i", "body": "base", "orientation_noise": [0.1, 0.1, 0.1]},
            {"type": "Bumper", "name": "b", "update_rate": 20},
            {"type": "BoolSensor", "name": "s", "update_rate": 20},
            {"type": "ModelTfPublisher", "name": "m", "update_rate": 20},
        ],
    }


def numbers(value: Any) -> Iterator[tuple[Any, Any]]:
    """Every place where a number stands: the container, and its key or index."""
    for key, entry in value.items() if isinstance(value, dict) else enumerate(value):
        if isinstance(entry, dict | list):
            yield from numbers(entry)
        elif isinstance(entry, int | float):
            yield value, key


@pytest.mark.long
@pytest.mark.parametrize("batch", range(4))
def test_odd_worlds_run(workshop: Workshop, batch: int) -> None:
    sound = everything(workshop)
    ran = 0
    for seed in range(batch * 60, batch * 60 + 60):
        rng = random.Random(seed)
        model, pose = copy.deepcopy(sound), [0, 0, 0]
        for container, key in rng.sample([*numbers(model), *numbers(pose)], rng.randint(1, 6)):
            container[key] = rng.choice(ODD)
        walls = [[1, -2, 1, 2], [rng.choice(ODD) for _ in range(4)], [0, 0, 0, 0]]
        start = time.process_time()
        try:
            world = workshop.world({"odd": model}, {"walls": walls}, poses={"odd": pose})
        except WorldError:
            continue
        simulation = Simulation(world, seed=seed)
        simulation.accept("/cmd_vel", Twist(linear=Vector3(x=1.0), angular=Vector3(z=1.0)))
        simulation.step(5)
        simulation.move_model("odd", simulation.pose("odd"))
        simulation.step(5)
        for body in simulation.state().bodies:
            assert all(map(math.isfinite, (*body.pose, *body.velocity))), seed
        assert time.process_time() - start < SECONDS, seed
        ran += 1
    assert ran > 20
