"""The terminal robot-learning kit. The loop is in ``kit/run/runner.py``; `kit help design` shows the code layout.

Scripts and notebooks may use the names below. Each is imported when it is first used, so that ``import kit``
is fast. Importing the kit also registers its environments with Gymnasium.

A Gymnasium environment. ``task="my/task.yaml"`` uses your own task, and ``render_mode="human"`` draws it in
the terminal:

>>> import gymnasium, kit
>>> env = gymnasium.make("RobotKit/Turn-v0", case="turn_a_to_b")
>>> observation, info = env.reset(seed=1)
>>> observation, reward, terminated, truncated, info = env.step(env.action_space.sample())

Training with PPO on many worlds at once (``kit train`` does more):

>>> from stable_baselines3 import PPO
>>> from kit.learning.environment.sb3_vec_env import make_vec_env
>>> from kit.learning.tasks.catalogue import find_task
>>> worlds = make_vec_env(find_task("turn"), 64, seed=1)
>>> model = PPO("MlpPolicy", worlds, n_steps=32, batch_size=1024, device="cpu", seed=1)
>>> model = model.learn(4_096)
>>> action, _ = model.predict(observation, deterministic=True)

Running a controller from a script and measuring it:

>>> summary = kit.run_episode("turn", "forward", seconds=2.0, record="run.npz")
>>> summary.metrics.time_s
2.0

Its recording as NumPy arrays:

>>> kit.load_recording("run.npz").track("serp").shape  # x [m], y [m], theta [rad] at every tick
(200, 3)
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from kit.environment_ids import register_when_imported

if TYPE_CHECKING:
    from kit.learning.policies.evaluation import evaluate_policy
    from kit.learning.policies.policy_file import load_policy
    from kit.run.headless import run_episode
    from kit.run.recording import Recording, load_recording
    from kit.sim.simulation import load_world
    from kit.world.catalogue import all_maps, find_map

__version__ = "0.2.0"

__all__ = [
    "Recording",
    "all_maps",
    "evaluate_policy",
    "find_map",
    "load_policy",
    "load_recording",
    "load_world",
    "run_episode",
]

_HOMES = {
    "Recording": "kit.run.recording",
    "all_maps": "kit.world.catalogue",
    "evaluate_policy": "kit.learning.policies.evaluation",
    "find_map": "kit.world.catalogue",
    "load_policy": "kit.learning.policies.policy_file",
    "load_recording": "kit.run.recording",
    "load_world": "kit.sim.simulation",
    "run_episode": "kit.run.headless",
}
"""Module that defines each public name."""


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        raise AttributeError(f"module 'kit' has no attribute {name!r}")
    value = getattr(import_module(_HOMES[name]), name)
    globals()[name] = value  # from now on an ordinary attribute
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


register_when_imported()
