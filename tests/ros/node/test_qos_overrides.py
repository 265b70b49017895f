"""QoS overrides: a node's parameters change the QoS of its publishers and subscriptions."""

from __future__ import annotations

from typing import Any

import pytest

from kit.msg.std_msgs import Int32
from kit.ros.exceptions import ParameterImmutableException
from kit.ros.execution.context import context_of
from kit.ros.graph.graph import Graph
from kit.ros.node.node import Node
from kit.ros.node.qos import QoSPolicyKind, QoSProfile, ReliabilityPolicy
from kit.ros.node.qos_overrides import InvalidQosOverridesError, QosCallbackResult, QoSOverridingOptions
from kit.ros.node.time import Duration
from kit.ros.parameters.parameter import Parameter


def make_node(graph: Graph, **overrides: Any) -> Node:
    """A node that was given values for parameters of its topic ``/x``."""
    parameters = [
        Parameter("qos_overrides./x." + name.replace("__", "."), value=value)
        for name, value in overrides.items()
    ]
    return Node("node", context=context_of(graph), parameter_overrides=parameters)


def test_parameters_override_the_default_policies(graph: Graph) -> None:
    node = make_node(graph, publisher__depth=3, publisher__reliability="best_effort")
    profile = QoSProfile(depth=10)
    options = QoSOverridingOptions.with_default_policies()
    publisher = node.create_publisher(Int32, "x", profile, qos_overriding_options=options)
    assert (publisher.qos_profile.depth, publisher.qos_profile.reliability.name) == (3, "BEST_EFFORT")
    assert (profile.depth, profile.reliability) == (10, ReliabilityPolicy.RELIABLE)
    assert {
        name: parameter.value
        for name, parameter in node.get_parameters_by_prefix("qos_overrides./x.publisher").items()
    } == {"depth": 3, "history": "keep_last", "reliability": "best_effort"}
    with pytest.raises(ParameterImmutableException):
        node.undeclare_parameter("qos_overrides./x.publisher.depth")


def test_durations_are_nanoseconds_and_a_lifespan_is_a_publishers(graph: Graph) -> None:
    node = make_node(graph, subscription_second__deadline=5_000)
    options = QoSOverridingOptions([QoSPolicyKind.DEADLINE, QoSPolicyKind.LIFESPAN], entity_id="second")
    subscription = node.create_subscription(Int32, "x", lambda _: None, 1, qos_overriding_options=options)
    assert subscription.qos_profile.deadline == Duration(nanoseconds=5_000)
    assert not node.has_parameter("qos_overrides./x.subscription_second.lifespan")


def test_two_endpoints_share_the_parameters(graph: Graph) -> None:
    node = make_node(graph, publisher__depth=3)
    options = QoSOverridingOptions.with_default_policies()
    made = [node.create_publisher(Int32, "x", 1, qos_overriding_options=options) for _ in range(2)]
    assert [publisher.qos_profile.depth for publisher in made] == [3, 3]


def test_a_callback_may_refuse_the_profile(graph: Graph) -> None:
    def check(profile: QoSProfile) -> QosCallbackResult:
        return QosCallbackResult(successful=profile.depth < 5, reason="too deep")

    options = QoSOverridingOptions.with_default_policies(callback=check)
    make_node(graph).create_publisher(Int32, "x", 4, qos_overriding_options=options)
    node = make_node(graph, publisher__depth=9)
    with pytest.raises(InvalidQosOverridesError, match="too deep"):
        node.create_publisher(Int32, "x", 4, qos_overriding_options=options)


def test_a_policy_without_this_setting_is_named(graph: Graph) -> None:
    node = make_node(graph, publisher__reliability="sometimes")
    options = QoSOverridingOptions.with_default_policies()
    with pytest.raises(RuntimeError, match=r"reliability.*sometimes.*best_effort"):
        node.create_publisher(Int32, "x", 4, qos_overriding_options=options)
