"""A scene that is played frame by frame: a learner on its grid, messages on their graph."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final

from textual import events
from textual.message import Message
from textual.timer import Timer

from kit.school.lessons.records import GraphScene, LearningScene
from kit.tui.theme import Theme
from kit.tui.widgets.frame_view import FrameView

if TYPE_CHECKING:
    from kit.school.lessons.graph_playback import GraphPlayback
    from kit.school.lessons.learning_playback import LearningPlayback


FRAME_S: Final = 0.1
"""Between two pictures [s]: as many as a slow link carries."""


class PlaybackSceneView(FrameView):
    """Shows one scene without a world at a time, the same each time it is shown: tables that learn, or nodes that send
    messages."""

    class Updated(Message):
        """There is a newer picture."""

    DEFAULT_CSS = "PlaybackSceneView { width: 1fr; height: 1fr; }"

    by_hand: Final = False
    """Nobody drives in it."""

    def __init__(self, theme: Theme) -> None:
        super().__init__(theme.palette, id="playback")
        self.scene: LearningScene | GraphScene | None = None
        self.playback: LearningPlayback | GraphPlayback | None = None
        self._encoder = theme.encoder
        self._reduces_motion = theme.terminal.reduce_motion.value
        self._timer: Timer | None = None
        self._shown_at = 0.0
        """When the last picture was shown [s]."""

    @property
    def is_open(self) -> bool:
        """Whether there is a picture."""
        return self.playback is not None

    @property
    def is_resting(self) -> bool:
        """Whether it has been played to its end."""
        return self.playback is not None and self.playback.is_over

    @property
    def rows(self) -> int:
        """Rows that it has a use for; 0: as many as there are."""
        return 0 if self.playback is None else self.playback.height

    @property
    def is_paused(self) -> bool:
        """Whether it stands still and could go on."""
        return self.is_open and self._timer is None and not self.is_resting

    @property
    def caption(self) -> str:
        """Says in a few words what it shows."""
        if self.playback is None:
            return ""
        if self.is_resting:
            return "finished"
        seconds = f"{int(self.playback.time_s)} of {self.playback.scene.seconds:g} s"
        return f"still, {seconds}" if self.is_paused else seconds

    def open(self, scene: LearningScene | GraphScene, *, still: bool) -> None:
        """Another scene, from its first instant on. ``still``: it stands there until ``go``."""
        from kit.school.lessons.graph_playback import GraphPlayback  # of no use to the first frame
        from kit.school.lessons.learning_playback import LearningPlayback

        self.scene = scene
        self.playback = GraphPlayback(scene) if isinstance(scene, GraphScene) else LearningPlayback(scene)
        self.set_paused(still)
        self.draw()

    def go(self) -> None:
        """Lets it play."""
        self.set_paused(False)

    def set_paused(self, paused: bool) -> None:
        """Stands still, or goes on."""
        if paused or self.playback is None or self.is_resting:
            self._stop_timer()
        elif self._reduces_motion:
            self.playback.advance_to(self.playback.scene.seconds)
            self.draw()
            self.post_message(self.Updated())
        elif self._timer is None:
            self._shown_at = time.monotonic()
            self._timer = self.set_interval(FRAME_S, self._advance)

    def step(self) -> None:
        """Stands still, and makes one update of each table, or moves the messages by one place."""
        if self.playback is not None:
            self.set_paused(True)
            self.playback.step()
            self.draw()
            self.post_message(self.Updated())

    def replay(self) -> None:
        """The same from its first instant on, running."""
        if self.scene is not None:
            self._stop_timer()
            self.open(self.scene, still=False)

    def close_session(self) -> None:
        """No scene any more."""
        self._stop_timer()
        self.scene = self.playback = None
        self.show_nothing()

    def draw(self) -> None:
        """The tables or the graph as they are now."""
        columns, rows = self.size
        if self.playback is not None and columns and rows > 1:
            self.show_frame(self.playback.frame(columns, rows, self._encoder))

    def on_resize(self, event: events.Resize) -> None:
        self.draw()

    def _advance(self) -> None:
        """A slow terminal gets fewer pictures, and the scene takes as long."""
        if self.playback is None:
            return
        now = time.monotonic()
        self.playback.advance_to(self.playback.time_s + now - self._shown_at)
        self._shown_at = now
        if self.is_resting:
            self._stop_timer()
        self.draw()
        self.post_message(self.Updated())

    def _stop_timer(self) -> None:
        if self._timer is not None:
            self._timer.stop()
            self._timer = None
