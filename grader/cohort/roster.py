"""The roster of a class: who is in it, as Moodle, Canvas, Gradescope and GitHub Classroom export it, and whose work is whose.

A roster is a CSV file with a line of column titles. Whose form it has is told by these titles; one of a teacher's own has
``name``, ``email``, ``id``, ``login`` and ``group``, of which one is enough. The file's own rows are kept, so that a grade can go
back into them.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Final

from grader.cohort.csv_file import read_csv_file
from grader.look_alikes import look
from kit.plain_text import join_names


@dataclass(frozen=True, slots=True)
class RosterEntry:
    """One student of the class. What the roster does not say is empty."""

    name: str = ""
    email: str = ""
    id: str = ""
    """The number by which the university or the learning platform knows the student."""
    login: str = ""
    group: str = ""
    """Students of one group hand in one work."""
    number: str = ""
    """What downloads of the platform write beside the name: Moodle's participant, Canvas's ID."""

    @property
    def label(self) -> str:
        """What the student is called in lists."""
        return self.name or self.email or self.login or self.id

    @property
    def keys(self) -> tuple[str, ...]:
        """Everything by which this student can be meant, but for the group."""
        return tuple(each for each in (self.email, self.id, self.login, self.number, self.name) if each)


@dataclass(frozen=True, slots=True)
class RosterForm:
    """The form of one platform's export."""

    platform: str
    told_by: tuple[str, ...]
    """The column titles that only this form has, as ``_normalize_title`` writes them."""
    columns: Mapping[str, tuple[str, ...]]
    """Titles of the columns of each field of ``RosterEntry``; more than one are put together with a blank."""


FORMS: Final = (
    RosterForm(
        "moodle",
        ("identifier", "full name", "grade"),
        {
            "number": ("identifier",),
            "name": ("full name",),
            "id": ("id number",),
            "email": ("email address",),
            "group": ("group",),
        },
    ),
    RosterForm(
        "moodle",
        ("email address",),
        {
            "name": ("first name", "surname|last name"),
            "id": ("id number",),
            "email": ("email address",),
            "group": ("groups",),
        },
    ),
    RosterForm(
        "canvas",
        ("student", "id", "section"),
        {"name": ("student",), "number": ("id",), "id": ("sis user id",), "login": ("sis login id",)},
    ),
    RosterForm(
        "gradescope",
        ("sid",),
        {"name": ("first name|name|full name", "last name"), "id": ("sid",), "email": ("email",)},
    ),
    RosterForm(
        "github",
        ("identifier", "github username"),
        {"name": ("name",), "id": ("identifier",), "login": ("github username",)},
    ),
    RosterForm(
        "own",
        (),
        {each: (each,) for each in ("name", "email", "id", "login", "group")},
    ),
)
"""Every form, of which the first that fits is taken."""


@dataclass(frozen=True, slots=True)
class Roster:
    """The students of a class, and the file in which they stand."""

    platform: str
    """Whose format it is: moodle, canvas, gradescope, github or own."""
    titles: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    """Its rows as they stand in the file, with those that are no student's."""
    students: Mapping[int, RosterEntry]
    """By index of the row."""

    def find(self, key: str) -> tuple[RosterEntry, ...]:
        """Returns every student that a teacher may mean by a name, an e-mail address, an id, a login or a group."""
        return self.index.get(look(key), ())

    @property
    def index(self) -> Mapping[str, tuple[RosterEntry, ...]]:
        """The students by each of their keys."""
        found: dict[str, list[RosterEntry]] = {}
        for student in self.students.values():
            for key in {*map(look, student.keys), *([look(student.group)] if student.group else [])}:
                found.setdefault(key, []).append(student)
        return MappingProxyType({key: tuple(each) for key, each in found.items()})


def read_roster(file: Path) -> Roster:
    """Reads a roster. Raises ValueError, with the file and the line, and OSError."""
    lines = read_csv_file(file)
    if not lines:
        raise ValueError(f"{file}: it is empty; a roster begins with a line of column titles")
    titles = tuple(lines[0])
    columns = {_normalize_title(each): i for i, each in reversed([*enumerate(titles)])}
    form = next((each for each in FORMS if all(told in columns for told in each.told_by)), FORMS[-1])
    places = {
        name: [at for each in parts if (at := _column_index(each, columns)) is not None]
        for name, parts in form.columns.items()
    }
    if not any(places.values()):
        raise ValueError(
            f"{file}:1: none of the columns is known ({join_names(titles)}): a roster has name, email, id, login or group, "
            "or is an export of Moodle, Canvas, Gradescope or GitHub Classroom"
        )
    students = {}
    for number, row in enumerate(lines[1:]):
        fields = {
            name: " ".join(" ".join(row[at] for at in found if at < len(row)).split())
            for name, found in places.items()
        }
        student = RosterEntry(**_tidy(form.platform, fields))
        if student.keys and not _is_no_student(form.platform, student):
            students[number] = student
    if not students:
        raise ValueError(f"{file}: there is no student in it")
    return Roster(form.platform, titles, tuple(map(tuple, lines[1:])), MappingProxyType(students))


def _normalize_title(text: str) -> str:
    return " ".join(text.strip().casefold().replace("_", " ").split())


def _column_index(names: str, columns: Mapping[str, int]) -> int | None:
    """The index of a column that has one of these titles, separated by ``|``."""
    return next((columns[each] for each in names.split("|") if each in columns), None)


def _tidy(platform: str, fields: dict[str, str]) -> dict[str, str]:
    if platform == "canvas":
        last, comma, first = fields["name"].partition(", ")
        fields["name"] = f"{first} {last}" if comma else last
    if platform == "moodle":
        fields["number"] = fields.get("number", "").removeprefix("Participant ")
        fields["group"] = fields.get("group", "").strip()
    return fields


def _is_no_student(platform: str, student: RosterEntry) -> bool:
    """Whether this is a row of the platform's own: the most points, or its student for tests."""
    return platform == "canvas" and student.name.casefold() in ("points possible", "test student")


PLATFORM_NAMES: Final = MappingProxyType(
    {
        "moodle": re.compile(
            r"(?P<name>((?!_\d+_assignsubmission_).)+)_(?P<number>\d+)_assignsubmission_(file|onlinetext)"
            r"(_((?!_\d+_assignsubmission_).)*)?"
        ),
        "canvas": re.compile(r"(?P<name>[^_]+)_(LATE_)?(?P<number>\d+)_\d+_.+"),
        "gradescope": re.compile(r"submission_(?P<number>\d+)"),
    }
)
"""How platforms name works in their downloads. At the end may stand the name of the student's own file."""


def _repository_prefix(works: Sequence[str], index: Mapping[str, object]) -> str | None:
    """Returns what stands before the login in the names of GitHub Classroom's repositories, ASSIGNMENT-LOGIN; None if none
    is such.

    A login may hold hyphens, also so that it ends like another's. So it is what gives most works to students, and of those
    that give as many the shortest.
    """
    counts: Counter[str] = Counter()
    for work in works:
        parts = work.split("-")
        for first in range(1, len(parts)):
            if look("-".join(parts[first:])) in index:
                counts["-".join(parts[:first]) + "-"] += 1
    return min(counts, key=lambda prefix: (-counts[prefix], len(prefix), prefix), default=None)


@dataclass(frozen=True, slots=True)
class WorkOwners:
    """The student to whom each work of a class belongs."""

    students: Mapping[str, tuple[RosterEntry, ...]]
    """By the work's name: one student, or those of a group; empty where it fits nobody, or several."""
    ambiguous: Mapping[str, tuple[RosterEntry, ...]]
    """The works whose name fits more than one student, with these."""


def owners_of(works: Iterable[str], roster: Roster) -> WorkOwners:
    """Finds whose each work is, by its name: that of a file or folder, as platforms write them in their downloads."""
    works = tuple(works)
    index = roster.index
    prefix = _repository_prefix(works, index)
    groups = {look(each.group) for each in roster.students.values() if each.group}
    students: dict[str, tuple[RosterEntry, ...]] = {}
    ambiguous: dict[str, tuple[RosterEntry, ...]] = {}
    for work in works:
        key, found = next(
            ((key, index[key]) for key in _possible_names(work, roster.platform, prefix) if key in index),
            ("", ()),
        )
        if len(found) > 1 and key not in groups:
            ambiguous[work], found = found, ()
        students[work] = found
    return WorkOwners(students, ambiguous)


def _possible_names(work: str, platform: str, prefix: str | None) -> Iterator[str]:
    """Yields what the name of a work may mean, the surest first. ``prefix``: that of GitHub Classroom's repositories here.

    No part of it that a student has chosen may mean another student: what has the form of the roster's own platform is read
    so, and else only what one platform alone can have named.
    """
    yield look(work)
    matches = {
        name: match
        for name, pattern in PLATFORM_NAMES.items()
        if (match := pattern.fullmatch(work)) is not None
    }
    found = matches.get(platform) or (next(iter(matches.values())) if len(matches) == 1 else None)
    if found is not None:
        yield look(found["number"])
        if "name" in found.groupdict():
            yield look(found["name"])
    yield look(work.partition("@")[0])
    if prefix is not None and work.startswith(prefix):
        yield look(work.removeprefix(prefix))
    yield look(work.replace("_", " "))
    yield look(work.replace(".", " "))
