"""``kit evaluate`` and ``compare``: how good policies are, case by case and side by side."""

from __future__ import annotations

import json
import shutil
import sys
from collections.abc import Mapping
from pathlib import Path

import click

from kit.cli import learning_options, messages, options
from kit.cli.output_file import OutputFile
from kit.cli.process import INTERRUPTED
from kit.document.layout import Page, lines_of
from kit.learning.policies.episode_paths import record_paths
from kit.learning.policies.evaluation import evaluate_on
from kit.learning.policies.paths_picture import build_paths_scene
from kit.learning.policies.policy import Policy
from kit.learning.policies.policy_node import format_policy_node
from kit.learning.policies.policy_package import create_policy_package
from kit.learning.policies.seeds import derive_seed
from kit.learning.policies.sweep import PolicySweep, find_kinds, sweep_blocks, sweep_csv
from kit.learning.tasks.disturbances import UniformRange
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.training.run_folders import find_run
from kit.learning.training.run_text import comparison_tables
from kit.learning.training.run_upkeep import draw_test_curves
from kit.render.encode import ENCODERS
from kit.render.image import draw_image, image_camera, save_image
from kit.render.world_text import scene_rows
from kit.ros.packages import PackageError
from kit.workspace import open_workspace, write_atomically


@click.command()
@click.argument("policy", metavar="[RUN or POLICY.npz]", required=False)
@learning_options.on
@click.option("--task", help="Test on another task with the same inputs and actions.")
@learning_options.episodes
@learning_options.sampled
@learning_options.test_seed
@learning_options.disturbances
@click.option("--sweep", is_flag=True, help="Test each kind of disturbance alone, from none to strong.")
@click.option(
    "--kinds", metavar="KINDS", help="With --sweep: only these kinds, separated by commas: latency,drift."
)
@click.option(
    "--csv",
    "csv_file",
    type=OutputFile(),
    help="With --sweep: write the table to this CSV file.",
)
@click.option("--newest", is_flag=True, help="Test the newest policy of the run instead of the best.")
@click.option("--paths", type=click.IntRange(1, 100), help="Also draw this many paths per case.")
@click.option(
    "--pictures",
    type=click.Path(file_okay=False, path_type=Path),
    help="Save the paths as PNG files in this folder instead.",
)
@click.option(
    "--node",
    type=OutputFile(),
    help="Only write the policy to this file, as a ROS 2 node.",
)
@click.option("--package", metavar="NAME", help="Only create a ROS 2 package of the policy, with this name.")
@click.option(
    "--dest",
    "destination",
    type=click.Path(file_okay=False, path_type=Path),
    help="With --package: folder to create it in (default: the workspace's packages).",
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@options.workspace
def command(
    policy: str | None,
    on: str | None,
    task: str | None,
    episodes: int,
    sampled: bool,
    seed: int,
    disturbed: Mapping[str, UniformRange],
    sweep: bool,
    kinds: str | None,
    csv_file: Path | None,
    newest: bool,
    paths: int | None,
    pictures: Path | None,
    node: Path | None,
    package: str | None,
    destination: Path | None,
    as_json: bool,
    workspace: Path | None,
) -> None:
    """Test the best policy of a run (default: the last run) on new episodes of every case.

    This needs neither torch nor the process that trained it. The interval contains the true success rate with 95 %
    confidence (Wilson).

    The options from --lidar-noise to --drift make the simulation differ from its
    files, as a real robot does; by default it is as in training. --sweep shows
    how the success rate falls with each of them. You can interrupt it; run the
    same command to continue.

    \b
    kit evaluate --command-jitter 0.1
    kit evaluate my_run --sweep --kinds latency,drift --csv sweep.csv
    kit evaluate my_run --package my_agent
    """
    if not sweep and (kinds or csv_file):
        raise click.UsageError("--kinds and --csv need --sweep.")
    with learning_options.explained_errors():
        title, found = learning_options.find_policy(policy, workspace, newest=newest)
        if node is not None:
            _write_node(found, node)
            return
        if package is not None:
            _make_package(found, package, destination, workspace)
            return
        place = learning_options.resolve_test_task(found, task, on, disturbed)
        if sweep:
            journal = learning_options.sweep_journal(policy, workspace)
            chosen = learning_options.split_names(kinds)
            _run_sweep(
                PolicySweep(
                    found,
                    place,
                    find_kinds(chosen),
                    episodes=episodes,
                    seed=derive_seed(seed, "evaluate"),
                    greedy=not sampled,
                    journal=journal,
                ),
                title,
                csv_file,
                as_json,
            )
            return
        fresh = derive_seed(seed, "evaluate")
        result = evaluate_on(place, found, episodes, fresh, greedy=not sampled)
        if as_json:
            about = {"policy": title, "steps": found.steps, "disturbances": place.disturbances.as_dict()}
            click.echo(json.dumps({**about, **result.as_dict()}, indent=2))
        else:
            click.echo(f"{title}: trained on {found.trained_on.title}, {found.steps:,} steps")
            if found.trained_on.has_changed and task is None:
                messages.say(
                    f"{found.trained_on.task} has changed since; this tests the task as it was. --task selects the new one."
                )
            if place.disturbances:
                click.echo(f"Under {place.disturbances}:")
            click.echo("\n".join(lines_of([result.table()])))
        if paths is not None or pictures is not None:
            _show_paths(found, place, paths or 10, pictures, seed, greedy=not sampled)


def _run_sweep(sweep: PolicySweep, title: str, csv_file: Path | None, as_json: bool) -> None:
    with click.progressbar(
        sweep.points(), length=len(sweep.places), label="sweep", file=sys.stderr
    ) as progress:
        try:
            points = list(progress)
        except KeyboardInterrupt:
            click.echo("\nFinished tests are kept; run the same command to continue.", err=True)
            raise SystemExit(INTERRUPTED) from None
    if csv_file is not None:
        write_atomically(csv_file, sweep_csv(points).encode())
    if as_json:
        click.echo(json.dumps({"policy": title, "points": [point.as_dict() for point in points]}, indent=2))
        return
    click.echo(f"{title}: success rate, {points[0].episodes:,} episodes per value")
    columns = min(79, shutil.get_terminal_size().columns - 1)
    blocks = sweep_blocks(points, ENCODERS["braille"](True), columns)
    click.echo("\n".join(lines_of(blocks, Page(width=columns))))


def _write_node(policy: Policy, file: Path) -> None:
    write_atomically(file, format_policy_node(policy).encode())
    task = policy.trained_on.resolve()
    where = task.maps[0] if task.maps else task.map_cards[0].world_file
    messages.say(
        f"{file}: `kit drive {where} --controller {file}` runs it here, `python3 {file}` on a robot."
    )


def _make_package(policy: Policy, name: str, destination: Path | None, workspace: Path | None) -> None:
    try:
        folder = create_policy_package(policy, name, destination or open_workspace(workspace).packages)
    except PackageError as problem:
        messages.fail(str(problem))
    where = folder if destination else name
    click.echo(f"{folder}: `kit launch {where} simulation.launch.py` runs it here.")
    messages.say(
        f"On a robot: copy it into ~/ros2_ws/src, `colcon build`, then `ros2 launch {name} {name}.launch.py "
        "scan_topic:=/scan cmd_vel_topic:=/cmd_vel`. It needs rclpy and numpy."
    )


def _show_paths(
    policy: Policy, task: LearningTask, count: int, pictures: Path | None, seed: int, *, greedy: bool
) -> None:
    ways = record_paths(policy, task, count, derive_seed(seed, "paths"), greedy=greedy)
    columns, rows = shutil.get_terminal_size()
    if pictures is not None:
        pictures.mkdir(parents=True, exist_ok=True)
    for card, case in task.map_cases():
        scene = build_paths_scene(task, card, case, ways)
        if pictures is not None:
            file = pictures / f"{case.name}.png"
            save_image(file, draw_image(scene, image_camera(scene.bounds, 640, 640)))
            click.echo(file)
        else:
            click.echo(f"\n{case.name}")
            click.echo(
                "\n".join(scene_rows(scene, columns - 1, max(10, rows - 4), ENCODERS["braille"](True)))
            )


@click.command()
@click.argument("policies", metavar="RUN or POLICY.npz ...", nargs=-1, required=True)
@learning_options.on
@learning_options.episodes
@learning_options.sampled
@learning_options.test_seed
@click.option("--curves", is_flag=True, help="Also draw their test results during training.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@options.workspace
def compare_command(
    policies: tuple[str, ...],
    on: str | None,
    episodes: int,
    sampled: bool,
    seed: int,
    curves: bool,
    as_json: bool,
    workspace: Path | None,
) -> None:
    """Test several policies on the same new episodes. `--on all` tests every case of the task, trained on or not."""
    with learning_options.explained_errors():
        results = {}
        for name in policies:
            title, policy = learning_options.find_policy(name, workspace)
            task = learning_options.resolve_test_task(policy, None, on)
            fresh = derive_seed(seed, "evaluate")
            results[title] = evaluate_on(task, policy, episodes, fresh, greedy=not sampled)
        if as_json:
            click.echo(json.dumps({name: result.as_dict() for name, result in results.items()}, indent=2))
        else:
            click.echo("\n".join(lines_of(comparison_tables(results))))
        if curves:
            _draw(policies, workspace)


def _draw(policies: tuple[str, ...], workspace: Path | None) -> None:
    folder = learning_options.runs_folder(workspace)
    columns, _ = shutil.get_terminal_size()
    runs = [find_run(folder, name) for name in policies]
    click.echo("\n".join(draw_test_curves(runs, columns - 1, 16, ENCODERS["braille"](True))))
