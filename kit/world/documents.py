"""Loads the YAML files of one world within limits and resolves their includes."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path

from kit.plain_text import quoted
from kit.world.files import AllowedRoot, UnusableFile, read_bytes
from kit.world.problems import ProblemCollector
from kit.world.records import SourceLocation
from kit.world.yaml_reader import InvalidYaml, NodeBudget, YamlComposer
from kit.world.yaml_section import Section
from kit.world.yaml_tree import MapNode, Node, ScalarNode, missing_blank

MAX_YAML_BYTES = 1_000_000
MAX_INCLUDES = 16
"""Maximum depth of nested includes."""


class WorldDocuments:
    """Reads each file once. Mistakes are noted in ``problems``; only an exceeded limit raises WorldError.

    ``environment``: the variables that ``env()`` may read.
    """

    def __init__(
        self, allowed_root: AllowedRoot, environment: Mapping[str, str], problems: ProblemCollector
    ) -> None:
        self.allowed_root = allowed_root
        self.problems = problems
        self._environment = environment
        self._budget = NodeBudget(problems)
        self._read_files: dict[Path, tuple[tuple[Node, ...], int]] = {}

    def section(self, file: Path, referenced_at: SourceLocation, text: str | None = None) -> Section | None:
        """The mapping that a file holds, which ``referenced_at`` names; None where it holds none, which is noted.

        ``text``: what the file held, where it is not to be read again.
        """
        documents = self._read(file, referenced_at, (), 0, text)
        if not documents:
            return None
        if len(documents) > 1:
            self.problems.add(documents[1].location, "a second YAML document: this file must have only one")
        if isinstance(documents[0], MapNode):
            return Section(documents[0], self.problems)
        document = documents[0]
        cure = (
            missing_blank(document.text) if isinstance(document, ScalarNode) and document.is_plain else None
        )
        self.problems.add(document.location, cure or "the file must contain a mapping of keys to values")
        return None

    def referenced_file(self, section: Section, key: str) -> Path | None:
        """The file that a key names, relative to the file in which the name stands; None if it may not be used."""
        name = section.name(key)
        if not name:
            return None
        try:
            return self.allowed_root.resolve(name, section.location_of(key).file.parent)
        except UnusableFile as error:
            section.error(str(error), key)
            return None

    def _read(
        self,
        file: Path,
        referenced_at: SourceLocation,
        chain: tuple[Path, ...],
        depth: int,
        text: str | None = None,
    ) -> tuple[Node, ...]:
        if file in self._read_files:
            documents, size = self._read_files[file]
            self._budget.count(size, referenced_at)
            return documents
        before = self._budget.spent
        documents = ()
        try:
            composer = YamlComposer(
                file,
                problems=self.problems,
                budget=self._budget,
                environment=self._environment,
                include=partial(self._include, (*chain, file)),
            )
            content = read_text(file, MAX_YAML_BYTES) if text is None else text
            documents = tuple(composer.documents(content, depth))
            if not documents:
                self.problems.add(SourceLocation(file), "the file is empty")
        except UnusableFile as error:
            self.problems.add(referenced_at, f"cannot read {quoted(str(file), 200)}: {error}")
        except InvalidYaml as error:
            self.problems.add(error.problem.location, error.problem.message)
        self._read_files[file] = documents, self._budget.spent - before
        return documents

    def _include(
        self, chain: tuple[Path, ...], name: str, location: SourceLocation, depth: int
    ) -> tuple[Node, ...]:
        try:
            file = self.allowed_root.resolve(name, location.file.parent)
        except UnusableFile as error:
            self.problems.add(location, str(error))
            return ()
        if file in chain:
            self.problems.add(location, f"{quoted(name)} includes itself")
            return ()
        if len(chain) > MAX_INCLUDES:
            self.problems.add(location, f"includes are nested more than {MAX_INCLUDES} levels deep")
            return ()
        return self._read(file, location, chain, depth)


def read_text(file: Path, limit: int) -> str:
    """The content of a UTF-8 file of at most ``limit`` bytes. Raises Unusable."""
    content = read_bytes(file, limit)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise UnusableFile(f"it is not UTF-8 text (line {line})") from error
