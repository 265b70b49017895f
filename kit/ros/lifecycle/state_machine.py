"""The states of a lifecycle node, the transitions between them, and which state it is in."""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from typing import Final, NamedTuple

from kit.msg.lifecycle_msgs import State, Transition
from kit.ros.exceptions import RCLError


class TransitionCallbackReturn(IntEnum):
    """What a callback of a transition returns."""

    SUCCESS = Transition.TRANSITION_CALLBACK_SUCCESS
    FAILURE = Transition.TRANSITION_CALLBACK_FAILURE
    ERROR = Transition.TRANSITION_CALLBACK_ERROR

    def to_label(self) -> str:
        """The label of the transition that follows."""
        return f"transition_{self.name.lower()}"


class LifecycleState(NamedTuple):
    """A state of a lifecycle node."""

    label: str
    state_id: int


class StateMachineTransition(NamedTuple):
    """A way from one state to another."""

    label: str
    transition_id: int
    start: LifecycleState
    goal: LifecycleState


UNKNOWN: Final = LifecycleState("unknown", State.PRIMARY_STATE_UNKNOWN)
UNCONFIGURED: Final = LifecycleState("unconfigured", State.PRIMARY_STATE_UNCONFIGURED)
INACTIVE: Final = LifecycleState("inactive", State.PRIMARY_STATE_INACTIVE)
ACTIVE: Final = LifecycleState("active", State.PRIMARY_STATE_ACTIVE)
FINALIZED: Final = LifecycleState("finalized", State.PRIMARY_STATE_FINALIZED)
CONFIGURING: Final = LifecycleState("configuring", State.TRANSITION_STATE_CONFIGURING)
CLEANING_UP: Final = LifecycleState("cleaningup", State.TRANSITION_STATE_CLEANINGUP)
SHUTTING_DOWN: Final = LifecycleState("shuttingdown", State.TRANSITION_STATE_SHUTTINGDOWN)
ACTIVATING: Final = LifecycleState("activating", State.TRANSITION_STATE_ACTIVATING)
DEACTIVATING: Final = LifecycleState("deactivating", State.TRANSITION_STATE_DEACTIVATING)
ERROR_PROCESSING: Final = LifecycleState("errorprocessing", State.TRANSITION_STATE_ERRORPROCESSING)

STATES: Final = (
    UNKNOWN,
    UNCONFIGURED,
    INACTIVE,
    ACTIVE,
    FINALIZED,
    CONFIGURING,
    CLEANING_UP,
    SHUTTING_DOWN,
    ACTIVATING,
    DEACTIVATING,
    ERROR_PROCESSING,
)


def _outcomes(
    first_id: int, start: LifecycleState, goals: tuple[LifecycleState, LifecycleState, LifecycleState]
) -> tuple[StateMachineTransition, ...]:
    """The three transitions that end a transition state; their numbers follow each other."""
    return tuple(
        StateMachineTransition(outcome.to_label(), first_id + i, start, goal)
        for i, (outcome, goal) in enumerate(zip(TransitionCallbackReturn, goals, strict=True))
    )


TRANSITIONS: Final = (
    StateMachineTransition("configure", Transition.TRANSITION_CONFIGURE, UNCONFIGURED, CONFIGURING),
    *_outcomes(
        Transition.TRANSITION_ON_CONFIGURE_SUCCESS, CONFIGURING, (INACTIVE, UNCONFIGURED, ERROR_PROCESSING)
    ),
    StateMachineTransition("cleanup", Transition.TRANSITION_CLEANUP, INACTIVE, CLEANING_UP),
    *_outcomes(
        Transition.TRANSITION_ON_CLEANUP_SUCCESS, CLEANING_UP, (UNCONFIGURED, INACTIVE, ERROR_PROCESSING)
    ),
    StateMachineTransition("activate", Transition.TRANSITION_ACTIVATE, INACTIVE, ACTIVATING),
    *_outcomes(Transition.TRANSITION_ON_ACTIVATE_SUCCESS, ACTIVATING, (ACTIVE, INACTIVE, ERROR_PROCESSING)),
    StateMachineTransition("deactivate", Transition.TRANSITION_DEACTIVATE, ACTIVE, DEACTIVATING),
    *_outcomes(
        Transition.TRANSITION_ON_DEACTIVATE_SUCCESS, DEACTIVATING, (INACTIVE, ACTIVE, ERROR_PROCESSING)
    ),
    StateMachineTransition(
        "shutdown", Transition.TRANSITION_UNCONFIGURED_SHUTDOWN, UNCONFIGURED, SHUTTING_DOWN
    ),
    StateMachineTransition("shutdown", Transition.TRANSITION_INACTIVE_SHUTDOWN, INACTIVE, SHUTTING_DOWN),
    StateMachineTransition("shutdown", Transition.TRANSITION_ACTIVE_SHUTDOWN, ACTIVE, SHUTTING_DOWN),
    *_outcomes(
        Transition.TRANSITION_ON_SHUTDOWN_SUCCESS, SHUTTING_DOWN, (FINALIZED, FINALIZED, ERROR_PROCESSING)
    ),
    *_outcomes(
        Transition.TRANSITION_ON_ERROR_SUCCESS, ERROR_PROCESSING, (UNCONFIGURED, FINALIZED, FINALIZED)
    ),
)
"""All transitions, in the order in which ROS 2 lists them."""


class LifecycleStateMachine:
    """The state of one node. ``on_change(transition)`` is called after each change."""

    def __init__(self, on_change: Callable[[StateMachineTransition], None]) -> None:
        self._on_change = on_change
        self.state = UNCONFIGURED

    @property
    def available_transitions(self) -> tuple[StateMachineTransition, ...]:
        """Those that begin in the present state."""
        return tuple(each for each in TRANSITIONS if each.start == self.state)

    def find(self, wanted: int | str) -> StateMachineTransition:
        """The available transition with this number or label. Raises RCLError."""
        for transition in self.available_transitions:
            if wanted in (transition.transition_id, transition.label):
                return transition
        known = {each.transition_id: each.label for each in TRANSITIONS}
        name = known.get(wanted, f"transition {wanted}") if isinstance(wanted, int) else wanted
        ways = ", ".join(each.label for each in self.available_transitions) or "no way"
        raise RCLError(
            f"'{name}' is not possible: the node is {self.state.label}, from which there is {ways}"
        )

    def trigger(self, wanted: int | str) -> StateMachineTransition:
        """Takes an available transition. Raises RCLError."""
        transition = self.find(wanted)
        self.state = transition.goal
        self._on_change(transition)
        return transition
