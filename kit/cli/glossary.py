"""``kit glossary``: what the terms of the lessons mean."""

from __future__ import annotations

import click

from kit.cli import options


@click.command()
@click.argument("term", nargs=-1)
def command(term: tuple[str, ...]) -> None:
    """Say what a TERM of the lessons means, or all of them, and which lesson introduces it.

    \b
    kit glossary                    every term
    kit glossary quality of service one of them
    """
    from kit.school.lessons.glossary import UnknownTerm, find_terms, read_glossary
    from kit.world.problems import WorldError

    try:
        terms = read_glossary()
        shown = find_terms(terms, " ".join(term)) if term else terms
    except (UnknownTerm, WorldError, FileNotFoundError) as error:
        options.fail(str(error))
    for each in shown:
        click.echo("\n".join(each.lines()))
