"""The world as a widget: shows scenes, can be moved over them, and never outruns the link to the terminal."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Final

from textual import events
from textual.message import Message
from textual.timer import Timer

from kit.render.palettes import ANSI_PALETTE, Palette
from kit.render.roles import Role
from kit.tui.textual_patches import ask_cursor
from kit.tui.widgets.frame_view import FrameView

if TYPE_CHECKING:
    from kit.arrays import FloatArray
    from kit.render.camera import Camera
    from kit.render.encode import Encoder
    from kit.render.painter import Painter
    from kit.render.scene import Scene


TIMEOUT: Final = 2.0
"""Seconds after which an answer is no longer waited for."""

MOST_UNDER_WAY: Final = 3

SLOW, FAST = 10, 20
"""Frames per second."""

LAG_FOR_FAST, LAG_FOR_SLOW = 0.100, 0.130
"""Below the first lag [s] the fast rate is used, above the second the slow one, between them the same as before."""

CONGESTED: Final = 0.25
"""Seconds that pictures wait for each other, beyond the link's own delay, from which on fewer are under way at once."""
SETTLING, RECOVERY = 1.0, 10.0
"""Seconds after which still fewer are, and without such waits one more."""

DRAWING_SHARE: Final = 1 / 3
"""Most of this process's time that goes into drawing: where that takes long, the frames are fewer."""
LEAST: Final = 2
"""Frames per second that are drawn all the same."""

_SOON: Final = 1e-3
"""Seconds that make no difference: timers ring a little early or late."""
_SMOOTHING: Final = 0.2
_WINDOW: Final = 32
"""Answers over which the shortest counts as the link's own delay."""


@dataclass
class FrameThrottle:
    """Says when the next frame may be drawn. Times are seconds on any one steady clock.

    A slow machine and a slow link get fewer frames, never plainer ones, and as many as before once they are fast again.
    """

    fastest: int = FAST
    """Frames per second that are never exceeded."""

    def __post_init__(self) -> None:
        self._asked: deque[float] = deque()
        """When each open question was put."""
        self._lags: deque[float] = deque(maxlen=_WINDOW)
        self._most = MOST_UNDER_WAY
        """Frames under way at once that the link carries without waits."""
        self._changed_at = -math.inf
        """When that number was last changed."""
        self._lag = math.nan
        self._drawing = 0.0
        """Seconds that drawing takes, smoothed."""
        self._fps = min(SLOW, self.fastest)
        self._due = -math.inf
        self._deaf = False
        """It has never answered, so it is not waited for."""

    @property
    def lag(self) -> float | None:
        """Seconds from writing a frame to the terminal's having shown it, smoothed; None if it never answered."""
        return None if math.isnan(self._lag) else self._lag

    @property
    def fps(self) -> int:
        """Frames per second that the link has room for."""
        return self._fps

    @property
    def period(self) -> float:
        """Seconds between two frames, as link and machine allow."""
        return max(1 / self._fps, min(self._drawing / DRAWING_SHARE, 1 / LEAST))

    @property
    def allowed(self) -> int:
        """Frames that may be under way at once: as many as are shown during a round trip, and one."""
        if not self._lags:
            return 1
        return min(1 + math.ceil(min(self._lags) * self._fps), self._most)

    def wait(self, now: float) -> float:
        """Seconds until a frame may be drawn, if no answer arrives before."""
        self._give_up(now)
        wait = self._due - now
        if len(self._asked) >= self.allowed and not self._deaf:
            wait = max(wait, self._asked[0] + TIMEOUT - now)
        return wait if wait > _SOON else 0.0

    def _give_up(self, now: float) -> None:
        """Forgets all open questions when the oldest was put too long ago. Should they be answered after all,
        the answers are taken for later questions' until none is open: for so long the lag is underrated."""
        if self._asked and now - self._asked[0] >= TIMEOUT - _SOON:
            self._asked.clear()
            self._deaf = not self._lags

    def drawn(self, now: float, took: float = 0.0) -> None:
        """A frame was drawn, begun at ``now``. One that came late does not make the next one late."""
        self._drawing += _SMOOTHING * (took - self._drawing)
        self._due = max(self._due + self.period, now + self.period / 2)

    def sent(self, now: float) -> None:
        """It was written, and the question after it."""
        self._asked.append(now)

    def answered(self, now: float) -> None:
        """The terminal gave its cursor position. Answers come in the order of the questions."""
        self._give_up(now)
        if not self._asked:
            return
        self._deaf = False
        lag = now - self._asked.popleft()
        self._lags.append(lag)
        self._lag = lag if math.isnan(self._lag) else self._lag + _SMOOTHING * (lag - self._lag)
        if self._lag < LAG_FOR_FAST:
            self._fps = self.fastest
        elif self._lag > LAG_FOR_SLOW:
            self._fps = min(SLOW, self.fastest)
        self._adapt_most(now)

    def _adapt_most(self, now: float) -> None:
        """One frame less under way where they wait for each other, one more after a while in which they do not."""
        if self._lag - min(self._lags) > CONGESTED:
            if self._most > 1 and now - self._changed_at > SETTLING:
                self._most, self._changed_at = self._most - 1, now
        elif self._most < MOST_UNDER_WAY and now - self._changed_at > RECOVERY:
            self._most, self._changed_at = self._most + 1, now


class ErrorEvent(Message):
    """Something that the user asked for could not be done; ``text`` says what and why."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.text = text


class FloorClicked(Message):
    """The floor was clicked at a place [m, m]."""

    def __init__(self, place: tuple[float, float]) -> None:
        super().__init__()
        self.place = place


class WorldView(FrameView):
    """Shows scenes. It fits them to its size until it is told to zoom, pan or follow.

    ``offer`` paces itself: give it what makes the newest scene as often as there is news, and it draws as
    many as the terminal keeps up with.
    """

    DEFAULT_CSS = "WorldView { width: 1fr; height: 1fr; }"

    def __init__(
        self,
        find_encoder: Callable[[], Encoder] | None = None,
        palette: Palette = ANSI_PALETTE,
        *,
        clock: Callable[[], float] = time.monotonic,
        id: str | None = None,  # noqa: A002 - Textual's own name
        classes: str | None = None,
    ) -> None:
        """``find_encoder``: asked once, by the first scene; braille without it."""
        super().__init__(palette, id=id, classes=classes)
        self._find_encoder = find_encoder
        self._is_shaded = palette[Role.FLOOR].color is not None
        self.throttle = FrameThrottle()
        self._clock = clock
        self._scene: Scene | None = None
        self._camera: Camera | None = None
        self._fitted: FloatArray | None = None
        self._free = False
        self._followed: int | None = None
        self._offered: Callable[[], Scene] | None = None
        self._later: Timer | None = None

    @cached_property
    def _painter(self) -> Painter:
        from kit.render.encode import BrailleEncoder
        from kit.render.painter import Painter

        encoder = BrailleEncoder() if self._find_encoder is None else self._find_encoder()
        return Painter(encoder, shaded=self._is_shaded)

    @property
    def camera(self) -> Camera | None:
        """The part of the world that is shown; None before the first scene."""
        return self._camera

    @property
    def encoder(self) -> Encoder:
        """The encoder that makes characters of dots."""
        return self._painter.encoder

    @property
    def is_shaded(self) -> bool:
        """Whether the palette has colours for the floor and for what a laser sees of it."""
        return self._is_shaded

    @property
    def followed(self) -> int | None:
        """The number of the robot that is followed, from 0."""
        return self._followed

    def show(self, scene: Scene) -> bool:
        """Draws a scene, now; says whether anything looks different. The same scene again costs nothing."""
        if scene is self._scene:
            return False
        self._scene = scene
        return self._redraw()

    def clear(self) -> None:
        """Shows nothing until the next scene, which is fitted again."""
        self._scene = self._camera = self._fitted = self._offered = None
        self._free, self._followed = False, None
        self.show_nothing()

    def offer(self, make_scene: Callable[[], Scene]) -> None:
        """Draws what ``make_scene`` gives as soon as the link has room. Of several offers made meanwhile only
        the last is asked for its scene."""
        self._offered = make_scene
        self._draw_offered()

    def fit(self) -> None:
        """Shows all there is, and stops following."""
        self.fit_again()
        self._redraw()

    def fit_again(self) -> None:
        """Has the next scene be fitted, whatever is shown now; draws nothing."""
        self._free, self._followed, self._fitted = False, None, None

    def follow_at(self, cell_width: float) -> None:
        """Has the next scene be shown with the first robot in it, a character being so wide [m]; draws nothing."""
        if self._camera is not None:
            self._camera = replace(self._camera, cell_width=cell_width)
        self._free, self._followed = True, 0

    def zoom(self, steps: int) -> None:
        """Nearer, or farther if negative: about the middle, or about the robot that is followed."""
        self._move(lambda camera: camera.zoomed(steps))

    def pan(self, columns: int, rows: int) -> None:
        """Looks this many characters further to the right and up, and stops following."""
        self._followed = None
        self._move(lambda camera: camera.panned(columns, rows))

    def follow(self, robot: int | None = 0) -> None:
        """Keeps a robot in the calm middle of the picture; None stops that."""
        self._followed = robot
        self._move(lambda camera: camera)

    def on_mount(self) -> None:
        self.app.message_signal.subscribe(self, self._on_app_message, immediate=True)

    def on_resize(self, event: events.Resize) -> None:
        self._redraw()

    def on_click(self, event: events.Click) -> None:
        if self._camera is not None:
            event.stop()
            left, _, _, top = self._camera.bounds
            x = left + (event.x + 0.5) * self._camera.cell_width
            self.post_message(FloorClicked((x, top - (event.y + 0.5) * self._camera.cell_height)))

    def on_mouse_scroll_up(self, event: events.MouseScrollUp) -> None:
        event.stop()
        self.zoom(1)

    def on_mouse_scroll_down(self, event: events.MouseScrollDown) -> None:
        event.stop()
        self.zoom(-1)

    def _move(self, change: Callable[[Camera], Camera]) -> None:
        self._free = True
        if self._camera is not None:
            self._camera = change(self._camera)
            self._redraw()

    def _redraw(self) -> bool:
        columns, rows = self.size
        if self._scene is None or not columns or not rows:
            return False
        self._camera = self._current_camera(self._scene, columns, rows)
        return self.show_frame(self._painter.paint(self._scene, self._camera))

    def _current_camera(self, scene: Scene, columns: int, rows: int) -> Camera:
        from kit.render.camera import Camera

        camera = self._camera
        if camera is None or not self._free:
            # Redrawn only for other walls or another size: a scene's bounds may move with what moves in it.
            if (
                camera is None
                or self._fitted is not scene.walls
                or (camera.columns, camera.rows) != (columns, rows)
            ):
                camera = Camera.fit(scene.bounds, columns, rows)
                self._fitted = scene.walls
            return camera
        camera = camera.resized(columns, rows)
        robots = scene.robots
        if self._followed is not None and self._followed < len(robots):
            robot = robots[self._followed]
            camera = camera.following(*robot.pose.transform_point(*robot.extent.middle))
        return camera

    def withdraw(self) -> None:
        """Takes back what was offered and has not been drawn yet."""
        self._offered = None

    def _draw_offered(self) -> None:
        if self._offered is None or self._later is not None:
            return
        now = self._clock()
        wait = self.throttle.wait(now)
        if wait > 0:
            self._later = self.set_timer(wait, self._draw_later)
            return
        make_scene, self._offered = self._offered, None
        is_different = self.show(make_scene())
        self.throttle.drawn(now, self._clock() - now)
        if is_different:
            self.call_after_refresh(self._on_frame_sent)

    def _on_app_message(self, message: Message) -> None:
        """Handles, of the app's messages, the terminal's answers that it has shown a frame."""
        if isinstance(message, events.CursorPosition):
            self.throttle.answered(self._clock())
            if self._later is not None:
                self._later.stop()
            self._draw_later()

    def _draw_later(self) -> None:
        self._later = None
        self._draw_offered()

    def _on_frame_sent(self) -> None:
        """The frame has gone out to the terminal."""
        if ask_cursor(self.app):
            self.throttle.sent(self._clock())
