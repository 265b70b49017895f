"""Which messages pass between two profiles, found out in a graph."""

from __future__ import annotations

from pathlib import Path

from kit.msg.std_msgs import Float32
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from kit.ros.node.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from kit.school.quiz.items import QuizItem
from tests.school.quiz.derived.finding import Derivation, Finding

KEPT = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
LOSSY = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)


def heard_by_latecomer(
    offered: QoSProfile | int,
    asked: QoSProfile | int,
    before: list[float],
    after: list[float],
    *,
    waits: bool = False,
) -> tuple[float, ...]:
    """What a subscription hears that comes between the two. ``waits``: its callback runs when all have been sent."""
    graph, heard = Graph(log_sink=[].append), []
    publisher = create_graph_node(graph, "talker").create_publisher(Float32, "x", offered)
    for value in before:
        publisher.publish(Float32(data=value))
        graph.run_due()
    create_graph_node(graph, "late").create_subscription(
        Float32, "x", lambda message: heard.append(round(message.data, 2)), asked
    )
    if not waits:
        graph.run_due()
    for value in after:
        publisher.publish(Float32(data=value))
        if not waits:
            graph.run_due()
    graph.run_due()
    return tuple(heard)


def more_than_asked(item: QuizItem, folder: Path) -> Finding:
    heard = heard_by_latecomer(10, LOSSY, [], [1.0, 2.0, 3.0, 4.0])
    return Finding(
        len(heard),
        {
            "Nothing, since the two differ": 0,
            "Everything, since more is offered than asked": 4,
            "Every other message, half of the promise": 2,
        },
    )


def kept_for_whom(item: QuizItem, folder: Path) -> Finding:
    return Finding(
        (heard_by_latecomer(KEPT, 10, [1.0], []), heard_by_latecomer(KEPT, 10, [1.0], [1.0])),
        {
            "Nothing, until it is published again": ((), (1.0,)),
            "The map, since the publisher kept it": ((1.0,), (1.0, 1.0)),
            "The map, ten times, as the depth says": ((1.0,) * 10, (1.0,) * 11),
        },
    )


def how_many_are_kept(item: QuizItem, folder: Path) -> Finding:
    asked = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    means = {option.text: tuple(map(float, option.text.split(", "))) for option in item.options}
    return Finding(heard_by_latecomer(KEPT, asked, [0.4, 0.3, 0.2], []), means)


def depths_differ(item: QuizItem, folder: Path) -> Finding:
    sent = [float(number) for number in range(50)]
    heard = heard_by_latecomer(1, 100, [], sent, waits=True)
    return Finding(
        len(heard),
        {
            "Yes, since each side counts for itself": 50,
            "No, since more is asked than offered": 0,
            "Yes, but the hundred becomes one": 1,
        },
    )


def only_the_newest_scan(item: QuizItem, folder: Path) -> Finding:
    sent = [float(number) for number in range(10)]
    return Finding(
        heard_by_latecomer(10, 1, [], sent, waits=True),
        {
            "All ten, one after the other": tuple(sent),
            "The first, which came when it was free": (0.0,),
            "The newest, and no other": (9.0,),
        },
    )


def whose_side_to_change(item: QuizItem, folder: Path) -> Finding:
    tried = {
        "A depth of 1000 in your node": QoSProfile(depth=1000),
        "BEST_EFFORT in your node": LOSSY,
        "TRANSIENT_LOCAL in your node": KEPT,
    }
    (works,) = [text for text, asked in tried.items() if heard_by_latecomer(LOSSY, asked, [], [1.0])]
    return Finding(works, {text: text for text in tried})


SERVICE_QUALITY: dict[str, Derivation] = {
    "more-than-asked": more_than_asked,
    "kept-for-whom": kept_for_whom,
    "how-many-are-kept": how_many_are_kept,
    "depths-differ": depths_differ,
    "only-the-newest-scan": only_the_newest_scan,
    "whose-side-to-change": whose_side_to_change,
}
