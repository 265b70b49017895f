"""A Python file with functions, called in a process of its own and compared with the teacher's.

``reference.py`` in the assignment's folder, which is the teacher's and runs apart from the grader (``grader.author_code``), has
each function as it should be, and beside it the cases it is called with::

    def nearest(ranges): ...

    def nearest_cases(chance):              # a random.Random, seeded by the assignment
        yield {"ranges": [0.5, 0.3]}        # each a dictionary of arguments, plain data
        for _ in range(20):
            yield {"ranges": [chance.uniform(0.1, 2.0) for _ in range(91)]}

The assignment names the functions; ``secret.yaml`` may set another seed::

    functions:
      - {name: nearest, within: 0.001}
    seed: 1
"""

from __future__ import annotations

import ast
import importlib.util
import math
import random
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from functools import partial
from itertools import islice
from pathlib import Path
from types import ModuleType
from typing import Any, Final, Self

from grader.assignment import MAX_COUNTERPARTS, Assignment, Criterion
from grader.author_code import UNINTELLIGIBLE, AuthorCodeError, run_author_code
from grader.check import check
from grader.evidence.contract import (
    CachingCollector,
    Evidence,
    EvidenceCollector,
    EvidenceOptions,
    EvidenceRecord,
)
from grader.kinds.contract import AssignmentFiles, KindSettings, SubmissionKind
from grader.kinds.function.sheet_keys import SHEET_KEYS
from grader.seeds import SeedSet, counterpart_seed, read_seed
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.sandbox.limits import GRADER_LIMITS
from kit.host.student_functions import StudentFunctions
from kit.host.wire import Json, printable
from kit.plain_text import counted, quoted, suggestion
from kit.world.yaml_section import Section

REFERENCE: Final = "reference.py"
CASES_SUFFIX: Final = "_cases"
"""Suffix of the function that makes a function's cases."""
MAX_CASES: Final = 500
REFERENCE_LIMIT_S: Final = 60.0
"""Wall clock of the reference for all cases of a submission."""
CALL_LIMITS: Final = replace(GRADER_LIMITS, reply_s=2.0)
"""A call gets plain data and computes from it: what takes longer has no end, most likely."""
CALL_FAILURES: Final = (FailureKind.EXCEPTION, FailureKind.TIMEOUT)
"""Ends of a call that its arguments may explain."""
MAX_SHOWN: Final = 9
"""The most entries of a list that feedback shows."""


@dataclass(frozen=True, slots=True)
class FunctionSpec:
    """One function that the student is to write."""

    name: str
    within: float
    """Tolerance for numbers, absolute and relative."""


@dataclass(frozen=True, slots=True)
class FunctionsTask:
    """The functions to write and the reference they are compared with."""

    functions: tuple[FunctionSpec, ...]
    reference: Path
    seed: int
    secret_seed: int | None


@dataclass(frozen=True, slots=True)
class CaseDifference:
    """A case in which the student's function returns something other than the reference."""

    arguments: Mapping[str, Json]
    expected: Json
    actual: Json

    def __str__(self) -> str:
        difference = _first_difference(self.expected, self.actual)
        end = "" if difference.endswith("?") else "."
        return f"should be {format_value(self.expected)}, and is {format_value(self.actual)}{difference}{end}"


@dataclass(frozen=True, slots=True)
class FunctionComparison:
    """How a student's function did on its cases."""

    name: str
    cases: int
    differences: tuple[CaseDifference, ...]
    prints: bool = False
    """Whether it printed anything."""

    def explain_first(self) -> str:
        """Returns feedback on the first case that differs; empty if none does."""
        if not self.differences:
            return ""
        difference = self.differences[0]
        arguments = ", ".join(f"{name}={format_value(value)}" for name, value in difference.arguments.items())
        if difference.actual is None and difference.expected is not None:
            why = (
                "It prints: print only shows a value, return gives it to the caller."
                if self.prints
                else "Does every path through it end with a return? append(), sort() and reverse() return nothing themselves."
            )
            return f"{self.name}({arguments}) returns nothing. {why}"
        return f"{self.name}({arguments}) {difference}"


@dataclass(frozen=True, slots=True)
class FunctionParams:
    """The function that a criterion is about."""

    function: str = ""
    """May be left out if there is only one."""


@check(none=0.5, full=1, unit="%", params=FunctionParams)
def agrees(evidence: EvidenceRecord, params: FunctionParams) -> float:
    """It returns what it should in {actual} of the cases."""
    comparison: FunctionComparison = evidence.content
    return 1.0 - len(comparison.differences) / comparison.cases


def read_settings(files: AssignmentFiles) -> KindSettings:
    """Reads the functions, and checks that the reference has them."""
    file = files.folder / REFERENCE
    spec = tuple(_function_specs(files.public))
    seed = read_seed(files.public, 1)
    secret = None if files.secret is None else read_seed(files.secret)
    secret_seeds = () if secret is None else (secret,)
    try:
        defined = _names_in(file)
    except (OSError, ValueError, SyntaxError) as error:
        files.public.error(f"{REFERENCE}, which has the functions as they should be, cannot be read: {error}")
        return KindSettings(task=FunctionsTask(spec, file, seed, secret), secret_seeds=secret_seeds)
    for each in spec:
        for name in (each.name, each.name + CASES_SUFFIX):
            if name not in defined:
                files.public.error(f"{REFERENCE} has no function {name}()", "functions")
    return KindSettings(task=FunctionsTask(spec, file, seed, secret), secret_seeds=secret_seeds)


def _function_specs(section: Section) -> Iterator[FunctionSpec]:
    names: set[str] = set()
    for each in section.sections("functions", at_least=1):
        spec = FunctionSpec(each.name("name"), each.number("within", 1e-6, minimum=0))
        each.finish()
        if not spec.name.isidentifier() or spec.name.startswith("_"):
            each.error(f"{quoted('name')} must be a function's name", "name")
        elif spec.name in names:
            each.error(f"a function named {quoted(spec.name)} is already required", "name")
        else:
            yield spec
        names.add(spec.name)


def _names_in(file: Path) -> frozenset[str]:
    """Returns the names of the functions that a Python file defines or imports, without running it. Raises OSError,
    ValueError and SyntaxError."""
    names: set[str] = set()
    for node in ast.parse(file.read_bytes(), file.name).body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            names.add(node.name)
        elif isinstance(node, (ast.Import, ast.ImportFrom)):
            names |= {each.asname or each.name for each in node.names}
        elif isinstance(node, ast.Assign):
            names |= {each.id for each in node.targets if isinstance(each, ast.Name)}
    return frozenset(names)


def load_reference(file: Path) -> ModuleType:
    """Imports the teacher's reference as a new module each time. Raises what it raises."""
    spec = importlib.util.spec_from_file_location(f"reference_of_{file.parent.name}", file)
    assert spec is not None  # the name ends in .py
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def cases_of(module: ModuleType, name: str, seed: int) -> Sequence[Mapping[str, Json]]:
    """Returns the cases of a function for this seed, each a dictionary of arguments; of more than ``MAX_CASES`` the first."""
    make: Callable[[random.Random], Iterator[Mapping[str, Json]]] = getattr(module, name + CASES_SUFFIX)
    return list(islice(make(random.Random(f"{name} {seed}")), MAX_CASES))


def answer_cases(file: Path, wanted: Sequence[tuple[str, int]]) -> list[Json]:
    """Returns for each function and seed a list of cases, each with the reference's answer; or why there is none."""
    module = load_reference(file)
    return [_answers_of(module, name, seed) for name, seed in wanted]


def _answers_of(module: ModuleType, name: str, seed: int) -> Json:
    try:
        right = getattr(module, name)
        return [[case, _as_json(right(**case))] for case in cases_of(module, name, seed)]
    except Exception:  # noqa: BLE001  # an error in one function costs no other
        return traceback.format_exc()


class FunctionCollector(CachingCollector):
    """Calls each function when a criterion first needs it: all of them in one process with the public cases, then in another
    with the secret ones. After a failure the next function gets a new one, so that an error in one costs no other; in a
    student's own check the one that failed is not called with secret cases, nor anywhere one that took too long with the
    public ones."""

    stops_after_timeouts = False

    def __init__(self, assignment: Assignment, file: Path, options: EvidenceOptions) -> None:
        super().__init__(options)
        self._task: FunctionsTask = assignment.task
        self._assignment = assignment
        self._file = file
        self._stops_at_death = options.stops_at_death
        self._secret = options.secret and self._task.secret_seed is not None
        self._known: dict[tuple[str, int], Json] = {}
        """By function and seed: each case with the right answer, or why there are none."""
        self._functions: StudentFunctions | None = None
        self._calls_secret = False
        """Whether the open process is called with secret cases."""
        self._not_loaded: Failure | None = None
        """Why the file cannot be loaded: then it is not tried again."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._close()

    def _close(self) -> None:
        if self._functions is not None:
            self._functions.close()
            self._functions = None

    def _open(self, *, secret: bool) -> StudentFunctions:
        """Returns the process to call. One that was called with public cases has ended before a secret one starts. Raises
        StudentCodeError."""
        if self._not_loaded is not None:
            raise StudentCodeError(self._not_loaded)
        if self._calls_secret is not secret:
            self._close()
        if self._functions is None:
            limits = self._clock.shorten(self._assignment.limits)
            try:
                self._functions = StudentFunctions(self._file, limits=limits, level=self.level)
            except StudentCodeError as error:
                if error.failure.kind in (FailureKind.SYNTAX, FailureKind.IMPORT):
                    self._not_loaded = error.failure
                raise
            self._calls_secret = secret
        return self._functions

    def evidence(self, criterion: Criterion) -> Sequence[Evidence]:
        name = self._function(criterion.params.function)
        hidden = {SeedSet.PUBLIC: (False,), SeedSet.SECRET: (True,), SeedSet.ALL: (False, True)}[
            criterion.seeds
        ]
        return [self._record(name, secret) for secret in hidden if self._secret or not secret]

    def public_evidence(self, criterion: Criterion) -> Sequence[Evidence]:
        name = self._function(criterion.params.function)
        return [] if criterion.seeds is SeedSet.SECRET else [self._record(name, False)]

    def counterparts(self, criterion: Criterion) -> Iterator[Evidence]:
        spec = self._function(criterion.params.function)
        label = f"{spec.name}()"
        return self._collect_counterparts(
            ((spec.name, seed), label, partial(self._compare, spec, seed, EvidenceRecord(label=label)))
            for seed in map(counterpart_seed, range(MAX_COUNTERPARTS))
        )

    def _function(self, name: str) -> FunctionSpec:
        known = {each.name: each for each in self._task.functions}
        if not name and len(known) == 1:
            return self._task.functions[0]
        if name not in known:
            raise LookupError(f"no function {quoted(name)}: {suggestion(name, known)}")
        return known[name]

    def _record(self, spec: FunctionSpec, secret: bool) -> Evidence:
        label = f"{spec.name}()" + (" on secret cases" if secret else "")
        seed = self._task.secret_seed if secret else self._task.seed
        assert seed is not None  # without one, no secret evidence is collected
        key = (spec.name, secret)
        failure = self._record(spec, False).failure if secret else None
        if failure is not None and (self._stops_at_death or failure.kind is FailureKind.TIMEOUT):
            return self._skip(key, failure, label, secret=True)
        run = partial(self._compare, spec, seed, EvidenceRecord(label=label, secret=secret))
        return self._collect(key, run, label, secret=secret)

    def _cases(self, name: str, seed: int) -> Sequence[tuple[Mapping[str, Json], Json]]:
        """Returns the cases of a function for this seed, each with the right answer. Raises AuthorCodeError."""
        if (name, seed) not in self._known:
            wanted = {(name, seed)}
            if not self._known:  # all that is sure to be needed, at once
                seeds = [self._task.seed]
                if self._secret and self._task.secret_seed is not None:
                    seeds.append(self._task.secret_seed)
                wanted |= {(each.name, one) for each in self._task.functions for one in seeds}
            ordered = sorted(wanted)
            file = self._task.reference
            answers = run_author_code(
                lambda: answer_cases(file, ordered), file.parent, self.level, REFERENCE_LIMIT_S
            )
            try:
                self._known.update(zip(ordered, answers, strict=True))
            except (TypeError, ValueError):
                raise AuthorCodeError(UNINTELLIGIBLE) from None
        known = self._known[name, seed]
        if isinstance(known, str):
            raise AuthorCodeError(known)
        try:
            return [(dict(case), answer) for case, answer in known]
        except (TypeError, ValueError):
            raise AuthorCodeError(UNINTELLIGIBLE) from None

    def _compare(self, spec: FunctionSpec, seed: int, blank: EvidenceRecord) -> EvidenceRecord:
        """Calls the function with the cases of a seed. ``blank``: what the record is called."""
        cases = self._cases(spec.name, seed)
        differences = []
        clock = self._clock
        case: Mapping[str, Json] | None = None
        try:
            functions = self._open(secret=blank.secret)
            for case, expected in cases:
                clock.check()
                actual = functions.call_json(spec.name, case)
                if not is_close(expected, actual, spec.within):
                    differences.append(CaseDifference(case, expected, actual))
            printed = tuple(printable(line.text) for line in functions.take_output().lines)
        except StudentCodeError as error:
            self._close()
            return failed_record(blank, clock.explain(error.failure), case)
        found = FunctionComparison(spec.name, len(cases), tuple(differences), bool(printed))
        explanation = found.explain_first()
        return EvidenceRecord(
            found,
            None,
            blank.label,
            blank.secret,
            printed=printed,
            steps=len(cases),
            explain_with=lambda *_: explanation,
        )


def failed_record(blank: EvidenceRecord, failure: Failure, case: Mapping[str, Json] | None) -> EvidenceRecord:
    """Returns the evidence of a function that failed; tells its arguments unless the case is secret."""
    if case is not None and not blank.secret and failure.kind in CALL_FAILURES:
        arguments = ", ".join(f"{key}={format_value(value)}" for key, value in case.items()) or "nothing"
        end = "" if failure.message.endswith((".", "?", "!")) else "."
        failure = replace(failure, message=f"{failure.message}{end} It was called with {arguments}.")
    return EvidenceRecord(
        failure=failure, label=blank.label, secret=blank.secret, outcome=f"stopped ({failure.kind.value})"
    )


def _as_json(value: Any) -> Json:
    """Converts a value of the reference as the student's process converts its values."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [_as_json(each) for each in value]
    return float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else value


def is_close(expected: Json, actual: Json, within: float) -> bool:
    """True if two returned values are equal: numbers within the tolerance, everything else exactly."""
    if isinstance(expected, list):
        return (
            isinstance(actual, list)
            and len(actual) == len(expected)
            and all(is_close(*pair, within) for pair in zip(expected, actual, strict=True))
        )
    if type(expected) is float and type(actual) is float:
        return math.isclose(expected, actual, rel_tol=within, abs_tol=within)
    return type(expected) is type(actual) and bool(expected == actual)


def format_value(value: Json) -> str:
    """Formats a value for feedback; shortens long lists."""
    if isinstance(value, list):
        shown = ", ".join(map(format_value, value[:MAX_SHOWN]))
        more = f", ... {len(value)} in all" if len(value) > MAX_SHOWN else ""
        return f"[{shown}{more}]"
    if type(value) is float:
        return f"{value + 0.0:.6g}"  # without the sign of a zero
    return printable(repr(value)[:200])


def _first_difference(expected: Json, actual: Json) -> str:
    """Describes where two lists first differ; empty for other values."""
    if not isinstance(expected, list) or not isinstance(actual, list):
        return ""
    if len(expected) != len(actual):
        ended = len(actual) == 1 and is_close(expected[:1], actual, 1e-6)
        why = ". Does the return stand inside the loop, so that the first entry ends it?" if ended else ""
        return f": {counted(len(actual), 'entry')} instead of {len(expected)}{why}"
    for index, (one, other) in enumerate(zip(expected, actual, strict=True)):
        if not is_close(one, other, 1e-6):
            return f": item [{index}] should be {format_value(one)}, and is {format_value(other)}"
    return ""


def collect(
    assignment: Assignment, file: Path, options: EvidenceOptions
) -> AbstractContextManager[EvidenceCollector]:
    """Calls each function when a criterion first needs it."""
    return FunctionCollector(assignment, file, options)


KIND: Final = SubmissionKind(
    (".py",),
    {agrees.name: agrees},
    read_settings,
    collect,
    seed_decides="A seed decides with which values it is called.",
    limits=CALL_LIMITS,
    sheet_keys=SHEET_KEYS,
    exercise="30-quality-of-service/heard",
)
