"""Takes the terminal as an app does, without any app, and ends in the way named by its argument."""

from __future__ import annotations

import os
import signal
import sys
import termios
import threading
import tty
from types import FrameType

from kit.tui.input.terminal_guard import TerminalGuard


def own_handler(number: int, frame: FrameType | None) -> None:
    os.write(2, b"own handler\n")
    os._exit(7)


def draw() -> None:
    while True:
        os.write(2, b"\x1b[1;1Hframe" * 20)


way = sys.argv[1]
if way == "handled":
    signal.signal(signal.SIGTERM, own_handler)
if way == "ignored":
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
guard = TerminalGuard(0, 2)
guard.arm()
guard.arm()
os.write(
    2,
    b"\x1b[?1049h\x1b[?1000h\x1b[?1003h\x1b[?1006h\x1b[?1016h\x1b[?25l\x1b[?1004h\x1b[?2004h\x1b[?7l\x1b[>27u\x1b[?2026h",
)
tty.setraw(0)
if way == "threads":
    threading.Thread(target=draw, daemon=True).start()
os.write(int(os.environ["REPORT"]), b'"taken"\n')
if way == "disarmed":
    guard.disarm()
    guard.disarm()
    assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL
    raise SystemExit(0)
if way == "error":
    raise RuntimeError("as told")
if way == "exit":
    raise SystemExit(5)
if way == "ignored":
    os.kill(os.getpid(), signal.SIGHUP)
    raise SystemExit(6)
if way == "closed":
    os.close(2)
    raise SystemExit(8)
if way == "gone":
    termios.tcflush(0, termios.TCIOFLUSH)
while True:
    signal.pause()
