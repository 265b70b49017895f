"""What is shown of a league: its standings and its matches."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

from kit.document.blocks import Block, Cell, CellStyle, Column, Table, Text, Tone, ToneText, labelled_table
from kit.plain_text import join_names
from kit.school.game.league.house import SPEEDS
from kit.school.game.league.league import RACE_LIMIT, LeagueJob, Programme
from kit.school.game.league.standings import DRAW, Match, Place, Standings
from kit.school.game.two_players import TAG_RULE

TEXT = CellStyle.TEXT
MOST_OPPONENTS: Final = 4
"""Of an entrant, in the table of its matches by level."""
HOUSE: Final = f"{join_names(tuple(SPEEDS))}, the programs of the house, which have met each other, and whatever others enter."


class LeagueWords(NamedTuple):
    """How a face says what is to be done."""

    enter: str
    opponent: str
    run: str
    watch: str


COMMANDS: Final = LeagueWords(
    "`kit league submit --controller FILE` enters a program of yours, `--agent RUN` an agent that you trained.",
    "Submit with `--keep`, and your former program stays as a rival; or enter another one with `--name OTHER`.",
    "`kit league run`",
    "`kit league replay NUMBER` shows one",
)
KEYS: Final = LeagueWords(
    "e enters one of your programs, or an agent that you trained.",
    "Enter a changed program again, and the former one can stay as a rival.",
    "t",
    "Enter opens an entrant's matches, and replays one",
)


def summary_blocks(standings: Standings, words: LeagueWords = COMMANDS) -> list[Block]:
    """Who is the champion, what is still to be run, and who takes no part."""
    blocks: list[Block] = []
    champion, own = standings.champion, standings.own_places
    if not own or len(standings.places) < 2:
        blocks.append(Text(_who_is_entered(own, has_house=standings.programme.has_house), Tone.BOLD))
        blocks += rules_blocks(standings.programme, words)
    elif standings.unread:
        read = standings.jobs - standings.unread
        text = "This machine judges every drive itself; next time only those that are new."
        blocks.append(Text(text, lead=f"Running the drives again: {read} of {standings.jobs}."))
    elif not standings.matches:
        blocks.append(Text(f"No match has been driven yet. {words.run} drives the matches that are missing."))
    elif len(own) == 1:
        blocks.append(_among_the_house(standings.places, own[0]))
    elif champion is None:
        blocks.append(Text("No match has been won yet."))
    elif standings.is_certain:
        blocks.append(Text(f"{champion.entry.name} is the champion.", Tone.GOOD))
    else:
        second = standings.places[1].entry.name
        text = f"leads; the interval overlaps with that of {second}, so the difference may be chance."
        blocks.append(Text(f"{champion.entry.name} {text}", Tone.GOOD))
    if standings.waiting:
        text = f"{standings.waiting} of {standings.jobs} drives and games are still to be run."
        blocks.append(Text(text, Tone.DIM, is_tight=True))
    blocks += [Text(f"{each.name} takes no part: {each.problem}.", Tone.WARN) for each in standings.refused]
    return blocks


def _who_is_entered(own: Sequence[Place], *, has_house: bool) -> str:
    """Of a league in which nobody meets anybody yet but the programs of the house."""
    if not own and has_house:
        return "Nobody is entered yet; the programs of the house wait for the first."
    alone = f"{own[0].entry.name} alone is entered" if own else "Nobody is entered"
    return f"{alone}{'.' if has_house else ': a league needs two.'}"


def _among_the_house(places: Sequence[Place], own: Place) -> Text:
    """How the only one that is entered stands among the programs of the house."""
    if not _has_played(own):
        return Text(f"No match of {own.entry.name} has been driven yet.")
    house = [each for each in places if each.entry.is_house and _has_played(each)]
    above = [each for each in house if each.rating.points > own.rating.points]
    if not above:
        return Text(f"{own.entry.name} has left the programs of the house behind.", Tone.GOOD)
    gap = above[-1].rating.points - own.rating.points
    return Text(f"{own.entry.name} has {above[-1].entry.name} to beat next, {gap:.0f} points above.")


def _has_played(each: Place) -> bool:
    return each.won + each.drawn + each.lost > 0


def rules_blocks(programme: Programme, words: LeagueWords) -> list[Block]:
    """What the entrants of a league do, and how one enters."""
    races, tag = (
        join_names([level.title for level in levels]) for levels in (programme.races, programme.tag)
    )
    alone = (
        "each entrant drives alone, from five starts; the middle drives are compared. "
        f"A drive ends after {RACE_LIMIT:.0f} times the reference's time."
    )
    together = f"two robots in one world. {TAG_RULE}"
    rules = [
        ("Races", f"{races}: {alone}") if races else None,
        ("Tag", f"{tag}: {together}") if tag else None,
        ("Take part", words.enter),
        ("Opponents", f"{HOUSE} {words.opponent}" if programme.has_house else words.opponent),
        ("Then", f"{words.run} drives the matches; ratings follow from who beat whom. {words.watch}."),
    ]
    return [labelled_table(rule for rule in rules if rule is not None)]


def standings_table(standings: Standings) -> Table:
    """The entrants by rating."""
    has_divisions = any(each.division > 1 for each in standings.places)
    columns = (
        *((Column("division", TEXT),) if has_divisions else ()),
        Column(""),
        Column("", TEXT),
        Column("driver", TEXT, is_optional=True),
        Column("rating", decimals=0),
        Column("95 %", decimals=0),
        Column("won"),
        Column("drawn"),
        Column("lost"),
    )
    count = len(standings.places)
    rows = tuple(
        (*((f"{each.division}",) if has_divisions else ()), *_place_cells(each, count))
        for each in standings.places
    )
    return Table("standings", "", columns, rows, grouped=has_divisions)


def _place_cells(each: Place, count: int) -> tuple[Cell, ...]:
    """``count``: of all places."""
    number = "" if count < 2 or not _has_played(each) else f"{each.number} of {count}"
    name = ToneText(each.entry.name, Tone.BOLD if each.entry.is_mine else Tone.PLAIN)
    rating = each.rating
    points, interval = (rating.points, (rating.low, rating.high)) if _has_played(each) else (None, None)
    driver = each.entry.driver.phrase.removeprefix("by ")
    return number, name, driver, points, interval, each.won, each.drawn, each.lost


def level_grid(standings: Standings, name: str) -> Table:
    """How an entrant has fared against each other one, level by level: ``+`` for a match that it won, ``-`` lost, ``=`` drawn."""
    others = [each.entry.name for each in standings.places if each.entry.name != name]
    signs: dict[tuple[str, str], str] = {}
    for match in standings.matches_of(name):
        is_first = match.entrants[0].name == name
        other = match.entrants[int(is_first)].name
        points = match.points if is_first else 1.0 - match.points
        key = _match_title(match), other
        signs[key] = signs.get(key, "") + ("=" if points == DRAW else "+" if points > DRAW else "-")
    met = [each for each in others if any(other == each for _, other in signs)][:MOST_OPPONENTS]
    rows = tuple(
        (title, *(signs.get((title, other), "") for other in met))
        for title in dict.fromkeys(title for title, _ in signs)
    )
    columns = (Column(f"{name}, level by level", TEXT), *(Column(each, TEXT) for each in met))
    return Table("levels", "", columns, rows, is_ruled=False)


def _match_title(match: Match) -> str:
    return f"{'tag' if match.is_tag else 'race'}, {match.level.title}"


def job_title(job: LeagueJob) -> str:
    """What is driven, where, and by whom."""
    what = "tag" if job.is_tag else "race"
    return f"{what}, {job.level.title}: {' against '.join(each.name for each in job.entrants)}"


def match_sentence(match: Match) -> str:
    """What a match was and how it ended."""
    what = "Tag" if match.is_tag else "Race"
    names = " against ".join(each.name for each in match.entrants)
    return f"{what}, {match.level.title}: {names}. {result_sentence(match)}"


def result_sentence(match: Match) -> str:
    """Who won a match, and by what."""
    gap = " " if match.by.startswith("by ") else ": "
    ended = "Draw" if match.winner is None else f"{match.winner.name} won{gap}{match.by}"
    did = "; ".join(
        f"{entry.name}: {detail}" for entry, detail in zip(match.entrants, match.details, strict=True)
    )
    return f"{ended} ({did})."


def matches_table(matches: Sequence[Match], name: str | None = None) -> Table:
    """Matches with a number each, from 1; ``name``: only those of this entrant, whose name is not told in every row."""
    columns = (
        *(Column("", TEXT) for _ in range(5 if name is None else 4)),
        Column("", TEXT, is_optional=True),
        Column("first did" if name is None else f"{name} did", TEXT, is_optional=True),
        Column("second did" if name is None else "the other did", TEXT, is_optional=True),
    )
    rows = tuple(
        _match_cells(number, match, name)
        for number, match in enumerate(matches, 1)
        if name is None or name in (each.name for each in match.entrants)
    )
    return Table("matches", "", columns, rows)


def _match_cells(number: int, match: Match, name: str | None) -> tuple[Cell, ...]:
    (first, second), details, points = match.entrants, match.details, match.points
    if second.name == name:
        first, second, details, points = second, first, details[::-1], 1.0 - points
    word, tone = ("beat", Tone.GOOD) if points > DRAW else ("lost to", Tone.WARN)
    elsewhere = "" if match.is_same_platform else " (another machine)"
    return (
        f"{number}",
        _match_title(match),
        *((first.name,) if name is None else ()),
        ToneText("drew with", Tone.PLAIN) if points == DRAW else ToneText(word, tone),
        second.name,
        match.by,
        *(f"{detail}{elsewhere}" for detail in details),
    )
