"""The graph screen over a graph that the test drives: what is chosen, found, hidden, opened; and what it costs."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Awaitable, Callable
from types import SimpleNamespace
from typing import Any

import pytest
from textual.app import App
from textual.pilot import Pilot

from kit.msg.geometry_msgs import Twist
from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_srvs import Trigger
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from kit.ros.node.qos import qos_profile_sensor_data
from kit.tui.screens.graph import CALM, FRAME, GraphScreen
from kit.tui.terminal import TerminalFacts, TerminalOptions, decide_terminal
from kit.tui.theme import Theme
from kit.tui.widgets.field_plot import FieldPlot
from tests.tui.lesson_stage import rows, text

MS = 1_000_000


class FakeHost:
    """A world in the test's own thread: a robot, a driver that hears it, and one that asks for too much."""

    def __init__(self) -> None:
        self.graph = Graph(log_sink=lambda record: None)
        self.paused = False
        self.listener: Callable[[Any], object] | None = None
        robot, driver = create_graph_node(self.graph, "robot"), create_graph_node(self.graph, "driver")
        self.scan = robot.create_publisher(LaserScan, "scan", qos_profile_sensor_data)
        robot.create_subscription(Twist, "cmd_vel", lambda command: None, 10)
        robot.create_service(Trigger, "ring", lambda request, response: response)
        driver.create_subscription(LaserScan, "scan", lambda scan: None, qos_profile_sensor_data)
        self.cmd_vel = driver.create_publisher(Twist, "cmd_vel", 10)
        self.ring = driver.create_client(Trigger, "ring")
        self.graph.run_due()

    def set_listener(self, listener: Callable[[Any], object] | None) -> None:
        self.listener = listener
        self.show()

    def post(self, job: Callable[[Any], object]) -> None:
        job(self.session)

    def set_paused(self, paused: bool) -> None:
        self.paused = paused
        self.show()

    def step(self) -> None:
        self.tick()

    @property
    def session(self) -> Any:
        return SimpleNamespace(graph=self.graph, runner=SimpleNamespace(paused=self.paused))

    def show(self) -> None:
        if self.listener is not None:
            self.listener(self.session)

    def tick(self, speed: float = 0.5) -> None:
        """A tenth of a second in which everybody says something."""
        self.graph.advance(self.graph.now_ns + 100 * MS)
        self.scan.publish(LaserScan(ranges=[1.0, 2.0]))
        command = Twist()
        command.linear.x = speed
        self.cmd_vel.publish(command)
        self.graph.run_due()
        self.show()


Scene = Callable[[GraphScreen, FakeHost, Pilot[None]], Awaitable[None]]


def play(scene: Scene, *, glyphs: str = "braille", size: tuple[int, int] = (80, 24)) -> None:
    terminal = decide_terminal(
        {"TERM": "xterm-256color"}, TerminalFacts(), TerminalOptions(False, glyphs, None)
    )  # type: ignore[arg-type]  # a word of its list

    async def run() -> None:
        app: App[None] = App()
        async with app.run_test(size=size) as pilot:
            host = FakeHost()
            screen = GraphScreen(Theme.of(terminal), host, "test")  # type: ignore[arg-type]  # all it uses
            await app.push_screen(screen)
            await settled(screen)
            await scene(screen, host, pilot)

    asyncio.run(run())


async def settled(screen: GraphScreen) -> None:
    """Waits until nothing moves any more and all is said."""
    async with asyncio.timeout(10):
        await asyncio.sleep(0.05)
        while screen.is_moving:
            await asyncio.sleep(0.02)
    await asyncio.sleep(0.05)


@pytest.mark.long
def test_the_screen_at_eighty_columns() -> None:
    async def scene(screen: GraphScreen, host: FakeHost, pilot: Pilot[None]) -> None:
        for _ in range(5):
            host.tick()
        await settled(screen)
        await asyncio.sleep(CALM)
        host.show()
        await settled(screen)
        assert rows(screen)[:4] == [
            "test  2 nodes  2 topics  1 service  14 not shown",
            " /robot ━━━━━━━━━━━━━━━━━10 Hz━▶ [/scan]━━━━━━━━━━━━━━━━━━━━▶  /driver",
            " /driver ─────────┬──────10 Hz─▶  /cmd_vel ────────────────┬▶  /robot",
            "                  └╌╌╌╌╌╌╌╌╌╌╌╌▶  /ring() ╌╌╌╌╌╌╌╌╌╌╌╌╌╌╌╌╌┘",
        ]
        assert rows(screen)[5:10] == [
            "── /scan  sensor_msgs/msg/LaserScan ────────────────────────────────────────────",
            "from /robot  to /driver",
            "header:",
            "  stamp: {sec: 0, nanosec: 0}",
            "  frame_id: ''",
        ]
        keys = "arrows choose Enter message / filter a all t tidy ? help Esc back ^P more"
        assert rows(screen)[-1] == keys

    play(scene)


@pytest.mark.long
def test_a_choice_shows_its_newest_message() -> None:
    async def scene(screen: GraphScreen, host: FakeHost, pilot: Pilot[None]) -> None:
        await pilot.press("down")
        assert "/cmd_vel  geometry_msgs/msg/Twist" in text(screen)
        assert "no message yet" in text(screen)
        host.show()
        host.tick(0.25)
        await settled(screen)
        assert "linear: {x: 0.25, y: 0.0, z: 0.0}" in text(screen)
        await pilot.press("enter")
        await settled(screen)
        assert "  x: 0.25" in text(screen)
        assert "RELIABLE VOLATILE depth 10" in text(screen)
        assert "/scan" not in text(screen)
        await pilot.press("escape")
        await settled(screen)
        assert "/scan" in text(screen)

    play(scene)


@pytest.mark.long
@pytest.mark.parametrize(("size", "has_room"), [((200, 50), True), ((120, 35), False)])
def test_the_definition_of_a_message_stands_beside_it_where_there_is_room(
    size: tuple[int, int], has_room: bool
) -> None:
    async def scene(screen: GraphScreen, host: FakeHost, pilot: Pilot[None]) -> None:
        await pilot.press("down")
        host.show()
        host.tick(0.25)
        await settled(screen)
        assert "0.25" in text(screen)
        assert ("Vector3 linear" in text(screen)) is has_room

    play(scene, size=size)


@pytest.mark.long
def test_messages_travel_while_there_are_any_and_leave_nothing_behind() -> None:
    async def scene(screen: GraphScreen, host: FakeHost, pilot: Pilot[None]) -> None:
        host.tick()
        await pilot.pause()
        seen = set()
        async with asyncio.timeout(10):
            while screen.is_moving:
                seen.add(text(screen).count("●"))
                await asyncio.sleep(FRAME / 4)
        assert max(seen) == 2
        assert "●" not in text(screen)

    play(scene)


@pytest.mark.long
def test_a_mismatch_is_chosen_first_and_explained() -> None:
    async def scene(screen: GraphScreen, host: FakeHost, pilot: Pilot[None]) -> None:
        await pilot.press("escape")
        demanding = create_graph_node(host.graph, "demanding")
        demanding.create_subscription(LaserScan, "scan", lambda scan: None, 10)
        screen = GraphScreen(screen.theme, host, "test")  # type: ignore[arg-type]  # all it uses
        await pilot.app.push_screen(screen)
        await settled(screen)
        assert "1 broken line" in rows(screen)[0]
        assert "✗" in text(screen)
        assert "[/scan]" in text(screen)
        words = " ".join(text(screen).split())
        assert (
            "nothing arrives: RELIABILITY: /robot offers BEST_EFFORT, /demanding asks for RELIABLE" in words
        )

    play(scene)


@pytest.mark.long
def test_joining_and_leaving_move_nothing_that_was_there() -> None:
    async def scene(screen: GraphScreen, host: FakeHost, pilot: Pilot[None]) -> None:
        before = rows(screen)[1:4]
        joined = create_graph_node(host.graph, "joined")
        joined.create_publisher(Twist, "more", 10)
        host.show()
        await asyncio.sleep(CALM)
        host.show()
        await settled(screen)
        assert "/joined" in text(screen)
        assert rows(screen)[1:4] == before
        joined.destroy_node()
        host.show()
        await asyncio.sleep(CALM)
        host.show()
        await settled(screen)
        assert "/joined" not in text(screen)
        assert rows(screen)[1:4] == before

    play(scene)


@pytest.mark.long
def test_narrowing_and_all() -> None:
    async def scene(screen: GraphScreen, host: FakeHost, pilot: Pilot[None]) -> None:
        assert "/rosout" not in text(screen)
        await pilot.press("a")
        await settled(screen)
        assert "/rosout" in text(screen)
        assert "get_parameters()" in text(screen)
        await pilot.press("a", "slash", "s", "c", "a")
        assert "only: sca" in rows(screen)[0]
        assert "/cmd_vel" not in text(screen)
        assert "/scan" in text(screen)
        await pilot.press("enter")
        assert "Esc back" in rows(screen)[-1]
        await pilot.press("escape")
        assert "/cmd_vel" in text(screen)
        await pilot.press("slash", "x", "x", "escape")
        assert "only" not in rows(screen)[0]
        assert screen.is_active

    play(scene)


@pytest.mark.long
def test_a_step_while_paused_shows_what_was_said_in_it() -> None:
    async def scene(screen: GraphScreen, host: FakeHost, pilot: Pilot[None]) -> None:
        await pilot.press("p")
        assert host.paused
        await asyncio.sleep(CALM)
        await settled(screen)
        assert rows(screen)[0].endswith("paused")
        assert not screen.is_moving
        await pilot.press("full_stop")
        assert screen.is_moving
        assert host.graph.now_ns == 100 * MS

    play(scene)


@pytest.mark.long
def test_closed_it_listens_no_more() -> None:
    async def scene(screen: GraphScreen, host: FakeHost, pilot: Pilot[None]) -> None:
        assert host.graph.message_listeners
        await pilot.press("escape")
        await pilot.pause()
        assert not host.graph.message_listeners
        assert host.listener is None

    play(scene)


@pytest.mark.long
def test_help_explains_the_picture() -> None:
    async def scene(screen: GraphScreen, host: FakeHost, pilot: Pilot[None]) -> None:
        await pilot.press("question_mark")
        await pilot.pause()
        assert "any key closes" in text(screen)

    play(scene)


@pytest.mark.long
def test_in_plain_characters() -> None:
    async def scene(screen: GraphScreen, host: FakeHost, pilot: Pilot[None]) -> None:
        for _ in range(3):
            host.tick()
        await asyncio.sleep(FRAME)
        assert text(screen).isascii()

    play(scene, glyphs="ascii")


@pytest.mark.long
@pytest.mark.parametrize("size", [(60, 18), (40, 10), (20, 5), (200, 60)])
def test_any_size_will_do(size: tuple[int, int]) -> None:
    async def scene(screen: GraphScreen, host: FakeHost, pilot: Pilot[None]) -> None:
        host.tick()
        await settled(screen)
        assert len(rows(screen)) == size[1]

    play(scene, size=size)


async def open_message(screen: GraphScreen, host: FakeHost, pilot: Pilot[None], *speeds: float) -> None:
    """The whole message of /cmd_vel, after it was sent at these speeds."""
    await pilot.press("down")
    host.show()
    for speed in speeds:
        host.tick(speed)
    await pilot.press("enter")
    await settled(screen)


def plot(screen: GraphScreen) -> list[str]:
    """The rows of the plot as they are seen."""
    area = screen.query_one(FieldPlot).region
    return [line[area.x : area.right] for line in rows(screen)[area.y : area.bottom]]


@pytest.mark.long
def test_a_plot_of_the_chosen_field_has_its_path_values_and_seconds() -> None:
    async def scene(screen: GraphScreen, host: FakeHost, pilot: Pilot[None]) -> None:
        await open_message(screen, host, pilot, *(number / 10 for number in range(21)))
        assert "y plot" in rows(screen)[-1]
        await pilot.press("y")
        await settled(screen)
        assert "linear.x 2" in plot(screen)[0]
        assert plot(screen)[1].startswith("2┤")
        assert plot(screen)[-2].strip("└─ ").split("─")[0].split() == ["-2"]
        assert plot(screen)[-2].endswith("─ 0 s")
        assert "the last 21 messages" in plot(screen)[-1]
        await pilot.press("down")
        assert "linear.y 0" in plot(screen)[0]
        await pilot.press("up", "up")
        assert "linear.x" in plot(screen)[0]
        await pilot.press("y")
        await settled(screen)
        assert "the last 21" not in text(screen)
        assert "  x: 2.0" in text(screen)

    play(scene)


@pytest.mark.long
@pytest.mark.parametrize("size", [(80, 24), (80, 14), (109, 30), (110, 30), (200, 50)])
def test_the_plot_stands_beside_the_message_where_there_is_room_else_below(size: tuple[int, int]) -> None:
    async def scene(screen: GraphScreen, host: FakeHost, pilot: Pilot[None]) -> None:
        await open_message(screen, host, pilot, 0.5, 1.0)
        await pilot.press("y")
        await settled(screen)
        message, area = screen.query_one("#about").region, screen.query_one(FieldPlot).region
        assert area.area >= size[0] * size[1] / 4
        if size[0] >= 110:
            assert area.x > message.right - 1
            assert area.y == message.y
        else:
            assert area.y == message.bottom
        assert "x: 1.0" in text(screen)

    play(scene, size=size)


@pytest.mark.long
def test_every_item_of_a_list_can_be_plotted_and_a_text_says_that_it_cannot() -> None:
    async def scene(screen: GraphScreen, host: FakeHost, pilot: Pilot[None]) -> None:
        host.show()
        host.tick()
        await pilot.press("y")
        await settled(screen)
        assert "angle_min" in plot(screen)[0]
        await pilot.press(*["down"] * 7)
        assert "ranges[0] 1" in plot(screen)[0]
        await pilot.press("right", "right", "right")
        assert "ranges[1] 2" in plot(screen)[0]
        await pilot.press("down")
        assert "intensities is empty" in text(screen)
        await pilot.press("home", "down", "down")
        assert "header.frame_id is not a number" in text(screen)

    play(scene)


@pytest.mark.long
def test_values_that_are_not_finite_are_counted() -> None:
    async def scene(screen: GraphScreen, host: FakeHost, pilot: Pilot[None]) -> None:
        await open_message(screen, host, pilot, 0.5, math.nan, math.inf, 1.0)
        await pilot.press("y")
        await settled(screen)
        assert "linear.x 1" in plot(screen)[0]
        assert "2 of them not finite" in plot(screen)[-1]

    play(scene)


@pytest.mark.long
def test_a_node_has_no_field_to_plot() -> None:
    async def scene(screen: GraphScreen, host: FakeHost, pilot: Pilot[None]) -> None:
        await pilot.press("left", "y")
        await settled(screen)
        assert "no field to plot" in text(screen)
        await pilot.press("down", "right")
        assert screen.is_active

    play(scene)


@pytest.mark.long
def test_a_click_chooses_a_field_and_esc_closes_the_plot_first() -> None:
    async def scene(screen: GraphScreen, host: FakeHost, pilot: Pilot[None]) -> None:
        await open_message(screen, host, pilot, 0.5)
        await pilot.press("y")
        await settled(screen)
        line = next(number for number, words in enumerate(rows(screen)) if words.strip() == "z: 0.0")
        await pilot.click(offset=(3, line))
        assert "linear.z" in plot(screen)[0]
        await pilot.click(offset=(3, 1))
        await pilot.click(offset=(3, line - 3))
        assert "linear.z" in plot(screen)[0]
        await pilot.press("escape")
        await settled(screen)
        assert "angular:" in text(screen)
        assert "the last" not in text(screen)
        await pilot.press("escape")
        await settled(screen)
        assert "/scan" in text(screen)

    play(scene)


@pytest.mark.long
def test_a_click_far_down_a_long_message_chooses_the_field_that_is_there() -> None:
    async def scene(screen: GraphScreen, host: FakeHost, pilot: Pilot[None]) -> None:
        host.show()
        host.tick()
        await pilot.press("y")
        await settled(screen)
        await pilot.press("end")
        assert "intensities is empty" in text(screen)
        line = next(number for number, words in enumerate(rows(screen)) if words.startswith("ranges:"))
        await pilot.click(offset=(3, line))
        assert "ranges[0] 1" in plot(screen)[0]

    play(scene)
