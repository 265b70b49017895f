"""``kit compare``: several policies on the same episodes, side by side."""

from __future__ import annotations

import json
from pathlib import Path

import click

from kit.cli import learning_options, options


@click.command()
@click.argument("policies", metavar="RUN or POLICY.npz ...", nargs=-1, required=True)
@learning_options.on
@learning_options.episodes
@learning_options.sampled
@learning_options.test_seed
@click.option("--curves", is_flag=True, help="Also draw how their tests went while they learned.")
@click.option("--json", "as_json", is_flag=True, help="For machines.")
@options.workspace
def command(
    policies: tuple[str, ...],
    on: str | None,
    episodes: int,
    sampled: bool,
    seed: int,
    curves: bool,
    as_json: bool,
    workspace: Path | None,
) -> None:
    """Test several policies on the same fresh episodes. `--on all` takes every case of the task, trained on or not."""
    with learning_options.explained_errors():
        from kit.learning.policies.evaluation import Evaluator, derive_seed
        from kit.learning.training.run_text import format_comparison

        results = {}
        for name in policies:
            title, policy = learning_options.find_policy(name, workspace)
            task = learning_options.resolve_test_task(policy, None, on)
            fresh = derive_seed(seed, "evaluate")
            results[title] = Evaluator(task).test(policy, episodes, fresh, greedy=not sampled)
        if as_json:
            click.echo(json.dumps({name: result.as_dict() for name, result in results.items()}, indent=2))
        else:
            click.echo("\n".join(format_comparison(results)))
        if curves:
            _draw(policies, workspace)


def _draw(policies: tuple[str, ...], workspace: Path | None) -> None:
    import shutil

    from kit.learning.training.run_upkeep import draw_test_curves
    from kit.learning.training.runs import find_run
    from kit.render.encode import ENCODERS

    folder = learning_options.runs_folder(workspace)
    columns, _ = shutil.get_terminal_size()
    runs = [find_run(folder, name) for name in policies]
    click.echo("\n".join(draw_test_curves(runs, columns - 1, 16, ENCODERS["braille"](True))))
