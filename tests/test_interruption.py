"""Signals end a verb as Ctrl-C does, and what is being written becomes whole before."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from kit.interruption import ENDING, ended_by_signals, uninterrupted

ALL = (signal.SIGINT, *ENDING)


@pytest.mark.parametrize("sent", ENDING)
def test_a_signal_interrupts_and_decides_the_exit_status(sent: signal.Signals) -> None:
    done = []

    @ended_by_signals()
    def work() -> None:
        try:
            signal.raise_signal(sent)
        except KeyboardInterrupt:
            done.append("kept")
            raise SystemExit(130) from None

    for count in (1, 2):  # a second time as the first
        with pytest.raises(SystemExit) as ended:
            work()
        assert ended.value.code == 128 + sent
        assert done == ["kept"] * count
    assert signal.getsignal(sent) is signal.SIG_DFL


def test_output_to_a_terminal_that_is_gone_changes_nothing() -> None:
    @ended_by_signals()
    def work() -> None:
        try:
            signal.raise_signal(signal.SIGHUP)
        finally:
            raise OSError(5, "Input/output error")

    with pytest.raises(SystemExit) as ended:
        work()
    assert ended.value.code == 129


@pytest.mark.parametrize("error", [SystemExit(3), OSError("full"), KeyboardInterrupt()])
def test_without_a_signal_everything_is_as_ever(error: BaseException) -> None:
    with pytest.raises(type(error)) as caught, ended_by_signals():
        raise error
    assert caught.value is error


def test_what_is_ignored_or_handled_stays_so() -> None:
    heard: list[int] = []
    before = [signal.signal(signal.SIGHUP, signal.SIG_IGN)]
    before.append(signal.signal(signal.SIGTERM, lambda number, frame: heard.append(number)))
    try:
        with ended_by_signals():
            signal.raise_signal(signal.SIGHUP)
            signal.raise_signal(signal.SIGTERM)
            with uninterrupted():
                signal.raise_signal(signal.SIGHUP)
    finally:
        signal.signal(signal.SIGHUP, before[0])
        signal.signal(signal.SIGTERM, before[1])
    assert heard == [signal.SIGTERM]


@pytest.mark.parametrize("sent", ALL)
def test_a_signal_in_a_callback_of_c_code_is_not_lost(sent: signal.Signals) -> None:
    """There an exception ends nothing, as here in a finalizer."""

    class Stepped:
        def __del__(self) -> None:
            signal.raise_signal(sent)
            sum(range(1000))

    ended = []

    @ended_by_signals()
    def work() -> None:
        Stepped()
        try:
            threading.Event().wait(60)
        except KeyboardInterrupt:
            ended.append(sent)
            raise

    with pytest.raises((KeyboardInterrupt, SystemExit)):
        work()
    assert ended == [sent]


def test_a_fork_dies_of_the_signal() -> None:
    with ended_by_signals():
        child = os.fork()
        if child == 0:
            try:
                os.kill(os.getpid(), signal.SIGTERM)
            finally:
                os._exit(9)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == -signal.SIGTERM


@pytest.mark.parametrize("sent", ALL)
def test_what_is_uninterrupted_becomes_whole(sent: signal.Signals) -> None:
    written = []

    @ended_by_signals()
    @uninterrupted()
    def write() -> None:
        for letter in "abc":
            for number in (sent, *ALL):
                signal.raise_signal(number)
            written.append(letter)

    with pytest.raises((KeyboardInterrupt, SystemExit)):
        write()
    assert written == ["a", "b", "c"]
    assert [signal.getsignal(number) for number in ALL] == [
        signal.default_int_handler,
        signal.SIG_DFL,
        signal.SIG_DFL,
    ]


AT_IMPORT = """
import importlib.abc, signal, sys

class Interrupt(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name == {module!r}:
            sys.meta_path.remove(self)
            signal.raise_signal(signal.SIGINT)
            return None

sys.meta_path.insert(0, Interrupt())
sys.argv = ["kit", "maps"]
import runpy
runpy.run_module("kit", run_name="__main__", alter_sys=True)
"""


@pytest.mark.parametrize("module", ["click", "kit.cli.options", "kit.cli.maps"])
def test_an_interrupt_while_the_kit_starts_ends_it_without_a_traceback(module: str) -> None:
    done = subprocess.run(
        [sys.executable, "-c", AT_IMPORT.format(module=module)],
        cwd=Path(__file__).parents[1],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode in (-signal.SIGINT, 1, 128 + signal.SIGINT)
    assert done.stdout == ""
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("sent", ALL)
def test_a_signal_that_is_lost_twice_is_sent_again(
    sent: signal.Signals, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a busy machine the repeated one comes before the hook that repeats it has returned."""
    start, started = threading.Timer.start, []

    def start_late(timer: threading.Timer) -> None:
        start(timer)
        started.append(timer)
        if len(started) < 3:
            threading.Event().wait(0.2)

    monkeypatch.setattr(threading.Timer, "start", start_late)
    test_a_signal_in_a_callback_of_c_code_is_not_lost(sent)
    assert len(started) == 3
