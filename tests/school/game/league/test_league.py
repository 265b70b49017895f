"""The league: who meets whom, what a match is worth, and what counts for nothing: cheats, crashes, a clock that was set back."""

from __future__ import annotations

import io
import json
import os
import shutil
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from kit.controllers import kit_controllers
from kit.document.layout import lines_of
from kit.host.sandbox.sandbox_config import Level
from kit.learning.policies.policy_node_text import constant_names, node_text
from kit.run.recording import Recording
from kit.school.game.league import entries as entries_module
from kit.school.game.league import league as league_module
from kit.school.game.league.entries import (
    HOLDERS,
    MAX_BYTES,
    MAX_OF_ONE_USER,
    Entry,
    LeagueError,
    read_entries,
    record_holders,
    renew_beside_former,
    submit,
    withdraw,
)
from kit.school.game.league.house import PROGRAM as HOUSE_PROGRAM
from kit.school.game.league.house import house_programs
from kit.school.game.league.league import (
    HOUSE_RESULTS,
    JudgedJob,
    League,
    LeagueJob,
    drive_job,
    house_judgements,
    own_league,
    read_programme,
    run_league_job,
    seconds_left,
    tag_job,
)
from kit.school.game.league.league_blocks import matches_table, standings_table, summary_blocks
from kit.school.game.league.standings import (
    DRAW,
    Match,
    Standings,
    match_film,
    race_match,
    read_standings,
)
from kit.school.game.league.tag_game import play_tag, tag_again, tag_scenario
from kit.school.game.league.verification import differing_jobs
from kit.school.game.levels import find_level
from kit.school.game.race import DriverKind, RaceFinish, middle_drive, race_controller
from kit.school.game.references import reference_seconds
from kit.school.game.shared_drives import digest_of, share_drives
from kit.school.game.shared_sockets import user_name
from kit.school.game.starts import OWN_SEED, STARTS
from kit.school.game.two_players import TAG_SECONDS
from kit.workspace import open_workspace
from tests.school.game.league.house_results import house_jobs, house_judgement

LEVEL = find_level("first-drive")
ARENA = find_level("two-doors")
CONTROLLER = DriverKind.PROGRAM
LASER = HOUSE_PROGRAM.read_bytes() + b"\nown = True\n"

FRAME = """
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import PoseStamped, Twist
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool

class Player(Node):
    def __init__(self):
        super().__init__("player")
        self.drive = self.create_publisher(Twist, "cmd_vel", 1)
        self.begin()

    def go(self, linear, angular=0.0):
        command = Twist()
        command.linear.x, command.angular.z = linear, angular
        self.drive.publish(command)
{body}

rclpy.init()
rclpy.spin(Player())
"""
STANDS = FRAME.format(body="\n    def begin(self):\n        pass\n").encode()
CHASES = FRAME.format(
    body="""
    def begin(self):
        self.catches, self.pose, self.other = False, None, None
        from nav_msgs.msg import Odometry
        self.create_subscription(Bool, "is_catcher", self.told, 1)
        self.create_subscription(Odometry, "odom", self.here, 1)
        self.create_subscription(PoseStamped, "goal_pose", self.there, 1)

    def told(self, message):
        self.catches = message.data

    def here(self, message):
        self.pose = message.pose.pose

    def there(self, message):
        import math
        other = message.pose.position
        if self.pose is None or not self.catches:
            return self.go(-0.3)
        at, turned = self.pose.position, self.pose.orientation
        heading = math.atan2(other.y - at.y, other.x - at.x) - 2.0 * math.atan2(turned.z, turned.w)
        self.go(0.3, 3.0 * math.remainder(heading, math.tau))
"""
).encode()
CRASHES = b"raise RuntimeError('no')\n"
GIVES_UP = FRAME.format(
    body="""
    def begin(self):
        self.create_timer(0.5, self.end)

    def end(self):
        raise RuntimeError("enough")
"""
).encode()
"""Does not arrive, and needs less time for it than one that stands to the end."""


def make_league(
    folder: Path, *, races: bool = True, tag: bool = False, house: bool = False, **programs: bytes
) -> League:
    league = League.make(folder / "league", "Ours", [LEVEL.id] if races else [], [ARENA.id] if tag else [])
    league.change(replace(league.programme(), confinement=Level.LIMITED, has_house=house))
    for name, program in programs.items():
        submit(league.folder, name, program)
    return league


@pytest.fixture(scope="module")
def driven_once(tmp_path_factory: pytest.TempPathFactory) -> League:
    """Of one who arrives and one who does not."""
    league = make_league(tmp_path_factory.mktemp("driven"), laser=LASER, stands=GIVES_UP)
    run(league)
    return league


@pytest.fixture
def driven(driven_once: League, tmp_path: Path) -> League:
    """The same, for a test to change."""
    return League(Path(shutil.copytree(driven_once.folder, tmp_path / "league")))


def run(league: League) -> Standings:
    """Drives what is missing in this process."""
    for key in league.waiting():
        league.run_job(key)
    return read_standings(league)


def names(standings: Standings) -> list[str]:
    return [each.entry.name for each in standings.places]


@pytest.mark.long
def test_all_meet_all_and_the_best_is_champion(tmp_path: Path) -> None:
    league = make_league(tmp_path, laser=LASER, stands=GIVES_UP, crashes=CRASHES)
    assert len(league.waiting()) == 3
    standings = run(league)
    assert (standings.waiting, len(standings.matches)) == (0, 3)
    assert standings.champion is not None
    assert standings.champion.entry.name == "laser"
    assert (standings.champion.won, standings.champion.lost) == (2, 0)
    by_pair = {tuple(sorted(entry.name for entry in each.entrants)): each for each in standings.matches}
    assert by_pair["crashes", "stands"].points == DRAW  # neither arrives, and both have failed
    assert "RuntimeError" in " ".join(by_pair["crashes", "laser"].details)
    assert len(standings_table(standings).rows) == 3
    assert sum(each.rating.points for each in standings.places) == pytest.approx(3 * 1500.0)


@pytest.mark.long
def test_a_program_that_does_not_start_is_started_once_for_each_level(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One that waits for ever would take two minutes of the owner's time from each of five starts."""
    started: list[int] = []

    def race(*args: Any, seed: int, **options: Any) -> tuple[RaceFinish, Recording]:
        started.append(seed)
        return race_controller(*args, seed=seed, **options)

    monkeypatch.setattr(league_module, "race_controller", race)
    league = make_league(tmp_path, laser=LASER, crashes=CRASHES)
    job = next(each for each in league.jobs() if each.entrants[0].name == "crashes")
    league.run_job(job.key)
    assert started == [OWN_SEED]
    judged = league.judge(job)
    assert judged is not None
    assert len(judged.finishes) == STARTS
    assert all("RuntimeError" in each for each in judged.remarks)


@pytest.mark.long
def test_who_has_not_arrived_three_times_is_spared_the_other_two_drives(tmp_path: Path) -> None:
    """The middle drive has not arrived either way; and no drive takes much longer than the reference does."""
    league = make_league(tmp_path, laser=LASER, stands=STANDS)
    league.change(replace(league.programme(), races=(find_level("parking"),)))
    (level,) = league.programme().races
    reference = reference_seconds(level)
    assert reference is not None
    assert level.time_limit < 6 * reference
    job = next(each for each in league.jobs() if each.entrants[0].name == "stands")
    league.run_job(job.key)
    judged = league.judge(job)
    assert judged is not None
    driven = [each.seconds for each in judged.finishes if each.seconds]
    assert driven == pytest.approx([level.time_limit] * 3)
    assert len(judged.finishes) == STARTS
    assert not judged.finishes[middle_drive(judged.finishes)].reached
    assert any(each.ticks for each in league.recordings(job) if each.seed == OWN_SEED), "that it can be shown"
    found = differing_jobs(league)
    assert (found.compared, found.differing) == (1, ())


@pytest.mark.long
def test_two_play_tag_in_one_world_and_each_begins_once(tmp_path: Path) -> None:
    league = make_league(tmp_path, races=False, tag=True, chases=CHASES, stands=STANDS)
    standings = run(league)
    assert [each.is_tag for each in standings.matches] == [True, True]
    assert {each.entrants[0].name for each in standings.matches} == {"chases", "stands"}
    assert names(standings) == ["chases", "stands"]
    assert all(each.winner is not None and each.winner.name == "chases" for each in standings.matches)
    film = match_film(league, standings.matches[0])
    (recording,) = film.recordings
    assert film.states[-1].scores == pytest.approx(
        league.judge(standings.matches[0].jobs[0]).scores, abs=0.2
    ), "how it stood, to the end"
    assert recording.ticks * recording.step_size == pytest.approx(TAG_SECONDS)
    assert all(len(recording.track(robot)) for robot in tag_scenario(ARENA).drivers)


def test_a_replay_shows_both_drives_of_a_race_from_one_start(driven: League) -> None:
    (match,) = read_standings(driven).matches
    drives = match_film(driven, match).recordings
    assert len(drives) == 2
    assert drives[0].seed == drives[1].seed
    assert any(each.inputs for each in drives), "so that the robot drives again"
    assert match.winner is not None
    assert match.by in " ".join(lines_of([matches_table([match])]))


def test_the_standings_are_told_while_the_drives_are_run_again(driven: League) -> None:
    told: list[Standings] = []
    last = read_standings(driven, told.append)
    assert (told[0].unread, told[0].waiting, told[0].jobs) == (2, 0, 2)
    assert sorted(names(told[0])) == ["laser", "stands"]
    assert "0 of 2" in " ".join(lines_of(summary_blocks(told[0])))
    assert (last.unread, len(last.matches)) == (0, 1)

    def leave(standings: Standings) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        read_standings(driven, leave)


def test_a_lone_entrant_drives_nothing_and_nobody_is_champion(tmp_path: Path) -> None:
    league = make_league(tmp_path)
    for count in range(2):
        standings = read_standings(league)
        assert (league.waiting(), len(standings.places), standings.champion) == ((), count, None)
        told = " ".join(lines_of(summary_blocks(standings)))
        levels = (*standings.programme.races, *standings.programme.tag)
        assert all(level.title in told for level in levels)
        assert "kit league submit" in told
        submit(league.folder, "laser", LASER)


def test_anothers_entry_is_withdrawn_by_nobody_and_told_as_such(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    league = make_league(tmp_path, laser=LASER)
    own = os.getuid()

    def refuse(self: Path, missing_ok: bool = False) -> None:
        raise PermissionError(1, "Operation not permitted", str(self))

    monkeypatch.setattr(Path, "unlink", refuse)
    monkeypatch.setattr(os, "getuid", lambda: own + 1)
    with pytest.raises(LeagueError, match=f"an entry of {user_name(own)}"):
        withdraw(league.folder, "laser")


def test_who_withdraws_takes_the_matches_along_and_a_new_program_drives_anew(driven: League) -> None:
    league = driven
    submit(league.folder, "crashes", CRASHES)
    assert len(run(league).matches) == 3
    withdraw(league.folder, "crashes")
    standings = read_standings(league)
    assert (names(standings), len(standings.matches), standings.waiting) == (["laser", "stands"], 1, 0)
    league.remove_stale_results()
    assert len(list((league.folder / "results").iterdir())) == 2
    submit(league.folder, "stands", GIVES_UP + b"again = True\n")
    assert len(league.waiting()) == 1
    assert read_standings(league).matches == ()
    with pytest.raises(LeagueError):
        withdraw(league.folder, "crashes")


def test_a_former_program_stays_as_a_rival(tmp_path: Path) -> None:
    league = make_league(tmp_path, laser=LASER)
    assert renew_beside_former(league.folder, "laser", LASER + b"second = True\n") == "laser-1"
    assert renew_beside_former(league.folder, "laser", LASER + b"third = True\n") == "laser-2"
    programs = {each.name: each.file.read_bytes() for each in league.entrants()}
    assert programs == {
        "laser": LASER + b"third = True\n",
        "laser-1": LASER,
        "laser-2": LASER + b"second = True\n",
    }
    with pytest.raises(LeagueError):
        renew_beside_former(league.folder, "nobody", LASER)


def test_a_clock_that_was_set_back_changes_nothing(driven: League) -> None:
    league = driven
    before = standings_table(read_standings(league))
    for file in league.folder.rglob("*"):
        os.utime(file, (0, 0))
    assert standings_table(read_standings(league)) == before
    assert league.waiting() == ()


def test_what_was_judged_is_kept_for_the_next_look_and_damage_of_it_is_passed_over(
    driven: League, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Others are judged in processes of their own: this one has a screen to draw."""
    league = League(driven.folder, tmp_path / "judged")
    with monkeypatch.context() as patched:
        patched.setattr(league_module, "judge_result", lambda *told: pytest.fail("judged here"))
        assert len(league.unjudged()) == 2
        before = standings_table(read_standings(league))
        assert league.unjudged() == []
        league_module._judge_once.cache_clear()
        assert standings_table(read_standings(league)) == before
    assert standings_table(read_standings(driven)) == before
    (first, *_) = (tmp_path / "judged").iterdir()
    league_module._judge_once.cache_clear()
    first.write_text('{"judged": {"finishes": 3}}')
    assert standings_table(read_standings(league)) == before


def test_who_runs_a_match_has_judged_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made = make_league(tmp_path, crashes=CRASHES, laser=LASER)
    league = League(made.folder, tmp_path / "judged")
    job = next(each for each in league.jobs() if each.entrants[0].name == "crashes")
    league.run_job(job.key)
    league_module._judge_once.cache_clear()
    monkeypatch.setattr(league_module, "judge_result", lambda *told: pytest.fail("judged again"))
    assert league.unjudged() == []
    assert league.judge(job) is not None


def test_short_races_are_driven_first_and_what_is_left_is_told_by_their_length(tmp_path: Path) -> None:
    league = League.make(tmp_path / "league", "Ours", ["racetrack", "parking"], [ARENA.id])
    submit(league.folder, "laser", LASER)
    jobs = league.jobs()
    lengths = [each.expected_s for each in jobs]
    assert lengths == sorted(lengths)
    assert {each.level.id for each in jobs[:4]} == {"parking"}
    assert len({each.entrants for each in jobs[:4]}) == 4, "so that all have met on one level"
    done = [each.key for each in jobs[:4]]
    assert seconds_left(jobs, [], 1.0) is None
    assert seconds_left(jobs, done, 1.0) == pytest.approx(
        (sum(lengths) - sum(lengths[:4])) / sum(lengths[:4])
    )
    assert seconds_left(jobs, [each.key for each in jobs], 1.0) == 0.0


def test_a_film_that_nobody_waits_for_runs_nothing_more(
    driven: League, monkeypatch: pytest.MonkeyPatch
) -> None:
    (match,) = read_standings(driven).matches
    left = [False]
    rerun = league_module._rerun

    def leave_meanwhile(*told: Any) -> Any:
        assert not left[0], "it was left before"
        left[0] = True
        return rerun(*told)

    def end_if_left() -> None:
        if left[0]:
            raise KeyboardInterrupt

    monkeypatch.setattr(league_module, "_rerun", leave_meanwhile)
    with pytest.raises(KeyboardInterrupt):
        match_film(driven, match, end_if_left)
    assert left[0]


def test_divisions_hold_six_each(tmp_path: Path) -> None:
    programs = {f"stands{number}": STANDS + b"number = %d\n" % number for number in range(1, 9)}
    standings = read_standings(make_league(tmp_path, **programs))
    assert [each.division for each in standings.places] == [1] * 6 + [2] * 2
    assert standings_table(standings).grouped


@pytest.mark.parametrize(
    "content",
    [
        b"{",
        b"[]",
        b"{}",
        b'{"title": "x", "races": [], "tag": [], "confinement": 1, "house": true}',
        b'{"title": "x", "races": ["nowhere"], "tag": [], "confinement": 1, "house": true}',
        b'{"title": "x", "races": [], "tag": ["crossing"], "confinement": 1, "house": true}',
        b'{"title": "x", "races": ["parking"], "tag": [], "confinement": 9, "house": true}',
        b'{"title": "x", "races": ["parking"], "tag": [], "confinement": 1}',
    ],
)
def test_a_damaged_league_says_what_is_wrong(tmp_path: Path, content: bytes) -> None:
    with pytest.raises(LeagueError, match=r"league\.json"):
        read_programme(content, tmp_path)


def test_no_league_or_a_second_one_is_refused(tmp_path: Path) -> None:
    with pytest.raises(LeagueError):
        League(tmp_path).programme()
    with pytest.raises(LeagueError):
        submit(tmp_path, "laser", LASER)
    make_league(tmp_path)
    with pytest.raises(LeagueError):
        make_league(tmp_path)
    own = own_league(open_workspace(tmp_path / "home"))
    assert own.is_mine
    assert own_league(open_workspace(tmp_path / "home")) == own


# The house


@pytest.mark.long
def test_the_first_entrant_meets_the_house_which_wins_no_title(tmp_path: Path) -> None:
    league = make_league(tmp_path, house=True)
    assert (league.waiting(), read_standings(league).places) == ((), ()), "the house waits"
    submit(league.folder, "laser", LASER)
    standings = run(league)
    count = len(house_programs())
    assert len(standings.matches_of("laser")) == count
    assert len(standings.matches) == count + count * (count - 1) // 2, "they have met each other too"
    (own,) = standings.own_places
    assert (own.entry.name, standings.champion) == ("laser", None)
    assert standings.places[own.number - 1] is own
    assert [str(each[0]) for each in standings_table(standings).rows] == [f"{n} of 4" for n in range(1, 5)]
    order = [each.entry.name.removesuffix(" (house)") for each in standings.places if each.entry.is_house]
    assert order[0] == "quick"
    assert set(order) == set(house_programs())
    submit(league.folder, "stands", GIVES_UP)
    champion = run(league).champion
    assert champion is not None
    assert champion.entry.name == "laser", "whatever the house drives"
    league.change(replace(league.programme(), has_house=False))
    assert len(read_standings(league).matches) == 1


def test_what_the_house_drives_comes_with_the_kit_for_a_new_league() -> None:
    keys = {each.key for each in house_jobs()}
    assert {each.stem for each in HOUSE_RESULTS.glob("*.npz")} == keys
    assert house_judgements().keys() == keys


@pytest.mark.long
def test_in_a_new_league_the_house_has_a_table_that_its_recordings_give_again(tmp_path: Path) -> None:
    league = own_league(open_workspace(tmp_path / "home"))
    assert not league.waiting()
    standings = read_standings(league)
    assert [each.entry.name for each in standings.places] == [
        f"{n} (house)" for n in ("quick", "steady", "slow")
    ]
    assert [each.number for each in standings.places] == [1, 2, 3]
    assert standings.champion is None
    assert not standings.waiting
    told = " ".join(lines_of(summary_blocks(standings)))
    assert "Nobody is entered" in told
    for job in house_jobs():
        assert house_judgement(job) == house_judgements()[job.key]
        if job.level.id == "parking":
            driven = run_league_job(job, Level(0))[0]
            assert list(map(digest_of, driven)) == list(map(digest_of, league.recordings(job)))


# Cheats: entries

EntryCheat = Callable[[League], None]
CLOCK_STEP_S = 0.02
"""What is written so much later has a later time in every file system that the tests use."""


def copy_of_the_kits_own(league: League) -> None:
    shipped = kit_controllers()[0].file
    shutil.copy(shipped, league.folder / "entries" / "mine.py")


def copy_of_the_kits_own_with_a_comment(league: League) -> None:
    shipped = kit_controllers()[0].file.read_bytes()
    (league.folder / "entries" / "mine.py").write_bytes(shipped + b"\n# all mine\n")


def copy_of_the_house(league: League) -> None:
    (league.folder / "entries" / "mine.py").write_bytes(house_programs()["slow"] + b"\n# all mine\n")


def anothers_program_in_another_layout(league: League) -> None:
    program = b'"""All mine."""\n' + LASER.replace(b"\n\n", b"\n\n\n# mine\n")
    (league.folder / "entries" / "mine.py").write_bytes(program)


def anothers_program_again(league: League) -> None:
    (league.folder / "entries" / "mine.py").write_bytes(LASER)


def anothers_program_under_an_earlier_name(league: League) -> None:
    (league.folder / "entries" / "aaa.py").write_bytes(LASER)


def link_to_anothers_program(league: League) -> None:
    (league.folder / "entries" / "mine.py").symlink_to("laser.py")


def name_in_capitals(league: League) -> None:
    (league.folder / "entries" / "LASER.py").write_bytes(LASER + b"number = 1\n")


def program_that_fills_the_disk(league: League) -> None:
    (league.folder / "entries" / "mine.py").write_bytes(b"#" * (MAX_BYTES[CONTROLLER] + 1))


@pytest.mark.parametrize(
    "cheat",
    [
        copy_of_the_kits_own,
        copy_of_the_kits_own_with_a_comment,
        copy_of_the_house,
        anothers_program_in_another_layout,
        anothers_program_again,
        anothers_program_under_an_earlier_name,
        link_to_anothers_program,
        name_in_capitals,
        program_that_fills_the_disk,
    ],
    ids=lambda each: each.__name__,
)
def test_what_is_nobodys_own_program_takes_no_part(tmp_path: Path, cheat: EntryCheat) -> None:
    league = make_league(tmp_path, laser=LASER, stands=GIVES_UP)
    honest = read_entries(league.folder)
    time.sleep(CLOCK_STEP_S)
    cheat(league)
    entries = read_entries(league.folder)
    assert len(entries) == 3
    assert len(league.entrants()) == 2
    assert [each for each in entries if not each.problem] == list(honest)


def test_many_files_push_nobody_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    league = make_league(tmp_path, laser=LASER, stands=GIVES_UP)
    honest = read_entries(league.folder)
    monkeypatch.setattr(entries_module, "MAX_ENTRIES", 4)
    time.sleep(CLOCK_STEP_S)
    for number in range(10):
        file = league.folder / "entries" / f"a{number}.py"
        file.write_bytes(LASER + b"number = %d\n" % number)
        os.utime(file, (0, 0))
    entries = read_entries(league.folder)
    assert len(entries) == 4
    assert set(honest) <= set(entries)


def test_a_link_that_another_user_has_put_there_leads_to_no_file_of_ones_own(tmp_path: Path) -> None:
    league, precious = make_league(tmp_path), tmp_path / "precious"
    precious.write_bytes(b"mine")
    file = league.folder / "entries" / "ada.py"
    file.symlink_to(precious)
    assert submit(league.folder, "ada", LASER) == file
    assert precious.read_bytes() == b"mine"
    assert not file.is_symlink()


def agents_node(title: str = "turn, 5,000 steps") -> bytes:
    """The node of an agent that has learned nothing."""
    constants = {**dict.fromkeys(constant_names(), 0), "TRAINED_ON": title}
    return node_text("".join(f"{name} = {value!r}\n" for name, value in constants.items()), None).encode()


def test_an_agent_is_who_has_the_kits_node_of_one(tmp_path: Path) -> None:
    node = agents_node()
    own = node.replace(b"    def stop(self)", b"    def stop_now(self)")
    learned = node.replace(b"TARGETS = 0\n", b"TARGETS = open('targets').read()\n")
    besides = node.replace(b"TARGETS = 0\n", b"TARGETS = 0\nimport laser\n")
    assert node not in (own, learned, besides)
    league = make_league(
        tmp_path, agent=node, laser=LASER, own=own, learned=learned, besides=besides, mark=node + b"\nx = 1\n"
    )
    for name in ("laser.agent.py", "agent.controller.py"):  # a name says nothing
        (league.folder / "entries" / name).write_bytes(LASER + b"number = 1\n")
    drivers = {each.name: each.driver for each in league.entrants()}
    assert drivers == {
        "agent": DriverKind.AGENT,
        **dict.fromkeys(("laser", "own", "learned", "besides", "mark"), CONTROLLER),
    }
    with pytest.raises(LeagueError, match="the same program"):
        submit(league.folder, "mine", agents_node("mine, 1 step"))


ANOTHER, THIRD = 60001, 60002


def enter_as(user: int, league: League, name: str, program: bytes) -> Path:
    file = league.folder / "entries" / name
    file.write_bytes(program)
    os.chown(file, user, -1)
    return file


@pytest.mark.skipif(os.geteuid() != 0, reason="files of other users")
def test_who_renews_an_entry_keeps_its_name(tmp_path: Path) -> None:
    name = "Ada.py"
    league = make_league(tmp_path, ada=LASER, bob=GIVES_UP)
    record_holders(league.folder)
    enter_as(ANOTHER, league, name, LASER + b"number = 1\n")
    time.sleep(CLOCK_STEP_S)
    submit(league.folder, "ada", LASER + b"better = True\n")
    (ada,) = (each for each in league.entrants() if each.name.casefold() == "ada")
    assert (ada.user, ada.file.name) == (os.getuid(), "ada.py")
    for forged in (b"[" * 9000, b'{"ada": "x"}', b'{"ada": [%d, ""]}' % ANOTHER):
        (league.folder / HOLDERS).write_bytes(forged)
        assert len(league.entrants()) == 2
    assert ANOTHER in {each.user for each in league.entrants()}, "what the owner records is read"
    os.chown(league.folder / HOLDERS, ANOTHER, -1)
    os.utime(ada.file)
    time.sleep(CLOCK_STEP_S)
    os.utime(league.folder / "entries" / name)
    assert ANOTHER not in {each.user for each in league.entrants()}, "what others record is not"


@pytest.mark.skipif(os.geteuid() != 0, reason="files of other users")
def test_a_clock_that_is_set_back_gives_nobody_anothers_program(tmp_path: Path) -> None:
    league = make_league(tmp_path, ada=LASER)
    enter_as(ANOTHER, league, "bob.py", GIVES_UP)
    record_holders(league.folder)
    enter_as(ANOTHER, league, "bob.py", LASER)
    time.sleep(CLOCK_STEP_S)
    os.utime(league.folder / "entries" / "ada.py")  # is now later than the copy of it, as by a clock set back
    assert [each.name for each in league.entrants()] == ["ada"]


@pytest.mark.skipif(os.geteuid() != 0, reason="files of other users")
def test_who_came_first_with_many_files_keeps_nobody_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(entries_module, "MAX_ENTRIES", 12)
    league = make_league(tmp_path)
    for number in range(30):
        enter_as(ANOTHER, league, f"a{number}.py", STANDS + b"number = %d\n" % number)
    time.sleep(CLOCK_STEP_S)
    enter_as(THIRD, league, "third.py", LASER)
    assert Counter(each.user for each in league.entrants()) == {ANOTHER: MAX_OF_ONE_USER, THIRD: 1}


@pytest.mark.skipif(os.geteuid() != 0, reason="files of other users")
def test_one_user_has_few_entries_in_anothers_league(tmp_path: Path) -> None:
    league = make_league(
        tmp_path, **{f"mine{number}": LASER + b"number = %d\n" % number for number in range(6)}
    )
    for number in range(9):
        enter_as(ANOTHER, league, f"a{number}.py", STANDS + b"number = %d\n" % number)
    enter_as(THIRD, league, "third.py", STANDS)
    counts = Counter(each.user for each in league.entrants())
    assert counts == {os.getuid(): 6, ANOTHER: MAX_OF_ONE_USER, THIRD: 1}


# Cheats: results

ResultCheat = Callable[[League, LeagueJob, LeagueJob], None]
"""Of the job of one who arrives, and that of one who does not."""


def change(file: Path, changed: Callable[[dict[str, Any]], None]) -> None:
    with np.load(file) as stored:
        content = json.loads(bytes(stored["drives"]))
    changed(content)
    data = io.BytesIO()
    np.savez_compressed(data, drives=np.frombuffer(json.dumps(content).encode(), dtype=np.uint8))
    file.write_bytes(data.getvalue())


def score_that_is_claimed(league: League, good: LeagueJob, bad: LeagueJob) -> None:
    league.result_file(bad.key).write_bytes(json.dumps({"reached": True, "seconds": 0.1}).encode())


def commands_that_come_sooner(league: League, good: LeagueJob, bad: LeagueJob) -> None:
    shutil.copy(league.result_file(good.key), league.result_file(bad.key))

    def sooner(content: dict[str, Any]) -> None:
        for drive in content["drives"]:
            drive["inputs"] = [[max(0, tick - 5), kind, what] for tick, kind, what in drive["inputs"]]

    change(league.result_file(bad.key), sooner)


def robot_that_is_moved(league: League, good: LeagueJob, bad: LeagueJob) -> None:
    robot = LEVEL.find_scenario().partners[0]

    def moved(content: dict[str, Any]) -> None:
        for drive in content["drives"]:
            drive["inputs"].insert(0, [0, "move_model", [robot, [0.625, 0.5, 0.0]]])

    change(league.result_file(bad.key), moved)


def other_robot_that_is_moved(league: League, good: LeagueJob, bad: LeagueJob) -> None:
    def moved(content: dict[str, Any]) -> None:
        twist = {"linear": {"x": 1.0}, "angular": {}}
        content["drives"][0]["inputs"] = [
            [0, "accept", ["/beacon/cmd_vel", "geometry_msgs/msg/Twist", twist]]
        ]

    change(league.result_file(bad.key), moved)


def one_good_start_five_times(league: League, good: LeagueJob, bad: LeagueJob) -> None:
    (recording, *_) = league.recordings(good)
    share_drives([recording] * 5, league.result_file(bad.key), [""] * 5)


def result_of_somebody_else(league: League, good: LeagueJob, bad: LeagueJob) -> None:
    target = league.folder / "elsewhere.npz"
    shutil.copy(league.result_file(good.key), target)
    league.result_file(bad.key).unlink()
    league.result_file(bad.key).symlink_to(target)


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    "cheat",
    [
        score_that_is_claimed,
        commands_that_come_sooner,
        robot_that_is_moved,
        other_robot_that_is_moved,
        one_good_start_five_times,
        result_of_somebody_else,
    ],
    ids=lambda each: each.__name__,
)
def test_a_result_that_was_not_driven_counts_for_nothing_and_is_driven_anew(
    driven: League, cheat: ResultCheat
) -> None:
    league = driven
    good, bad = (drive_job(LEVEL, each) for each in league.entrants())
    cheat(league, good, bad)
    assert league.judge(bad) is None
    assert league.waiting() == (bad.key,)
    assert read_standings(league).matches == ()


@pytest.mark.skipif(os.geteuid() != 0, reason="files of other users")
@pytest.mark.parametrize(
    ("mode", "is_refused"), [(0o777, True), (0o775, True), (0o1777, False), (0o755, False)]
)
def test_who_puts_his_own_list_in_place_of_the_owners_does_not_become_the_owner(
    tmp_path: Path, mode: int, is_refused: bool
) -> None:
    league = make_league(tmp_path, laser=LASER)
    owner, manifest = league.owner, league.folder / "league.json"
    league.folder.chmod(mode)
    assert league.owner == owner
    os.chown(
        manifest, ANOTHER, ANOTHER
    )  # in a folder in which others can rename files it may be one of theirs
    if is_refused:
        with pytest.raises(LeagueError, match="can be replaced"):
            read_standings(league)
    else:
        assert league.owner == ANOTHER


def test_only_results_of_the_owner_count(driven: League, monkeypatch: pytest.MonkeyPatch) -> None:
    league = driven
    assert len(read_standings(league).matches) == 1
    monkeypatch.setattr(League, "owner", property(lambda self: os.geteuid() + 1))
    assert not league.is_mine
    assert read_standings(league).matches == ()


@pytest.mark.long
def test_a_result_of_another_program_is_found_by_driving_anew(driven: League) -> None:
    league = driven
    found = differing_jobs(league)
    assert (found.compared, found.differing) == (2, ())
    good, bad = (drive_job(LEVEL, each) for each in league.entrants())
    shutil.copy(league.result_file(good.key), league.result_file(bad.key))  # the owner himself, for a friend
    assert [each.key for each in differing_jobs(league).differing] == [bad.key]


@pytest.mark.long
def test_a_program_that_drives_something_else_each_time_is_told_as_such(tmp_path: Path) -> None:
    body = """
    def begin(self):
        import random
        self.go(0.05 + 0.01 * random.Random().random())
"""
    league = make_league(tmp_path, laser=LASER, draws=FRAME.format(body=body).encode())
    job = next(each for each in league.jobs() if each.entrants[0].name == "draws")
    league.run_job(job.key)
    found = differing_jobs(league)
    assert ([each.key for each in found.unrepeatable], found.differing) == ([job.key], ())


# Cheats: programs at tag

TAG_CHEATS = {
    "steers the other robot": 'self.create_publisher(Twist, "/second/cmd_vel", 1)',
    "blinds the other robot": 'self.create_publisher(LaserScan, "/second/static_laser", 1)',
    "tells the other it is not the catcher": 'self.create_publisher(Bool, "/second/is_catcher", 1)',
    "looks through the other's laser": (
        'self.create_subscription(LaserScan, "/second/static_laser", lambda scan: None, 1)'
    ),
    "moves robots by the world's service": (
        'self.create_client(__import__("flatland_msgs.srv").srv.MoveModel, "/move_model")'
    ),
    "stops the world": 'self.create_client(__import__("std_srvs.srv").srv.Empty, "/pause")',
    "takes the other's place": 'rclpy.create_node("player", namespace="/second", use_global_arguments=False)',
}


@pytest.mark.sampled(3)
@pytest.mark.parametrize("line", TAG_CHEATS.values(), ids=list(TAG_CHEATS))
def test_a_program_that_reaches_out_of_its_namespace_has_lost(tmp_path: Path, line: str) -> None:
    cheat = FRAME.format(body=f"\n    def begin(self):\n        {line}\n").encode()
    league = make_league(tmp_path, races=False, tag=True, cheat=cheat, stands=STANDS)
    cheater, honest = league.entrants()
    job = tag_job(ARENA, cheater, honest)
    league.run_job(job.key)
    (match,) = read_standings(league).matches
    assert match.winner == honest
    assert "not its own" in match.details[0]
    assert match.details[1].endswith("s penalty")


@pytest.mark.long
def test_who_crashes_late_has_lost_although_it_was_never_the_catcher(tmp_path: Path) -> None:
    body = """
    def begin(self):
        self.create_timer(1.0, self.end)

    def end(self):
        raise RuntimeError("late")
"""
    league = make_league(
        tmp_path, races=False, tag=True, crashes=FRAME.format(body=body).encode(), stands=STANDS
    )
    matches: tuple[Match, ...] = run(league).matches
    assert [each.winner.name for each in matches if each.winner is not None] == ["stands"] * 2


@pytest.mark.long
def test_a_game_run_again_is_the_same_to_the_bit(tmp_path: Path) -> None:
    league = make_league(tmp_path, races=False, tag=True, chases=CHASES, stands=STANDS)
    programs = [each.program for each in league.entrants()]
    game = play_tag(ARENA, programs, Level.LIMITED, league_module.GRADER_LIMITS)
    state, again = tag_again(ARENA, game.recording)
    assert digest_of(again) == digest_of(game.recording)
    assert (state.scores, state.winner) == (game.state.scores, game.state.winner)
    with pytest.raises(ValueError, match="is a game on"):
        tag_again(LEVEL, game.recording)


def test_of_two_that_do_not_arrive_none_has_won_unless_a_program_has_failed() -> None:
    level = find_level("left-turn")
    stands, bumps = RaceFinish(False, 72.0, 0), RaceFinish(False, 72.0, 7)
    arrives = RaceFinish(True, 9.0, 3)

    def points(first: JudgedJob, second: JudgedJob) -> float:
        jobs = [
            LeagueJob(name, level, (Entry(name, DriverKind.PROGRAM, Path(name), name, name, is_mine=True),))
            for name in ("first", "second")
        ]
        return race_match((jobs[0], jobs[1]), (first, second)).points

    assert points(JudgedJob((stands,)), JudgedJob((bumps,))) == DRAW
    assert points(JudgedJob((stands,), remarks=("it failed",)), JudgedJob((bumps,))) == 0.0
    assert points(JudgedJob((bumps,)), JudgedJob((stands,), remarks=("it failed",))) == 1.0
    assert points(JudgedJob((arrives,)), JudgedJob((stands,))) == 1.0
