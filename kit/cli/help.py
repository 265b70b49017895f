"""``kit help``: the pages of the kit, in the terminal or as a folder of HTML."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import click

from kit.cli import messages
from kit.cli.lazy_group import LazyGroup
from kit.document.blocks import Chapter, Document, Tone
from kit.document.glyphs import WIDTH
from kit.document.layout import Page, rows_of
from kit.document.rows import Row, row_text
from kit.help.site import overview, write_pages
from kit.help.topic import find_topic, topic_names
from kit.plain_text import counted, quoted, suggestion, unknown_name

_STYLES: Final[Mapping[str, Mapping[str, bool]]] = {
    Tone.CODE: {"bold": True},
    Tone.BOLD: {"bold": True},
    Tone.DIM: {"dim": True},
}
"""How a terminal shows tones; nothing is said by them alone."""


@click.command()
@click.argument("topic", required=False)
@click.argument("chapter", required=False)
@click.option(
    "--html",
    "html_folder",
    metavar="FOLDER",
    type=click.Path(file_okay=False, path_type=Path),
    help="Write all pages as HTML into FOLDER.",
)
@click.pass_context
def command(context: click.Context, topic: str | None, chapter: str | None, html_folder: Path | None) -> None:
    """Show a page: how to do something, or something to look up. Without TOPIC, list all pages.

    \b
    kit help student
    kit help world-format
    kit help world-format device-laser
    kit help --html pages

    CHAPTER: the part of a page to show; `kit help TOPIC` lists its chapters. Where TOPIC is a command, its --help is shown.
    """
    if html_folder is not None:
        if topic is not None:
            messages.fail("--html writes all pages: leave TOPIC out.")
        try:
            files = write_pages(html_folder)
        except OSError as error:
            messages.fail(messages.describe_os_error(error))
        click.echo(f"{counted(len(files), 'page')}: {files[0]}")
        return
    if topic is None:
        _print_document(overview())
    elif topic in topic_names():
        _print_document(_topic_document(topic, chapter))
    else:
        _print_command_help(context, topic)


def _topic_document(name: str, chapter: str | None) -> Document:
    """A topic's page, or one chapter of it."""
    document = find_topic(name).document()
    if chapter is None:
        return document
    found = {each.id: each for each in document.chapters}
    if chapter not in found:
        messages.fail(
            f"There is no chapter {quoted(chapter)} in {quoted(name)}: {suggestion(chapter, found)}"
        )
    return Document(document.title, (found[chapter],))


def _print_command_help(context: click.Context, name: str) -> None:
    main = context.find_root().command
    assert isinstance(main, LazyGroup)
    found = main.get_command(context, name)
    if found is None:
        known = (*topic_names(), *main.list_commands(context))
        messages.fail(unknown_name("topic", name, known, "kit help"))
    click.echo(found.get_help(found.context_class(found, info_name=name, parent=context.find_root())))


def _print_document(document: Document) -> None:
    click.echo(document.title)
    for each in document.chapters:
        click.echo("\n".join(("", _heading(each), "=" * len(each.title), "")))
        _print_rows(rows_of(each.blocks, Page(width=WIDTH)))


def _heading(chapter: Chapter) -> str:
    return click.style(chapter.title, bold=True)


def _print_rows(rows: Sequence[Row]) -> None:
    is_terminal = sys.stdout.isatty()
    for each in rows:
        line = (
            "".join(click.style(text, **_STYLES.get(tone, {})) for text, tone in each)
            if is_terminal
            else row_text(each)
        )
        click.echo(messages.replace_unencodable(line.rstrip()))
