"""Runs programs in the shape of every program of ROS 2's examples for rclpy and of demo_nodes_py, and prints a table.

``python -m tests.ros.examples.table``, with names to run only those. Each program runs as ``kit ros run`` would run it,
in a process of its own and in simulated time, beside the programs that it needs; it passes when it has printed what
it should, and ended where it should.
"""

from __future__ import annotations

import os
import re
import sys
import time
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from kit.launch.launch_run import GraphOnlyRun
from kit.launch.processes import Process, ProcessExit
from kit.launch.program_lookup import StartContext, start_process
from kit.launch.requests import StartRequest
from kit.ros.graph.graph import Graph
from kit.run.episode import run_until, when
from kit.run.pacing import MAXIMUM, Schedule

FOLDER: Final = Path(__file__).parent
LIMIT_S: Final = 60.0
"""How long one example may take, by the wall clock [s]."""


@dataclass(frozen=True)
class Example:
    """One program, and how it shows that it works."""

    package: str
    program: str
    expected: tuple[str, ...]
    """Patterns that lines of its output must match, in this order: all of one stream, since two have no common order."""
    partners: tuple[str, ...] = ()
    """Other programs of the package that run beside it; arguments after a blank."""
    arguments: tuple[str, ...] = ()
    ends: bool = False
    """Whether it must end by itself, and without a failure."""
    of_partner: bool = False
    """Whether it is the first partner that prints what is expected."""


def _rclpy(program: str, *expected: str, **options: object) -> Example:
    return Example("examples_rclpy", program, expected, **options)  # type: ignore[arg-type]  # the fields of Example


def _demo(program: str, *expected: str, **options: object) -> Example:
    return Example("demo_nodes_py", program, expected, **options)  # type: ignore[arg-type]  # the fields of Example


_HELLO: Final = (r"Publishing: .Hello World: 0", r"Publishing: .Hello World: 1")
_HEARD: Final = (r"I heard: .Hello World: \d", r"I heard: .Hello World: \d")
_SUM: Final = r"Result of add_two_ints: for 41 \+ 1 = 42"
_RESULT: Final = r"Goal succeeded! Result: .*\[0, 1, 1, 2, 3, 5, 8, 13, 21, 34, 55\]"
_COUNTED: Final = r"Returning result: .*\[0, 1, 1, 2, 3, 5, 8, 13, 21, 34, 55\]"

EXAMPLES: Final = (
    _rclpy("publisher_old_school", *_HELLO),
    _rclpy("publisher_local_function", *_HELLO),
    _rclpy("publisher_member_function", *_HELLO),
    _rclpy(
        "publisher_wait_for_all_acked",
        r"Published and acknowledged: .Hello World: 0",
        partners=("subscriber_lambda",),
    ),
    _rclpy("subscriber_old_school", *_HEARD, partners=("publisher_member_function",)),
    _rclpy("subscriber_lambda", *_HEARD, partners=("publisher_member_function",)),
    _rclpy("subscriber_member_function", *_HEARD, partners=("publisher_old_school",)),
    _rclpy("pointcloud_publisher", r"400 points"),
    _rclpy("service", r"Incoming request", r"a: 41 b: 1", partners=("client",)),
    _rclpy("service_member_function", r"a: 41 b: 1", partners=("client",)),
    _rclpy("client", _SUM, partners=("service",), ends=True),
    _rclpy("client_async", _SUM, partners=("service",), ends=True),
    _rclpy("client_async_callback", _SUM, partners=("service",), ends=True),
    _rclpy("client_async_member_function", _SUM, partners=("service",), arguments=("41", "1"), ends=True),
    _rclpy("talker", *_HELLO),
    _rclpy("listener", *_HEARD, partners=("talker",)),
    _rclpy("composed", r"Publishing: .Hello World: 0", r"I heard: .Hello World: 0"),
    _rclpy("callback_group", *_HELLO, r"I heard: .Hello World"),
    # Ten tokens at once; then two in a second.
    _rclpy("custom_callback_group", r"Publishing at 0\.5: .*: 4.$", r"Publishing at 3\.0: .*: 15.$"),
    _rclpy(
        "custom_executor",
        r"\[talker\]: Publishing: .Hello World: 0",
        r"\[listener\]: I heard: .Hello World: 0",
        r"\[estopper\]: I heard: stop",
        partners=("estop",),
    ),
    _rclpy("trigger_guard_condition", r"timer callback triggered", r"guard callback called", ends=True),
    _rclpy("action_server", _COUNTED, partners=("action_client",)),
    _rclpy("action_server_asyncio", _COUNTED, partners=("action_client",)),
    _rclpy("action_server_not_composable", _COUNTED, partners=("action_client",)),
    _rclpy("action_server_defer", r"Deferring", r"Executing", _COUNTED, partners=("action_client",)),
    _rclpy(
        "action_server_queue_goals",
        r"Goal put in the queue",
        r"Next goal pulled",
        _COUNTED,
        partners=("action_client", "action_client_not_composable"),
    ),
    _rclpy(
        "action_server_single_goal",
        r"Aborting previous goal",
        r"Goal aborted",
        _COUNTED,
        partners=("action_client", "action_client_not_composable"),
    ),
    _rclpy(
        "action_client",
        r"Goal accepted",
        r"Received feedback: .*\[0, 1, 1\]",
        _RESULT,
        partners=("action_server",),
        ends=True,
    ),
    _rclpy(
        "action_client_cancel",
        r"Goal accepted",
        r"Canceling goal",
        r"Goal successfully canceled",
        partners=("action_server",),
        ends=True,
    ),
    _rclpy("action_client_not_composable", r"Goal accepted", _RESULT, partners=("action_server",), ends=True),
    _rclpy(
        "action_client_asyncio",
        r"unfinished: 0 finished: 2",
        r"A\) result .*\[0, 1, 1\]\) and status flag 4",
        partners=("action_server",),
        ends=True,
    ),
    _demo("talker", *_HELLO),
    _demo("listener", *_HEARD, partners=("talker",)),
    _demo(
        "talker_qos", r"Best effort talker", r"Publishing: .Hello World: 1", arguments=("-n", "2"), ends=True
    ),
    _demo(
        "listener_qos",
        r"Reliable listener",
        *_HEARD,
        partners=("talker_qos --reliable",),
        arguments=("--reliable", "-n", "2"),
        ends=True,
    ),
    _demo(
        "listener_serialized", r"I heard: .b'.*Hello World", r"which says: Hello World", partners=("talker",)
    ),
    _demo("add_two_ints_server", r"a: 2 b: 3", partners=("add_two_ints_client",)),
    _demo("add_two_ints_client", r"Result of add_two_ints: 5", partners=("add_two_ints_server",), ends=True),
    _demo(
        "add_two_ints_client_async",
        r"Result of add_two_ints: 5",
        partners=("add_two_ints_server",),
        ends=True,
    ),
    _demo(
        "introspection",
        r"/add_two_ints/_service_event \['example_interfaces/srv/AddTwoInts_Event'\]",
        partners=("event_listener",),
        arguments=("--ros-args", "-p", "client_configure_introspection:=contents"),
        of_partner=True,
    ),
    _demo("set_parameters_callback", r"1\.5 4\.0", partners=("param1_setter",)),
    _demo(
        "async_param_client",
        r"set int_parameter: True",
        r"listed \['bool_parameter', 'int_parameter', 'string_parameter'\]",
        r"got string_parameter: Fee Fi Fo Fum",
        r"loaded int_parameter: True 12",
        r"deleted other_string_parameter: True",
        partners=("parameter_blackboard",),
        ends=True,
    ),
    _demo(
        "matched_event_detect",
        r"subscriptions: 1 \(\+1\)",
        r"subscriptions: 2 \(\+1\)",
        r"subscriptions: 1 \(-1\)",
        r"subscriptions: 0 \(-1\)",
        r"publishers: 2 \(\+1\)",
        r"publishers: 0 \(-1\)",
        ends=True,
    ),
    _demo(
        "use_logger_service",
        r"Output None with INFO",
        r"Current logger level: 0",
        r"Output DEBUG with DEBUG",
        r"Current logger level: 10",
        r"Output WARN with WARN",
        r"Current logger level: 40",
        ends=True,
    ),
)
"""Programs of ros2/examples (31 with both that use asyncio) and of demo_nodes_py (13)."""


@dataclass(frozen=True)
class Outcome:
    """How an example went."""

    works: bool
    reason: str
    simulated_s: float


class _Output:
    """The lines that a program prints, and how many of the expected ones have come."""

    def __init__(self, expected: tuple[str, ...]) -> None:
        self._expected = expected
        self.found = 0
        self.lines: list[str] = []

    @property
    def is_complete(self) -> bool:
        return self.found == len(self._expected)

    @property
    def missing(self) -> str:
        return self._expected[self.found]

    def take(self, process: Process) -> None:
        for line in process.take_lines():
            self.lines.append(line.text)
            if not self.is_complete and re.search(self._expected[self.found], line.text):
                self.found += 1


def run_example(example: Example, limit_s: float = LIMIT_S) -> Outcome:
    """Runs an example until it has shown what it should, has ended, or its time is up."""
    run = GraphOnlyRun(Graph(log_sink=lambda record: None))
    context = StartContext(run.graph, (FOLDER,), 0, _ignore, _ignore, lambda: None, None, "")
    watched, other = _Output(example.expected), _Output(())
    until = time.monotonic() + limit_s
    with ExitStack() as stack:

        def start(number: int, words: tuple[str, ...]) -> Process:
            name, *rest = words
            request = StartRequest(
                number, name, example.package, name, tuple(rest), False, dict(os.environ), None, ""
            )
            process = start_process(request, context)
            stack.callback(process.close)
            process.wait_until_started()
            run.participants.append(process)
            return process

        main = start(1, (example.program, *example.arguments))
        partners = [start(i, tuple(words.split())) for i, words in enumerate(example.partners, start=2)]
        outputs = [(main, other if example.of_partner else watched)]
        outputs += [
            (partner, watched if example.of_partner and partner is partners[0] else other)
            for partner in partners
        ]
        ended: ProcessExit | None = None

        def is_over() -> bool:
            nonlocal ended
            for process, output in outputs:
                output.take(process)
                status = process.poll()
                if process is main and status is not None:
                    ended = status
                    output.take(process)
            return ended is not None or (watched.is_complete and not example.ends) or time.monotonic() > until

        run_until(run, ends=(when(is_over),), schedule=Schedule(run.step_size, factor=MAXIMUM))
    return Outcome(*_judge(example, watched, [*watched.lines, *other.lines], ended), run.graph.now_ns / 1e9)


def _judge(
    example: Example, output: _Output, lines: list[str], ended: ProcessExit | None
) -> tuple[bool, str]:
    last = lines[-1] if lines else "nothing"
    if ended is not None and ended.code != 0:
        return False, ended.reason or last
    if not output.is_complete:
        return False, f"'{output.missing}' was never printed; the last line was: {last}"
    if example.ends and ended is None:
        return False, "it did not end"
    return True, ""


def _ignore(_: object) -> None:
    """No-op callback."""


def main() -> None:
    wanted = set(sys.argv[1:])
    chosen = [each for each in EXAMPLES if not wanted or each.program in wanted]
    working = 0
    for example in chosen:
        outcome = run_example(example)
        working += outcome.works
        word = "runs" if outcome.works else "FAILS"
        print(
            f"{example.package:16}{example.program:32}{word:6}{outcome.simulated_s:8.2f} s  {outcome.reason}"
        )
    print(f"{working} of {len(chosen)} run")
    raise SystemExit(working < len(chosen))


if __name__ == "__main__":
    main()
