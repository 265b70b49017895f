"""Shims for gym and pynput: they say that they are shims, and behave like the originals."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from textwrap import dedent

from kit.ros import names_folder, shims_folder


def run(code: str, *first: Path) -> str:
    """What a program prints that imports stand-ins, after ``first``."""
    paths = [*map(str, first), names_folder(), "{installed}", shims_folder()]
    setup = f"import sys\ninstalled = sys.path[1:]\nsys.path[:] = [sys.path[0], *{paths[:-2]!r}, *installed, {paths[-1]!r}]\n"
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", setup + dedent(code)],
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout + done.stderr


OLD_ENVIRONMENT = """
import gym
import numpy as np

class Corridor(gym.Env):
    def __init__(self):
        self.action_space = gym.spaces.Discrete(2)
        self.observation_space = gym.spaces.Box(0, 4, shape=(1,), dtype=np.float64)
    def reset(self):
        self.at = 0
        return np.array([float(self.at)])
    def step(self, action):
        self.at = min(4, max(0, self.at + (1 if action else -1)))
        return np.array([float(self.at)]), 1, self.at == 4, {}
    def render(self, mode='human'): pass
"""


def test_an_old_environment_is_what_a_learner_of_today_wants() -> None:
    """As gymnasium's own checker sees it, behind the wrapper that stable-baselines3 looks for."""
    said = run(
        OLD_ENVIRONMENT
        + dedent("""
        import gymnasium, shimmy
        from gymnasium.utils.env_checker import check_env
        old = Corridor()
        assert isinstance(old, gym.Env) and not isinstance(old, gymnasium.Env)
        assert len(old.step(1)) == 4 if old.reset() is not None else False
        new = shimmy.GymV21CompatibilityV0(env=old)
        check_env(new, skip_render_check=True)
        new.reset(seed=1)
        for _ in range(4):
            observation, reward, terminated, truncated, info = new.step(1)
        print(observation, reward, terminated, truncated)
        """)
    )
    assert "[4.] 1.0 True False" in said
    assert "gym is not installed" in said


def test_wrappers_change_what_they_say() -> None:
    said = run(
        OLD_ENVIRONMENT
        + dedent("""
        class Doubled(gym.ObservationWrapper):
            def observation(self, observation): return 2 * observation
        class Halved(gym.RewardWrapper):
            def reward(self, reward): return reward / 2
        class Reversed(gym.ActionWrapper):
            def action(self, action): return 1 - action
        env = Reversed(Halved(Doubled(Corridor())))
        env.reset()
        print(env.step(0)[:2], env.unwrapped.at, env.action_space.n)
        """)
    )
    assert "(array([2.]), 0.5) 1 2" in said


def test_ready_made_environments_are_refused_by_name() -> None:
    said = run("""
        import gym
        try:
            gym.make("CartPole-v0")
        except ImportError as problem:
            print(problem)
        """)
    assert "no 'CartPole-v0' to make" in said


def test_a_real_gym_comes_first(tmp_path: Path) -> None:
    (tmp_path / "gym.py").write_text("__version__ = 'real'\n")
    assert run("import gym; print(gym.__version__)", tmp_path) == "real\n"


def test_a_missing_keyboard_is_reported() -> None:
    said = run("""
        from pynput import keyboard
        from pynput.keyboard import Key, KeyCode
        assert Key.up != Key.down and KeyCode(char="w") == KeyCode.from_char("w")
        with keyboard.Listener(on_press=print, on_release=print) as listener:
            assert listener.running
        """)
    assert "this listener hears nothing" in said
    assert "/teleopkeys" in said
