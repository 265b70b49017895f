"""What a step of an environment costs: ``python tests/benchmarks/learning_engine.py``.

One step is: move, look for collisions, scan with 91 noisy rays, observe, reward, end, begin anew. The dissertation's
robot, as the polygons of its file, drives at random among the 20 walls of the map ``slalom``, on one thread.
Every figure is the best of ``REPEATS``.

Where ir-sim or VMAS is installed (they are no part of the kit), the same walls and as many rays are given to them, and
the ratio is printed. They do other things besides: ir-sim keeps Python objects, VMAS solves contacts.
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from kit.arrays import FloatArray, IntArray
from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.env import TaskEnv
from kit.learning.maps.batch_map import load_batch_map
from kit.learning.tasks.catalogue import HALLWAY, TURN, WHEELCHAIRS, find_task
from kit.learning.tasks.learning_task import LearningTask, StartVariation
from kit.learning.tasks.rewards import PROGRESS
from kit.learning.tasks.transition import Array, Transition
from kit.world.catalogue import find_map

REPEATS = 12
SECONDS = 0.25
"""Each repeat takes about so long."""
MAP = "slalom"
RAYS = 91
PEERS_AT_ONCE = 1024

SLALOM = replace(TURN, maps=(MAP,), start=StartVariation(noise=0.05, max_rotation=3.1), reward=PROGRESS)
"""Tutorial 2's robot: 0.1 s and one look for collisions a step."""
SLALOM_2 = replace(HALLWAY, maps=(MAP,))
"""The hallway study's: 0.2 s, two looks, 17 inputs, 7 actions, algorithm 1."""


def best(step: Callable[[], object], worlds: int) -> float:
    """Steps of one world per second, of the best of a few runs."""
    step()
    start, count = time.perf_counter(), 0
    while time.perf_counter() - start < SECONDS:
        step()
        count += 1
    rates = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        for _ in range(count):
            step()
        rates.append(count * worlds / (time.perf_counter() - start))
    return max(rates)


def driving(batch: BatchEnv) -> Callable[[], object]:
    """Random steps, forward half of the time."""
    chance = np.random.default_rng(0)
    task = batch.task
    odds = np.full(len(task.actions.moves), 0.5 / (len(task.actions.moves) - 1))
    odds[[move.name for move in task.actions.moves].index("FORWARD")] = 0.5
    shape = (batch.n,) if task.robots == 1 else (batch.n, task.robots)
    actions = [chance.choice(len(odds), size=shape, p=odds) for _ in range(64)]
    forever = iter(lambda: None, 0)
    numbers: Iterator[IntArray] = (actions[i % 64] for i, _ in enumerate(forever))
    batch.reset()
    for _ in range(50):  # episodes out of step with each other
        batch.step(next(numbers))
    return lambda: batch.step(next(numbers))


def ours(task: LearningTask, n: int, reward: Callable[[Transition], Array] | None = None) -> float:
    return best(driving(BatchEnv(task, n, seed=0, reward=reward)), n)


def students(transition: Transition) -> Array:
    """A reward as a student may write it, for all worlds at once."""
    reward = transition.previous_to_go - transition.to_go
    return reward[:, 0] - 0.01 - 2.0 * transition.collided + 2.0 * transition.reached


def single() -> float:
    """The Gymnasium environment, one world."""
    env = TaskEnv(SLALOM)
    env.reset(seed=0)
    chance = np.random.default_rng(0)

    def step() -> None:
        *_, ended, truncated, _ = env.step(np.int64(chance.integers(3)))
        if ended or truncated:
            env.reset()

    return best(step, 1)


# Peers


def irsim(walls: FloatArray) -> float | None:
    """Steps per second of one world of ir-sim."""
    step = irsim_step(walls)
    return None if step is None else best(step, 1)


def irsim_step(walls: FloatArray) -> Callable[[], object] | None:
    """A step of one world of ir-sim: a robot of the same size with a lidar of as many rays, no picture."""
    if find_spec("irsim") is None:
        return None
    import irsim as peer

    lines = "\n".join(
        f"  - {{shape: {{name: linestring, vertices: [[{x1}, {y1}], [{x2}, {y2}]]}}}}"
        for x1, y1, x2, y2 in walls.tolist()
    )
    start = load_batch_map(find_map(MAP)).starts[0]
    described = f"""\
world: {{height: 12, width: 12, offset: [-4, -4], step_time: 0.1, sample_time: 0.1, collision_mode: stop}}
robot:
  - kinematics: {{name: diff}}
    shape: {{name: rectangle, length: 0.165, width: 0.17}}
    state: [{start.x}, {start.y}, {start.theta}]
    goal: [100, 100, 0]
    vel_max: [2, 3]
    sensors:
      - {{type: lidar2d, range_min: 0, range_max: 10, angle_range: 6.2832, number: {RAYS}, noise: True, std: 0.015}}
obstacle:
{lines}
"""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "world.yaml"
        file.write_text(described)
        env = peer.make(str(file), display=False, headless=True, log_level="ERROR")
        assert len(env.robot_list[0].get_lidar_scan()["ranges"]) == RAYS
        action = np.array([[0.01], [0.2]])
        return lambda: env.step(action)


def vmas(walls: FloatArray) -> float | None:
    """A batch of VMAS: an agent with a lidar of as many rays that looks at as many line landmarks."""
    if find_spec("vmas") is None:
        return None
    import torch
    from vmas import make_env
    from vmas.simulator.core import Agent, Landmark, Line, Sphere, World
    from vmas.simulator.scenario import BaseScenario
    from vmas.simulator.sensors import Lidar

    torch.set_num_threads(1)

    class Walls(BaseScenario):
        def make_world(self, batch_dim, device, **kwargs):
            world = World(batch_dim, device, dt=0.1)
            lidar = Lidar(
                world,
                n_rays=RAYS,
                max_range=10.0,
                entity_filter=lambda entity: entity.name.startswith("wall"),
            )
            world.add_agent(Agent(name="agent", shape=Sphere(0.1), sensors=[lidar]))
            for number, (x1, y1, x2, y2) in enumerate(walls.tolist()):
                length = float(np.hypot(x2 - x1, y2 - y1))
                world.add_landmark(
                    Landmark(name=f"wall_{number}", collide=True, movable=False, shape=Line(length=length))
                )
            return world

        def reset_world_at(self, env_index=None):
            for landmark, (x1, y1, x2, y2) in zip(self.world.landmarks, walls.tolist(), strict=True):
                middle = torch.tensor([(x1 + x2) / 2, (y1 + y2) / 2], dtype=torch.float32)
                turn = torch.tensor([np.arctan2(y2 - y1, x2 - x1)], dtype=torch.float32)
                landmark.set_pos(middle, batch_index=env_index)
                landmark.set_rot(turn, batch_index=env_index)
            start = load_batch_map(find_map(MAP)).starts[0]
            self.world.agents[0].set_pos(torch.tensor([start.x, start.y]), batch_index=env_index)

        def observation(self, agent):
            return agent.sensors[0].measure()

        def reward(self, agent):
            return agent.state.pos[:, 0]

    env = make_env(Walls(), num_envs=PEERS_AT_ONCE, device="cpu", continuous_actions=True, seed=0)
    action = [torch.full((PEERS_AT_ONCE, 2), 0.01)]
    return best(lambda: env.step(action), PEERS_AT_ONCE)


def shown(name: str, rate: float | None, base: float | None = None) -> None:
    if rate is None:
        print(f"{name:58} not installed")
    else:
        print(f"{name:58} {rate:12,.0f} steps/s" + (f"   {base / rate:8,.0f} times" if base else ""))


def main() -> None:
    walls = load_batch_map(find_map(MAP)).walls
    print(f"{len(walls)} walls, {RAYS} rays, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}\n")
    rates = {n: ours(SLALOM, n) for n in (1, 64, 256, 1024, 4096, 16384)}
    for n, rate in rates.items():
        shown(f"batch of {n}: tutorial 2's robot", rate)
    engine = max(rates.values())
    shown("batch of 1024: the hallway study's, two looks, algorithm 1", ours(SLALOM_2, 1024))
    shown("batch of 1024: all fifteen hallways at once", ours(HALLWAY, 1024))
    shown("batch of 1024: two wheelchairs on nine cases", ours(WHEELCHAIRS, 1024))
    for goal in ("night-watch", "vacuum-cleaner", "wall-follower", "behind-the-cart"):
        shown(f"batch of 1024: {goal}", ours(find_task(goal), 1024))
    shown("batch of 1024: tutorial 2's robot, a student's reward", ours(SLALOM, 1024, students))
    shown("one world of Gymnasium", single())
    with suppress(KeyboardInterrupt):
        print("\nPeers, and how many times as fast the batch is")
        shown("ir-sim, one world", irsim(walls), engine)
        shown(f"VMAS, batch of {PEERS_AT_ONCE}", vmas(walls), engine)


if __name__ == "__main__":
    main()
