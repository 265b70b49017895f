"""A world in a process of its own, which reads it and runs it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import Final

from grader.evidence.reader_process import MEMORY_LIMIT, ReaderProcess
from grader.kinds.world.facts import RunFacts, WorldFacts, WorldRunSpec
from kit.host.failure import Failure, FailureKind
from kit.host.sandbox.sandbox_config import INTERACTIVE_LEVEL, Level

READ_TIMEOUT_S: Final = 30.0
"""Seconds to read a world, including the start on a busy machine."""


class WorldProcess(ReaderProcess):
    """One world in a process of its own."""

    def __init__(
        self,
        file: Path,
        memory: int = MEMORY_LIMIT,
        level: Level = INTERACTIVE_LEVEL,
        drivers: Iterable[str] = (),
    ) -> None:
        """``drivers``: the files of the assignment's programs that will drive in it."""
        super().__init__(
            "grader.kinds.world.child",
            file,
            subject="world",
            advice="Open it with the kit (`kit world check`)",
            memory=memory,
            level=level,
            words=sorted(set(drivers) - {""}),
        )

    def read_world(self, seconds: float = READ_TIMEOUT_S) -> WorldFacts:
        """Returns what was read; to be called first, and once."""
        return WorldFacts.from_json(
            self._await_answer(seconds, _too_slow("The world takes too long to read"))
        )

    def run(self, spec: WorldRunSpec, seconds: float) -> RunFacts:
        """Makes one run within this many seconds of wall clock."""
        self._send(asdict(spec))
        slow = f"{spec.time_s:g} simulated seconds of this world take longer than {seconds:g} s"
        return RunFacts.from_json(self._await_answer(seconds, _too_slow(slow)))


def _too_slow(text: str) -> Failure:
    return Failure(FailureKind.TIMEOUT, f"{text}: it has too many walls, rays or bodies.")
