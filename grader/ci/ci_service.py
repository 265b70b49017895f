"""What a CI service is, and what its file is made from."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Final

_ADDRESS: Final = re.compile(
    r"(?P<address>https://[A-Za-z0-9.-]+(:[0-9]+)?(/[A-Za-z0-9_.~-]+)+)(@(?P<version>[A-Za-z0-9_][A-Za-z0-9_./-]*))?"
)


@dataclass(frozen=True, slots=True)
class GradedWork:
    """One assignment of a repository, and where the student's work for it lies."""

    name: str
    """Used in the names of files."""
    work: str
    """File or folder, relative to the repository."""
    assignment: str
    """Folder, relative to the repository."""


@dataclass(frozen=True, slots=True)
class CiRunner:
    """The machine and the Python that a workflow runs on."""

    python: str = "3.12"
    image: str = "ubuntu-24.04"
    minutes: int = 15


@dataclass(frozen=True, slots=True)
class GitSource:
    """Address and version of the kit's source repository."""

    address: str
    """For ``git clone``."""
    version: str = ""
    """A branch or tag; empty for the default branch."""

    @classmethod
    def read(cls, text: str) -> GitSource:
        """``https://HOST/PATH`` or ``https://HOST/PATH@VERSION``. Raises ValueError for anything else, since the text goes into a shell script."""
        found = _ADDRESS.fullmatch(text)
        if found is None:
            raise ValueError(f"{text}: give https://HOST/PATH, optionally followed by @ and a branch or tag")
        return cls(found["address"], found["version"] or "")

    @property
    def clone(self) -> str:
        """The arguments for ``git clone``."""
        return f"--branch {self.version} {self.address}" if self.version else self.address


@dataclass(frozen=True, slots=True)
class CiService:
    """Makes the file that a service grades by. The names of works go into a shell's double quotes, so they must be plain."""

    name: str
    """On the command line."""
    place: PurePosixPath
    """Where the service looks for the file, from the top of the repository."""
    write: Callable[[Sequence[GradedWork], GitSource, CiRunner], bytes]
    """Makes the file's content. Raises OSError where it takes an assignment's files in and cannot read them."""
    is_in_students_repository: bool
    """Whether students have the file, and so everything beside it; else it takes one assignment."""
    is_text: bool = True
    """Whether it can be printed."""


def lines_of_works(works: Sequence[GradedWork], margin: str) -> str:
    """Writes a work on each line for the shell to read, after the margin of a block of YAML."""
    return "\n".join(f"{margin}{each.name} {each.work} {each.assignment}" for each in works)
