"""``grader checks``: what can be asked for in an assignment."""

from __future__ import annotations

import textwrap

import click

from grader.cli import options

WIDTH = 78
MARGIN = 18


@click.command()
@click.argument("kind", required=False, default="controller")
def command(kind: str) -> None:
    """List the checks that an assignment of this KIND may use: what each measures, what earns nothing and what earns
    everything unless `share` says otherwise, and what `with` may set.

    \b
    grader checks reward
    """
    from dataclasses import fields

    from grader.kinds.contract import find_kind, kind_names
    from kit.world.problems import quoted, suggestion

    if kind not in kind_names():
        options.fail(f"There is no kind {quoted(kind)}: {suggestion(kind, kind_names())}")
    for name, check in find_kind(kind).checks.items():
        none, full = check.format(check.anchors.none), check.format(check.anchors.full)
        params = ", ".join(f"{each.name}: {each.default!r}" for each in fields(check.params))
        parts = [
            f"“{none}” earns nothing, “{full}” everything" if full else "",
            f"with: {params}" if params else "",
        ]
        text = check.feedback.format(actual="...", full=full, where="...", passed="...", count="...")
        for line, first in ((text, f"{name:<{MARGIN - 1}} "), ("; ".join(filter(None, parts)), " " * MARGIN)):
            click.echo(textwrap.fill(line, WIDTH, initial_indent=first, subsequent_indent=" " * MARGIN))
    others = ", ".join(each for each in kind_names() if each != kind)
    click.echo("\n" + textwrap.fill(f"Other kinds: {others}.", WIDTH))
