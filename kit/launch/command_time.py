"""Lets simulated time pass for the commands of a launch file, in a run that goes as fast as it can.

A program with nodes is in the lock-step; a command (``echo``, ``ros2 service call``) runs by the wall clock. So that it takes
the same simulated time on every machine, the world stands still while it works: a command of ``kit ros`` until it has connected,
and then whenever the world waits for its answer; any other command for a while, in which most have ended. One that goes on takes
as much simulated time as it takes of the wall clock.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Final

from kit.host.processor_delay import family_delayed_s
from kit.launch.launch_run import Launch
from kit.launch.processes import CommandProcess

START_S: Final = 20.0
"""How long the world waits for a command of ``kit ros``, to connect or to answer [s]."""
COMMAND_S: Final = 1.0
"""How long it waits for another command to end [s]."""
PAUSE_S: Final = 0.002
"""How long it waits between two looks [s]."""


class CommandTime:
    """Decides before each tick whether it must wait for a command."""

    def __init__(self, launch: Launch, clients: Callable[[], Mapping[int, bool]]) -> None:
        """``clients``: the programs that are connected to the world, by process id, and whether each owes it an answer."""
        self._launch, self._clients = launch, clients
        self._seen_s: dict[int, float] = {}
        """When each command was first seen, on the monotonic clock [s], by process id."""
        self._answered_s: dict[int, float] = {}
        """When each was last found not to owe an answer [s]."""
        self._given_up: set[int] = set()
        """The processes that took longer than they are waited for: it is not looked again what kept them."""

    def wait(self, exchange: Callable[[], object]) -> None:
        """Calls ``exchange``, which exchanges messages while time stands still, until no command must be waited for."""
        while self._must_wait():
            exchange()
            time.sleep(PAUSE_S)

    def _must_wait(self) -> bool:
        commands = self._launch.commands
        if not commands:
            return False
        now_s = time.monotonic()
        owing: dict[int, bool] = {}
        for pid, owes in self._clients().items():
            with suppress(OSError):  # it has ended
                owing[os.getpgid(pid)] = owes
        return any(self._is_waited_for(each, began_ns, owing, now_s) for each, began_ns in commands.items())

    def _is_waited_for(
        self, command: CommandProcess, began_ns: int, owing: Mapping[int, bool], now_s: float
    ) -> bool:
        """``began_ns``: when it was started, in simulated time."""
        now_ns = self._launch.graph.now_ns
        began_s = self._seen_s.setdefault(command.pid, now_s)
        if command.poll() is not None:
            return (
                now_ns != began_ns
            )  # until the launch has taken note, which does so in the tick after the start
        if not command.is_of_kit:
            taken_s = now_s - began_s
            return self._is_within(COMMAND_S, taken_s, command) or (now_ns - began_ns) / 1e9 > taken_s
        if owing.get(command.pid) is False:
            self._answered_s[command.pid] = now_s
            return False
        return self._is_within(START_S, now_s - self._answered_s.get(command.pid, began_s), command)

    def _is_within(self, limit_s: float, waited_s: float, command: CommandProcess) -> bool:
        """Whether a command that was waited for so long may still be, by the wall clock but for what a busy machine took."""
        if waited_s < limit_s:
            return True
        if command.pid not in self._given_up and waited_s - family_delayed_s(command.pid) < limit_s:
            return True
        self._given_up.add(command.pid)
        return False
