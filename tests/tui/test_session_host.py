"""The world behind the screen: opened, exchanged, closed, without ever making the face wait."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from kit.controllers import find_controller
from kit.run.lockstep import Observer
from kit.run.scenario import Scenario, find_scenario
from kit.run.view import View
from kit.sim.simulation import Simulation
from kit.tui.session_host import SessionHost


class Face:
    """Notes what it is shown."""

    def __init__(self) -> None:
        self.views: list[View] = []
        self.troubles: list[str] = []
        self.host = SessionHost(on_view=self.views.append, on_error=self.troubles.append)

    def until(self, is_so: Callable[[], object]) -> None:
        end = time.monotonic() + 20
        while not is_so():
            assert time.monotonic() < end, self.troubles
            time.sleep(0.01)


@pytest.fixture
def face() -> Iterator[Face]:
    face = Face()
    yield face
    face.host.close()


@pytest.mark.long
def test_one_world_takes_the_place_of_another(face: Face) -> None:
    for name in ("simple", "maze"):
        face.host.open(lambda name=name: find_scenario(name), find_controller("forward"))  # type: ignore[misc]  # mypy on lambdas
        face.until(lambda name=name: face.views and face.views[-1].title == name)  # type: ignore[misc]  # same
    face.until(lambda: face.views[-1].time_s > 0.2)
    assert not face.troubles


def test_the_first_view_comes_before_the_first_tick_with_every_figure_in_its_place(face: Face) -> None:
    face.host.open(lambda: find_scenario("turn"), find_controller("forward"))
    face.until(lambda: face.views and face.views[-1].tick)
    first, later = face.views[0], face.views[-1]
    assert first.tick == 0
    assert [side for side, _ in first.nearest] == [side for side, _ in later.nearest] != []
    assert first.pose == find_scenario("turn").start


SLOW = """
import pathlib

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

while not pathlib.Path({go!r}).exists():
    pass  # it would start to sleep in the world's time


class Slow(Node):
    def __init__(self):
        super().__init__("slow")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)


rclpy.init()
rclpy.spin(Slow())
"""


@pytest.mark.long
def test_no_time_passes_before_the_controller_drives(face: Face, tmp_path: Path) -> None:
    go, file = tmp_path / "go", tmp_path / "slow.py"
    file.write_text(SLOW.format(go=str(go)))
    face.host.open(lambda: find_scenario("simple"), find_controller(str(file)), paused=True)
    face.until(lambda: face.views)
    face.host.step()  # compiles what the first tick needs
    face.until(lambda: face.views[-1].tick)
    could_drive: list[bool] = []

    class AtEveryTick(Observer):
        def on_step(self, simulation: Simulation) -> None:
            could_drive.append(go.exists())

    face.host.post(lambda session: session.runner.observers.append(AtEveryTick()))
    face.host.resume_when_driven()
    threading.Timer(0.3, go.touch).start()
    face.until(lambda: could_drive)
    assert could_drive[0]


@pytest.mark.long
def test_a_world_is_not_seen_any_more_once_another_was_asked_for(face: Face) -> None:
    begun, opened = threading.Event(), threading.Event()

    def slowly() -> Scenario:
        begun.set()
        opened.wait(20)
        return find_scenario("maze")

    face.host.open(lambda: find_scenario("simple"), find_controller("forward"))
    face.until(lambda: face.views and face.views[-1].tick)
    face.host.open(slowly, find_controller("forward"), paused=True)
    seen = len(face.views)
    assert begun.wait(20)
    ticked = threading.Event()
    face.host.post(lambda session: ticked.set())
    assert ticked.wait(20), "the world before goes on"
    assert len(face.views) == seen
    opened.set()
    face.until(lambda: len(face.views) > seen + 1)
    assert {each.title for each in face.views[seen:]} == {"maze"}


@pytest.mark.long
def test_what_cannot_be_opened_leaves_the_world_as_it_is(face: Face) -> None:
    face.host.open(lambda: find_scenario("simple"), find_controller("forward"))
    face.until(lambda: face.views)
    face.host.open(lambda: find_scenario("nowhere"), find_controller("forward"))
    face.until(lambda: face.troubles)
    assert "nowhere" in face.troubles[0]
    seen = len(face.views)
    face.until(lambda: len(face.views) > seen + 5)


@pytest.mark.long
def test_closing_does_not_wait_for_a_world_that_is_being_opened(face: Face) -> None:
    begun, opened = threading.Event(), threading.Event()

    def slowly() -> Scenario:
        begun.set()
        opened.wait(20)
        return find_scenario("simple")

    face.host.open(slowly, find_controller("forward"))
    assert begun.wait(20)
    start = time.monotonic()
    face.host.close()
    assert time.monotonic() - start < 1.0
    opened.set()
    time.sleep(0.5)
    assert not face.views


@pytest.mark.long
def test_closing_does_not_wait_for_a_controller_that_does_not_come_back(
    face: Face, tmp_path_factory: pytest.TempPathFactory
) -> None:
    file = tmp_path_factory.mktemp("work") / "loops.py"
    file.write_text(
        "from rclpy.node import Node\n"
        "class Loops(Node):\n"
        "    def __init__(self):\n"
        "        super().__init__('loops')\n"
        "        self.create_timer(0.1, self.go)\n"
        "    def go(self):\n"
        "        self.get_logger().info('now')\n"
        "        while True: pass\n"
    )
    face.host.open(lambda: find_scenario("simple"), find_controller(str(file)))
    face.until(lambda: face.views and face.views[-1].time_s > 0.05)
    time.sleep(0.5)
    start = time.monotonic()
    face.host.close()
    assert time.monotonic() - start < 2.0  # a reply may take three seconds


SAVER = """
import pathlib

import rclpy

rclpy.init()
node = rclpy.create_node("saver")
ticks = []
node.create_timer(0.05, lambda: ticks.append(1))
try:
    rclpy.spin(node)
finally:
    pathlib.Path({saved!r}).write_text(str(len(ticks)))
"""


@pytest.mark.parametrize("leaves", [True, False])
def test_a_program_saves_what_it_has_when_the_user_leaves_or_opens_another_world(
    face: Face, tmp_path: Path, leaves: bool
) -> None:
    saved = tmp_path / "saved.txt"
    (tmp_path / "saver.py").write_text(SAVER.format(saved=str(saved)))
    face.host.open(lambda: find_scenario("simple"), find_controller(str(tmp_path / "saver.py")))
    face.until(lambda: face.views and face.views[-1].time_s > 1)
    if leaves:
        face.host.close()
    else:
        face.host.open(lambda: find_scenario("maze"), None)
    face.until(saved.exists)
    face.until(lambda: saved.read_text() and int(saved.read_text()) > 1)
    assert not face.troubles
