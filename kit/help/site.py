"""All pages as a folder of plain HTML: one file a topic, and an index."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from kit.document.blocks import Chapter, Document, Marked
from kit.document.html import document_to_html
from kit.help.topic import Shelf, find_topic, topic_names
from kit.workspace import write_atomically

INDEX: Final = "index.html"


def overview() -> Document:
    """The list of all topics, shelf by shelf."""
    found = {name: find_topic(name) for name in topic_names()}
    chapters = (
        Chapter(
            shelf.name.lower().replace("_", "-"),
            shelf.value,
            (
                Marked(
                    "\n".join(
                        f"- `kit help {name}`: {topic.summary}"
                        for name, topic in found.items()
                        if topic.shelf is shelf
                    )
                ),
            ),
        )
        for shelf in Shelf
    )
    return Document("The terminal robot-learning kit", tuple(chapters))


def page_file(name: str) -> str:
    """The file of a topic's page."""
    return f"{name}.html"


def write_pages(folder: Path) -> list[Path]:
    """Writes every page and the index into a folder, which is made; returns the files. OSError if one cannot be written."""
    folder.mkdir(parents=True, exist_ok=True)
    links = {"kit help": INDEX} | {f"kit help {name}": page_file(name) for name in topic_names()}
    pages = {INDEX: overview()} | {page_file(name): find_topic(name).document() for name in topic_names()}
    files = []
    for name, page in pages.items():
        files.append(folder / name)
        write_atomically(files[-1], document_to_html(page, links).encode())
    return files
