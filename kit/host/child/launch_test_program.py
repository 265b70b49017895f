"""Runs a test file for launch_testing in the child: the launch that it describes, and its tests, in one program.

The main thread carries the launch out: it requests processes of the kit, and hears what happens to them, as a launch file
does, over a channel of the bridge::

    to the kit    wake time, requests       those of the launch file; also ``runs`` (how many launches the file has) and,
                                            at the end, ``tested`` (the cases, and why there are none)
    to the child  event                     what has happened; ``over`` when every process has ended

The tests run in a thread of their own beside it, and those that come after the end in the main thread, as in ROS 2: what the
launch file's own functions do is seen by its tests. All waits are in the graph, so that the same test takes the same time on
every machine.
"""

from __future__ import annotations

import os
import sys
import threading
import unittest
from collections.abc import Mapping
from typing import Any, Final

from kit.host.child.launch_program import explained, truncated
from kit.host.child.student_module import StudentProgram
from kit.host.graph_bridge import LAUNCH_CHANNEL, LAUNCH_OVER, ChildBridge
from kit.host.wire import MAX_TEXT, Json
from kit.ros.launch.actions import RegisterEventHandler
from kit.ros.launch.context import LaunchContext
from kit.ros.launch.entity import LaunchDescription
from kit.ros.launch.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart
from kit.ros.launch.events import Shutdown
from kit.ros.launch.service import LaunchService, Request
from kit.ros.launch.testing.lookup import process_name
from kit.ros.launch.testing.marks import KeepAliveProc
from kit.ros.launch.testing.records import ActiveIoHandler, ActiveProcInfoHandler
from kit.ros.launch.testing.runs import LaunchTestResult, LaunchTestRun, read_test_runs, run_tests
from kit.ros.launch.unavailable import install_unavailable_imports
from kit.ros.node.time import S_TO_NS

MODULE: Final = "launch_test_file"
"""The name of the module that the file becomes."""
STOPPED: Final = "Processes under test stopped before tests completed"
NOT_READY: Final = "Timed out waiting for processes to start up"


def run(program: StudentProgram, bridge: ChildBridge, start: Mapping[str, Any]) -> None:
    """Runs one of the file's launches, ``start["run"]``, with ``start["arguments"]``, and its tests."""
    install_unavailable_imports()
    context = LaunchContext()
    context.files.append(program.file)
    with explained(program, context):
        runs = read_test_runs(program.load(MODULE))
    _LaunchTest(program, bridge, runs[start["run"]], dict(start["arguments"])).run(len(runs))


class _LaunchTest:
    def __init__(
        self, program: StudentProgram, bridge: ChildBridge, run: LaunchTestRun, arguments: dict[str, str]
    ) -> None:
        self._program, self._graph, self._run, self._arguments = program, bridge.graph, run, arguments
        self._events: list[list[Any]] = []
        self._is_ready = self._is_tested = False
        self._not_tested = ""
        """Why the tests have not been run to their end."""
        self._results: list[LaunchTestResult] = []
        self._send = bridge.open_channel(LAUNCH_CHANNEL, self._events.extend)
        self._service = LaunchService(program.file, arguments, environment=dict(os.environ))
        self._service.context.on_ready_to_test = self._note_ready
        self._proc_info = ActiveProcInfoHandler(bridge.graph)
        self._proc_output = ActiveIoHandler(bridge.graph)

    def run(self, run_count: int) -> None:
        """Carries the launch out until all its processes have ended, and tells how its tests did."""
        self._request([["runs", run_count]])
        with explained(self._program, self._service.context):
            try:
                given = self._start()
            except unittest.SkipTest as skip:
                _say(f"the launch is skipped: {skip}")
                self._tell([], f"skipped: {skip}", is_failed=False)
                return
        tests = threading.Thread(target=self._test, name="test_runner_thread", daemon=True)
        tests.start()
        self._carry_out()
        if not self._is_tested:
            self._print_not_tested()
            self._tell([], self._not_tested, is_failed=True)
            return
        records = {
            "proc_info": self._proc_info.at_rest(),
            "proc_output": self._proc_output.at_rest(),
            "test_args": self._arguments,
        }
        self._run.bind(self._run.tests_after, {**given, **records}, records)
        self._results.append(run_tests(self._run.tests_after, self._clock_s))
        cases = [[*case] for result in self._results for case in result.cases()]
        self._tell(cases, "", is_failed=not all(result.wasSuccessful() for result in self._results))

    def _start(self) -> dict[str, Any]:
        """Begins the launch; returns what the file gives its tests. Raises SkipTest, and what the file raises."""
        description, given = self._run.describe()
        handlers: list[Any] = [
            OnProcessStart(on_start=lambda event, context: self._proc_info.append(event)),
            OnProcessExit(on_exit=lambda event, context: self._proc_info.append(event)),
            OnProcessIO(on_stdout=self._proc_output.append, on_stderr=self._proc_output.append),
        ]
        records = {
            "proc_info": self._proc_info,
            "proc_output": self._proc_output,
            "test_args": self._arguments,
        }
        self._run.bind(self._run.active_tests, {**given, **records}, records)
        whole = LaunchDescription(
            [
                *map(RegisterEventHandler, handlers),
                *([KeepAliveProc()] if self._run.keeps_alive else []),
                description,
            ]
        )
        self._request(self._service.start(whole))
        return given

    def _carry_out(self) -> None:
        """Reacts to what happens until every process has ended; ends them when the tests have."""
        service = self._service
        while True:
            until = None if service.context.is_shutdown else service.wake_ns
            self._graph.wait(self._has_news, until, what="the launch under test")
            events, self._events[:] = list(self._events), []
            if self._is_done and not service.context.is_shutdown:
                service.context.emit(Shutdown(reason=self._not_tested or "the tests have ended"))
            with explained(self._program, service.context):
                requests = service.advance(
                    self._graph.now_ns, [event for event in events if event[0] != LAUNCH_OVER]
                )
            self._request(requests)
            if any(event[0] == LAUNCH_OVER for event in events):
                return

    @property
    def _is_done(self) -> bool:
        return self._is_tested or bool(self._not_tested)

    def _has_news(self) -> bool:
        return bool(self._events) or (self._is_done and not self._service.context.is_shutdown)

    def _test(self) -> None:
        """Waits until the tests may begin, and runs those that come before the end."""
        until = self._graph.now_ns + round(self._run.ready_timeout_s * S_TO_NS)
        if self._graph.wait(lambda: self._is_ready, until, what="a launch test"):
            self._results.append(run_tests(self._run.active_tests, self._clock_s))
            self._is_tested = True
        else:
            self._not_tested = NOT_READY
        self._graph.notify()

    def _note_ready(self) -> None:
        self._is_ready = True
        self._graph.notify()

    def _clock_s(self) -> float:
        return self._graph.now_ns / S_TO_NS

    def _request(self, requests: list[Request]) -> None:
        self._send(self._service.wake_ns, truncated(requests))

    def _tell(self, cases: list[list[Json]], reason: str, *, is_failed: bool) -> None:
        for case in cases:
            case[-1] = str(case[-1])[-MAX_TEXT:]  # the end of a traceback says most
        self._request([["tested", self._run.suffix, cases, reason, is_failed]])

    def _print_not_tested(self) -> None:
        """Says why the tests have not been run, and what the processes that have failed have printed."""
        self._not_tested = self._not_tested or STOPPED
        _say(self._not_tested)
        for event in self._proc_info:
            code = getattr(event, "returncode", 0)
            if code:
                _say(f"Process '{event.process_name}' exited with {code}")
                for line in self._proc_output:
                    if line.action is event.action:
                        _say(f"  {line.text.decode().rstrip()}")
        if not self._is_ready:
            _say("ReadyToTest was not carried out.")
        elif self._not_tested == STOPPED and not self._service.context.is_shutdown:
            _say(
                f"{_process_names(self._proc_info)} ended before the tests did; a launch whose processes may end is marked "
                "with @launch_testing.markers.keep_alive"
            )


def _say(text: str) -> None:
    """Prints where ``unittest`` prints."""
    sys.stderr.write(f"{text}\n")


def _process_names(records: ActiveProcInfoHandler) -> str:
    """The names of the processes of which something is recorded, as the subject of a sentence."""
    return ", ".join(map(process_name, records.processes())) or "The launch"
