"""What a drive of a level had to reach, while it is played back: the map's case knows of one target alone."""

from __future__ import annotations

from kit.run.session import Session
from kit.school.game.daily import find_playable_level
from kit.school.game.race import RaceReferee
from kit.school.game.two_players import GUEST


def show_goal(session: Session) -> None:
    """Has the views of a session that plays a drive of a level back show the targets that were next, and the level's bumps.
    Does nothing where the session is of no level, or of a game for two. Raises UnknownLevel and WorldError."""
    scenario = session.scenario
    if scenario.level is None or any(model.name == GUEST for model in scenario.world.models):
        return
    referee = RaceReferee(find_playable_level(scenario.level), scenario, session.runner.simulation.step_size)
    session.runner.observers.append(referee)
    session.shown = referee.shown
