"""A program that plays tag against the player at the keys: it drives the second robot of a game for two."""

from __future__ import annotations

from typing import Final

from kit.controllers import ControllerFile
from kit.host.failure import StudentCodeError
from kit.host.node_process import NodeProcess
from kit.host.proxy_nodes import NameScope
from kit.msg.geometry_msgs import Twist
from kit.run.lockstep import Observer
from kit.run.session import Session
from kit.school.game.league.tag_game import TagAnnouncer, program_arguments
from kit.school.game.race import confinement_of
from kit.school.game.starts import OWN_SEED
from kit.school.game.two_players import GUEST, SharedGame, SharedPhase
from kit.sim.simulation import Simulation

PLAYER: Final = 1
"""Its number in the game."""


class TagOpponent(Observer):
    """Plays each game with a new process of the program. Belongs to the thread that ticks."""

    def __init__(self, session: Session, game: SharedGame, program: ControllerFile) -> None:
        """``session``: of a ``shared_scenario`` in which ``game`` is played."""
        self._session, self._game, self._program = session, game, program
        self._process: NodeProcess | None = None
        self._plays = False
        self.failure = ""
        """Why the program has stopped; empty while it plays."""
        session.runner.observers.append(TagAnnouncer(session.graph, game, {PLAYER: GUEST}))
        session.runner.observers.append(self)
        game.start()

    def begin(self) -> None:
        """Another game: the world is as new, and so is the program."""
        self.close()
        self.failure = ""
        try:
            self._process = NodeProcess.start(
                self._session.graph,
                self._program.file,
                args=program_arguments(self._session.scenario, PLAYER),
                seed=OWN_SEED,
                level=confinement_of(self._program),
                scope=NameScope(f"/{GUEST}"),
            )
        except StudentCodeError as error:
            self.failure = str(error.failure)

    def on_step(self, simulation: Simulation) -> None:
        """It drives while the game runs."""
        runs = self._game.state.phase is SharedPhase.RUNNING
        process = self._process
        if process is not None and process.failure is not None:
            self.failure = str(process.failure)
        if not runs:
            self._stop()
        elif self.failure:
            self.close()
            self._game.remove_player(PLAYER)
            self._game.start()  # of a rematch, if one is asked for
        elif process is not None and not self._plays:
            self._plays = True
            self._session.runner.participants.append(process)

    def disconnect(self) -> None:
        """Stops waiting for the program; from any thread. Only ``close`` may follow."""
        if (process := self._process) is not None:
            process.disconnect()

    def close(self) -> None:
        """Ends the program; once nobody ticks any more, or in the thread that does."""
        self._stop()
        if self._process is not None:
            self._process.close()
            self._process = None

    def _stop(self) -> None:
        if self._plays and self._process is not None:
            self._session.runner.participants.remove(self._process)
            for topic in self._session.command_topics(GUEST):  # its last command would drive its robot on
                self._session.runner.accept(topic, Twist())
        self._plays = False
