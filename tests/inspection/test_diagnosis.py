"""Checks find what is wrong with a graph, packages and a shell; reports show what there is."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.inspection.diagnosis import checks, reports
from kit.msg.std_msgs import String
from kit.msg.std_srvs import Trigger
from kit.ros.graph.directory import Excess
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from kit.ros.node.qos import QoSProfile, ReliabilityPolicy

BEST_EFFORT = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


@pytest.fixture
def graph() -> Graph:
    return Graph(log_sink=lambda record: None)


def found(graph: Graph | None, *folders: Path, **environment: str) -> dict[str, tuple[str, ...]]:
    """Errors and warnings by category."""
    return {
        each.category: each.errors + each.warnings for each in checks(graph, folders, environment, "jazzy")
    }


def test_a_graph_in_which_all_is_heard_passes(graph: Graph) -> None:
    node = create_graph_node(graph, "both")
    node.create_publisher(String, "said", 1)
    node.create_subscription(String, "said", print, 1)
    assert not any(found(graph).values())


def test_a_topic_without_its_other_end_is_named(graph: Graph) -> None:
    node = create_graph_node(graph, "one")
    node.create_publisher(String, "unheard", 1)
    node.create_subscription(String, "silent", print, 1)
    (unheard, silent) = sorted(found(graph)["topic"], key=lambda text: "silent" in text)
    assert "/unheard" in unheard
    assert "Publisher without" in unheard
    assert "/silent" in silent
    assert "Subscriber without" in silent


def test_ends_that_do_not_fit_are_named_with_the_policy(graph: Graph) -> None:
    create_graph_node(graph, "sensor").create_publisher(String, "said", BEST_EFFORT)
    create_graph_node(graph, "driver").create_subscription(String, "said", print, 1)
    (error,) = found(graph)["middleware"]
    assert all(word in error for word in ("/said", "sensor", "driver", "Best effort publisher"))
    (report,) = [each for each in reports(graph, "w", {}, {}, "jazzy") if each.title.startswith("QOS")]
    told = "ERROR: Best effort publisher and reliable subscription"
    assert dict(report.rows)["compatibility status"] == told


def test_what_a_robot_does_at_most_is_reported_and_who_asked_for_more_is_told(graph: Graph) -> None:
    graph.directory.note_command_limits("/cmd_vel", ("linear.x 0.22 m/s", "angular.z 2.84 rad/s"))
    graph.directory.note_excess("/gone", "/cmd_vel", "linear.x", Excess("5 m/s", "0.22 m/s"))
    (warning,) = found(graph)["topic"]
    assert all(word in warning for word in ("/gone", "/cmd_vel", "5 m/s", "0.22 m/s"))
    (report,) = [each for each in reports(graph, "w", {}, {}, "jazzy") if each.title == "COMMAND LIMITS"]
    assert [value for _, value in report.rows] == ["/cmd_vel", "linear.x 0.22 m/s", "angular.z 2.84 rad/s"]


def test_nodes_of_one_name_are_told(graph: Graph) -> None:
    for _ in range(2):
        create_graph_node(graph, "twin")
    assert "/twin" in found(graph)["node"][0]


def test_a_package_that_cannot_be_read_is_named_with_its_line(tmp_path: Path) -> None:
    (tmp_path / "broken").mkdir()
    (tmp_path / "broken" / "package.xml").write_text("<package>\n<name>broken</nam></package>")
    assert "broken/package.xml:2:" in found(None, tmp_path)["package"][0]


def test_another_distribution_in_the_shell_is_told() -> None:
    assert "humble" in found(None, ROS_DISTRO="humble")["platform"][0]
    assert not found(None, ROS_DISTRO="jazzy")["platform"]


def test_reports_count_both_ends_of_topics_and_services(graph: Graph) -> None:
    node = create_graph_node(graph, "one")
    node.create_subscription(String, "said", print, 1)
    node.create_service(Trigger, "act", lambda request, response: response)
    rows = {each.title: dict(each.rows) for each in reports(graph, "w", {}, {}, "jazzy")}
    assert rows["TOPIC LIST"] == {"topic": "/said", "publisher count": 0, "subscriber count": 1}
    services = next(
        each.rows for each in reports(graph, "w", {}, {}, "jazzy") if each.title == "SERVICE LIST"
    )
    first = services.index(("service", "/act"))
    assert services[first + 1 : first + 3] == [("service count", 1), ("client count", 0)]


def test_the_command_works_without_a_world(tmp_path: Path) -> None:
    words = ["ros", "doctor", "--workspace", str(tmp_path)]
    checked = CliRunner().invoke(main, words)
    assert checked.exit_code == 0, checked.output
    assert "checks passed" in checked.output
    report = CliRunner().invoke(main, [*words, "--report", "--exclude-packages"]).output
    assert "PLATFORM INFORMATION" in report
    assert "PACKAGE VERSIONS" not in report
