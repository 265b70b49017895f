"""A slow link: connects standard input and output to a port, at so many bytes a second and with so much delay.

Run as ``python relay.py PORT BYTES_PER_SECOND DELAY_SECONDS``, as ssh's ProxyCommand. Only what comes from the
server is throttled, as on a line whose downlink is the bottleneck; both ways are delayed. Like a real link it
holds little: what it cannot pass on yet stays with the sender.
"""

from __future__ import annotations

import os
import select
import socket
import sys
import time
from collections import deque

CHUNK = 1024
HELD = 4096
"""Bytes of the slow direction that are under way at most, besides those in the delay."""


def main(port: int, rate: float, delay: float) -> None:
    link = socket.create_connection(("127.0.0.1", port))
    link.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, HELD)
    up: deque[tuple[float, bytes]] = deque()
    down: deque[tuple[float, bytes]] = deque()
    free_at = time.monotonic()
    is_open = True
    while is_open or down:
        now = time.monotonic()
        waiting = sum(len(data) for when, data in down if when > now + delay)
        readers: list[object] = [0] if is_open else []
        if is_open and waiting < HELD:
            readers.append(link)
        times = [queue[0][0] for queue in (up, down) if queue]
        timeout = max(0.0, min(times) - now) if times else (0.02 if waiting >= HELD else None)
        ready = select.select(readers, [], [], 0.02 if waiting >= HELD else timeout)[0]
        now = time.monotonic()
        if 0 in ready:
            data = os.read(0, CHUNK)
            if not data:
                return
            up.append((now + delay, data))
        if link in ready:
            data = link.recv(CHUNK)
            if data:
                free_at = max(free_at, now) + len(data) / rate
                down.append((free_at + delay, data))
            else:
                is_open = False
        while up and up[0][0] <= now:
            link.sendall(up.popleft()[1])
        while down and down[0][0] <= now:
            os.write(1, down.popleft()[1])


if __name__ == "__main__":
    main(int(sys.argv[1]), float(sys.argv[2]), float(sys.argv[3]))
