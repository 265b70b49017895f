"""Reads an assignment's folder into records; every mistake is reported with its file, line and column.

``assignment.yaml`` is public. ``secret.yaml``, beside it on the teacher's machine alone, holds further seeds. Other files
(worlds, ``starter.py``, ``solution.py``, ``wrong/``) are found by their names.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import Any, Final

from grader.assignment import (
    MAX_HINTS,
    Assignment,
    Criterion,
    KnownMistake,
    TeacherTest,
    Trial,
)
from grader.budgets import read_budget
from grader.check import Check
from grader.evidence_digest import ASSIGNMENT_FILE, evidence_digest, folder_digest
from grader.kinds.contract import AssignmentFiles, find_kind, kind_names
from grader.scoring import MAX_SHARE_STEPS, Anchors
from grader.seeds import SeedSet
from grader.teacher_tests.reading import read_teacher_tests
from kit.extensions import ExtensionError, admitting, installed_extensions
from kit.host.sandbox.sandbox_config import Level
from kit.plain_files import is_file_there
from kit.plain_text import quoted, suggestion
from kit.results.grading_result import Visibility
from kit.world.documents import AllowedRoot, WorldDocuments
from kit.world.problems import ProblemCollector
from kit.world.records import SourceLocation
from kit.world.yaml_section import Section

SECRET_FILE: Final = "secret.yaml"


def read_assignment(folder: Path) -> Assignment:
    """Reads the assignment in ``folder``. Raises WorldError with all its mistakes."""
    documents = WorldDocuments(AllowedRoot.of_folder(folder), {}, ProblemCollector())
    secret_file = folder / SECRET_FILE
    secrets = documents.section(secret_file, SourceLocation(secret_file)) if secret_file.is_file() else None
    with documents.open(folder / ASSIGNMENT_FILE) as section:
        packages = section.texts("packages", ())
        with admitting(packages):
            _check_packages(section, packages)
            kind = section.text("kind", "controller", choices=kind_names())
            documents.problems.raise_if_any()  # the meaning of the other keys depends on the kind
            try:
                return read_sheet(kind, section, secrets, folder, packages)
            except ExtensionError as error:
                section.error(str(error), "packages")
                raise documents.problems.error() from error


def _check_packages(section: Section, packages: tuple[str, ...]) -> None:
    """Notes each package that brings no parts, or is not installed on this machine."""
    known = sorted({each.package for each in installed_extensions()} if packages else ())
    for name in packages:
        if name not in known:
            section.error(
                f"every machine that grades needs the package {quoted(name)}, and none that is installed here and brings "
                f"parts of the kit has that name: {suggestion(name, known)}",
                "packages",
            )


def read_sheet(
    kind: str, section: Section, secrets: Section | None, folder: Path, packages: tuple[str, ...] = ()
) -> Assignment:
    """Reads the sheet of an assignment of this kind in ``folder``, and its secret file; notes their mistakes."""
    folder = folder.absolute()  # its own code runs in another folder than this process
    kind_record = find_kind(kind)
    teacher_test_files = tuple(_teacher_test_files(section, folder))
    task = kind_record.read_settings(AssignmentFiles(folder, section, secrets))
    limits, submission_limit_s = read_budget(section.section("budget", None), task.trials, kind_record.limits)
    if secrets is not None:
        secrets.finish()
    criteria = tuple(_read_criteria(section, kind_record.checks, task.trials))
    return Assignment(
        folder=folder,
        id=section.name("id", folder.resolve().name),
        title=section.name("title"),
        kind=kind,
        packages=packages,
        submit=_file_name(section, kind_record.endings),
        level=Level(section.integer("level", int(Level.FILTERED), minimum=0, maximum=max(Level))),
        limits=limits,
        submission_limit_s=submission_limit_s,
        trials=task.trials,
        criteria=criteria,
        task=task.task,
        version=folder_digest(folder, packages=packages),
        public_version=folder_digest(folder, ignored=(SECRET_FILE,), packages=packages),
        has_secrets=secrets is not None,
        evidence_version=evidence_digest(folder, [file.name for file in teacher_test_files], packages),
        secret_seeds=(*(seed for trial in task.trials for seed in trial.secret_seeds), *task.secret_seeds),
        teacher_tests=tuple(_teacher_tests(section, teacher_test_files, criteria)),
        teacher_test_files=teacher_test_files,
    )


def _teacher_test_files(section: Section, folder: Path) -> Iterator[Path]:
    """Yields the files with teacher tests."""
    for name in section.texts("tests", ()):
        if "/" in name or not name.startswith("test_") or not is_file_there(folder / name):
            section.error(f"{quoted(name)} must be a file test_*.py in this folder", "tests")
        else:
            yield folder / name


def _teacher_tests(
    section: Section, files: tuple[Path, ...], criteria: Sequence[Criterion]
) -> Iterator[TeacherTest]:
    known = {each.id: each.visibility for each in criteria}
    for file in files:
        try:
            found = tuple(read_teacher_tests(file))
        except (ValueError, OSError, SyntaxError) as error:
            section.error(str(error), "tests")
            continue
        for each in found:
            if each.id in known:
                section.error(f"two tests, or a test and a check, are called {quoted(each.id)}", "tests")
            visibility = each.visibility
            if each.after is not None and each.after not in known:
                section.error(
                    f"{file.name}: {each.id} comes after {quoted(each.after)}, which does not stand before it: "
                    f"{suggestion(each.after, known)}",
                    "tests",
                )
            elif each.after is not None and visibility is Visibility.VISIBLE:
                visibility = known[each.after]  # that it was not judged would say how the one before it went
            known[each.id] = visibility
            yield replace(each, visibility=visibility)


def _file_name(section: Section, endings: tuple[str, ...]) -> str:
    name = section.name("submit")
    if name and (not name.endswith(endings) or "/" in name or name.startswith(".")):
        section.error(
            f"{quoted('submit')} must be the plain name of a file that ends with {' or '.join(endings)}",
            "submit",
        )
    return name


def _read_criteria(
    section: Section, checks: Mapping[str, Check], trials: tuple[Trial, ...]
) -> Iterator[Criterion]:
    known: list[str] = []
    visibilities: dict[str, Visibility] = {}
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
        if len(hints) > MAX_HINTS:
            each.error(f"at most {MAX_HINTS} hints, from where to look to nearly how", "hints")
        on = each.texts("on", tuple(trial.name for trial in trials))
        for trial in on:
            if trial not in {known_trial.name for known_trial in trials}:
                each.error(f"no trial {quoted(trial)}: {suggestion(trial, [t.name for t in trials])}", "on")
        visibility = each.choice(
            "visibility", {one.value: one for one in Visibility}, Visibility.VISIBLE.value
        )
        if after is not None and visibility is Visibility.VISIBLE:
            # That it was not judged would say how the one before it went.
            visibility = visibilities.get(after, visibility)
        visibilities[identity] = visibility
        anchors, share_steps = _read_anchors(each, check)
        parsed = Criterion(
            id=identity,
            title=each.name("title", identity),
            check=name,
            points=each.number("points", minimum=0, maximum=1e6),
            anchors=anchors,
            params=_read_params(each.section("with", None), check),
            trials=on,
            seeds=each.choice("seeds", {one.value: one for one in SeedSet}, SeedSet.ALL.value),
            need=each.number("need", above=0, maximum=1) if each.has("need") else None,
            after=after,
            visibility=visibility,
            hints=hints,
            feedback=check.feedback,
            share_steps=share_steps,
            # A hint says whether it passed, so a student must see that when the hint is seen.
            mistakes=tuple(
                _read_mistakes(
                    each,
                    [one for one in known[:-1] if visibilities[one] in (Visibility.VISIBLE, visibility)],
                )
            ),
        )
        each.finish()
        yield parsed


def _read_mistakes(section: Section, earlier: Sequence[str]) -> Iterator[KnownMistake]:
    """Yields the mistakes that a criterion knows: ``{when: TEXT, from: 0, to: 1, passed: ID, hint: TEXT}``, each but the
    hint optional."""
    for each in section.sections("mistakes", ()):
        hint = each.text("hint")
        parsed = KnownMistake(
            hint,
            when=each.text("when", ""),
            low=each.number("from", -math.inf) if each.has("from") else -math.inf,
            high=each.number("to", math.inf) if each.has("to") else math.inf,
            passed=each.text("passed", choices=earlier) if each.has("passed") else None,
        )
        if parsed == KnownMistake(hint):
            each.error("give a condition for the mistake: when, from, to or passed")
        each.finish()
        yield parsed


def _read_anchors(section: Section, check: Check) -> tuple[Anchors, int | None]:
    """Reads what earns nothing and everything, and the steps in which points are paid; None where none are stated."""
    given = section.section("share", None)
    if given is None:
        return check.anchors, None
    anchors = Anchors(given.number("none", check.anchors.none), given.number("full", check.anchors.full))
    steps = given.integer("steps", minimum=1, maximum=MAX_SHARE_STEPS) if given.has("steps") else None
    given.finish()
    return anchors, steps


def _read_params(section: Section | None, check: Check) -> Any:
    """Reads the check's params record, whose fields declare names, types and defaults."""
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
