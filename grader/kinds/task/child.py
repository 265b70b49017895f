"""The process that reads a submitted task with its world, and trains on it: one request per line on standard input, one
answer per line on standard output.

No program of the student's runs in it. But a world may be too large, and what reads its pictures, or the arrays of a
policy, may have mistakes: so its memory is limited, whoever started it ends it when it takes too long, and from level 1 on
it is confined as the process that reads worlds is.
"""

from __future__ import annotations

import json
import os
import sys
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np

from grader.evidence.reader_child import confine_before_reading, limit_memory, limit_resources, send_answer
from grader.evidence.reader_process import PROGRESS
from grader.evidence.submission_clock import SubmissionClock
from grader.evidence.training_results import PosedTaskPlan
from grader.task_files import problem_of_task
from kit.learning.authoring.task_check import touching
from kit.learning.environment.batch import BatchEnv
from kit.learning.maps.batch_floor import measure_floor
from kit.learning.maps.batch_map import load_batch_map
from kit.learning.tasks.task_spec import TaskSpec
from kit.world.catalogue import maps_folder

KNOWN_TASK: Final = "turn"
"""A task of the kit's, on which kernels are tried."""


def main() -> None:
    """Reads the task named on the command line, then measures what each line asks for."""
    path, memory, is_confined, scratch = sys.argv[1:]
    file = Path(path)
    limit_resources()
    from grader.kinds.task.posed_task import (
        PosedTask,  # loaded before this process is confined, as the kernels
    )

    if is_confined:
        compile_kernels()
        kernel_modules = ("kernels", "grids", "world_kernels")
        confine_before_reading(file, scratch, kernel_modules=kernel_modules, beside=[str(maps_folder())])
    limit_memory(int(memory), for_good=True)
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # other output must not mix with the answers
    request = json.loads(sys.stdin.readline())
    problem = problem_of_task(file) or ""
    # The path of the temporary copy means nothing to the student.
    shown = problem.replace(f"{file.parent}/", "").replace(str(file.parent), "of the task")
    send_answer(answers, {"problem": shown})
    if problem:
        return
    clock = SubmissionClock(
        show_progress=partial(_show_progress, answers)
    )  # time is kept by who started this
    posed = PosedTask(file, PosedTaskPlan(**request["plan"]), request["seed"], clock)
    for line in sys.stdin:
        asked = json.loads(line)
        send_answer(answers, asdict(posed.measure(asked["check"], asked["params"])))


def compile_kernels() -> None:
    """Has everything compiled that a task needs: a confined process cannot keep what it compiles, and the next one would
    have to do it again."""
    task = TaskSpec(KNOWN_TASK).resolve()
    card = task.map_cards[0]
    batch_map = load_batch_map(card, task.robots_on(card))
    touching(batch_map, [case.starts[0].nominal for _, case in task.map_cases()][:1])
    measure_floor(batch_map)
    batch = BatchEnv(task, 2, 0)
    batch.reset()
    batch.step(np.zeros(2, dtype=np.int64))


def _show_progress(answers: Any, text: str) -> None:
    send_answer(answers, {PROGRESS: text})


if __name__ == "__main__":
    main()
