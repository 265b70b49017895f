"""The folder of HTML: every page, no dead link, and nothing that a page needs from elsewhere."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

from kit.help.site import INDEX, overview, page_file, write_pages
from kit.help.topic import find_topic, topic_names
from tests.cli.verbs import kit
from tests.help.page_commands import commands_in_sentences


class Reader(HTMLParser):
    """Collects a page's links and ids."""

    def __init__(self) -> None:
        super().__init__()
        self.links: list[str] = []
        self.ids: list[str] = []
        self.tags: set[str] = set()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        found = dict(attrs)
        self.tags.add(tag)
        self.links += [found["href"] or ""] if "href" in found else []
        self.ids += [found["id"] or ""] if "id" in found else []


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Reader]:
    read = {}
    for file in write_pages(tmp_path_factory.mktemp("pages") / "new"):
        read[file.name] = Reader()
        read[file.name].feed(file.read_text())
    return read


def test_every_topic_has_a_page_that_the_index_links(pages: dict[str, Reader]) -> None:
    files = {page_file(name) for name in topic_names()}
    assert set(pages) == {INDEX, *files}
    assert files <= set(pages[INDEX].links)
    for name, page in pages.items():
        assert name == INDEX or INDEX in page.links


def test_no_link_is_dead_and_no_id_is_there_twice(pages: dict[str, Reader]) -> None:
    for name, page in pages.items():
        assert len(set(page.ids)) == len(page.ids), name
        for link in page.links:
            file, _, place = link.partition("#")
            assert (file or name) in pages, f"{name}: {link}"
            assert not place or place in pages[file or name].ids, f"{name}: {link}"


def test_a_page_needs_nothing_from_elsewhere(pages: dict[str, Reader]) -> None:
    for page in pages.values():
        assert not page.tags & {"script", "link", "img", "iframe"}


def test_every_topic_that_a_page_names_exists() -> None:
    for name in topic_names():
        for command in commands_in_sentences(name):
            named = re.fullmatch(r"kit help ([a-z-]+)", command)
            assert named is None or named[1] in topic_names(), f"{name}: {command}"


def test_the_overview_lists_every_topic_once() -> None:
    text = "".join(str(block) for chapter in overview().chapters for block in chapter.blocks)
    assert all(text.count(f"`kit help {name}`") == 1 for name in topic_names())


def test_a_page_a_chapter_and_a_command_are_shown() -> None:
    whole = kit("help", "exit-codes").output
    assert "Ctrl-C" in whole
    (first, *_) = find_topic("design").document().chapters
    shown = kit("help", "design", first.id).output
    assert first.title in shown
    assert find_topic("design").document().chapters[1].title not in shown
    assert "did you mean" in kit("help", "design", "the-main-lop", code=2).output
    assert "did you mean" in kit("help", "desing", code=2).output
    assert "run [OPTIONS] MAP" in kit("help", "run").output


def test_the_pages_are_written_where_they_were_asked_for(tmp_path: Path) -> None:
    assert str(tmp_path / "site") in kit("help", "--html", tmp_path / "site").output
    assert (tmp_path / "site" / INDEX).is_file()
    (tmp_path / "file").touch()
    kit("help", "--html", tmp_path / "file", code=2)


def test_no_row_of_a_page_is_wider_than_a_terminal() -> None:
    for name in topic_names():
        rows = kit("help", name).output.splitlines()
        assert [row for row in rows if len(row) > 80] == [], name
