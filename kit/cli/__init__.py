"""The command line. Each verb is one module here, imported only when it is used, so that ``kit`` starts fast."""

from __future__ import annotations

from typing import Final, NoReturn

import click

import kit
from kit.cli.lazy_group import LazyGroup
from kit.cli.plain_flag import PLAIN, PLAIN_OPTION
from kit.cli.process import run_as_process

VERBS: Final[dict[str, tuple[str, str]]] = {
    "start": ("kit.cli.start", "Open the kit: a robot and a menu (same as `kit` alone)."),
    "drive": ("kit.cli.drive", "Open a map: watch the robot, drive it, edit its controller."),
    "lesson": ("kit.cli.lesson", "List the lessons, or take one."),
    "game": (
        "kit.cli.game",
        "Play levels for medals and stars; race programs and agents.",
    ),
    "league": ("kit.cli.league", "Enter programs and agents; all meet all in races and at tag."),
    "run": ("kit.cli.run", "Run a world without a screen and print a summary."),
    "replay": ("kit.cli.replay", "Replay a recorded run, or check that it repeats bit for bit."),
    "maps": ("kit.cli.maps", "List the maps, show one, or make your own."),
    "world": ("kit.cli.world", "Check a world: errors, collisions, what each laser sees."),
    "layers": ("kit.cli.layers", "Plan a world's collision layers: the smallest set, with proof."),
    "fields": (
        "kit.cli.fields",
        "Show and test potential fields.",
    ),
    "launch": (
        "kit.cli.launch",
        "Run a ROS 2 launch file and its Flatland package, unchanged.",
    ),
    "pkg": (
        "kit.cli.launch:package_command",
        "Create a ROS 2 package, or list packages.",
    ),
    "ros": ("kit.cli.ros", "Inspect a running world from a second terminal, as `ros2` does."),
    "bridge": ("kit.cli.bridge", "Connect a running world to a ROS 2 robot; stop the robot."),
    "task": ("kit.cli.task", "Define your own task: maps, targets, reward, actions."),
    "train": ("kit.cli.train", "Train an agent on a task; closing the terminal does not stop it."),
    "runs": ("kit.cli.train:runs_command", "List training runs; pause, resume, stop, rename or delete one."),
    "watch": (
        "kit.cli.train:watch_command",
        "Watch a training run: its curve, episodes and newest policy.",
    ),
    "evaluate": (
        "kit.cli.evaluate",
        "Test a trained policy, draw its paths, or export it to ROS 2.",
    ),
    "compare": (
        "kit.cli.evaluate:compare_command",
        "Test several policies on the same episodes, side by side.",
    ),
    "sweep": (
        "kit.cli.sweep",
        "Train with many seeds, algorithms, rewards or groups of cases (resumable).",
    ),
    "study": (
        "kit.cli.study",
        "Show or reproduce the dissertation's tables and figures.",
    ),
    "form": (
        "kit.cli.form",
        "Fill in the evaluation form: what you knew, what you learned.",
    ),
    "class": (
        "kit.cli.class_",
        "Report on a class from its students' exported progress.",
    ),
    "quiz": (
        "kit.cli.quiz",
        "Test what you know: twelve ideas, or a lesson's questions.",
    ),
    "glossary": (
        "kit.cli.lesson:glossary_command",
        "Explain a term used in the lessons.",
    ),
    "progress": ("kit.cli.progress", "Show your progress; export or import it."),
    "help": ("kit.cli.help", "Show a page: how-to, formats, environments, Python, reasons."),
    "completion": ("kit.cli.completion", "Print a script that lets your shell complete commands."),
    "keys": ("kit.cli.doctor:keys_command", "Press keys and see what this terminal sends."),
    "warm": ("kit.cli.warm", "Compile what worlds compute with now, also for all accounts (--shared)."),
    "doctor": (
        "kit.cli.doctor",
        "Report what the kit found on this machine and terminal.",
    ),
}
"""Every verb: its module, with the name of its command where that is not ``command``, and its line in ``kit --help``."""
ELSEWHERE: Final = {
    "learn": "a lesson is `kit lesson`, a training `kit train`.",
    "levels": "they are in `kit game`.",
    "play": "a map is driven by `kit drive`, a level by `kit game play LEVEL`.",
    "race": "it is `kit game race`.",
    "daily": "it is `kit game daily`.",
    "tag": "it is `kit game host LEVEL` and `kit game guest`.",
    "grade": "work is graded by `grader check`, a class by `grader cohort`.",
    "check": "it is `kit world check`, `kit task check`, or `grader check` for an exercise.",
    "export": "it is `kit evaluate RUN --node` or `--package`, or `kit progress export`.",
    "test": "a policy is tested by `kit evaluate`, an assignment by `grader self-test`.",
}
"""Words that somebody may try as verbs, and the commands that they stand for."""
VERSION: Final[str] = getattr(kit, "__version__", "unknown")
"""Unknown where another package has written over the kit's files, which ``run_as_process`` says."""


@click.group(
    cls=LazyGroup,
    verbs=VERBS,
    absent=ELSEWHERE,
    has_others=True,
    everywhere=(PLAIN_OPTION,),
    invoke_without_command=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog="`kit COMMAND --help` explains a command, `kit help` lists pages to read. Ctrl-C leaves any screen.",
)
@click.option(
    "--plain", is_flag=True, help="Work line by line instead of on a full screen; also `kit COMMAND --plain`."
)
@click.version_option(VERSION, prog_name="kit")
@click.pass_context
def main(ctx: click.Context, plain: bool) -> None:
    """The terminal robot-learning kit: drive a robot, program it, train it.

    `kit` alone opens a menu and a robot in a maze, which you drive with W, A, S and D. Enter starts the first lesson,
    or continues where you left off.
    """
    ctx.meta[PLAIN] = plain
    if ctx.invoked_subcommand is None:
        start = main.get_command(ctx, "start")
        assert start is not None
        ctx.invoke(start)


def run() -> NoReturn:
    """Runs ``kit`` as this process."""
    run_as_process(main, "kit")
