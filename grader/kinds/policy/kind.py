"""A trained policy, as ``kit train`` keeps it (``best.npz``): tested on fresh episodes of every case of a task.

The assignment names the task and the test::

    policy:
      task: my_task.yaml       # a task of the kit's, or a task file in this folder
      episodes: 200            # of each case
    seed: 1                    # of the episodes; another one may stand in secret.yaml

No program of the student's runs: a policy is arrays of numbers.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Final

from grader.assignment import Assignment
from grader.check import Check, NoParams, check
from grader.evidence.contract import EvidenceOptions, EvidenceRecord
from grader.kinds.contract import AssignmentFiles, KindSettings, SubmissionKind, collect_once
from grader.kinds.policy.sheet_keys import SHEET_KEYS
from grader.seeds import read_seed
from grader.submitted_files import reading_submission
from grader.task_files import read_task_choice
from kit.array_archives import READ_ERRORS, check_arrays
from kit.document.layout import lines_of
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.wire import printable
from kit.learning.policies.confidence_intervals import lower_bound
from kit.learning.policies.evaluation import EvaluationResult, Evaluator
from kit.learning.policies.policy import Policy, PolicyError
from kit.learning.policies.policy_file import load_policy
from kit.learning.policies.seeds import derive_seed
from kit.learning.tasks.task_spec import TaskSpec
from kit.plain_files import read_plain_file

MAX_BYTES: Final = 2 << 20
"""Bytes of a policy, unpacked; the kit's take about a tenth. A larger one would take too long to test."""
MAX_EPISODES: Final = 1000


@dataclass(frozen=True, slots=True)
class PolicyTestPlan:
    """The cases and episodes that a policy is tested on."""

    choice: TaskSpec
    episodes: int
    """Episodes per case."""
    seed: int
    secret_seed: int | None


@check(none=0.5, full=0.9, unit="%")
def succeeds(evidence: EvidenceRecord, params: NoParams) -> float:
    """The agent surely reaches its goal in {actual} of the episodes; {full} earns all points. (“Surely”: the lower end of
    Wilson's interval, all cases together.)"""
    result: EvaluationResult = evidence.content
    return lower_bound(
        sum(case.reached for case in result.cases), sum(case.episodes for case in result.cases)
    )


@check(none=0.4, full=0.85, unit="%")
def every_case(evidence: EvidenceRecord, params: NoParams) -> float:
    """In the case that goes worst the agent surely reaches its goal in {actual} of the episodes; {full} earns all points."""
    result: EvaluationResult = evidence.content
    return lower_bound(result.worst.reached, result.worst.episodes)


@check(none=0.3, full=0.02, unit="%")
def collisions(evidence: EvidenceRecord, params: NoParams) -> float:
    """The agent touches something in {actual} of the episodes; {full} is allowed."""
    result: EvaluationResult = evidence.content
    return sum(case.outcomes[1] for case in result.cases) / sum(case.episodes for case in result.cases)


def read_settings(files: AssignmentFiles) -> KindSettings:
    """Reads the task and the test."""
    section = files.public.section("policy")
    choice = read_task_choice(section, files.folder)
    episodes = section.integer("episodes", 200, minimum=10, maximum=MAX_EPISODES)
    section.finish()
    seed = read_seed(files.public, 1)
    secret = None if files.secret is None else read_seed(files.secret)
    if choice is None:
        return KindSettings()
    return KindSettings(
        task=PolicyTestPlan(choice, episodes, seed, secret), secret_seeds=() if secret is None else (secret,)
    )


def collect_evidence(assignment: Assignment, file: Path, options: EvidenceOptions) -> EvidenceRecord:
    """Reads the policy and tests it once."""
    test: PolicyTestPlan = assignment.task
    is_secret = options.secret and test.secret_seed is not None
    seed = test.seed if not is_secret or test.secret_seed is None else test.secret_seed
    try:
        with reading_submission(file.name, PolicyError, OSError, RecursionError, OverflowError, MemoryError):
            policy = load_submitted_policy(file)
        task = test.choice.resolve()
        policy.check_fits(task)
    except (PolicyError, OSError, RecursionError, OverflowError, MemoryError) as error:
        # The path of the temporary copy means nothing to the student.
        message = printable(str(error).replace(f"{file.parent}/", ""))
        return EvidenceRecord(failure=Failure(FailureKind.IMPORT, message), label="the policy")
    try:
        result = Evaluator(task).test(
            policy, test.episodes, derive_seed(seed, "exam"), before_step=options.clock.check
        )
    except StudentCodeError as error:  # a network that takes long in every step
        return EvidenceRecord(failure=error.failure, label="the policy")
    return EvidenceRecord(
        result,
        secret=is_secret,
        label="the test with a secret seed" if is_secret else "the test",
        outcome="tested",
        steps=sum(case.episodes for case in result.cases),
        explain_with=lambda name, params: _explain(result, name),
        draw_with=lambda name: "\n".join(lines_of([result.table()])),
    )


def _explain(result: EvaluationResult, name: str) -> str:
    if name == "every_case":
        worst = result.worst
        return f"That is {worst.case}, reached {worst.reached} times in {worst.episodes}."
    return ""


def load_submitted_policy(file: Path) -> Policy:
    """The policy. PolicyError for what is none, too large, or holds more than its bytes say."""
    try:
        data = read_plain_file(file, MAX_BYTES)
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            check_arrays(archive, MAX_BYTES)
    except READ_ERRORS as error:
        raise PolicyError(
            f"{file.name}: not a policy of the kit, or damaged ({error}). Hand in a run's best.npz."
        ) from None
    return load_policy(file)


CHECKS: Final[Mapping[str, Check]] = MappingProxyType(
    {each.name: each for each in (succeeds, every_case, collisions)}
)
KIND: Final = SubmissionKind(
    (".npz",), CHECKS, read_settings, collect_once(collect_evidence), sheet_keys=SHEET_KEYS
)
