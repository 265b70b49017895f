"""Runs a launch description: turns entities and events into requests to start and end processes.

Time and events are passed in; requests are returned, as plain data::

    log        level, text
    listen                                        send an event for every line a process prints
    process    number, specification              start it; see ``processes`` for the specification
    end        number                             end it
    transition name, number                       request a transition of a lifecycle node
    watch      name                               send an event for every transition of it
    timer      time [ns]                          a timer is due then that no timer has set
    shutdown   reason                             end everything
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from heapq import heappop, heappush
from itertools import count
from types import MappingProxyType
from typing import Any, Final

from kit.ros.launch.bounds import (
    LOG_LINE,
    MAX_ACTIONS,
    MAX_DEPTH,
    MAX_LOGGED,
    MAX_PROCESSES,
    NESTED_TOO_DEEPLY,
)
from kit.ros.launch.context import LaunchContext, LaunchError, Visitable
from kit.ros.launch.entity import LaunchDescription, LaunchDescriptionEntity
from kit.ros.launch.events import (
    ChangeState,
    Event,
    IncludeLaunchDescription,
    ProcessExited,
    ProcessIO,
    ProcessMatchingEvent,
    ProcessStarted,
    Shutdown,
    StateTransition,
)
from kit.ros.launch.frontend.markup_reader import read_launch_description
from kit.ros.launch.processes import ExecuteProcess, LifecycleNode
from kit.ros.launch.unavailable import SoftwareUnavailable
from kit.ros.share_folders import with_original_paths

Request = list[Any]
"""The kind of the request, then its content."""


class LaunchService:
    """Carries a launch description out without starting any process itself."""

    def __init__(
        self, file: str, arguments: dict[str, str], *, environment: dict[str, str] | None = None
    ) -> None:
        self.context = context = LaunchContext(environment=environment)
        context.launch_configurations.update(arguments)
        context.files.append(file)
        context.request = self._request
        context.read_markup = read_launch_description
        context.start_timer = self._start_timer
        self._requests: list[Request] = []
        self._events: list[Event] = []
        context.emit = self._events.append
        self._timers: list[tuple[int, int, tuple[LaunchDescriptionEntity, ...], Visitable | None]] = []
        """When [ns], a number, what is to be carried out then, and the action that waits, if one does."""
        self._cancelled: set[int] = set()
        self._actions: dict[int, tuple[ExecuteProcess, str]] = {}
        self._process_numbers, self._timer_numbers = count(1), count(1)
        self._is_in_timer = False
        self._now_ns = 0
        self._depth = 0
        """Levels of entities that are being visited."""
        self._visited_count, self._process_count, self._logged_length = 0, 0, 0
        """Entities visited, processes started and characters logged since the last answer."""

    @property
    def wake_ns(self) -> int | None:
        """The time at which the next timer is due [ns]; None without timers."""
        return self._timers[0][0] if self._timers else None

    def start(self, description: LaunchDescription) -> list[Request]:
        """Visits the description; returns the first requests. Raises LaunchError, and what functions of the file raise."""
        self._visit(description)
        return self._finish()

    def advance(self, now_ns: int, events: Iterable[list[Any]]) -> list[Request]:
        """Handles events (see ``_EVENT_METHODS``) and due timers; returns the requests that follow. Raises likewise."""
        self._now_ns = now_ns
        for kind, *content in events:
            _EVENT_METHODS[kind](self, *content)
        while self._timers and self._timers[0][0] <= now_ns:
            _, number, actions, timer = heappop(self._timers)
            if number not in self._cancelled:
                self._is_in_timer = True
                for action in actions:
                    self._visit(action)
                if timer is not None:
                    self.context.report_complete(timer)
                self._is_in_timer = False
        return self._finish()

    def _finish(self) -> list[Request]:
        while self._events:
            self._handle(self._events.pop(0))
        requests, self._requests = self._requests, []
        self._visited_count, self._process_count, self._logged_length = 0, 0, 0
        return requests

    def _visit(self, entity: LaunchDescriptionEntity) -> None:
        context = self.context
        before, context.location = context.location, getattr(entity, "location", None) or context.location
        depth_before, self._depth = self._depth, self._depth + 1
        self._visited_count += 1
        try:
            if self._depth > MAX_DEPTH:
                raise LaunchError(NESTED_TOO_DEEPLY)
            if self._visited_count > MAX_ACTIONS:
                raise LaunchError(
                    f"more than {MAX_ACTIONS:,} actions are carried out at once: does a loop, or do includes, repeat too often?"
                )
            for part in entity.visit(context) or ():
                self._visit(part)
        except SoftwareUnavailable as problem:
            where = f"{context.location.file}:{context.location.line}: " if context.location else ""
            self._request("log", "WARN", f"{where}skipped: {problem}")
        except LaunchError as problem:
            if problem.location is None:
                problem.location = context.location
            raise
        context.location, self._depth = before, depth_before

    def _handle(self, event: Event) -> None:
        if isinstance(event, ProcessMatchingEvent):
            for number, (action, _) in list(self._actions.items()):
                if event.process_matcher(action):
                    self._requests.append(["end", number])
        if isinstance(event, ChangeState):
            for action, _ in list(self._actions.values()):
                if isinstance(action, LifecycleNode) and event.lifecycle_node_matcher(action):
                    self._requests.append(["transition", action.full_name, event.transition_id])
        if isinstance(event, IncludeLaunchDescription):
            self._visit(event.launch_description)
        for handler in list(self.context.handlers):
            if handler.matches(event):
                self.context.push_event(event)
                for entity in handler.handle(event, self.context):
                    self._visit(entity)
                self.context.pop_event()
        if isinstance(event, Shutdown) and not self.context.is_shutdown:
            self.context.is_shutdown = True
            self._timers.clear()
            self._requests.append(["shutdown", event.reason])

    # Called through the context

    def _request(self, kind: str, *content: Any) -> None:
        if kind == "log":
            self._logged_length += len(content[1]) + LOG_LINE
            if self._logged_length > MAX_LOGGED:
                raise LaunchError(f"more than {MAX_LOGGED // 1024} KiB are logged at once")
        if kind == "process":
            self._process_count += 1
            if self._process_count > MAX_PROCESSES:
                raise LaunchError(f"more than {MAX_PROCESSES} processes are started at once")
            action, specification = content
            number = next(self._process_numbers)
            self._actions[number] = (action, f"{specification['title']}-{number}")
            action.number = number
            action.process_details = {
                "cmd": specification.get("command")
                or [specification["executable"], *specification["arguments"]],
                "cwd": specification["cwd"],
                "env": specification["environment"],
            }
            content = (number, with_original_paths(specification))
        self._requests.append([kind, *content])

    def _start_timer(
        self,
        seconds: float,
        actions: Iterable[LaunchDescriptionEntity],
        timer: Visitable | None = None,
    ) -> Callable[[], None]:
        number, due_ns = next(self._timer_numbers), self._now_ns + int(seconds * 1e9)
        heappush(self._timers, (due_ns, number, tuple(actions), timer))
        if not self._is_in_timer:  # one that sets itself again would be waited for without end
            self._requests.append(["timer", due_ns])
        return lambda: self._cancelled.add(number)

    # Events

    def _started(self, number: int, pid: int) -> None:
        action, name = self._actions[number]
        action.process_details = {**(action.process_details or {}), "name": name, "pid": pid}
        self._events.append(ProcessStarted(action=action, name=name, pid=pid))

    def _exited(self, number: int, pid: int, code: int) -> None:
        action, name = self._actions.pop(number)
        self._events.append(ProcessExited(action=action, name=name, pid=pid, returncode=code))
        self.context.report_complete(action)
        if action.respawns(self.context) and not self.context.is_shutdown:
            self._start_timer(action.respawn_delay or 0.0, [action])

    def _printed(self, number: int, text: str, from_stdout: bool) -> None:
        action, name = self._actions[number]
        self._events.append(ProcessIO(action=action, name=name, text=text.encode(), from_stdout=from_stdout))

    def _transitioned(self, node: str, transition: str, start_state: str, goal_state: str) -> None:
        for action, _ in list(self._actions.values()):
            if isinstance(action, LifecycleNode) and action.full_name == node:
                self._events.append(
                    StateTransition(
                        action=action, transition=transition, start_state=start_state, goal_state=goal_state
                    )
                )

    def _interrupted(self, reason: str) -> None:
        self._events.append(Shutdown(reason=reason, due_to_sigint=True))


_EVENT_METHODS: Final[Mapping[str, Callable[..., None]]] = MappingProxyType(
    {
        "started": LaunchService._started,
        "exited": LaunchService._exited,
        "printed": LaunchService._printed,
        "transitioned": LaunchService._transitioned,
        "interrupted": LaunchService._interrupted,
    }
)
"""The kinds of events: a process has started, ended or printed something; a lifecycle node has changed; the user has interrupted the launch."""
