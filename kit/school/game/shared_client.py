"""A guest's end of a shared game: asks to come in, sends the pushes of its keys, and receives how things stand."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from contextlib import suppress
from types import TracebackType
from typing import Self

from kit.host.wire import ProtocolError
from kit.inspection.sockets import FramedSocket
from kit.school.game.shared_protocol import (
    KEEP_ALIVE,
    MAX_FRAME,
    SILENCE,
    GameOffer,
    JoinRequest,
    KeyPush,
    encode_push,
    encode_request,
    parse_from_host,
)
from kit.school.game.shared_sockets import FoundGame, SharedGameError
from kit.school.game.two_players import SharedState


class SharedGameClient:
    """Connects when it is made; close it, or use it as a context manager. Raises SharedGameError if it cannot come in.

    It says by itself, from then on, that it is still here. ``follow`` has its callbacks called in a thread of its own.
    """

    def __init__(self, game: FoundGame, name: str, *, plays: bool) -> None:
        connection = game.connect()
        connection.settimeout(SILENCE)
        self._socket = FramedSocket(connection, largest_frame=MAX_FRAME)
        self._push = KeyPush(0.0, 0.0)
        self._has_news = threading.Event()
        self._is_closed = False
        try:
            self._socket.send(encode_request(JoinRequest(name, plays)))
            offer = parse_from_host(self._socket.receive())
        except (EOFError, OSError, ProtocolError) as error:
            self._socket.close()
            raise SharedGameError(f"{game.name} does not let you in: {_reason(error)}.") from error
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

    def follow(self, on_state: Callable[[SharedState], object], on_end: Callable[[str], object]) -> None:
        """Calls ``on_state`` with every state, and ``on_end`` with the reason when the game is gone."""
        threading.Thread(
            target=self._receive, args=(on_state, on_end), name="shared-game-in", daemon=True
        ).start()

    def push(self, linear: float, angular: float) -> None:
        """Says what the keys ask for now, forward and left, each from -1 to 1. Does not wait."""
        self._push = KeyPush(min(max(linear, -1.0), 1.0), min(max(angular, -1.0), 1.0))
        self._has_news.set()

    def close(self) -> None:
        """Leaves the game. May be called twice."""
        self._is_closed = True
        self._has_news.set()
        self._socket.close()

    def _receive(self, on_state: Callable[[SharedState], object], on_end: Callable[[str], object]) -> None:
        try:
            while True:
                content = parse_from_host(self._socket.receive())
                if not isinstance(content, SharedState):
                    raise ProtocolError("a second offer")
                on_state(content)
        except (EOFError, OSError, ProtocolError) as error:
            if not self._is_closed:
                on_end(_reason(error))

    def _send(self) -> None:
        """The newest push, at most fifty times a second, and now and then to say that somebody is still here."""
        with suppress(EOFError, OSError):
            while not self._is_closed:
                self._has_news.wait(KEEP_ALIVE)
                self._has_news.clear()
                self._socket.send(encode_push(self._push))
                time.sleep(0.02)


def _reason(error: Exception) -> str:
    if isinstance(error, TimeoutError):
        return "no answer"
    if isinstance(error, ProtocolError):
        return f"it sent {error}"
    return "the host has gone"
