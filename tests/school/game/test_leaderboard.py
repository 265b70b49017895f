"""The leaderboard of a machine: who stands on it and in which order, and what does not: only what was driven stands."""

from __future__ import annotations

import datetime
import io
import json
import os
import shutil
from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from kit.controllers import find_controller
from kit.document.layout import lines_of
from kit.run.recording import Input, Recording
from kit.school.game import ghosts, leaderboard, references, shared_drives
from kit.school.game.daily import daily_level, today
from kit.school.game.leaderboard import (
    MAX_NAME_BYTES,
    MAX_NAME_LENGTH,
    LeaderboardEntry,
    publish_drives,
    read_entries,
    standings,
)
from kit.school.game.levels import GameLevel
from kit.school.game.medal import Medal
from kit.school.game.race import DriverKind, judge_recording, race_from_all_starts, run_again
from kit.school.game.references import drive_reference
from kit.school.game.shared_drives import (
    MAX_FILE_BYTES,
    JudgedDrive,
    SharedDrives,
    digest_of,
    judge_shared_drives,
    platform_key,
    read_shared_drives,
    share_drives,
)
from kit.school.game.starts import OWN_SEED
from kit.school.progress import EventKind, ProgressJournal
from kit.tui.rows import leaderboard_rows
from kit.tui.rows.leaderboard_rows import leaderboard_times
from kit.workspace import open_workspace
from tests.kit_content import kit_levels
from tests.school.game.measured_drivers import LASER_PROGRAM, drive, keys_drive, tape_drives
from tests.school.game.ordinary import targets_of
from tests.school.game.tidy import TidyDriver

LEVELS = kit_levels()
FIRST = LEVELS[0]
BEDROOM = next(level for level in LEVELS if level.id == "the-bedroom")
OWN = os.getuid()
KEYS, CONTROLLER = DriverKind.HAND, DriverKind.PROGRAM


@cache
def by_hand() -> Recording:
    return keys_drive(FIRST)[1]


def quicker() -> Recording:
    """A drive of the same keys without a hand's delay."""
    targets = targets_of(FIRST)
    return drive(
        FIRST, OWN_SEED, lambda session: session.runner.participants.append(TidyDriver(session, targets))
    )[1]


def own_file(board: Path, level: str = FIRST.id, driver: DriverKind = KEYS) -> Path:
    return board / f"{OWN}.{level}.{driver.value}.npz"


def join(board: Path, *recordings: Recording, driver: DriverKind = KEYS) -> Path:
    publish_drives(board, "Ada", {(FIRST.id, driver): recordings} if recordings else {})
    return board


def change(file: Path, changed: Callable[[dict[str, Any]], None]) -> None:
    """Changes what a shared file says."""
    with np.load(file) as stored:
        content = json.loads(bytes(stored["drives"]))
    changed(content)
    data = io.BytesIO()
    np.savez_compressed(data, drives=np.frombuffer(json.dumps(content).encode(), dtype=np.uint8))
    file.write_bytes(data.getvalue())


def test_the_leaderboard_lists_only_users_who_joined(tmp_path: Path) -> None:
    board = tmp_path / "board"
    assert not leaderboard.has_joined(board)
    publish_drives(board, "Ada\x1b[31m", {(FIRST.id, KEYS): [by_hand()]})
    assert leaderboard.has_joined(board)
    (entry,) = read_entries(board, [FIRST])
    assert (entry.level, entry.is_mine, "\x1b" in entry.name) == (FIRST.id, True, False)
    shutil.copy(board / f"{OWN}.json", board / "123456.json")  # written for somebody else
    shutil.copy(own_file(board), board / f"123456.{FIRST.id}.hand.npz")
    (board / "999.json").symlink_to(board / f"{OWN}.json")
    (board / "0.txt").write_text("x")
    assert len(read_entries(board, [FIRST])) == 1
    leaderboard.remove_own_entry(board)
    leaderboard.remove_own_entry(board)
    assert read_entries(board, [FIRST]) == []
    assert not own_file(board).exists()


Cheat = Callable[[Path], None]


def finishes_only_in_the_journal(board: Path) -> None:
    """Finishes that were written into the journal, without a recording."""
    workspace = open_workspace(board.parent / "desk")
    with ProgressJournal(workspace.folder) as journal:
        for level in LEVELS:
            content = {"driver": "hand", "reached": True, "seconds": 1.0, "bumps": 0, "medal": 5, "rules": []}
            journal.add(EventKind.FINISH, level.id, content)
        from kit.school.game.drive_records import join_leaderboard

        join_leaderboard(journal, workspace, "Ada")


def times_in_the_name_file(board: Path) -> None:
    """Times, medals and tracks that the user's own file claims."""
    join(board)
    level = {"stars": 5, "best": {"hand": 1.0}, "medals": {"hand": 5}, "tracks": {}}
    (board / f"{OWN}.json").write_text(json.dumps({"name": "Ada", "levels": {FIRST.id: level}}))


def drive_of_another_level(board: Path) -> None:
    join(board, keys_drive(BEDROOM)[1])


def inputs_that_were_changed(board: Path) -> None:
    """A quicker time by faster commands: the poses are others then."""
    join(board, by_hand())

    def faster(content: dict[str, Any]) -> None:
        inputs = content["drives"][0]["inputs"]
        content["drives"][0]["inputs"] = [[max(0, tick - 5), kind, what] for tick, kind, what in inputs]

    change(own_file(board), faster)


def drive_that_was_cut(board: Path) -> None:
    """The end of a drive is left out, so that it would be shorter."""
    recording = by_hand()
    half = recording.ticks // 2
    rows = int(recording.counts[:half].sum())
    join(board, replace(recording, counts=recording.counts[:half], poses=recording.poses[:rows]))


def robot_that_was_moved(board: Path) -> None:
    """The world's own service puts the robot at its goal."""
    home = Input(1, "move_model", (FIRST.find_scenario().partners[0], (0.625, 0.5, 0.0)))
    join(board, replace(by_hand(), inputs=(home, *by_hand().inputs)))


def other_model_that_was_moved(board: Path) -> None:
    command = by_hand().inputs[0]
    join(
        board,
        replace(by_hand(), inputs=(replace(command, content=("/beacon/cmd_vel", *command.content[1:])),)),
    )


def clock_that_was_set_back(board: Path) -> None:
    """Ticks of half the length would halve the time."""
    join(board, replace(by_hand(), step_size=0.005))


def seed_of_an_easier_start(board: Path) -> None:
    join(board, replace(by_hand(), seed=3))


def tape_as_a_program(board: Path) -> None:
    """The reference's commands from all five starts, handed in as a program."""
    join(board, *(recording for _, recording in tape_drives(FIRST)), driver=CONTROLLER)


def one_start_as_a_program(board: Path) -> None:
    join(board, by_hand(), driver=CONTROLLER)


def one_start_five_times(board: Path) -> None:
    join(board, *[by_hand()] * 5, driver=CONTROLLER)


def reference_drive_as_a_hand(board: Path) -> None:
    join(board, drive_reference(FIRST)[1])


def reference_drive_a_moment_later(board: Path) -> None:
    """The reference's commands, each as much later; the drive that they make is shared as it is."""
    reference = drive_reference(FIRST)[1]
    join(board, delayed(reference, 7))


def reference_drive_with_a_slower_start(board: Path) -> None:
    """The first command is slower by less than a thousandth: the same drive, but for a fraction of a millimetre."""
    reference = drive_reference(FIRST)[1]
    first, *others = reference.inputs
    topic, interface, command = first.content
    linear = {axis: 0.9998 * speed for axis, speed in command["linear"].items()}
    slower = replace(first, content=(topic, interface, {**command, "linear": linear}))
    join(board, driven(replace(reference, inputs=(slower, *others))))


def driven(recording: Recording) -> Recording:
    """The drive that these inputs make."""
    return run_again(FIRST, recording)[1]


def delayed(recording: Recording, ticks: int) -> Recording:
    """The drive of the same inputs that sets off later."""
    counts = np.append(recording.counts, np.zeros(ticks, dtype=recording.counts.dtype))
    inputs = tuple(replace(each, tick=each.tick + ticks) for each in recording.inputs)
    return driven(replace(recording, counts=counts, inputs=inputs))


def digest_of_another_drive(board: Path) -> None:
    """A forged fingerprint, from a machine like this one."""
    join(board, by_hand())
    change(own_file(board), lambda content: content["drives"][0].update(digest="0" * 64))


def file_that_is_too_large(board: Path) -> None:
    join(board, by_hand())
    with own_file(board).open("ab") as opened:
        opened.write(b"\0" * MAX_FILE_BYTES)


def archive_that_unpacks_to_much(board: Path) -> None:
    join(board)
    data = io.BytesIO()
    np.savez_compressed(data, drives=np.zeros(shared_drives.MAX_INPUTS_BYTES + 1, dtype=np.uint8))
    own_file(board).write_bytes(data.getvalue())


def link_to_anothers_file(board: Path) -> None:
    join(board, by_hand())
    elsewhere = board.parent / "elsewhere.npz"
    shutil.move(own_file(board), elsewhere)
    own_file(board).symlink_to(elsewhere)


CHEATS: tuple[Cheat, ...] = (
    finishes_only_in_the_journal,
    times_in_the_name_file,
    drive_of_another_level,
    inputs_that_were_changed,
    drive_that_was_cut,
    robot_that_was_moved,
    other_model_that_was_moved,
    clock_that_was_set_back,
    seed_of_an_easier_start,
    tape_as_a_program,
    one_start_as_a_program,
    one_start_five_times,
    reference_drive_as_a_hand,
    reference_drive_a_moment_later,
    reference_drive_with_a_slower_start,
    digest_of_another_drive,
    file_that_is_too_large,
    archive_that_unpacks_to_much,
    link_to_anothers_file,
)


@pytest.mark.parametrize("cheat", CHEATS, ids=lambda each: each.__name__)
def test_what_was_not_driven_stands_nowhere(
    cheat: Cheat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    board = tmp_path / "board"
    monkeypatch.setenv(leaderboard.FOLDER_VARIABLE, str(board))
    cheat(board)
    assert leaderboard.has_joined(board)
    assert read_entries(board, [FIRST, BEDROOM]) == []


def test_a_link_that_another_user_has_put_there_leads_to_no_file_of_ones_own(tmp_path: Path) -> None:
    board, precious = tmp_path / "board", tmp_path / "precious"
    board.mkdir(mode=0o1777)
    precious.write_bytes(b"mine")
    files = (board / f"{OWN}.json", own_file(board))
    for file in files:
        file.symlink_to(precious)
    join(board, by_hand())
    assert precious.read_bytes() == b"mine"
    assert not any(file.is_symlink() for file in files)
    assert len(read_entries(board, [FIRST])) == 1


@pytest.fixture
def run_again_here(monkeypatch: pytest.MonkeyPatch) -> list[bytes]:
    """The files whose drives are run again, in their order."""
    ran: list[bytes] = []

    def judge(content: bytes, level: GameLevel, driver: DriverKind) -> JudgedDrive:
        ran.append(content)
        return judge_shared_drives(content, level, driver)

    monkeypatch.setattr(leaderboard, "judge_shared_drives", judge)
    leaderboard._judge_once.cache_clear()
    return ran


def test_many_files_of_one_user_make_nobody_wait(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, run_again_here: list[bytes]
) -> None:
    board = join(tmp_path / "board", by_hand())
    for number in range(40):
        file = board / f"{OWN}.{FIRST.id}.keys.{number:016x}.npz"
        shutil.copy(own_file(board), file)
        change(file, partial(add_remark, str(number)))
    monkeypatch.setattr(leaderboard, "MAX_TICKS_OF_ONE_USER", 4 * by_hand().ticks)
    assert len(read_entries(board, [FIRST])) == 1
    assert len(run_again_here) <= 5


def test_one_drive_in_the_places_of_all_levels_makes_nobody_wait(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, run_again_here: list[bytes]
) -> None:
    board = join(tmp_path / "board", by_hand())
    for level in LEVELS[1:]:
        shutil.copy(own_file(board), own_file(board, level.id))
    monkeypatch.setattr(
        leaderboard, "MAX_TICKS_OF_ONE_USER", (by_hand().ticks + leaderboard.TICKS_OF_A_FILE) // 4
    )
    read_entries(board, LEVELS)
    assert 1 <= len(run_again_here) <= len(LEVELS) // 4 + 1


def test_files_that_unpack_to_megabytes_make_nobody_wait(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    board = join(tmp_path / "board", by_hand())
    for number in range(10):
        file = board / f"{OWN}.{FIRST.id}.keys.{number:016x}.npz"
        shutil.copy(own_file(board), file)
        change(file, partial(add_remark, f"{number}" * 1_000_000))
    read = list[bytes]()

    def noted(data: bytes) -> SharedDrives:
        read.append(data)
        return read_shared_drives(data)

    monkeypatch.setattr(leaderboard, "read_shared_drives", noted)
    monkeypatch.setattr(leaderboard, "MAX_TICKS_OF_ONE_USER", 10_000)
    assert len(read_entries(board, [FIRST])) == 1
    assert len(read) <= 1 + 10_000 * leaderboard.BYTES_OF_A_TICK // 1_000_000, (
        "by their ticks it would be nine"
    )


def add_remark(remark: str, content: dict[str, Any]) -> None:
    content["remarks"].append(remark)


def test_a_former_drive_that_is_as_long_as_no_other_is_not_run_again(
    tmp_path: Path, run_again_here: list[bytes]
) -> None:
    board = join(tmp_path / "board", quicker())
    join(board, by_hand())
    assert len(read_entries(board, [FIRST])) == 1
    assert len(run_again_here) == 1


@pytest.fixture
def of_many_users(monkeypatch: pytest.MonkeyPatch) -> None:
    """As if each file belonged to the user it is named after."""
    monkeypatch.setattr(leaderboard, "read_own", lambda file, user, limit: file.read_bytes())


@pytest.mark.usefixtures("of_many_users")
def test_a_replay_of_anothers_drive_by_hand_stands_nowhere(tmp_path: Path) -> None:
    board = join(tmp_path / "board", by_hand())
    (board / "7.json").write_text('{"name": "Bob"}')
    copy = board / f"7.{FIRST.id}.hand.npz"
    shutil.copy(own_file(board), copy)
    assert [each.user for each in read_entries(board, [FIRST])] == [OWN]
    os.utime(copy, (0, 0))  # a clock that is set back in the file says nothing
    assert [each.user for each in read_entries(board, [FIRST])] == [OWN]
    publish_drives(
        board, "Ada", {(FIRST.id, KEYS): [by_hand()]}
    )  # joining again does not make the first one younger
    assert [each.user for each in read_entries(board, [FIRST])] == [OWN]

    def a_moment_later(content: dict[str, Any]) -> None:
        inputs = content["drives"][0]["inputs"]
        content["drives"][0]["inputs"] = [[tick + 37, kind, what] for tick, kind, what in inputs]
        content["drives"][0]["ticks"] += 37
        content["platform"] = "another"

    change(copy, a_moment_later)
    assert [each.user for each in read_entries(board, [FIRST])] == [OWN]


@pytest.mark.usefixtures("of_many_users")
def test_a_copy_stands_nowhere_although_its_owner_has_driven_better_since(tmp_path: Path) -> None:
    board = join(tmp_path / "board", by_hand())
    (board / "7.json").write_text('{"name": "Bob"}')
    shutil.copy(own_file(board), board / f"7.{FIRST.id}.hand.npz")
    join(board, quicker())
    (entry,) = read_entries(board, [FIRST])
    assert (entry.user, entry.seconds < judge_recording(FIRST, by_hand()).seconds) == (OWN, True)


@pytest.mark.usefixtures("of_many_users")
def test_a_copy_does_not_become_the_first_one_when_its_owner_leaves_the_board(tmp_path: Path) -> None:
    board = join(tmp_path / "board", by_hand())
    (board / "7.json").write_text('{"name": "Bob"}')
    shutil.copy(own_file(board), board / f"7.{FIRST.id}.hand.npz")
    leaderboard.remove_own_entry(board)
    assert read_entries(board, [FIRST]) == []
    join(board, by_hand())
    assert [each.user for each in read_entries(board, [FIRST])] == [OWN], "what was kept is still theirs"


@pytest.mark.usefixtures("of_many_users")
def test_who_claims_anothers_drive_as_an_earlier_one_takes_nothing_away(tmp_path: Path) -> None:
    board = join(tmp_path / "board", by_hand())
    (board / "7.json").write_text('{"name": "Bob"}')
    shutil.copy(own_file(board), board / f"7.{FIRST.id}.keys.0123456789abcdef.npz")
    assert [each.user for each in read_entries(board, [FIRST])] == [OWN]


@pytest.mark.usefixtures("of_many_users")
def test_a_copied_drive_of_a_program_is_told_and_does_not_count(tmp_path: Path) -> None:
    drives = race_from_all_starts(FIRST, find_controller(str(LASER_PROGRAM)))
    board = join(tmp_path / "board", *(recording for _, recording in drives), driver=CONTROLLER)
    (board / "7.json").write_text('{"name": "Bob"}')
    shutil.copy(own_file(board, driver=CONTROLLER), board / f"7.{FIRST.id}.program.npz")
    entries = read_entries(board, [FIRST])
    assert [(each.user, each.copy_of) for each in entries] == [(OWN, ""), (7, "Ada")]
    assert "as Ada before" in "\n".join(lines_of([leaderboard_times(entries)]))
    assert [each.name for each in standings(entries)] == ["Ada"]

    shutil.move(board / f"7.{FIRST.id}.program.npz", board / f"7.{FIRST.id}.agent.npz")
    entries = read_entries(board, [FIRST])
    assert [(each.user, each.copy_of) for each in entries] == [(OWN, ""), (7, "Ada")], "called an agent"


@pytest.mark.usefixtures("of_many_users")
@pytest.mark.parametrize("user", [OWN, 7])
def test_a_drive_of_a_program_is_none_by_hand(tmp_path: Path, user: int) -> None:
    drives = race_from_all_starts(FIRST, find_controller(str(LASER_PROGRAM)))
    board = join(tmp_path / "board", *(recording for _, recording in drives), driver=CONTROLLER)
    (board / "7.json").write_text('{"name": "Bob"}')
    (own_start,) = (recording for _, recording in drives if recording.seed == OWN_SEED)
    share_drives([own_start], board / f"{user}.{FIRST.id}.hand.npz")
    assert [(each.user, each.driver) for each in read_entries(board, [FIRST])] == [(OWN, CONTROLLER)]
    for file in board.glob(f"{OWN}.{FIRST.id}.program.*"):
        file.unlink()
    assert [each.user for each in read_entries(board, [FIRST])] == [user], "else it would stand"


def test_yesterdays_level_stays_a_day_with_who_drove_it_then(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = today()
    level = daily_level(now)
    publish_drives(tmp_path, "Ada", {(level.id, KEYS): [keys_drive(level)[1]]})

    def on_the_board() -> list[str]:
        entries = read_entries(tmp_path)
        return [str(each[0]) for each in leaderboard_times(entries).rows]

    def let_pass(days: int) -> None:
        for module in (leaderboard, leaderboard_rows):
            monkeypatch.setattr(module, "today", lambda: now + datetime.timedelta(days=days))
            monkeypatch.setattr(module, "yesterday", lambda: now + datetime.timedelta(days=days - 1))

    assert on_the_board() == ["Today's maze"]
    let_pass(1)
    assert on_the_board() == ["Yesterday's maze"]
    let_pass(2)
    assert on_the_board() == []
    let_pass(1)
    late = daily_level(now - datetime.timedelta(days=1))  # driven today, when it was over
    let_pass(0)
    publish_drives(tmp_path, "Ada", {(late.id, KEYS): [keys_drive(late)[1]]})
    assert on_the_board() == ["Today's maze"]


@pytest.mark.usefixtures("of_many_users")
def test_two_of_one_name_are_told_apart(tmp_path: Path) -> None:
    board = join(tmp_path / "board", by_hand())
    (board / "7.json").write_text('{"name": "ADA"}')
    share_drives([keys_drive(BEDROOM)[1]], board / f"7.{BEDROOM.id}.hand.npz")
    names = [each.name for each in read_entries(board, [FIRST, BEDROOM])]
    assert sorted(names) == sorted([f"Ada (user {OWN})", "ADA (user 7)"])


def test_a_drive_from_another_platform_is_judged_and_marked(tmp_path: Path) -> None:
    board = join(tmp_path / "board", by_hand())

    def elsewhere(content: dict[str, Any]) -> None:
        content["platform"] = f"not {platform_key()}"
        content["drives"][0]["digest"] = "its last digits were others"

    change(own_file(board), elsewhere)
    (entry,) = read_entries(board, [FIRST])
    assert not entry.is_same_platform
    assert entry.medal is Medal.BRONZE


def test_a_drive_is_judged_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    board = join(tmp_path / "board", by_hand())
    first = read_entries(board, [FIRST])
    monkeypatch.setattr(leaderboard, "judge_shared_drives", pytest.fail)
    assert [each.seconds for each in read_entries(board, [FIRST])] == [each.seconds for each in first]


def test_players_are_ranked_by_medals_and_then_by_stars() -> None:
    def entry(user: int, level: str, seconds: float, medal: Medal, stars: int) -> LeaderboardEntry:
        return LeaderboardEntry(
            f"user {user}", level, DriverKind.HAND, seconds, stars, user == 1, medal, user=user
        )

    by_agent = replace(entry(3, "b", 6.0, Medal.BRONZE, 2), driver=DriverKind.AGENT)
    entries = [
        entry(1, "a", 5.0, Medal.SILVER, 1),
        entry(2, "a", 7.0, Medal.GOLD, 0),
        entry(3, "b", 5.0, Medal.SILVER, 2),
        by_agent,
    ]
    found = leaderboard.standings(entries)
    assert [each.name for each in found] == ["user 2", "user 3", "user 1"]  # gold, then bronze beside silver
    assert [each.fastest for each in found] == [0, 1, 1]
    assert found[1].stars == 2  # of a level once, whoever drove
    assert [each.is_mine for each in found] == [False, False, True]


@pytest.mark.parametrize(
    "content", ["", "[]", "{}", "[" * 100_000, '{"name": "' + "x" * MAX_NAME_BYTES + '"}']
)
def test_a_damaged_name_is_passed_over(tmp_path: Path, content: str) -> None:
    share_drives([by_hand()], own_file(tmp_path))
    (tmp_path / f"{OWN}.json").write_text(content)
    assert read_entries(tmp_path, [FIRST]) == []


@pytest.mark.parametrize(
    "damage",
    [
        lambda content: content.update(format=0),
        lambda content: content.update(drives=[1]),
        lambda content: content["drives"][0].pop("inputs"),
        lambda content: content["drives"][0].update(ticks=1e99),
        lambda content: content["drives"][0].update(ticks=10**9),
        lambda content: content["drives"][0].update(inputs=[[0, "accept", []]]),
        lambda content: content["drives"][0].update(inputs=[[0, "explode", []]]),
        lambda content: content["drives"][0]["inputs"][0][2].__setitem__(0, []),
        lambda content: content["drives"][0]["inputs"][0][2].__setitem__(0, {}),
        lambda content: content["drives"][0]["inputs"][0][2][2]["linear"].update(x=10**400),
    ],
)
def test_a_damaged_drive_is_passed_over(tmp_path: Path, damage: Callable[[dict[str, Any]], None]) -> None:
    board = join(tmp_path / "board", by_hand())
    change(own_file(board), damage)
    assert read_entries(board, [FIRST]) == []


def test_a_drive_with_many_messages_a_tick_is_shared_and_the_same(tmp_path: Path) -> None:
    """Of which the robot obeys the last: so many commands keep nobody's drive from being judged."""
    told = by_hand()
    other = {"linear": {"x": -9.0}}
    many = tuple(
        each
        for one in told.inputs
        for each in (*(replace(one, content=(*one.content[:2], other)),) * 20, one)
    )
    assert digest_of(run_again(FIRST, replace(told, inputs=many))[1]) == digest_of(told)
    share_drives([replace(told, inputs=many)], tmp_path / "many.npz")
    share_drives([told], tmp_path / "few.npz")
    assert (tmp_path / "many.npz").read_bytes() == (tmp_path / "few.npz").read_bytes()
    assert judge_shared_drives((tmp_path / "many.npz").read_bytes(), FIRST, KEYS).finish.reached


def test_a_folder_in_which_others_can_replace_files_is_refused(tmp_path: Path) -> None:
    board = tmp_path / "board"
    board.mkdir()
    board.chmod(0o777)
    with pytest.raises(leaderboard.LeaderboardError, match="chmod"):
        publish_drives(board, "Ada", {})


def test_a_long_name_is_cut_where_it_is_written_and_where_it_is_read(tmp_path: Path) -> None:
    whole = "n" * MAX_NAME_LENGTH
    board = tmp_path / "board"
    publish_drives(board, whole + "n", {})
    assert leaderboard.own_name(board) == whole
    (board / f"{OWN}.json").write_text(json.dumps({"name": whole + "n"}))
    assert leaderboard.own_name(board) == whole


def test_as_many_classmates_drive_along_as_fit(monkeypatch: pytest.MonkeyPatch) -> None:
    others = [
        LeaderboardEntry(f"user {number}", FIRST.id, DriverKind.HAND, number, 0, False)
        for number in range(1, ghosts.MAX_CLASSMATES + 2)
    ]
    monkeypatch.setattr(leaderboard, "read_entries", lambda folder, levels: others[:-1])
    assert [each.name for each in ghosts.classmate_ghosts(FIRST)] == [each.name for each in others[:-1]]
    monkeypatch.setattr(leaderboard, "read_entries", lambda folder, levels: others)
    assert [each.name for each in ghosts.classmate_ghosts(FIRST)] == [each.name for each in others[:-1]]


def test_few_reference_drives_are_kept_in_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    driven: list[str] = []

    def pretend(level: object, on_second: object) -> tuple[None, str]:
        driven.append(level.id)  # type: ignore[attr-defined]  # the race is a stand-in: its level is typed as object
        return None, f"of {level.id}"  # type: ignore[attr-defined]  # likewise

    monkeypatch.setattr(references, "_RECORDINGS", type(references._RECORDINGS)())
    monkeypatch.setattr(references, "drive_reference", pretend)
    monkeypatch.setattr(references, "reference_seconds", lambda level: 1.0)
    kept, one_more = LEVELS[: references.MAX_RECORDINGS], LEVELS[references.MAX_RECORDINGS]
    for level in (*kept, *kept):
        references.reference_recording(level)
    assert driven == [each.id for each in kept]
    references.reference_recording(one_more)
    references.reference_recording(kept[-1])
    references.reference_recording(kept[0])  # which was there longest, and had to go
    assert driven == [*(each.id for each in kept), one_more.id, kept[0].id]
