"""``kit train``: start a training, or go on with one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import click

from kit.cli import learning_options, options

if TYPE_CHECKING:
    from kit.learning.environment.disturbances import UniformRange
    from kit.learning.training.events import EventReader
    from kit.learning.training.runs import RunConfig, TrainingRun
    from kit.tui.terminal import TerminalDecision


@click.command()
@click.argument("task", required=False)
@click.option("--algo", help="By which algorithm, see below; by default ppo.")
@click.option(
    "--imitate",
    metavar="WHOM",
    multiple=True,
    help="Learn from a recorded drive, a controller, a run or a policy, not from a reward; give it again for more.",
)
@click.option(
    "--preset",
    type=click.Choice(("kit", "seed", "seed-text")),
    default="kit",
    show_default=True,
    help="Settings: the kit's own; the dissertation's as its code ran; as its text says.",
)
@learning_options.on
@click.option(
    "--reward",
    "reward_file",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Your own reward: a Python file with reward(); functions metric_NAME() in it are only counted, a curve each.",
)
@click.option("--algorithm-reward", "reward", help="Another one of the kit's rewards, by name.")
@click.option("--scale", type=float, help="Multiplies the reward.")
@click.option(
    "--seed", type=click.IntRange(0, 2**31 - 1), default=0, show_default=True, help="Of all chance."
)
@click.option(
    "--steps",
    type=click.IntRange(1),
    help="Ends with the batch that reaches so many; by default the preset's.",
)
@click.option("--worlds", type=click.IntRange(1, 100_000), help="So many at once; by default the preset's.")
@click.option(
    "--learning-rate", type=click.FloatRange(0, min_open=True), help="Constant; by default the preset's."
)
@click.option("--goal", type=click.FloatRange(0, 1), help="Stop at this success; by default the preset's.")
@click.option("--keep-training", is_flag=True, help="To the last step, whatever tests say.")
@click.option("--mirrored", is_flag=True, help="Half of the worlds are seen in a mirror: left helps right.")
@click.option(
    "--measured-to", type=click.Choice(("hull", "axle")), help="What of the robot must be near the target."
)
@click.option("--tell-target", is_flag=True, help="The agent is told distance and rotation to the target.")
@click.option("--tell-arrived", is_flag=True, help="The agents are told who has arrived.")
@click.option(
    "--timeout-terminal", is_flag=True, help="Running out of time ends an episode like a crash (wrong)."
)
@learning_options.disturbances
@click.option("--name", help="Of the run.")
@click.option("--resume", metavar="RUN", help="Go on with a run that was stopped or killed.")
@click.option("--detach", is_flag=True, help="Do not watch; the training goes on either way.")
@click.option("--list", "listed", is_flag=True, help="List tasks, cases, algorithms and rewards.")
@options.workspace
@learning_options.plain
@options.glyphs
@options.color
def command(
    task: str | None,
    algo: str | None,
    imitate: tuple[str, ...],
    preset: Literal["kit", "seed", "seed-text"],
    on: str | None,
    reward_file: Path | None,
    reward: str | None,
    scale: float | None,
    seed: int,
    steps: int | None,
    worlds: int | None,
    learning_rate: float | None,
    goal: float | None,
    keep_training: bool,
    mirrored: bool,
    measured_to: Literal["hull", "axle"] | None,
    tell_target: bool,
    tell_arrived: bool,
    timeout_terminal: bool,
    disturbed: Mapping[str, UniformRange],
    name: str | None,
    resume: str | None,
    detach: bool,
    listed: bool,
    workspace: Path | None,
    plain: bool,
    glyphs: str | None,
    color: str | None,
) -> None:
    """Train an agent for TASK in a process of its own, and watch it.

    Ctrl-C ends the watching, not the training: `kit watch` looks again, `kit runs --stop` stops it. It also goes on
    when the connection drops.

    \b
    kit train turn
    kit train hallway --on doors,straight --algo dqn
    kit train turn --reward my_reward.py --name mine
    kit train turn --latency 0:0.2 --wheel-radius -0.1:0.1 --drift -0.2:0.2

    A task's actions are a table to choose from, or continuous (smooth-turn). With
    --algo the first are learned by ppo, a2c, dqn, boltzmann-dqn, qrdqn, trpo,
    recurrent-ppo, maskable-ppo, ars, q-learning and sarsa; continuous ones by ppo,
    a2c, trpo, recurrent-ppo, sac, td3, ddpg, tqc and crossq. `--list` says more.

    With --imitate it learns from what others do, on the same maps: by bc (behaviour
    cloning), or by dagger, which also shows the way from where the learner comes to
    and so needs somebody who can be asked, not a recording.

    
    kit play turn --controller teleop --record drive.npz
    kit train smooth-turn --imitate drive.npz
    kit train smooth-turn --imitate fields

    The options from --lidar-noise to --drift make the simulation differ from its
    files, as a robot does. A range is drawn from again for every episode, so that
    the agent learns to drive under all of it (domain randomisation).
    """
    if listed:
        click.echo("\n".join(_list()))
        return
    terminal = None if detach else options.terminal(plain=plain, glyphs=glyphs, color=color)
    with learning_options.explained_errors():
        if resume is not None:
            _go_on(resume, workspace, terminal)
            return
        if task is None:
            raise click.UsageError(
                "Which task? `kit train --list` lists them; `kit train turn` is the first."
            )
        from kit.learning.environment.tasks import TaskSpec
        from kit.learning.training.runs import RunConfig

        choice = TaskSpec(
            task,
            learning_options.split_names(on),
            measured_to=measured_to,
            tells_target=tell_target or None,
            tells_arrived=tell_arrived or None,
            reward=reward,
            scale=scale,
            timeout_terminal=timeout_terminal or None,
        )
        if disturbed:
            own = choice.resolve().disturbances
            choice = replace(choice, disturbances=own.changed(disturbed))
            click.echo(f"Under {choice.disturbances}.")
        demonstrations = learning_options.find_demonstrations(imitate, workspace)
        config = RunConfig(
            choice,
            *(
                algo or _usual_algorithm(demonstrations),
                preset,
                seed,
                steps,
                worlds,
                learning_rate,
                goal,
                keep_training,
            ),
            reward_file=None if reward_file is None else str(reward_file.absolute()),
            mirrored=mirrored,
            imitate=tuple(map(str, demonstrations)),
        )
        _begin(config, name, workspace, terminal)


def _usual_algorithm(demonstrations: tuple[Path, ...]) -> str:
    from kit.learning.training.demonstrations import is_recording

    if not demonstrations:
        return "ppo"
    return "bc" if any(map(is_recording, demonstrations)) else "dagger"


def _begin(
    config: RunConfig, name: str | None, workspace: Path | None, terminal: TerminalDecision | None
) -> None:
    """Checks everything that can be wrong before anything is written."""
    from kit.learning.training.run_check import check_run_config
    from kit.learning.training.runs import create_run

    check_run_config(config)
    _start(create_run(learning_options.runs_folder(workspace), config, name), terminal)


def _go_on(name: str, workspace: Path | None, terminal: TerminalDecision | None) -> None:
    from kit.learning.training.runs import RunError, find_run

    run = find_run(learning_options.runs_folder(workspace), name)
    run.config()
    summary = run.summary()
    if summary.state in ("running", "paused"):
        run.send_command("go")
        click.echo(f"{run.name} is being trained; if it paused, it goes on.")
        if terminal is not None:
            _show(run, terminal)
        return
    if summary.state == "finished":
        raise RunError(
            f"{run.name} has finished: {summary.reason}. `kit evaluate {run.name}` tests it; start another with "
            "another --seed."
        )
    _start(run, terminal)


def _start(run: TrainingRun, terminal: TerminalDecision | None) -> None:
    """``terminal``: where to watch it; None: nowhere."""
    from kit.learning.training.events import EventReader
    from kit.learning.training.worker import start_worker

    reader = EventReader(run.events_file, from_now=True)
    process = start_worker(run)
    click.echo(f"{run.name}: training in {run.folder}")
    if terminal is None:
        click.echo(f"`kit watch {run.name}` shows how it goes.")
        return
    try:
        _show(run, terminal, reader)
    finally:
        if not run.is_active:
            process.wait()


def _show(run: TrainingRun, terminal: TerminalDecision, reader: EventReader | None = None) -> None:
    from kit.cli.watch import follow, open_training_screen

    if terminal.plain.value:
        follow(run, reader=reader)
    else:
        open_training_screen(run, terminal)


def _list() -> list[str]:
    from kit.learning.environment.rewards import REWARDS
    from kit.learning.environment.tasks import all_tasks
    from kit.learning.training.algorithms import ALGORITHMS, IMITATION_ALGORITHMS, algorithms_for

    tasks = all_tasks()
    lines = ["Tasks:", *(f"  {task.name:20} {task.summary}" for task in tasks)]
    lines.append("\nCases, by group:")
    for task in tasks:
        if task.name.endswith(("-seed", "-seed-49")):  # the same cases as its namesake's
            continue
        groups: dict[str, list[str]] = {}
        for _, case in task.map_cases():
            groups.setdefault(case.group or "(no group)", []).append(case.name)
        lines += [f"  {task.name:18} {group:12} {', '.join(cases)}" for group, cases in groups.items()]
    for title, is_continuous in (("a table of actions", False), ("continuous actions", True)):
        rows = [ALGORITHMS[name] for name in algorithms_for(is_continuous=is_continuous)]
        lines.append(f"\nAlgorithms for {title}:")
        lines += [f"  {row.name:20} {row.title} ({row.library})" for row in rows]
    lines.append("\nAlgorithms that imitate:")
    lines += [f"  {row.name:20} {row.title} ({row.library})" for row in IMITATION_ALGORITHMS.values()]
    return [*lines, "\nRewards:", *(f"  {name}" for name in REWARDS)]
