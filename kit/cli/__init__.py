"""The command line. Each verb is one module here, imported only when it is used, so that ``kit`` starts fast."""

from __future__ import annotations

import atexit
import os
import signal
import sys
from collections.abc import Iterable, Mapping
from contextlib import suppress
from errno import EACCES, EDQUOT, EFBIG, EIO, EMFILE, ENAMETOOLONG, ENFILE, ENOSPC, EPERM, EROFS
from importlib import import_module
from types import MappingProxyType
from typing import Any, Final, NoReturn

import click
from click.shell_completion import CompletionItem

import kit
from kit.extensions import Extension, ExtensionError, extensions, load
from kit.installation import foreign_distributions, overwritten_text
from kit.interruption import ended_by_signals, write_out

VERBS: Final[dict[str, tuple[str, str]]] = {
    "start": ("kit.cli.start", "Open the kit: a robot and a menu (same as `kit` alone)."),
    "play": ("kit.cli.play", "Open a map: watch the robot, drive it, edit its controller."),
    "drive": ("kit.cli.play", "Same as `play`: `kit drive pair_turn --controller fields`."),
    "lesson": ("kit.cli.lesson", "List the lessons, or take one."),
    "game": (
        "kit.cli.game",
        "Play levels for medals and stars; race programs and agents.",
    ),
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
    "doctor": (
        "kit.cli.doctor",
        "Report what the kit found on this machine and terminal.",
    ),
}
"""Every verb: its module, with the name of its command where that is not ``command``, and its line in ``kit --help``."""


NO_ROOM: Final = frozenset((ENOSPC, EDQUOT, EFBIG))
REFUSED: Final = frozenset((EACCES, EPERM, EROFS, EIO, ENAMETOOLONG, EMFILE, ENFILE))


def is_environment_error(error: OSError) -> bool:
    """Whether an error is one of the disk, or of rights: nothing that the kit does wrong."""
    return error.errno in NO_ROOM or (error.errno in REFUSED and error.filename is not None)


def describe_no_room(error: OSError) -> str:
    """A sentence about a full disk, and the way out."""
    where = "what it prints or writes" if error.filename is None else error.filename
    return (
        f"{where} cannot be written: {error.strerror}. Free some space, or write elsewhere, and run it again."
    )


VERSION: Final[str] = getattr(kit, "__version__", "unknown")
"""Unknown where another package has written over the kit's files, which ``run_as_process`` says."""


BAD_INPUT: Final = 2
"""Exit code where an argument is wrong, or something cannot be read or written."""


SIGNALLED: Final = 128
"""Exit codes of what a signal has ended are above this, as shells have them."""


class ScreenClosed(SystemExit):
    """A full screen was left: all that was to be kept is on the disk, and the terminal is as it was."""


Verbs = Mapping[str, tuple[str, str]]
_HELD: Final = "\ue000"
"""In the place of a hyphen while click wraps a text: it would break an option there."""


class WholeWordFormatter(click.HelpFormatter):
    """Breaks the text of a command's help at blanks alone."""

    def write_usage(self, prog: str, args: str = "", prefix: str | None = None) -> None:
        super().write_usage(prog, _held(args), prefix)

    def write_text(self, text: str) -> None:
        super().write_text(_held(text))

    def write_dl(self, rows: Iterable[tuple[str, str]], col_max: int = 30, col_spacing: int = 2) -> None:
        super().write_dl([(first, _held(second)) for first, second in rows], col_max, col_spacing)

    def getvalue(self) -> str:
        return super().getvalue().replace(_HELD, "-")


def _held(text: str) -> str:
    return text.replace("-", _HELD)


class CommandContext(click.Context):
    """What a command of the kit or the grader is called with."""

    formatter_class = WholeWordFormatter


def _prepared(command: click.Command) -> click.Command:
    """The command, with its own commands, whose help is broken at blanks alone."""
    command.context_class = CommandContext
    for each in command.commands.values() if isinstance(command, click.Group) else ():
        _prepared(each)
    return command


class LazyGroup(click.Group):
    """A group that imports a verb's module when the verb is used, and lists the verbs without importing any."""

    context_class = CommandContext

    def __init__(
        self,
        *arguments: Any,
        verbs: Verbs = VERBS,
        absent: Mapping[str, str] = MappingProxyType({}),
        has_others: bool = False,
        **options: Any,
    ) -> None:
        """``verbs``: by name ``module`` or ``module:command``, and its line in ``--help``; none for a verb that is not for
        people. ``absent``: verbs that somebody may look for and why they are not there. ``has_others``: whether verbs and
        dialogues of other packages are verbs of it."""
        super().__init__(*arguments, **options)
        self._verbs = verbs
        self._has_others = has_others
        self._absent = absent

    def _others(self) -> dict[str, Extension]:
        """The verbs and dialogues of other packages, by the names that the kit itself does not use."""
        if not self._has_others:
            return {}
        return {**extensions("dialogues", list(self._verbs)), **extensions("verbs", list(self._verbs))}

    def list_commands(self, ctx: click.Context) -> list[str]:
        return [*self._verbs, *self._others()]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in self._verbs:
            other = self._others().get(cmd_name)
            return None if other is None else _prepared(_command_of(other))
        module, _, name = self._verbs[cmd_name][0].partition(":")
        return _prepared(getattr(import_module(module), name or "command"))

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
            near = nearest_name(args[0], self.list_commands(ctx))
            hint = f" Did you mean `{path} {near}`?" if near else ""
            raise click.UsageError(
                f"There is no `{path} {args[0]}`.{hint} `{path} --help` lists the commands.", ctx
            ) from None

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        """The verbs that begin so, without importing any, and the options."""
        verbs = (
            CompletionItem(name, help=text)
            for name, (_, text) in self._verbs.items()
            if text and name.startswith(incomplete)
        )
        others = (CompletionItem(name) for name in self._others() if name.startswith(incomplete))
        return [*verbs, *others, *click.Command.shell_complete(self, ctx, incomplete)]

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl([(name, text) for name, (_, text) in self._verbs.items() if text])
        others = self._others()
        if others:
            with formatter.section("Commands of other packages"):
                formatter.write_dl([(name, f"From {each.source}.") for name, each in others.items()])


class UnusablePart(click.ClickException):
    """A verb of another package cannot be used."""

    exit_code = BAD_INPUT


def _command_of(extension: Extension) -> click.Command:
    """The verb, or the verb that opens a dialogue, of another package; one that cannot be used ends with a sentence."""
    try:
        found = load(extension)
    except ExtensionError as error:
        raise UnusablePart(str(error)) from None
    if extension.group == "dialogues":
        from kit.cli.dialogue import dialogue_command

        return dialogue_command(extension.name, found)
    if isinstance(found, click.Command):
        return found
    raise UnusablePart(f"The verb {extension.name} of {extension.source} is no click command.")


@click.group(
    cls=LazyGroup,
    has_others=True,
    invoke_without_command=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog="`kit COMMAND --help` explains a command, `kit help` lists pages to read. Ctrl-C leaves any screen.",
)
@click.version_option(VERSION, prog_name="kit")
@click.pass_context
def main(ctx: click.Context) -> None:
    """The terminal robot-learning kit: drive a robot, program it, train it.

    `kit` alone opens a menu and a robot in a maze, which you drive with W, A, S and D. Enter starts the first lesson,
    or continues where you left off.
    """
    if ctx.invoked_subcommand is None:
        start = main.get_command(ctx, "start")
        assert start is not None
        ctx.invoke(start)


def run() -> NoReturn:
    """Runs ``kit`` as this process."""
    run_as_process(main, "kit")


def run_as_process(command: click.Command, name: str) -> NoReturn:
    """Runs a command line as this process, to whose end belongs that what it has written is out.

    SIGTERM and SIGHUP end it as Ctrl-C does. Where the disk is full, or the folder another user's, one sentence says so in
    place of a traceback; exit code 2.

    After a full screen Python does not take apart what was imported, which takes longer than to leave the screen: the
    process ends once its output is written. The screen has given the terminal back and removed what it made; the exit
    handlers of libraries do not run, which would take compiled code away from threads that are still in it.
    """
    if signal.getsignal(signal.SIGINT) is signal.SIG_DFL:  # for the imports; see ``kit.__main__``
        signal.signal(signal.SIGINT, signal.default_int_handler)
    for foreign in foreign_distributions(only_named=True):
        click.echo(f"{name}: {overwritten_text(*foreign)}", err=True)
        raise SystemExit(BAD_INPUT)
    try:
        with ended_by_signals():
            try:
                command(prog_name=name)
            except SystemExit as stop:
                if stop.code == BAD_INPUT:  # and why has been said
                    write_out()
                if sys.stdout is not None:  # closed by whoever started this
                    sys.stdout.flush()
                raise
    except ScreenClosed as closed:
        write_out()
        os._exit(closed.code if isinstance(closed.code, int) else 0)
    except SystemExit as stop:
        if not isinstance(stop.code, int) or stop.code <= SIGNALLED:
            raise
        # Python would kill itself by SIGINT, whatever the code, if an `exec` of a library's was interrupted on the way.
        atexit._run_exitfuncs()
        write_out()
        os._exit(stop.code)
    except OSError as error:
        if not is_environment_error(error):
            raise
        with suppress(OSError):
            text = (
                describe_no_room(error) if error.errno in NO_ROOM else f"{error.filename}: {error.strerror}."
            )
            click.echo(f"{name}: {text}", err=True)
        write_out()
        raise SystemExit(BAD_INPUT) from None
    raise SystemExit(0)  # a command that ends otherwise has said so by a SystemExit of its own
