"""What a grading asked of a submission's evidence, and the answers: kept, so that it can be judged anew without running it.

Evidence is what a program did; judgement is what that is worth. Findings depend on the program, the worlds, seeds and limits,
and the grader's version; never on points, titles, hints, weights or what a criterion comes after. While a submission is graded,
``FindingsRecorder`` stands between its evidence and the judgement and notes every answer; ``KeptFindings`` gives the same answers
later. Asked for anything else, it raises NotKept: then the submission is run again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field, fields
from typing import Any, TypeVar

from grader.assignment import Criterion
from grader.evidence.contract import Evidence, EvidenceCollector
from kit.field_types import check_field_types
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.sandbox.sandbox_config import Level

Answer = TypeVar("Answer")
FailureData = dict[str, str | int | None]
"""A failure's fields, for JSON."""
Measure = Callable[[Evidence, Any], float]
"""(evidence, params of the check) -> the measure. Raises StudentCodeError."""


class NotKept(BaseException):
    """The findings do not hold what is asked for. No ``Exception``: nothing may take it for an error of a check."""


@dataclass(slots=True)
class KeptFinding:
    """One piece of evidence, with every answer that it has given."""

    label: str
    secret: bool
    outcome: str
    steps: int
    printed: tuple[str, ...]
    failure: FailureData | None
    measures: dict[str, str] = field(default_factory=dict)
    """By check and params; as text, since JSON has no infinity."""
    failed_measures: dict[str, FailureData] = field(default_factory=dict)
    """How the program failed where it was measured, by check and params."""
    failures: dict[str, FailureData | None] = field(default_factory=dict)
    """How the program had failed when it had been measured, by check and params: a measure may be the first to run it."""
    steps_then: dict[str, int] = field(default_factory=dict)
    """The steps that had been simulated when it had been measured."""
    explained: dict[str, str] = field(default_factory=dict)
    pictures: dict[str, str] = field(default_factory=dict)
    """By check."""


@dataclass(slots=True)
class Findings:
    """All that was found about one submission."""

    level: int
    pieces: list[KeptFinding] = field(default_factory=list)
    evidence: dict[str, list[int]] = field(default_factory=dict)
    """The pieces that a criterion is judged on, by what it asks for."""
    public: dict[str, list[int]] = field(default_factory=dict)
    counterparts: dict[str, list[int]] = field(default_factory=dict)
    """Those that were asked for, of which there may have been more."""
    collected: list[int] = field(default_factory=list)
    own_tests: str = ""
    """Digest of the code of the teacher's own tests; empty if none was run."""
    outcomes: dict[str, list[list[Any]]] = field(default_factory=dict)
    """Status, message and whether it saw secrets, of each run of each of these tests."""

    def as_dict(self) -> dict[str, Any]:
        """The findings as data for JSON."""
        return asdict(self)

    @classmethod
    def from_dict(cls, content: Mapping[str, Any]) -> Findings:
        """The findings that ``as_dict`` wrote. Raises KeyError, TypeError or ValueError for other data."""
        given = {each.name: content[each.name] for each in fields(cls) if each.name != "pieces"}
        check_field_types(cls, {name: value for name, value in given.items() if name != "outcomes"})
        if not isinstance(given["outcomes"], Mapping):
            raise TypeError("outcomes that are of no test")
        pieces = []
        for each in content["pieces"]:
            check_field_types(KeptFinding, each)
            pieces.append(KeptFinding(**{**each, "printed": tuple(each["printed"])}))
        found = cls(**given, pieces=pieces)
        places = (
            *found.evidence.values(),
            *found.public.values(),
            *found.counterparts.values(),
            found.collected,
        )
        if any(not 0 <= at < len(pieces) for indices in places for at in indices):
            raise ValueError("a piece of evidence is missing")
        return found


def evidence_key(criterion: Criterion) -> str:
    """What decides which evidence a criterion is judged on."""
    return repr((criterion.check, criterion.params, criterion.trials, criterion.seeds.value))


def _answer_key(check: str, params: Any) -> str:
    return repr((check, params))


class NotedEvidence:
    """Evidence whose answers are noted."""

    def __init__(self, original: Evidence, finding: KeptFinding) -> None:
        self.original = original
        self._finding = finding
        self._measured: list[tuple[str, Any]] = []

    @property
    def label(self) -> str:
        return self.original.label

    @property
    def secret(self) -> bool:
        return self.original.secret

    @property
    def failure(self) -> Failure | None:
        return self.original.failure

    @property
    def outcome(self) -> str:
        return self.original.outcome

    @property
    def steps(self) -> int:
        return self.original.steps

    @property
    def printed(self) -> tuple[str, ...]:
        return self.original.printed

    def explain(self, check: str, params: Any) -> str:
        text = self.original.explain(check, params)
        self._finding.explained[_answer_key(check, params)] = text
        return text

    def picture(self, check: str = "") -> str:
        text = self.original.picture(check)
        self._finding.pictures[check] = text
        return text

    def answer_all(self) -> None:
        """Notes what a criterion that measured it would also ask if it had lost points by that: where the measure is that earns
        everything may change."""
        for check, params in self._measured:
            key = _answer_key(check, params)
            with suppress(
                Exception
            ):  # asked where points are lost, it would be the grader's error; here nobody has asked
                if key not in self._finding.explained:
                    self.explain(check, params)
                if check not in self._finding.pictures and not self.secret:
                    self.picture(check)

    def measure(self, check: str, params: Any, measure: Measure) -> float:
        """Measures it, and notes the measure or how the program failed."""
        key = _answer_key(check, params)
        self._measured.append((check, params))
        try:
            value = float(measure(self.original, params))
        except StudentCodeError as error:
            self._finding.failed_measures[key] = _failure_data(error.failure)
            raise
        self._finding.measures[key] = repr(value)
        failure = self.failure
        self._finding.failures[key] = None if failure is None else _failure_data(failure)
        self._finding.steps_then[key] = self.steps
        return value


class FindingsRecorder:
    """A collector that notes what the judgement asks of another one."""

    def __init__(self, collector: EvidenceCollector) -> None:
        self.level = collector.level
        self.findings = Findings(int(collector.level))
        self._collector = collector
        self._noted: dict[int, tuple[int, NotedEvidence]] = {}

    def evidence(self, criterion: Criterion) -> Sequence[Evidence]:
        return self._note(self.findings.evidence, criterion, self._collector.evidence(criterion))

    def public_evidence(self, criterion: Criterion) -> Sequence[Evidence]:
        return self._note(self.findings.public, criterion, self._collector.public_evidence(criterion))

    def collected(self) -> Sequence[Evidence]:
        return [self._noted_of(each)[1] for each in self._collector.collected()]

    def counterparts(self, criterion: Criterion) -> Iterator[Evidence]:
        asked = self.findings.counterparts.setdefault(evidence_key(criterion), [])
        for number, each in enumerate(self._collector.counterparts(criterion)):
            at, noted = self._noted_of(each)
            if number == len(asked):
                asked.append(at)
            yield noted

    def finish(self) -> Findings:
        """Returns all findings, when the grading is over: what a program did is known in full only then."""
        self.findings.collected = [self._noted_of(each)[0] for each in self._collector.collected()]
        for at, noted in self._noted.values():
            noted.answer_all()
            piece = self.findings.pieces[at]
            piece.outcome, piece.steps, piece.printed = noted.outcome, noted.steps, tuple(noted.printed)
            piece.failure = None if noted.failure is None else _failure_data(noted.failure)
        return self.findings

    def _note(
        self, kept: dict[str, list[int]], criterion: Criterion, collected: Sequence[Evidence]
    ) -> Sequence[Evidence]:
        noted = [self._noted_of(each) for each in collected]
        kept[evidence_key(criterion)] = [at for at, _ in noted]
        return [each for _, each in noted]

    def _noted_of(self, evidence: Evidence) -> tuple[int, NotedEvidence]:
        """The number of a piece of evidence and the object that notes its measures, always the same object: criteria compare by identity."""
        known = self._noted.get(id(evidence))
        if known is None:
            finding = KeptFinding(evidence.label, evidence.secret, "", 0, (), None)
            known = len(self.findings.pieces), NotedEvidence(evidence, finding)
            self.findings.pieces.append(finding)
            self._noted[id(evidence)] = known
        return known


class KeptEvidence:
    """Evidence that answers what was asked before. Raises NotKept for anything else."""

    def __init__(self, finding: KeptFinding) -> None:
        self._finding = finding
        self.label = finding.label
        self.secret = finding.secret
        self.outcome = finding.outcome
        self.steps = finding.steps
        self.printed = finding.printed
        self.failure = None if finding.failure is None else _failure_from(finding.failure)

    def explain(self, check: str, params: Any) -> str:
        return _stored_answer(self._finding.explained, _answer_key(check, params))

    def picture(self, check: str = "") -> str:
        return _stored_answer(self._finding.pictures, check)

    def measure(self, check: str, params: Any, measure: Measure) -> float:
        """The measure that it had. Raises StudentCodeError if measuring it failed."""
        key = _answer_key(check, params)
        if key in self._finding.failed_measures:
            raise StudentCodeError(_failure_from(self._finding.failed_measures[key]))
        return float(_stored_answer(self._finding.measures, key))

    def has_measured(self, check: str, params: Any) -> bool:
        key = _answer_key(check, params)
        return key in self._finding.measures or key in self._finding.failed_measures

    def state_of(self, check: str, params: Any) -> tuple[Failure | None, int]:
        """How the program had failed, and the steps that had been simulated, when it had been measured."""
        key = _answer_key(check, params)
        failure = _stored_answer(self._finding.failures, key)
        return None if failure is None else _failure_from(failure), _stored_answer(
            self._finding.steps_then, key
        )


class KeptFindings:
    """A collector that runs nothing: all its evidence was collected before."""

    def __init__(self, findings: Findings) -> None:
        self.level = Level(findings.level)
        self._findings = findings
        self._pieces = [KeptEvidence(each) for each in findings.pieces]

    def evidence(self, criterion: Criterion) -> Sequence[Evidence]:
        return self._pieces_at(_stored_answer(self._findings.evidence, evidence_key(criterion)))

    def public_evidence(self, criterion: Criterion) -> Sequence[Evidence]:
        return self._pieces_at(_stored_answer(self._findings.public, evidence_key(criterion)))

    def collected(self) -> Sequence[Evidence]:
        return self._pieces_at(self._findings.collected)

    def counterparts(self, criterion: Criterion) -> Iterator[Evidence]:
        yield from self._pieces_at(_stored_answer(self._findings.counterparts, evidence_key(criterion)))

    def _pieces_at(self, indices: Sequence[int]) -> Sequence[Evidence]:
        return [self._pieces[at] for at in indices]


def _stored_answer(answers: Mapping[str, Answer], key: str) -> Answer:
    if key not in answers:
        raise NotKept(key)
    return answers[key]


def _failure_data(failure: Failure) -> FailureData:
    return {**asdict(failure), "kind": failure.kind.value}


def _failure_from(content: FailureData) -> Failure:
    given: dict[str, Any] = {**content, "kind": FailureKind(content["kind"])}
    failure = Failure(**given)
    check_field_types(Failure, asdict(failure))
    return failure


def measure_of(evidence: Evidence, check: str, params: Any, measure: Measure) -> float:
    """Measures a piece of evidence for a check, or returns what it measured before. Raises StudentCodeError, NotKept."""
    if isinstance(evidence, (NotedEvidence, KeptEvidence)):
        return evidence.measure(check, params, measure)
    return float(measure(evidence, params))


def failure_before(evidence: Evidence, check: str, params: Any) -> Failure | None:
    """How the program has failed, as it is known before the evidence is measured for a check; None if it has not."""
    if isinstance(evidence, KeptEvidence) and evidence.has_measured(check, params):
        return None
    return evidence.failure


def state_after(evidence: Evidence, check: str, params: Any) -> tuple[Failure | None, int]:
    """How the program has failed, and how many steps were simulated, when the evidence has been measured for a check."""
    if isinstance(evidence, KeptEvidence):
        return evidence.state_of(check, params)
    return evidence.failure, evidence.steps


def original_of(evidence: Evidence) -> Evidence:
    """The evidence itself, for a teacher's own tests, which may look at all of it."""
    return evidence.original if isinstance(evidence, NotedEvidence) else evidence
