"""A Gymnasium environment around a robot in a world: run for some episodes and compared with that world.

The assignment gives the scenario and what each action does::

    environment:
      class: HallwayEnv
      place: turn
      case: turn_a_to_b
      moves: [[0.5, 0], [0, 1.57], [0, -1.57]]    # m/s, rad/s of each action
      step_time: 0.1
      max_steps: 200
      way: [[0, 1.6], [1.6, 1.6]]                 # points by which the target is reached
      scan: /static_laser
      clip: 2.0
    seed: 1

Or a task of the kit's by name, or a task file in this folder, gives place, case, moves, times and clip::

    environment:
      class: HallwayEnv
      task: my_task.yaml
      case: there                                 # by default its first
      way: [[0, 1.6], [1.6, 1.6]]
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from grader.assignment import Assignment
from grader.evidence.contract import EvidenceOptions, EvidenceRecord
from grader.kinds.contract import AssignmentFiles, KindSettings, SubmissionKind, collect_once
from grader.kinds.controller.kind import read_scenario
from grader.kinds.environment.checks import CHECKS, first_complaint
from grader.kinds.environment.examination import (
    EXAMINER_FILE,
    EnvironmentRecord,
    EnvironmentTask,
    examine_environment,
)
from grader.kinds.environment.sheet_keys import SHEET_KEYS
from grader.seeds import read_seed
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.program_start import child_seed
from kit.host.wire import MAX_NAME, printable
from kit.plain_text import quoted
from kit.run.scenario import Scenario
from kit.world.problems import WorldError
from kit.world.yaml_section import Section

if TYPE_CHECKING:
    from kit.learning.tasks.learning_task import LearningTask

MOST_STEPS: Final = 400
"""Most steps of one episode: the grader drives one to its time limit."""


def read_settings(files: AssignmentFiles) -> KindSettings:
    """Reads the scenario of the environment, and what its actions do."""
    section = files.public.section("environment")
    if section.has("task"):
        # Only here: whatever has tasks imports numba and Gymnasium, which takes a second.
        from kit.learning.tasks.actions import DiscreteActions

        task = _read_task(section, files.folder)
        scenario = None if task is None else _scenario_of_task(section, task)
        moves = task.actions.twist_table if task and isinstance(task.actions, DiscreteActions) else ()
        step_s, max_steps = (task.step_time, task.max_steps) if task else (0.1, 200)
        clip = task.observation.clip if task else 2.0
    else:
        scenario = read_scenario(section, files.folder)
        moves = section.points("moves", at_least=2, at_most=20)
        step_s = section.number("step_time", 0.1, above=0, maximum=2)
        max_steps = section.integer("max_steps", 200, minimum=10, maximum=MOST_STEPS)
        clip = section.number("clip", 2.0, above=0)
    seed = files.public.integer("seed", 1, minimum=0, maximum=10**6)
    secret = None if files.secret is None else read_seed(files.secret)
    class_name = section.name("class")
    waypoints = section.points("way", at_least=1, at_most=50)
    scan = section.name("scan", "/static_laser")
    section.finish()
    if scenario is None:
        return KindSettings()
    if scenario.case is None or scenario.robot is None:
        section.error("the place must have a robot and a target: give a case of a map of the kit", "place")
        return KindSettings()
    return KindSettings(
        task=EnvironmentTask(
            class_name, scenario, moves, step_s, max_steps, waypoints, scan, clip, seed, secret
        ),
        secret_seeds=() if secret is None else (secret,),
    )


def _read_task(section: Section, folder: Path) -> LearningTask | None:
    """The task that the environment is to be; notes what this kind cannot examine and returns None."""
    from grader.task_files import read_task_choice
    from kit.learning.tasks.actions import DiscreteActions

    choice = read_task_choice(section, folder)
    if choice is None:
        return None
    task = choice.resolve()
    if task.robots != 1 or not isinstance(task.actions, DiscreteActions):
        section.error("an environment to write needs one robot and discrete actions", "task")
        return None
    if task.max_steps > MOST_STEPS:
        section.error(
            f"its episodes take up to {task.max_steps} steps; at most {MOST_STEPS} are driven", "task"
        )
        return None
    return task


def _scenario_of_task(section: Section, task: LearningTask) -> Scenario | None:
    from grader.task_files import task_scenario

    case = section.name("case") if section.has("case") else None
    try:
        return task_scenario(task, case)
    except (LookupError, WorldError) as error:
        section.error(str(error), "case" if case is not None else "task")
        return None


def collect_evidence(assignment: Assignment, file: Path, options: EvidenceOptions) -> EvidenceRecord:
    """Examines the environment once; with the secret seed where secrets are used."""
    task: EnvironmentTask = assignment.task
    if not options.secret or task.secret_seed is None:
        return _examine(assignment, file, options, task.seed)
    # The environment is told the seed of each episode: it must not be the secret itself.
    return replace(_examine(assignment, file, options, child_seed(task.secret_seed) % 2**31), secret=True)


def _examine(assignment: Assignment, file: Path, options: EvidenceOptions, seed: int) -> EvidenceRecord:
    task: EnvironmentTask = assignment.task
    try:
        record = examine_environment(task, assignment, file, options.level, seed, options.clock)
    except StudentCodeError as error:
        failure = options.clock.explain(error.failure)
        if failure.file == EXAMINER_FILE.name:  # the grader's own examiner means nothing to the student
            failure = replace(failure, file=file.name, line=None)
        return EvidenceRecord(
            failure=failure, label="the environment", outcome=f"stopped ({failure.kind.value})"
        )
    wrong = _missing_environment(record, task, file.name)
    if wrong:
        failure = Failure(FailureKind.IMPORT, printable(wrong), file.name)
        return EvidenceRecord(failure=failure, label="the environment", printed=record.printed)
    return EvidenceRecord(
        record,
        label="the environment",
        steps=record.steps,
        printed=record.printed,
        explain_with=lambda check, params: first_complaint(record, check),
    )


def _missing_environment(record: EnvironmentRecord, task: EnvironmentTask, file: str) -> str:
    """Returns why there is no environment in the file; empty if there is one."""
    if "missing" in record.description:
        missing = record.description["missing"]
        names: Sequence[str] = (
            [str(each)[:MAX_NAME] for each in missing[:20]] if isinstance(missing, list) else []
        )
        return f"it has no class {quoted(task.class_name)}. Its classes: {', '.join(names) or 'none'}."
    if not record.description.get("is_env"):
        return (
            f"{task.class_name} is not a gymnasium.Env yet: write `class {task.class_name}(gymnasium.Env):`."
        )
    return ""


KIND: Final = SubmissionKind(
    (".py",),
    CHECKS,
    read_settings,
    collect_once(collect_evidence),
    sheet_keys=SHEET_KEYS,
    exercise="10-words-of-learning/hallway",
)
