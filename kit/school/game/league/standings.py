"""The standings of a league: the matches that were driven, what each was worth, ratings, divisions and the champion."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Final

import numpy as np

from kit.run.recording import Recording
from kit.school.game.league.entries import Entry
from kit.school.game.league.league import (
    JudgedJob,
    League,
    LeagueJob,
    Programme,
    drive_job,
    tag_job,
)
from kit.school.game.league.ratings import Rating, rate
from kit.school.game.league.tag_game import tag_again
from kit.school.game.levels import GameLevel
from kit.school.game.race import finish_order, middle_drive
from kit.school.game.starts import OWN_SEED
from kit.school.game.two_players import SharedGameState
from kit.sim.simulation import STEP_SIZE_S

DIVISION_SIZE: Final = 6
"""Entrants of each division but the last."""
DRAW: Final = 0.5
PROGRESS_S: Final = 0.3
"""Between two standings while results are read [s]."""


@dataclass(frozen=True, slots=True, eq=False)
class Match:
    """One meeting of two entrants that has been driven."""

    level: GameLevel
    is_tag: bool
    entrants: tuple[Entry, Entry]
    """At tag the first began as the catcher."""
    points: float
    """Of the first: 1 it won, 0 it lost, 0.5 a draw."""
    by: str
    """What decided it, such as ``by 0.52 s``; empty for a draw."""
    details: tuple[str, str]
    """What each did, in words."""
    jobs: tuple[LeagueJob, ...]
    """Of a race each one's drives, of tag their game."""
    is_same_platform: bool
    """Whether all of it was driven on a machine like this one, and so is the same to the bit."""

    @property
    def winner(self) -> Entry | None:
        return None if self.points == DRAW else self.entrants[int(self.points < DRAW)]


@dataclass(frozen=True, slots=True)
class Place:
    """One entrant's place."""

    entry: Entry
    rating: Rating
    won: int
    drawn: int
    lost: int
    number: int
    """Its place, from 1."""
    division: int
    """From 1."""


@dataclass(frozen=True, slots=True, eq=False)
class Standings:
    """A league as it stands."""

    title: str
    places: tuple[Place, ...]
    """By rating, best first."""
    matches: tuple[Match, ...]
    jobs: int
    """Drives and games that all entrants owe."""
    waiting: int
    """Those that are still to be run."""
    unread: int
    """Those whose results have not been looked at yet."""
    refused: tuple[Entry, ...]
    """Entries that take no part."""
    programme: Programme
    """What all of them do."""

    @property
    def own_places(self) -> list[Place]:
        """Those of the entrants that are not of the house."""
        return [each for each in self.places if not each.entry.is_house]

    @property
    def champion(self) -> Place | None:
        """The best that is not of the house; None while it has won no match, or fewer than two are entered."""
        own = self.own_places
        return own[0] if len(own) > 1 and own[0].won else None

    @property
    def is_certain(self) -> bool:
        """Whether the champion's interval lies above that of the next."""
        own = self.own_places
        return len(own) > 1 and own[0].rating.low > own[1].rating.high

    def matches_of(self, name: str) -> list[Match]:
        return [each for each in self.matches if name in (entry.name for entry in each.entrants)]


def read_standings(
    league: League, on_progress: Callable[[Standings], object] = lambda standings: None
) -> Standings:
    """Runs the recordings of a league that were not judged before again, in processes of their own, and judges them: about a
    second for each. ``on_progress``: gets the standings so far, at once and then as the results are read; what it raises ends
    the reading. Raises LeagueError and OSError."""
    programme, entries, jobs = league.programme(), league.entries(), league.jobs()
    judged: dict[str, JudgedJob | None] = {}
    told_s = -math.inf

    def tell(key: str = "") -> None:
        nonlocal told_s
        if time.monotonic() - told_s >= PROGRESS_S:
            on_progress(_standings_of(programme, entries, jobs, judged))
            told_s = time.monotonic()

    def take(key: str) -> None:
        judged[key] = league.judge(by_key[key])
        tell()

    by_key = {job.key: job for job in jobs}
    unjudged = league.unjudged()
    tell()
    for key in by_key:
        if key not in unjudged:
            take(key)
    league.judge_apart([key for key in by_key if key in unjudged], take)
    return _standings_of(programme, entries, jobs, judged)


def _standings_of(
    programme: Programme,
    entries: Sequence[Entry],
    jobs: Sequence[LeagueJob],
    judged: Mapping[str, JudgedJob | None],
) -> Standings:
    """The standings by the jobs that have been judged; None: they have not been run."""
    entrants = [each for each in entries if not each.problem]
    matches = []
    for first, second in combinations(entrants, 2):
        for level in programme.races:
            drives = drive_job(level, first), drive_job(level, second)
            one, other = (judged.get(drive.key) for drive in drives)
            if one is not None and other is not None:
                matches.append(race_match(drives, (one, other)))
        for level in programme.tag:
            for pair in ((first, second), (second, first)):
                job = tag_job(level, *pair)
                game = judged.get(job.key)
                if game is not None:
                    matches.append(tag_match(job, game))
    if not jobs and all(each.is_house for each in entrants):  # it waits for somebody
        entrants = [each for each in entrants if not each.is_house]
    return Standings(
        programme.title,
        _rank_entrants(entrants, matches),
        tuple(matches),
        len(jobs),
        sum(judged.get(job.key, job) is None for job in jobs),
        sum(job.key not in judged for job in jobs),
        tuple(each for each in entries if each.problem),
        programme,
    )


@dataclass(frozen=True, slots=True, eq=False)
class MatchFilm:
    """A match, to be looked at."""

    recordings: tuple[Recording, ...]
    """Of a race the two drives from the level's own start, the only one that both have; of tag the game."""
    states: tuple[SharedGameState, ...] = ()
    """Of tag: how it stood, every ``TOLD_TICKS`` ticks."""


def match_film(league: League, match: Match, on_job: Callable[[], object] = lambda: None) -> MatchFilm:
    """Runs the recordings of a match again. ``on_job``: called before each of its jobs; what it raises ends this. Raises
    LeagueError."""
    recordings: list[Recording] = []
    for job in match.jobs:
        on_job()
        recordings += [each for each in league.recordings(job) if each.seed == OWN_SEED]
    states: list[SharedGameState] = []
    if match.is_tag:
        tag_again(match.level, recordings[0], states.append)
    return MatchFilm(tuple(recordings), tuple(states))


def race_match(jobs: tuple[LeagueJob, LeagueJob], judged: tuple[JudgedJob, JudgedJob]) -> Match:
    """Compares two entrants' middle drives: at the goal, without a bump, soon. Less than a tick apart is a draw. Of two that
    do not arrive, the one whose program has failed has lost; otherwise it is a draw."""
    orders, details = [], []
    for each in judged:
        number = middle_drive(each.finishes)
        finish, remark = each.finishes[number], each.remarks[number] if each.remarks else ""
        if finish.reached:
            bumps = ", with a bump" if finish.collisions else ""
            orders.append(finish_order(finish))
            details.append(f"{finish.seconds:.2f} s{bumps}")
        else:
            orders.append((True, bool(remark), 0.0))
            details.append(remark or finish.foul or "did not arrive")
    first, second = orders
    is_draw = first[:2] == second[:2] and abs(first[2] - second[2]) < STEP_SIZE_S
    points = DRAW if is_draw else float(first < second)
    if is_draw:
        by = ""
    elif first[0] != second[0]:
        by = "only the winner arrived"
    elif first[0]:
        by = "the other's program failed"
    else:
        by = (
            f"by {abs(first[2] - second[2]):.2f} s"
            if first[1] == second[1]
            else "only the winner had no bump"
        )
    entrants = jobs[0].entrants[0], jobs[1].entrants[0]
    is_same = all(each.is_same_platform for each in judged)
    return Match(jobs[0].level, False, entrants, points, by, (details[0], details[1]), jobs, is_same)


def tag_match(job: LeagueJob, game: JudgedJob) -> Match:
    """Who has less time against it wins. Whose program has failed has lost, whatever the time says."""
    first_failed, second_failed = (bool(each) for each in (*game.remarks, "", "")[:2])
    if first_failed != second_failed:
        points = float(second_failed)
    elif first_failed or game.winner is None:
        points = DRAW
    else:
        points = float(game.winner == 0)
    by = f"by {abs(game.scores[0] - game.scores[1]):.1f} s"
    if first_failed != second_failed:
        by = "the other's program failed"
    remarks = (*game.remarks, "", "")
    details = [
        remark or f"{seconds:.1f} s penalty" for remark, seconds in zip(remarks, game.scores, strict=False)
    ]
    entrants = job.entrants[0], job.entrants[1]
    told = "" if points == DRAW else by
    return Match(
        job.level, True, entrants, points, told, (details[0], details[1]), (job,), game.is_same_platform
    )


def _rank_entrants(entrants: Sequence[Entry], matches: Sequence[Match]) -> tuple[Place, ...]:
    numbers = {each.name: number for number, each in enumerate(entrants)}
    points = np.zeros((len(entrants), len(entrants)))
    counts = np.zeros((len(entrants), 3), dtype=int)
    for match in matches:
        first, second = (numbers[each.name] for each in match.entrants)
        points[first, second] += match.points
        points[second, first] += 1.0 - match.points
        result = 1 if match.points == DRAW else 0 if match.points > DRAW else 2
        counts[first, result] += 1
        counts[second, 2 - result] += 1
    rated = sorted(
        zip(entrants, rate(points), counts.tolist(), strict=True),
        key=lambda each: (-round(each[1].points, 6), each[0].name),
    )
    places, above = [], 0
    for number, (entry, rating, (won, drawn, lost)) in enumerate(rated, 1):
        division = 1 + above // DIVISION_SIZE
        above += not entry.is_house
        places.append(Place(entry, rating, won, drawn, lost, number, division))
    return tuple(places)
