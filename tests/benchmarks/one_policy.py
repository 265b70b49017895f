"""One policy, everywhere: ``python tests/benchmarks/one_policy.py [TASK ...]`` (needs the extra ``learn``).

Trains an agent for each of twelve tasks with all goals that there are, two of them in ``policy_tasks`` beside this file, and lets
it drive the same episodes in four ways: in the batch engine, as ``kit evaluate`` does; in a race; as the node that ``--node``
writes; and as the program of a package with its parameters in the package's world. One table: of how many episodes the outcome
is that of the batch engine (reached, collided, timed out), how far the first observation is from there, and in which share of
all steps the command is what the policy itself chooses for what the program has seen.

Lidars have no noise and nothing is disturbed, since the engines draw it differently. Commands take effect 0.01 s later in the
simulator, so that ways differ by millimetres, and by more where a policy decides otherwise for that. What moves by itself has
moved on for these 0.01 s when a program sees it first: a ray that just passes a cart in one way may just meet it in another.

``--episodes N`` (100), ``--first SEED`` (1000), ``--agents FOLDER`` where trained agents are kept (a folder for temporary files).
"""

from __future__ import annotations

import argparse
import base64
import json
import math
import re
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory, gettempdir

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2]))

from kit.arrays import Float32Array, FloatArray
from kit.controllers import find_controller
from kit.document.blocks import CellStyle, Column, Table
from kit.document.layout import lines_of
from kit.host.node_process import NodeProcess
from kit.host.sandbox.limits import INTERACTIVE_LIMITS
from kit.host.sandbox.sandbox_config import INTERACTIVE_LEVEL
from kit.launch.package_creation import place_models
from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.episode_start import EpisodeStart
from kit.learning.environment.episode_stats import EpisodeOutcome
from kit.learning.policies.policy import Policy
from kit.learning.policies.policy_file import load_policy, save_policy
from kit.learning.policies.policy_node import format_policy_node
from kit.learning.policies.policy_package import PROGRAM, create_policy_package
from kit.learning.tasks.catalogue import find_task
from kit.learning.tasks.disturbances import UNDISTURBED
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.run_config import RunConfig
from kit.learning.training.run_folders import create_run
from kit.learning.training.training import train
from kit.run.episode import controller_arguments, run_until, when
from kit.run.scenario import Scenario
from kit.run.session import Session
from kit.school.game.race import RaceFinish, RaceReferee, run_race
from kit.school.game.task_levels import TaskLevel, episode_scenario, task_level
from kit.sim.plugins.laser import LaserParams
from kit.sim.plugins.tween import TweenParams
from kit.sim.simulation import load_world
from kit.world.records import Model

OWN = Path(__file__).with_name("policy_tasks")
TASKS = (
    "turn",
    "gate-anywhere",
    "slalom-run",
    "bay-parking",
    "house-errands",
    "night-watch",
    "vacuum-cleaner",
    "wall-follower",
    "behind-the-cart",
    "two-through-a-hall",
    str(OWN / "clear-of-carts.yaml"),
    str(OWN / "two-in-formation.yaml"),
)
TRAINING_SEED = 1
WAYS = ("race", "node", "package")
SEEN, DONE = "SEEN ", "DONE "
TOLD = f"""
_twists = ExportedPolicy.twists


def _told_twists(self, x):
    twists = _twists(self, x)
    print("{SEEN}" + base64.b64encode(x.astype(np.float32).tobytes()).decode(), flush=True)
    print("{DONE}" + json.dumps(twists), flush=True)
    return twists


ExportedPolicy.twists = _told_twists


"""
"""Makes a node print what it sees and what it does."""


@dataclass(frozen=True, eq=False)
class Driven:
    """One episode."""

    outcome: EpisodeOutcome
    observations: Float32Array
    """(steps, size)"""
    twists: FloatArray
    """(steps, robots, 2) the commands [m/s, rad/s]."""


def agent_of(name: str, folder: Path) -> Policy:
    """The agent of a task, which is trained where there is none of this version yet."""
    spec = TaskSpec(name).frozen()
    task = spec.resolve()
    file = folder / f"{task.name}-{task.version}.npz"
    if not file.exists():
        folder.mkdir(parents=True, exist_ok=True)
        with TemporaryDirectory() as runs:
            run = create_run(Path(runs), RunConfig(spec, "ppo", seed=TRAINING_SEED))
            train(run)
            save_policy(run.policy(), file)
    return load_policy(file)


def without_chance(task: LearningTask) -> LearningTask:
    """The task with exact lidars and motors."""
    return replace(task, lidar_noise=0.0, disturbances=UNDISTURBED)


def evaluated(policy: Policy, task: LearningTask, seed: int) -> Driven:
    """The episode in the batch engine."""
    batch, player = BatchEnv(task, 1, seed, autoreset=False), policy.make_player(1)
    seen = batch.reset(seed=seed, cases=np.zeros(1, dtype=np.int64))
    observations, twists, fresh = [], [], np.ones(1, dtype=np.bool_)
    while True:
        action = player.act(seen, fresh)
        observations.append(seen[0].copy())
        twists.append(task.actions.commands(action, task.robots).twists[0])
        step = batch.step(action)
        seen, fresh = step.observations, np.zeros(1, dtype=np.bool_)
        if step.transition.ended[0]:
            return Driven(EpisodeOutcome.of(step.transition, 0), np.array(observations), np.array(twists))


def exact(scenario: Scenario) -> Scenario:
    """The scenario with lasers that have no noise."""

    def model_of(model: Model) -> Model:
        plugins = tuple(
            replace(each, params=replace(each.params, noise=0.0))
            if isinstance(each.params, LaserParams)
            else each
            for each in model.plugins
        )
        return replace(model, plugins=plugins)

    return replace(
        scenario, world=replace(scenario.world, models=tuple(map(model_of, scenario.world.models)))
    )


def in_a_race(level: TaskLevel, scenario: Scenario, program: Path) -> Driven:
    """The episode in a race."""
    printed: list[str] = []
    kept: list[Session] = []

    def install(session: Session) -> None:
        kept.append(session)
        session.drive_with(find_controller(str(program)))
        session.wait_until_driven()

    def listen(seconds: float) -> None:
        printed.extend(record.text for record in kept[0].messages)
        kept[0].messages.clear()

    finish, _ = run_race(level, scenario, install, listen)
    listen(0.0)
    return driven(finish, printed)


def as_a_program(level: TaskLevel, scenario: Scenario, program: Path, arguments: Sequence[str]) -> Driven:
    """The episode with a program that drives in the scenario's world, and is judged as in a race."""
    printed: list[str] = []
    with Session(scenario, seed=1, always_scan=level.goal.reads_lidar) as session:
        referee = RaceReferee(level, scenario)
        session.runner.observers.append(referee)
        process = NodeProcess(
            session.graph,
            program,
            args=arguments,
            seed=1,
            limits=INTERACTIVE_LIMITS,
            level=INTERACTIVE_LEVEL,
        )
        try:
            process.wait_until_started()
            process.join()
            session.runner.participants.append(process)

            def listen(tick: int) -> None:
                if tick % 50 == 0:
                    printed.extend(line.text for line in process.take_output().lines)

            limit = math.ceil(level.time_limit / session.runner.step_size)
            run_until(session.runner, ticks=limit, ends=(when(lambda: referee.is_over),), before_tick=listen)
            listen(0)
        finally:
            process.close()
    return driven(referee.finish, printed)


def driven(finish: RaceFinish, printed: Sequence[str]) -> Driven:
    """What came of a drive whose program printed these lines."""
    outcome = EpisodeOutcome.TIMED_OUT
    if finish.collisions:
        outcome = EpisodeOutcome.COLLIDED
    elif finish.reached:
        outcome = EpisodeOutcome.REACHED
    seen = [
        np.frombuffer(base64.b64decode(each.removeprefix(SEEN)), np.float32)
        for each in printed
        if each.startswith(SEEN)
    ]
    done = [json.loads(each.removeprefix(DONE)) for each in printed if each.startswith(DONE)]
    return Driven(outcome, np.array(seen), np.array(done))


@contextmanager
def programs(policy: Policy) -> Iterator[tuple[Path, Path]]:
    """A policy's node and its package, whose programs also print what they see and do."""
    with TemporaryDirectory() as folder:
        node = Path(folder, "agent.py")
        node.write_text(telling(format_policy_node(policy)))
        package = create_policy_package(policy, "agent_package", Path(folder))
        program = package / package.name / f"{PROGRAM}.py"
        program.write_text(telling(program.read_text()))
        yield node, package


def telling(program: str) -> str:
    """A node's program that prints what it sees and does."""
    return program.replace('if __name__ == "__main__":', TOLD + 'if __name__ == "__main__":')


def in_the_package(scenario: Scenario, package: Path) -> Scenario:
    """The scenario in the package's own world, with its models where the episode begins."""
    file = package / "world" / "world.yaml"
    place_models(file, {model.name: model.pose for model in scenario.world.models})
    motions = {model.name: {each.name: each for each in model.plugins} for model in scenario.world.models}
    world = load_world(file)
    models = tuple(
        replace(
            model,
            plugins=tuple(
                motions[model.name][each.name] if isinstance(each.params, TweenParams) else each
                for each in model.plugins
            ),
        )
        for model in world.models
    )
    order = [model.name for model in scenario.world.models]
    models = tuple(sorted(models, key=lambda model: order.index(model.name)))
    return exact(replace(scenario, world=replace(world, models=models)))


def package_arguments(package: Path, start: EpisodeStart, level: TaskLevel) -> list[str]:
    """The arguments that the package's launch file gives its program, with the target of this episode where it is drawn."""
    arguments = ["--ros-args", "--params-file", str(package / "config" / f"{package.name}.yaml")]
    case = level.learning_task.map_cases()[0][1]
    is_drawn = level.goal.has_standing_targets and not level.goal.is_route and case.targets.model is None
    if is_drawn:
        arguments += ["-p", f"target:=[{start.target.x!r}, {start.target.y!r}]"]
    return arguments


@dataclass(frozen=True)
class Agreement:
    """One way beside the batch engine, over all episodes."""

    same_outcomes: int
    episodes: int
    first_difference: float
    """Of the first observation, at most."""
    same_commands: float
    """Share of all steps."""

    @classmethod
    def of(cls, policy: Policy, task: LearningTask, pairs: Sequence[tuple[Driven, Driven]]) -> Agreement:
        """Of the episodes as the batch engine drove them and as the other way did."""
        firsts = [np.abs(one.observations[0] - other.observations[0]).max() for one, other in pairs]
        same = [
            np.isclose(chosen_for(policy, task, each.observations), each.twists, atol=1e-5).all(axis=(1, 2))
            for _, each in pairs
        ]
        return cls(
            sum(one.outcome is other.outcome for one, other in pairs),
            len(pairs),
            float(max(firsts)),
            float(np.concatenate(same).mean()),
        )


def chosen_for(policy: Policy, task: LearningTask, observations: Float32Array) -> FloatArray:
    """(steps, robots, 2) the commands that a policy chooses for what has been seen in an episode."""
    player, fresh = policy.make_player(1), np.ones(1, dtype=np.bool_)
    found = []
    for seen in observations:
        found.append(task.actions.commands(player.act(seen[None], fresh), task.robots).twists[0])
        fresh = np.zeros(1, dtype=np.bool_)
    return np.array(found)


def compare(policy: Policy, file: Path, seeds: Sequence[int]) -> tuple[float, dict[str, Agreement]]:
    """The share of the episodes that the batch engine reached, and how each way agrees with it."""
    level, task = task_level(file), without_chance(policy.trained_on.resolve())
    pairs: dict[str, list[tuple[Driven, Driven]]] = {way: [] for way in WAYS}
    reached = 0
    with programs(policy) as (node, package):
        for seed in seeds:
            start = EpisodeStart.drawn(task, seed)
            scenario = exact(episode_scenario(level, start))
            expected = evaluated(policy, task, seed)
            reached += expected.outcome is EpisodeOutcome.REACHED
            own = in_the_package(scenario, package)
            program = package / package.name / f"{PROGRAM}.py"
            arguments = package_arguments(package, start, level)
            for way, found in (
                ("race", in_a_race(level, scenario, node)),
                ("node", as_a_program(level, scenario, node, controller_arguments(scenario))),
                ("package", as_a_program(level, own, program, arguments)),
            ):
                pairs[way].append((expected, found))
    return reached / len(seeds), {way: Agreement.of(policy, task, found) for way, found in pairs.items()}


def rows_of(name: str, share: float, found: dict[str, Agreement]) -> list[tuple[str | float, ...]]:
    """The rows of one task, a way each."""
    return [
        (
            name if way == WAYS[0] else "",
            share if way == WAYS[0] else "",
            way,
            f"{each.same_outcomes} of {each.episodes}",
            each.first_difference,
            each.same_commands,
        )
        for way, each in found.items()
    ]


def main() -> None:
    """Reads the arguments, trains what is missing, compares, and prints the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("tasks", nargs="*", default=TASKS)
    parser.add_argument("--episodes", type=int, default=100)
    parser.add_argument("--first", type=int, default=1000)
    parser.add_argument("--agents", type=Path, default=Path(gettempdir(), "one-policy-agents"))
    given = parser.parse_args()
    rows: list[tuple[str | float, ...]] = []
    for name in given.tasks:
        file = find_task(name).file
        assert file is not None  # every task is a file
        policy = agent_of(name, given.agents)
        seeds = range(given.first, given.first + given.episodes)
        share, found = compare(policy, file, seeds)
        rows += rows_of(re.sub(r".*/|\.yaml", "", name), share, found)
        print(
            f"{name}: {', '.join(f'{way} {each.same_outcomes}' for way, each in found.items())}", flush=True
        )
    columns = (
        Column("task", CellStyle.TEXT),
        Column("reached", decimals=3),
        Column("way", CellStyle.TEXT),
        Column("same outcome", CellStyle.TEXT),
        Column("first observation", decimals=5),
        Column("same commands", decimals=3),
    )
    print("\n".join(lines_of([Table("one policy", "", columns, tuple(rows), "")])))


if __name__ == "__main__":
    main()
