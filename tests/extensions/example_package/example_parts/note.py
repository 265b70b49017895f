"""A kind of submission: a note, a text file. No program runs."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from grader.assignment import Assignment
from grader.check import check
from grader.evidence.contract import EvidenceOptions, EvidenceRecord
from grader.kinds.contract import AssignmentFiles, KindSettings, SubmissionKind, collect_once


@dataclass(frozen=True, slots=True)
class WordsParams:
    about: str = ""


@check(none=0, full=20, unit="words", params=WordsParams)
def words(record: EvidenceRecord, params: WordsParams) -> float:
    """The note has {actual}; {full} earn all points."""
    return float(len(record.content.split()))


def read_settings(files: AssignmentFiles) -> KindSettings:
    return KindSettings()


def collect_evidence(assignment: Assignment, file: Path, options: EvidenceOptions) -> EvidenceRecord:
    return EvidenceRecord(file.read_bytes().decode(errors="replace"))


KIND = SubmissionKind((".txt",), {words.name: words}, read_settings, collect_once(collect_evidence))
