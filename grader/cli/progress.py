"""Shows what a long check is doing: on the terminal, or to the screen that waits for it."""

from __future__ import annotations

import os
import shutil
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Final

import click

from grader.evidence.submission_clock import DRIVE_KIND
from grader.reports.cleaning import clean_line

FIRST_AFTER_S: Final = 1.0
"""Nothing is shown of a check that is over before."""
INTERVAL_S: Final = 0.2
MAX_DRIVE: Final = 40_000
"""Characters of a text that is to be drawn."""


@contextmanager
def shown_progress(descriptor: int | None) -> Iterator[Callable[[str], None]]:
    """Yields the function to call with what is being done; it may be called often. An empty text clears the line.

    ``descriptor``: a file descriptor that gets each text as a line; without one a terminal shows the newest, as long
    as this lasts. Where the standard error is no terminal, nothing is shown.
    """
    if descriptor is not None:
        with suppress(OSError):  # there is no such descriptor: then nobody is told
            os.set_inheritable(descriptor, False)
        yield _limit_rate(lambda text: _write_line(descriptor, text), first_after_s=0.0)
    elif sys.stderr.isatty():
        with _status_line() as show:
            yield _limit_rate(show, first_after_s=FIRST_AFTER_S)
    else:
        yield lambda text: None


def _limit_rate(show: Callable[[str], None], *, first_after_s: float) -> Callable[[str], None]:
    """Limits how often the text of one kind is shown: the part before its first colon says the kind."""
    due = time.monotonic() + first_after_s
    shown_kind = ""

    def show_sometimes(text: str) -> None:
        nonlocal due, shown_kind
        if not text:
            due, shown_kind = time.monotonic() + first_after_s, ""
            show("")
            return
        kind, now = text.partition(":")[0], time.monotonic()
        if now >= due or (shown_kind and kind != shown_kind):
            due, shown_kind = now + INTERVAL_S, kind
            show(clean_line(text, MAX_DRIVE) if is_drive(kind) else clean_line(text))

    return show_sometimes


def is_drive(kind: str) -> bool:
    """Whether texts of this kind are to be drawn, and not to be read."""
    return kind.endswith(DRIVE_KIND)


def _write_line(descriptor: int, text: str) -> None:
    with suppress(OSError):  # whoever waited has gone
        if not text:
            return
        os.write(descriptor, f"{text}\n".encode())


@contextmanager
def _status_line() -> Iterator[Callable[[str], None]]:
    """Keeps one line of the terminal, and clears it at the end."""
    is_shown = False

    def show(text: str) -> None:
        nonlocal is_shown
        if (not text and not is_shown) or is_drive(text.partition(":")[0]):
            return
        is_shown = bool(text)
        width = shutil.get_terminal_size().columns - 1
        sys.stderr.write(f"\r{text[:width]:<{width}}\r")
        sys.stderr.flush()

    try:
        yield show
    finally:
        if is_shown:
            show("")


LINE_INTERVAL_S: Final = 15.0
"""Between two lines on how far a class is, where there is no terminal."""


@contextmanager
def counted_progress(total: int, done: str) -> Iterator[Callable[[], None]]:
    """Yields the function to call for each of ``total`` things that is done: a bar on a terminal; elsewhere, as in a log, a
    line from time to time, and the last one. ``done``: the word for it, such as "graded"."""
    if sys.stderr.isatty():
        with click.progressbar(length=total, label=done, file=sys.stderr) as bar:
            yield lambda: bar.update(1)
        return
    began = time.monotonic()
    count, said_at, said = 0, began, 0

    def say() -> None:
        nonlocal said, said_at
        said, said_at = count, time.monotonic()
        click.echo(f"{count} of {total} {done}, {said_at - began:.0f} s", err=True)

    def count_one() -> None:
        nonlocal count
        count += 1
        if time.monotonic() - said_at >= LINE_INTERVAL_S:
            say()

    yield count_one
    if count > said:
        say()
