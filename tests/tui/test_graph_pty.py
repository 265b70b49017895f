"""Who says what to whom, in a real terminal over a real world: traffic to be seen, and what it costs."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

import pytest

from tests.tui.test_play_pty import KIT, User
from tests.tui.widgets.test_world_view_pty import cpu_seconds, run_on

Open = Callable[..., User]
DOT = "●"


@pytest.fixture
def graph() -> Iterator[User]:
    """The kit on a map, with the graph on the screen and messages on their way."""
    user = User(KIT, "drive", "simple", "--seed", "1")
    user.until(lambda: "forward   0.50" in user.text, "a robot on its way")
    user.send(b"n")
    user.until(lambda: "10 Hz" in user.text and DOT in user.text, "messages on their way")
    yield user
    user.close()


@pytest.mark.long
def test_the_running_world_talks_and_goes_on(graph: User) -> None:
    text = graph.text
    for name in ("/flatland_server", "/random_walk", "/cmd_vel", "/static_laser", "/move_model()"):
        assert name in text
    assert "/rosout" not in text
    graph.send(b"//static_laser\r")
    graph.until(lambda: "only: /static_laser" in graph.text, "the one topic")
    graph.until(lambda: "frame_id: " in graph.text, "its newest message")
    first = re.search(r"nanosec: \d+", graph.text)
    assert first is not None
    graph.until(lambda: first[0] not in graph.text, "a newer one")
    graph.send(b"\r")
    graph.until(lambda: "Enter close" in graph.text, "the whole message")
    graph.send(b"\x1b")
    graph.until(lambda: "Enter message" in graph.text, "the graph again")
    graph.send(b"\x1b")
    graph.until(lambda: "only:" not in graph.text and "/odom" in graph.text, "all topics again")
    graph.send(b"\x1b")
    graph.until(lambda: "nearest" in graph.text, "the world again")
    clock = re.search(r"\d:\d\d\.\d", graph.text)
    assert clock is not None
    graph.until(lambda: clock[0] not in graph.text, "the world to go on")
    graph.send(b"\x03")
    assert graph.wait() == 0
    graph.assert_sane()


@pytest.mark.long
def test_it_costs_little_and_nothing_while_paused(graph: User) -> None:
    run_on(graph, 1.0)
    before = len(graph.output)
    run_on(graph, 2.0)
    assert 0 < len(graph.output) - before < 2 * 6000
    graph.send(b"p")
    graph.until(lambda: "paused" in graph.text and DOT not in graph.text, "the last dots to arrive")
    run_on(graph, 1.0)
    before, cpu = len(graph.output), cpu_seconds(graph.process.pid)
    run_on(graph, 1.5)
    assert len(graph.output) == before
    assert cpu_seconds(graph.process.pid) - cpu < 0.15
    graph.send(b"." * 12)
    graph.until(lambda: len(graph.output) > before, "what was said in a few steps")
    graph.send(b"\x03")
    assert graph.wait() == 0
    graph.assert_sane()
