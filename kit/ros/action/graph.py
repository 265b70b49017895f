"""Lists the actions of the graph, as the methods of the same names of a node do."""

from __future__ import annotations

from kit.ros.graph.action_names import NamesAndTypes
from kit.ros.node.node import Node


def get_action_names_and_types(node: Node) -> NamesAndTypes:
    return node.get_action_names_and_types()


def get_action_server_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    return node.get_action_server_names_and_types_by_node(remote_node_name, remote_node_namespace)


def get_action_client_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    return node.get_action_client_names_and_types_by_node(remote_node_name, remote_node_namespace)
