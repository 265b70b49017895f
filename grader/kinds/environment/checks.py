"""Checks of Gymnasium environments: compares what they returned with what was true in the world."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any, Final

from grader.check import Check, NoParams, check
from grader.evidence.contract import EvidenceRecord
from grader.kinds.environment.examination import (
    EnvironmentEpisode,
    EnvironmentRecord,
    StepRecord,
    sector_minima,
)
from kit.geometry import Pose, wrap_angle
from kit.plain_text import counted

SECTORS: Final = 9
MAX_START_OFFSET: Final = (0.15, 0.35)
"""m, rad: the largest distance from home at which an episode may begin."""
OBSERVATION_TOLERANCE: Final = 1e-3
"""Tolerance of an observation [m], for single precision."""
MOVE_TOLERANCE: Final = 0.2
"""Relative tolerance of a move."""
TARGET_TOLERANCE: Final = 0.06
"""m: tolerance of the distance at which an episode ends at the target: more than one step."""

NUMBER_TYPES: Final = ("float", "int", "float64", "float32", "int64", "int32")


Complaints = Callable[[EnvironmentRecord], Iterator[str]]
"""Yields a string for everything that is looked at: a complaint, or empty where all is well."""


def complaint_check(
    *, none: float, full: float, unit: str = "", words: tuple[str, str] | None = None
) -> Callable[[Complaints], Check]:
    """Makes a check of a function that yields complaints; its docstring is the feedback.

    The check measures the share of what is fine.
    """

    def make(complaints: Complaints) -> Check:
        def share(evidence: EvidenceRecord, params: NoParams) -> float:
            found = list(complaints(evidence.content))
            return sum(not each for each in found) / len(found) if found else 0.0

        def faults(record: EnvironmentRecord, params: Any) -> Iterator[str]:
            return filter(None, complaints(record))

        share.__name__, share.__doc__ = complaints.__name__, complaints.__doc__
        return check(none=none, full=full, unit=unit, words=words, faults=faults)(share)

    return make


@complaint_check(none=0, full=1, unit="%")
def spaces(record: EnvironmentRecord) -> Iterator[str]:
    """The spaces say what an agent may do and what it sees; {actual} of that is right."""
    action, observation = (record.description.get(each, {}) for each in ("action_space", "observation_space"))
    expected = len(record.task.moves)
    # The spaces are what the program says of itself; that it acts on what it says is seen in the world.
    unproved = "" if _has_acted(record) else UNPROVED_SPACE
    if record.changed_spaces:  # whoever has read one space must know that neither will be another
        yield _changed_text(record, *record.changed_spaces)
        return
    yield (
        unproved and unproved.format(name="action_space")
        if (action.get("kind"), action.get("n"), action.get("start")) == ("Discrete", expected, 0)
        else f"action_space should be Discrete({expected}), one number for each action, and is {_space_text(action)}."
    )
    fits = observation.get("kind") == "Box" and observation.get("shape") == [SECTORS]
    if not fits:
        yield f"observation_space should be a Box of shape ({SECTORS},), and is {_space_text(observation)}."
    elif observation.get("low") != 0.0 or observation.get("high") != record.task.clip:
        yield f"observation_space should reach from 0 to {record.task.clip:g}, and is {_space_text(observation)}."
    elif observation.get("dtype") not in ("float32", "float64"):
        yield f"what is seen are metres: the Box's dtype should be numpy.float32, not {observation.get('dtype')}."
    else:
        yield unproved and unproved.format(name="observation_space")


UNPROVED_SPACE: Final = (
    "{name} is right, and counts as soon as step() drives the robot as one of the actions says."
)


def _changed_text(record: EnvironmentRecord, *names: str) -> str:
    """Returns what is wrong with the first of these spaces that has become another one; empty if none has."""
    return next(
        (
            f"{name} was another one after {record.changed_spaces[name]}: what an agent may do and sees stays the same for good."
            for name in names
            if name in record.changed_spaces
        ),
        "",
    )


def _has_acted(record: EnvironmentRecord) -> bool:
    """True if at some step the robot moved as the action says."""
    return any(not step.collided and not _move_complaint(step, record) for step in record.step_records)


def _returned_text(returned: Mapping[str, object]) -> str:
    """What a function of theirs has returned, in a few words."""
    count = returned.get("count")
    return counted(count, "value") if isinstance(count, int) else f"one of the type {returned.get('kind')}"


def _space_text(value: Mapping[str, object]) -> str:
    """Formats a space as Python code shows it."""
    kind = value.get("kind")
    if kind == "Discrete":
        return f"Discrete({value.get('n')})" + (
            f" from {value.get('start')} on" if value.get("start") else ""
        )
    if kind == "Box":
        shape = value.get("shape")
        sizes = ", ".join(map(str, shape)) if isinstance(shape, list) else "?"
        return f"Box({value.get('low')}, {value.get('high')}, shape ({sizes}), {value.get('dtype')})"
    return "missing" if kind in (None, "NoneType") else f"a {kind}"


@complaint_check(none=0, full=1, unit="%")
def resets(record: EnvironmentRecord) -> Iterator[str]:
    """reset() begins an episode; it did so rightly in {actual} of the cases."""
    home = record.task.scenario.start or Pose()
    for episode in record.episodes.values():
        returned = episode.returned
        parts = returned.get("parts", [])
        turned = abs(wrap_angle(episode.pose.theta - home.theta))
        away = math.hypot(episode.pose.x - home.x, episode.pose.y - home.y)
        if returned.get("kind") != "tuple" or returned.get("count") != 2:
            yield f"reset() returns two values, observation and info; yours returned {_returned_text(returned)}."
        elif parts[1].get("kind") != "dict":
            yield f"The second value of reset() is info, a dictionary; yours is of the type {parts[1].get('kind')}."
        elif changed := _changed_text(record, "observation_space"):
            yield f"What reset() returned lies in no space that stays: {changed}"
        elif not episode.is_in_space:
            yield "The observation of reset() is not in observation_space: look at its shape, dtype and bounds."
        elif away > MAX_START_OFFSET[0] or turned > MAX_START_OFFSET[1]:
            yield f"After reset() the robot stands {away:.2f} m and {math.degrees(turned):.0f} degrees from its home."
        elif not _is_observation_right(parts[0], episode.ranges, record):
            wrong = _explain_difference(parts[0], episode.ranges, record)
            yield f"In the observation of reset(): {wrong} Was the scan from before the reset kept?"
        else:
            yield ""


@complaint_check(none=0, full=1, unit="%")
def steps(record: EnvironmentRecord) -> Iterator[str]:
    """What step() returned has the right form in {actual} of the steps."""
    has_lasted = {name: _has_lasted(episode, record) for name, episode in record.episodes.items()}
    for name, step in ((name, step) for name, each in record.episodes.items() for step in each.step_records):
        returned = step.returned
        if returned.get("kind") != "tuple" or returned.get("count") != 5:
            five = "five values: observation, reward, terminated, truncated, info"
            yield f"step() returns {five}; yours returned {_returned_text(returned)}."
        elif changed := _changed_text(record, "observation_space"):
            yield f"What step() returned lies in no space that stays: {changed}"
        elif not step.is_in_space:
            yield "The observation of step() is not in observation_space: look at its shape, dtype and bounds."
        elif step.part(1).get("kind") not in NUMBER_TYPES or step.part(1).get("value") is None:
            yield f"The second value of step(), the reward, is a finite number; yours is of the type {step.part(1).get('kind')}."
        elif (step.part(2).get("kind"), step.part(3).get("kind")) != ("bool", "bool"):
            kinds = f"{step.part(2).get('kind')} and {step.part(3).get('kind')}"
            yield f"terminated and truncated are True or False, not {kinds}."
        elif step.part(4).get("kind") != "dict":
            yield f"The fifth value of step() is info, a dictionary; yours is of the type {step.part(4).get('kind')}."
        elif not has_lasted[name]:
            yield _instant_step_text(record)
        else:
            yield ""


def _has_lasted(episode: EnvironmentEpisode, record: EnvironmentRecord) -> bool:
    """True if the episode's steps took their time in the world."""
    return record.task.has_lasted([step.duration_s for step in episode.step_records])


def _instant_step_text(record: EnvironmentRecord) -> str:
    return (
        "step() came back before time had passed in the world: it should drive the robot for "
        f"{record.task.step_s:g} s and wait for what its sensors measure then."
    )


@complaint_check(none=0.5, full=1, unit="%")
def sees(record: EnvironmentRecord) -> Iterator[str]:
    """The observation is the nine sectors of the newest scan in {actual} of the steps."""
    for step in record.step_records:
        value = step.part(0)
        if _is_observation_right(value, step.ranges, record):
            yield ""
        else:
            wrong = _explain_difference(value, step.ranges, record)
            yield wrong[0].upper() + wrong[1:]


def _is_observation_right(
    value: Mapping[str, object], ranges: tuple[float, ...], record: EnvironmentRecord
) -> bool:
    numbers, expected = value.get("numbers"), sector_minima(ranges, SECTORS, record.task.clip)
    return (
        isinstance(numbers, list)
        and len(numbers) == len(expected)
        and all(
            isinstance(given, float) and math.isclose(given, right, abs_tol=OBSERVATION_TOLERANCE)
            for given, right in zip(numbers, expected, strict=True)
        )
    )


def _explain_difference(
    value: Mapping[str, object], ranges: tuple[float, ...], record: EnvironmentRecord
) -> str:
    """Describes the first wrong value of an observation."""
    numbers, expected = value.get("numbers"), sector_minima(ranges, SECTORS, record.task.clip)
    if not isinstance(numbers, list):
        return f"an observation is a NumPy array of {SECTORS} numbers, not a {value.get('kind', 'value')}."
    if len(numbers) != len(expected):
        return f"an observation is {SECTORS} numbers."
    index = next(
        k
        for k, (one, other) in enumerate(zip(numbers, expected, strict=True))
        if not isinstance(one, float) or not math.isclose(one, other, abs_tol=OBSERVATION_TOLERANCE)
    )
    given = numbers[index]
    shown = f"{given:.3f}" if isinstance(given, float) else "no finite number"
    return f"sector {index} should be {expected[index]:.3f} m by the newest scan, and is {shown}."


@complaint_check(none=0.5, full=0.98, unit="%")
def acts(record: EnvironmentRecord) -> Iterator[str]:
    """The robot did what the action says in {actual} of the steps."""
    for step in record.step_records:
        if not step.collided:
            yield _move_complaint(step, record)


def _move_complaint(step: StepRecord, record: EnvironmentRecord) -> str:
    """Returns how a step's move differs from what its action says; empty if it does not."""
    speed, turn = record.task.moves[step.action]
    gone = math.hypot(step.pose_after.x - step.pose_before.x, step.pose_after.y - step.pose_before.y)
    turned = wrap_angle(step.pose_after.theta - step.pose_before.theta)
    expected = speed * record.task.step_s, turn * record.task.step_s
    tolerance = MOVE_TOLERANCE * max(abs(expected[0]), abs(expected[1]), 0.01)
    if abs(gone - expected[0]) <= tolerance and abs(turned - expected[1]) <= tolerance:
        return ""
    return (
        f"step({step.action}) should drive {expected[0]:.3f} m and turn {math.degrees(expected[1]):.0f} degrees; "
        f"the robot drove {gone:.3f} m and turned {math.degrees(turned):.0f}."
    )


@complaint_check(none=0, full=1, words=("something else", "terminated"))
def crash(record: EnvironmentRecord) -> Iterator[str]:
    """A collision ends the episode."""
    episode = record.episodes["into the wall"]
    hit = next((k for k, step in enumerate(episode.step_records) if step.collided), None)
    yield _ending_complaint(episode, hit, "the robot touched a wall", "terminated")


@complaint_check(none=0, full=1, words=("something else", "terminated"))
def arrival(record: EnvironmentRecord) -> Iterator[str]:
    """Reaching the target ends the episode."""
    case = record.task.scenario.case
    assert case is not None  # drives to a target are only asked for where there is one
    episode, radius = record.episodes["to the target"], case.target_radius
    step_records = episode.step_records
    late = next(
        (k for k, step in enumerate(step_records) if step.target_distance < radius - TARGET_TOLERANCE), None
    )
    if step_records and step_records[-1].is_over and not step_records[-1].collided:
        away = step_records[-1].target_distance
        late = len(step_records) - 1 if away <= radius + TARGET_TOLERANCE else late
    yield _ending_complaint(episode, late, f"the robot came within {radius:g} m of the target", "terminated")


@complaint_check(none=0, full=1, words=("something else", "truncated"))
def timeout(record: EnvironmentRecord) -> Iterator[str]:
    """When its time is up an episode is cut off."""
    last = record.task.max_steps - 1
    episode = record.episodes["turning on the spot"]
    if not _has_lasted(episode, record):
        yield _instant_step_text(record)
        return
    yield _ending_complaint(episode, last, "the time was up", "truncated")


def _ending_complaint(episode: EnvironmentEpisode, due: int | None, why: str, how: str) -> str:
    """Returns a complaint unless the episode ended at the step ``due``, terminated or truncated as ``how`` says."""
    step_records = episode.step_records
    over = next((k for k, step in enumerate(step_records) if step.is_over), None)
    if over is not None and (due is None or over < due):
        after = f"The episode “{episode.name}” was {{}} after {counted(over + 1, 'step')}"
        if step_records[over].is_true(2):
            return f"{after.format('terminated')}, though it had neither collided nor arrived."
        return (
            f"{after.format('truncated')}, before its time was up: does reset() set the count of steps back?"
        )
    if due is None:
        return f"The episode “{episode.name}” did not end: do the actions do what they should?"
    if over is None or over > due + 1:
        return f"After {due + 1} steps {why}: step() should return {how} as True then, and did not."
    says = step_records[over].is_true(2), step_records[over].is_true(3)
    if says != ((True, False) if how == "terminated" else (False, True)):
        hint = (
            "The world has not ended, only the time limit was reached: the agent cannot see the clock."
            if how == "truncated"
            else "It is the world that ended the episode, not the clock."
        )
        return f"When {why}, step() returned terminated {says[0]}, truncated {says[1]}; it should be {how} alone. {hint}"
    return ""


@complaint_check(none=0, full=1, unit="%")
def repeats(record: EnvironmentRecord) -> Iterator[str]:
    """The seed must decide whatever chance decides, and nothing else may."""
    one, again, other = (
        record.episodes[name] for name in ("one seed", "the same seed again", "another seed")
    )
    same = _observations(one) == _observations(again) and _start(one) == _start(again)
    yield (
        ""
        if same
        else (
            "reset(seed=...) with the same seed, and the same actions, saw something else. Does it call "
            "super().reset(seed=seed), and draw from self.np_random alone?"
        )
    )
    yield (
        ""
        if _start(one) != _start(other)
        else (
            "Two seeds began at the very same place: the start should differ a little, drawn from self.np_random."
        )
    )


def _observations(episode: EnvironmentEpisode) -> list[object]:
    first = episode.returned.get("parts", [{}])
    record = [first[0].get("numbers") if first else None]
    record += [step.part(0).get("numbers") for step in episode.step_records]
    return [[round(n, 3) if isinstance(n, float) else n for n in each or []] for each in record]


def _start(episode: EnvironmentEpisode) -> tuple[float, ...]:
    return tuple(round(each, 4) for each in episode.pose)


@complaint_check(none=0, full=1, unit="%")
def pays(record: EnvironmentRecord) -> Iterator[str]:
    """The reward of an episode's last step tells good ends from bad ones."""
    for name, sign, what in (
        ("to the target", 1, "reaching the target"),
        ("into the wall", -1, "a collision"),
    ):
        step_records = record.episodes[name].step_records
        paid = step_records[-1].part(1).get("value") if step_records else None
        is_right = isinstance(paid, float) and paid * sign > 0
        if is_right and not _has_happened(step_records, record, sign):
            yield f"The episode “{name}” did not come to {what}: do the actions do what they should?"
            continue
        expected = "more than 0" if sign > 0 else "less than 0"
        yield (
            ""
            if is_right
            else f"The step that ends with {what} should be rewarded with {expected}, not with {paid}."
        )


def _has_happened(step_records: Sequence[StepRecord], record: EnvironmentRecord, sign: int) -> bool:
    """True if the robot really reached the target (``sign`` above 0) or touched a wall at some step."""
    if sign < 0:
        return any(step.collided for step in step_records)
    case = record.task.scenario.case
    assert case is not None  # checked when the assignment was read
    return any(step.target_distance <= case.target_radius + TARGET_TOLERANCE for step in step_records)


@complaint_check(none=0, full=1, words=("complains", "content"))
def checker(record: EnvironmentRecord) -> Iterator[str]:
    """Gymnasium's own checker is not content."""
    if record.changed_spaces:
        yield "It looked at spaces that were other ones later."
    elif record.checker_complaint:
        yield f"It says: {record.checker_complaint}"
    else:
        has_lasted = record.task.has_lasted(record.checker_step_durations)
        yield "" if has_lasted else _instant_step_text(record)


CHECKS: Final[Mapping[str, Check]] = MappingProxyType(
    {
        each.name: each
        for each in (spaces, resets, steps, sees, acts, crash, arrival, timeout, repeats, pays, checker)
    }
)
"""Every check of an environment, by name."""


def first_complaint(record: EnvironmentRecord, name: str) -> str:
    """The first complaint of a check; empty if there is none."""
    faults = CHECKS[name].faults
    return "" if faults is None else next(faults(record, None), "")
