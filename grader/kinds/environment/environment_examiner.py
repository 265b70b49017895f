"""Runs in the student's process, beside their file: makes their environment and calls it as the grader requests.

Never imported by the grader: the file is copied beside the student's. It judges nothing, and nothing that it says about
itself counts: it sends values as plain data, which the grader rebuilds, checks, and compares with the world, which it
keeps.
"""

import hashlib
import json
import math
import sys
from importlib import import_module
from types import ModuleType
from typing import Any, Final

import gymnasium
import numpy as np

MAX_NUMBERS: Final = 1000
MAX_PARTS: Final = 16
MAX_DEPTH: Final = 5

PlainData = dict[str, Any]


def describe_value(value: object, depth: int = MAX_DEPTH) -> PlainData:
    """Describes a value as plain data: its type and its numbers; None for a number that is not finite.

    Of what cannot be looked at, such as a list of a class of their own that fails, the type alone is told.
    """
    try:
        return _describe_value(value, depth)
    except Exception:  # noqa: BLE001  # whatever their own classes raise
        return {"kind": type(value).__name__[:80]}


def _describe_value(value: object, depth: int) -> PlainData:
    kind = type(value).__name__[:80]
    if isinstance(value, np.ndarray):
        plain = value.ravel()[:MAX_NUMBERS].tolist() if value.dtype.kind in "fiub" else []
        numbers = [finite_or_none(each) for each in plain]
        return {"kind": kind, "dtype": str(value.dtype)[:80], "shape": list(value.shape), "numbers": numbers}
    if isinstance(value, (bool, np.bool_)):
        return {"kind": "bool", "value": bool(value), "numpy": isinstance(value, np.bool_)}
    if isinstance(value, (int, float, np.number)):
        return {"kind": kind, "value": finite_or_none(value)}
    if isinstance(value, str):
        return {"kind": kind, "text": value[:100]}
    if depth > 1 and isinstance(value, (tuple, list)):
        name = "parts" if isinstance(value, tuple) else "values"
        parts = [describe_value(each, depth - 1) for each in value[:MAX_PARTS]]
        return {"kind": "tuple" if isinstance(value, tuple) else "list", name: parts, "count": len(value)}
    if depth > 1 and isinstance(value, dict):
        named = [(name, each) for name, each in value.items() if isinstance(name, str)][:MAX_PARTS]
        return {"kind": "dict", "items": {name[:80]: describe_value(each, depth - 1) for name, each in named}}
    return {"kind": kind}


def finite_or_none(value: Any) -> float | None:
    """Returns a number as a float; None for one that is not finite, is complex, or is larger than any float."""
    try:
        number = float(value)
    except (OverflowError, TypeError, ValueError):
        return None
    return number if math.isfinite(number) else None


def describe_space(value: object) -> PlainData:
    """Describes a space as plain data; of one that cannot be looked at, the type alone is told."""
    try:
        return _describe_space(value)
    except Exception:  # noqa: BLE001  # whatever their own classes raise
        return {"kind": type(value).__name__[:80], "is_space": isinstance(value, gymnasium.Space)}


def _describe_space(value: object) -> PlainData:
    kind = type(value).__name__[:80]
    if isinstance(value, gymnasium.spaces.Discrete):
        return {"kind": "Discrete", "n": int(value.n), "start": int(value.start)}
    if isinstance(value, gymnasium.spaces.Box):
        lows, highs = (
            [finite_or_none(each) for each in bounds.ravel()[: MAX_NUMBERS + 1].tolist()]
            for bounds in (value.low, value.high)
        )
        shape = list(value.shape)
        return {"kind": "Box", "shape": shape, "dtype": str(value.dtype), "lows": lows, "highs": highs}
    return {"kind": kind, "is_space": isinstance(value, gymnasium.Space)}


def make_environment(module: ModuleType, name: str) -> tuple[Any, PlainData]:
    """Makes the environment, and describes it."""
    cls = getattr(module, name, None)
    classes = [each[:80] for each, value in vars(module).items() if isinstance(value, type)][:20]
    if not isinstance(cls, type):
        return None, {"missing": classes}
    env = cls()
    return env, {"is_env": isinstance(env, gymnasium.Env), **describe_spaces(env)}


def describe_spaces(env: Any) -> PlainData:
    """Describes both spaces of an environment, as they are now."""
    return {each: describe_space(getattr(env, each, None)) for each in ("action_space", "observation_space")}


class CallRunner:
    """Calls the environment's methods as the grader requests."""

    def __init__(self, env: Any) -> None:
        self._env = env
        self._spaces = describe_spaces(env)
        self._kept: list[tuple[object, object]] = []

    def answer(self, question: PlainData) -> PlainData:
        """Makes one call, and tells of spaces that it has changed; see ``_answer``."""
        answer, spaces = self._answer(question), describe_spaces(self._env)
        return (
            answer
            if spaces == self._spaces
            else {**answer, "changed": [each for each in spaces if spaces[each] != self._spaces[each]]}
        )

    def _answer(self, question: PlainData) -> PlainData:
        """Makes one call; while Gymnasium's checker runs, an exception is an answer too."""
        if not question.get("checking"):
            return {"returned": describe_value(self._call(question))}
        try:
            returned = self._call(question)
        except Exception as problem:  # noqa: BLE001  # any error is a complaint for the student to read
            return {"raised": f"{type(problem).__name__}: {problem}"[:500]}
        generator = getattr(self._env, "_np_random", None)
        state = None if generator is None else repr(generator.bit_generator.state).encode()
        return {
            "returned": describe_value(returned),
            "generator": None if state is None else hashlib.sha256(state).hexdigest(),
            "reused": self._find_reused(returned),
        }

    def _call(self, question: PlainData) -> object:
        if question["call"] == "reset":
            return self._env.reset(**question["keywords"])
        return self._env.step(np.int64(question["action"]))

    def _find_reused(self, returned: object) -> list[bool]:
        """Returns whether the observation and the info share their memory with those of an earlier call."""
        if not isinstance(returned, tuple) or len(returned) < 2:
            return [False, False]
        observation, info = returned[0], returned[-1]
        reused = [
            any(_shares_memory(observation, earlier) for earlier, _ in self._kept),
            any(info is earlier for _, earlier in self._kept),
        ]
        self._kept = [*self._kept[-3:], (observation, info)]
        return reused


def _shares_memory(one: object, other: object) -> bool:
    return isinstance(one, np.ndarray) and isinstance(other, np.ndarray) and np.may_share_memory(one, other)


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
    runner, number = CallRunner(env), 0
    while rclpy.ok():
        answers.publish(String(data=json.dumps({**answer, "number": number})))
        while not questions:
            rclpy.spin_once(node)
        question = json.loads(questions.pop())
        answer, number = runner.answer(question), question["number"]


if __name__ == "__main__":
    main()
