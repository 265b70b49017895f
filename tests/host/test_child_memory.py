"""A student's process holds nothing that the kit or the grader knows: of the run's seed only a one-way derivative."""

from __future__ import annotations

import json
import random
import secrets
from collections.abc import Iterator
from dataclasses import replace

import pytest

from kit.host.node_process import NodeProcess
from kit.host.program_start import child_seed
from kit.host.sandbox.sandbox_config import Level
from kit.host.student_functions import StudentFunctions
from kit.launch.launch_bounds import LaunchBounds
from kit.launch.launch_file_process import LaunchFileProcess
from kit.ros.graph.graph import Graph
from tests.host.conftest import QUICK, Student

pytestmark = pytest.mark.usefixtures("cold_start")

SECRET = 4_182_736_451_928_374_651
MASK = 0x5A
PATIENT = replace(QUICK, start_s=60.0, reply_s=60.0)
"""A search takes as long as the machine needs."""

SEARCHER = """
import gc
import random
import sys

MASK = 0x5A

def state():
    return [float(word) for word in random.getstate()[1]]

def in_memory(starts, rests):
    # The pattern itself must not come to lie in memory: its rest is compared byte by byte, behind a mask.
    found = []
    with open("/proc/self/maps") as maps, open("/proc/self/mem", "rb", 0) as memory:
        for line in maps.read().splitlines():
            span, rights = line.split()[:2]
            low, high = (int(each, 16) for each in span.split("-"))
            if not rights.startswith("rw") or "[v" in line:
                continue
            try:
                memory.seek(low)
                page = memory.read(high - low)
            except (OSError, ValueError, OverflowError):
                continue
            for number, (start, rest) in enumerate(zip(starts, rests)):
                wanted = bytes.fromhex(start)
                at = page.find(wanted)
                while at >= 0:
                    after = page[at + len(wanted) : at + len(wanted) + len(rest)]
                    if [float(each ^ MASK) for each in after] == rest:
                        found.append(float(number))
                    at = page.find(wanted, at + 1)
    return found

def in_objects(masked):
    seen, waiting = set(), [*gc.get_objects(), *sys._current_frames().values(), *map(vars, sys.meta_path[:1])]
    while waiting:
        each = waiting.pop()
        if id(each) in seen:
            continue
        seen.add(id(each))
        if type(each) is int and (str(each ^ int(masked)) == "1234567"):
            return True
        if not isinstance(each, (int, float, str, bytes)):
            waiting += gc.get_referents(each)
    return False
"""


NODE = """
import random
from rclpy.node import Node

class Printer(Node):
    def __init__(self):
        super().__init__("printer")
        print(random.random())
"""


def patterns(number: int) -> Iterator[tuple[str, list[float]]]:
    """How a number may lie in memory: as digits, as eight bytes, as Python keeps it; each as (start, masked rest)."""
    digits = [number >> 30 * place & (1 << 30) - 1 for place in range(3)]
    for pattern in (
        str(number).encode(),
        number.to_bytes(8, "little"),
        number.to_bytes(8, "big"),
        b"".join(digit.to_bytes(4, "little") for digit in digits),
    ):
        yield pattern[:4].hex(), [float(byte ^ MASK) for byte in pattern[4:]]


def found_in_memory(functions: StudentFunctions, number: int) -> object:
    starts, rests = zip(*patterns(number), strict=True)
    return functions.call_json("in_memory", {"starts": list(starts), "rests": list(rests)})


def found_in_objects(functions: StudentFunctions, number: int) -> object:
    return functions.call_json("in_objects", {"masked": str(number ^ 1_234_567)})


@pytest.mark.long
def test_a_secret_seed_is_nowhere_in_a_childs_memory(student: Student) -> None:
    with StudentFunctions(student(SEARCHER), seed=SECRET, limits=PATIENT, level=Level.LIMITED) as functions:
        assert found_in_memory(functions, SECRET) == []
        assert found_in_objects(functions, SECRET) is False
        # The same search finds what is there: the child's own seed.
        assert found_in_memory(functions, child_seed(SECRET)) != []
        assert found_in_objects(functions, child_seed(SECRET)) is True


@pytest.mark.long
@pytest.mark.parametrize("level", [Level.LIMITED, Level.FILTERED])
def test_the_state_of_random_comes_from_no_seed_of_a_run(student: Student, level: Level) -> None:
    from kit.host.sandbox.probe import highest_level_up_to

    if highest_level_up_to(level) < level:
        pytest.skip(f"this machine does not reach level {int(level)}")
    for seed in (7, SECRET):
        with StudentFunctions(student(SEARCHER), seed=seed, limits=PATIENT, level=level) as functions:
            assert found_in_objects(functions, SECRET) is False
            state = functions.call_json("state", {})
        candidates = {seed, *range(20), SECRET % 2**32, str(seed), float(seed)}
        assert not any(state == _state(candidate) for candidate in candidates)
        assert state == _state(child_seed(seed))


NODE_SEARCH = """
import rclpy
from rclpy.node import Node

class Searcher(Node):
    def __init__(self):
        super().__init__("searcher")
        print("found", in_memory({starts!r}, {rests!r}))
"""
LAUNCH_SEARCH = """
from launch import LaunchDescription

def generate_launch_description():
    print("found", in_memory({starts!r}, {rests!r}))
    return LaunchDescription([])
"""


@pytest.mark.parametrize("role", ["functions", "node", "launch"])
def test_nothing_that_the_kit_knows_is_in_a_childs_memory(
    student: Student, monkeypatch: pytest.MonkeyPatch, role: str
) -> None:
    """At level 0 too, where nothing keeps a program from reading its own memory."""
    planted = secrets.token_hex(16)
    monkeypatch.setenv("GRADER_TOKEN", planted)
    kept = {"seeds": [planted, planted.encode()]}
    own = "".join(["a plain word ", "of the program's own"])  # the search finds what is there
    starts = [text.encode()[:4].hex() for text in (planted, own)]
    rests = [[float(byte ^ MASK) for byte in text.encode()[4:]] for text in (planted, own)]
    source = f"OWN = {own!r}\n" + SEARCHER
    if role == "functions":
        with StudentFunctions(student(source), limits=PATIENT, level=Level.LIMITED) as functions:
            found = functions.call_json("in_memory", {"starts": starts, "rests": rests})
    elif role == "node":
        file = student(source + NODE_SEARCH.format(starts=starts, rests=rests))
        with NodeProcess(Graph(log_sink=lambda record: None), file, limits=PATIENT) as node:
            node.wait_until_started()
            found = json.loads(node.take_output().lines[0].text.removeprefix("found "))
    else:
        file = student(source + LAUNCH_SEARCH.format(starts=starts, rests=rests))
        bounds = LaunchBounds(Level.LIMITED, PATIENT, PATIENT)  # a user's own gets the user's environment
        launch = LaunchFileProcess(file, file.parent, [], {}, bounds)
        try:
            launch.start()
            found = json.loads(launch.take_output().lines[0].text.removeprefix("found "))
        finally:
            launch.close()
    assert 1.0 in found, "the search finds what is there"
    assert 0.0 not in found
    assert kept["seeds"][0] == planted


def _state(seed: float | str) -> list[float]:
    return [float(word) for word in random.Random(seed).getstate()[1]]


def test_all_kinds_of_programs_get_the_derivative(student: Student) -> None:
    file = student("import random\nprint(random.random())\ndef f():\n    return random.random()\n")
    with StudentFunctions(file, seed=SECRET, limits=PATIENT) as functions:
        printed = functions.take_output().lines[0].text
    assert float(printed) == random.Random(child_seed(SECRET)).random()
    node = NodeProcess(Graph(log_sink=lambda record: None), student(NODE), seed=SECRET, limits=PATIENT)
    with node:
        node.wait_until_started()
        assert node.take_output().lines[0].text == printed
