"""Service introspection: requests and responses as events on a topic."""

from __future__ import annotations

from typing import Any

import pytest

from kit.msg.interfaces import UnknownInterface, find_interface_or_event, service_event_class
from kit.msg.std_srvs import SetBool
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from kit.ros.node.qos import qos_profile_system_default
from kit.ros.node.service_introspection import (
    ServiceIntrospectionState,
)


def test_both_ends_publish_what_happens(graph: Graph) -> None:
    serving, asking, watching = (create_graph_node(graph, name) for name in ("serving", "asking", "watching"))

    def answer(request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        response.message = f"got {request.data}"
        return response

    service = serving.create_service(SetBool, "switch", answer)
    client = asking.create_client(SetBool, "switch")
    events: list[Any] = []
    watching.create_subscription(service_event_class(SetBool), "/switch/_service_event", events.append, 10)

    def call(of_service: ServiceIntrospectionState, of_client: ServiceIntrospectionState) -> list[Any]:
        service.configure_introspection(serving.get_clock(), qos_profile_system_default, of_service)
        client.configure_introspection(asking.get_clock(), qos_profile_system_default, of_client)
        events.clear()
        client.call_async(SetBool.Request(data=True))
        graph.run_due()
        return [(event.info.event_type, len(event.request), len(event.response)) for event in events]

    off, metadata, contents = ServiceIntrospectionState
    assert call(off, off) == []
    assert call(metadata, off) == [(1, 0, 0), (2, 0, 0)]
    assert call(metadata, contents) == [(0, 1, 0), (1, 0, 0), (2, 0, 0), (3, 0, 1)]
    assert {event.info.sequence_number for event in events} == {3}
    assert {bytes(event.info.client_gid) for event in events} == {client.number.to_bytes(16, "big")}
    assert (events[0].request[0].data, events[3].response[0].message) == (True, "got True")
    assert call(off, off) == []
    assert graph.directory.topics["/switch/_service_event"].publishers == []


def test_another_process_finds_the_type_by_its_name() -> None:
    assert find_interface_or_event("std_srvs/srv/SetBool_Event") is service_event_class(SetBool)
    assert find_interface_or_event("std_srvs/srv/SetBool") is SetBool
    with pytest.raises(UnknownInterface):
        find_interface_or_event("std_srvs/srv/Nothing_Event")
