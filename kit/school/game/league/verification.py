"""Drives the matches of a league anew with the programs that are entered, and compares them with the results, to the bit."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from kit.run.recording import Recording
from kit.school.game.league.league import League, LeagueJob, run_league_job
from kit.school.game.shared_drives import digest_of


@dataclass(frozen=True, slots=True)
class Verification:
    """What came of it."""

    compared: int
    differing: tuple[LeagueJob, ...]
    """Those whose programs drive something other than the result shows."""
    unrepeatable: tuple[LeagueJob, ...]
    """Those whose programs drive something else each time."""


def differing_jobs(league: League, on_done: Callable[[str], object] = lambda key: None) -> Verification:
    """Drives every job that has a result again, and those that differ once more. A result of another platform is passed over: there a drive is the same, but not
    to the bit. ``on_done``: is called with the key of each job that is through. Raises LeagueError."""
    confinement = league.programme().confinement
    compared = 0
    differing: list[LeagueJob] = []
    unrepeatable: list[LeagueJob] = []
    for job in league.jobs():
        judged = league.judge(job)
        if judged is not None and judged.is_same_platform:
            compared += 1
            driven = _digests(run_league_job(job, confinement)[0])
            if driven != _digests(league.recordings(job)):
                is_same_again = driven == _digests(run_league_job(job, confinement)[0])
                (differing if is_same_again else unrepeatable).append(job)
        on_done(job.key)
    return Verification(compared, tuple(differing), tuple(unrepeatable))


def _digests(recordings: Sequence[Recording]) -> list[str]:
    return list(map(digest_of, recordings))
