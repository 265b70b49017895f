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

    from grader.kinds.contract import kinds, sort_of
    from kit.world.problems import quoted, suggestion

    if kind not in kinds():
        options.fail(f"There is no kind {quoted(kind)}: {suggestion(kind, kinds())}")
    for name, check in sort_of(kind).checks.items():
        none, full = check.said(check.anchors.none), check.said(check.anchors.full)
        params = ", ".join(f"{each.name}: {each.default!r}" for each in fields(check.params))
        parts = [
            f"“{none}” earns nothing, “{full}” everything" if full else "",
            f"with: {params}" if params else "",
        ]
        said = check.feedback.format(actual="...", full=full, where="...", passed="...", count="...")
        for text, first in ((said, f"{name:<{MARGIN - 1}} "), ("; ".join(filter(None, parts)), " " * MARGIN)):
            click.echo(textwrap.fill(text, WIDTH, initial_indent=first, subsequent_indent=" " * MARGIN))
    others = ", ".join(each for each in kinds() if each != kind)
    click.echo("\n" + textwrap.fill(f"Other kinds: {others}.", WIDTH))
