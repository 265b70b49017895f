"""The protocol between the two processes of a shared game, frame by frame, and the checks of what is read.

A guest asks to come in, then sends the pushes of its keys. The host says which level is played, then how things stand. A frame
is one JSON list as in ``kit.host.wire``; whatever else arrives is a ProtocolError, which ends the connection.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from kit.geometry import Pose
from kit.host.wire import Json, ProtocolError, boolean, integer, items, number, text
from kit.school.game.two_players import PLAYERS, SharedGameState, SharedMode, SharedPhase

VERSION: Final = 6
MAX_FRAME: Final = 4096
"""Bytes of a frame, in both directions."""
MAX_PLAYER_NAME: Final = 24
MAX_LEVEL_NAME: Final = 64
MAX_WATCHING: Final = 8
MAX_CATCHES: Final = 64
"""Names of spectators in a frame."""
MAX_COORDINATE: Final = 1e4
"""A pose beyond this [m] is no pose of a world of the kit."""
MAX_SECONDS: Final = 1e6
MAX_RATE: Final = 60.0
"""Frames a guest may send per second, on the average."""
MAX_BURST: Final = 120.0
"""Frames a guest may send at once."""
SILENCE: Final = 5.0
"""Seconds without a frame after which the other side is taken for gone."""
KEEP_ALIVE: Final = 1.0
"""Seconds after which a guest says again what it pushes."""


@dataclass(frozen=True, slots=True)
class JoinRequest:
    """A guest's first frame."""

    name: str
    plays: bool
    """False: it only watches."""


@dataclass(frozen=True, slots=True)
class KeyPush:
    """What a guest's keys ask for now."""

    linear: float
    """Forward, -1 to 1."""
    angular: float
    """Turn to the left, -1 to 1."""


@dataclass(frozen=True, slots=True)
class RematchRequest:
    """A guest that plays asks for another game."""


@dataclass(frozen=True, slots=True)
class GameOffer:
    """The host's answer to a request."""

    level: str
    """Id of a level of the kit: both load it from their own files."""
    mode: SharedMode
    name: str
    """Name of the host's player."""
    plays: bool
    """Whether the guest plays; two play already where it asked to and may not."""


def encode_join_request(request: JoinRequest) -> Json:
    """A guest's first frame."""
    return ["join", VERSION, request.name, request.plays]


def encode_push(push: KeyPush) -> Json:
    """A guest's later frames."""
    return ["push", push.linear, push.angular]


def encode_rematch_request() -> Json:
    """A guest's frame after a game that is over."""
    return ["again"]


def encode_offer(offer: GameOffer) -> Json:
    """The host's first frame."""
    return ["offer", VERSION, offer.level, offer.mode.value, offer.name, offer.plays]


def encode_state(state: SharedGameState) -> Json:
    """The host's later frames."""
    poses: Json = [[round(each, 4) for each in pose] for pose in state.poses]
    scores: Json = [round(each, 2) for each in state.scores]
    watching: Json = list(state.watching[:MAX_WATCHING])
    who: Json = [state.catcher, state.winner, list(state.names), state.asks_again, watching, state.has_left]
    catches: Json = [round(each, 2) for each in state.catches[:MAX_CATCHES]]
    return [
        "state",
        state.phase.value,
        round(state.seconds, 3),
        poses,
        scores,
        *who,
        list(state.wins),
        catches,
    ]


def parse_from_guest(frame: Json) -> JoinRequest | KeyPush | RematchRequest:
    """Raises ProtocolError for anything that a guest must not send."""
    kind, *rest = items(frame) or [None]
    if kind == "join":
        version, name, plays = items(rest, 3)
        _check_version(version)
        return JoinRequest(_read_name(name), boolean(plays))
    if kind == "push":
        linear, angular = items(rest, 2)
        return KeyPush(_read_share(linear), _read_share(angular))
    if kind == "again":
        items(rest, 0)
        return RematchRequest()
    raise ProtocolError("a frame of an unknown kind")


def parse_from_host(frame: Json) -> GameOffer | SharedGameState:
    """Raises ProtocolError for anything that a host must not send."""
    kind, *rest = items(frame) or [None]
    if kind == "offer":
        version, level, mode, name, plays = items(rest, 5)
        _check_version(version)
        return GameOffer(
            text(level, MAX_LEVEL_NAME),
            SharedMode(_one_of(mode, SharedMode)),
            _read_name(name),
            boolean(plays),
        )
    if kind == "state":
        (
            phase,
            seconds,
            poses,
            scores,
            catcher,
            winner,
            names,
            asks_again,
            watching,
            has_left,
            wins,
            catches,
        ) = items(rest, 12)
        if len(items(catches)) > MAX_CATCHES:
            raise ProtocolError(f"more than {MAX_CATCHES} catches")
        if len(items(watching)) > MAX_WATCHING:
            raise ProtocolError(f"more than {MAX_WATCHING} spectators")
        return SharedGameState(
            SharedPhase(_one_of(phase, SharedPhase)),
            _read_bounded(seconds, MAX_SECONDS),
            tuple(_read_pose(each) for each in items(poses, PLAYERS)),
            tuple(_read_bounded(each, MAX_SECONDS) for each in items(scores, PLAYERS)),
            _read_player(catcher),
            _read_player(winner),
            tuple(text(each, MAX_PLAYER_NAME) for each in items(names, PLAYERS)),
            boolean(asks_again),
            tuple(_read_name(each) for each in items(watching)),
            boolean(has_left),
            tuple(int(_read_bounded(integer(each), MAX_SECONDS)) for each in items(wins, PLAYERS)),
            tuple(_read_bounded(each, MAX_SECONDS) for each in items(catches)),
        )
    raise ProtocolError("a frame of an unknown kind")


def _check_version(value: Json) -> None:
    if integer(value) != VERSION:
        raise ProtocolError(f"version {value} of the game; this is {VERSION}")


def _one_of(value: Json, kind: type[SharedMode] | type[SharedPhase]) -> str:
    found = text(value, MAX_LEVEL_NAME)
    if found not in [each.value for each in kind]:
        raise ProtocolError(f"an unknown word: {found}")
    return found


def _read_name(value: Json) -> str:
    """Returns a name without spaces around it, and never empty."""
    return " ".join(text(value, MAX_PLAYER_NAME).split()) or "somebody"


def _read_bounded(value: Json, limit: float) -> float:
    found = number(value)
    if abs(found) > limit:
        raise ProtocolError(f"a number beyond {limit:g}")
    return found


def _read_share(value: Json) -> float:
    return _read_bounded(value, 1.0)


def _read_pose(value: Json) -> Pose:
    x, y, theta = (_read_bounded(each, MAX_COORDINATE) for each in items(value, 3))
    return Pose(x, y, theta)


def _read_player(value: Json) -> int | None:
    return None if value is None else integer(value, 0, PLAYERS - 1)
