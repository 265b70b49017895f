"""The YAML files of one world: found, read within limits, and put into one another where they say so."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path

from kit.world.files import Enclosure, Unusable, read_bytes
from kit.world.problems import Problems, quoted
from kit.world.records import Place
from kit.world.yaml_reader import Budget, Composer, NotYaml
from kit.world.yaml_section import Section
from kit.world.yaml_tree import MapNode, Node

MAX_YAML_BYTES = 1_000_000
MAX_INCLUDES = 16
"""How deep files may include one another."""


class Documents:
    """Reads each file once. What is wrong is noted in ``problems``; only an exceeded limit raises WorldError.

    ``environment``: the variables that ``env()`` may read.
    """

    def __init__(self, enclosure: Enclosure, environment: Mapping[str, str], problems: Problems) -> None:
        self.enclosure = enclosure
        self.problems = problems
        self._environment = environment
        self._budget = Budget(problems)
        self._known: dict[Path, tuple[tuple[Node, ...], int]] = {}

    def section(self, file: Path, named_at: Place) -> Section | None:
        """The mapping that a file holds, which ``named_at`` names; None where it holds none, which is noted."""
        documents = self._read(file, named_at, (), 0)
        if not documents:
            return None
        if len(documents) > 1:
            self.problems.add(documents[1].place, "a second document: this file must hold one")
        if isinstance(documents[0], MapNode):
            return Section(documents[0], self.problems)
        self.problems.add(documents[0].place, "the file must hold a mapping of keys to values")
        return None

    def named(self, section: Section, key: str) -> Path | None:
        """The file that a key names, relative to the file in which the name stands; None if it may not be used."""
        name = section.name(key)
        if not name:
            return None
        try:
            return self.enclosure.locate(name, section.place_of(key).file.parent)
        except Unusable as error:
            section.error(str(error), key)
            return None

    def _read(self, file: Path, named_at: Place, chain: tuple[Path, ...], depth: int) -> tuple[Node, ...]:
        if file in self._known:
            documents, size = self._known[file]
            self._budget.spend(size, named_at)
            return documents
        before = self._budget.spent
        documents = ()
        try:
            composer = Composer(
                file,
                problems=self.problems,
                budget=self._budget,
                environment=self._environment,
                include=partial(self._included, (*chain, file)),
            )
            documents = tuple(composer.documents(read_text(file, MAX_YAML_BYTES), depth))
            if not documents:
                self.problems.add(Place(file), "the file is empty")
        except Unusable as error:
            self.problems.add(named_at, f"cannot read {quoted(str(file), 200)}: {error}")
        except NotYaml as error:
            self.problems.add(error.problem.place, error.problem.message)
        self._known[file] = documents, self._budget.spent - before
        return documents

    def _included(self, chain: tuple[Path, ...], name: str, place: Place, depth: int) -> tuple[Node, ...]:
        try:
            file = self.enclosure.locate(name, place.file.parent)
        except Unusable as error:
            self.problems.add(place, str(error))
            return ()
        if file in chain:
            self.problems.add(place, f"{quoted(name)} would include itself without end")
            return ()
        if len(chain) > MAX_INCLUDES:
            self.problems.add(place, f"files include one another more than {MAX_INCLUDES} deep")
            return ()
        return self._read(file, place, chain, depth)


def read_text(file: Path, limit: int) -> str:
    """The content of a UTF-8 file of at most ``limit`` bytes. Raises Unusable."""
    content = read_bytes(file, limit)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise Unusable(f"it is not a text in UTF-8 (line {line})") from error
