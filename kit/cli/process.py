"""A command line as a process of its own: what ends it, with which exit code, and that all it has written is out."""

from __future__ import annotations

import atexit
import gc
import os
import signal
import sys
import threading
import time
from contextlib import suppress
from errno import EACCES, EDQUOT, EFBIG, EIO, EMFILE, ENAMETOOLONG, ENFILE, ENOSPC, EPERM, EROFS
from typing import Final, NoReturn

import click

from kit.installation import foreign_distributions, overwritten_text
from kit.interruption import ended_by_signals, write_out
from kit.kernels.compilation_progress import PROGRESS
from kit.plain_text import escape_controls

FAILED: Final = 1
"""Exit code where what was asked for is not so, or not possible."""
BAD_INPUT: Final = 2
"""Exit code where an argument is wrong, or something cannot be read or written."""
INTERRUPTED: Final = 128 + signal.SIGINT
"""Exit code after Ctrl-C, as shells have it."""
NO_ROOM: Final = frozenset((ENOSPC, EDQUOT, EFBIG))
REFUSED: Final = frozenset((EACCES, EPERM, EROFS, EIO, ENAMETOOLONG, EMFILE, ENFILE))


def is_environment_error(error: OSError) -> bool:
    """Whether an error is one of the disk, or of rights: nothing that the kit does wrong."""
    return error.errno in NO_ROOM or (error.errno in REFUSED and error.filename is not None)


def describe_no_room(error: OSError) -> str:
    """A sentence about a full disk, and the way out."""
    where = "what it prints or writes" if error.filename is None else error.filename
    return (
        f"{where} cannot be written: {error.strerror}. Free some space, or write elsewhere, and run it again."
    )


NOTICE_INTERVAL_S: Final = 2.0
COLLECTED_FROM: Final = 50_000
"""New objects from which on unreachable ones are looked for. A command imports about a hundred thousand, of which none is
unreachable: with Python's 700, looking for them is a sixth of a check's start."""


class ScreenClosed(SystemExit):
    """A full screen was left: all that was to be kept is on the disk, and the terminal is as it was."""


def refuse_if_written_over(name: str) -> None:
    """Ends the process with one sentence where another package has written over files of the kit."""
    for foreign in foreign_distributions(only_named=True):
        click.echo(f"{name}: {overwritten_text(*foreign)}", err=True)
        raise SystemExit(BAD_INPUT)


def _tell_other_kinds(name: str) -> None:
    """Says of each file of this command line that another command takes it, if that is so."""
    from kit.cli.file_kinds import other_kinds  # what a command that succeeds does not need

    with suppress(OSError):
        for sentence in other_kinds(name, sys.argv[1:]):
            click.echo(escape_controls(sentence), err=True)


class _CompilationNotice:
    """Says on a terminal what is compiled while a command seems to do nothing: at once, and then from time to time."""

    def __init__(self) -> None:
        self._due = 0.0

    def tell(self, text: str) -> None:
        if sys.stderr is not None and sys.stderr.isatty() and time.monotonic() >= self._due:
            self._due = time.monotonic() + NOTICE_INTERVAL_S
            click.echo(text, err=True)


def run_as_process(command: click.Command, name: str) -> NoReturn:
    """Runs a command line as this process, to whose end belongs that what it has written is out.

    SIGTERM and SIGHUP end it as Ctrl-C does. Where the disk is full, or the folder another user's, one sentence says so in
    place of a traceback; exit code 2.

    Python does not take apart what was imported, which takes as long as a third of a short check: the process ends once its
    output is written. After a full screen, which has given the terminal back and removed what it made, the exit handlers of
    libraries do not run either: they would take compiled code away from threads that are still in it.
    """
    gc.set_threshold(COLLECTED_FROM)
    if signal.getsignal(signal.SIGINT) is signal.SIG_DFL:  # for the imports; see ``kit.program``
        signal.signal(signal.SIGINT, signal.default_int_handler)
    refuse_if_written_over(name)
    try:
        with ended_by_signals(), PROGRESS.told_by(_CompilationNotice().tell):
            try:
                command(prog_name=name)
            except SystemExit as stop:
                if stop.code in (FAILED, BAD_INPUT):
                    _tell_other_kinds(name)
                if stop.code == BAD_INPUT:  # and why has been said
                    write_out()
                if sys.stdout is not None:  # closed by whoever started this
                    sys.stdout.flush()
                raise
    except ScreenClosed as closed:
        write_out()
        os._exit(closed.code if isinstance(closed.code, int) else 0)
    except SystemExit as stop:
        if not isinstance(stop.code, int):
            raise
        # Python would also kill itself by SIGINT, whatever the code, if an `exec` of a library's was interrupted on the way.
        threading._shutdown()  # type: ignore[attr-defined] # it waits for threads, as Python does at its end
        atexit._run_exitfuncs()
        write_out()
        os._exit(stop.code)
    except OSError as error:
        if not is_environment_error(error):
            raise
        with suppress(OSError):
            text = (
                describe_no_room(error) if error.errno in NO_ROOM else f"{error.filename}: {error.strerror}."
            )
            click.echo(f"{name}: {text}", err=True)
        write_out()
        raise SystemExit(BAD_INPUT) from None
    raise SystemExit(0)  # a command that ends otherwise has said so by a SystemExit of its own
