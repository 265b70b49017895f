"""The process that reads and runs a world: one request per line on standard input, one answer per line on standard output.

No program of a student's runs in it, but a world may be too large or too slow: then the process is ended.
"""

from __future__ import annotations

import ctypes
import json
import os
import resource
import sys
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any

from grader.evidence.world.facts import WorldRunSpec
from grader.evidence.world.world_reading import read_world_facts
from grader.evidence.world.world_run import run_world
from kit.world.records import World


def main() -> None:
    """Reads the world named on the command line, then makes one run for each line."""
    file, memory = Path(sys.argv[1]), int(sys.argv[2])
    _limit_resources(memory)
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # other output must not mix with the answers
    facts, world = read_world_facts(file)
    _send(answers, asdict(facts))
    for line in sys.stdin:
        _send(answers, asdict(run_world(_there(world), WorldRunSpec(**json.loads(line)))))


def _there(world: World | None) -> World:
    assert world is not None, "a world that cannot be read is not run"
    return world


def _send(answers: Any, answer: dict[str, Any]) -> None:
    answers.write(json.dumps(answer) + "\n")
    answers.flush()


def _limit_resources(memory: int) -> None:
    """Makes the process end with its parent, and limits its address space to ``memory`` bytes."""
    if sys.platform == "linux":
        with suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(1, ctypes.c_ulong(9))  # PR_SET_PDEATHSIG, SIGKILL
    with suppress(ValueError, OSError):
        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


if __name__ == "__main__":
    main()
