"""Evidence about a reward: its value for every transition of the model and for the mirrored and rotated task, its exploit as a recording, and what is learned with it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from statistics import fmean
from typing import Any, Final

import numpy as np

from grader.assignment import Assignment, GridTask
from grader.evidence.submission_clock import SubmissionClock, TrainingProgressReport
from grader.evidence.task_model import (
    CELL,
    HEADINGS,
    LAST_MOVES,
    LEFT,
    MODEL_FACTS,
    RIGHT,
    BehaviourComparison,
    GridModel,
    LoopComparison,
    OptimalPolicy,
    PolicyOutcome,
    TransitionBatch,
    build_model,
    compare_behaviours,
    compare_loops,
    discounted_return,
    draw_path,
    evaluate_policy,
    rollout,
    to_transition,
    value_iteration,
)
from grader.submitted_files import reading_submission
from grader.task_files import assignment_task
from kit.arrays import FloatArray, IntArray
from kit.geometry import Pose, wrap_angle
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.sandbox.confinement import Level
from kit.host.student_functions import StudentFunctions
from kit.host.wire import printable
from kit.learning.environment.episode_stats import EpisodeStats
from kit.learning.policies.evaluation import Evaluator, PathRecorder, derive_seed, worst_drive
from kit.learning.tasks.rewards import RewardFunction
from kit.learning.tasks.student_reward import (
    REWARD_FUNCTION,
    RewardFileError,
    call_reward,
    reward_parameters,
)
from kit.learning.tasks.transition import Transition
from kit.learning.training.algorithms import find_algorithm, require_learn_extra
from kit.learning.training.learner import Learner
from kit.learning.training.presets import find_preset
from kit.learning.training.training import make_learner
from kit.plain_text import suggestion
from kit.ros.graph.graph import Graph
from kit.run.episode import run_until
from kit.run.recording import Recorder, save_recording
from kit.run.runner import Runner
from kit.run.scenario import scenario_in_file
from kit.sim.simulation import Simulation
from kit.workspace import write_atomically
from kit.world.layer_reader import trace_edges

MIRRORED_MOVES = np.arange(LAST_MOVES)
MIRRORED_MOVES[[LEFT, RIGHT]] = RIGHT, LEFT


def mirrored(steps: TransitionBatch) -> TransitionBatch:
    """Mirrors the task: left and right exchanged, x reversed."""
    task = steps.model.task
    width = len(task.rows[0])
    return _transformed(
        steps,
        replace(task, rows=tuple(row[::-1] for row in task.rows)),
        lambda cells: np.column_stack([width - 1 - cells[:, 0], cells[:, 1]]),
        lambda headings: (HEADINGS // 2 - headings) % HEADINGS,
        MIRRORED_MOVES,
    )


def rotated(steps: TransitionBatch) -> TransitionBatch:
    """Rotates the task a quarter turn counter-clockwise."""
    task = steps.model.task
    height = len(task.rows)
    rows = tuple("".join(row[k] for row in task.rows) for k in reversed(range(len(task.rows[0]))))
    return _transformed(
        steps,
        replace(task, rows=rows),
        lambda cells: np.column_stack([height - 1 - cells[:, 1], cells[:, 0]]),
        lambda headings: (headings + HEADINGS // 4) % HEADINGS,
        np.arange(LAST_MOVES),
    )


def _transformed(
    steps: TransitionBatch,
    task: GridTask,
    move_cells: Callable[[IntArray], IntArray],
    turn_headings: Callable[[IntArray], IntArray],
    moves: IntArray,
) -> TransitionBatch:
    before, after = steps.model, build_model(task)
    number = {tuple(cell): index for index, cell in enumerate(after.cells.tolist())}
    cell_map = np.array([number[tuple(cell)] for cell in move_cells(before.cells).tolist()])
    return TransitionBatch(
        after, _states(before, steps.states, cell_map, turn_headings, moves), moves[steps.moves]
    )


def _states(
    model: GridModel,
    states: IntArray,
    cell_map: IntArray,
    turn_headings: Callable[[IntArray], IntArray],
    moves: IntArray,
) -> IntArray:
    headings = turn_headings(model.heading_of(states))
    transformed: IntArray = (cell_map[model.cell_of(states)] * HEADINGS + headings) * LAST_MOVES + moves[
        states % LAST_MOVES
    ]
    return transformed


SHUFFLE: Final = 1234
"""Seed of the order in which the transitions are evaluated a second time."""
MAX_SAMPLES: Final = 4000
"""Transitions on which the mirrored and the rotated task are compared."""


class RewardEvidence:
    """One reward function, and what is computed from its values."""

    label = "the reward"
    secret = False

    def __init__(
        self, file: Path, assignment: Assignment, level: Level, clock: SubmissionClock | None = None
    ) -> None:
        self._clock = clock or SubmissionClock()
        self._interruptions: dict[str, Failure] = {}
        """How the reward failed when a check called it again, by check."""
        self.model: GridModel = build_model(assignment.task)
        self.level = level
        self.failure: Failure | None = None
        self.printed: tuple[str, ...] = ()
        self.steps = 0
        self._file = file
        self._folder = assignment.folder
        self._limits = assignment.limits
        self._names: tuple[str, ...] = ()
        self._successes: dict[RewardTrainingParams, float] = {}
        try:
            self._names = read_parameter_names(file)
            self.rewards: FloatArray = self._evaluate_all(TransitionBatch.all(self.model)).reshape(
                self.model.states, -1
            )
        except StudentCodeError as error:
            self.failure = self._clock.explain(error.failure)

    @property
    def outcome(self) -> str:
        return "examined" if self.failure is None else f"stopped ({self.failure.kind.value})"

    @cached_property
    def policy(self) -> OptimalPolicy:
        return value_iteration(self.model, self.rewards, self._clock.check)

    @cached_property
    def plan_outcome(self) -> PolicyOutcome:
        return evaluate_policy(self.policy, self._clock.check)

    @cached_property
    def is_pure(self) -> bool:
        """True if the same transitions give bit-equal rewards in another order and in a fresh process."""
        steps = TransitionBatch.all(self.model)
        order = np.random.default_rng(SHUFFLE).permutation(len(steps))
        shuffled = steps.at(order)
        try:
            with self._open() as functions:
                first = self._call(functions, shuffled)
                second = self._call(functions, steps)
        except StudentCodeError as error:
            self._interruptions["pure"] = self._clock.explain(error.failure)
            return False
        known = self.rewards.reshape(-1)
        return bool(np.array_equal(first, known[order]) and np.array_equal(second, known))

    @cached_property
    def symmetry(self) -> float:
        """The share of transitions whose reward stays the same when the whole task is mirrored and when it is turned."""
        everything = TransitionBatch.all(self.model)
        # In the target's centre there is no direction to the target.
        elsewhere = np.flatnonzero(
            ~everything.reached & (self.model.cell_of(everything.states) != self.model.target)
        )
        sampled = np.random.default_rng(SHUFFLE).permutation(elsewhere)[:MAX_SAMPLES]
        sample = everything.at(sampled)
        known = self.rewards.reshape(-1)[sampled]
        same = np.ones(len(sample), dtype=np.bool_)
        transforms: tuple[TransitionBatch, ...] = (mirrored(sample), rotated(sample))
        try:
            with self._open() as functions:
                for transformed in transforms:
                    same &= np.isclose(self._call(functions, transformed), known, rtol=1e-6, atol=1e-9)
        except StudentCodeError as error:
            self._interruptions["symmetric"] = self._clock.explain(error.failure)
            return 0.0
        return float(same.mean())

    @cached_property
    def behaviours(self) -> tuple[BehaviourComparison, ...]:
        """Comparisons of good and bad behaviours by their returns."""
        return compare_behaviours(self.model, self.rewards, self._clock.check)

    @cached_property
    def loops(self) -> tuple[LoopComparison, ...]:
        return compare_loops(self.model, self.rewards, self._clock.check)

    def success_after_training(self, budget: RewardTrainingParams) -> float:
        """Returns the success of robots trained with this reward; 0 if the reward fails during training."""
        if budget not in self._successes:
            try:
                with self._open() as functions:
                    self._successes[budget] = mean_success(
                        lambda each: self._rewards_of(functions, each), budget, self._clock, self._folder
                    )
            except StudentCodeError as error:
                self._interruptions["trained"] = self._clock.explain(error.failure)
                self._successes[budget] = 0.0
        return self._successes[budget]

    def explain(self, check: str, params: Any = None) -> str:
        """Explains the first comparison that a check counts as wrong, or how the reward failed during a check."""
        if check in self._interruptions:
            return f"But {self._interruptions[check]}"
        if check == "ordered":
            wrong = next((pair for pair in self.behaviours if not pair.is_ordered), None)
            return "" if wrong is None else str(wrong)
        if check == "loops":
            profitable = next((loop for loop in self.loops if loop.is_profitable), None)
            return "" if profitable is None else str(profitable)
        return ""

    def picture(self, check: str = "") -> str:
        """Draws the optimal behaviour under this reward, and says its return, if it misses the target."""
        try:
            if self.failure is not None or self.plan_outcome.exploit_start is None:
                return ""
        except StudentCodeError:  # the time is used up
            return ""
        states = rollout(self.policy, self.plan_outcome.exploit_start, self.model.task.max_steps)
        moves = tuple((states[1:] % LAST_MOVES).tolist())
        paid = discounted_return(self.model, self.policy.rewards, int(states[0]), moves)
        return f"{draw_path(self.model, states)}\nYour reward pays {paid:.4g} for it in all."

    def save_exploit(self, file: Path) -> None:
        """Saves what ``picture`` shows as a recording. Raises OSError."""
        assert self.plan_outcome.exploit_start is not None, "there is no picture"
        save_exploit(
            self.model,
            rollout(self.policy, self.plan_outcome.exploit_start, self.model.task.max_steps),
            file,
        )

    def _evaluate_all(self, steps: TransitionBatch) -> FloatArray:
        with self._open() as functions:
            try:
                return self._call(functions, steps)
            finally:
                self.printed = tuple(printable(line.text) for line in functions.take_output().lines)

    def _open(self) -> StudentFunctions:
        self._clock.check()
        return StudentFunctions(self._file, limits=self._clock.shorten(self._limits), level=self.level)

    def _call(self, functions: StudentFunctions, steps: TransitionBatch) -> FloatArray:
        self.steps += len(steps)
        return self._rewards_of(functions, to_transition(steps))

    def _rewards_of(self, functions: StudentFunctions, step: Transition) -> FloatArray:
        """Returns (n,) rewards of the student's function for n transitions."""
        rewards: FloatArray = call_reward(functions, REWARD_FUNCTION, step, self._names)
        return rewards


def read_parameter_names(file: Path) -> tuple[str, ...]:
    """Returns the names of the reward function's parameters. The file is read, never run. Raises StudentCodeError."""
    try:
        with reading_submission(file.name, RewardFileError):
            names = reward_parameters(file)
    except RewardFileError as error:
        # The path of the temporary copy means nothing to the student.
        message = str(error).replace(f"{file}", file.name)
        raise StudentCodeError(Failure(FailureKind.IMPORT, printable(message))) from None
    unknown = [name for name in names if name not in MODEL_FACTS]
    if unknown:
        message = f"{file.name}: {REWARD_FUNCTION}() asks for {unknown[0]}, which this task does not have: {suggestion(unknown[0], MODEL_FACTS)}"
        raise StudentCodeError(Failure(FailureKind.IMPORT, message))
    return names


STEP: Final = 0.01
"""s"""
TICKS_PER_MOVE: Final = 25
"""For each move of the model: four moves a second."""
MAX_MOVES: Final = 80
"""Twenty seconds: enough to see a loop several times."""
ROBOT: Final = "robot"

ROBOT_FILE: Final = """\
bodies:
  - name: body
    footprints:
      - {type: polygon, density: 1, layers: [], points: [[0.09, 0], [-0.06, 0.07], [-0.06, -0.07]]}
"""
TARGET_FILE: Final = """\
bodies:
  - name: post
    type: static
    footprints:
      - {type: circle, radius: 0.1, density: 0, layers: []}
"""
WALLS_FILE: Final = "type: line_segments\ndata: walls.dat\nscale: 1\norigin: [0, 0, 0]\n"
WORLD_FILE: Final = """\
properties: {{}}
layers:
  - {{name: walls, map: map.yaml}}
models:
  - {{name: robot, model: robot.model.yaml, pose: [{0}, {1}, {2}]}}
  - {{name: target, model: target.model.yaml, pose: [{3}, {4}, 0]}}
"""


def save_exploit(model: GridModel, states: IntArray, file: Path) -> Path:
    """Saves the path through ``states`` as a recording, and its world in a folder beside it; returns that folder.

    Raises OSError.
    """
    folder = file.with_name(f"{file.stem}-world")
    folder.mkdir(parents=True, exist_ok=True)
    poses = model.pose(states[: MAX_MOVES + 1])
    for name, text in _files(model, Pose(*poses[0].tolist())).items():
        write_atomically(folder / name, text.encode())
    scenario = scenario_in_file((folder / "world.yaml").absolute())
    simulation = Simulation(scenario.world, seed=0, step_size=STEP)
    runner = Runner(simulation, Graph(log_sink=lambda record: None))
    recorder = Recorder(scenario.name, None, simulation)
    runner.observers.append(recorder)
    path = [step for before, after in pairwise(poses) for step in _poses_between(before, after)]
    run_until(
        runner,
        ticks=len(path),
        before_tick=lambda number: runner.call_service("move_model", ROBOT, path[number]),
    )
    save_recording(recorder.recording(), file)
    return folder


def _poses_between(before: FloatArray, after: FloatArray) -> Iterator[tuple[float, float, float]]:
    """The poses at the ticks of one move, the last included."""
    turn = wrap_angle(float(after[2] - before[2]))
    for tick in range(1, TICKS_PER_MOVE + 1):
        x, y = (before[:2] + (after[:2] - before[:2]) * (tick / TICKS_PER_MOVE)).tolist()
        yield x, y, float(before[2]) + turn * tick / TICKS_PER_MOVE


def _files(model: GridModel, start: Pose) -> dict[str, str]:
    """Returns the world's files: text by name."""
    floor = np.array([[sign != "#" for sign in row] for row in model.task.rows])
    walls = trace_edges(~floor, CELL)
    target = (model.cells[model.target] + 0.5) * CELL
    return {
        "world.yaml": WORLD_FILE.format(*(f"{number:.6f}" for number in (*start, *target.tolist()))),
        "map.yaml": WALLS_FILE,
        "walls.dat": "".join(" ".join(f"{number:.4f}" for number in wall) + "\n" for wall in walls.tolist()),
        "robot.model.yaml": ROBOT_FILE,
        "target.model.yaml": TARGET_FILE,
    }


@dataclass(frozen=True, slots=True)
class RewardTrainingParams:
    """How to train, and how often."""

    task: str = "turn"
    """A task of the kit's, or a task file in the assignment's folder."""
    algorithm: str = "q-learning"
    """``q-learning`` and ``sarsa`` need no extra package; the others want the extra ``learn``."""
    steps: int = 50_000
    seeds: int = 3
    """Number of trainings, each from the start; a single one may be lucky."""
    episodes: int = 100
    """Test episodes after each training, for each case of the task."""


TESTS: Final = 8
"""During a training, for its curve and the newest drive. They decide nothing."""
TEST_EPISODES: Final = 20
"""Episodes per case in one test."""


class TestedTraining:
    """Training callbacks that test the newest policy now and then and show how it went, and end a training when the
    submission's time is used up.

    A test takes nothing from the training: it has worlds, a reward and random numbers of its own.
    """

    __test__ = False  # no test class for pytest

    def __init__(
        self, learner: Learner, evaluator: Evaluator, steps: int, seed: int, progress: TrainingProgressReport
    ) -> None:
        """``steps``: of the whole training. ``seed``: the training's."""
        self._learner = learner
        self._evaluator = evaluator
        self._every = max(1, steps // TESTS)
        self._seed = seed
        self._progress = progress
        self._count = self._tested_steps = 0

    def between_updates(self) -> None:
        """Shows the progress. Raises StudentCodeError when the time is used up."""
        self._progress.clock.check()
        self._progress.show(self._learner.steps)
        if self._learner.steps >= (self._count + 1) * self._every:
            self._test()

    def on_episode_end(self, episode: EpisodeStats) -> None:
        """No-op: tests count, not episodes of training."""

    def test_last_steps(self) -> None:
        """Tests the policy at the end, if the last steps have not been tested."""
        if self._tested_steps < self._learner.steps:
            self._test()

    def _test(self) -> None:
        self._tested_steps = self._learner.steps
        self._count = self._learner.steps // self._every
        recorder, seed = PathRecorder(), derive_seed(self._seed, "test", self._count)
        result = self._evaluator.test(self._learner.policy(), TEST_EPISODES, seed, paths=recorder)
        drive = worst_drive(self._evaluator.task, result, recorder)
        self._progress.add_test(self._learner.steps, result.mean, drive)


def mean_success(
    reward: RewardFunction, budget: RewardTrainingParams, clock: SubmissionClock, folder: Path
) -> float:
    """Returns the share of episodes that reach the target after training with ``reward``, the mean over all seeds.

    ``folder``: the assignment's, which may hold the task's file. Raises StudentCodeError where the student's code fails or
    the submission's time is used up, and LookupError or LearnExtraMissing where the assignment asks for something that is
    not here.
    """
    algorithm, choice = find_algorithm(budget.algorithm), assignment_task(budget.task, folder)
    if algorithm.needs_torch:
        require_learn_extra()
    task = choice.resolve()
    preset = find_preset("kit", algorithm, task.preset)
    evaluator = Evaluator(task)
    shares = []
    for seed in range(budget.seeds):
        learner = make_learner(algorithm, preset, choice, task, seed=seed, reward=reward)
        progress = TrainingProgressReport(clock, seed + 1, budget.seeds, budget.steps)
        training = TestedTraining(learner, evaluator, budget.steps, seed, progress)
        learner.learn(budget.steps, training)
        training.test_last_steps()
        progress.show_exam()
        shares.append(evaluator.test(learner.policy(), budget.episodes, derive_seed(seed, "exam")).mean)
    return fmean(shares)
