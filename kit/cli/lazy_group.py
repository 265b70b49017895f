"""A group of commands whose modules are imported only when they are used, and help that is broken at blanks alone."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from importlib import import_module
from types import MappingProxyType
from typing import Any, Final

import click
from click.shell_completion import CompletionItem
from click.types import StringParamType

from kit.cli.process import BAD_INPUT, INTERRUPTED
from kit.extensions import Extension, ExtensionError, extensions, load
from kit.plain_text import nearest_name

_TAKEN: Final = "kit.taken"
"""Of a context: the path of a group whose word is taken for a name, and the nearest of its commands."""
Verbs = Mapping[str, tuple[str, str]]
_HELD: Final = "\ue000"
"""In the place of a hyphen while click wraps a text: it would break an option there."""


class WholeWordFormatter(click.HelpFormatter):
    """Breaks the text of a command's help at blanks alone."""

    def write_usage(self, prog: str, args: str = "", prefix: str | None = None) -> None:
        super().write_usage(prog, _keep_hyphens_together(args), prefix)

    def write_text(self, text: str) -> None:
        super().write_text(_keep_hyphens_together(text))

    def write_dl(self, rows: Iterable[tuple[str, str]], col_max: int = 30, col_spacing: int = 2) -> None:
        super().write_dl(
            [(first, _keep_hyphens_together(second)) for first, second in rows], col_max, col_spacing
        )

    def getvalue(self) -> str:
        return super().getvalue().replace(_HELD, "-")


def _keep_hyphens_together(text: str) -> str:
    return text.replace("-", _HELD)


class CommandContext(click.Context):
    """What a command of the kit or the grader is called with."""

    formatter_class = WholeWordFormatter


class WordType(StringParamType):
    """A word that may name a file: a map or a world's file. click has a shell complete nothing for a text."""

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        return [CompletionItem(incomplete, type="file")]


WORD: Final = WordType()


def _prepare(command: click.Command, everywhere: Sequence[click.Option]) -> click.Command:
    """The command, with its own commands: its help is broken at blanks alone, a shell completes its words with files, and
    it takes the options ``everywhere`` unless it has one of that name, or passes on what it does not know."""
    command.context_class = CommandContext
    for parameter in command.params:
        if parameter.type is click.STRING:
            parameter.type = WORD
    if not command.context_settings.get("ignore_unknown_options"):
        names = {name for parameter in command.params for name in parameter.opts}
        command.params.extend(option for option in everywhere if names.isdisjoint(option.opts))
    for each in command.commands.values() if isinstance(command, click.Group) else ():
        _prepare(each, everywhere)
    return command


LONGEST_SENTENCE: Final = 1000
"""Characters of what is said of a command in the list of its group."""


class HintingGroup(click.Group):
    """A group that tells which of its commands a word that is none may mean."""

    absent: Mapping[str, str] = MappingProxyType({})
    """Commands that users may try, and why there are none."""

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        try:
            return super().resolve_command(ctx, args)
        except click.UsageError:
            path = ctx.command_path
            if args[0] in self.absent:
                raise click.UsageError(
                    f"There is no `{path} {args[0]}`: {self.absent[args[0]]}", ctx
                ) from None
            near = nearest_name(args[0], self.list_commands(ctx))
            hint = f" Did you mean `{path} {near}`?" if near else ""
            raise click.UsageError(
                f"There is no `{path} {args[0]}`.{hint} `{path} --help` lists the commands.", ctx
            ) from None

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Each with its whole first sentence, which click would cut to the end of a line."""
        commands = [(name, self.get_command(ctx, name)) for name in self.list_commands(ctx)]
        told = [
            (name, each.get_short_help_str(LONGEST_SENTENCE))
            for name, each in commands
            if each is not None and not each.hidden
        ]
        if told:
            with formatter.section("Commands"):
                formatter.write_dl(told)


class LazyGroup(HintingGroup):
    """A group that imports a verb's module when the verb is used, and lists the verbs without importing any."""

    context_class = CommandContext

    def __init__(
        self,
        *arguments: Any,
        verbs: Verbs,
        absent: Mapping[str, str] = MappingProxyType({}),
        has_others: bool = False,
        everywhere: Sequence[click.Option] = (),
        **options: Any,
    ) -> None:
        """``verbs``: for each name its ``module`` or ``module:command``, and its line in ``--help``; without a line, a verb
        is not listed. ``absent``: verbs that users may try, and why the kit does not have them. ``has_others``: whether
        verbs and dialogues of other packages belong to the group. ``everywhere``: options that every verb takes."""
        super().__init__(*arguments, **options)
        self._verbs = verbs
        self._has_others = has_others
        self.absent = absent
        self._everywhere = everywhere

    def _extension_commands(self) -> dict[str, Extension]:
        """The verbs and dialogues of other packages, by the names that the kit itself does not use."""
        if not self._has_others:
            return {}
        return {**extensions("dialogues", list(self._verbs)), **extensions("verbs", list(self._verbs))}

    def invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except (KeyboardInterrupt, click.Abort):  # of which click says "Aborted!"
            pass
        except RuntimeError as error:
            if not isinstance(error.__cause__, KeyboardInterrupt):
                raise  # before Python 3.12, an interrupt while a class is made, as in imports, is the cause of another error
        click.echo(f"\n{ctx.command_path}: interrupted before it was done.", err=True)
        raise SystemExit(INTERRUPTED)

    def list_commands(self, ctx: click.Context) -> list[str]:
        return [*self._verbs, *self._extension_commands()]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in self._verbs:
            other = self._extension_commands().get(cmd_name)
            return None if other is None else _prepare(_command_of(other), self._everywhere)
        module, _, name = self._verbs[cmd_name][0].partition(":")
        return _prepare(getattr(import_module(module), name or "command"), self._everywhere)

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        """The verbs that begin so, without importing any, and the options."""
        verbs = (
            CompletionItem(name, help=text)
            for name, (_, text) in self._verbs.items()
            if text and name.startswith(incomplete)
        )
        others = (CompletionItem(name) for name in self._extension_commands() if name.startswith(incomplete))
        return [*verbs, *others, *click.Command.shell_complete(self, ctx, incomplete)]

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl([(name, text) for name, (_, text) in self._verbs.items() if text])
        others = self._extension_commands()
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


def or_command(message: str) -> str:
    """The message about a name that nothing has, with the group's own command that a word in its place may mean."""
    path, near = click.get_current_context().meta.get(_TAKEN, ("", None))
    if not path:
        return message
    return (
        f"{message} Or is it `{path} {near}`?" if near else f"{message} `{path} --help` lists the commands."
    )


class NamesGroup(HintingGroup):
    """A group that may also be given a name, such as a map's, which its command ``taker`` takes."""

    taker: click.Command | None = None

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        if args and self.get_command(ctx, args[0]) is None and not args[0].startswith("-"):
            taker = self.taker
            ctx.meta[_TAKEN] = ctx.command_path, nearest_name(args[0], self.list_commands(ctx))
            assert taker is not None  # each such group has one
            return taker.name, taker, args
        return super().resolve_command(ctx, args)
