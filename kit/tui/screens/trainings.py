"""Trainings, opened from another screen: go on looking at one, or begin one."""

from __future__ import annotations

from asyncio import to_thread
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from kit.tui.screens.message_dialog import MessageDialog, wrapped
from kit.tui.screens.picker import Picker, PickerItem

if TYPE_CHECKING:
    from textual.screen import Screen

    from kit.learning.training.runs import TrainingRun
    from kit.tui.screens.training import TrainingScreen
    from kit.tui.theme import Theme

NEW: Final = "new/"
"""Before a task's name: begin a training of it."""


async def choose_training(screen: Screen[Any], theme: Theme, runs: Path) -> TrainingScreen | None:
    """The screen of the training that was chosen; None if none was, or it could not be begun."""
    choices = await to_thread(_choices, runs)
    chosen = await screen.app.push_screen_wait(Picker("Train", choices))
    if chosen is None:
        return None
    try:
        run = await to_thread(_run, runs, chosen)
    except Exception as error:  # noqa: BLE001 - torch missing, a full disk, a damaged run: all of it is told
        screen.app.push_screen(MessageDialog("This cannot be trained", wrapped(str(error))))
        return None
    from kit.tui.screens.training import TrainingScreen

    return TrainingScreen(theme, run)


def _choices(folder: Path) -> list[PickerItem]:
    """Called in another thread: the learning side takes a moment to import."""
    from kit.learning.environment.tasks import all_tasks
    from kit.learning.training.runs import RunError, list_runs

    choices = [PickerItem(f"{NEW}{task.name}", f"new: {task.name}", task.summary) for task in all_tasks()]
    for run in list_runs(folder):
        try:
            choices.append(PickerItem(run.name, run.name, f"look at it: {run.config().choice.title}"))
        except RunError:
            choices.append(PickerItem(run.name, run.name, "damaged"))
    return choices


def _run(folder: Path, chosen: str) -> TrainingRun:
    """The run, begun where it is to be a new one."""
    from kit.learning.environment.task_spec import TaskSpec
    from kit.learning.training.optional_deps import require_learn_extra
    from kit.learning.training.runs import RunConfig, create_run, find_run
    from kit.learning.training.worker import start_worker

    if not chosen.startswith(NEW):
        return find_run(folder, chosen)
    require_learn_extra()
    run = create_run(folder, RunConfig(TaskSpec(chosen.removeprefix(NEW))), None)
    start_worker(run)
    return run
