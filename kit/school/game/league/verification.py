"""Drives the matches of a league anew with the programs that are entered, and compares them with the results, to the bit."""

from __future__ import annotations

from dataclasses import dataclass

from kit.school.game.league.league import League, LeagueJob, run_league_job
from kit.school.game.shared_drives import digest_of


@dataclass(frozen=True, slots=True)
class Verification:
    """What came of it."""

    compared: int
    differing: tuple[LeagueJob, ...]


def differing_jobs(league: League) -> Verification:
    """Drives every job that has a result again. A result of another platform is passed over: there a drive is the same, but not
    to the bit. Raises LeagueError."""
    confinement = league.programme().confinement
    compared, differing = 0, []
    for job in league.jobs():
        judged = league.judge(job)
        if judged is None or not judged.is_same_platform:
            continue
        compared += 1
        recordings, _ = run_league_job(job, confinement)
        if list(map(digest_of, recordings)) != list(map(digest_of, league.recordings(job))):
            differing.append(job)
    return Verification(compared, tuple(differing))
