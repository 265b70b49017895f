"""``python -m grader``: the verbs, whose modules in ``grader.cli`` are imported only when a verb is used."""

from __future__ import annotations

import os
from collections.abc import Mapping
from importlib import import_module
from types import MappingProxyType
from typing import Final, NamedTuple

import click

from kit.plain_text import nearest_name

# Before numpy is imported: it starts a thread for each core otherwise, for sums that one adds up in no time.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


class GraderVerb(NamedTuple):
    """Where a verb's command is, and its line in ``grader --help``."""

    module: str
    command: str
    help: str = ""
    """Empty for a verb that is not for people."""


VERBS: Final[Mapping[str, GraderVerb]] = MappingProxyType(
    {
        "check": GraderVerb(
            "check", "check", "Grade one submission: a verdict per criterion, and what to do next."
        ),
        "new": GraderVerb("assignments", "new", "Make an assignment's folder, to start from."),
        "checks": GraderVerb("assignments", "checks", "List what can be checked, by what is handed in."),
        "self-test": GraderVerb(
            "assignments", "self_test", "Try an assignment out on its own solution and wrong solutions."
        ),
        "report": GraderVerb("check", "report", "Write a result in another format."),
        "ci": GraderVerb("assignments", "ci", "Print a workflow file for GitHub or GitLab."),
        "cohort": GraderVerb(
            "cohort", "cohort", "Grade a folder of submissions; go on where it was interrupted."
        ),
        "work": GraderVerb("cohort", "work", "Grade a share of a cohort's queue, on another machine."),
        "worker": GraderVerb("cohort", "worker"),
        "gradebook": GraderVerb(
            "cohort", "gradebook", "Print a cohort's gradebook: late rules, and what has changed."
        ),
        "ladder": GraderVerb("cohort", "ladder", "Race all programs of a folder, and rank them."),
    }
)
"""Every verb, in the order of ``grader --help``."""


class GraderGroup(click.Group):
    """A group that imports a verb's module when the verb is used, and lists the verbs without importing any."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(VERBS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in VERBS:
            return None
        verb = VERBS[cmd_name]
        command: click.Command = getattr(import_module(f"grader.cli.{verb.module}"), verb.command)
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        if args[0] not in VERBS and not args[0].startswith("-"):
            near = nearest_name(args[0], VERBS)
            hint = f" Did you mean `grader {near}`?" if near else ""
            raise click.UsageError(
                f"There is no `grader {args[0]}`.{hint} `grader --help` lists the verbs.", ctx
            )
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Verbs"):
            formatter.write_dl([(name, verb.help) for name, verb in VERBS.items() if verb.help])


@click.group(
    cls=GraderGroup,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog="`grader VERB --help` explains a verb.",
)
def main() -> None:
    """Grades what students program: one submission here, each push in CI, or a whole class on a cluster."""


if __name__ == "__main__":
    main(prog_name="grader")
