"""The screen of a lesson: one step at a time, the picture first; nothing moves on by itself."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar

from textual import events, work
from textual.app import ComposeResult
from textual.binding import BindingType

from kit.dialogue.actions import ScreenAction, ScreenActions, digits, letter
from kit.document.rows import Row, row
from kit.inspection.sockets import sockets_folder
from kit.run.scenario import Scenario
from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.records import CommandKind, LessonCommand, LessonStep, PredictionOption
from kit.school.lessons.shell_lines import TITLE as SECOND_TERMINAL
from kit.school.lessons.shell_lines import fill_in_paths, second_terminal_here
from kit.school.lessons.translation import missing_translation_text
from kit.school.progress import ProgressError
from kit.tui.exercise_model import ExerciseModel
from kit.tui.input.drive import DriveState
from kit.tui.input.driver import KeyRepeated
from kit.tui.input.modes import base_key, named
from kit.tui.input.screen import DriveScreen
from kit.tui.rows import lesson_rows
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.screens.dialogs import HelpDialog, MessageDialog, Picker, PickerItem, TextScreen, wrapped
from kit.tui.screens.lesson_exercise import ExerciseListener, ExercisePanel
from kit.tui.screens.quiz import ask_of_lesson
from kit.tui.suspend import plain_lines, run_aside
from kit.tui.theme import Theme
from kit.tui.widgets.lesson_page import (
    BESIDE,
    LessonContent,
    LessonPage,
    LessonSceneView,
    PageLayout,
    PlaybackSceneView,
)
from kit.tui.widgets.text_rows import RowsScreen, TextRows
from kit.tui.widgets.world_view import ErrorEvent
from kit.workspace import Workspace

if TYPE_CHECKING:
    from kit.run.recording import Recording

ARROWS = ("up", "down", "left", "right")
HELD = (*ARROWS, "pageup", "pagedown", "space")
"""Keys that do more the longer they are held."""
POLL_S = 0.2
"""Seconds between two polls of the exercise's file and its check."""
ENDING_IDS = frozenset(("next", "questions", "previous", "help", "back"))
"""Actions after the last step."""
BREAKPOINTS = [(0, "-usual"), (130, "-wide")]


class LessonScreen(RowsScreen[None], DriveScreen):
    """Shows one lesson, step by step. Redraws only what a key, a scene or a check has changed."""

    AUTO_FOCUS = ""
    screen_actions = ScreenActions(
        "lesson",
        (
            "predict", "drive_scene", "check", "edit_file", "hint", "drive", "replay", "solution", "next",
            "defend", "run_command", "second_terminal", "output", "questions", "previous", "restart",
            "pause", "step", "start_over", "help", "back",
        ),
        ("steps", "scroll", "quit"),
        own=(
            ScreenAction("predict", "1 2 3 4", "predict", "predict; your first choice counts", digits("predict", 1, 4), "1-4"),
            ScreenAction("drive_scene", "arrows", "drive", "drive the robot, in a scene that waits for you", (), "←↑↓→"),
            letter("run_command", "o", "run", "run a command of this step here"),
            letter("questions", "k", "questions", "answer the lesson's questions, after its last step"),
        ),
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    DEFAULT_CSS = """
    LessonScreen { layout: vertical; }
    LessonScreen #heading, LessonScreen #title, LessonScreen #keys { height: 1; }
    """
    HORIZONTAL_BREAKPOINTS = BREAKPOINTS

    def __init__(self, theme: Theme, session: LessonSession, workspace: Workspace) -> None:
        super().__init__(theme.terminal)
        self.theme = theme
        self.visit = session
        self.workspace = workspace
        self.step: LessonStep = session.first_step
        self._opening_step = self.step
        """Where it is said that the lesson is in another language than the one asked for."""
        self._exercise = ExercisePanel(
            theme, workspace, ExerciseListener(self.show, self.show_answer, self.show_run, self.show_error)
        )
        self._world_scene = LessonSceneView(theme, workspace.controllers, sockets_folder(workspace.folder))
        self._playback_scene = PlaybackSceneView(theme)
        self._is_answer_shown = True
        """Whether what there is to say of a prediction may be said: the scene has been seen."""
        self.is_over = False
        self._following: LessonSession | None = None
        """The next lesson, once this one is over."""
        self._page = LessonPage(self._world_scene, self._playback_scene)
        self._answer_row = self._lost_row = self._hint_row = 0
        self._strength = 1.0
        self._allowed_lines: set[str] = set()
        """Commands of somebody else's lesson that the student has seen and let run."""

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        yield TextRows(id="title")
        yield self._page
        yield self._exercise
        yield TextRows(id="keys")

    def on_mount(self) -> None:
        self.set_interval(POLL_S, self._exercise.poll)
        self.enter(self.step)

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self.show)

    def on_screen_resume(self) -> None:
        self.hold_scene(False)
        self._scene.draw()
        self.show()

    def on_screen_suspend(self) -> None:
        self.hold_scene(True)

    def hold_scene(self, held: bool) -> None:
        """Has the scene stand still while something else is looked at, or go on if it was going."""
        self._scene.hold(held or self._is_still)

    # Steps

    @property
    def model(self) -> ExerciseModel | None:
        """The step's exercise; None where it has none."""
        return self._exercise.model

    @property
    def _scene(self) -> LessonSceneView | PlaybackSceneView:
        """The scene that is shown in this step."""
        if self.step.playback_scene is None or self._world_scene.is_recorded:
            return self._world_scene
        return self._playback_scene

    @property
    def chosen(self) -> PredictionOption | None:
        """The prediction that was made in this step."""
        return self.visit.prediction(self.step)

    @property
    def _has_scene(self) -> bool:
        """Whether something moves in this step: its own scene, or the student's run."""
        return not self.is_over and (self.step.moves or self._world_scene.is_recorded)

    @property
    def _is_waiting(self) -> bool:
        """Whether the step waits for a prediction."""
        return bool(self.step.options) and self.chosen is None

    @property
    def _is_still(self) -> bool:
        """Whether the scene is to stand at its first instant: until a prediction, or until it is opened to be driven."""
        return self._begins_still and not self._world_scene.is_recorded

    @property
    def _begins_still(self) -> bool:
        """The same of the step's own scene, whatever is shown."""
        return self._is_waiting or (self.model is not None and self.model.by_hand)

    @property
    def _is_driving(self) -> bool:
        """Whether the arrow keys drive in the scene."""
        return self._scene.by_hand and not self._is_still

    @property
    def _is_playing_back(self) -> bool:
        """Whether tables learn or messages move in the picture, or would if they were not held."""
        return self.step.playback_scene is not None and not self._is_still and not self.is_over

    def enter(self, step: LessonStep) -> None:
        """Shows a step from its beginning."""
        self.step, self.is_over = step, False
        self._page.scroll_words_to(0)
        self._is_answer_shown = not self._is_waiting
        self._exercise.enter(self.visit, step)
        self._open_scene()
        self.show()

    def _open_scene(self) -> None:
        """The step's own scene from its beginning, if it has one."""
        if self.step.scene is not None:
            self._world_scene.open(self.step.scene, still=self._begins_still)
        else:
            self._world_scene.close_session()
        if self.step.playback_scene is not None:
            self._playback_scene.open(self.step.playback_scene, still=self._begins_still)
        else:
            self._playback_scene.close_session()

    def show_error(self, title: str, text: str) -> None:
        """Shows an error as a page over the step."""
        self.app.push_screen(MessageDialog(title, wrapped(text)))

    # What is shown

    def show(self) -> None:
        """Everything, as it stands now. Rows that are the same cost nothing."""
        width = self.size.width
        if not width or not self.is_mounted:
            return
        over, step = self.is_over, self.step
        exercise_rows = self._exercise.show(width)
        self._rows("heading").show([lesson_rows.heading(self.visit.lesson_progress, step, width)])
        self._show_title()
        self._rows("keys").show(
            [self._exercise.busy_keys(self.screen_actions, width) or self._key_row(width)]
        )
        written = self._text_rows()
        answer = self._longest_answer()
        is_roomy = self._layout is PageLayout.ROOMY
        hides_work = over or self._world_scene.is_recorded
        shown = [] if hides_work else self._exercise.work_picture(self._width - 2, is_roomy=is_roomy)
        picture = shown or step.picture.splitlines()
        content = LessonContent(
            written,
            [] if over or not step.options else self._question_rows(),
            () if over or self._world_scene.is_recorded else tuple(picture),
            moves=self._scene if self._has_scene and not shown else None,
            # Not all at once, where there is little room.
            moves_rows=self._graph_rows,
            first_words=max(self._answer_row, answer, len(written) - self._answer_row),
            most_words=self._answer_row + answer,
            scrolls_with="PgDn" if self._is_driving else "down",
        )
        if is_roomy:
            content = self._exercise.with_work(content)
        self._page.show(content, self.size.height - 3 - exercise_rows, self._layout)

    def _show_title(self) -> None:
        self._rows("title").show(
            [row() if self.is_over else lesson_rows.title(self.step, self._caption(), self.size.width)]
        )

    def _text_rows(self) -> list[Row]:
        """The words of the step, and below them what is said to what the student did."""
        if self.is_over:
            following = self._following.lesson if self._following is not None else None
            levels = self.visit.opened_levels()
            return lesson_rows.ending(self.visit.lesson_progress, self._width, following, levels)
        text = self.with_paths(self.step.text)
        filled = [
            (each, line) for each in self.step.commands if (line := self.with_paths(each.line)) not in text
        ]
        made = [row(), *self._language_rows(), *lesson_rows.words(text, self._width)]
        made += lesson_rows.commands(filled, self._width)
        self._answer_row = len(made)
        if self.chosen is not None and self._is_answer_shown:
            made += lesson_rows.feedback(self.step, self.chosen, self._width)
        model, self._lost_row, self._hint_row = self.model, 0, 0
        if model is not None and model.report is not None and model.seconds is None:
            said = lesson_rows.verdict(model.report, self.visit.opened_hints(model.exercise), self._width)
            self._lost_row = len(made) + said.first_lost if said.first_lost else 0
            self._hint_row = len(made) + said.last_hint if said.last_hint else 0
            made += said.rows
        return made

    def _language_rows(self) -> list[Row]:
        missing = self.visit.lesson.missing_language if self.step is self._opening_step else ""
        return [*lesson_rows.words(missing_translation_text(missing), self._width), row()] if missing else []

    def _longest_answer(self) -> int:
        """Rows of the longest thing that may be said to a prediction."""
        answers = (len(lesson_rows.feedback(self.step, option, self._width)) for option in self.step.options)
        return max(answers, default=0)

    def _question_rows(self) -> list[Row]:
        return [row(), *lesson_rows.question(self.step, self.chosen, self._is_answer_shown, self._width)]

    def _caption(self) -> Row:
        """The state of the scene, or what is said to a key that does nothing now."""
        if self._exercise.step_notice is not None:
            return self._exercise.step_notice
        state = ""
        if self._has_scene:
            state = self._scene.caption
            if self._is_waiting and self._scene.is_open:
                state = "waiting for your prediction"
            elif self._scene.by_hand and self._scene.is_open:
                state = "you drive" if self._is_driving else "press d to drive"
        return row((state, "dim"))

    def _key_row(self, width: int) -> Row:
        """The keys that do something now."""
        if self.is_over:
            ended = ENDING_IDS if self._following is not None else ENDING_IDS - {"next"}
            return footer(
                self.screen_actions,
                width,
                without=set(self.screen_actions.footer) - ended,
                labels={"next": "next lesson"},
            )
        can = {
            "predict": self._is_waiting,
            "drive_scene": self._is_driving,
            "next": not self._is_waiting,
            "second_terminal": any(each.kind is CommandKind.BESIDE for each in self.step.commands),
            "run_command": bool(self.step.runnable_commands),
            "questions": False,
            "previous": self.step.number > 1,
            "restart": self._has_scene and not self._is_still,
            "pause": self._is_playing_back and not self._playback_scene.is_resting,
            "step": self._is_playing_back and self._playback_scene.is_paused,
            **self._exercise.possible_actions(),
        }
        return footer(
            self.screen_actions,
            width,
            without=[each for each, possible in can.items() if not possible],
            keys={"predict": f"1-{len(self.step.options)}"},
        )

    @property
    def _width(self) -> int:
        """Width of the words."""
        return self.size.width if self._layout is PageLayout.STACKED else min(self.size.width, BESIDE)

    @property
    def _graph_rows(self) -> int:
        """Rows of the step's graph; 0: none is shown, and a scene takes the rows that there are."""
        is_played = self._has_scene and self._scene is self._playback_scene
        return self._playback_scene.rows if is_played else 0

    @property
    def _layout(self) -> PageLayout:
        if self._graph_rows:  # is low, and as wide as the screen
            return PageLayout.STACKED
        return PageLayout.of(self.size.width, self.size.height, is_wide=self.has_class("-wide"))

    def with_paths(self, text: str) -> str:
        """Inserts the student's own paths."""
        return fill_in_paths(text, None if self.model is None else self.model.file)

    def show_answer(self) -> None:
        """Scrolls to what is said to what the student did: to a new hint, or to the first criterion that is lost."""
        if self._world_scene.is_recorded and not (
            self.model and self.model.report and self.model.report.is_passed
        ):
            self._open_scene()
        self.show()
        self._page.scroll_words_to(self._answer_row)
        if self._hint_row:
            self._page.scroll_words_into_sight(self._hint_row)
        elif self._lost_row:
            self._page.scroll_words_into_sight(self._lost_row)

    def show_run(self, recording: Recording, place: Scenario) -> None:
        """Plays the student's own run, in place of the scene."""
        self._world_scene.play(recording, place)
        self.show_answer()

    # The scene

    def on_playback_scene_view_updated(self) -> None:
        self.on_lesson_scene_view_moved()

    def on_lesson_scene_view_moved(self) -> None:
        if not self.is_active:
            return
        if not self._is_answer_shown and not self._is_waiting and self._scene.is_resting:
            self._reveal_answer()
        self._rows("title").show(
            [row() if self.is_over else lesson_rows.title(self.step, self._caption(), self.size.width)]
        )

    def on_error_event(self, event: ErrorEvent) -> None:
        self.show_error("The scene cannot be shown", event.text)
        if not self._is_waiting:
            self._reveal_answer()

    def is_drive_key(self, key: str) -> bool:
        return self._is_driving and base_key(key) in ARROWS

    def drive_keys_changed(self, messages: tuple[str, ...], state: DriveState) -> None:
        strength = max((push for name, push in state.held.items() if named(name).moves), default=1.0)
        if (messages or strength != self._strength) and self._is_driving:
            self._world_scene.press(messages, strength)
        self._strength = strength

    # Keys

    def on_key(self, event: events.Key) -> None:
        if event.key != "enter" and self._exercise.cancel_start_over():
            event.stop()
            event.prevent_default()
        else:
            self._exercise.drop_step_notice()

    def on_key_repeated(self, event: KeyRepeated) -> None:
        """A key that is held scrolls and drives; it does not go on and on."""
        if not self.is_drive_key(event.key) and base_key(event.key) not in HELD:
            event.prevent_default()

    def action_predict(self, number: int) -> None:
        if not self._is_waiting or number > len(self.step.options):
            return
        try:
            self.visit.predict(self.step, number - 1)
        except ProgressError as error:
            self.show_error("Your prediction could not be saved", str(error))
            return
        if self.step.moves and self._scene.is_open:
            self._scene.go()
            self.show()
        else:
            if self.step.moves:
                self._scene.again()
            self._reveal_answer()

    def _reveal_answer(self) -> None:
        self._is_answer_shown = True
        self.show_answer()

    def action_next(self) -> None:
        if self._exercise.confirm_start_over():
            return
        if self.is_over:
            if self._following is not None:
                is_told = bool(self.visit.lesson.missing_language)
                self.visit, self._following = self._following, None
                self._opening_step = self._opening_step if is_told else self.visit.first_step
                self.enter(self.visit.first_step)
            return
        if self._is_waiting:
            self._exercise.notify_row(
                f"Predict first: press 1 to {len(self.step.options)}. A wrong guess costs nothing.", "warn"
            )
            return
        if not self._is_answer_shown:
            self._reveal_answer()
            return
        if self.step.exercise is None:
            try:
                self.visit.complete_step(self.step)
            except ProgressError as error:
                self.show_error("This step could not be saved", str(error))
                return
        if self.step.number == len(self.visit.lesson.steps):
            self._exercise.close()
            self._world_scene.close_session()
            self._playback_scene.close_session()
            self.is_over = True
            self._following = self.visit.following()
            self.show()
            self._page.scroll_words_to(0)
        else:
            self.enter(self.visit.find_step(self.step.number + 1))

    def action_previous(self) -> None:
        if self.is_over:
            self.enter(self.step)
        elif self.step.number > 1:
            self.enter(self.visit.find_step(self.step.number - 1))

    def action_restart(self) -> None:
        """The scene from its beginning. Never a check."""
        if self._has_scene and not self._is_still:
            self._scene.again()
        elif self.model is not None and self.model.by_hand:
            self._exercise.notify_row(" Press d to drive; r restarts the drive there.")
        elif self.model is not None:
            self._exercise.notify_row(" c checks the exercise, x starts it over.")

    def action_pause(self) -> None:
        """Stills tables that learn and messages on their way, and lets them go on."""
        if self._is_playing_back:
            self._playback_scene.hold(not self._playback_scene.is_paused)
            self.show()

    def action_step(self) -> None:
        """One update of tables, or one place of messages, that stand still."""
        if self._is_playing_back:
            self._playback_scene.step()
            self.show()

    def action_scroll(self, lines: int) -> None:
        self._page.scroll_words(lines)

    @work
    async def action_steps(self) -> None:
        progress = self.visit.lesson_progress
        choices = [
            PickerItem(
                str(step.number),
                f"{'[x]' if progress.is_step_completed(step) else '[ ]'} {step.number}",
                step.title,
            )
            for step in self.visit.lesson.steps
        ]
        chosen = await self.app.push_screen_wait(
            Picker(self.visit.lesson.title, choices, str(self.step.number))
        )
        if chosen is not None:
            self.enter(self.visit.find_step(int(chosen)))

    def action_help(self) -> None:
        self.app.push_screen(HelpDialog("This lesson", self.screen_actions))

    async def _choose_command(self, commands: Sequence[LessonCommand]) -> LessonCommand | None:
        """The only command, or the one that the student picks; None: none."""
        if len(commands) <= 1:
            return commands[0] if commands else None
        choices = [PickerItem(str(at), self.with_paths(each.line)) for at, each in enumerate(commands)]
        chosen = await self.app.push_screen_wait(Picker("Run", choices))
        return None if chosen is None else commands[int(chosen)]

    async def _may_run(self, command: LessonCommand) -> bool:
        """Shows a command of somebody else's lesson before it runs for the first time."""
        line = self.with_paths(command.line)
        if not self.visit.lesson.is_foreign or line in self._allowed_lines:
            return True
        choices = [PickerItem("no", "do not run it"), PickerItem("run", "run", line)]
        chosen = await self.app.push_screen_wait(Picker("The author's command", choices))
        if chosen == "run":
            self._allowed_lines.add(line)
        return chosen == "run"

    @work
    async def action_run_command(self) -> None:
        command = await self._choose_command([] if self.is_over else self.step.runnable_commands)
        if command is None or not await self._may_run(command):
            return
        self.hold_scene(True)
        printed = run_aside(
            self.app,
            self.with_paths(command.line),
            self.theme.terminal,
            workspace=self.workspace.folder,
            folder=self.model.file.parent if self.model is not None else None,
            waits=command.kind is CommandKind.ALONE,
        )
        self.hold_scene(False)
        if printed:
            self.app.push_screen(TextScreen(command.line, [row(each) for each in plain_lines(printed)]))
        if printed is None:
            self.show_error(
                "This command cannot run here",
                f"Type it in a second terminal: {self.with_paths(command.line)}",
            )

    def action_second_terminal(self) -> None:
        """How to open one."""
        text = second_terminal_here(self.workspace)
        self.app.push_screen(TextScreen(SECOND_TERMINAL, lesson_rows.words(text, self.size.width)))

    @work
    async def action_questions(self) -> None:
        if self.is_over:
            await ask_of_lesson(self, self.visit.journal, self.visit.lesson.name)

    # Keys of the exercise

    def action_check(self) -> None:
        self._exercise.check()

    def action_edit_file(self) -> None:
        self._exercise.edit_file()

    def action_hint(self) -> None:
        self._exercise.hint()

    def action_output(self) -> None:
        self._exercise.output()

    def action_solution(self) -> None:
        self._exercise.solution()

    def action_start_over(self) -> None:
        self._exercise.start_over()

    def action_replay(self) -> None:
        self._exercise.replay()

    def action_defend(self) -> None:
        self._exercise.defend()

    def action_drive(self) -> None:
        self._exercise.drive()
