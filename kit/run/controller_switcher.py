"""The driver's seat: one controller drives, the next one starts beside it and takes over only if it starts well."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

from kit.controllers import ControllerFile
from kit.host.failure import Failure, GuestError
from kit.host.file_watcher import FileWatch
from kit.host.node_process import Guest
from kit.host.sandbox.confinement import DESK_LEVEL, Level
from kit.host.sandbox.limits import Limits
from kit.run.runner import Runner


@dataclass(slots=True)
class _Coming:
    """A controller that is starting."""

    controller: ControllerFile
    guest: Guest


class Seat:
    """Whose guest takes part in the runner's ticks. Belongs to the thread that ticks."""

    def __init__(
        self,
        runner: Runner,
        arguments: Sequence[str],
        *,
        seed: int,
        limits: Limits,
        level: Level = DESK_LEVEL,
        on_empty: Callable[[], object] = lambda: None,
        on_print: Callable[[str], object] = lambda line: None,
    ) -> None:
        """``on_empty``: called when a controller has stopped driving; ``on_print``: with each line it prints."""
        self._runner = runner
        self._on_empty = on_empty
        self._on_print = on_print
        self._arguments: Final = tuple(arguments)
        self._seed = seed
        self._limits = limits
        self._level = level
        self._guest: Guest | None = None
        self._coming: _Coming | None = None
        self._failure: Failure | None = None
        self._file: FileWatch | None = None
        self.controller: ControllerFile | None = None
        """Who drives or is about to."""

    @property
    def failure(self) -> Failure | None:
        """Why the present controller has stopped, or why its newest version was not taken."""
        if self._failure is None and self._guest is not None:
            return self._guest.failure
        return self._failure

    def seat(self, controller: ControllerFile | None) -> None:
        """Starts a controller, without waiting; None leaves the seat empty."""
        self._give_up_coming()
        self._failure = None
        self.controller = controller
        if controller is None:
            self._leave()
            return
        self._file = FileWatch(controller.file)
        self._start(controller)

    def restart(self) -> None:
        """The same controller, from its beginning; the old one stops driving at once."""
        self._leave()
        self.seat(self.controller)

    def wait(self) -> None:
        """Until the coming controller drives or has failed."""
        if self._coming is not None:
            self._settle(self._coming.guest.wait_until_started)

    def look(self) -> None:
        """Lets a controller that is ready take over, and starts a new version of a file that was saved."""
        coming = self._coming
        self.listen()
        if self._guest is not None and self._guest.failure is not None and self._failure is None:
            self._failure = self._guest.failure
            self._on_empty()
        if coming is not None:
            self._settle(coming.guest.is_started)
        elif self.controller is not None and self._file is not None and self._file.has_changed():
            self._failure = None
            self._start(self.controller)

    def hang_up(self) -> None:
        """From any thread: who drives, or is about to, is not waited for any more."""
        guests = (self._guest, self._coming.guest if self._coming is not None else None)
        for guest in filter(None, guests):
            guest.hang_up()

    def listen(self) -> None:
        """Takes in what who drives has printed."""
        if self._guest is not None:
            self._hear(self._guest)

    def close(self) -> None:
        self._give_up_coming()
        self._leave()

    def _start(self, controller: ControllerFile) -> None:
        try:
            guest = Guest(
                self._runner.graph,
                controller.file,
                args=self._arguments,
                seed=self._seed,
                limits=self._limits,
                level=self._level,
            )
        except GuestError as error:
            self._failure = error.failure
            return
        self._coming = _Coming(controller, guest)

    def _settle(self, is_ready: Callable[[], bool | None]) -> None:
        coming = self._coming
        assert coming is not None
        try:
            if is_ready() is False:
                return
        except GuestError as error:
            self._failure = error.failure
            self._hear(coming.guest)
            self._give_up_coming()
            return
        self._coming = self._failure = None
        self._leave()
        coming.guest.join()
        self._guest = coming.guest
        self._runner.participants.append(coming.guest)

    def _give_up_coming(self) -> None:
        if self._coming is not None:
            self._coming.guest.close()
            self._coming = None

    def _leave(self) -> None:
        if self._guest is not None:
            self._hear(self._guest)
            self._runner.participants.remove(self._guest)
            self._guest.close()
            self._guest = None
            self._on_empty()

    def _hear(self, guest: Guest) -> None:
        for line in guest.take_output().lines:
            self._on_print(line.text)
