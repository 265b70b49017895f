"""Lifecycle nodes: their states, the callbacks of each transition, and the services by which others ask for one.

What such a node manages follows its transitions, as publishers do that are silent until it is active.
"""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterable
from enum import IntEnum
from functools import wraps
from typing import Any, Final, NamedTuple, TypeVar

from kit.msg.lifecycle_msgs import (
    ChangeState,
    GetAvailableStates,
    GetAvailableTransitions,
    GetState,
    State,
    Transition,
    TransitionDescription,
    TransitionEvent,
)
from kit.msg.message import Message
from kit.ros.exceptions import RCLError
from kit.ros.execution.callback_groups import CallbackGroup
from kit.ros.node.node import Node
from kit.ros.node.publisher import Publisher


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
        """The transitions that begin in the present state."""
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


M = TypeVar("M", bound=Message)


class ManagedEntity:
    """Something with a callback for each transition of its node; by default each says SUCCESS."""

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS


class SimpleManagedEntity(ManagedEntity):
    """An entity that is enabled while its node is active."""

    def __init__(self) -> None:
        self._enabled = False

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        self._enabled = True
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        self._enabled = False
        return TransitionCallbackReturn.SUCCESS

    @property
    def is_activated(self) -> bool:
        return self._enabled

    @staticmethod
    def when_enabled(
        wrapped: Callable[..., None] | None = None, *, when_not_enabled: Callable[[], Any] | None = None
    ) -> Any:
        """Decorator of a method that does nothing, or calls ``when_not_enabled()``, while it is not enabled."""

        def decorate(method: Callable[..., None]) -> Callable[..., None]:
            @wraps(method)
            def call_when_enabled(self: SimpleManagedEntity, *arguments: Any, **options: Any) -> None:
                if self._enabled:
                    method(self, *arguments, **options)
                elif when_not_enabled is not None:
                    when_not_enabled()

            return call_when_enabled

        return decorate if wrapped is None else decorate(wrapped)


class LifecyclePublisher(SimpleManagedEntity, Publisher[M]):
    """A publisher whose messages are dropped while its node is not active."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        SimpleManagedEntity.__init__(self)
        Publisher.__init__(self, *arguments, **options)
        self._has_warned = False

    def publish(self, msg: M | bytes) -> None:
        """Publishes a message, if the node is active; otherwise says once, after each change, that it is not."""
        if self._enabled:
            self._has_warned = False
            super().publish(msg)
        elif not self._has_warned:
            self._has_warned = True
            warning = f"Trying to publish message on the topic '{self.topic_name}', but the publisher is not activated"
            self.handle.logger.warning(warning)


_CALLBACK_NAMES = {
    CONFIGURING: "on_configure",
    CLEANING_UP: "on_cleanup",
    SHUTTING_DOWN: "on_shutdown",
    ACTIVATING: "on_activate",
    DEACTIVATING: "on_deactivate",
    ERROR_PROCESSING: "on_error",
}


class LifecycleNodeMixin(ManagedEntity):
    """Makes a Node a lifecycle node. ``LifecycleNode`` is both.

    Each ``on_...`` callback gets the state before, and returns a TransitionCallbackReturn; by default it asks the
    managed entities, and ends at the first that does not return SUCCESS.
    """

    def __init__(
        self, *, enable_communication_interface: bool = True, callback_group: CallbackGroup | None = None
    ) -> None:
        """``enable_communication_interface``: with the services and the topic by which others manage it."""
        self.__entities: list[ManagedEntity] = []
        self.__event_publisher: Publisher[TransitionEvent] | None = None
        self.__machine = LifecycleStateMachine(self.__publish_event)
        if not enable_communication_interface:
            return
        node = self.__node
        self.__event_publisher = node.create_publisher(TransitionEvent, "~/transition_event", 10)
        for srv_type, name, callback in (
            (ChangeState, "change_state", self.__on_change_state),
            (GetState, "get_state", self.__on_get_state),
            (GetAvailableStates, "get_available_states", self.__on_get_available_states),
            (GetAvailableTransitions, "get_available_transitions", self.__on_get_available_transitions),
            (GetAvailableTransitions, "get_transition_graph", self.__on_get_transition_graph),
        ):
            node.create_service(srv_type, f"~/{name}", callback, callback_group=callback_group)

    @property
    def __node(self) -> Node:
        assert isinstance(self, Node)
        return self

    # Transitions

    def trigger_configure(self) -> TransitionCallbackReturn:
        """Configures the node. Raises RCLError if its state does not allow that; likewise the others."""
        return self.__change_state(Transition.TRANSITION_CONFIGURE)

    def trigger_cleanup(self) -> TransitionCallbackReturn:
        return self.__change_state(Transition.TRANSITION_CLEANUP)

    def trigger_shutdown(self) -> TransitionCallbackReturn:
        return self.__change_state("shutdown")

    def trigger_activate(self) -> TransitionCallbackReturn:
        return self.__change_state(Transition.TRANSITION_ACTIVATE)

    def trigger_deactivate(self) -> TransitionCallbackReturn:
        return self.__change_state(Transition.TRANSITION_DEACTIVATE)

    # Callbacks

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        return self.__ask_entities("on_configure", state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        return self.__ask_entities("on_cleanup", state)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        return self.__ask_entities("on_shutdown", state)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        return self.__ask_entities("on_activate", state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        return self.__ask_entities("on_deactivate", state)

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        return self.__ask_entities("on_error", state)

    # Managed entities

    def add_managed_entity(self, entity: ManagedEntity) -> None:
        """Makes an entity follow the node's transitions."""
        if entity not in self.__entities:
            self.__entities.append(entity)

    def create_lifecycle_publisher(self, *args: Any, **kwargs: Any) -> LifecyclePublisher[Any]:
        """Creates a publisher as ``Node.create_publisher`` does; it is silent while the node is not active."""
        if "publisher_class" in kwargs:
            raise TypeError("create_publisher() got an unexpected keyword argument 'publisher_class'")
        publisher = self.__node.create_publisher(*args, **kwargs, publisher_class=LifecyclePublisher)
        assert isinstance(publisher, LifecyclePublisher)
        self.add_managed_entity(publisher)
        return publisher

    def destroy_lifecycle_publisher(self, publisher: LifecyclePublisher[Any]) -> bool:
        """Destroys such a publisher; False if it is not this node's."""
        if publisher in self.__entities:
            self.__entities.remove(publisher)
        return self.__node.destroy_publisher(publisher)

    def __ask_entities(self, callback: str, state: LifecycleState) -> TransitionCallbackReturn:
        for entity in list(self.__entities):
            answer: TransitionCallbackReturn = getattr(entity, callback)(state)
            if answer != TransitionCallbackReturn.SUCCESS:
                return answer
        return TransitionCallbackReturn.SUCCESS

    def __change_state(self, wanted: int | str) -> TransitionCallbackReturn:
        before = self.__machine.state
        self.__machine.trigger(wanted)
        answer = self.__execute_callback(before)
        self.__machine.trigger(answer.to_label())
        if answer is TransitionCallbackReturn.ERROR:
            self.__machine.trigger(self.__execute_callback(before).to_label())
        return answer

    def __execute_callback(self, before: LifecycleState) -> TransitionCallbackReturn:
        """Calls the callback of the present state and returns its result; ERROR if it fails."""
        name = _CALLBACK_NAMES[self.__machine.state]
        try:
            answer = getattr(self, name)(before)
        except Exception as problem:  # noqa: BLE001 - whatever it raises leads to on_error(), as in rclpy
            error = f"{name}() failed: {type(problem).__name__}: {problem}"
            self.__node.get_logger().error(error)
            traceback.print_exc()
            return TransitionCallbackReturn.ERROR
        if not isinstance(answer, TransitionCallbackReturn):
            error = f"{name}() must return a TransitionCallbackReturn, such as SUCCESS, not {answer!r}"
            self.__node.get_logger().error(error)
            return TransitionCallbackReturn.ERROR
        return answer

    # Services

    def __publish_event(self, transition: StateMachineTransition) -> None:
        if self.__event_publisher is not None:
            self.__event_publisher.publish(
                TransitionEvent(start_state=_state(transition.start), goal_state=_state(transition.goal))
            )

    def __on_change_state(self, request: Any, response: Any) -> Any:
        try:
            wanted = self.__machine.find(request.transition.label or request.transition.id)
        except RCLError as problem:
            self.__node.get_logger().warning(str(problem))
            response.success = False
            return response
        response.success = self.__change_state(wanted.transition_id) is TransitionCallbackReturn.SUCCESS
        return response

    def __on_get_state(self, request: Any, response: Any) -> Any:
        response.current_state = _state(self.__machine.state)
        return response

    def __on_get_available_states(self, request: Any, response: Any) -> Any:
        response.available_states = [_state(each) for each in STATES]
        return response

    def __on_get_available_transitions(self, request: Any, response: Any) -> Any:
        response.available_transitions = _descriptions(self.__machine.available_transitions)
        return response

    def __on_get_transition_graph(self, request: Any, response: Any) -> Any:
        response.available_transitions = _descriptions(TRANSITIONS)
        return response


class LifecycleNode(LifecycleNodeMixin, Node):
    """A node that is configured, activated and shut down from outside, or by its own ``trigger_...`` methods.

    It begins unconfigured. Arguments as Node's.
    """

    def __init__(self, node_name: str, *, enable_communication_interface: bool = True, **kwargs: Any) -> None:
        Node.__init__(self, node_name, **kwargs)
        LifecycleNodeMixin.__init__(self, enable_communication_interface=enable_communication_interface)


def _state(state: LifecycleState) -> State:
    return State(id=state.state_id, label=state.label)


def _descriptions(transitions: Iterable[StateMachineTransition]) -> list[TransitionDescription]:
    return [
        TransitionDescription(
            transition=Transition(id=each.transition_id, label=each.label),
            start_state=_state(each.start),
            goal_state=_state(each.goal),
        )
        for each in transitions
    ]
