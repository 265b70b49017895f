"""The answers to challenges: the files they are written in, which begin with the naive answer, and what a challenge shows."""

from __future__ import annotations

import math
import shutil
import time
from pathlib import Path
from typing import Final

import yaml

from kit.layers.requirements_file import read_requirements
from kit.school.game.challenges import (
    PREFIX,
    Challenge,
    ChallengeError,
    DevicesTask,
    ExploitTask,
    LayersTask,
    RepairTask,
    TrainingTask,
    naive_lasers,
    naive_plan,
    shortest_moves,
)
from kit.school.lessons.reading import STARTER_FOLDER
from kit.school.progress import EventKind, ProgressJournal
from kit.workspace import Workspace, write_atomically

COMMENT: Final = "#"
FILES: Final = {ExploitTask: "moves.txt", DevicesTask: "lasers.txt", LayersTask: "plan.yaml"}
"""The name of an answer's file. A training's answer is a run, and a repair's the program itself."""


def answers_folder(workspace: Workspace) -> Path:
    """The folder of the answers' files."""
    return workspace.folder / "challenges"


def task_lines(challenge: Challenge) -> list[str]:
    """What a challenge shows beside its text: a drawing, prices, the list that a plan is for."""
    task = challenge.task
    if isinstance(task, ExploitTask):
        prices = f"Nearer pays {task.nearer:g}, farther {task.farther:g}, arriving {task.goal:g};"
        return [*task.grid, f"{prices} discount {task.discount:g}, at most {task.max_moves} moves."]
    if isinstance(task, DevicesTask):
        columns = "   " + "".join(str(column % 10) for column in range(len(task.grid[0])))
        return [columns, *(f"{number:>2} {line}" for number, line in enumerate(task.grid))]
    if isinstance(task, LayersTask):
        return task.file.read_text().rstrip().splitlines()
    return []


def prepare_answer(
    journal: ProgressJournal, challenge: Challenge, folder: Path, now_s: float | None = None
) -> tuple[Path | None, float]:
    """Makes the file of an answer in ``folder`` unless it is there; a repair's clock begins with the first look.

    Returns the file, None for a training, and the seconds since the first look, infinite where no clock runs. Raises
    ProgressError and OSError.
    """
    if isinstance(challenge.task, RepairTask):
        return begin_repair(journal, challenge, folder, now_s)
    if isinstance(challenge.task, TrainingTask):
        return None, math.inf
    file = folder / challenge.id / FILES[type(challenge.task)]
    if not file.exists():
        file.parent.mkdir(parents=True, exist_ok=True)
        about = [
            challenge.task_text,
            "Below is the naive answer, which earns no medal.",
            *task_lines(challenge),
        ]
        text = "".join(f"{COMMENT} {line}\n" for line in about) + _naive_answer(challenge.task)
        write_atomically(file, text.encode())
    return file, math.inf


def read_answer(challenge: Challenge, file: Path) -> str:
    """Reads what ``judge`` takes from an answer's file. Raises ChallengeError."""
    if type(challenge.task) not in (ExploitTask, DevicesTask):
        return str(file)  # the file itself is handed in
    try:
        lines = file.read_text().splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise ChallengeError(f"{file} cannot be read: {error}") from None
    return " ".join(line for line in lines if not line.lstrip().startswith(COMMENT))


def begin_repair(
    journal: ProgressJournal, challenge: Challenge, folder: Path, now_s: float | None = None
) -> tuple[Path, float]:
    """Copies the faulty program into ``folder`` unless it is there, and begins the clock with the first look.

    Returns the file to repair and the seconds since then. Raises ProgressError and OSError.
    """
    assert isinstance(challenge.task, RepairTask)
    made = folder / challenge.id
    if not made.exists():
        shutil.copytree(challenge.task.folder / STARTER_FOLDER, made)
    subject = f"{PREFIX}{challenge.id}"
    now = time.time() if now_s is None else now_s
    begun = [event.time.timestamp() for event in journal.events(EventKind.FINISH, subject)]
    if not begun:
        journal.add(EventKind.FINISH, subject, {"medal": 0, "text": "begun"})
    return made / challenge.task.file, max(0.0, now - begun[0]) if begun else 0.0


def _naive_answer(task: ExploitTask | DevicesTask | LayersTask) -> str:
    """The naive answer as a file holds it."""
    if isinstance(task, ExploitTask):
        return f"{shortest_moves(task)}\n"
    if isinstance(task, DevicesTask):
        return "".join(f"{row},{column}\n" for row, column in naive_lasers(task))
    plan = naive_plan(read_requirements(task.file).case)
    content = {
        "layers": {layer.name: sorted(layer.members) for layer in plan.layers},
        "lasers": {laser: list(names) for laser, names in plan.watches.items()},
    }
    return str(yaml.safe_dump(content, sort_keys=False, width=math.inf))
