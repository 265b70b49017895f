"""Events: a process starts, prints or ends; the launch shuts down."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


class Event:
    """Something that events, or is to happen."""

    name = "launch.Event"


class ChangeState(Event):
    """Requests a transition, by its number in lifecycle_msgs, of the lifecycle nodes for which the matcher is true."""

    def __init__(self, *, lifecycle_node_matcher: Callable[[Any], bool], transition_id: int) -> None:
        self.lifecycle_node_matcher, self.transition_id = lifecycle_node_matcher, transition_id


class StateTransition(Event):
    """A lifecycle node of the launch has made a transition; states and transition are given by their labels."""

    name = "launch_ros.events.lifecycle.StateTransition"

    def __init__(self, *, action: Any, transition: str, start_state: str, goal_state: str) -> None:
        self.action = action
        """The one that started the node."""
        self.transition, self.start_state, self.goal_state = transition, start_state, goal_state


class Shutdown(Event):
    """The launch shuts down."""

    name = "launch.events.Shutdown"

    def __init__(self, *, reason: str = "reason not given", due_to_sigint: bool = False) -> None:
        self.reason = reason
        self.due_to_sigint = due_to_sigint


class ExecutionComplete(Event):
    """An action has been carried out; one that starts a process or a timer, when these have ended."""

    name = "launch.events.ExecutionComplete"

    def __init__(self, *, action: Any) -> None:
        self.action = action


class IncludeLaunchDescription(Event):
    """Requests that a launch description be carried out."""

    name = "launch.events.IncludeLaunchDescription"

    def __init__(self, launch_description: Any) -> None:
        self.launch_description = launch_description


class RunningProcessEvent(Event):
    """An event of a process that the launch has started."""

    name = "launch.events.process.RunningProcessEvent"

    def __init__(self, *, action: Any, name: str, pid: int = 0) -> None:
        self.action = action
        """The one that started it."""
        self.process_name = name
        self.pid = pid


class ProcessStarted(RunningProcessEvent):
    name = "launch.events.process.ProcessStarted"


class ProcessExited(RunningProcessEvent):
    name = "launch.events.process.ProcessExited"

    def __init__(self, *, returncode: int, **about: Any) -> None:
        super().__init__(**about)
        self.returncode = returncode


class ProcessIO(RunningProcessEvent):
    """A process has printed something."""

    name = "launch.events.process.ProcessIO"

    def __init__(self, *, text: bytes, from_stdout: bool, **about: Any) -> None:
        super().__init__(**about)
        self.text = text
        self.from_stdout = from_stdout

    @property
    def from_stderr(self) -> bool:
        return not self.from_stdout


class ProcessMatchingEvent(Event):
    """Commands the processes for whose action ``process_matcher(action)`` is true."""

    def __init__(self, *, process_matcher: Callable[[Any], bool]) -> None:
        self.process_matcher = process_matcher


class ShutdownProcess(ProcessMatchingEvent):
    """Ends processes."""

    name = "launch.events.process.ShutdownProcess"


class SignalProcess(ProcessMatchingEvent):
    """Sends a signal to processes; here any signal ends them."""

    name = "launch.events.process.SignalProcess"

    def __init__(self, *, signal_number: Any, process_matcher: Callable[[Any], bool]) -> None:
        super().__init__(process_matcher=process_matcher)
        self.signal = signal_number


def event_named(event_name: str) -> Callable[[Event], bool]:
    """Returns a matcher for the events of this name, as ``launch.events.Shutdown``."""
    return lambda event: event.name == event_name


def matches_pid(pid: int) -> Callable[[Any], bool]:
    """Returns a matcher for the process of this number."""
    return lambda action: (action.process_details or {}).get("pid") == pid


def matches_name(name: str) -> Callable[[Any], bool]:
    """Returns a matcher for the process that the launch calls so, as ``talker-1``."""
    return lambda action: (action.process_details or {}).get("name") == name


def matches_executable(executable: str) -> Callable[[Any], bool]:
    """Returns a matcher for processes whose program's path ends so."""
    return lambda action: (action.process_details or {"cmd": [""]})["cmd"][0].endswith(executable)


def matches_node_name(node_name: str) -> Callable[[Any], bool]:
    """Returns a matcher for the node of this full name."""
    full_name = f"/{node_name.lstrip('/')}"
    return lambda action: getattr(action, "full_name", None) == full_name


def matches_action(action: Any) -> Callable[[Any], bool]:
    """Returns a matcher for the process that this action has started."""
    return lambda other: other is action
