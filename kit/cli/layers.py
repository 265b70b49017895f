"""``kit layers``: who must touch whom and which laser must see whom, in the fewest layers, with the proof; as text, data or a
graph."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import Any, Final

import click

from kit.cli import messages, options, terminal_options
from kit.cli.full_screen import show_layers
from kit.cli.lazy_group import HintingGroup
from kit.document.blocks import labelled_table
from kit.document.layout import lines_of
from kit.layers import explain as words
from kit.layers.assignment import LayerAssignment
from kit.layers.assignment_tables import assignment_tables
from kit.layers.case_sources import PlanningTask, UnknownPlanningTask, open_task, solve_task
from kit.layers.drawing.case import draw_case
from kit.layers.drawing.spans import GlyphStyle, to_plain_lines
from kit.layers.examples import EXAMPLES
from kit.layers.explain import greedy_end_text, patch_text, world_verdict_text
from kit.layers.flatland.world_patch import PatchError, WorldPatch, apply_patch, build_patch, make_recheck
from kit.layers.flatland.world_planning import WorldPlan
from kit.layers.greedy import GreedyRun, run_greedy
from kit.layers.plan_data import (
    check_data,
    graphviz_text,
    greedy_data,
    mermaid_text,
    patch_data,
    plan_data,
    sacrifice_data,
    world_data,
)
from kit.layers.planning import LayerPlan
from kit.layers.relaxations import Relaxation, allow_unwanted, drop_requirements
from kit.layers.requirements import LayerCase
from kit.layers.requirements_file import requirements_text
from kit.plain_text import counted, unknown_name
from kit.world.problems import WorldError
from kit.world.records import MAX_LAYERS

REQUIREMENTS_NOT_MET: Final = 1
"""Exit code: the requirements are not met, or cannot be within sixteen layers."""

MORE_LAYERS_THAN_NEEDED: Final = 3
"""Exit code of ``check``: a world that could do with fewer layers."""

_JSON = click.option("--json", "as_json", is_flag=True, help="Print JSON.")


@dataclass(frozen=True, slots=True)
class _ReadingOptions:
    """Options for reading files, and the solver's time limit."""

    root: Path | None
    variables: tuple[str, ...]
    never: bool
    time_limit: float

    def open(self, target: str, requirements: Path | None = None) -> PlanningTask:
        """Opens the case or world that the user named. Raises WorldError and UnknownTask."""
        environment = dict(map(options.environment_variable, self.variables))
        return open_task(
            target,
            requirements=requirements,
            one_model_never_collides=self.never,
            root=self.root,
            environment=environment,
        )


_READING: Final = (
    click.option(
        "--one-model-never-collides",
        "never",
        is_flag=True,
        help="Assume, as the slides do, that bodies of one model never collide. In Flatland they do, if they share "
        "a layer and are not joined. Safe for models whose parts cannot reach each other.",
    ),
    click.option(
        "--time-limit",
        type=click.FloatRange(min=0, min_open=True),
        default=10.0,
        show_default="10",
        metavar="SECONDS",
        help="Time after which to print the best plan found and the proved lower bound. Above 16 layers, each of two searches for a relaxation takes up to as long again.",
    ),
    options.root,
    click.option(
        "--env",
        "variables",
        metavar="NAME[=VALUE]",
        multiple=True,
        help="Environment variable that env() in the world may read; repeat for more.",
    ),
)


def _reading_options(function: Callable[..., None]) -> Callable[..., None]:
    """Adds the options for reading files to a verb, as its argument ``reading``."""

    @wraps(function)
    def verb(
        root: Path | None, variables: tuple[str, ...], never: bool, time_limit: float, **others: Any
    ) -> None:
        function(reading=_ReadingOptions(root, variables, never, time_limit), **others)

    decorated: Callable[..., None] = verb
    for option in reversed(_READING):
        decorated = option(decorated)
    return decorated


@click.group(cls=HintingGroup, invoke_without_command=True)
@click.pass_context
def command(context: click.Context) -> None:
    """Plan collision layers for Flatland worlds. Without a command, open a full screen to build and solve a case.

    In Flatland, two bodies collide if they share a layer, and a laser sees the bodies in the layers it watches. A
    world has at most 16 layers. The planner finds the fewest layers that meet your requirements, proves that fewer
    are not enough, and writes them into your files.

    \b
      kit layers example                     list the examples
      kit layers explain slides-lasers       the slides' method, step by step
      kit layers plan my.world.yaml          same behaviour, fewest layers
      kit layers plan my.world.yaml --patch  the changes to your files
      kit layers check my.world.yaml         for CI: exit code 3 if not minimal
    """
    if context.invoked_subcommand is None:
        terminal = terminal_options.decide()
        if terminal.plain.value:
            click.echo(context.get_help())
            return
        first = next(iter(EXAMPLES))
        show_layers(open_task(first), first, terminal)


@command.command()
@click.argument("target", metavar="FILE_OR_NAME")
@click.option("--patch", "show_patch", is_flag=True, help="Print the changes to the world's files as a diff.")
@click.option(
    "--apply", "do_apply", is_flag=True, help="Change the files, then load them and check the result."
)
@click.option("--also-shared", is_flag=True, help="Also change model files that other worlds use.")
@click.option(
    "--dot", "graph", flag_value="dot", default=None, help="Print the graph and its layers for Graphviz."
)
@click.option("--mermaid", "graph", flag_value="mermaid", help="Print the graph and its layers for Mermaid.")
@click.option(
    "--requirements",
    "as_requirements",
    is_flag=True,
    help="Print the requirements, to edit and check against.",
)
@click.option(
    "--method",
    type=click.Choice(("exact", "greedy")),
    default="exact",
    show_default=True,
    help="exact proves the minimum, greedy does not.",
)
@_JSON
@_reading_options
def plan(
    target: str,
    show_patch: bool,
    do_apply: bool,
    also_shared: bool,
    graph: str | None,
    as_requirements: bool,
    method: str,
    as_json: bool,
    reading: _ReadingOptions,
) -> None:
    """Find the fewest layers, and assign every body to them.

    FILE_OR_NAME is a requirements file, a Flatland world (the plan keeps what collides and what is seen now), an
    example of `kit layers example`, or a map of `kit maps`. If a requirements file has a line `world: FILE`, the plan
    is for that world. A layer list shared by several instances of a model file is planned once.

    Exit code: 0 a plan; 1 more than 16 layers are needed; 2 the input is wrong.

    \b
      kit layers example slides > s.yaml; kit layers plan s.yaml
      kit layers plan my.world.yaml --apply
      kit layers plan depot --json
    """
    with _explained_errors():
        task = reading.open(target)
        if as_requirements:
            click.echo(task.as_requirements(), nl=False)
            return
        if method == "greedy":
            if show_patch or do_apply:
                raise click.UsageError("A patch needs the exact plan: leave out --method greedy.")
            show_greedy(task.case, as_json=as_json, graph=graph)
            return
        found, world_plan = solve_task(task, time_limit=reading.time_limit)
        patch = _make_patch(task, world_plan, also_shared) if show_patch or do_apply else None
        assignment = found.assignment if world_plan is None else world_plan.assignment
        if as_json:
            click.echo(json.dumps(plan_json(found, world_plan, patch, reading.time_limit), indent=2))
        elif graph:
            show_graph(task.case, assignment, graph)
        else:
            show_plan(task.case, found, world_plan, reading.time_limit)
            if patch is not None:
                print_patch(patch)
        if do_apply and patch is not None and world_plan is not None:
            _apply_patch(task, world_plan, patch, quiet=as_json)
        raise SystemExit(REQUIREMENTS_NOT_MET if len(assignment.layers) > MAX_LAYERS else 0)


@command.command()
@click.argument("world", metavar="WORLD")
@click.argument("requirements", required=False, type=click.Path(dir_okay=False, path_type=Path))
@click.option("--lenient", is_flag=True, help="Report unneeded layers, but do not fail.")
@_JSON
@_reading_options
def check(
    world: str,
    requirements: Path | None,
    lenient: bool,
    as_json: bool,
    reading: _ReadingOptions,
) -> None:
    """Check a world's layers, for CI. Does it meet REQUIREMENTS, with as few layers as possible?

    Without REQUIREMENTS, check only whether fewer layers would give the same behaviour.

    \b
    Exit code:
      0  everything is fine
      1  something collides or is seen that must not, or the reverse
      2  the input is wrong
      3  fewer layers are enough (0 with --lenient)

    \b
      kit layers plan my.world.yaml --requirements > my.layers.yaml  (once)
      kit layers check my.world.yaml my.layers.yaml                  (in CI)
    """
    with _explained_errors():
        task = reading.open(world, requirements)
        if task.world is None:
            raise click.UsageError(
                f"{world} is not a Flatland world; for a requirements file use `kit layers plan`."
            )
        _, result = solve_task(task, time_limit=reading.time_limit)
        assert result is not None  # there is a world
        more = result.current_name_count > result.size
        code = (
            REQUIREMENTS_NOT_MET
            if result.current_breaches
            else MORE_LAYERS_THAN_NEEDED
            if more and not lenient
            else 0
        )
        if as_json:
            click.echo(json.dumps({**check_data(result), "exit": code}, indent=2))
        else:
            echo_lines(world_verdict_text(result))
        raise SystemExit(code)


@command.command()
@click.argument("target", metavar="FILE_OR_NAME")
@click.option("--pictures", is_flag=True, help="Draw the graph at every step, with the edges removed so far.")
@click.option("--screen", "on_screen", is_flag=True, help="Open it on the full screen.")
@click.option(
    "--glyphs",
    type=click.Choice(("auto", "braille", "ascii")),
    default="auto",
    show_default=True,
    help="Characters used to draw pictures.",
)
@_reading_options
def explain(
    target: str,
    pictures: bool,
    on_screen: bool,
    glyphs: str,
    reading: _ReadingOptions,
) -> None:
    """Show the slides' method step by step. Then show the optimum, and the proof that fewer layers are not enough.

    FILE_OR_NAME is the same as for `kit layers plan`.

    \b
      kit layers explain three
      kit layers explain slides --pictures
      kit layers explain greedy-trap
    """
    with _explained_errors():
        task = reading.open(target)
        if on_screen:
            show_layers(task, Path(target).name)
        run = run_greedy(task.case)
        echo_lines(words.paragraph(task.case.title))
        echo_lines(to_plain_lines(draw_case(task.case, glyphs=choose_glyphs(glyphs))))
        echo_lines(["", "THE SLIDES' METHOD", ""])
        echo_lines(
            words.greedy_text(run, draw=step_pictures(run, choose_glyphs(glyphs)) if pictures else None)
        )
        found, _ = solve_task(task, time_limit=reading.time_limit)
        echo_lines(["", "THE FEWEST LAYERS", ""])
        echo_lines(words.layer_count_text(found))
        echo_lines(["", *lines_of(assignment_tables(task.case, found.assignment)), ""])
        echo_lines(words.proof_text(found, every_pair=len(found.certificate.conflicting) <= 10))
        echo_lines(words.comparison_text(run, found))


@command.command()
@click.argument("name", required=False)
@click.option("--screen", "on_screen", is_flag=True, help="Open it on the full screen.")
def example(name: str | None, on_screen: bool) -> None:
    """Print an example as a requirements file. Without NAME, list the examples.

    \b
      kit layers example slides-lasers > slides.yaml
      kit layers example slides-lasers --screen
    """
    if name is None:
        echo_lines(lines_of([labelled_table((key, case.title) for key, case in EXAMPLES.items())]))
        echo_lines(["", "`kit layers example NAME` prints one, `kit layers explain NAME` explains it."])
    elif name in EXAMPLES and on_screen:
        show_layers(open_task(name), name)
    elif name in EXAMPLES:
        click.echo(requirements_text(EXAMPLES[name]), nl=False)
    else:
        messages.fail(unknown_name("example", name, EXAMPLES))


# What the user named


@contextmanager
def _explained_errors() -> Iterator[None]:
    """Ends the verb with a message and exit code 2 for errors in the user's files."""
    try:
        yield
    except (WorldError, UnknownPlanningTask) as error:
        messages.fail(str(error))


def _apply_patch(task: PlanningTask, world_plan: WorldPlan, patch: WorldPatch, *, quiet: bool) -> None:
    assert task.source is not None  # there is a patch
    try:
        apply_patch(patch, make_recheck(world_plan, task.source.read, requirements=task.requirements))
    except PatchError as error:
        messages.fail(f"Nothing was written: {error}.")
    if patch.files and not quiet:
        count = len(patch.files)
        click.echo(
            f"\nWritten: {counted(count, 'file')}. Loaded again and checked: all requirements are met."
        )


def _make_patch(task: PlanningTask, world_plan: WorldPlan | None, also_shared: bool) -> WorldPatch:
    if world_plan is None or task.source is None:
        raise click.UsageError(
            "There are no files to patch: give a world, or write `world: FILE` in the requirements."
        )
    if world_plan.size > MAX_LAYERS:
        messages.fail(f"{world_plan.size} layers do not fit in a world file, so there is no patch.")
    return build_patch(world_plan, root=task.source.root, also_shared=also_shared)


def show_plan(case: LayerCase, found: LayerPlan, world_plan: WorldPlan | None, time_limit: float) -> None:
    """Prints the plan as tables, its proof, the slides' method beside it, and relaxations where it is too large."""
    if world_plan is None:
        echo_lines(words.paragraph(case.title))
        echo_lines(words.layer_count_text(found))
        assignment, kept = found.assignment, 0
    else:
        echo_lines(words.world_plan_text(world_plan))
        assignment, kept = world_plan.assignment, len(world_plan.world_case.layer_lists.kept_layers)
    echo_lines(["", *lines_of(assignment_tables(case, assignment)), ""])
    echo_lines(words.proof_text(found))
    echo_lines(words.comparison_text(run_greedy(found.case), found))
    if found.size + kept > MAX_LAYERS:
        echo_lines(["", *words.too_many_text(found, *_find_relaxations(found, kept, time_limit))])


def _find_relaxations(
    found: LayerPlan, kept: int, time_limit: float
) -> tuple[Relaxation | None, Relaxation | None]:
    """Finds requirements to give up, or contacts to tolerate, so that at most sixteen layers are needed."""
    limit = MAX_LAYERS - kept
    return (
        drop_requirements(found.case, limit=limit, time_limit=time_limit),
        allow_unwanted(found, limit=limit, time_limit=time_limit),
    )


def plan_json(
    found: LayerPlan, world_plan: WorldPlan | None, patch: WorldPatch | None, time_limit: float
) -> dict[str, Any]:
    """The content of ``show_plan`` and the patch as JSON-able data."""
    facts = plan_data(found, run_greedy(found.case))
    kept = 0 if world_plan is None else len(world_plan.world_case.layer_lists.kept_layers)
    if world_plan is not None:
        facts |= world_data(world_plan)
    if found.size + kept > MAX_LAYERS:
        given_up, tolerated = _find_relaxations(found, kept, time_limit)
        facts["give_up"] = None if given_up is None else sacrifice_data(given_up)
        facts["tolerate"] = None if tolerated is None else sacrifice_data(tolerated)
    if patch is not None:
        facts["patch"] = patch_data(patch)
    return facts


def show_greedy(case: LayerCase, *, as_json: bool, graph: str | None) -> None:
    run = run_greedy(case)
    if as_json:
        click.echo(json.dumps(greedy_data(run), indent=2))
    elif graph:
        show_graph(case, run.assignment, graph)
    else:
        echo_lines([*greedy_end_text(run), "", *lines_of(assignment_tables(case, run.assignment))])


def show_graph(case: LayerCase, assignment: LayerAssignment, language: str) -> None:
    click.echo({"dot": graphviz_text, "mermaid": mermaid_text}[language](case, assignment), nl=False)


def print_patch(patch: WorldPatch) -> None:
    echo_lines(["", *patch_text(patch)])


def step_pictures(run: GreedyRun, glyphs: GlyphStyle) -> Callable[[int], list[str]]:
    """Draws the graph at a step: what is struck already, and the group just made."""

    def draw(step: int) -> list[str]:
        members = run.collision_steps[step].layer.members
        return to_plain_lines(
            draw_case(run.case, struck=run.covered_before(step), group=members, glyphs=glyphs)
        )

    return draw


def choose_glyphs(asked: str) -> GlyphStyle:
    """Returns the glyphs asked for, or those that this terminal can show."""
    if asked == "auto":
        encoding = (getattr(sys.stdout, "encoding", None) or "").lower().replace("-", "")
        return (
            "braille" if encoding == "utf8" and os.environ.get("TERM") not in ("dumb", "linux") else "ascii"
        )
    return "braille" if asked == "braille" else "ascii"


def echo_lines(lines: Iterable[str]) -> None:
    for line in lines:
        click.echo(line)
