"""The leaderboard of a machine: who stands on it, in which order, and how much one user may put there."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from kit.school.game import ghosts, leaderboard
from kit.school.game.leaderboard import (
    MAX_COORDINATE,
    MAX_FILE_SIZE,
    MAX_NAME_LENGTH,
    MAX_TRACK_LENGTH,
    LeaderboardEntry,
    publish_entry,
    read_entries,
)
from kit.school.game.medal import Medal
from kit.school.game.player_progress import LevelProgress
from kit.school.game.race import DriverKind
from tests.kit_content import kit_levels

LEVELS = kit_levels()
FIRST = LEVELS[0]
OWN_FILE = f"{os.getuid()}.json"


def fastest(seconds: float, level: int = 0) -> LevelProgress:
    """The progress of somebody who has driven a level once, by hand."""
    return LevelProgress(LEVELS[level], True, {}, frozenset(), {DriverKind.KEYS: seconds})


def track_of(poses: int) -> list[list[float]]:
    return [[0.1, 0.2, 0.3]] * poses


def write_entry(
    folder: Path, track: Sequence[Sequence[float]] = (), name: str = "Ada", padding: int = 0
) -> Path:
    """Writes this user's file by hand, ``padding`` bytes longer than it need be."""
    level = {"stars": 0, "best": {"keys": 5.0}, "medals": {}, "tracks": {"keys": track}}
    text = json.dumps({"name": name, "levels": {FIRST.id: level}})
    (folder / OWN_FILE).write_text(text + " " * padding)
    return folder / OWN_FILE


def test_the_leaderboard_lists_only_users_who_joined(tmp_path: Path) -> None:
    board = tmp_path / "board"
    assert not leaderboard.has_joined(board)
    publish_entry(board, "Ada\x1b[31m", [fastest(5.0)])
    (entry,) = read_entries(board)
    assert (entry.seconds, entry.is_mine, "\x1b" in entry.name) == (5.0, True, False)
    own = board / OWN_FILE
    (board / "123456.json").write_text(own.read_text())  # written for somebody else
    (board / "999.json").symlink_to(own)
    (board / "0.txt").write_text("x")
    assert len(read_entries(board)) == 1
    leaderboard.remove_own_entry(board)
    leaderboard.remove_own_entry(board)
    assert read_entries(board) == []


def test_players_are_ranked_by_medals_and_then_by_stars() -> None:
    def entry(user: int, level: str, seconds: float, medal: Medal, stars: int) -> LeaderboardEntry:
        return LeaderboardEntry(
            f"user {user}", level, DriverKind.KEYS, seconds, stars, user == 1, medal, (), user
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
    "content",
    [
        "",
        "[]",
        "{}",
        "[" * 100_000,
        '{"name": "x", "levels": {"a": {"stars": 1e999, "best": {"keys": 1}}}}',
        json.dumps({"name": "x", "levels": {"a": {"stars": 1, "best": {"keys": "inf"}}}}),
    ],
)
def test_a_damaged_entry_is_passed_over(tmp_path: Path, content: str) -> None:
    (tmp_path / OWN_FILE).write_text(content)
    assert read_entries(tmp_path) == []


def test_a_folder_in_which_others_can_replace_files_is_refused(tmp_path: Path) -> None:
    board = tmp_path / "board"
    board.mkdir()
    board.chmod(0o777)
    with pytest.raises(leaderboard.LeaderboardError, match="chmod"):
        publish_entry(board, "Ada", [])


def test_a_file_is_read_up_to_its_largest_size(tmp_path: Path) -> None:
    size = write_entry(tmp_path).stat().st_size
    write_entry(tmp_path, padding=MAX_FILE_SIZE - size)
    assert len(read_entries(tmp_path)) == 1
    write_entry(tmp_path, padding=MAX_FILE_SIZE - size + 1)
    assert read_entries(tmp_path) == []


def test_a_long_name_is_cut_where_it_is_written_and_where_it_is_read(tmp_path: Path) -> None:
    whole = "n" * MAX_NAME_LENGTH
    board = tmp_path / "board"
    for name in (whole, whole + "n"):
        publish_entry(board, name, [fastest(5.0)])
        assert json.loads((board / OWN_FILE).read_text())["name"] == whole
        write_entry(tmp_path, name=name)
        assert [each.name for each in read_entries(tmp_path)] == [whole]


def test_a_long_track_is_not_written_and_is_cut_where_it_is_read(tmp_path: Path) -> None:
    for poses, published in ((MAX_TRACK_LENGTH, MAX_TRACK_LENGTH), (MAX_TRACK_LENGTH + 1, 0)):
        board = tmp_path / "board"
        publish_entry(board, "Ada", [fastest(5.0)], {(FIRST.id, "keys"): track_of(poses)})
        assert [len(each.track) for each in read_entries(board)] == [published]
        write_entry(tmp_path, track_of(poses))
        assert [len(each.track) for each in read_entries(tmp_path)] == [MAX_TRACK_LENGTH]


def test_of_many_tracks_as_many_are_written_as_a_file_may_hold(tmp_path: Path) -> None:
    """Whoever has driven many levels stays on the leaderboard; the longest tracks give way."""
    levels = LEVELS[:24]
    drives = [fastest(5.0, number) for number in range(len(levels))]
    long = track_of(MAX_TRACK_LENGTH)
    tracks = {(each.id, "keys"): long for each in levels} | {(FIRST.id, "keys"): track_of(10)}
    assert len(json.dumps(list(tracks.values()))) > MAX_FILE_SIZE
    publish_entry(tmp_path / "board", "Ada", drives, tracks)
    entries = read_entries(tmp_path / "board")
    assert len(entries) == len(levels)
    lengths = [len(each.track) for each in entries]
    assert lengths.count(10) == 1
    assert 0 < lengths.count(MAX_TRACK_LENGTH) < len(levels) - 1


def test_as_many_classmates_drive_along_as_fit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    others = [
        LeaderboardEntry(
            f"user {number}", FIRST.id, DriverKind.KEYS, number, 0, False, track=((0.0, 0.0, 0.0),)
        )
        for number in range(1, ghosts.MAX_CLASSMATES + 2)
    ]
    monkeypatch.setattr(leaderboard, "read_entries", lambda folder: others[:-1])
    assert [each.name for each in ghosts.classmate_ghosts(FIRST)] == [each.name for each in others[:-1]]
    monkeypatch.setattr(leaderboard, "read_entries", lambda folder: others)
    assert [each.name for each in ghosts.classmate_ghosts(FIRST)] == [each.name for each in others[:-1]]


def test_few_reference_drives_are_kept_in_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    driven: list[str] = []

    def pretend(level: object, on_second: object) -> tuple[None, str]:
        driven.append(level.id)  # type: ignore[attr-defined]  # the race is a stand-in: its level is typed as object
        return None, f"of {level.id}"  # type: ignore[attr-defined]  # likewise

    monkeypatch.setattr(ghosts, "_RECORDINGS", type(ghosts._RECORDINGS)())
    monkeypatch.setattr(ghosts, "drive_reference", pretend)
    monkeypatch.setattr(ghosts, "reference_seconds", lambda level: 1.0)
    kept, one_more = LEVELS[: ghosts.MAX_RECORDINGS], LEVELS[ghosts.MAX_RECORDINGS]
    for level in (*kept, *kept):
        ghosts.reference_recording(level)
    assert driven == [each.id for each in kept]
    ghosts.reference_recording(one_more)
    ghosts.reference_recording(kept[-1])
    ghosts.reference_recording(kept[0])  # which was there longest, and had to go
    assert driven == [*(each.id for each in kept), one_more.id, kept[0].id]


def test_a_track_leads_nowhere_that_no_map_is(tmp_path: Path) -> None:
    inside = MAX_COORDINATE - 1.0
    write_entry(tmp_path, [[inside, -inside, 0.0]])
    assert [each.track for each in read_entries(tmp_path)] == [((inside, -inside, 0.0),)]
    write_entry(tmp_path, [[0.0, -MAX_COORDINATE, 0.0]])
    assert read_entries(tmp_path) == []
