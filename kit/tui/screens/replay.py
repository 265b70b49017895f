"""Watch a recorded run again: no controller, only what the world was told."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.binding import BindingType

from kit.run.recording import Recording
from kit.run.scenario import Scenario
from kit.tui.rows.key_rows import bindings
from kit.tui.screens.watch import WatchScreen
from kit.tui.theme import Theme

if TYPE_CHECKING:
    from kit.learning.policies.policies import Policy
    from kit.run.session import Session


class ReplayScreen(WatchScreen):
    """Plays a recording from its first tick, and stands still at its end."""

    name_of_actions = "replay"
    BINDINGS: ClassVar[list[BindingType]] = bindings("replay")
    shows_mode = False

    def __init__(self, theme: Theme, place: Scenario, recording: Recording, title: str) -> None:
        super().__init__(theme, f"{place.title}, {title}", seed=recording.seed)
        self.driver_name = title
        self._place = place
        self._recording = recording

    def watch_agent(self, name: str, policy: Policy | None) -> None:
        """Shows from the first moment on what this agent perceives on the way; None: no agent drove."""
        self.agent_name, self._policy = name, policy
        self._shows_agent = policy is not None

    def on_mount(self) -> None:
        super().on_mount()
        self.set_class(self._shows_agent, "-agent")

    def open_world(self) -> None:
        self.host.open_session(self._session, lambda session: self.host.pacing.factor)
        self.observe_agent()

    def _session(self) -> Session:
        """Called in the helper thread."""
        from kit.run.session import Session

        told = self._recording
        session = Session(self._place, seed=told.seed, step_size=told.step_size, always_scan=True)
        session.play_back(told)
        return session

    def action_restart(self) -> None:
        """From the beginning."""
        self.open_world()
