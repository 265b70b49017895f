"""Frame throttle against a simulated link: the picture stays young at every speed, and never stalls for good."""

from __future__ import annotations

import heapq
import itertools
import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from itertools import islice
from typing import Any

import numpy as np
import pytest
from textual import events
from textual.pilot import Pilot
from textual.screen import ModalScreen
from textual.widgets import Label

from kit.geometry import Pose
from kit.render.encode import ENCODERS, BrailleEncoder
from kit.render.painter import Painter
from kit.render.palettes import COLOR_SCHEMES, PALETTES
from kit.render.roles import SHADES, Role
from kit.render.scene import Scene
from kit.tui.textual_patches import CroppingCompositor
from kit.tui.widgets.world_view import FAST, LEAST, MOST_UNDER_WAY, SLOW, TIMEOUT, FrameThrottle
from tests.render.scenes import drive, maze, robot
from tests.tui.tape import Display, ViewApp, painted, run_in

FRAME = 1000
"""Bytes of a frame."""


@dataclass
class Link:
    """A link with a delay each way and an endless buffer in front of a narrow pipe: what SSH looks like."""

    rate: float
    """Bytes per second."""
    delay: float
    """Seconds, one way."""
    answers: Callable[[float], bool] = lambda now: True
    free_at: float = 0.0
    events: list[float] = field(default_factory=list)
    lags: list[float] = field(default_factory=list)

    def send(self, now: float) -> None:
        self.free_at = max(self.free_at, now) + FRAME / self.rate
        shown = self.free_at + self.delay
        self.lags.append(shown - now)
        if self.answers(now):
            heapq.heappush(self.events, shown + self.delay)


def play(link: Link, end: float, throttle: FrameThrottle | None = None, start: float = 0.0) -> list[float]:
    """Draws whenever allowed; the times of the frames."""
    throttle = throttle or FrameThrottle()
    now, drawn = start, []
    while now < end:
        while link.events and link.events[0] <= now:
            throttle.answered(heapq.heappop(link.events))
        if throttle.wait(now) <= 0:
            throttle.drawn(now)
            link.send(now)
            throttle.sent(now)
            drawn.append(now)
        now += 0.001
    return drawn


def rate(drawn: list[float], start: float, end: float) -> float:
    return sum(start <= time < end for time in drawn) / (end - start)


def test_a_fast_link_gets_twenty_frames_a_second() -> None:
    drawn = play(Link(1e7, 0.001), 10)
    assert rate(drawn, 2, 10) == pytest.approx(FAST, abs=0.5)


def test_a_link_of_40_ms_round_trip_gets_twenty_too() -> None:
    drawn = play(link := Link(125e3, 0.020), 10)
    assert rate(drawn, 2, 10) == pytest.approx(FAST, abs=0.5)
    assert max(link.lags) < 0.1


@pytest.mark.parametrize(
    ("bytes_per_second", "delay"), [(30e3, 0.02), (9600, 0.02), (2400, 0.05), (30e3, 0.3)]
)
def test_the_picture_is_never_older_than_a_few_frames_take(bytes_per_second: float, delay: float) -> None:
    drawn = play(link := Link(bytes_per_second, delay), 20)
    assert max(link.lags) <= MOST_UNDER_WAY * FRAME / bytes_per_second + delay + 1e-6
    # Nor is the link left idle for long.
    possible = min(SLOW, bytes_per_second / FRAME)
    assert rate(drawn, 5, 20) > 0.6 * min(possible, 1 / (2 * delay + FRAME / bytes_per_second))


def test_a_slow_link_is_asked_for_ten_frames_a_second_at_most() -> None:
    drawn = play(Link(1e7, 0.2), 10)
    assert rate(drawn, 2, 10) <= SLOW + 0.5


def test_a_link_that_slows_down_and_recovers() -> None:
    throttle = FrameThrottle()
    link = Link(1e7, 0.005)
    play(link, 5, throttle)
    assert throttle.fps == FAST
    slow = Link(5e3, 0.02)
    play(slow, 15, throttle, start=5)
    assert throttle.fps == SLOW
    assert throttle.lag is not None
    assert throttle.lag > 0.2
    play(Link(1e7, 0.005), 25, throttle, start=15)
    assert throttle.fps == FAST


def test_a_terminal_that_never_answers_gets_ten_frames_a_second_after_the_first_timeout() -> None:
    drawn = play(Link(1e7, 0.001, answers=lambda now: False), 12)
    assert drawn[0] == 0.0
    assert drawn[1] == pytest.approx(TIMEOUT, abs=0.01)
    assert rate(drawn, 3, 12) == pytest.approx(SLOW, abs=0.5)


def test_a_lost_answer_costs_a_pause_and_no_more() -> None:
    lost = Link(1e7, 0.005, answers=lambda now: not 3.0 < now < 3.2)
    drawn = play(lost, 30)
    gaps = [after - before for before, after in itertools.pairwise(drawn)]
    assert max(gaps) <= TIMEOUT + 0.1
    assert rate(drawn, 6, 30) > 0.9 * SLOW


def test_a_link_that_stood_still_goes_on() -> None:
    """Nothing arrives for five seconds, then everything does."""
    throttle, link = FrameThrottle(), Link(1e7, 0.005)
    play(link, 3, throttle)
    link.free_at, link.events = 8.0, []
    times = play(link, 20, throttle, start=3)
    assert rate(times, 12, 20) > 0.9 * SLOW


def test_an_answer_nobody_asked_for_changes_nothing() -> None:
    throttle = FrameThrottle()
    throttle.answered(1.0)
    assert throttle.lag is None
    assert throttle.allowed == 1


def test_the_wait_is_until_the_next_frame_is_due() -> None:
    throttle = FrameThrottle()
    assert throttle.wait(5.0) == 0
    throttle.drawn(5.0)
    throttle.sent(5.0)
    throttle.answered(5.001)
    assert throttle.fps == FAST
    assert throttle.wait(5.02) == pytest.approx(0.03, abs=0.03)
    assert throttle.wait(5.2) == 0


def test_late_frames_do_not_slow_the_rate() -> None:
    """A timer that rings a few milliseconds late each time still gets its twenty."""
    throttle, now, frames = FrameThrottle(), 0.0, 0
    while now < 20.0:
        wait = throttle.wait(now)
        if wait > 0:
            now += wait + 0.004
            continue
        throttle.drawn(now)
        throttle.sent(now)
        throttle.answered(now + 0.001)
        frames += 1
    assert frames / 20 == pytest.approx(FAST, rel=0.03)


def test_the_fastest_rate_can_be_chosen() -> None:
    drawn = play(Link(1e7, 0.001), 10, FrameThrottle(fastest=5))
    assert rate(drawn, 2, 10) == pytest.approx(5, abs=0.5)
    assert not math.isnan(rate(drawn, 0, 1))


def test_pictures_that_wait_for_each_other_in_the_link_become_fewer_at_once_and_come_back() -> None:
    throttle = FrameThrottle()
    play(Link(1e7, 0.005), 5, throttle)
    narrow = Link(3e3, 0.02)
    play(narrow, 40, throttle, start=5)
    assert max(narrow.lags) <= MOST_UNDER_WAY * FRAME / 3e3 + 0.05
    later = narrow.lags[len(narrow.lags) // 2 :]
    assert sum(later) / len(later) < 1.6 * FRAME / 3e3, "seldom more than one picture under way"
    drawn = play(Link(1e7, 0.1), 80, throttle, start=40)
    assert rate(drawn, 75, 80) == pytest.approx(SLOW, abs=0.5), "more than one under way again"


def test_a_far_link_keeps_several_pictures_under_way() -> None:
    drawn = play(Link(1e7, 0.3), 40)
    assert rate(drawn, 30, 40) == pytest.approx(MOST_UNDER_WAY / 0.6, rel=0.1)


def draw_for(cost: float, end: float, throttle: FrameThrottle, start: float) -> list[float]:
    """Draws whenever allowed, on a machine on which a frame takes ``cost`` seconds and a fast link."""
    now, drawn = start, []
    while now < end:
        if throttle.wait(now) <= 0:
            drawn.append(now)
            throttle.drawn(now, cost)
            now += cost
            throttle.sent(now)
            throttle.answered(now + 0.002)
        now += 0.001
    return drawn


@pytest.mark.parametrize("cost", [0.03, 0.1, 0.15])
def test_a_slow_machine_draws_fewer_frames_and_as_many_as_before_when_it_is_fast_again(cost: float) -> None:
    throttle = FrameThrottle()
    assert rate(draw_for(0.002, 10, throttle, 0), 2, 10) == pytest.approx(FAST, abs=0.5)
    slow = draw_for(cost, 30, throttle, 10)
    assert rate(slow, 15, 30) * cost < 0.4, "most of its time is left for the rest"
    assert LEAST - 0.2 <= rate(slow, 15, 30) < FAST
    again = draw_for(0.002, 40, throttle, 30)
    assert rate(again, 33, 40) == pytest.approx(FAST, abs=0.5)


def test_one_slow_frame_such_as_the_first_does_not_count_for_long() -> None:
    throttle = FrameThrottle()
    throttle.drawn(0.0, 1.0)
    assert throttle.period > 1 / FAST
    assert rate(draw_for(0.002, 10, throttle, 1.0), 4, 10) == pytest.approx(FAST, abs=0.5)


BUDGET = 30_000 / 20
"""Bytes of a frame: 30 KB/s at twenty frames a second."""

SIZE = (80, 24)


def scenes(count: int, skip: int = 0) -> list[Scene]:
    return list(islice(drive(), skip, skip + count))


def in_terminal(
    app: ViewApp, script: Callable[[Pilot[None], Display], Any], size: tuple[int, int] = SIZE
) -> None:
    """Runs the script with a display that is fed by ``see``."""

    async def with_display(pilot: Pilot[None]) -> None:
        await painted(app)
        await script(pilot, Display(*size))

    run_in(app, with_display, size)


async def see(app: ViewApp, display: Display) -> int:
    """Brings the display up to date; says how many bytes that took."""
    await painted(app)
    text = app.terminal.take()
    display.feed(text)
    return len(text.encode())


def seen(app: ViewApp) -> list[str]:
    assert app.view.frame is not None
    return app.view.frame.rows()


@pytest.mark.long
@pytest.mark.parametrize("cropped", [True, False])
@pytest.mark.parametrize("glyphs", ENCODERS)
def test_the_terminal_shows_every_frame(glyphs: str, cropped: bool) -> None:
    app = ViewApp(ENCODERS[glyphs](False), cropped=cropped)

    async def script(pilot: Pilot[None], display: Display) -> None:
        for scene in scenes(30, skip=100):
            app.view.show(scene)
            await see(app, display)
            assert display.rows == seen(app)

    in_terminal(app, script)


def test_frames_reach_the_terminal_without_the_compositor(monkeypatch: pytest.MonkeyPatch) -> None:
    app, display = ViewApp(), Display(60, 20)
    rounds: list[object] = []

    async def script(pilot: Pilot[None]) -> None:
        first, *later = scenes(8, skip=100)
        app.view.show(first)
        await see(app, display)
        monkeypatch.setattr(CroppingCompositor, "render_partial_update", rounds.append)
        sent = 0
        for scene in later:
            app.view.show(scene)
            sent += await see(app, display)
            assert display.rows == seen(app)
        assert sent

    run_in(app, script, (60, 20))
    assert rounds == []


class Notice(Label):
    """Lies over the picture."""

    DEFAULT_CSS = "Notice { layer: above; dock: top; width: 30; height: 1; offset: 4 3; }"


@pytest.mark.parametrize("is_screen", [False, True])
def test_frames_do_not_write_over_what_lies_above_them(is_screen: bool) -> None:
    app, display = ViewApp(), Display(60, 20)
    app.CSS = "Screen { layers: default above; }"
    said = "as it was ".ljust(30, "#")

    async def script(pilot: Pilot[None]) -> None:
        shown = iter(scenes(12, skip=100))
        app.view.show(next(shown))
        await see(app, display)
        notice = Notice(said)
        if is_screen:
            dialog: ModalScreen[None] = ModalScreen()
            await app.push_screen(dialog)
            await dialog.mount(notice)
        else:
            await app.screen.mount(notice)
        await pilot.pause()
        for scene in islice(shown, 6):
            app.view.show(scene)
            await see(app, display)
            assert any(said in row for row in display.rows)
        await (app.pop_screen() if is_screen else notice.remove())
        await pilot.pause()
        with app.batch_update():
            app.view.show(next(shown))
        for scene in shown:
            await see(app, display)
            assert display.rows == seen(app)
            app.view.show(scene)

    run_in(app, script, (60, 20))


def test_meaning_has_its_colour() -> None:
    app = ViewApp(ENCODERS["ascii"](False))

    async def script(pilot: Pilot[None], display: Display) -> None:
        app.view.show(scenes(1)[0])
        await see(app, display)
        colors = {role: set() for role in Role}
        frame = app.view.frame
        for row in range(24):
            for column in range(80):
                colors[Role(frame.fg[row, column])].add(display.color(row, column))
        assert colors[Role.WALL] == {"default"}
        assert colors[Role.ROBOT] == {"cyan"}
        assert colors[Role.HIT] == {"brown"}  # pyte's name of ANSI colour 3
        assert colors[Role.TARGET] == {"green"}

    in_terminal(app, script)


def test_without_colours_none_is_sent() -> None:
    app = ViewApp(ENCODERS["braille"](True), PALETTES["none"])

    async def script(pilot: Pilot[None], display: Display) -> None:
        app.view.show(scenes(1)[0])
        await painted(app)
        text = app.terminal.take()
        assert "\x1b[1m" in text
        assert not any(f"\x1b[{code}" in text or f";{code}m" in text for code in range(30, 50))

    in_terminal(app, script)


def test_in_a_theme_with_a_paper_of_its_own_the_view_is_on_it_too() -> None:
    app = ViewApp(ENCODERS["ascii"](False), PALETTES["16"])
    app.theme = "textual-dark"

    async def script(pilot: Pilot[None], display: Display) -> None:
        app.view.show(scenes(1)[0])
        await see(app, display)
        papers = {display.paper(row, column) for row in range(24) for column in range(80)}
        assert len(papers) == 1  # by which name depends on how many colours this terminal has
        assert papers != {"default"}
        app.theme = "ansi-dark"
        await pilot.pause()
        await see(app, display)
        assert {display.paper(row, column) for row in range(24) for column in range(80)} == {"default"}

    in_terminal(app, script)


@pytest.mark.long
@pytest.mark.parametrize(("glyphs", "bound"), [("braille", 300), ("block", 260), ("ascii", 220)])
def test_a_moving_robot_stays_far_within_the_budget(glyphs: str, bound: int) -> None:
    """Counted per frame, not per second: the machine's speed has no part in it."""
    app = ViewApp(ENCODERS[glyphs](False))
    sizes: list[int] = []

    async def script(pilot: Pilot[None], display: Display) -> None:
        first, *others = scenes(90, skip=400)
        app.view.show(first)
        await see(app, display)
        for scene in others:
            app.view.show(scene)
            sizes.append(await see(app, display))

    in_terminal(app, script)
    assert sum(sizes) / len(sizes) < min(bound, BUDGET)
    assert max(sizes) < BUDGET


@pytest.mark.long
@pytest.mark.parametrize(
    ("size", "scheme", "bound"), [(SIZE, None, 12_000), (SIZE, "dark", 24_000), ((200, 50), "dark", 24_000)]
)
def test_following_a_robot_close_up_stays_within_the_budget(
    size: tuple[int, int], scheme: str | None, bound: int
) -> None:
    """``bound``: bytes a second at twenty frames. ``scheme``: of the true colours, with a lit floor."""
    is_shaded = scheme is not None
    palette = COLOR_SCHEMES[scheme].palette(reduced=False) if scheme is not None else PALETTES["16"]
    app = ViewApp(BrailleEncoder(layers=is_shaded), palette)
    app.theme = "textual-dark" if is_shaded else "ansi-dark"
    sizes: list[int] = []

    async def script(pilot: Pilot[None], display: Display) -> None:
        for number, scene in enumerate(scenes(160)):
            hits = scene.hits if is_shaded else scene.hits[:0]
            rays = np.column_stack((np.full_like(hits, scene.robots[0].pose[:2]), hits))
            app.view.show(replace(scene, beams=rays))
            if not number:
                app.view.follow()
                app.view.zoom(3)
            sizes.append(await see(app, display))
            assert display.rows == seen(app)

    in_terminal(app, script, size)
    assert sum(sizes[1:]) / len(sizes[1:]) * 20 < bound


@pytest.mark.long
def test_nothing_is_sent_while_nothing_changes() -> None:
    app = ViewApp()

    async def script(pilot: Pilot[None], display: Display) -> None:
        (scene,) = scenes(1, skip=50)
        app.view.show(scene)
        await see(app, display)
        assert not app.view.show(scene)
        assert not app.view.show(Scene(**{name: getattr(scene, name) for name in Scene.__slots__}))
        assert await see(app, display) == 0
        await pilot.pause(0.3)
        assert app.terminal.take() == ""

    in_terminal(app, script)


@pytest.mark.long
def test_a_storm_of_sizes_leaves_a_whole_picture() -> None:
    app = ViewApp()
    sizes = [(120, 40), (40, 10), (1, 1), (200, 50), (2, 30), (81, 25), (80, 24), (33, 7)]

    async def script(pilot: Pilot[None]) -> None:
        for number, scene in enumerate(scenes(16)):
            app.view.show(scene)
            await pilot.resize_terminal(*sizes[number % len(sizes)])
        for size in sizes:
            app.terminal.take()
            await pilot.resize_terminal(*size)
            await painted(app)
            display = Display(*size)
            display.feed(app.terminal.take())
            assert app.view.frame is not None
            assert app.view.frame.shape == (size[1], size[0])
            app.view.show(scenes(1, skip=300)[0])
            await see(app, display)
            assert display.rows == seen(app)

    run_in(app, script, SIZE)


@pytest.mark.long
def test_the_whole_world_fits_whatever_the_size_until_one_zooms() -> None:
    app = ViewApp()

    async def script(pilot: Pilot[None]) -> None:
        app.view.show(Scene(maze(), (robot(Pose(1, 1, 0)),)))
        for size in ((80, 24), (40, 12), (200, 50)):
            await pilot.resize_terminal(*size)
            await painted(app)
            seen_world = app.view.camera.bounds
            assert seen_world.left <= 0 < 8.25 <= seen_world.right
            assert seen_world.bottom <= 0 < 5.175 <= seen_world.top
        app.view.zoom(2)
        near = app.view.camera
        await pilot.resize_terminal(80, 24)
        await painted(app)
        assert app.view.camera.cell_width == near.cell_width
        assert (app.view.camera.x, app.view.camera.y) == (near.x, near.y)
        app.view.fit()
        assert app.view.camera.bounds.right >= 8.25

    run_in(app, script, SIZE)


def test_a_followed_robot_stays_in_sight_and_panning_lets_go() -> None:
    app = ViewApp()

    async def script(pilot: Pilot[None]) -> None:
        for scene in scenes(1):
            app.view.show(scene)
        app.view.follow(0)
        app.view.zoom(4)
        for scene in scenes(200)[::4]:
            app.view.show(scene)
            x, y, _ = scene.robots[0].pose
            left, bottom, right, top = app.view.camera.bounds
            assert left < x < right
            assert bottom < y < top
        assert app.view.followed == 0
        camera = app.view.camera
        app.view.pan(3, -2)
        assert app.view.followed is None
        assert app.view.camera == camera.panned(3, -2)

    run_in(app, script, SIZE)


def test_a_scene_without_walls_does_not_dance() -> None:
    """What moves in it does not move the camera."""
    app = ViewApp()

    async def script(pilot: Pilot[None]) -> None:
        cameras = set()
        for step in range(10):
            app.view.show(Scene(bodies=(robot(Pose(0.05 * step, 0, 0.2 * step)),)))
            cameras.add(app.view.camera)
        assert len(cameras) == 1

    run_in(app, script, SIZE)


class Clock:
    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


def test_offers_wait_for_the_terminals_answer_and_the_newest_wins() -> None:
    clock = Clock()
    app = ViewApp(clock=clock)
    made: list[int] = []

    def offer(number: int, scene: Scene) -> None:
        def make() -> Scene:
            made.append(number)
            return scene

        app.view.offer(make)

    async def script(pilot: Pilot[None]) -> None:
        app.terminal.answers = False
        for number, scene in enumerate(scenes(8)):
            offer(number, scene)
            await painted(app)
            clock.now += 0.01
        assert made == [0]
        clock.now += 0.5
        app.terminal.send_message(events.CursorPosition(0, 0))
        await pilot.pause()
        assert made == [0, 7]

    run_in(app, script, SIZE)


@pytest.mark.long
def test_the_last_offer_is_drawn_even_if_no_answer_comes() -> None:
    app = ViewApp()

    async def script(pilot: Pilot[None]) -> None:
        app.terminal.answers = False
        first, last = scenes(40)[::39]
        app.view.offer(lambda: first)
        await painted(app)
        app.view.offer(lambda: last)
        await pilot.pause(TIMEOUT + 0.3)
        assert app.view.frame is not None
        assert app.view.frame.rows() == Painter(BrailleEncoder()).paint(last, app.view.camera).rows()

    run_in(app, script, SIZE)


def test_what_is_withdrawn_is_never_asked_for() -> None:
    app = ViewApp()

    async def script(pilot: Pilot[None]) -> None:
        app.terminal.answers = False
        first, asked = scenes(1)[0], []
        app.view.offer(lambda: first)
        await painted(app)
        app.view.offer(lambda: asked.append(True) or first)
        app.view.withdraw()
        app.view._draw_later()  # the answer comes
        await pilot.pause()
        assert not asked

    run_in(app, script, SIZE)


@pytest.mark.long
def test_an_answering_terminal_gets_a_steady_stream() -> None:
    app = ViewApp()

    async def script(pilot: Pilot[None]) -> None:
        shown = []
        every = drive()
        start = time.monotonic()
        for _ in range(40):
            app.view.offer(lambda: shown.append(scene := next(every)) or scene)
            await pilot.pause(0.02)
        assert 8 <= len(shown) <= 20 * (time.monotonic() - start) + 2
        assert app.view.throttle.lag is not None

    run_in(app, script, SIZE)


def test_a_slow_link_keeps_its_colours_and_its_floor() -> None:
    app = ViewApp(BrailleEncoder(layers=True), COLOR_SCHEMES["dark"].palette(False))
    app.theme = "textual-dark"

    async def script(pilot: Pilot[None], display: Display) -> None:
        every = scenes(3)
        app.view.show(every[0])
        await painted(app)
        frame = app.view.frame
        assert frame is not None
        shades = frame.bg.copy()
        assert np.isin(shades, SHADES).any()
        for number in range(20):
            app.view.throttle.sent(1000.0 + number)
            app.view.throttle.answered(1000.0 + number + 0.04 * number)
        app.message_signal.publish(events.CursorPosition(0, 0))
        await pilot.pause()
        app.view.show(every[2])
        await painted(app)
        assert app.view.is_shaded
        frame = app.view.frame
        assert frame is not None
        assert np.isin(frame.bg, SHADES).sum() > 0.9 * np.isin(shades, SHADES).sum()
        floor = COLOR_SCHEMES["dark"].roles[Role.FLOOR]
        papers = {
            part.style.bgcolor.triplet
            for y in range(frame.shape[0])
            for part in app.view.render_line(y)
            if part.style is not None and part.style.bgcolor is not None
        }
        assert floor in papers

    in_terminal(app, script)
