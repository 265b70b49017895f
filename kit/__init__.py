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
>>> worlds = kit.make_vec_env("turn", 64, seed=1)
>>> model = PPO("MlpPolicy", worlds, n_steps=32, batch_size=1024, device="cpu", seed=1)
>>> model = model.learn(4_096)
>>> action, _ = model.predict(observation, deterministic=True)

From here on it is a policy like any other, for every command that takes one. A model that was
saved is read by ``kit.load_policy("model.zip", task="turn")``:

>>> kit.save_policy(kit.export_policy(model, "turn"), "mine.npz")

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

from kit.blas import prepare_blas
from kit.environment_ids import register_when_imported

if TYPE_CHECKING:
    from kit.learning.environment.parallel_env import RobotsParallelEnv
    from kit.learning.environment.sb3_vec_env import make_vec_env
    from kit.learning.policies.evaluation import evaluate_policy
    from kit.learning.policies.export import export_policy
    from kit.learning.policies.policy import Policy
    from kit.learning.policies.policy_file import load_policy, save_policy
    from kit.learning.tasks.catalogue import find_task
    from kit.run.headless import run_episode
    from kit.run.recording import Recording, load_recording
    from kit.sim.simulation import load_world
    from kit.world.catalogue import all_maps, find_map

__version__ = "0.2.0"

__all__ = [
    "Policy",
    "Recording",
    "RobotsParallelEnv",
    "all_maps",
    "evaluate_policy",
    "export_policy",
    "find_map",
    "find_task",
    "load_policy",
    "load_recording",
    "load_world",
    "make_vec_env",
    "run_episode",
    "save_policy",
]

_HOMES = {
    "Policy": "kit.learning.policies.policy",
    "Recording": "kit.run.recording",
    "RobotsParallelEnv": "kit.learning.environment.parallel_env",
    "all_maps": "kit.world.catalogue",
    "evaluate_policy": "kit.learning.policies.evaluation",
    "export_policy": "kit.learning.policies.export",
    "find_map": "kit.world.catalogue",
    "find_task": "kit.learning.tasks.catalogue",
    "load_policy": "kit.learning.policies.policy_file",
    "load_recording": "kit.run.recording",
    "load_world": "kit.sim.simulation",
    "make_vec_env": "kit.learning.environment.sb3_vec_env",
    "run_episode": "kit.run.headless",
    "save_policy": "kit.learning.policies.policy_file",
}
"""Module that defines each public name."""


if not TYPE_CHECKING:  # which would take every name, also a misspelt one

    def __getattr__(name: str) -> object:
        if name not in _HOMES:
            raise AttributeError(f"module 'kit' has no attribute {name!r}")
        value = getattr(import_module(_HOMES[name]), name)
        globals()[name] = value  # from now on an ordinary attribute
        return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


prepare_blas()
register_when_imported()
