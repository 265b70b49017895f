"""A world that runs in a thread, with a server, and the kit's command line to look into it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Protocol

import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.inspection.server import InspectionServer
from kit.inspection.sockets import sockets_folder
from kit.msg.geometry_msgs import PointStamped
from kit.msg.rcl_interfaces import IntegerRange, ParameterDescriptor
from kit.msg.std_msgs import String
from kit.msg.std_srvs import SetBool
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from kit.ros.node.time import Time
from kit.run.scenario import scenario_on_map
from kit.run.session import Session
from kit.run.world_thread import WorldThread
from kit.world.catalogue import find_map

SPEED = 20.0


class Talker:
    """A node with a bit of everything: says something ten times a second, answers, has parameters."""

    def __init__(self, graph: Graph) -> None:
        self.node = node = create_graph_node(graph, "talker", "/demo")
        self.heard: list[str] = []
        node.declare_parameter("words", "hello")
        node.declare_parameter("volume.high", 0.5)
        levels = IntegerRange(from_value=0, to_value=10, step=2)
        about = ParameterDescriptor(description="how often", integer_range=[levels])
        node.declare_parameter("level", 4, about)
        self._chatter = node.create_publisher(String, "chatter", 10)
        self._points = node.create_publisher(PointStamped, "points", 10)
        node.create_subscription(String, "orders", lambda message: self.heard.append(message.data), 10)
        node.create_service(SetBool, "switch", self._switch)
        node.create_timer(0.1, self._say)

    def _say(self) -> None:
        self._chatter.publish(String(data="hello"))
        stamp = Time(nanoseconds=self.node.get_clock().now().nanoseconds - 20_000_000).to_msg()
        point = PointStamped()
        point.header.stamp, point.header.frame_id, point.point.x = stamp, "map", 1.5
        self._points.publish(point)

    def _switch(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        response.success, response.message = request.data, "on" if request.data else "off"
        return response


class Stage:
    """The running world, and what there is in it."""

    def __init__(self, workspace: Path) -> None:
        self.workspace = workspace
        self.session = Session(scenario_on_map(find_map("simple")), seed=1)
        self.graph = self.session.graph
        self.talker = Talker(self.graph)
        self.live = WorldThread(self.session.runner, factor=SPEED, on_change=lambda runner: None)
        self.server = InspectionServer(self.graph, sockets_folder(workspace), "simple", wake=self._wake)
        self.session.runner.participants.append(self.server)

    def _wake(self) -> None:
        if self.session.runner.paused:
            self.live.post(lambda runner: None)

    def __enter__(self) -> Stage:
        self.live.__enter__()
        return self

    def __exit__(self, *_: object) -> None:
        self.live.stop()
        self.server.close()
        self.session.close()


@pytest.fixture(scope="module")
def stage(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Stage]:
    with Stage(tmp_path_factory.mktemp("workspace")) as made:
        yield made


class Kit(Protocol):
    """Runs ``kit ros ...``: what it prints, what it complains, its exit code."""

    def __call__(self, *words: str) -> tuple[str, str, int]: ...


@pytest.fixture
def kit_ros(stage: Stage) -> Kit:
    return runner_for(stage.workspace)


def runner_for(workspace: Path) -> Callable[..., tuple[str, str, int]]:
    def run(*words: str) -> tuple[str, str, int]:
        result = CliRunner(env={"KIT_WORKSPACE": str(workspace)}).invoke(main, ["ros", *words])
        if result.exception is not None and not isinstance(result.exception, SystemExit):
            raise result.exception
        return result.stdout, result.stderr, result.exit_code

    return run
