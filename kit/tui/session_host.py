"""The world behind the screen: a session in its own thread, and how the screen talks with it.

Everything slow happens off the face's event loop: opening worlds, starting controllers, the physics itself.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from queue import SimpleQueue
from typing import TYPE_CHECKING, Final, TypeAlias

from kit.controllers import ControllerFile
from kit.dialogue.shared_actions import ACTIONS
from kit.run.pacing import PacingStatus

if TYPE_CHECKING:  # the physics takes a moment to import: the frame is drawn first
    from pathlib import Path

    from kit.inspection.server import InspectionServer
    from kit.run.lockstep import Observer
    from kit.run.recording import Recorder, Recording, RecordingStore
    from kit.run.runner import Runner
    from kit.run.scenario import Scenario
    from kit.run.session import Session
    from kit.run.view import View, ViewBuilder
    from kit.run.world_thread import WorldThread

POLITE_S: Final = 0.3
"""How long to wait for a controller that is in its callback, when the user leaves [s]."""
VIEW_INTERVAL: Final = 0.045
"""Seconds between two views while the world runs: a little over twenty a second."""

SessionJob: TypeAlias = "Callable[[Session], object]"


class SessionHost:
    """Hosts at most one session at a time. ``on_view`` and ``on_error`` are called in other threads."""

    def __init__(
        self,
        *,
        on_view: Callable[[View], None],
        on_error: Callable[[str], None],
        seed: int = 0,
        socket_dir: Path | None = None,
        records: bool = False,
        store: RecordingStore | None = None,
    ) -> None:
        """``socket_dir``: the folder of sockets through which other terminals look in; None: none does. ``records``:
        whether the drive is recorded. ``store``: where it is written as it goes on."""
        self._on_view = on_view
        self._on_error = on_error
        self._seed = seed
        self._socket_dir = socket_dir
        self._records = records or store is not None
        self._recording_store = store
        self._recorder: Recorder | None = None
        self._inspection_server: InspectionServer | None = None
        self._session: Session | None = None
        self._live: WorldThread | None = None
        self.view_builder: ViewBuilder | None = None
        self._last_view_s = 0.0
        self._beams = False
        self._listener: SessionJob | None = None
        self._is_closed = False
        self._swap_lock = threading.Lock()
        """Held while one world replaces another."""
        self._asked = self._opening = self._shown = 0
        """Numbers of the world that was asked for last, of the one that is being opened, and of the one whose views are handed
        on."""
        self._view_lock = threading.Lock()
        """Held while a view is handed on, or another world asked for."""
        self._jobs: SimpleQueue[Callable[[], None] | None] = SimpleQueue()
        self._helper = threading.Thread(target=self._run_jobs, name="helper", daemon=True)
        self._helper.start()

    @property
    def pacing(self) -> PacingStatus:
        return self._live.pacing if self._live is not None else PacingStatus(1.0, 0.0, False)

    def open(self, find: Callable[[], Scenario], controller: ControllerFile, *, paused: bool = False) -> None:
        """Opens another world in place of the present one, which stays if that fails, and is not seen meanwhile. ``paused``: it
        stands still."""

        def job() -> None:
            from kit.run.session import Session

            session = Session(find(), seed=self._seed, always_scan=True)
            self._record(session)
            session.watch_connections(f"{ACTIONS['editor'].keys} opens it.")
            session.drive_with(controller)
            session.runner.paused = paused
            self._replace(session)

        self._put_opening(job)

    def open_session(self, make: Callable[[], Session], factor: Callable[[Session], float]) -> None:
        """Opens a world that makes its session by itself, at a speed of its own."""

        def job() -> None:
            session = make()
            self._replace(session, factor(session))

        self._put_opening(job)

    def _put_opening(self, job: Callable[[], None]) -> None:
        """Queues the opening of a world; until it ends, nobody sees the present one any more, or does something to it that was
        meant for the other."""
        with self._view_lock:
            self._asked += 1
            number = self._asked

        def open_world() -> None:
            self._opening = number
            try:
                job()
            finally:  # also where it failed: the present world stays
                self._show_opening()

        self._jobs.put(open_world)

    def _show_opening(self) -> None:
        """From now on there are views again, unless another world was asked for meanwhile."""
        with self._view_lock:
            self._shown = self._opening

    def post(self, job: SessionJob) -> None:
        """Has something done to the session, in the world's thread, between two ticks."""
        session, live = self._session, self._live
        if session is not None and live is not None:
            live.post(lambda runner: job(session))

    def drive_with(self, controller: ControllerFile) -> None:
        """Lets another controller drive, in the world that is open when the request is carried out."""
        self._jobs.put(lambda: self.post(lambda session: session.drive_with(controller)))

    def observe(self, make_observer: Callable[[Session], Observer]) -> None:
        """Adds an observer to the world that is open by then; what making it raises is told."""

        def job() -> None:
            session = self._session
            if session is not None:
                observer = make_observer(session)
                self.post(lambda session: session.runner.observers.append(observer))

        self._jobs.put(job)

    def set_factor(self, factor: float) -> None:
        if self._live is not None:
            self._live.set_factor(factor)

    def set_paused(self, paused: bool) -> None:
        if self._live is not None:
            self._live.set_paused(paused)

    def resume_when_driven(self) -> None:
        """Lets the world go on as soon as its controller drives, or has failed to: no time passes before."""
        self.post(lambda session: session.wait_until_driven())
        self.set_paused(False)

    def step(self) -> None:
        if self._live is not None:
            self._live.step()

    def show_beams(self, shown: bool) -> None:
        self._beams = shown
        self.post(lambda session: None)

    def recording(self) -> Recording | None:
        """The drive in the world that was opened last; None where nothing is recorded. To be asked after ``close``."""
        return None if self._recorder is None else self._recorder.recording()

    def set_listener(self, listener: SessionJob | None) -> None:
        """Has the session shown to somebody else too, in the world's thread, as often as there are views."""
        self._listener = listener
        self.post(lambda session: None)

    def close_session(self) -> None:
        """Ends the world and its controller; another may be opened later. Does not wait."""

        def job() -> None:
            with self._swap_lock:
                self._drop_session()

        self._jobs.put(job)

    def close(self) -> None:
        """Ends the world and its controller, and waits for both; not for a world that is being opened."""
        self._is_closed = True
        self._jobs.put(None)
        with self._swap_lock:
            self._drop_session()

    def _run_jobs(self) -> None:
        while (job := self._jobs.get()) is not None and not self._is_closed:
            try:
                job()
            except Exception as error:  # noqa: BLE001 - whatever it is, it must reach the screen, not a dead thread
                self._on_error(str(error))

    def _record(self, session: Session) -> None:
        """Records from the first tick on, so that the drive can be kept."""
        if self._records:
            from kit.run.recording import Recorder

            self._recorder = Recorder.for_scenario(
                session.scenario, session.runner.simulation, self._recording_store
            )
            session.runner.observers.append(self._recorder)

    def _replace(self, session: Session, factor: float | None = None) -> None:
        with self._swap_lock:
            if self._is_closed:
                session.close()
            else:
                self._start(session, self.pacing.factor if factor is None else factor)

    def _start(self, session: Session, factor: float) -> None:
        from kit.run.view import ViewBuilder
        from kit.run.world_thread import WorldThread

        runner = session.runner
        self._drop_session()
        self._session, self.view_builder = session, ViewBuilder(session)
        self._live = live = WorldThread(runner, factor=factor, on_change=self._world_changed)
        runner.on_rate = lambda rate: self.set_factor(rate * runner.simulation.step_size)
        if self._socket_dir is not None:
            from kit.inspection.server import open_inspection_server

            name = (
                session.scenario.title
                if session.scenario.name.endswith((".yaml", ".yml"))
                else session.scenario.name
            )

            def wake() -> None:
                if runner.paused:  # nobody ticks: a visitor's words have to be looked at
                    live.post(_no_op)

            self._inspection_server = open_inspection_server(session.graph, self._socket_dir, name, wake)
            if self._inspection_server is not None:
                runner.participants.append(self._inspection_server)
        self._show_opening()
        self._on_view(
            self.view_builder.build()
        )  # before the first tick, which loads the kernels of the laser
        live.__enter__()
        if runner.paused:  # nobody ticks, and yet it is to be seen
            live.post(_no_op)

    def _drop_session(self) -> None:
        live, session, server = self._live, self._session, self._inspection_server
        self._live = self._session = self.view_builder = self._inspection_server = None
        if session is not None:
            if live is not None and live.stop(POLITE_S):
                session.interrupt()  # it may save what it has, as at Ctrl-C
            session.disconnect()  # or a controller that loops would have us wait for its deadline
        if live is not None:
            live.stop()
        if server is not None:
            server.close()
        if session is not None:
            session.close()

    def _world_changed(self, runner: Runner) -> None:
        """Makes a view of the world; called in the world's thread after every stretch of ticks."""
        view_builder, live, session = self.view_builder, self._live, self._session
        if view_builder is None or live is None or session is None:
            return
        if live.failure is not None:
            self._on_error(f"the world stopped: {live.failure}")
        now = time.monotonic()
        if runner.paused or now - self._last_view_s >= VIEW_INTERVAL:
            self._last_view_s = now
            session.poll()
            view_builder.shows_beams = self._beams
            view = view_builder.build()
            with self._view_lock:
                if self._shown == self._asked:
                    self._on_view(view)
            if (listener := self._listener) is not None:
                listener(session)


def _no_op(runner: Runner) -> None:
    """A job that only has the world look around."""
