"""How many points lateness costs: due times, extensions of single students, days that cost nothing.

A day ends when 24 hours are over, or at the same time on the next day, whichever is later: when the clocks change in between,
nobody loses by that.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta, tzinfo
from pathlib import Path
from types import MappingProxyType
from typing import Final
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError

from grader.look_alikes import look
from kit.plain_text import counted, quoted
from kit.world.documents import open_document
from kit.world.yaml_section import Section

EXAMPLE: Final = "2026-11-30T23:59:00+01:00"
MAX_DAYS: Final = 3650
"""Days of an extension, of a grace, and of lateness that is counted."""
YEARS: Final = range(1970, 3000)
"""Years of a time: ``MAX_DAYS`` before or after them are still in the calendar, in every zone."""


@dataclass(frozen=True, slots=True)
class DueDateExtension:
    """More time for one student."""

    until: datetime | None = None
    """A due time of its own; None for that of all."""
    days: int = 0
    """Calendar days after it."""


@dataclass(frozen=True, slots=True)
class Lateness:
    """How late one submission is, and which share of its points it keeps."""

    kept: float = 1.0
    days: int = 0
    """Days begun after the time that was due for this student; 0 if it was in time."""
    late_s: float = 0.0
    """s after that time; 0 if it was in time."""
    free_days: int = 0
    """How many of the days cost nothing."""
    is_extended: bool = False
    """Whether the student had an extension."""

    def text(self) -> str:
        """How late it is and what that costs, for the student; empty if it was in time by the due time of all."""
        if not self.days:
            return "In time by an extension." if self.is_extended else ""
        whole, rest = divmod(self.late_s, 3600)
        days, hours = divmod(int(whole), 24)
        parts = (
            [counted(days, "day")] * bool(days) + [f"{hours} h"] * bool(hours) + [f"{int(rest // 60)} min"]
        )
        late = " ".join(parts[:2])
        because = " after your extension" if self.is_extended else ""
        if self.kept >= 1.0:
            return f"Late by {late}{because}, within the {counted(self.free_days, 'day')} that cost nothing."
        free = f", {counted(self.free_days, 'day')} of them for nothing" if self.free_days else ""
        return f"Late by {late}{because} ({counted(self.days, 'day')} begun{free}): {self.kept:.0%} of the points are kept."


@dataclass(frozen=True, slots=True)
class LatePolicy:
    """How many points lateness costs."""

    due: datetime
    grace_s: float = 0.0
    per_day: float = 0.1
    """Share of the points lost for each day begun."""
    least: float = 0.0
    """Share that is always kept, until ``latest_days``."""
    latest_days: float | None = None
    """Days after which nothing counts; None for no such limit."""
    zone: tzinfo | None = None
    """In which times are read that name none, and by whose clocks days are counted."""
    grace_days: int = 0
    """Days that cost nothing."""
    extensions: Mapping[str, DueDateExtension] = field(default_factory=dict)
    """By student: name, e-mail address, id or login."""
    locations: Mapping[str, str] = field(default_factory=dict)
    """Where each extension stands, for messages."""

    @property
    def due_text(self) -> str:
        """How the due date was read."""
        zone = "" if self.zone is None else f" {self.zone}"
        return f"due {self.due.isoformat(sep=' ')}{zone}"

    def lateness(self, submitted: datetime, extension: DueDateExtension | None = None) -> Lateness:
        """Returns how late a submission is, and what it keeps."""
        due = self.due if extension is None or extension.until is None else extension.until
        if self.zone is not None:
            due = due.astimezone(self.zone)
        due += timedelta(days=0 if extension is None else extension.days)
        # In one zone Python subtracts what clocks show, and they skip or repeat an hour twice a year.
        late_s = (submitted.astimezone(UTC) - due.astimezone(UTC)).total_seconds()
        if late_s <= self.grace_s:
            return Lateness(is_extended=extension is not None)
        begun, at = due + timedelta(seconds=self.grace_s), submitted.astimezone(UTC)
        days = next((count for count in range(1, MAX_DAYS) if _day_end(begun, count) >= at), MAX_DAYS)
        free = min(days, self.grace_days)
        kept = 1.0 if days == free else max(self.least, 1.0 - self.per_day * (days - free), 0.0)
        if self.latest_days is not None and at > _day_end(begun, self.latest_days):
            kept = 0.0
        return Lateness(kept, days, late_s, free, extension is not None)

    def extension_of(self, names: Iterable[str]) -> DueDateExtension | None:
        """Returns the extension of a student who is called by one of these names; None if there is none."""
        known = {look(each): extension for each, extension in self.extensions.items()}
        return next((known[key] for each in names if (key := look(each)) in known), None)

    def kept_share(self, submitted: datetime) -> float:
        """Returns the share of its points that a submission keeps, of a student without an extension."""
        return self.lateness(submitted).kept


def _day_end(begun: datetime, days: float) -> datetime:
    """The end of this many days [UTC]: by the calendar or by hours, whichever is later."""
    by_calendar = (begun + timedelta(days=days)).astimezone(UTC)
    return max(by_calendar, begun.astimezone(UTC) + timedelta(days=days))


def read_policy(file: Path) -> LatePolicy:
    """Reads ``due``, ``zone``, ``grace_minutes``, ``grace_days``, ``per_day``, ``least``, ``latest_days`` and ``extensions``
    from a YAML file.

    ``due`` is a time with its offset, or in ``zone``; a date alone means the end of that day. An extension is such a time,
    or ``{days: N}``, by the student's e-mail address, id, login or name. Raises WorldError.
    """
    with open_document(file) as section:
        zone = None
        if section.has("zone"):
            zone = find_zone(section.name("zone"))
            if zone is None:
                section.error("must be a time zone such as Europe/Lisbon, or UTC", "zone")
        due = _read_due(section, "due", zone)
        extensions: dict[str, DueDateExtension] = {}
        locations: dict[str, str] = {}
        given = section.section("extensions", None)
        if given is not None:
            for student in given.keys():  # noqa: SIM118  # a section is no mapping
                extensions[student] = _read_extension(given, student, zone)
                locations[student] = str(given.location_of(student))
        return LatePolicy(
            due or datetime.now(UTC),
            60 * section.number("grace_minutes", 0.0, minimum=0, maximum=MAX_DAYS * 24 * 60),
            section.number("per_day", 0.1, minimum=0, maximum=1),
            section.number("least", 0.0, minimum=0, maximum=1),
            section.number("latest_days", minimum=0, maximum=MAX_DAYS)
            if section.has("latest_days")
            else None,
            zone,
            section.integer("grace_days", 0, minimum=0, maximum=MAX_DAYS),
            MappingProxyType(extensions),
            MappingProxyType(locations),
        )


def _read_due(section: Section, key: str, zone: tzinfo | None) -> datetime | None:
    try:
        return parse_time(section.name(key), zone, whole_day=True)
    except ValueError as problem:
        section.error(str(problem), key)
        return None


def _read_extension(section: Section, student: str, zone: tzinfo | None) -> DueDateExtension:
    if not section.is_mapping(student):
        return DueDateExtension(_read_due(section, student, zone))
    given = section.section(student)
    until = _read_due(given, "until", zone) if given.has("until") else None
    days = given.integer("days", 0, minimum=0, maximum=MAX_DAYS)
    if until is None and not days:
        given.error(f"the extension of {quoted(student)} needs `until` or `days`")
    given.finish()
    return DueDateExtension(until, days)


def find_zone(name: str) -> tzinfo | None:
    """The time zone of a name of the IANA's; None for a name of none, or one that this machine does not know."""
    if name == "UTC":
        return UTC
    try:
        return ZoneInfo(name)
    except (ZoneInfoNotFoundError, ValueError, OSError):
        return None


def parse_time(text: str, zone: tzinfo | None = None, *, whole_day: bool = False) -> datetime:
    """Parses a date and time with its offset, or in ``zone``. ``whole_day``: a date alone is the end of that day.

    Raises ValueError for anything else, also for a time that can be read in two ways: in no zone, of a day alone, or in
    the hour that clocks skip or repeat; and for a year that is none of ``YEARS``. The message begins with a verb.
    """
    text = text.strip()
    at = _moodle_time(text)
    if at is None:
        try:
            at = datetime.fromisoformat(text)
        except ValueError:
            raise ValueError(f"must be a date and time such as {EXAMPLE}") from None
    if at.year not in YEARS:
        raise ValueError(f"must be in the years {YEARS.start} to {YEARS.stop - 1}")
    is_day = ":" not in text and "T" not in text.upper()
    if is_day and not whole_day:
        raise ValueError(f"names a day and no time ({text}): write when, such as {EXAMPLE}")
    if is_day:
        at = at.replace(hour=23, minute=59, second=59)
    if at.tzinfo is not None:
        return at
    if zone is None:
        raise ValueError(
            f"names no time zone ({text}): write it, such as {at.isoformat()}+01:00 or {at.isoformat()}Z, "
            "or give the late rules a zone, such as `zone: Europe/Lisbon`"
        )
    first, second = (at.replace(tzinfo=zone, fold=fold) for fold in (0, 1))
    if first.utcoffset() != second.utcoffset():
        kind = "twice" if first.utcoffset() > second.utcoffset() else "never"  # type: ignore[operator]  # both have one
        raise ValueError(f"comes {kind} in {zone} on that day ({text}): write its offset, such as {EXAMPLE}")
    return first


MOODLE_TIMES: Final = ("%A, %d %B %Y, %I:%M %p", "%A, %B %d, %Y, %I:%M %p")
"""How Moodle writes a time in its worksheets, in English, British and American; in other languages it is not read."""


def _moodle_time(text: str) -> datetime | None:
    for form in MOODLE_TIMES:
        try:
            return datetime.strptime(text, form)  # its zone is the site's, which the worksheet does not say
        except ValueError:
            continue
    return None
