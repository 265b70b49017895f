"""The process that reads and runs a world: one request per line on standard input, one answer per line on standard output.

No program of a student's runs in it, but a world may be too large or too slow: then the process is ended. And what reads
it may have mistakes: from level 1 on the process can open no file but Python, the kit, the world's folder and the
assignment's drivers, write to its own folder alone, and reach neither the network nor other processes.
"""

from __future__ import annotations

import json
import os
import resource
import sys
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path

from grader.evidence.reader_child import (
    confine_before_reading,
    limit_memory,
    limit_resources,
    send_answer,
)
from grader.kinds.world.facts import WorldFacts, WorldRunSpec
from kit.world.documents import AllowedRoot, UnusableFile, WorldDocuments
from kit.world.problems import ProblemCollector, WorldError
from kit.world.records import SourceLocation, World


def main() -> None:
    """Reads the world named on the command line, then makes one run for each line."""
    path, memory, is_confined, scratch, *drivers = sys.argv[1:]
    file = Path(path)
    limit_resources()
    limit_memory(int(memory))
    if is_confined:
        confine_before_reading(file, scratch, drivers)
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # other output must not mix with the answers
    facts, world = _read_world(file, int(memory))
    send_answer(answers, asdict(facts))
    from grader.kinds.world.world_run import run_world  # only now: a world that cannot be read is not run

    for line in sys.stdin:
        send_answer(answers, asdict(run_world(_require_world(world), WorldRunSpec(**json.loads(line)))))


def _read_world(file: Path, memory: int) -> tuple[WorldFacts, World | None]:
    """Reads a world; of one whose main file is no mapping nothing else is read, and no simulator loaded for it."""
    documents = WorldDocuments(AllowedRoot.containing(file), {}, ProblemCollector())
    with suppress(UnusableFile):
        try:  # what is too much to read ends the reading at once
            if documents.section(documents.allowed_root.path_inside(file), SourceLocation(file)) is None:
                documents.problems.raise_if_any()
        except WorldError as error:
            return WorldFacts.of_unreadable(error, file), None
    limit_memory(resource.getrlimit(resource.RLIMIT_AS)[1])  # the simulator's own code is not the world's
    from grader.kinds.world.world_reading import read_world_facts

    limit_memory(memory, for_good=True)
    return read_world_facts(file)


def _require_world(world: World | None) -> World:
    assert world is not None, "a world that cannot be read is not run"
    return world


if __name__ == "__main__":
    main()
