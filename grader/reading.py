"""An assignment's folder becomes records. Every mistake is told with its file, line and column.

``assignment.yaml`` is what everybody may see. ``secret.yaml``, beside it on the teacher's machine alone, holds
further seeds. Whatever else lies there (worlds, ``starter.py``, ``solution.py``, ``wrong/``) is found by its name.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, replace
from importlib import import_module
from pathlib import Path
from typing import Any, Final

from grader.assignment import HINT_STEPS, Assignment, Criterion, GridTask, Kind, Seeds, Shift, Trial
from grader.checks.contract import Check
from grader.result import Visibility
from grader.scoring import Anchors
from kit.geometry import Pose
from kit.host.confine import Level
from kit.host.limits import GRADER, MIB, Limits
from kit.places import Place as Where
from kit.places import find_place
from kit.sim.telling import SERVICES
from kit.world.catalogue import Case
from kit.world.documents import Documents
from kit.world.files import Enclosure
from kit.world.problems import Problems, WorldError, quoted, suggestion
from kit.world.records import Place
from kit.world.section import Section

SHEET: Final = "assignment.yaml"
SECRET: Final = "secret.yaml"
LONGEST_EPISODE: Final = 3600.0
"""s"""
LARGEST_PLAN: Final = 40
"""Rows and columns of a grid."""


TABLES: Final[Mapping[Kind, str]] = {
    Kind.CONTROLLER: "grader.checks.drives",
    Kind.REWARD: "grader.checks.rewards",
}
"""The module that holds the table of checks, by what is handed in; imported only when needed."""


def checks_for(kind: Kind) -> Mapping[str, Check]:
    """The table of checks for what is handed in."""
    checks: Mapping[str, Check] = import_module(TABLES[kind]).CHECKS
    return checks


def read(folder: Path) -> Assignment:
    """The assignment in ``folder``. Raises WorldError with all its mistakes."""
    problems = Problems()
    sheet = folder / SHEET
    documents = Documents(Enclosure.of(folder), {}, problems)
    section = documents.section(sheet, Place(sheet))
    secret_file = folder / SECRET
    secrets = documents.section(secret_file, Place(secret_file)) if secret_file.is_file() else None
    problems.raise_if_any()
    assert section is not None  # None is noted as a problem
    made = _assignment(section, secrets, folder)
    problems.raise_if_any()
    return made


def digest(folder: Path) -> str:
    """What everything in the folder that grading depends on says, in short."""
    made = hashlib.sha256()
    for file in sorted(path for path in folder.rglob("*") if path.is_file()):
        name = file.relative_to(folder)
        if name.parts[0] in NOT_GRADING or any(part.startswith((".", "__")) for part in name.parts):
            continue
        made.update(repr((name.as_posix(), file.stat().st_size)).encode())
        made.update(file.read_bytes())
    return made.hexdigest()[:16]


NOT_GRADING: Final = ("README.md", "starter.py", "solution.py", "wrong")
"""What may change without making another assignment of it."""


def _assignment(section: Section, secrets: Section | None, folder: Path) -> Assignment:
    kind = section.choice("kind", {each.value: each for each in Kind}, Kind.CONTROLLER.value)
    trials = tuple(_trials(section, secrets, folder)) if kind is Kind.CONTROLLER else ()
    made = Assignment(
        folder=folder,
        id=section.name("id", folder.resolve().name),
        title=section.name("title"),
        kind=kind,
        submit=_file_name(section),
        level=Level(section.integer("level", int(Level.FILTERED), minimum=0, maximum=max(Level))),
        limits=_limits(section.section("budget", None)),
        trials=trials,
        criteria=tuple(_criteria(section, checks_for(kind), trials)),
        grid=_grid(section.section("grid")) if kind is Kind.REWARD else None,
        version=digest(folder),
        has_secrets=secrets is not None,
    )
    section.finish()
    if secrets is not None:
        secrets.finish()
    return made


def _file_name(section: Section) -> str:
    name = section.name("submit")
    if name and (not name.endswith(".py") or "/" in name or name.startswith(".")):
        section.error(f"{quoted('submit')} must be the plain name of a Python file", "submit")
    return name


def _limits(section: Section | None) -> Limits:
    if section is None:
        return GRADER
    made = replace(
        GRADER,
        start_s=section.number("start", GRADER.start_s, above=0, maximum=120),
        reply_s=section.number("reply", GRADER.reply_s, above=0, maximum=60),
        total_s=section.number("total", GRADER.total_s or 120.0, above=0, maximum=3600),
        cpu_s=section.integer("cpu", GRADER.cpu_s or 60, minimum=1, maximum=3600),
        memory=MIB * section.integer("memory", GRADER.memory // MIB, minimum=256, maximum=64 * 1024),
    )
    section.finish()
    return made


def _trials(section: Section, secrets: Section | None, folder: Path) -> Iterator[Trial]:
    seen: set[str] = set()
    hidden = None if secrets is None else secrets.section("seeds")
    for each in section.sections("trials", at_least=1):
        name = each.name("name")
        if name in seen:
            each.error(f"a trial named {quoted(name)} already exists", "name")
        seen.add(name)
        place = _place(each, folder)
        time_s = each.number("time", 60.0, above=0, maximum=LONGEST_EPISODE)
        seeds = _seeds(each, "seeds", (1, 2, 3))
        shift = Shift(*each.numbers("shift", (0.0, 0.0, 0.0), length=3))
        noise = each.number("noise", minimum=0, maximum=10) if each.has("noise") else None
        until = each.flag("until_reached", True)
        services = each.texts("services", ("move_model",))
        for service in services:
            if service not in SERVICES:
                each.error(
                    f"no service {quoted(service)}: {suggestion(service, tuple(SERVICES))}", "services"
                )
        each.finish()
        secret_seeds = _seeds(hidden, name, ()) if hidden is not None and name else ()
        if place is not None:
            yield Trial(name, place, time_s, seeds, secret_seeds, shift, noise, until, frozenset(services))
    if hidden is not None:
        hidden.finish()


def _seeds(section: Section, key: str, default: tuple[int, ...]) -> tuple[int, ...]:
    numbers = section.numbers(key, default)
    if any(number != int(number) or number < 0 for number in numbers):
        section.error(f"{quoted(key)} must be whole numbers from 0 on", key)
        return default
    seeds = tuple(map(int, numbers))
    if len(set(seeds)) < len(seeds):
        section.error(f"{quoted(key)} names a seed twice", key)
    return seeds


def _place(section: Section, folder: Path) -> Where | None:
    name = section.name("place")
    case = section.name("case") if section.has("case") else None
    target = section.point("target") if section.has("target") else None
    radius = section.number("target_radius", 0.2, above=0)
    if not name:
        return None
    try:
        inside = (folder / name).resolve()
        is_ours = inside.exists() and inside.is_relative_to(folder.resolve())
        place = find_place(str(folder / name) if is_ours else name, case, folder if is_ours else None)
    except (LookupError, WorldError, OSError) as error:
        section.error(str(error), "place")
        return None
    if target is None:
        return place
    start = place.start or Pose()
    made = Case(section.name("name"), start, target, radius, (0.0, 0.0), (0.0, 0.0), False, "", None)
    return replace(place, case=made)


def _criteria(
    section: Section, checks: Mapping[str, Check], trials: tuple[Trial, ...]
) -> Iterator[Criterion]:
    known: list[str] = []
    for each in section.sections("checks", at_least=1):
        name = each.text("check", choices=checks)
        if name not in checks:
            continue
        check = checks[name]
        identity = each.name("id", name)
        if identity in known:
            each.error(
                f"a check with the id {quoted(identity)} already exists", "id" if each.has("id") else None
            )
        after = each.text("after", choices=known or ("none so far",)) if each.has("after") else None
        known.append(identity)
        hints = each.texts("hints", ())
        if len(hints) > HINT_STEPS:
            each.error(f"at most {HINT_STEPS} hints, from where to look to nearly how", "hints")
        on = each.texts("on", tuple(trial.name for trial in trials))
        for trial in on:
            if trial not in {known_trial.name for known_trial in trials}:
                each.error(f"no trial {quoted(trial)}: {suggestion(trial, [t.name for t in trials])}", "on")
        made = Criterion(
            id=identity,
            title=each.name("title", identity),
            check=name,
            points=each.number("points", minimum=0, maximum=1e6),
            anchors=_anchors(each, check),
            params=_params(each.section("with", None), check),
            trials=on,
            seeds=each.choice("seeds", {one.value: one for one in Seeds}, Seeds.ALL.value),
            need=each.number("need", above=0, maximum=1) if each.has("need") else None,
            after=after,
            visibility=each.choice(
                "visibility", {one.value: one for one in Visibility}, Visibility.VISIBLE.value
            ),
            hints=hints,
            feedback=check.feedback,
        )
        each.finish()
        yield made


def _anchors(section: Section, check: Check) -> Anchors:
    given = section.section("share", None)
    if given is None:
        return check.anchors
    made = Anchors(given.number("none", check.anchors.none), given.number("full", check.anchors.full))
    given.finish()
    return made


def _params(section: Section | None, check: Check) -> Any:
    """The check's own record, from the fields it declares."""
    if section is None:
        return check.params()
    getters: Mapping[type, Callable[..., Any]] = {
        float: section.number,
        int: section.integer,
        str: section.text,
        tuple: section.texts,
    }
    values = {
        field.name: getters[type(field.default)](field.name, field.default) for field in fields(check.params)
    }
    section.finish()
    return check.params(**values)


def _grid(section: Section) -> GridTask:
    rows = tuple(line.rstrip() for line in section.text("map").splitlines() if line.strip())
    made = GridTask(
        rows,
        section.number("discount", 0.98, above=0, maximum=0.999),
        section.integer("max_steps", 200, minimum=1, maximum=10_000),
    )
    section.finish()
    if not rows or len({len(row) for row in rows}) != 1 or max(len(rows), len(rows[0])) > LARGEST_PLAN:
        section.error(
            f"{quoted('map')} must be rows of equal length, at most {LARGEST_PLAN} by {LARGEST_PLAN}", "map"
        )
    elif set("".join(rows)) - set("#.G") or "".join(rows).count("G") != 1:
        section.error(
            f"{quoted('map')} is drawn with # for a wall, . for floor and exactly one G, the target", "map"
        )
    elif any(row[0] + row[-1] != "##" for row in rows) or set(rows[0] + rows[-1]) != {"#"}:
        section.error(f"{quoted('map')} must have walls all around", "map")
    return made
