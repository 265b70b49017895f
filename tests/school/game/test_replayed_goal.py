"""A drive of a level that is played back has the level's targets, one after the other."""

from __future__ import annotations

from kit.run.animation import recorded_scenes
from kit.run.session import Session
from kit.school.game.levels import find_level
from kit.school.game.references import reference_recording
from kit.school.game.replayed_goal import show_goal
from kit.school.game.starts import film_scenario
from kit.school.game.two_players import shared_scenario


def test_each_target_is_shown_until_it_is_reached() -> None:
    level = find_level("first-drive")
    recording = reference_recording(level)
    assert recording is not None
    scenario = film_scenario(level, recording.seed)
    scenes = [each.scene for each in recorded_scenes(recording, scenario, 20, prepare=show_goal)]
    shown = list(dict.fromkeys(tuple((disc.x, disc.y) for disc in scene.targets) for scene in scenes))
    assert shown == [((x, y),) for x, y in level.targets] + [()]


def test_a_game_for_two_is_shown_as_it_is() -> None:
    with Session(shared_scenario(find_level("two-doors"))) as session:
        observers = list(session.runner.observers)
        show_goal(session)
        assert session.runner.observers == observers
