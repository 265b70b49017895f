"""Sweeps disturbances: how a policy's success falls as each kind of difference from the simulation grows, one at a time.

Every value is tested on the same episodes. What has been tested is kept in a file, so that a sweep that was interrupted
goes on where it was.
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field, fields, is_dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from kit.document.blocks import Block, Cell, CellStyle, Column, Picture, Table, Text
from kit.learning.policies.confidence_intervals import ConfidenceInterval, wilson_interval
from kit.learning.policies.evaluation import EvaluationResult, evaluate_on
from kit.learning.policies.policy import Policy
from kit.learning.policies.policy_file import policy_bytes
from kit.learning.tasks.disturbances import (
    DISTURBANCE_KINDS,
    DisturbanceError,
    DisturbanceKind,
    Disturbances,
    UniformRange,
)
from kit.learning.tasks.learning_task import LearningTask
from kit.line_log import LineLog, LineReader
from kit.plain_text import quoted, suggestion, without_formula
from kit.render.curve import Axes, Curve, draw_curves
from kit.render.encode import Encoder

CHART_ROWS = 10
CSV_HEADER = (
    "kind",
    "unit",
    "value",
    "episodes",
    "share",
    "low",
    "high",
    "reached",
    "collided",
    "timed_out",
    "worst_case",
    "worst_share",
)


@dataclass(frozen=True, slots=True)
class SweepPoint:
    """The results of a policy under one value of one disturbance."""

    kind: str
    value: float
    reached: int
    collided: int
    timed_out: int
    worst_case: str
    worst_share: float
    """Success in the case that goes worst."""
    metrics: Mapping[str, float] = field(default_factory=dict)
    """Mean of each metric of the task's own reward file, by name."""

    @property
    def episodes(self) -> int:
        return self.reached + self.collided + self.timed_out

    @property
    def share(self) -> float:
        """Success over all cases, which have equally many episodes."""
        return self.reached / self.episodes

    @property
    def interval(self) -> ConfidenceInterval:
        """The 95 % confidence interval of the share."""
        return wilson_interval(self.reached, self.episodes)

    def as_dict(self) -> dict[str, Any]:
        """JSON-able."""
        return {
            **asdict(self),
            "episodes": self.episodes,
            "share": self.share,
            "interval": list(self.interval),
        }


def find_kinds(names: Sequence[str]) -> tuple[DisturbanceKind, ...]:
    """The kinds of these names, with dashes or underscores; all where there is none. DisturbanceError for an unknown one."""
    known = {kind.option: kind for kind in DISTURBANCE_KINDS}
    wanted = [name.replace("_", "-") for name in names]
    for name in wanted:
        if name not in known:
            raise DisturbanceError(f"there is no disturbance {quoted(name)}: {suggestion(name, known)}")
    return tuple(kind for name, kind in known.items() if not wanted or name in wanted)


def _with_all_fields(value: object) -> object:
    """The value with every record in it as the name of its class and all its fields, which its own text may leave out."""
    if is_dataclass(value):
        return type(value).__name__, tuple(
            _with_all_fields(getattr(value, each.name)) for each in fields(value)
        )
    return tuple(map(_with_all_fields, value)) if isinstance(value, tuple) else value


class PolicySweep:
    """A sweep of ``policy`` on ``task``, whose own disturbances are the middle from which one at a time is changed."""

    def __init__(
        self,
        policy: Policy,
        task: LearningTask,
        kinds: Sequence[DisturbanceKind],
        *,
        episodes: int,
        seed: int,
        greedy: bool = True,
        journal: Path | None = None,
    ) -> None:
        """``episodes`` of each case for every value. ``journal``: the file that keeps what has been tested."""
        policy.check_fits(task)
        self._policy = policy
        self._task = task
        self._episodes, self._seed, self._greedy = episodes, seed, greedy
        self._journal = journal
        self._key = self._make_key()
        self.places = tuple((kind, value) for kind in kinds for value in kind.sweep)
        """Every kind with every value that is tested, in order."""

    def points(self) -> Iterator[SweepPoint]:
        """The points in the order of ``places``: those that are known at once, the others as they are tested."""
        known = self._read_journal()
        for kind, value in self.places:
            disturbances = self._disturbances(kind, value)
            name = json.dumps(disturbances.as_dict(), sort_keys=True)
            if name not in known:
                task = replace(self._task, disturbances=disturbances)
                result = evaluate_on(task, self._policy, self._episodes, self._seed, greedy=self._greedy)
                known[name] = _outcome_counts(result)
                self._append(name, known[name])
            yield SweepPoint(kind.name, value, **known[name])

    def _disturbances(self, kind: DisturbanceKind, value: float) -> Disturbances:
        return self._task.disturbances.changed({kind.name: UniformRange(value, value)})

    def _make_key(self) -> str:
        """What tells this sweep's results from those of others in the journal."""
        plain = replace(self._task, disturbances=Disturbances())
        told = repr((_with_all_fields(plain), self._episodes, self._seed, self._greedy)).encode()
        return hashlib.sha256(policy_bytes(self._policy) + told).hexdigest()[:32]

    def _read_journal(self) -> dict[str, dict[str, Any]]:
        found: dict[str, dict[str, Any]] = {}
        if self._journal is None:
            return found
        for line in LineReader(self._journal).read_new():
            with suppress(
                RecursionError, ValueError, TypeError, KeyError
            ):  # the last line of a sweep that was killed
                entry = json.loads(line)
                if entry["key"] == self._key:
                    SweepPoint("", 0.0, **entry["counts"])
                    found[entry["disturbances"]] = entry["counts"]
        return found

    def _append(self, name: str, counts: dict[str, Any]) -> None:
        if self._journal is not None:
            entry = {"key": self._key, "disturbances": name, "counts": counts}
            with self._journal.open("a+b") as file:
                LineLog(file).append(json.dumps(entry).encode())


def _outcome_counts(result: EvaluationResult) -> dict[str, Any]:
    reached, collided, timed_out = np.sum([case.outcomes for case in result.cases], axis=0).tolist()
    worst = result.worst
    return {
        "reached": reached,
        "collided": collided,
        "timed_out": timed_out,
        "worst_case": worst.case,
        "worst_share": worst.share,
        "metrics": result.metrics,
    }


def sweep_blocks(points: Sequence[SweepPoint], encoder: Encoder, columns: int = 79) -> list[Block]:
    """A chart of the success with its interval, and a table, for each kind of disturbance."""
    blocks: list[Block] = []
    for kind in DISTURBANCE_KINDS:
        of_kind = [point for point in points if point.kind == kind.name]
        if not of_kind:
            continue
        label = kind.option.replace("-", " ") + (f" [{kind.unit}]" if kind.unit else "")
        blocks.append(Text(f"{label}: {kind.summary}"))
        if len(of_kind) > 1:
            blocks.append(
                Picture(
                    tuple(_sweep_chart(of_kind, label, encoder, columns, CHART_ROWS)), indent=0, is_tight=True
                )
            )
        blocks.append(_sweep_table(of_kind))
    return blocks


def _sweep_table(points: Sequence[SweepPoint]) -> Table:
    columns = (
        Column("value"),
        Column("success", decimals=3),
        Column("95 % interval", decimals=3),
        Column("collided", decimals=3),
        Column("timed out", decimals=3),
        Column("worst", decimals=3),
        Column("case", CellStyle.TEXT),
        *(Column(name, decimals=2) for name in points[0].metrics),
    )
    rows: tuple[tuple[Cell, ...], ...] = tuple(
        (
            f"{point.value:g}",
            point.share,
            point.interval,
            point.collided / point.episodes,
            point.timed_out / point.episodes,
            point.worst_share,
            point.worst_case,
            *point.metrics.values(),
        )
        for point in points
    )
    return Table("disturbances", "", columns, rows, is_ruled=False, is_tight=True)


def _sweep_chart(
    points: Sequence[SweepPoint], label: str, encoder: Encoder, columns: int, rows: int
) -> list[str]:
    values = np.array([point.value for point in points])
    parts = (
        Curve("success", values, np.array([point.share for point in points])),
        Curve("low", values, np.array([point.interval.low for point in points])),
        Curve("high", values, np.array([point.interval.high for point in points])),
    )
    axes = Axes(label, 0.0, 1.0, start=float(values[0]), end=float(values[-1]))
    return list(draw_curves(parts, axes, columns, rows, encoder).rows())


def sweep_csv(points: Sequence[SweepPoint]) -> str:
    """A table for other programs: a row for each point."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    own = tuple(dict.fromkeys(name for point in points for name in point.metrics))
    writer.writerow((*CSV_HEADER, *own))
    units = {kind.name: kind.unit for kind in DISTURBANCE_KINDS}
    for point in points:
        measured = (point.episodes, point.share, *point.interval, point.reached, point.collided)
        tail = (point.timed_out, without_formula(point.worst_case), point.worst_share)
        metrics = (point.metrics.get(name, "") for name in own)
        writer.writerow((point.kind, units[point.kind], point.value, *measured, *tail, *metrics))
    return text.getvalue()
