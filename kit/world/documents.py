"""Opens the files that a world names, and loads the YAML ones within limits, with their includes.

A world may be untrusted, so nothing outside its folder is opened, nothing that is not a plain file, and nothing without a
limit on its size.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from functools import lru_cache, partial
from pathlib import Path

from kit.plain_files import near_file, read_plain_file
from kit.plain_text import is_printable, quoted
from kit.world.problems import Problem, ProblemCollector, WorldError
from kit.world.records import SourceLocation
from kit.world.yaml_reader import InvalidYaml, NodeBudget, YamlComposer
from kit.world.yaml_section import Section
from kit.world.yaml_tree import MapNode, Node, ScalarNode
from kit.yaml_slips import missing_blank

MAX_YAML_BYTES = 1_000_000
MAX_KEPT_CHARACTERS = 100_000
"""A text that is longer is not kept."""
MAX_INCLUDES = 16
"""Maximum depth of nested includes."""

WIDER_ROOT = ": use --root to allow a wider folder, or put a package.xml in it"
"""Advice at the end of the message about a file outside the allowed folder."""


_DEPENDENT = re.compile(r"[$\\]|\benv\s*\(")


class UnusableFile(Exception):
    """A file that cannot be used; the message says why, without naming the file."""


@dataclass(frozen=True, slots=True)
class AllowedRoot:
    """A folder that paths may not leave: not by ``..``, absolute paths or symbolic links."""

    display_path: Path
    """The folder as the user calls it: how its files are named in messages and records."""
    real_path: Path
    """The same, free of symbolic links."""

    @classmethod
    def of_folder(cls, root: Path) -> AllowedRoot:
        return cls(root, _resolve_links(root))

    @classmethod
    def containing(cls, file: Path) -> AllowedRoot:
        """The folder in which the file lies (really lies, if it is a symbolic link)."""
        return cls.of_folder((_resolve_links(file) if file.is_symlink() else file).parent)

    def resolve(self, text: str, folder: Path) -> Path:
        """Returns the file that ``text`` in a file of ``folder`` refers to. Raises UnusableFile."""
        if not text or not is_printable(text):
            raise UnusableFile(f"{quoted(text)} is not a file name")
        return self._checked(folder / text, text)

    def path_inside(self, path: Path) -> Path:
        """Returns the path of the same file below this folder. Raises UnusableFile if it lies elsewhere."""
        return self._checked(path, str(path))

    def _checked(self, path: Path, given: str) -> Path:
        real = _resolve_links(path)
        if not real.is_relative_to(self.real_path):
            folder = quoted(str(self.display_path), 200)
            raise UnusableFile(f"{quoted(given)} is outside the folder {folder}{WIDER_ROOT}")
        return self.display_path / real.relative_to(self.real_path)


_READ_FILES: ContextVar[set[Path] | None] = ContextVar("_READ_FILES", default=None)


@contextmanager
def collected_reads() -> Iterator[set[Path]]:
    """Collects the files that are read inside it by ``read_bytes``: all that a world consists of, if it is loaded here."""
    files: set[Path] = set()
    token = _READ_FILES.set(files)
    try:
        yield files
    finally:
        _READ_FILES.reset(token)


def read_bytes(path: Path, limit: int) -> bytes:
    """The content of a regular file of at most ``limit`` bytes. Raises UnusableFile."""
    if (collected := _READ_FILES.get()) is not None:
        collected.add(path)
    try:
        return read_plain_file(path, limit)
    except (OSError, ValueError) as error:
        raise UnusableFile(_error_text(error)) from error


def _exists(file: Path) -> bool:
    """Whether there is such a file; a name that is too long has none."""
    try:
        return file.exists()
    except OSError:
        return False


def _resolve_links(path: Path) -> Path:
    try:
        return path.resolve()
    except (OSError, RuntimeError, ValueError) as error:  # a loop of links; too long; a NUL in the name
        raise UnusableFile(f"{quoted(str(path))} cannot be a file: {_error_text(error)}") from error


def _error_text(error: Exception) -> str:
    if isinstance(error, FileNotFoundError):
        return "there is no such file"
    if isinstance(error, IsADirectoryError):
        return "it is a folder"
    if isinstance(error, OSError) and error.strerror:
        return error.strerror[:1].lower() + error.strerror[1:]
    return str(error).lower()


def open_document(file: Path, *, is_partial: bool = False) -> AbstractContextManager[Section]:
    """Opens a YAML file that stands alone: what it includes lies in its folder, and ``env()`` reads nothing.

    Otherwise as ``WorldDocuments.open``.
    """
    try:
        root = AllowedRoot.containing(file)
    except UnusableFile as error:
        raise WorldError([Problem(SourceLocation(file), f"cannot read it: {error}")]) from error
    return WorldDocuments(root, {}, ProblemCollector()).open(file, is_partial=is_partial)


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

    @contextmanager
    def open(self, file: Path, text: str | None = None, *, is_partial: bool = False) -> Iterator[Section]:
        """Opens a file for the block that reads its mapping; an unknown key is noted when the block ends.

        ``text``: what the file held, where it is not to be read again. ``is_partial``: the block reads only some keys, and
        the others are no mistake. Raises WorldError with all mistakes noted: at once where the file holds no mapping,
        otherwise at the end.
        """
        section = self.section(file, SourceLocation(file), text)
        if section is None:
            raise self.problems.error()
        yield section
        if not is_partial:
            section.finish()
        self.problems.raise_if_any()

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
        folder = section.location_of(key).file.parent
        try:
            file = self.allowed_root.resolve(name, folder)
        except UnusableFile as error:
            near = near_file(name, folder)
            section.error(f"{error}{f'. Did you mean {quoted(near)}?' if near else ''}", key)
            return None
        if not _exists(file) and (near := near_file(name, folder)):
            section.error(f"{quoted(name)}: there is no such file. Did you mean {quoted(near)}?", key)
            return None
        return file

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
            kept = _kept_documents(file, content) if depth == 0 and _is_independent(content) else []
            if kept and self._budget.has_room_for(kept[0][1]):
                documents = kept[0][0]
                self._budget.count(kept[0][1], referenced_at)
            else:
                mistakes = len(self.problems)
                documents = tuple(composer.documents(content, depth))
                if not kept and len(self.problems) == mistakes:
                    kept.append((documents, self._budget.spent - before))
            if not documents:
                self.problems.add(SourceLocation(file), "the file is empty")
        except UnusableFile as error:
            near = "" if _exists(file) else near_file(str(file), file.parent) or near_file(str(file))
            hint = f". Did you mean {quoted(near)}?" if near else ""
            self.problems.add(referenced_at, f"cannot read {quoted(str(file), 200)}: {error}{hint}")
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


def _is_independent(text: str) -> bool:
    """Whether a text surely names no other file and no variable; it may spell them with escapes."""
    return len(text) <= MAX_KEPT_CHARACTERS and not _DEPENDENT.search(text)


@lru_cache(maxsize=256)
def _kept_documents(file: Path, text: str) -> list[tuple[tuple[Node, ...], int]]:
    """Where the documents of an independent text are kept, with the number of their values, once it was composed without a
    mistake: many worlds share a robot, and every overview of the lessons reads them all."""
    return []


def read_text(file: Path, limit: int) -> str:
    """The content of a UTF-8 file of at most ``limit`` bytes. Raises UnusableFile."""
    content = read_bytes(file, limit)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise UnusableFile(f"it is not UTF-8 text (line {line})") from error
