"""Both ends of a shared game: the host admits guests, reads their keys, and sends everyone the state."""

from __future__ import annotations

import os
import selectors
import socket
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import TracebackType
from typing import Final, Protocol, Self

from kit.host.wire import HEADER, Json, ProtocolError, decode, encode
from kit.inspection.sockets import FramedSocket
from kit.school.game.shared_protocol import (
    KEEP_ALIVE,
    MAX_BURST,
    MAX_FRAME,
    MAX_RATE,
    SILENCE,
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
from kit.school.game.shared_sockets import Audience, FoundGame, SharedGameError, listen_for_guests, peer_user
from kit.school.game.two_players import SharedGameState, SharedMode

MAX_GUESTS: Final = 16
MAX_OF_ONE_USER: Final = 4
JOIN_WITHIN: Final = 3.0
"""Seconds from the connection to the request."""
FRAME_WITHIN: Final = 2.0
"""Seconds in which a frame that has begun must be complete, and in which one that is sent must be taken."""
LOOK_INTERVAL: Final = 0.1
"""Seconds between two looks at the clock while nothing comes."""


class SharedGameRules(Protocol):
    """What the server needs of the game."""

    @property
    def mode(self) -> SharedMode: ...

    def push(self, player: int, linear: float, angular: float) -> None: ...

    def start(self) -> None: ...

    def ask_again(self) -> None: ...

    def remove_player(self, player: int) -> None: ...


@dataclass(slots=True, eq=False)
class _Guest:
    """One connection."""

    connection: socket.socket
    user: int | None
    since: float
    heard: float
    name: str = ""
    plays: bool = False
    has_joined: bool = False
    credit: float = MAX_BURST
    received: bytearray = field(default_factory=bytearray)
    receiving_since: float | None = None
    sending: bytes = b""
    sending_since: float = 0.0
    waiting: bytes | None = None
    """The newest state that could not be sent yet."""


class SharedGameServer:
    """Opens when it is made, and raises SharedGameError if it cannot. Close it, or use it as a context manager.

    ``on_change``: called in the server's thread when somebody has come or gone; ``guests`` and ``player_name`` tell who is
    there.
    """

    def __init__(
        self,
        folder: Path,
        level: str,
        name: str,
        game: SharedGameRules,
        audience: Audience,
        *,
        on_change: Callable[[], object] = lambda: None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._level, self._name, self._game, self._audience = level, name, game, audience
        self._on_change = on_change
        self._clock = clock
        self._guests: list[_Guest] = []
        self._newest: bytes | None = None
        self._player_name = ""
        self._is_closed = False
        self.refused: list[str] = []
        """Why guests were disconnected, in their order; the newest hundred."""
        self._listener, self.path = listen_for_guests(folder, level, audience)
        self._listener.setblocking(False)
        self._wake_in, self._wake_out = socket.socketpair()
        for each in (self._wake_in, self._wake_out):
            each.setblocking(False)
        self._selector = selectors.DefaultSelector()
        self._selector.register(self._listener, selectors.EVENT_READ)
        self._selector.register(self._wake_out, selectors.EVENT_READ)
        self._thread = threading.Thread(target=self._serve, name="shared-game", daemon=True)
        self._thread.start()

    @property
    def player_name(self) -> str:
        """Name of the second player; empty if there is none."""
        return next((guest.name for guest in list(self._guests) if guest.plays), "")

    @property
    def spectators(self) -> tuple[str, ...]:
        """The names of the guests that only watch."""
        return tuple(guest.name for guest in list(self._guests) if guest.has_joined and not guest.plays)

    def publish(self, state: SharedGameState) -> SharedGameState:
        """Tells everybody how things stand, and returns it, with the names of all; a player who has left keeps the name. Of
        several states that could not be sent yet only the newest is."""
        self._player_name = self.player_name or self._player_name
        names = self._name, self._player_name
        if names[0] == names[1]:  # one user in two terminals
            names = f"{names[0]} 1", f"{names[1]} 2"
        named = replace(state, names=names, watching=self.spectators)
        self._newest = encode(encode_state(named))
        self._wake()
        return named

    def close(self) -> None:
        """Disconnects everybody and removes the socket. May be called twice."""
        if self._is_closed:
            return
        self._is_closed = True
        self._wake()
        self._thread.join(FRAME_WITHIN)
        with suppress(FileNotFoundError):
            self.path.unlink()

    def _wake(self) -> None:
        with suppress(OSError):  # full, or closed: it is awake
            self._wake_in.send(b"x")

    # In the server's thread

    def _serve(self) -> None:
        while not self._is_closed:
            for key, events in self._selector.select(LOOK_INTERVAL):
                if key.fileobj is self._listener:
                    self._accept()
                elif key.fileobj is self._wake_out:
                    with suppress(OSError):
                        self._wake_out.recv(4096)
                else:
                    self._serve_guest(key.data, events)
            self._hand_out()
            now = self._clock()
            for guest in list(self._guests):
                if reason := _overdue_reason(guest, now):
                    self._drop(guest, reason)
        for guest in list(self._guests):
            self._drop(guest, "")
        for each in (self._listener, self._wake_in, self._wake_out):
            each.close()
        self._selector.close()

    def _accept(self) -> None:
        try:
            connection, _ = self._listener.accept()
        except OSError:
            return
        connection.setblocking(False)
        user, now = peer_user(connection), self._clock()
        of_same = sum(guest.user == user for guest in self._guests)
        is_own = user in (None, os.getuid())
        if user is not None and not self._audience.admits(user):
            self._refuse(connection, f"user {user} may not come in")
        elif len(self._guests) >= MAX_GUESTS or (of_same >= MAX_OF_ONE_USER and not is_own):
            self._refuse(connection, "too many guests")
        else:
            guest = _Guest(connection, user, now, now)
            self._guests.append(guest)
            self._selector.register(connection, selectors.EVENT_READ, guest)

    def _refuse(self, connection: socket.socket, reason: str) -> None:
        self._note_refusal(reason)
        connection.close()

    def _note_refusal(self, reason: str) -> None:
        if reason:
            self.refused = [*self.refused, reason][-100:]

    def _serve_guest(self, guest: _Guest, events: int) -> None:
        if guest not in self._guests:
            return  # dropped in this very round
        try:
            if events & selectors.EVENT_WRITE:
                self._send_rest(guest)
            if events & selectors.EVENT_READ:
                self._receive(guest)
        except ProtocolError as error:
            self._drop(guest, str(error))
        except OSError:
            self._drop(guest, "")

    def _receive(self, guest: _Guest) -> None:
        """Reads what is there, at most a frame's bytes at a time, so that nobody keeps the others waiting."""
        try:
            data = guest.connection.recv(MAX_FRAME)
        except BlockingIOError:
            return
        if not data:
            raise ConnectionResetError
        now = self._clock()
        guest.received += data
        while len(guest.received) >= HEADER.size:
            (length,) = HEADER.unpack_from(guest.received)
            if length > MAX_FRAME:
                raise ProtocolError(f"a frame of {length} bytes; {MAX_FRAME} are allowed")
            if len(guest.received) < HEADER.size + length:
                break
            frame = decode(bytes(guest.received[HEADER.size : HEADER.size + length]))
            del guest.received[: HEADER.size + length]
            guest.receiving_since = None
            self._take_frame(guest, frame, now)
        if guest.received and guest.receiving_since is None:
            guest.receiving_since = now

    def _take_frame(self, guest: _Guest, frame: Json, now: float) -> None:
        guest.credit = min(MAX_BURST, guest.credit + (now - guest.heard) * MAX_RATE) - 1.0
        guest.heard = now
        if guest.credit < 0.0:
            raise ProtocolError(f"more than {MAX_RATE:g} frames a second")
        content = parse_from_guest(frame)
        if isinstance(content, JoinRequest) and not guest.has_joined:
            self._join(guest, content)
        elif isinstance(content, KeyPush) and guest.has_joined:
            if guest.plays:
                self._game.push(1, content.linear, content.angular)
        elif isinstance(content, RematchRequest) and guest.has_joined:
            if guest.plays:
                self._game.ask_again()
        else:
            raise ProtocolError("a frame at the wrong time")

    def _join(self, guest: _Guest, request: JoinRequest) -> None:
        guest.has_joined, guest.name = True, request.name
        guest.plays = request.plays and not any(each.plays for each in self._guests)
        guest.sending = encode(encode_offer(GameOffer(self._level, self._game.mode, self._name, guest.plays)))
        guest.sending_since = self._clock()
        self._send_rest(guest)
        if guest.plays:
            self._game.start()
        self._on_change()

    def _hand_out(self) -> None:
        newest, self._newest = self._newest, None
        if newest is None:
            return
        for guest in list(self._guests):
            if not guest.has_joined:
                continue
            if guest.sending:
                guest.waiting = newest
                continue
            guest.sending, guest.sending_since = newest, self._clock()
            try:
                self._send_rest(guest)
            except OSError:
                self._drop(guest, "")

    def _send_rest(self, guest: _Guest) -> None:
        while guest.sending:
            try:
                sent = guest.connection.send(guest.sending)
            except BlockingIOError:
                break
            guest.sending = guest.sending[sent:]
            if not guest.sending and guest.waiting is not None:
                guest.sending, guest.waiting, guest.sending_since = guest.waiting, None, self._clock()
        wanted = selectors.EVENT_READ | (selectors.EVENT_WRITE if guest.sending else 0)
        self._selector.modify(guest.connection, wanted, guest)

    def _drop(self, guest: _Guest, reason: str) -> None:
        self._note_refusal(reason)
        self._guests.remove(guest)
        with suppress(KeyError, ValueError):
            self._selector.unregister(guest.connection)
        if guest.plays:
            self._game.remove_player(1)
        guest.connection.close()
        if guest.has_joined and not self._is_closed:
            self._on_change()


def _overdue_reason(guest: _Guest, now: float) -> str:
    """Why a guest is to be disconnected by now; empty: it is not."""
    if not guest.has_joined and now - guest.since > JOIN_WITHIN:
        return "no request in time"
    if guest.receiving_since is not None and now - guest.receiving_since > FRAME_WITHIN:
        return "a frame that does not end"
    if guest.sending and now - guest.sending_since > FRAME_WITHIN:
        return "it does not read"
    if guest.has_joined and now - guest.heard > SILENCE:
        return "silence"
    return ""


class SharedGameClient:
    """Connects when it is made; close it, or use it as a context manager. Raises SharedGameError if it cannot come in.

    It says by itself, from then on, that it is still here. ``follow`` has its callbacks called in a thread of its own.
    """

    def __init__(self, game: FoundGame, name: str, *, plays: bool) -> None:
        connection = game.connect()
        connection.settimeout(SILENCE)
        self._socket = FramedSocket(connection, largest_frame=MAX_FRAME, longest_wait_s=2 * SILENCE)
        self._push = KeyPush(0.0, 0.0)
        self._asks_again = False
        self._has_news = threading.Event()
        self._is_closed = False
        try:
            self._socket.send(encode_join_request(JoinRequest(name, plays)))
            offer = parse_from_host(self._socket.receive())
        except (EOFError, OSError, ProtocolError) as error:
            self._socket.close()
            raise SharedGameError(f"{game.name} does not let you in: {_error_text(error)}.") from error
        if not isinstance(offer, GameOffer):
            self._socket.close()
            raise SharedGameError(f"{game.name} does not let you in: it did not say what is played.")
        self.offer = offer
        # From now on, for a screen may take longer to open than silence is allowed to last.
        threading.Thread(target=self._send, name="shared-game-out", daemon=True).start()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def follow(self, on_state: Callable[[SharedGameState], object], on_end: Callable[[str], object]) -> None:
        """Calls ``on_state`` with every state, and ``on_end`` with the reason when the game is gone."""
        threading.Thread(
            target=self._receive, args=(on_state, on_end), name="shared-game-in", daemon=True
        ).start()

    def push(self, linear: float, angular: float) -> None:
        """Says what the keys ask for now, forward and left, each from -1 to 1. Does not wait."""
        self._push = KeyPush(min(max(linear, -1.0), 1.0), min(max(angular, -1.0), 1.0))
        self._has_news.set()

    def ask_again(self) -> None:
        """Asks the host for another game. Does not wait."""
        self._asks_again = True
        self._has_news.set()

    def close(self) -> None:
        """Leaves the game. May be called twice."""
        self._is_closed = True
        self._has_news.set()
        self._socket.close()

    def _receive(
        self, on_state: Callable[[SharedGameState], object], on_end: Callable[[str], object]
    ) -> None:
        try:
            while True:
                content = parse_from_host(self._socket.receive())
                if not isinstance(content, SharedGameState):
                    raise ProtocolError("a second offer")
                if self.offer.mode is SharedMode.TAG and content.catcher is None:
                    raise ProtocolError("a game of tag without a catcher")
                on_state(content)
        except (EOFError, OSError, ProtocolError) as error:
            if not self._is_closed:
                on_end(_error_text(error))

    def _send(self) -> None:
        """The newest push, at most fifty times a second, and now and then to say that somebody is still here."""
        with suppress(EOFError, OSError):
            while not self._is_closed:
                self._has_news.wait(KEEP_ALIVE)
                self._has_news.clear()
                if self._asks_again:
                    self._asks_again = False
                    self._socket.send(encode_rematch_request())
                self._socket.send(encode_push(self._push))
                time.sleep(0.02)


def _error_text(error: Exception) -> str:
    if isinstance(error, TimeoutError):
        return "no answer"
    if isinstance(error, ProtocolError):
        return f"it sent {error}"
    return "the host has gone"
