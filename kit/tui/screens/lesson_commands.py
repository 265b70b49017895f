"""The commands of a lesson's step, run from its screen."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from kit.school.lessons.records import CommandKind, LessonCommand, LessonStep
from kit.tui.screens.picker import Picker, PickerItem

if TYPE_CHECKING:
    from textual.screen import Screen


def runnable_commands(step: LessonStep) -> list[LessonCommand]:
    """The commands that can be run here; for those that look into a world, what opens that world."""
    made = [each for each in step.commands if each.kind is not CommandKind.BESIDE]
    places = dict.fromkeys(each.map_name for each in step.commands if each.kind is CommandKind.BESIDE)
    return made + [LessonCommand(f"kit play {place}", CommandKind.SCREEN, place) for place in places]


async def choose_command(
    screen: Screen[None], commands: Sequence[LessonCommand], with_paths: Callable[[str], str]
) -> LessonCommand | None:
    """The only command, or the one that the student picks; None: none. ``with_paths``: fills in the student's paths."""
    if len(commands) <= 1:
        return commands[0] if commands else None
    choices = [PickerItem(str(at), with_paths(each.line)) for at, each in enumerate(commands)]
    chosen = await screen.app.push_screen_wait(Picker("Run", choices))
    return None if chosen is None else commands[int(chosen)]
