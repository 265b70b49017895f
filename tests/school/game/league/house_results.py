"""What the programs of the house drive and play on the levels of a new league.

``python -m tests.school.game.league.house_results`` drives it anew and writes it where the kit has it: about eight minutes.
"""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from itertools import permutations
from pathlib import Path
from tempfile import TemporaryDirectory

from kit.host.sandbox.sandbox_config import Level as Confinement
from kit.school.game.league.entries import house_entries
from kit.school.game.league.league import (
    HOUSE_JUDGED,
    HOUSE_RESULTS,
    RACES,
    TAG,
    JudgedJob,
    League,
    LeagueJob,
    drive_job,
    judge_result,
    run_league_job,
    tag_job,
)
from kit.school.game.shared_drives import pack_drives


def house_jobs() -> list[LeagueJob]:
    """The drives and games, as a new league has them."""
    with TemporaryDirectory() as folder:
        programme = League.make(Path(folder, "league"), "House", RACES, TAG).programme()
    drives = [drive_job(level, entry) for level in programme.races for entry in house_entries()]
    return [
        *drives,
        *(tag_job(level, *pair) for level in programme.tag for pair in permutations(house_entries(), 2)),
    ]


def house_judgement(job: LeagueJob) -> JudgedJob:
    """What came of a drive or a game, as its recordings show."""
    content = (HOUSE_RESULTS / f"{job.key}.npz").read_bytes()
    judged = judge_result(content, job.level, len(job.entrants))
    assert judged is not None
    return replace(judged, is_same_platform=True)


def main() -> None:
    HOUSE_RESULTS.mkdir(exist_ok=True)
    jobs = house_jobs()
    for file in HOUSE_RESULTS.glob("*.npz"):
        file.unlink()
    judged = {}
    for job in jobs:
        content = pack_drives(*run_league_job(job, Confinement(0)))
        (HOUSE_RESULTS / f"{job.key}.npz").write_bytes(content)
        judged[job.key] = asdict(house_judgement(job))
        print(job.level.id, *(each.name for each in job.entrants), f"{len(content)} bytes")
    HOUSE_JUDGED.write_text(json.dumps(judged, indent=1, sort_keys=True) + "\n")


if __name__ == "__main__":
    main()
