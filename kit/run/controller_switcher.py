"""Switches controllers while a world runs: the next one starts beside the active one and replaces it once it has started well."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

from kit.controllers import ControllerFile
from kit.host.failure import Failure, StudentCodeError
from kit.host.file_watcher import FileWatcher
from kit.host.node_process import NodeProcess
from kit.host.program_start import PackageProgram
from kit.host.program_terminal import ProgramStreams
from kit.host.sandbox.limits import Limits
from kit.host.sandbox.sandbox_config import INTERACTIVE_LEVEL, Level
from kit.msg.interfaces import register_packages
from kit.ros.packages import (
    SEARCH_VARIABLE,
    find_packages,
    import_folders,
    interface_packages,
    workspace_folders,
)
from kit.run.runner import Runner


class ControllerSwitcher:
    """Owns the process of the controller that takes part in the runner's ticks. Belongs to the thread that ticks."""

    def __init__(
        self,
        runner: Runner,
        arguments: Sequence[str],
        *,
        seed: int,
        limits: Limits,
        level: Level = INTERACTIVE_LEVEL,
        on_stop: Callable[[], object] = lambda: None,
        on_reload: Callable[[Path], object] = lambda file: None,
        on_print: Callable[[str], object] = lambda line: None,
        streams: ProgramStreams | None = None,
    ) -> None:
        """``on_stop``: called when a controller has stopped driving; ``on_reload``: when a new version of its file drives; ``on_print``: with each line it prints.

        ``streams``: what a controller reads that is run by hand.
        """
        self._streams = streams
        self._runner = runner
        self._on_stop = on_stop
        self._on_reload = on_reload
        self._is_reload = False
        self._on_print = on_print
        self._arguments: Final = tuple(arguments)
        self._seed = seed
        self._limits = limits
        self._level = level
        self._active: NodeProcess | None = None
        self._pending: NodeProcess | None = None
        self._failure: Failure | None = None
        self._file: FileWatcher | None = None
        self.controller: ControllerFile | None = None
        """The one that drives or is about to."""

    @property
    def failure(self) -> Failure | None:
        """Why the active controller has stopped, or why its newest version was not taken."""
        if self._failure is None and self._active is not None:
            return self._active.failure
        return self._failure

    @property
    def node_names(self) -> frozenset[str]:
        """The full names of the active controller's nodes."""
        return frozenset() if self._active is None else self._active.node_names

    def load(self, controller: ControllerFile | None) -> None:
        """Starts a controller without waiting for it; None only stops the active one."""
        self._cancel_pending()
        self._failure = None
        self.controller = controller
        if controller is None:
            self._unload()
            return
        self._file = FileWatcher(controller.file)
        self._start(controller)

    def restart(self) -> None:
        """Stops the active controller at once and starts the same one from its beginning."""
        self._unload()
        self.load(self.controller)

    def wait(self) -> None:
        """Waits until the pending controller drives or has failed."""
        if self._pending is not None:
            self._finish_start(self._pending.wait_until_started)

    def poll(self) -> None:
        """Activates a pending controller that has started, and starts a new version of a file that was saved."""
        pending = self._pending
        self.read_output()
        if self._active is not None and self._active.failure is not None and self._failure is None:
            self._failure = self._active.failure
            self._on_stop()
        if pending is not None:
            self._finish_start(pending.is_started)
        elif self.controller is not None and self._file is not None and self._file.has_changed():
            self._failure = None
            self._start(self.controller)
            self._is_reload = True

    def disconnect(self) -> None:
        """Stops waiting for the active and the pending controller; may be called in any thread."""
        for process in filter(None, (self._active, self._pending)):
            process.disconnect()

    def read_output(self) -> None:
        """Passes on what the active controller has printed since the last time."""
        if self._active is not None:
            self._pass_on_output(self._active)

    def interrupt(self) -> None:
        """Lets the active controller do what it does at Ctrl-C."""
        if self._active is not None:
            self._active.interrupt()
            self.read_output()

    def close(self) -> None:
        """Ends both processes."""
        self._cancel_pending()
        self._unload()

    def _start(self, controller: ControllerFile) -> None:
        self._is_reload = False
        try:
            self._pending = NodeProcess(
                self._runner.graph,
                controller.file,
                args=self._arguments,
                seed=self._seed,
                limits=self._limits,
                level=self._level,
                package=_controller_package(controller.file) if self._level is INTERACTIVE_LEVEL else None,
                streams=self._streams,
                replaces=self._active,
            )
        except StudentCodeError as error:
            self._failure = error.failure

    def _finish_start(self, is_started: Callable[[], bool | None]) -> None:
        """Activates the pending controller unless ``is_started`` returns False; discards it if that raises."""
        pending = self._pending
        assert pending is not None
        try:
            if is_started() is False:
                return
        except StudentCodeError as error:
            self._failure = error.failure
            self._pass_on_output(pending)
            self._cancel_pending()
            return
        self._pending = self._failure = None
        self._unload()
        pending.join()
        self._active = pending
        self._runner.participants.append(pending)
        if self._is_reload and self.controller is not None:
            self._on_reload(self.controller.file)

    def _cancel_pending(self) -> None:
        if self._pending is not None:
            self._pending.close()
            self._pending = None

    def _unload(self) -> None:
        active, self._active = self._active, None
        if active is not None:
            self._pass_on_output(active)
            self._runner.participants.remove(active)
            active.close()
            self._on_stop()

    def _pass_on_output(self, process: NodeProcess) -> None:
        printed = process.take_output()
        for line in printed.lines:
            self._on_print(line.text)
        if printed.omission:
            self._on_print(printed.omission)


def _controller_package(file: Path) -> PackageProgram | None:
    """What a controller's file sees of the ROS 2 workspace in which it lies; None if it lies in none."""
    search = workspace_folders(file.absolute())
    if not search:
        return None
    packages = find_packages(search)
    interfaces = interface_packages(packages)
    register_packages({name: str(folder) for name, folder in interfaces.items()})
    environment = {SEARCH_VARIABLE: os.pathsep.join(map(str, search))}
    return PackageProgram(
        file.absolute().parent,
        None,
        environment,
        imports=import_folders(packages.values()),
        interfaces=interfaces,
        is_controller=True,
    )
