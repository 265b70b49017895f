"""The middle of a lesson's screen: its scene first, the words below or beside it, what is asked always in sight."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Final

from textual import events
from textual.app import ComposeResult
from textual.containers import Container
from textual.message import Message
from textual.timer import Timer
from textual.widget import Widget

from kit.controllers import find_controller
from kit.document.rows import Row, row
from kit.render.encode import AsciiEncoder
from kit.render.roles import Role
from kit.render.scene import Scene as Picture
from kit.run.lockstep import Observer
from kit.run.view import View
from kit.school.lessons.records import GraphScene, LearningScene, LessonScene, scene_confinement_level
from kit.tui.session_host import SessionHost
from kit.tui.theme import Theme
from kit.tui.widgets.frame_view import FrameView
from kit.tui.widgets.text_rows import TextRows
from kit.tui.widgets.world_view import ErrorEvent, WorldView

if TYPE_CHECKING:
    from kit.render.camera import Camera
    from kit.run.recording import Recording
    from kit.run.runner import Runner
    from kit.run.scenario import Scenario
    from kit.run.session import Session
    from kit.school.lessons.graph_playback import GraphPlayback
    from kit.school.lessons.learning_playback import LearningPlayback
    from kit.sim.simulation import Simulation


TELEOP: Final = "teleop"
ASCII_WALL: Final = AsciiEncoder.shapes[Role.WALL]
MOST_WALL: Final = 0.6
"""The share of a picture in ASCII that may be wall: beyond it no passage is seen any more."""
READABLE_ROW: Final = 0.25
"""Height of a row in which passages of half a metre are seen [m]."""
UNSEEN_FACTOR: Final = 10.0
"""Simulated seconds a second of a scene of which the beginning and the end alone are shown."""


class LessonSceneView(WorldView):
    """Shows one scene at a time. ``folder``: the student's controllers; ``socket_dir``: where other terminals look in."""

    class Moved(Message):
        """There is a newer view."""

    DEFAULT_CSS = "LessonSceneView { width: 1fr; height: 1fr; }"

    def __init__(self, theme: Theme, folder: Path, socket_dir: Path | None = None) -> None:
        super().__init__(lambda: theme.encoder, theme.palette, id="scene")
        self.view: View | None = None
        """The newest; None before the first of a scene."""
        self.scene: LessonScene | None = None
        self._folder = folder
        self._reduces_motion = theme.terminal.reduce_motion.value
        self._is_drawn = False
        """Whether any view of this scene was drawn."""
        self._picture: Picture | None = None
        self._announced = self._opening = False
        self._decided_for: object = None
        self._decided_size = (0, 0)
        """The walls and the size for which it was decided whether all of the world is shown."""
        self._recording: tuple[Recording, Scenario] | None = None
        """What is played again, where the scene is a recorded run."""
        self._host = SessionHost(
            on_view=self._view_arrived, on_error=self._error_arrived, socket_dir=socket_dir
        )

    @property
    def is_recorded(self) -> bool:
        """Whether it is a recorded run that is played again."""
        return self._recording is not None

    @property
    def by_hand(self) -> bool:
        """Whether the student drives in it. Then it never rests."""
        return self.scene is not None and self.scene.controller == TELEOP

    @property
    def is_resting(self) -> bool:
        """Whether it has run for as long as it is to run."""
        return (
            self.scene is not None
            and self.view is not None
            and self.view.paused
            and not self.by_hand
            and self.view.time_s >= self.scene.seconds - 1e-6
        )

    @property
    def is_open(self) -> bool:
        """Whether there is a view."""
        return self.view is not None and self.view.failure is None

    @property
    def caption(self) -> str:
        """Says in a few words what it shows."""
        if self.scene is None:
            return ""
        if self.view is None:
            return "opening ..."
        if self.view.failure is not None:
            return "the controller has stopped"
        if self.is_resting:
            return "your run: w shows it again" if self.is_recorded else "finished"
        run = "your run: " if self.is_recorded else ""
        return f"{run}{int(self.view.time_s)} of {self.scene.seconds:.3g} s"

    def open(self, scene: LessonScene, *, still: bool) -> None:
        """Another scene, from its first instant on. ``still``: it stands there until ``go``."""
        if self.scene is None or (scene.map_name, scene.case) != (self.scene.map_name, self.scene.case):
            self.clear()  # not the place of the step before
        self._recording = None
        self.scene, self.view, self._opening = scene, None, True
        folder, by_hand = self._folder, self.by_hand

        def make() -> Session:
            """Called in the helper thread, which imports the physics while the words are on the screen already."""
            from kit.run.scenario import find_scenario
            from kit.run.session import Session

            session = Session(
                find_scenario(scene.map_name, scene.case),
                seed=scene.seed,
                always_scan=True,
                level=scene_confinement_level(scene),
            )
            try:
                if scene.controller:
                    session.drive_with(find_controller(scene.controller, folder))
                    session.wait_until_driven()  # it drives from the first tick on, so that each time is the same
            except BaseException:  # also a cancelled worker: the world is closed; raised again
                session.close()
                raise
            runner = session.runner
            if not by_hand:
                runner.observers.append(
                    _PauseAtEnd(runner, round(scene.seconds / runner.simulation.step_size))
                )
            runner.paused = still
            self._opening = False
            return session

        self._is_drawn = False
        self._host.open_session(make, lambda session: self._factor)

    @property
    def _factor(self) -> float:
        """How much faster than real time it runs: a scene that is not seen to move need not take as long."""
        return UNSEEN_FACTOR if self._reduces_motion and not self.by_hand else 1.0

    def play(self, recording: Recording, place: Scenario, *, still: bool = False) -> None:
        """A recorded run from its first instant to its last. ``still``: it stands there until ``go``."""
        seconds = recording.ticks * recording.step_size
        if self.scene is None or (place.name, recording.case) != (self.scene.map_name, self.scene.case):
            self.clear()
        self.scene = LessonScene(place.name, recording.case, "", recording.seed, seconds)
        self._recording = recording, place
        self.view, self._opening = None, True

        def make() -> Session:
            """Called in the helper thread."""
            from kit.run.session import Session

            session = Session(place, seed=recording.seed, step_size=recording.step_size, always_scan=True)
            session.play_back(recording)
            session.runner.tick()  # what was put elsewhere before it began stands there now
            session.runner.paused = still
            self._opening = False
            return session

        self._is_drawn = False
        self._host.open_session(make, lambda session: self._factor)

    def go(self) -> None:
        """Lets it run."""
        self._host.set_paused(False)

    def hold(self, held: bool) -> None:
        """Stands still while something else is looked at."""
        if self.view is not None and not self.is_resting:
            self._host.set_paused(held)

    def again(self) -> None:
        """The same from its first instant on, running."""
        if self._recording is not None:
            self.play(*self._recording)
        elif self.scene is not None:
            self.open(self.scene, still=False)

    def close_session(self) -> None:
        """No scene any more."""
        self.scene = self.view = self._recording = None
        self._host.close_session()

    def press(self, messages: tuple[str, ...], strength: float) -> None:
        """Hands driving keys to whoever listens in the scene."""
        self._host.post(lambda session: session.keys.publish(messages, strength))

    def draw(self) -> None:
        """The newest view, as soon as the link has room."""
        if self.view is not None:
            self.offer(self._newest)

    def _current_camera(self, scene: Picture, columns: int, rows: int) -> Camera:
        """All of the world; where that is little but wall, a part that is large enough for its passages, with the robot."""
        if self.encoder.across * self.encoder.down > 1:
            return super()._current_camera(scene, columns, rows)
        if self._decided_for is scene.walls and self._decided_size == (columns, rows):
            return super()._current_camera(scene, columns, rows)
        self._decided_for, self._decided_size = scene.walls, (columns, rows)
        self.fit_again()
        self._camera = camera = super()._current_camera(scene, columns, rows)
        drawn = "".join(each.strip() for each in self._painter.paint(scene, camera).rows())
        if drawn and drawn.count(ASCII_WALL) > MOST_WALL * len(drawn):
            self.follow_at(READABLE_ROW / camera.aspect)
            camera = super()._current_camera(scene, columns, rows)
        return camera

    def on_unmount(self) -> None:
        self._host.close()

    def _newest(self) -> Picture:
        assert self._picture is not None  # nothing is offered before the first view
        return self._picture

    def _view_arrived(self, view: View) -> None:
        """Keeps a view and announces it; called in the world's thread."""
        if self._opening:  # still of the one before
            return
        self.view = view
        if not self._reduces_motion or self.by_hand or view.paused or not self._is_drawn:
            self._picture, self._is_drawn = view.scene, True
        if not self._announced:  # the newest wins: one announcement at a time is enough
            self._announced = True
            self.post_message(self.Moved())

    def _error_arrived(self, text: str) -> None:
        if self._opening:  # the one before would run on
            self._host.close_session()
        self.post_message(ErrorEvent(text))

    def on_lesson_scene_view_moved(self) -> None:
        self._announced = False
        if self.screen.is_active:
            self.draw()


class _PauseAtEnd(Observer):
    """Watches a runner, and has it stand still from a tick on."""

    def __init__(self, runner: Runner, ticks: int) -> None:
        self._runner = runner
        self._ticks = ticks

    def on_step(self, simulation: Simulation) -> None:
        if simulation.tick >= self._ticks:
            self._runner.pause()


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
        self.hold(still)
        self.draw()

    def go(self) -> None:
        """Lets it play."""
        self.hold(False)

    def hold(self, held: bool) -> None:
        """Stands still, or goes on."""
        if held or self.playback is None or self.is_resting:
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
            self.hold(True)
            self.playback.step()
            self.draw()
            self.post_message(self.Updated())

    def again(self) -> None:
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


LEAST_PICTURE: Final = 8
MOST_PICTURE: Final = 14
"""Rows of a scene above the words."""
LEAST_WORDS: Final = 3
"""Rows of the words below it, on the smallest screen."""
LINES_SEEN: Final = 2
"""Rows of a verdict or a hint that are brought into sight."""
BESIDE: Final = 82
"""Columns of the words, where the picture is beside them."""


ROOMY_SIZE: Final = (120, 36)
"""Columns and rows from which on the scene, the file and its log stand beside the words, all at once."""
COLUMNS_WIDTH: Final = 180
"""Columns from which on the file has a column of its own."""
MOST_LOG: Final = 8
"""Rows of what the program printed."""


class PageLayout(Enum):
    """The places of the page's parts."""

    STACKED = "-stacked"
    """The picture above the words."""
    BESIDE = "-beside"
    """The picture beside the words."""
    ROOMY = "-roomy"
    """The scene, the file and its log beside the words."""

    @classmethod
    def of(cls, width: int, height: int, *, is_wide: bool) -> PageLayout:
        """Computes the layout for a screen of so many columns and rows."""
        if width >= ROOMY_SIZE[0] and height >= ROOMY_SIZE[1]:
            return cls.ROOMY
        return cls.BESIDE if is_wide else cls.STACKED


@dataclass(frozen=True, slots=True)
class LessonContent:
    """The contents of a lesson's page."""

    words: Sequence[Row]
    asked: Sequence[Row] = ()
    """Below the words, always in sight."""
    picture: Sequence[str] = ()
    """Fixed characters, in place of a scene."""
    moves: LessonSceneView | PlaybackSceneView | None = None
    """The scene that is seen, if any."""
    moves_rows: int = 0
    """Rows that the scene has a use for; 0: as many as there are."""
    first_words: int = 0
    """Rows of words that the picture leaves room for, as far as it can."""
    most_words: int = 0
    """Rows of words there may be in this step: so many are kept free above what is asked, so that it never moves."""
    scrolls_with: str = "down"
    """The key that shows more words."""
    file: Sequence[Row] = ()
    """The student's file, line by line; shown where there is room."""
    file_title: str = ""
    file_line: int = 0
    """The line of it to look at first, counted from 0."""
    log: Sequence[Row] = ()
    """What the student's program printed."""


class LessonPage(Container):
    """``scenes``: are opened and shut by whoever owns the sheet; one of them is seen at a time."""

    DEFAULT_CSS = f"""
    LessonPage {{ height: 1fr; layout: vertical; }}
    LessonPage #left, LessonPage #stage {{ height: auto; layout: vertical; }}
    LessonPage #picture {{ height: auto; }}
    LessonPage #words {{ height: 1fr; }}
    LessonPage #ask {{ height: auto; }}
    LessonPage #right {{ height: 1fr; layout: vertical; }}
    LessonPage #work {{ display: none; }}
    LessonPage #log {{ display: none; height: auto; }}
    LessonPage.-beside, LessonPage.-roomy {{ layout: horizontal; }}
    LessonPage.-beside #left, LessonPage.-roomy #left {{ width: 1fr; height: 1fr; }}
    LessonPage.-beside #stage, LessonPage.-roomy #stage {{ height: 1fr; }}
    LessonPage.-beside #right, LessonPage.-roomy #right {{ width: {BESIDE}; }}
    LessonPage.-roomy.-work #work {{ display: block; width: 1fr; height: 1fr; }}
    LessonPage.-roomy.-work #log {{ display: block; }}
    LessonPage #work, LessonPage #log {{ padding: 0 1 0 0; }}
    LessonPage.-roomy.-still #stage {{ height: auto; }}
    LessonPage.-roomy.-columns #left {{ layout: horizontal; }}
    LessonPage.-roomy.-columns #stage {{ width: 1fr; }}
    LessonPage.-roomy.-columns.-still #stage {{ height: 1fr; }}
    """

    def __init__(self, *scenes: LessonSceneView | PlaybackSceneView) -> None:
        super().__init__()
        self._scenes = scenes
        self._texts = {name: TextRows(id=name) for name in ("picture", "log", "work", "words", "ask")}
        """Made at once: the screen may be given its size, and fill them, before they are mounted."""
        self._content = LessonContent(())
        self._top = 0
        self._offset = 0
        """Rows of the picture that stand above the words and scroll with them."""
        self._room = 1
        self._heights: dict[str, int | str] = {}

    def compose(self) -> ComposeResult:
        with Container(id="left"):
            with Container(id="stage"):
                yield from self._scenes
                yield self._texts["picture"]
                yield self._texts["log"]
            yield self._texts["work"]
        with Container(id="right"):
            yield self._texts["words"]
            yield self._texts["ask"]

    def show(self, content: LessonContent, room: int, layout: PageLayout) -> None:
        """``room``: rows there are for all of it."""
        is_roomy = layout is PageLayout.ROOMY
        has_work = bool(content.file_title) and is_roomy
        picture = [row("  " + line) for line in content.picture]
        self._offset = len(picture) if is_roomy else 0
        if is_roomy:  # a picture may be wider than what is left beside the words
            content, picture = replace(content, words=[*picture, *content.words], picture=()), []
        self._content = content
        has_picture = content.moves is not None or bool(picture)
        is_beside = layout is not PageLayout.STACKED and (has_picture or has_work)
        self.set_class(is_beside and not is_roomy, "-beside")
        self.set_class(is_beside and is_roomy, "-roomy")
        self.set_class(has_work, "-work")
        self.set_class(content.moves is None, "-still")
        self.set_class(self.size.width >= COLUMNS_WIDTH, "-columns")
        self._rows("picture").show_all(picture)
        self._rows("picture").display = bool(picture)
        for scene in self._scenes:
            scene.display = scene is content.moves
        self._rows("ask").show_all(content.asked)
        asked = len(content.asked)
        least = min(LEAST_PICTURE, max(room - asked - LEAST_WORDS, 4))
        rows = min(max(room - content.first_words - asked, least), content.moves_rows or MOST_PICTURE)
        if content.moves is not None:
            self._set_height(content.moves, "1fr" if is_beside else rows)
        used = 0 if is_beside else rows if content.moves is not None else len(picture)
        self._room = max(1, room - used - asked)
        kept = max(content.most_words, len(content.words))
        self._set_height(self._rows("words"), min(kept, self._room) if content.asked else "1fr")
        self._show_words()
        if has_work:
            self.call_after_refresh(self._show_work, content)  # then it has the height that it will have

    def _show_work(self, content: LessonContent) -> None:
        """The student's file, around the line to look at, and the end of what the program printed."""
        log = content.log[-MOST_LOG + 1 :]
        self._rows("log").show_all([row(("What it printed", "bold")), *log] if log else [])
        work = self._rows("work")
        room = max(1, work.size.height - 1)
        top = max(0, min(content.file_line - room // 3, len(content.file) - room))
        more = f"  lines {top + 1} to {min(len(content.file), top + room)} of {len(content.file)}"
        head = row((content.file_title, "bold"), (more if len(content.file) > room else "", "dim"))
        work.show([head, *content.file[top : top + room]])

    def scroll_words(self, lines: int) -> None:
        """Scrolls by lines, at most by a page so that none is skipped; by more than there are, to the end."""
        page = max(1, self._room - 1)  # the last row may say that more follows
        self._top += lines if abs(lines) > len(self._content.words) else max(-page, min(lines, page))
        self._show_words()

    def scroll_words_to(self, line: int) -> None:
        """Scrolls so that a line and as much as possible of what follows is in sight."""
        self._top = line + self._offset if line else 0
        self._show_words()

    def scroll_words_into_sight(self, line: int) -> None:
        """Scrolls as little as needed to show a line and a few below it; the last row may say that more follows."""
        most, top = max(0, self._room - LINES_SEEN - 1), self._top - self._offset
        if not top <= line <= top + most:
            self.scroll_words_to(max(0, line - most) if line > top else line)

    def _set_height(self, widget: Widget, height: int | str) -> None:
        """Sets the height in rows, or as a share of the rest. Setting it again costs nothing."""
        assert widget.id is not None
        if self._heights.get(widget.id) != height:
            self._heights[widget.id] = widget.styles.height = height

    def _show_words(self) -> None:
        words = self._content.words
        self._top = max(0, min(self._top, len(words) - self._room))
        shown = list(words[self._top : self._top + self._room])
        below = len(words) - self._top - len(shown)
        if below > 0 and shown:
            shown[-1] = row((f"  ... {below + 1} more lines: {self._content.scrolls_with}", "dim"))
        self._rows("words").show(shown)

    def _rows(self, name: str) -> TextRows:
        return self._texts[name]
