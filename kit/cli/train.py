"""``kit train``, ``watch`` and ``runs``: starts a training or goes on with one, follows it, lists all and keeps them."""

from __future__ import annotations

import json
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import click
from click.core import ParameterSource

from kit.cli import learning_options, messages, options, terminal_options
from kit.cli.existing_path import ExistingPath
from kit.cli.full_screen import run_screen, show_screen
from kit.cli.shared_game import join_shared_game
from kit.document.layout import lines_of
from kit.learning.authoring.task_text import tasks_table
from kit.learning.maps.batch_map import UnsupportedWorld
from kit.learning.tasks.catalogue import all_tasks, dissertation_tasks, first_tasks
from kit.learning.tasks.disturbances import UniformRange
from kit.learning.tasks.learning_task import UnknownTask
from kit.learning.tasks.rewards import REWARDS
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.algorithms import ALGORITHMS, IMITATION_ALGORITHMS, algorithms_for, find_algorithm
from kit.learning.training.demonstrations import is_recording
from kit.learning.training.events import EventReader, TrainingEnded, TrainingProgress
from kit.learning.training.learn_extra import require_learn_extra
from kit.learning.training.run_check import check_run_config
from kit.learning.training.run_config import MAX_WORLDS, PresetName, RunConfig, RunError
from kit.learning.training.run_folders import create_run, find_run, left_out, list_runs
from kit.learning.training.run_text import format_event
from kit.learning.training.run_upkeep import delete_run, disk_bytes, read_overviews, rename_run, runs_blocks
from kit.learning.training.runs import TrainingRun
from kit.learning.training.training import resolve_preset
from kit.learning.training.worker import start_worker
from kit.plain_text import format_size
from kit.school.game.shared_sockets import SharedGameError, find_game, games_folder
from kit.school.game.task_levels import race_command
from kit.tui.terminal import TerminalDecision
from kit.world.problems import WorldError

if TYPE_CHECKING:
    from kit.tui.app import KitApp
    from kit.tui.screens.training import TrainingScreen
    from kit.tui.screens.trainings import TrainingsScreen


PROGRESS_INTERVAL_S = 2.0
"""Shortest time between two lines of progress; other events are all printed."""


@click.command()
@click.argument("run", required=False)
@click.option("--once", is_flag=True, help="Print what has happened so far, and exit.")
@options.workspace
@learning_options.plain
@terminal_options.glyphs
@terminal_options.color
def watch_command(
    run: str | None, once: bool, workspace: Path | None, plain: bool, glyphs: str | None, color: str | None
) -> None:
    """Watch RUN (default: the last one, or with no runs the game hosted here): its curve, how its episodes end, the robot with its newest policy.

    Ctrl-C stops watching; the training continues. RUN can also be a game hosted on this machine with
    `kit game host`.
    """
    if not once and _is_hosted(run, workspace):
        join_shared_game(run, None, plays=False, plain=plain)
    with learning_options.explained_errors():
        found = find_run(learning_options.runs_folder(workspace), run)
        found.config()
        terminal = terminal_options.decide(plain=plain or once, glyphs=glyphs, color=color)
        if terminal.plain.value:
            follow(found, once=once)
        else:
            open_training_screen(found, terminal)


def _is_hosted(name: str | None, workspace: Path | None) -> bool:
    """Whether a game of that name is hosted, and no training has it; without a name, whether one is hosted and there are no
    trainings."""
    try:
        find_game(games_folder(), name)
    except SharedGameError:
        return False
    try:
        find_run(learning_options.runs_folder(workspace), name)
    except RunError:
        return True
    return False


def _names_settings() -> bool:
    """Whether options were given that only a task's training has a use for."""
    context, of_screens = click.get_current_context(), ("workspace", "plain", "glyphs", "color")
    given = (context.get_parameter_source(each) for each in context.params if each not in of_screens)
    return any(source is ParameterSource.COMMANDLINE for source in given)


def _trainings_screen(app: KitApp, workspace: Path | None) -> TrainingsScreen:
    from kit.tui.screens.trainings import TrainingsScreen

    return TrainingsScreen(app.kit_theme, learning_options.runs_folder(workspace))


def open_training_screen(run: TrainingRun, terminal: TerminalDecision) -> None:
    """Opens the training screen; exit code 1 if the training has failed by the time it is left."""

    def make_screen(app: KitApp) -> TrainingScreen:
        from kit.tui.screens.training import TrainingScreen

        return TrainingScreen(app.kit_theme, run)

    screen, code = run_screen(terminal, make_screen)
    if screen.state == "interrupted" and run.last_log_line:
        click.echo(run.last_log_line)
    click.echo(screen.farewell)
    if screen.state == "finished":
        _suggest_race(run)
    if code or screen.state == "failed":
        raise SystemExit(code or 1)


def follow(run: TrainingRun, *, once: bool = False, reader: EventReader | None = None) -> None:
    """Prints a run's events as they come, until its training has ended; exit code 1 if it failed.

    ``reader``: of its events, if not all of them.
    """
    reader = reader or EventReader(run.events_file)
    printed_at, ended = -PROGRESS_INTERVAL_S, None
    try:
        while True:
            is_active = run.is_active  # asked first: whatever is written before the end is read below
            for event in reader.read_new():
                if isinstance(event, TrainingProgress):
                    if event.seconds - printed_at < PROGRESS_INTERVAL_S:
                        continue
                    printed_at = event.seconds
                ended = event if isinstance(event, TrainingEnded) else None
                click.echo(format_event(event))
            if once or not is_active:
                break
            time.sleep(0.1)
    except KeyboardInterrupt:
        messages.say(
            f"\n{run.name} continues training. `kit watch {run.name}` shows it again, `kit runs {run.name} --stop` stops it."
        )
        return
    if ended is None:
        if not once or not run.is_active:
            if run.last_log_line:
                click.echo(run.last_log_line)
            messages.say(
                f"{run.name} was interrupted. `kit train --resume {run.name}` continues from its last checkpoint."
            )
    elif ended.how == "failed":
        raise SystemExit(1)
    elif not once:
        click.echo(f"`kit evaluate {run.name}` tests the best policy.")
        _suggest_race(run)


def _suggest_race(run: TrainingRun) -> None:
    """Prints how the agent is raced, where it can be and its task is still there."""
    with suppress(RunError, UnknownTask, UnsupportedWorld, WorldError):
        if race := race_command(run.config().choice.resolve(), run.name):
            click.echo(f"`{race}` races it.")


@click.command()
@click.argument("task", required=False)
@click.option("--algo", help="Algorithm, see above (default: ppo).")
@click.option(
    "--imitate",
    metavar="WHOM",
    multiple=True,
    help="Learn from a recorded drive, controller, run or policy instead of a reward; repeat for more.",
)
@click.option(
    "--preset",
    type=click.Choice(("kit", "seed", "seed-text")),
    default="kit",
    show_default=True,
    help="Settings: the kit's own (kit); the dissertation's, as its code ran (seed) or as its text says (seed-text).",
)
@learning_options.on
@click.option(
    "--reward",
    "reward_file",
    type=ExistingPath(dir_okay=False, path_type=Path),
    help="Your own reward: a Python file with reward(); each function metric_NAME() in it only adds a curve.",
)
@click.option("--algorithm-reward", "reward", help="Use another of the kit's rewards, by name.")
@click.option("--scale", type=float, help="Multiply the reward by this factor.")
@click.option("--seed", type=click.IntRange(0, 2**31 - 1), default=0, show_default=True, help="Random seed.")
@click.option(
    "--steps",
    type=click.IntRange(1),
    help="Stop after the batch that reaches this many steps (default: the preset's).",
)
@click.option(
    "--worlds",
    type=click.IntRange(1, MAX_WORLDS),
    help="Number of worlds simulated at once (default: the preset's).",
)
@click.option(
    "--learning-rate",
    type=click.FloatRange(0, min_open=True),
    help="Constant learning rate (default: the preset's).",
)
@learning_options.settings_option("NAME=NUMBER", "gamma=0.95")
@click.option(
    "--goal", type=click.FloatRange(0, 1), help="Stop at this success rate (default: the preset's)."
)
@click.option("--keep-training", is_flag=True, help="Train to the last step, whatever the tests show.")
@click.option(
    "--mirrored", is_flag=True, help="Mirror half of the worlds, so that left turns teach right turns too."
)
@click.option(
    "--measured-to", type=click.Choice(("hull", "axle")), help="Part of the robot that must reach the target."
)
@click.option("--tell-target", is_flag=True, help="Tell the agent the distance and rotation to its target.")
@click.option("--tell-arrived", is_flag=True, help="Tell the agents which of them have arrived.")
@click.option(
    "--timeout-terminal", is_flag=True, help="Treat a timeout as a terminal state, like a crash (incorrect)."
)
@learning_options.disturbances
@click.option("--name", help="Name of the run.")
@click.option("--resume", metavar="RUN", help="Resume a run that was stopped or killed.")
@click.option("--detach", is_flag=True, help="Start the training without watching it.")
@click.option(
    "--list",
    "listed",
    is_flag=True,
    help="List tasks, cases, algorithms and rewards; with TASK, the settings that --set can change.",
)
@options.workspace
@learning_options.plain
@terminal_options.glyphs
@terminal_options.color
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
    settings: dict[str, tuple[float, ...]],
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
    """Train an agent for TASK in a separate process, and watch it. Without TASK, list the trainings on a full screen.

    Ctrl-C stops watching; the training continues, also if the connection drops. `kit watch` shows it again,
    `kit runs --stop` stops it.

    \b
    kit train turn
    kit train hallway --on doors,straight --algo dqn
    kit train turn --reward my_reward.py --name mine
    kit train turn --set gamma=0.95 --set n_steps=64
    kit train turn --latency 0:0.2 --wheel-radius -0.1:0.1 --drift -0.2:0.2

    A task's actions are discrete, or continuous (smooth-turn). For discrete actions
    --algo takes ppo, a2c, dqn, boltzmann-dqn, qrdqn, trpo, recurrent-ppo,
    maskable-ppo, ars, q-learning and sarsa; for continuous ones ppo, a2c, trpo,
    recurrent-ppo, sac, td3, ddpg, tqc and crossq. See also --list.

    With --imitate the agent learns from demonstrations on the same maps: by bc
    (behaviour cloning), or by dagger, which asks the demonstrator what to do in the
    states that the learner visits, and so needs more than a recording.

    \b
    kit drive turn --controller teleop --record drive.npz
    kit train smooth-turn --imitate drive.npz
    kit train smooth-turn --imitate fields

    The options from --lidar-noise to --drift make the simulation differ from its
    files, as a real robot does. For a range LOW:HIGH, each episode draws a new value
    (domain randomisation).
    """
    if listed and task is None:
        click.echo("\n".join(_list_tasks()))
        return
    terminal = None if detach else terminal_options.decide(plain=plain, glyphs=glyphs, color=color)
    with learning_options.explained_errors():
        if resume is not None:
            _go_on(resume, workspace, terminal)
            return
        if listed and task is not None:
            click.echo("\n".join(_list_settings(task, algo or "ppo", preset)))
            return
        if task is None:
            if terminal is not None and not terminal.plain.value and not _names_settings():
                show_screen(terminal, lambda app: _trainings_screen(app, workspace))
            raise click.UsageError(
                "Which task? `kit train --list` lists them; `kit train turn` is the first."
            )
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
        if several := [name for name, numbers in settings.items() if len(numbers) > 1]:
            raise click.UsageError(
                f"A training has one number for {several[0]}; `kit sweep --set` compares several."
            )
        if learning_rate is not None and "learning_rate" in settings:
            raise click.UsageError("--learning-rate and --set learning_rate are the same: give one of them.")
        demonstrations = learning_options.find_demonstrations(imitate, workspace)
        config = RunConfig(
            choice,
            algorithm=algo or _usual_algorithm(demonstrations),
            preset=preset,
            seed=seed,
            steps=steps,
            worlds=worlds,
            learning_rate=learning_rate,
            goal=goal,
            keep_training=keep_training,
            reward_file=None if reward_file is None else str(reward_file.absolute()),
            mirrored=mirrored,
            imitate=tuple(map(str, demonstrations)),
            settings=tuple((name, number) for name, (number,) in settings.items()),
        )
        _begin_run(config, name, workspace, terminal)


def _usual_algorithm(demonstrations: tuple[Path, ...]) -> str:
    if not demonstrations:
        return "ppo"
    return "bc" if any(map(is_recording, demonstrations)) else "dagger"


def _begin_run(
    config: RunConfig, name: str | None, workspace: Path | None, terminal: TerminalDecision | None
) -> None:
    """Checks everything that can be wrong before anything is written."""
    check_run_config(config)
    _start_run(create_run(learning_options.runs_folder(workspace), config, name), terminal)


def _go_on(name: str, workspace: Path | None, terminal: TerminalDecision | None) -> None:
    run = find_run(learning_options.runs_folder(workspace), name)
    run.config()
    summary = run.summary()
    if summary.state in ("running", "paused"):
        run.send_command("go")
        click.echo(f"{run.name} is training; if it was paused, it continues.")
        if terminal is not None:
            _show_training(run, terminal)
        return
    if summary.state == "finished":
        raise RunError(
            f"{run.name} has finished: {summary.reason}. `kit evaluate {run.name}` tests it; train again with "
            "another --seed."
        )
    _start_run(run, terminal)


def _start_run(run: TrainingRun, terminal: TerminalDecision | None) -> None:
    """``terminal``: where to watch it; None: nowhere."""
    reader = EventReader(run.events_file, from_now=True)
    process = start_worker(run)
    click.echo(f"{run.name}: training in {run.folder}")
    if terminal is None:
        click.echo(f"`kit watch {run.name}` shows its progress.")
        return
    try:
        _show_training(run, terminal, reader)
    finally:
        if not run.is_active:
            process.wait()


def _show_training(run: TrainingRun, terminal: TerminalDecision, reader: EventReader | None = None) -> None:

    if terminal.plain.value:
        follow(run, reader=reader)
    else:
        open_training_screen(run, terminal)


def _list_settings(task: str, algo: str, preset: PresetName) -> list[str]:
    """A line for each setting of an algorithm on a task: its name, and the preset's number."""
    config, algorithm = RunConfig(TaskSpec(task), algo, preset), find_algorithm(algo)
    if algorithm.needs_torch:
        require_learn_extra()
    found = resolve_preset(config)
    lines = [f"Settings of {algo} on {task}, preset {preset}:"]
    for name in found.setting_types(algorithm):
        own = f"{algorithm.library_defaults().get(name)} (the library's)"
        lines.append(f"  {name:24} {found.number_of(name) or own}")
    return lines


def _list_tasks() -> list[str]:
    tasks = all_tasks()
    lines = ["Tasks:", *lines_of([tasks_table(first_tasks(), indent=2)])]
    lines += ["\nTasks as in the dissertation (-as-run: as its code ran, not as its text says):"]
    lines += lines_of([tasks_table(dissertation_tasks(), indent=2)])
    lines.append("\nCases, by group:")
    for task in tasks:
        if task.name.endswith(("-seed", "-seed-49")):  # the same cases as its namesake's
            continue
        groups: dict[str, list[str]] = {}
        for _, case in task.map_cases():
            groups.setdefault(case.group or "(no group)", []).append(case.name)
        lines += [f"  {task.name:18} {group:12} {', '.join(cases)}" for group, cases in groups.items()]
    for title, is_continuous in (("discrete actions", False), ("continuous actions", True)):
        rows = [ALGORITHMS[name] for name in algorithms_for(is_continuous=is_continuous)]
        lines.append(f"\nAlgorithms for {title}:")
        lines += [f"  {row.name:20} {row.title} ({row.library})" for row in rows]
    lines.append("\nImitation algorithms:")
    lines += [f"  {row.name:20} {row.title} ({row.library})" for row in IMITATION_ALGORITHMS.values()]
    return [*lines, "\nRewards:", *(f"  {name}" for name in REWARDS)]


@click.command()
@click.argument("run", required=False)
@click.option("--pause", "order", flag_value="pause", help="Pause the training.")
@click.option("--go", "order", flag_value="go", help="Resume a paused training.")
@click.option(
    "--stop", "order", flag_value="stop", help="Stop the training; `kit train --resume` can resume it."
)
@click.option("--rename", "new_name", metavar="NAME", help="Rename RUN.")
@click.option(
    "--delete", "deleted", is_flag=True, help="Delete RUN and everything it has learned; asks first."
)
@click.option("--yes", is_flag=True, help="With --delete: do not ask.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@options.workspace
def runs_command(
    run: str | None,
    order: Literal["pause", "go", "stop"] | None,
    new_name: str | None,
    deleted: bool,
    yes: bool,
    as_json: bool,
    workspace: Path | None,
) -> None:
    """List the training runs, or show RUN, or change it.

    The list shows the disk space of each run and, while it trains, the longest time that it still needs. --pause,
    --go and --stop act on the last run if no RUN is given.

    \b
    kit runs
    kit runs mine --rename first-try
    kit runs first-try --delete
    """
    if run is None and (new_name is not None or deleted):
        raise click.UsageError(f"Which run? `kit runs NAME {'--delete' if deleted else '--rename NEW'}`.")
    with learning_options.explained_errors():
        folder = learning_options.runs_folder(workspace)
        if new_name is not None:
            renamed = rename_run(find_run(folder, run), new_name)
            click.echo(f"{run} is now called {renamed.name}.")
        elif deleted:
            _delete_run(find_run(folder, run), yes)
        elif order is not None:
            _send_order(find_run(folder, run), order)
        elif run is not None:
            _show_run(find_run(folder, run), as_json)
        elif as_json:
            rows = [
                {"name": each.name, **each.summary().as_dict(), "disk_bytes": disk_bytes(each)}
                for each in list_runs(folder)
            ]
            click.echo(json.dumps(rows, indent=2))
        else:
            found, foreign = list_runs(folder), left_out(folder)
            if found:
                click.echo("\n".join(lines_of(runs_blocks(read_overviews(found)))))
            elif not foreign:
                click.echo("No runs yet. `kit train turn` starts one.")
            for problem in foreign:
                click.echo(problem, err=True)


def _delete_run(run: TrainingRun, yes: bool) -> None:
    if not yes and not click.confirm(
        f"Delete {run.name} with its policies and curves ({format_size(disk_bytes(run))})?", default=False
    ):
        click.echo("Kept.")
        return
    click.echo(f"{run.name} is deleted; this frees {format_size(delete_run(run))}.")


def _send_order(run: TrainingRun, order: Literal["pause", "go", "stop"]) -> None:
    if not run.is_active:
        raise RunError(f"{run.name} is not training. `kit train --resume {run.name}` resumes it.")
    run.send_command(order)
    click.echo(f"{run.name}: {order}.")


def _show_run(run: TrainingRun, as_json: bool) -> None:
    config, summary = run.config(), run.summary()
    if as_json:
        click.echo(json.dumps({"name": run.name, "config": config.as_dict(), **summary.as_dict()}, indent=2))
        return
    click.echo(
        f"{run.name}: {config.choice.title}, {config.algorithm}, {config.preset_text}, seed {config.seed}"
    )
    click.echo(f"{summary.state}, {summary.steps:,} steps in {summary.seconds:.1f} s  {summary.reason}")
    for title, test in (("last test", summary.last_evaluation), ("best", summary.best_evaluation)):
        if test is not None:
            click.echo(f"{title:10}{format_event(test).strip()}")
    click.echo(f"in {run.folder}")
