"""Two players in one world: the rules, what the wire lets through, and a host that no guest can stop."""

from __future__ import annotations

import json
import math
import os
import socket
import struct
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

import pytest

from kit.geometry import Pose
from kit.host.wire import HEADER, Json, ProtocolError, encode
from kit.inspection import sockets
from kit.run.episode import run_until
from kit.run.recording import Recorder, load_recording, rerun, save_recording
from kit.run.session import Session
from kit.school.game import shared_server, shared_sockets, two_players
from kit.school.game.levels import all_levels, find_level
from kit.school.game.shared_protocol import (
    MAX_BURST,
    MAX_COORDINATE,
    MAX_FRAME,
    MAX_LEVEL_NAME,
    MAX_PLAYER_NAME,
    MAX_SECONDS,
    MAX_WATCHING,
    VERSION,
    GameOffer,
    JoinRequest,
    KeyPush,
    RematchRequest,
    encode_join_request,
    encode_offer,
    encode_push,
    encode_rematch_request,
    encode_state,
    parse_from_guest,
    parse_from_host,
)
from kit.school.game.shared_server import SharedGameClient, SharedGameServer
from kit.school.game.shared_sockets import (
    Audience,
    FoundGame,
    SharedGameError,
    find_game,
    found_games,
    listen_for_guests,
)
from kit.school.game.two_players import (
    CATCH_DISTANCE,
    COUNTDOWN,
    GUEST,
    STILL_DISTANCE,
    STILL_SECONDS,
    TAG_PAUSE,
    CannotShare,
    SharedGame,
    SharedGameState,
    SharedMode,
    SharedPhase,
    recorded_scenario,
    shared_scenario,
)
from tests.cases import every_case
from tests.waiting import wait_until

STATE = SharedGameState(
    SharedPhase.RUNNING,
    1.5,
    (Pose(1.0, 2.0, 0.5), Pose(-1.0, 0.0, 3.0)),
    (1.0, 0.0),
    None,
    1,
    catches=(0.5, 1.25),
)

# The rules


@pytest.mark.long
def test_every_level_for_one_robot_has_room_for_two_or_says_why() -> None:
    shared = []
    for level in all_levels():
        try:
            scenario = shared_scenario(level)
        except CannotShare:
            continue
        models = {model.name: model for model in scenario.world.models}
        first, second = models[scenario.robot or ""], models[GUEST]
        assert 0.2 < math.dist(first.pose[:2], second.pose[:2]) < 0.6
        shared.append(level.id)
    assert len(shared) >= 15


@pytest.fixture
def race() -> Iterator[tuple[Session, SharedGame]]:
    yield from shared_session(SharedMode.RACE)


@pytest.fixture
def tag() -> Iterator[tuple[Session, SharedGame]]:
    yield from shared_session(SharedMode.TAG)


def shared_session(mode: SharedMode) -> Iterator[tuple[Session, SharedGame]]:
    scenario = shared_scenario(find_level("first-drive"))
    with Session(scenario) as session:
        game = SharedGame(scenario, mode, session.runner)
        session.runner.observers.append(game)
        yield session, game


def until(session: Session, seconds: float) -> None:
    run_until(session.runner, ticks=round(seconds / session.runner.step_size))


def test_nobody_moves_before_the_start_and_pushes_are_cut(race: tuple[Session, SharedGame]) -> None:
    session, game = race
    begin = game.state.poses
    game.push(0, 1.0, 0.0)
    until(session, 0.3)
    assert game.state.phase is SharedPhase.WAITING
    game.start()
    until(session, COUNTDOWN - 0.1)
    assert game.state.phase is SharedPhase.COUNTDOWN
    assert game.state.poses == begin
    game.push(1, 1e9, -1e9)
    until(session, 1.1)
    assert game.state.phase is SharedPhase.RUNNING
    ways = [math.dist(now[:2], before[:2]) for now, before in zip(game.state.poses, begin, strict=True)]
    assert ways[0] == pytest.approx(0.5, abs=0.1)  # half a metre a second
    assert 0.0 < ways[1] < ways[0] + 0.1


def test_the_first_at_every_target_wins(race: tuple[Session, SharedGame]) -> None:
    session, game = race
    game.start()
    until(session, COUNTDOWN + 0.1)
    for target in session.scenario.targets or ():
        session.runner.call_service("move_model", GUEST, Pose(*target, 0.0))
        until(session, 0.02)
    assert (game.state.phase, game.state.winner) == (SharedPhase.OVER, 1)
    assert game.state.scores == (0.0, float(len(session.scenario.targets)))


def test_a_robot_has_arrived_with_its_nose_as_in_the_game_alone(race: tuple[Session, SharedGame]) -> None:
    session, game = race
    game.start()
    until(session, COUNTDOWN + 0.1)
    assert session.scenario.case is not None
    (x, y), radius = session.scenario.targets[0], session.scenario.case.target_radius
    for away, has_arrived in ((radius + 0.1, False), (radius + 0.04, True)):
        session.runner.call_service("move_model", GUEST, Pose(x, y - away, math.pi / 2))
        until(session, 0.02)
        assert (game.state.scores[1] == 1.0) is has_arrived


def test_each_player_is_shown_the_target_that_is_next_and_a_spectator_both() -> None:
    targets = [(1.0, 1.0), (2.0, 2.0)]
    ahead = replace(STATE, scores=(1.0, 0.0))
    assert ahead.next_targets(targets, 0) == [(2.0, 2.0)]
    assert ahead.next_targets(targets, 1) == [(1.0, 1.0)]
    assert ahead.next_targets(targets, None) == targets
    assert replace(STATE, scores=(2.0, 1.0)).next_targets(targets, None) == [(2.0, 2.0)]


def test_a_game_that_is_reset_at_its_start_is_recorded_and_runs_again(
    race: tuple[Session, SharedGame], tmp_path: Path
) -> None:
    session, game = race
    until(session, 0.5)
    game.start()
    until(session, 0.02)
    session.reset()
    recorder = Recorder.for_scenario(session.scenario, session.runner.simulation)
    session.runner.observers.insert(0, recorder)
    until(session, COUNTDOWN - 0.1)
    assert game.state.seconds == pytest.approx(COUNTDOWN - 0.1, abs=0.02)
    game.push(0, 1.0, 0.0)
    game.push(1, 1.0, 0.2)
    until(session, 1.1)
    assert game.state.phase is SharedPhase.RUNNING
    save_recording(recorder.recording(), tmp_path / "film.npz")
    film = load_recording(tmp_path / "film.npz")
    scenario = recorded_scenario(find_level(film.level or ""), film)
    again = rerun(film, scenario.world)
    assert (again.poses == film.poses).all()
    for player, name in enumerate((scenario.robot or "", GUEST)):
        assert tuple(film.track(name)[-1]) == pytest.approx(game.state.poses[player])
        assert math.dist(film.track(name)[0][:2], film.track(name)[-1][:2]) > 0.3


def test_who_leaves_has_lost(race: tuple[Session, SharedGame]) -> None:
    session, game = race
    game.start()
    until(session, 0.1)
    game.remove_player(1)
    assert game.state.phase is SharedPhase.WAITING  # it had not begun: another may come
    assert game.state.has_left, "the host is told"
    game.start()
    assert not game.state.has_left
    until(session, COUNTDOWN + 0.1)
    game.remove_player(1)
    assert (game.state.phase, game.state.winner, game.state.has_left) == (SharedPhase.OVER, 0, True)
    game.rematch()
    assert not game.state.has_left


def test_in_tag_who_is_caught_catches_and_less_time_wins(
    tag: tuple[Session, SharedGame], monkeypatch: pytest.MonkeyPatch
) -> None:
    session, game = tag
    monkeypatch.setattr(two_players, "TAG_SECONDS", 6.0)
    game.start()
    until(session, COUNTDOWN + 0.1)
    assert game.state.catcher == 0
    until(session, TAG_PAUSE)
    mine = game.state.poses[0]
    session.runner.call_service("move_model", GUEST, Pose(mine.x + 0.25, mine.y, 0.0))
    until(session, 0.05)
    assert game.state.catcher == 0, "who has not moved catches nobody"
    moved = Pose(mine.x + 0.02, mine.y + CATCH_DISTANCE, mine.theta)
    session.runner.call_service("move_model", game.robots[0], moved)
    until(session, 0.05)
    assert game.state.catcher == 1
    until(session, TAG_PAUSE - 0.1)
    assert game.state.catcher == 1  # not at once again
    session.runner.call_service("move_model", GUEST, session.scenario.starts[0])
    until(session, 6.0)
    assert (game.state.phase, game.state.winner) == (
        SharedPhase.OVER,
        int(game.state.scores[1] < game.state.scores[0]),
    )
    assert sum(game.state.scores) == pytest.approx(6.0, abs=0.1)


@pytest.mark.parametrize(
    ("moving", "scores"),
    [
        ((), (8.0, 0.0)),
        ((0,), (STILL_SECONDS, 8.0 - STILL_SECONDS)),
        ((1,), (8.0, 0.0)),
        ((0, 1), (8.0, 0.0)),
    ],
    ids=["nobody moves", "the catcher moves", "the other one moves", "both move"],
)
def test_in_tag_a_second_counts_against_the_one_that_is_chased_where_that_alone_stands_still(
    tag: tuple[Session, SharedGame],
    monkeypatch: pytest.MonkeyPatch,
    moving: tuple[int, ...],
    scores: tuple[float, float],
) -> None:
    session, game = tag
    monkeypatch.setattr(two_players, "TAG_SECONDS", 8.0)
    starts = game.state.poses
    game.start()
    until(session, COUNTDOWN + 0.1)
    for second in range(9):
        for number in moving:
            start = starts[number]
            place = Pose(start.x, start.y + STILL_DISTANCE * (1 + second % 2), start.theta)
            session.runner.call_service("move_model", game.robots[number], place)
        until(session, 1.0)
    assert game.state.catcher == 0, "nobody was caught"
    assert game.state.scores == pytest.approx(scores, abs=0.1)


def test_a_rematch_begins_anew_with_the_other_catching_first_or_waits(
    tag: tuple[Session, SharedGame], monkeypatch: pytest.MonkeyPatch
) -> None:
    session, game = tag
    monkeypatch.setattr(two_players, "TAG_SECONDS", 1.0)
    game.start()
    until(session, COUNTDOWN + 0.5)
    game.rematch()
    game.ask_again()
    assert game.state.phase is SharedPhase.RUNNING  # not before it is over
    until(session, 1.0)
    assert (game.state.phase, game.state.catcher, game.state.winner) == (SharedPhase.OVER, 0, 1)
    assert not game.state.asks_again
    game.ask_again()
    assert game.state.asks_again
    game.rematch()
    session.reset()
    assert not game.state.asks_again
    assert (game.state.phase, game.state.winner, game.state.scores) == (
        SharedPhase.COUNTDOWN,
        None,
        (0.0, 0.0),
    )
    until(session, COUNTDOWN + 1.5)
    assert (game.state.phase, game.state.catcher, game.state.winner) == (SharedPhase.OVER, 1, 0)
    assert game.state.wins == (1, 1)
    game.remove_player(1)
    game.rematch()
    assert game.state.phase is SharedPhase.WAITING  # nobody is there to play against
    game.start()
    assert game.state.phase is SharedPhase.COUNTDOWN
    assert game.state.wins == (0, 0)  # another player


# What the wire lets through


def test_frames_come_back_as_they_were() -> None:
    for request in (JoinRequest("Ada", True), JoinRequest("Ben", False)):
        assert parse_from_guest(encode_join_request(request)) == request
    assert parse_from_guest(encode_push(KeyPush(-1.0, 0.5))) == KeyPush(-1.0, 0.5)
    offer = GameOffer("two-doors", SharedMode.TAG, "Ada", False)
    assert parse_from_host(encode_offer(offer)) == offer
    assert parse_from_guest(encode_rematch_request()) == RematchRequest()
    assert parse_from_host(encode_state(STATE)) == STATE
    asked = replace(
        STATE,
        asks_again=True,
        names=("\N{GRINNING FACE}" * MAX_PLAYER_NAME,) * 2,
        watching=("Eve",),
        has_left=True,
    )
    assert parse_from_host(encode_state(asked)) == asked
    many = replace(asked, watching=asked.names[:1] * 2 * MAX_WATCHING)
    assert len(encode(encode_state(many))) < MAX_FRAME
    assert parse_from_host(encode_state(many)) == replace(many, watching=many.watching[:MAX_WATCHING])


BAD_FROM_GUEST: tuple[Json, ...] = (
    None, 1, "join", [], [[]], ["eval", "1"], ["join"], ["join", VERSION, "a"], ["join", 99, "a", True],
    ["join", VERSION, "a" * 1000, True], ["join", VERSION, "a", 1], ["join", True, "a", True], ["push"], ["push", 1.0],
    ["push", 1.5, 0.0], ["push", 0.0, -1e300], ["push", "1", 0], ["push", True, 0.0], ["push", 10**400, 0.0],
    ["push", None, None], ["push", 0.0, 0.0, 0.0], {"push": 1}, ["again", 1], ["state", "running", 0, [], [], None, None],
)  # fmt: skip
BAD_FROM_HOST: tuple[Json, ...] = (
    ["push", 0.0, 0.0], ["offer", VERSION, "x" * 100, "race", "a", True], ["offer", VERSION, "a", "chess", "a", True],
    ["state", "running", 0.0, [[0, 0, 0]], [0, 0], None, None, ["a", "b"], False, [], False, [0, 0]],
    ["state", "running", 0.0, [[0, 0, 0], [1e9, 0, 0]], [0, 0], None, None, ["a", "b"], False, [], False, [0, 0]],
    ["state", "running", 0.0, [[0, 0, 0], [0, 0]], [0, 0], None, None, ["a", "b"], False, [], False, [0, 0]],
    ["state", "running", 1e99, [[0, 0, 0], [0, 0, 0]], [0, 0], None, None, ["a", "b"], False, [], False, [0, 0]],
    ["state", "running", 0.0, [[0, 0, 0], [0, 0, 0]], [0, 0], 2, None, ["a", "b"], False, [], False, [0, 0]],
    ["state", "running", 0.0, [[0, 0, 0], [0, 0, 0]], [0, 0], None, None, ["a"], False, [], False, [0, 0]],
    ["state", "running", 0.0, [[0, 0, 0], [0, 0, 0]], [0, 0], None, None, ["a" * 1000, "b"], False, [], False, [0, 0]],
    ["state", "running", 0.0, [[0, 0, 0], [0, 0, 0]], [0, 0], None, None, ["a", "b"], False, [], False, [0]],
    ["state", "running", 0.0, [[0, 0, 0], [0, 0, 0]], [0, 0], None, None, ["a", "b"], False, [], False, [0, 0.5]],
    ["state", "sleeping", 0.0, [[0, 0, 0], [0, 0, 0]], [0, 0], None, None, ["a", "b"], False, [], False, [0, 0]],
    ["state", "running", 0.0, [[0, 0, 0], [0, 0, 0]], [0, 0], None, None, ["a", "b"], 1, [], False, [0, 0]],
    ["state", "running", 0.0, [[0, 0, 0], [0, 0, 0]], [0, 0], None, None, ["a", "b"], False, [], 1, [0, 0]],
    ["state", "running", 0.0, [[0, 0, 0], [0, 0, 0]], [0, 0], None, None, ["a", "b"], False, ["a"] * 99, False, [0, 0]],
    ["state", "running", 0.0, [[0, 0, 0], [0, 0, 0]], [0, 0], None, None, ["a", "b"], False, ["a" * 99], False, [0, 0]],
)  # fmt: skip


@every_case("frame", BAD_FROM_GUEST)
def test_a_guest_can_say_nothing_else(frame: Json) -> None:
    with pytest.raises(ProtocolError):
        parse_from_guest(frame)


@every_case("frame", BAD_FROM_HOST)
def test_a_host_can_say_nothing_else(frame: Json) -> None:
    with pytest.raises(ProtocolError):
        parse_from_host(frame)


def test_numbers_and_names_of_frames_go_up_to_their_limits() -> None:
    def state(seconds: float, x: float, score: float, name: str, catches: int = 0) -> Json:
        return [
            "state",
            "running",
            seconds,
            [[0, 0, 0], [x, 0, 0]],
            [0, score],
            None,
            None,
            [name, "b"],
            False,
            [],
            False,
            [0, 0],
            [score] * catches,
        ]

    most = (MAX_SECONDS, -MAX_COORDINATE, MAX_SECONDS, "n" * MAX_PLAYER_NAME)
    found = parse_from_host(state(*most))
    assert isinstance(found, SharedGameState)
    assert (found.seconds, found.poses[1].x, found.scores[1], found.names[0]) == most
    for place, message in enumerate(
        ("beyond 1e\\+06", "beyond 10000", "beyond 1e\\+06", "at most 24 characters")
    ):
        beyond = [each + each[:1] if isinstance(each, str) else each * 1.001 for each in most]
        with pytest.raises(ProtocolError, match=message):
            parse_from_host(state(*most[:place], beyond[place], *most[place + 1 :]))
    with pytest.raises(ProtocolError, match="more than 64 catches"):
        parse_from_host(state(*most, catches=65))
    level, name = "l" * MAX_LEVEL_NAME, "n" * MAX_PLAYER_NAME
    assert parse_from_host(["offer", VERSION, level, "race", name, True]) == GameOffer(
        level, SharedMode.RACE, name, True
    )
    for offered in ((level + "l", name), (level, name + "n")):
        with pytest.raises(ProtocolError, match="not a text of at most"):
            parse_from_host(["offer", VERSION, offered[0], "race", offered[1], True])


def test_a_name_cannot_steer_a_terminal() -> None:
    found = parse_from_guest(["join", VERSION, "\x1b[2J\n Ada ", True])
    assert isinstance(found, JoinRequest)
    assert found.name.isprintable()
    assert "Ada" in found.name
    assert parse_from_guest(["join", VERSION, "  ", True]) == JoinRequest("somebody", True)


# The host


@dataclass
class Rules:
    """Notes what it is told."""

    mode: SharedMode = SharedMode.RACE
    told: list[tuple[object, ...]] = field(default_factory=list)

    def push(self, player: int, linear: float, angular: float) -> None:
        self.told.append(("push", player, linear, angular))

    def start(self) -> None:
        self.told.append(("start",))

    def ask_again(self) -> None:
        self.told.append(("again",))

    def remove_player(self, player: int) -> None:
        self.told.append(("leave", player))


@pytest.fixture
def server(tmp_path: Path) -> Iterator[tuple[SharedGameServer, Rules, FoundGame]]:
    rules = Rules()
    opened = SharedGameServer(tmp_path / "games", "two-doors", "Ada", rules, Audience())
    try:
        yield opened, rules, find_game(tmp_path / "games", None)
    finally:
        opened.close()
        assert not opened.path.exists()


Opened = tuple[SharedGameServer, Rules, FoundGame]


def test_a_guest_plays_another_watches_and_both_are_told(server: Opened) -> None:
    opened, rules, game = server
    seen: list[SharedGameState] = []
    also: list[SharedGameState] = []
    with SharedGameClient(game, "Ben", plays=True) as ben, SharedGameClient(game, "Eve", plays=True) as eve:
        assert ben.offer == GameOffer("two-doors", SharedMode.RACE, "Ada", True)
        assert not eve.offer.plays  # two play already
        ben.follow(seen.append, lambda reason: None)
        eve.follow(also.append, lambda reason: None)
        ben.push(1.0, -0.5)
        eve.push(-1.0, 0.0)
        wait_until(lambda: ("push", 1, 1.0, -0.5) in rules.told)
        told = opened.publish(STATE)
        wait_until(lambda: seen and also)
        assert seen[0] == also[0] == told == replace(STATE, names=("Ada", "Ben"), watching=("Eve",))
        assert (opened.player_name, opened.spectators) == ("Ben", ("Eve",))
        eve.ask_again()
        ben.ask_again()
        wait_until(lambda: ("again",) in rules.told)
    wait_until(lambda: ("leave", 1) in rules.told)
    assert rules.told[0] == ("start",)
    assert rules.told.count(("again",)) == 1  # who watches asks for nothing
    assert ("push", 1, -1.0, 0.0) not in rules.told  # who watches moves nobody
    wait_until(lambda: not opened.player_name)
    assert opened.publish(STATE).names == ("Ada", "Ben")  # who has left keeps the name
    opened._player_name = "Ada"  # one user in two terminals
    assert opened.publish(STATE).names == ("Ada 1", "Ada 2")
    with SharedGameClient(game, "Cleo", plays=True) as cleo:
        assert cleo.offer.plays  # the place is free again


def test_a_guest_is_told_that_the_host_has_gone(server: Opened) -> None:
    opened, _, game = server
    ends: list[str] = []
    with SharedGameClient(game, "Ben", plays=True) as ben:
        ben.follow(lambda state: None, ends.append)
        opened.close()
        wait_until(lambda: ends)
    assert ends == ["the host has gone"]


def closes(connection: socket.socket, within: float = 10.0) -> bool:
    """Whether the other side ends the connection."""
    connection.settimeout(within)
    try:
        while connection.recv(4096):
            pass
    except ConnectionError:
        return True
    except TimeoutError:
        return False
    return True


GARBAGE = {
    "not a frame": b"GET / HTTP/1.1\r\n\r\n",
    "a frame of four gigabytes": b"\xff\xff\xff\xff",
    "a frame just too large": HEADER.pack(MAX_FRAME + 1) + b"[" * 10,
    "no JSON": HEADER.pack(4) + b"\x80\x81\x82\x83",
    "deep": HEADER.pack(1000) + b"[" * 1000,
    "a huge number": (lambda data: HEADER.pack(len(data)) + data)(b'["push",' + b"9" * 900 + b",0]"),
    "infinity": (lambda data: HEADER.pack(len(data)) + data)(b'["push",1e999,0]'),
    "NaN": (lambda data: HEADER.pack(len(data)) + data)(b'["push",NaN,0]'),
    "a push before the request": encode(["push", 0.0, 0.0]),
    "two requests": encode(["join", VERSION, "a", True]) * 2,
    "another version": encode(["join", 99, "a", True]),
    "an empty frame": HEADER.pack(0),
}


def test_garbage_ends_its_own_connection_and_nothing_else(server: Opened) -> None:
    opened, rules, game = server

    with SharedGameClient(game, "Ben", plays=True) as ben:
        ben.follow(lambda state: None, lambda reason: None)
        for name, data in GARBAGE.items():
            with game.connect() as connection:
                connection.sendall(data)
                assert closes(connection), name
        ben.push(1.0, 1.0)
        wait_until(lambda: ("push", 1, 1.0, 1.0) in rules.told)
    assert len(opened.refused) == len(GARBAGE)


def test_a_flood_is_cut_off(server: Opened) -> None:
    opened, rules, game = server
    with game.connect() as connection:
        connection.sendall(encode(["join", VERSION, "a", True]))
        flood = encode(["push", 1.0, 0.0]) * 1_000_000
        with pytest.raises(ConnectionError):
            connection.sendall(flood)
    assert any("frames a second" in reason for reason in opened.refused)
    pushes = [each for each in rules.told if each[0] == "push"]
    assert len(pushes) < 3 * MAX_BURST
    assert rules.told[-1] == ("leave", 1)


@pytest.mark.long
def test_who_says_nothing_or_half_a_frame_or_does_not_read_is_cut_off(
    server: Opened, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened, _, game = server
    monkeypatch.setattr(shared_server, "JOIN_WITHIN", 0.2)
    monkeypatch.setattr(shared_server, "FRAME_WITHIN", 0.2)
    with game.connect() as connection:
        assert closes(connection)
    with game.connect() as connection:
        connection.sendall(encode(["join", VERSION, "a", False]) + b"\0")
        assert closes(connection)
    monkeypatch.setattr(shared_server, "JOIN_WITHIN", 3.0)
    connection = game.connect()
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    connection.sendall(encode(["join", VERSION, "a", False]))
    wait_until(lambda: opened.spectators == ("a",))
    deadline = time.monotonic() + 20
    while opened.spectators and time.monotonic() < deadline:
        opened.publish(STATE)
        time.sleep(0.0005)
    assert not opened.spectators
    connection.close()
    assert opened.refused == ["no request in time", "a frame that does not end", "it does not read"]


def test_no_more_guests_than_there_is_room_for(server: Opened) -> None:
    opened, _, game = server
    connections = [game.connect() for _ in range(shared_server.MAX_GUESTS)]
    wait_until(lambda: len(opened._guests) == shared_server.MAX_GUESTS)
    with game.connect() as one_more:
        assert closes(one_more)
    assert opened.refused == ["too many guests"]
    for each in connections:
        each.close()


def test_one_other_user_takes_only_a_part_of_the_room(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    users = [os.getuid() + 1] * (shared_server.MAX_OF_ONE_USER + 1) + [os.getuid() + 2, os.getuid()]
    asking = iter(users)
    monkeypatch.setattr(shared_server, "peer_user", lambda connection: next(asking))
    opened = SharedGameServer(tmp_path / "games", "two-doors", "Ada", Rules(), Audience(everybody=True))
    game = FoundGame(opened.path, os.getuid())  # not looked for: a search connects too
    with ExitStack() as stack:
        stack.callback(opened.close)
        for _ in users:
            stack.enter_context(game.connect())
        wait_until(lambda: len(opened._guests) + len(opened.refused) == len(users))
        assert [guest.user for guest in opened._guests] == users[: shared_server.MAX_OF_ONE_USER] + users[-2:]
        assert opened.refused == ["too many guests"]


# Who may come in


def test_a_game_is_open_to_those_it_was_opened_to(tmp_path: Path) -> None:
    modes = {
        Audience(): (0o700, 0o600),
        Audience(os.getgid()): (0o750, 0o660),
        Audience(everybody=True): (0o755, 0o666),
    }
    for number, (audience, (folder_mode, socket_mode)) in enumerate(modes.items()):
        listener, path = listen_for_guests(tmp_path / f"games{number}", "race", audience)
        listener.close()
        assert path.parent.stat().st_mode & 0o777 == folder_mode
        assert path.stat().st_mode & 0o777 == socket_mode
        assert path.parent.name == str(os.getuid())
        assert path.parent.parent.stat().st_mode & 0o7777 == 0o1777
    nobody = 65534
    assert Audience(everybody=True).admits(nobody)
    assert not Audience().admits(nobody)
    assert not Audience(os.getgid()).admits(3_999_999)
    assert Audience(os.getgid()).admits(os.getuid())
    with pytest.raises(SharedGameError, match="no group"):
        Audience.of_group("no-such-group-here")


def test_a_folder_that_others_could_change_is_refused(tmp_path: Path) -> None:
    open_to_all = tmp_path / "games"
    open_to_all.mkdir()
    open_to_all.chmod(0o777)
    with pytest.raises(SharedGameError, match=r"chmod \+t"):
        listen_for_guests(open_to_all, "race", Audience())
    a_file = tmp_path / "file"
    a_file.write_text("")
    with pytest.raises(SharedGameError):
        listen_for_guests(a_file, "race", Audience())


def test_what_is_not_its_owners_socket_is_not_found(tmp_path: Path) -> None:
    games = tmp_path / "games"
    for name in (str(os.getuid() + 1), "ada", str(os.getuid())):
        (games / name).mkdir(parents=True)
        (games / name / "race-1.sock").write_text("no socket")
    assert found_games(games) == []
    with pytest.raises(SharedGameError, match="Nobody is hosting"):
        find_game(games, None)
    listener, path = listen_for_guests(tmp_path / "others", "race", Audience())
    (tmp_path / "others" / str(os.getuid() + 1)).symlink_to(path.parent)
    assert [game.path for game in found_games(tmp_path / "others")] == [path]
    assert find_game(tmp_path / "others", "race").path == path
    listener.close()
    with pytest.raises(SharedGameError, match="Nobody is hosting"):
        find_game(tmp_path / "others", "race")
    # Another user answers where this one's socket should be.
    stranger = FoundGame(path, os.getuid() + 1)
    with pytest.raises(SharedGameError):
        stranger.connect()


def test_a_host_that_lies_is_left(tmp_path: Path) -> None:
    listener, path = listen_for_guests(tmp_path / "games", "race", Audience())
    game = FoundGame(path, os.getuid())
    frames: list[bytes] = [
        encode(["state", "running", 0.0, [[0, 0, 0], [0, 0, 0]], [0, 0], None, None, ["a", "b"]]),
        struct.pack(">I", 2**31),
        encode(["offer", VERSION, "../../etc/passwd" * 10, "race", "a", True]),
        json.dumps(["offer"]).encode(),
    ]

    def lie() -> None:
        for frame in frames:
            connection, _ = listener.accept()
            connection.sendall(frame)
            connection.shutdown(socket.SHUT_WR)
            connection.close()

    threading.Thread(target=lie, daemon=True).start()
    for _ in frames:
        with pytest.raises(SharedGameError, match="does not let you in"):
            SharedGameClient(game, "Ben", plays=True)
    listener.close()


@pytest.mark.long
def test_a_host_that_sends_a_frame_byte_by_byte_is_left(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shared_server, "SILENCE", 0.5)
    listener, path = listen_for_guests(tmp_path / "games", "race", Audience())
    has_left = threading.Event()

    def dribble() -> None:
        connection, _ = listener.accept()
        with suppress(OSError):
            for byte in encode(encode_offer(GameOffer("first-drive", SharedMode.RACE, "a", True))):
                connection.sendall(bytes([byte]))
                has_left.wait(0.05)
        connection.close()

    threading.Thread(target=dribble, daemon=True).start()
    with pytest.raises(SharedGameError, match="does not let you in"):
        SharedGameClient(FoundGame(path, os.getuid()), "Ben", plays=True)
    has_left.set()
    listener.close()


def test_a_game_of_tag_in_which_nobody_catches_is_left(tmp_path: Path) -> None:
    rules = Rules()
    rules.mode = SharedMode.TAG
    ended: list[str] = []
    with ExitStack() as stack:
        opened = SharedGameServer(tmp_path / "games", "two-doors", "Ada", rules, Audience())
        stack.callback(opened.close)
        guest = stack.enter_context(SharedGameClient(find_game(tmp_path / "games", None), "Ben", plays=True))
        guest.follow(lambda state: None, ended.append)
        opened.publish(replace(STATE, catcher=None))
        wait_until(lambda: ended)
    assert ended == ["it sent a game of tag without a catcher"]


@pytest.mark.long
def test_a_guest_that_takes_long_to_open_its_screen_is_not_taken_for_gone(
    server: Opened, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened, rules, game = server
    monkeypatch.setattr(shared_server, "SILENCE", 0.5)
    monkeypatch.setattr(shared_server, "KEEP_ALIVE", 0.1)
    with SharedGameClient(game, "Ben", plays=True):
        wait_until(lambda: len([each for each in rules.told if each[0] == "push"]) > 10)
        assert opened.player_name == "Ben"
    assert opened.refused == []


def test_what_another_user_calls_a_socket_reaches_no_terminal(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = tmp_path / str(os.getuid())
    own.mkdir()
    monkeypatch.chdir(own)  # a socket's path must be short
    with socket.socket(socket.AF_UNIX) as good, socket.socket(socket.AF_UNIX) as bad:
        for listener, name in ((good, "first_drive-4711"), (bad, "\x1b]0;owned\x07-4711")):
            listener.bind(f"{name}.sock")
            listener.listen()
        assert sorted(own.glob("*.sock")) != [own / "first_drive-4711.sock"]  # the other one is there too
        assert [game.name for game in found_games(tmp_path)] == ["first_drive-4711"]


def test_thousands_of_sockets_hold_up_no_search(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shared_sockets, "MAX_SOCKETS_OF_ONE_USER", 3)
    own = tmp_path / str(os.getuid())
    own.mkdir()
    monkeypatch.chdir(own)
    for number in range(1, 6):
        with socket.socket(socket.AF_UNIX) as listener:
            listener.bind(f"g-{number}.sock")
    assert len(found_games(tmp_path)) == 3


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere a full queue is refused at once")
def test_a_host_that_lets_nobody_in_holds_nobody_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sockets, "CONNECT_S", 0.05)
    monkeypatch.chdir(tmp_path)
    with socket.socket(socket.AF_UNIX) as listener, ExitStack() as waiting:
        listener.bind("full-1.sock")
        listener.listen(0)
        for _ in range(10):  # until its queue is full
            each = waiting.enter_context(socket.socket(socket.AF_UNIX))
            each.setblocking(False)
            with suppress(BlockingIOError):
                each.connect("full-1.sock")
        done = threading.Event()

        def guest() -> None:
            with pytest.raises(SharedGameError, match="cannot be joined"):
                FoundGame(Path("full-1.sock"), os.getuid()).connect()
            done.set()

        threading.Thread(target=guest, daemon=True).start()
        assert done.wait(30.0)
