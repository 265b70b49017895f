"""Lifecycle nodes."""

from __future__ import annotations

from typing import Any

import pytest

from kit.msg.lifecycle_msgs import (
    ChangeState,
    GetAvailableStates,
    GetAvailableTransitions,
    GetState,
    TransitionEvent,
)
from kit.msg.std_msgs import String
from kit.ros.exceptions import RCLError
from kit.ros.execution.context import context_of
from kit.ros.graph.graph import Graph
from kit.ros.lifecycle import (
    LifecycleNode,
    LifecycleState,
    ManagedEntity,
    SimpleManagedEntity,
    TransitionCallbackReturn,
)
from kit.ros.log import LogRecord
from kit.ros.node.node import Node, create_graph_node

SUCCESS, FAILURE, ERROR = TransitionCallbackReturn


class Talker(LifecycleNode):
    """Records its callbacks; ``answers`` are what they return."""

    def __init__(self, graph: Graph, **options: Any) -> None:
        super().__init__("talker", context=context_of(graph), **options)
        self.answers: dict[str, Any] = {}
        self.called: list[tuple[str, str]] = []

    def _answer(self, name: str, state: LifecycleState, otherwise: Any) -> Any:
        self.called.append((name, state.label))
        answer = self.answers.get(name, otherwise)
        if isinstance(answer, Exception):
            raise answer
        return answer

    def on_configure(self, state: LifecycleState) -> Any:
        return self._answer("configure", state, super().on_configure(state))

    def on_activate(self, state: LifecycleState) -> Any:
        return self._answer("activate", state, super().on_activate(state))

    def on_error(self, state: LifecycleState) -> Any:
        return self._answer("error", state, super().on_error(state))


@pytest.fixture
def talker(graph: Graph) -> Talker:
    return Talker(graph)


@pytest.fixture
def manager(graph: Graph) -> Node:
    return create_graph_node(graph, "manager")


def ask(graph: Graph, manager: Node, srv_type: Any, name: str, request: Any = None) -> Any:
    client = manager.create_client(srv_type, f"/talker/{name}")
    future = client.call_async(request or srv_type.Request())
    graph.run_due()
    return future.result()


def state(graph: Graph, manager: Node) -> str:
    label = ask(graph, manager, GetState, "get_state").current_state.label
    assert isinstance(label, str)
    return label


def change(graph: Graph, manager: Node, transition: int | str) -> bool:
    request = ChangeState.Request()
    if isinstance(transition, str):
        request.transition.label = transition
    else:
        request.transition.id = transition
    answer = ask(graph, manager, ChangeState, "change_state", request)
    return bool(answer.success)


def test_the_way_through_all_states(graph: Graph, talker: Talker, manager: Node) -> None:
    events: list[tuple[str, str]] = []
    manager.create_subscription(
        TransitionEvent,
        "/talker/transition_event",
        lambda event: events.append((event.start_state.label, event.goal_state.label)),
        10,
    )
    seen = [state(graph, manager)]
    for transition in ("configure", "activate", "deactivate", "cleanup", 1, 3, 7):
        assert change(graph, manager, transition)
        seen.append(state(graph, manager))
    assert seen == [
        "unconfigured",
        "inactive",
        "active",
        "inactive",
        "unconfigured",
        "inactive",
        "active",
        "finalized",
    ]
    assert events[:2] == [("unconfigured", "configuring"), ("configuring", "inactive")]
    assert len(events) == 14
    assert talker.called[:2] == [("configure", "unconfigured"), ("activate", "inactive")]


def test_what_is_possible_from_each_state(graph: Graph, talker: Talker, manager: Node) -> None:
    def possible() -> list[tuple[int, str]]:
        answer = ask(graph, manager, GetAvailableTransitions, "get_available_transitions")
        return [(each.transition.id, each.transition.label) for each in answer.available_transitions]

    assert possible() == [(1, "configure"), (5, "shutdown")]
    talker.trigger_configure()
    assert possible() == [(2, "cleanup"), (3, "activate"), (6, "shutdown")]
    talker.trigger_activate()
    assert possible() == [(4, "deactivate"), (7, "shutdown")]
    talker.trigger_shutdown()
    assert possible() == []
    every = ask(graph, manager, GetAvailableTransitions, "get_transition_graph").available_transitions
    assert len(every) == 25
    assert {(each.transition.id, each.goal_state.label) for each in every} >= {
        (10, "inactive"),
        (11, "unconfigured"),
        (12, "errorprocessing"),
        (60, "unconfigured"),
        (62, "finalized"),
    }
    states = ask(graph, manager, GetAvailableStates, "get_available_states").available_states
    assert [each.id for each in states] == [0, 1, 2, 3, 4, 10, 11, 12, 13, 14, 15]


@pytest.mark.parametrize(
    ("answers", "after", "result"),
    [
        ({"configure": FAILURE}, "unconfigured", FAILURE),
        ({"configure": ERROR}, "unconfigured", ERROR),
        ({"configure": ERROR, "error": FAILURE}, "finalized", ERROR),
        ({"configure": ValueError("no camera")}, "unconfigured", ERROR),
        ({"configure": None}, "unconfigured", ERROR),
        ({"configure": True, "error": ValueError("again")}, "finalized", ERROR),
    ],
)
def test_callbacks_that_do_not_succeed(
    graph: Graph,
    talker: Talker,
    manager: Node,
    answers: dict[str, Any],
    after: str,
    result: TransitionCallbackReturn,
) -> None:
    talker.answers = answers
    assert talker.trigger_configure() is result
    assert state(graph, manager) == after
    assert (("error", "unconfigured") in talker.called) == (result is ERROR)


def test_a_callback_without_an_answer_is_told_so(
    graph: Graph, talker: Talker, lines: list[LogRecord]
) -> None:
    talker.answers["configure"] = None
    talker.trigger_configure()
    assert "on_configure() must return a TransitionCallbackReturn" in lines[-1].text


def test_transitions_that_are_not_possible(graph: Graph, talker: Talker, manager: Node) -> None:
    for transition in ("activate", 3, "fly", 200):
        assert not change(graph, manager, transition)
    with pytest.raises(RCLError, match="the node is unconfigured, from which there is configure, shutdown"):
        talker.trigger_activate()
    assert state(graph, manager) == "unconfigured"
    assert talker.called == []


def test_a_publisher_is_silent_while_its_node_is_not_active(
    graph: Graph, talker: Talker, manager: Node, lines: list[LogRecord]
) -> None:
    heard: list[str] = []
    manager.create_subscription(String, "chatter", lambda message: heard.append(message.data), 10)
    publisher = talker.create_lifecycle_publisher(String, "chatter", 10)
    for steps in ("", "configure", "activate", "deactivate"):
        if steps:
            getattr(talker, f"trigger_{steps}")()
        publisher.publish(String(data=steps))
        publisher.publish(String(data=steps))
        assert publisher.is_activated == (steps == "activate")
    graph.run_due()
    assert heard == ["activate", "activate"]
    assert len([line for line in lines if "not activated" in line.text]) == 2
    assert talker.destroy_lifecycle_publisher(publisher)
    assert not talker.destroy_lifecycle_publisher(publisher)
    with pytest.raises(TypeError):
        talker.create_lifecycle_publisher(String, "chatter", 10, publisher_class=object)


def test_managed_entities_follow_in_their_order(talker: Talker) -> None:
    asked: list[str] = []

    class Part(ManagedEntity):
        def __init__(self, name: str, answer: TransitionCallbackReturn) -> None:
            self.name, self.answer = name, answer

        def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
            asked.append(self.name)
            return self.answer

    for name, answer in (("a", SUCCESS), ("b", FAILURE), ("c", SUCCESS)):
        talker.add_managed_entity(Part(name, answer))
    assert talker.trigger_configure() is FAILURE
    assert asked == ["a", "b"]


def test_a_method_that_waits_for_activation() -> None:
    done: list[str] = []

    class Part(SimpleManagedEntity):
        @SimpleManagedEntity.when_enabled
        def work(self, what: str) -> None:
            done.append(what)

        @SimpleManagedEntity.when_enabled(when_not_enabled=lambda: done.append("not yet"))
        def play(self) -> None:
            done.append("play")

    part = Part()
    part.work("a")
    part.play()
    part.on_activate(LifecycleState("inactive", 2))
    part.work("b")
    part.play()
    assert done == ["not yet", "b", "play"]


def test_a_node_without_communication_interface(graph: Graph) -> None:
    talker = Talker(graph, enable_communication_interface=False)
    assert talker.trigger_configure() is SUCCESS
    assert not any("change_state" in name for name, _ in talker.get_service_names_and_types())
