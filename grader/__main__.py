"""``python -m grader``. Each verb is one module of ``grader.cli``, imported only when it is used."""

from __future__ import annotations

from difflib import get_close_matches
from importlib import import_module
from typing import Final

import click

VERBS: Final[dict[str, tuple[str, str]]] = {
    "check": ("grader.cli.check", "Judge one submission: a verdict per criterion, and what to do next."),
    "new": ("grader.cli.new", "Make an assignment's folder, to start from."),
    "checks": ("grader.cli.checks", "List what can be checked, by what is handed in."),
    "self-test": ("grader.cli.self_test", "Try an assignment out on its own solution and wrong solutions."),
    "report": ("grader.cli.report", "Write a result in another format."),
    "ci": ("grader.cli.ci", "Print a workflow file for GitHub or GitLab."),
    "cohort": ("grader.cli.cohort", "Grade a folder of submissions; go on where it was interrupted."),
    "work": ("grader.cli.work", "Work off a share of a cohort's queue, on another machine."),
    "worker": ("grader.cli.worker", ""),
    "gradebook": ("grader.cli.gradebook", "Print a cohort's gradebook: late rules, and what has changed."),
}
"""Every verb: the module that holds its ``command``, and its line in ``grader --help``; none if it is not for people."""


class LazyGroup(click.Group):
    """A group that imports a verb's module when the verb is used, and lists the verbs without importing any."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(VERBS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in VERBS:
            return None
        command: click.Command = import_module(VERBS[cmd_name][0]).command
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        if args[0] not in VERBS and not args[0].startswith("-"):
            near = get_close_matches(args[0], VERBS, n=1)
            hint = f" Did you mean `grader {near[0]}`?" if near else ""
            raise click.UsageError(
                f"There is no `grader {args[0]}`.{hint} `grader --help` lists the verbs.", ctx
            )
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Verbs"):
            formatter.write_dl([(name, text) for name, (_, text) in VERBS.items() if text])


@click.group(
    cls=LazyGroup,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog="`grader VERB --help` explains a verb.",
)
def main() -> None:
    """Checks controllers and reward functions: one at a desk, a class in CI, a cohort on a cluster."""


if __name__ == "__main__":
    main(prog_name="grader")
