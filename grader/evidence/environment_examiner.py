"""Runs in the student's process, beside their file: makes their environment and calls it as the grader requests.

Never imported by the grader: the file is copied beside the student's. It judges nothing. What it reports is compared with
the world itself, which the grader keeps.
"""

import json
import math
import sys
import warnings
from importlib import import_module
from types import ModuleType
from typing import Any, Final

import gymnasium
import numpy as np
from gymnasium.utils.env_checker import check_env

MOST_NUMBERS: Final = 200

PlainData = dict[str, Any]


def describe_value(value: object) -> PlainData:
    """Describes a value as plain data: its type and its numbers; None for a number that is not finite."""
    kind = type(value).__name__
    if isinstance(value, tuple):
        return {"kind": kind, "parts": [describe_value(each) for each in value[:8]], "count": len(value)}
    if isinstance(value, np.ndarray):
        plain = value.ravel()[:MOST_NUMBERS].tolist() if value.dtype.kind in "fiub" else []
        numbers = [finite_or_none(each) for each in plain]
        return {"kind": kind, "dtype": str(value.dtype), "shape": list(value.shape), "numbers": numbers}
    if isinstance(value, (bool, np.bool_)):
        return {"kind": "bool", "value": bool(value)}
    if isinstance(value, (int, float, np.number)):
        return {"kind": kind, "value": finite_or_none(value)}
    return {"kind": kind}


def finite_or_none(value: Any) -> float | None:
    return float(value) if math.isfinite(value) else None


def describe_space(value: object) -> PlainData:
    """Describes a space as plain data."""
    if isinstance(value, gymnasium.spaces.Discrete):
        return {"kind": "Discrete", "n": int(value.n), "start": int(value.start)}
    if isinstance(value, gymnasium.spaces.Box):
        low, high = (finite_or_none(bound) for bound in (value.low.min(), value.high.max()))
        shape = list(value.shape)
        return {"kind": "Box", "shape": shape, "dtype": str(value.dtype), "low": low, "high": high}
    return {"kind": type(value).__name__}


def is_observation_valid(env: Any, returned: object) -> bool:
    """True if the observation, the first of the returned values, lies in the observation space."""
    is_space = isinstance(getattr(env, "observation_space", None), gymnasium.Space)
    observation = returned[0] if isinstance(returned, tuple) and returned else returned
    return bool(is_space and env.observation_space.contains(observation))


def make_environment(module: ModuleType, name: str) -> tuple[Any, PlainData]:
    """Makes the environment, and describes it."""
    cls = getattr(module, name, None)
    classes = [each for each, value in vars(module).items() if isinstance(value, type)][:20]
    if not isinstance(cls, type):
        return None, {"missing": classes}
    env = cls()
    spaces = {
        each: describe_space(getattr(env, each, None)) for each in ("action_space", "observation_space")
    }
    return env, {"is_env": isinstance(env, gymnasium.Env), **spaces}


def reset(env: Any, question: PlainData) -> PlainData:
    returned = env.reset(seed=question["seed"])
    return {"returned": describe_value(returned), "inside": is_observation_valid(env, returned)}


def step(env: Any, question: PlainData) -> PlainData:
    returned = env.step(np.int64(question["action"]))
    return {"returned": describe_value(returned), "inside": is_observation_valid(env, returned)}


def run_checker(env: Any, question: PlainData) -> PlainData:
    """Runs Gymnasium's own checker and returns its complaints."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            check_env(env, skip_render_check=True)
        except Exception as problem:  # noqa: BLE001  # any error is a complaint for the student to read
            return {"says": f"{type(problem).__name__}: {problem}"[:500], "warns": []}
    return {"says": "", "warns": [str(each.message)[:300] for each in caught[:5]]}


def main() -> None:
    # The kit's own packages, only on the path of a student's process.
    import rclpy
    from std_msgs.msg import String

    module, name = sys.argv[1:3]
    rclpy.init()
    node = rclpy.create_node("examiner", start_parameter_services=False, use_global_arguments=False)
    questions: list[str] = []
    node.create_subscription(String, "/examination/ask", lambda caught: questions.append(caught.data), 10)
    answers = node.create_publisher(String, "/examination/answer", 10)
    env, answer = make_environment(import_module(module), name)
    calls = {"reset": reset, "step": step, "checker": run_checker}
    while rclpy.ok():
        answers.publish(String(data=json.dumps(answer)))
        while not questions:
            rclpy.spin_once(node)
        question = json.loads(questions.pop())
        answer = calls[question["call"]](env, question)


if __name__ == "__main__":
    main()
