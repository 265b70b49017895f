"""The navigation of a lesson: to another step, into a command, to the questions, and back."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual import work
from textual.screen import Screen

from kit.school.lessons.records import CommandKind, LessonCommand
from kit.tui.screens.message_dialog import HelpDialog
from kit.tui.screens.picker import Picker, PickerItem
from kit.tui.suspend import run_aside

if TYPE_CHECKING:
    from kit.school.lessons.lesson_session import LessonSession
    from kit.school.lessons.records import LessonStep
    from kit.tui.exercise_model import ExerciseModel
    from kit.tui.theme import Theme
    from kit.workspace import Workspace


class NavigationActions(Screen[None]):
    """What a lesson's screen opens and where it goes."""

    theme: Theme
    visit: LessonSession
    workspace: Workspace
    step: LessonStep
    model: ExerciseModel | None
    is_over: bool
    """Whether the last step lies behind."""

    def enter(self, step: LessonStep) -> None:
        """Shows a step from its beginning."""
        raise NotImplementedError

    def with_paths(self, text: str) -> str:
        """With the student's own paths."""
        raise NotImplementedError

    def hold_scene(self, held: bool) -> None:
        """Has the scene stand still while something else is looked at, or go on if it was going."""
        raise NotImplementedError

    def show_error(self, title: str, text: str) -> None:
        """What went wrong, as a page over the step."""
        raise NotImplementedError

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
        self.app.push_screen(HelpDialog("This lesson", "lesson"))

    def action_back(self) -> None:
        if len(self.app.screen_stack) > 2:
            self.dismiss()
        else:
            self.app.exit()

    def runnable_commands(self) -> list[LessonCommand]:
        """The commands that can be run here; for those that look into a world, what opens that world."""
        made = [each for each in self.step.commands if each.kind is not CommandKind.BESIDE]
        places = dict.fromkeys(
            each.map_name for each in self.step.commands if each.kind is CommandKind.BESIDE
        )
        return made + [LessonCommand(f"kit play {place}", CommandKind.SCREEN, place) for place in places]

    @work
    async def action_run_command(self) -> None:
        commands = self.runnable_commands() if not self.is_over else []
        if not commands:
            return
        chosen: str | None = "0"
        if len(commands) > 1:
            choices = [PickerItem(str(at), self.with_paths(each.line)) for at, each in enumerate(commands)]
            chosen = await self.app.push_screen_wait(Picker("Run", choices))
        if chosen is None:
            return
        command = commands[int(chosen)]
        self.hold_scene(True)
        done = run_aside(
            self.app,
            self.with_paths(command.line),
            self.theme.terminal,
            workspace=self.workspace.folder,
            folder=self.model.file.parent if self.model is not None else None,
            waits=command.kind is CommandKind.ALONE,
        )
        self.hold_scene(False)
        if not done:
            self.show_error(
                "This command cannot run here",
                f"Type it in a second terminal: {self.with_paths(command.line)}",
            )

    @work
    async def action_questions(self) -> None:
        if self.is_over:
            from kit.tui.screens.questions import ask_of_lesson  # of no use before the end

            await ask_of_lesson(self, self.visit.journal, self.visit.lesson.name)
