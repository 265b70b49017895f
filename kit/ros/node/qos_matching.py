"""Which quality of service hears everybody on a topic."""

from __future__ import annotations

from kit.ros.graph.graph import Graph
from kit.ros.node.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy


def fitting_qos(graph: Graph, topic: str) -> QoSProfile:
    """What to ask for so that every publisher of a topic is heard, and its old messages if all keep them."""
    profiles = [publisher.qos_profile for publisher in graph.directory.publishers(topic)]
    reliable = all(not profile.is_best_effort for profile in profiles)
    lasting = bool(profiles) and all(profile.is_transient_local for profile in profiles)
    return QoSProfile(
        history=HistoryPolicy.KEEP_ALL,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if lasting else DurabilityPolicy.VOLATILE,
    )
