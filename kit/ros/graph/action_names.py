"""The actions of a graph, found by the names of their services and topics."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Final

from kit.msg.message import type_name

if TYPE_CHECKING:
    from kit.ros.graph.directory import Directory, NodeEntry

SEND_GOAL: Final = "_action/send_goal"
CANCEL_GOAL: Final = "_action/cancel_goal"
GET_RESULT: Final = "_action/get_result"
FEEDBACK: Final = "_action/feedback"
STATUS: Final = "_action/status"
_FEEDBACK_TYPE: Final = "_FeedbackMessage"
NamesAndTypes = list[tuple[str, list[str]]]


def action_names_and_types(directory: Directory) -> NamesAndTypes:
    """All actions that a node serves or calls, sorted by name."""
    return _actions_of((name, types) for name, types in directory.topic_names_and_types())


def all_served_actions(directory: Directory) -> dict[str, list[str]]:
    """The types of all actions that a node serves, by name."""
    found: dict[str, set[str]] = {}
    for handle in directory.nodes:
        for name, types in served_actions(handle):
            found.setdefault(name, set()).update(types)
    return {name: sorted(types) for name, types in sorted(found.items())}


def served_actions(handle: NodeEntry) -> NamesAndTypes:
    """The actions that a node serves, sorted by name."""
    return _actions_of((end.topic_name, [type_name(end.msg_type)]) for end in handle.publishers)


def called_actions(handle: NodeEntry) -> NamesAndTypes:
    """The actions that a node calls, sorted by name."""
    return _actions_of((end.topic_name, [type_name(end.msg_type)]) for end in handle.subscriptions)


def _actions_of(topics: Iterable[tuple[str, list[str]]]) -> NamesAndTypes:
    found: dict[str, set[str]] = {}
    for topic, types in topics:
        name, _, rest = topic.partition(f"/{FEEDBACK}")
        if name == topic or rest:
            continue
        actions = {each.removesuffix(_FEEDBACK_TYPE) for each in types if each.endswith(_FEEDBACK_TYPE)}
        if actions:
            found.setdefault(name, set()).update(actions)
    return [(name, sorted(types)) for name, types in sorted(found.items())]
