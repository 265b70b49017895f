"""The command line. Each verb is one module here, imported only when it is used, so that ``kit`` starts fast."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from importlib import import_module
from types import MappingProxyType
from typing import Any, Final, NoReturn

import click

import kit

VERBS: Final[dict[str, tuple[str, str]]] = {
    "start": ("kit.cli.start", "Open the kit: a robot to drive, and a menu (what `kit` alone does)."),
    "play": ("kit.cli.play", "Open a map at once: watch, drive, edit a controller."),
    "drive": ("kit.cli.play", "The same as `play`: `kit drive pair_turn --controller fields`."),
    "lesson": ("kit.cli.lesson", "Go through a lesson: predict, run, explain, modify, make; or list them."),
    "game": ("kit.cli.game", "Levels, stars, ghosts, time trials; a leaderboard for this machine."),
    "run": ("kit.cli.run", "Run a world without a screen, as fast as it goes; print what happened."),
    "replay": ("kit.cli.replay", "Watch a recorded run again, or check that it runs the same to the bit."),
    "maps": ("kit.cli.maps", "List the maps that come with the kit, or show one as a picture."),
    "world": ("kit.cli.world", "Check a world: its errors, who collides with whom, which laser sees whom."),
    "layers": ("kit.cli.layers", "Plan a world's collision layers: the provably smallest set."),
    "fields": (
        "kit.cli.fields",
        "Potential fields: show a map's, test who follows them, the dissertation's tables beside ours.",
    ),
    "launch": (
        "kit.cli.launch",
        "Carry out a ROS 2 launch file, with the package for Flatland around it as it is.",
    ),
    "pkg": (
        "kit.cli.launch:package_command",
        "Make a ROS 2 package that `kit launch` and a robot run, or list packages.",
    ),
    "ros": ("kit.cli.ros", "Look into a running world from a second terminal, as `ros2` does."),
    "bridge": ("kit.cli.bridge", "Join a running world to a robot on ROS 2's wire; stop the robot at once."),
    "task": ("kit.cli.task", "Pose a task of your own: a file with maps, starts, targets, reward, actions."),
    "train": ("kit.cli.train", "Train an agent on a task, in a process that outlives this terminal."),
    "runs": ("kit.cli.train:runs_command", "List the training runs; pause, go on, stop."),
    "watch": (
        "kit.cli.train:watch_command",
        "Watch a training: its curve, its episodes, the robot with its newest policy.",
    ),
    "evaluate": (
        "kit.cli.evaluate",
        "Test a trained policy case by case; draw its paths; make it a ROS 2 node.",
    ),
    "compare": (
        "kit.cli.evaluate:compare_command",
        "Test several policies on the same episodes, side by side.",
    ),
    "crosstable": (
        "kit.cli.evaluate:crosstable_command",
        "Train on each group of cases, test on all: a table, resumable.",
    ),
    "sweep": (
        "kit.cli.sweep",
        "Train many times over: seeds, algorithms, rewards, cases; one table, resumable.",
    ),
    "study": (
        "kit.cli.study",
        "The dissertation's tables and figures by number, ours beside them; make one again.",
    ),
    "form": ("kit.cli.form", "The evaluation form: what you knew, what you learned, how the kit served you."),
    "class": (
        "kit.cli.class_",
        "A class's report from its students' exported progress; the dissertation's beside ours.",
    ),
    "quiz": (
        "kit.cli.quiz",
        "Find out what you know: twelve ideas, a lesson's questions, what is due today.",
    ),
    "glossary": (
        "kit.cli.lesson:glossary_command",
        "Say what a term of the lessons means, and which lesson introduces it.",
    ),
    "progress": ("kit.cli.progress", "What you have done so far; everything in one file, and back."),
    "keys": ("kit.cli.doctor:keys_command", "Press keys and see what this terminal sends."),
    "doctor": ("kit.cli.doctor", "Say what the kit found on this machine and terminal, and what it decided."),
}
"""Every verb: its module, with the name of its command where that is not ``command``, and its line in ``kit --help``."""


class ScreenClosed(SystemExit):
    """A full screen was left: all that was to be kept is on the disk, and the terminal is as it was."""


Verbs = Mapping[str, tuple[str, str]]


class LazyGroup(click.Group):
    """A group that imports a verb's module when the verb is used, and lists the verbs without importing any."""

    def __init__(
        self,
        *arguments: Any,
        verbs: Verbs = VERBS,
        absent: Mapping[str, str] = MappingProxyType({}),
        **options: Any,
    ) -> None:
        """``verbs``: by name ``module`` or ``module:command``, and its line in ``--help``; none for a verb that is not for
        people. ``absent``: verbs that somebody may look for and why they are not there."""
        super().__init__(*arguments, **options)
        self._verbs = verbs
        self._absent = absent

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(self._verbs)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in self._verbs:
            return None
        module, _, name = self._verbs[cmd_name][0].partition(":")
        command: click.Command = getattr(import_module(module), name or "command")
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        try:
            return super().resolve_command(ctx, args)
        except click.UsageError:
            from kit.plain_text import nearest_name

            path = ctx.command_path
            if args[0] in self._absent:
                raise click.UsageError(
                    f"There is no `{path} {args[0]}`: {self._absent[args[0]]}", ctx
                ) from None
            near = nearest_name(args[0], self._verbs)
            hint = f" Did you mean `{path} {near}`?" if near else ""
            raise click.UsageError(
                f"There is no `{path} {args[0]}`.{hint} `{path} --help` lists the verbs.", ctx
            ) from None

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Verbs"):
            formatter.write_dl([(name, text) for name, (_, text) in self._verbs.items() if text])


@click.group(
    cls=LazyGroup,
    invoke_without_command=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog="`kit VERB --help` explains a verb. Ctrl-C leaves every screen.",
)
@click.version_option(kit.__version__, prog_name="kit")
@click.pass_context
def main(ctx: click.Context) -> None:
    """The terminal robot-learning kit: drive a robot, program it, teach it.

    `kit` alone opens a robot in its maze, to be driven with W, A, S and D, and beside it a menu: Enter begins the
    first lesson, or goes on where you left off.
    """
    if ctx.invoked_subcommand is None:
        start = main.get_command(ctx, "start")
        assert start is not None
        ctx.invoke(start)


def run() -> NoReturn:
    """Runs the command line as this process.

    After a full screen Python does not take apart what was imported, which takes longer than to leave the screen: the
    process ends once its output is written. The screen has given the terminal back and removed what it made; the exit
    handlers of libraries do not run, which would take compiled code away from threads that are still in it.
    """
    try:
        main(prog_name="kit")
    except ScreenClosed as closed:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(closed.code if isinstance(closed.code, int) else 0)
    raise SystemExit(0)  # a command that ends otherwise has said so by a SystemExit of its own
