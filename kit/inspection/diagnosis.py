"""What ``ros2 doctor`` tells about a ROS 2 system, as far as it has a meaning here: checks, and a report for each subject."""

from __future__ import annotations

import platform
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import kit
from kit.inspection.graph_text import node_names, services, topics
from kit.ros.graph.connections import find_excesses
from kit.ros.graph.graph import Graph
from kit.ros.node.qos import QoSCompatibility, qos_check_compatible
from kit.ros.packages import PackageError, broken_packages, read_package

UNCHECKED_TOPICS: Final = ("/parameter_events", "/rosout")
"""Topics that every node has, whether anybody listens or not."""
NO_WORLD: Final = "no world is running"

Rows = Sequence[tuple[str, object]]


@dataclass(frozen=True, slots=True)
class Report:
    """What there is of one subject. ``category``: that of the checks which this explains."""

    title: str
    category: str
    rows: Rows


@dataclass(frozen=True, slots=True)
class DiagnosisCheck:
    """What is wrong with one subject: errors, and warnings, which may be meant."""

    category: str
    errors: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    def passes(self, *, warnings_fail: bool) -> bool:
        return not self.errors and not (warnings_fail and self.warnings)


def checks(
    graph: Graph | None, folders: Sequence[Path], environment: Mapping[str, str], distro: str
) -> Iterator[DiagnosisCheck]:
    """Checks the shell, the packages of some folders and, if a world runs, its graph. ``distro``: the one that the kit offers."""
    sourced = environment.get("ROS_DISTRO")
    other = f"ROS_DISTRO is {sourced} in this shell; the programs that the kit runs get {distro}."
    yield DiagnosisCheck("platform", warnings=(other,) if sourced not in (None, distro) else ())
    if folders:
        yield DiagnosisCheck("package", errors=tuple(broken_packages(folders)))
    if graph is not None:
        yield _node_check(graph)
        yield _topic_check(graph)
        yield _qos_check(graph)


def _node_check(graph: Graph) -> DiagnosisCheck:
    twice = [name for name, count in Counter(node_names(graph, hidden=False)).items() if count > 1]
    return DiagnosisCheck(
        "node", warnings=tuple(f"There is more than one node of the name {name}." for name in twice)
    )


def _topic_check(graph: Graph) -> DiagnosisCheck:
    found = []
    for name in _checked_topics(graph):
        publishers, subscriptions = _count_endpoints(graph, name)
        if publishers and not subscriptions:
            found.append(f"Publisher without subscriber detected on {name}.")
        elif subscriptions and not publishers:
            found.append(f"Subscriber without publisher detected on {name}.")
    asking = {node for node, _, _ in graph.directory.excesses}  # some may have left
    return DiagnosisCheck("topic", warnings=(*found, *find_excesses(graph, asking)))


def _qos_check(graph: Graph) -> DiagnosisCheck:
    return DiagnosisCheck(
        "middleware",
        errors=tuple(
            f"QoS compatibility error found on topic '{name}', from {publisher} to {subscriber}: "
            f"{status.removeprefix('ERROR: ')}"
            for name, _, publisher, subscriber, status in _endpoint_pairs(graph)
            if status != "OK"
        ),
    )


def _checked_topics(graph: Graph) -> Iterator[str]:
    return (name for name, _ in topics(graph, hidden=False) if name not in UNCHECKED_TOPICS)


def _count_endpoints(graph: Graph, topic: str) -> tuple[int, int]:
    """The numbers of publishers and subscriptions of a topic."""
    return sum(1 for _ in graph.directory.publishers(topic)), sum(
        1 for _ in graph.directory.subscriptions(topic)
    )


def _endpoint_pairs(graph: Graph) -> Iterator[tuple[str, str, str, str, str]]:
    """Topic, type, names of the two nodes, and ``OK`` or the reason, of each publisher with each subscription."""
    for name, types in topics(graph, hidden=False):
        for publisher in graph.directory.publishers(name):
            for subscription in graph.directory.subscriptions(name):
                outcome, reason = qos_check_compatible(publisher.qos_profile, subscription.qos_profile)
                status = reason.rstrip(";") if outcome is QoSCompatibility.ERROR else "OK"
                yield name, ", ".join(types), publisher.handle.name, subscription.handle.name, status


def reports(
    graph: Graph | None,
    world: str,
    packages: Mapping[str, Path],
    environment: Mapping[str, str],
    distro: str,
) -> Iterator[Report]:
    """Yields the reports in the order of ROS 2's. ``world``: the name of the one whose graph this is."""
    yield Report("PACKAGE VERSIONS", "package", tuple(_versions(packages)) or (("package", "none"),))
    yield Report(
        "PLATFORM INFORMATION",
        "platform",
        (
            ("system", platform.system()),
            ("platform info", platform.platform()),
            ("release", platform.release()),
            ("processor", platform.machine()),
            ("python", platform.python_version()),
        ),
    )
    pairs = [] if graph is None else list(_endpoint_pairs(graph))
    names = ("topic [type]", "publisher node", "subscriber node", "compatibility status")
    rows = [
        row for topic, kind, *rest in pairs for row in zip(names, (f"{topic} [{kind}]", *rest), strict=True)
    ]
    yield Report(
        "QOS COMPATIBILITY LIST",
        "middleware",
        rows or (("compatibility status", "No publisher/subscriber pairs found"),),
    )
    yield Report(
        "RMW MIDDLEWARE",
        "middleware",
        (("middleware name", f"robot-learning-kit {kit.__version__}, in place of a network"),),
    )
    yield Report(
        "ROS 2 INFORMATION",
        "platform",
        (("distribution name", distro), ("distribution type", "the kit's own, of ROS 2's interfaces")),
    )
    variables = ", ".join(f"{key}={value}" for key, value in sorted(environment.items()) if "ROS" in key)
    yield Report("ROS ENVIRONMENT", "platform", (("ros environment variables", variables or "none"),))
    yield from _graph_reports(graph, world)


def _versions(packages: Mapping[str, Path]) -> Iterator[tuple[str, object]]:
    for name, folder in sorted(packages.items()):
        try:
            yield name, read_package(folder).version
        except PackageError as problem:
            yield name, str(problem)


def _graph_reports(graph: Graph | None, world: str) -> Iterator[Report]:
    if graph is None:
        yield Report("WORLD", "topic", (("world", NO_WORLD),))
        return
    names = node_names(graph, hidden=False)
    yield Report("WORLD", "topic", (("world", world), ("time [s]", f"{graph.now_ns / 1e9:.3f}")))
    yield Report("NODE LIST", "node", [("node", name) for name in names] or (("node", "none"),))
    rows: list[tuple[str, object]] = []
    for name in _checked_topics(graph):
        publishers, subscriptions = _count_endpoints(graph, name)
        rows += [("topic", name), ("publisher count", publishers), ("subscriber count", subscriptions)]
    yield Report("TOPIC LIST", "topic", rows or (("topic", "none"),))
    rows = []
    for topic, most in sorted(graph.directory.command_limits.items()):
        rows += [("topic", topic), *(("at most", each) for each in most)]
    yield Report("COMMAND LIMITS", "topic", rows or (("topic", "none with a limit"),))
    rows = []
    for name, _ in services(graph, hidden=False):
        servers, clients = (
            len(ends.get(name, ())) for ends in (graph.directory.services, graph.directory.clients)
        )
        rows += [("service", name), ("service count", servers), ("client count", clients)]
    yield Report("SERVICE LIST", "topic", rows or (("service", "none"),))
