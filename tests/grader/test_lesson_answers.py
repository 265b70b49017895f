"""What lessons call right about worlds is what the kit itself does: answers are derived, not believed."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from grader.kinds.answers.kind import AnswerKey, AnswersTask
from grader.kinds.world.facts import WorldFacts
from grader.kinds.world.world_reading import read_world_facts
from grader.reading import read_assignment

LESSONS = Path(__file__).parents[2] / "lessons"
YARD = LESSONS / "07-who-collides-who-sees" / "what-happens"
SPEAKERS = LESSONS / "06-models-and-plugins" / "who-speaks"

PLUGINS = {
    "laser": "{type: Laser, name: it, body: base, range: 1, angle: {min: 0, max: 1, increment: 0.5}, broadcast_tf: false}",
    "bumper": "{type: Bumper, name: it}",
    "diff_drive": "{type: DiffDrive, name: it, body: base}",
    "gps": "{type: Gps, name: it, body: base}",
    "bool_sensor": "{type: BoolSensor, name: it}",
    "tween": "{type: Tween, name: it, body: base, mode: trigger, trigger_topic: go, delta: [1, 0, 0]}",
}


def keys_of(folder: Path) -> Mapping[str, AnswerKey]:
    task: AnswersTask = read_assignment(folder).task
    return task.keys


@pytest.fixture(scope="module")
def yard() -> WorldFacts:
    facts, _ = read_world_facts(YARD / "starter" / "world.yaml")
    assert facts.problems == ()
    return facts


def named(thing: tuple[str, str]) -> str:
    return thing[0] or "walls"


@pytest.mark.parametrize("pair", sorted(set(keys_of(YARD)) - {"laser_sees"}))
def test_who_collides_in_the_yard(yard: WorldFacts, pair: str) -> None:
    (collides,) = {
        meeting.collides
        for meeting in yard.collisions
        if {named(meeting.a), named(meeting.b)} == set(pair.split("_"))
    }
    assert keys_of(YARD)[pair].right == ("yes" if collides else "no",)


def test_what_the_truck_sees(yard: WorldFacts) -> None:
    sees = {named(view.thing) for view in yard.sights if view.sees and view.laser == "truck/lidar"}
    assert set(keys_of(YARD)["laser_sees"].right) == sees


def test_every_plugin_asked_about_is_tried() -> None:
    assert set(keys_of(SPEAKERS)) == set(PLUGINS)


@pytest.mark.parametrize("plugin", sorted(PLUGINS))
def test_who_speaks_and_who_listens(tmp_path: Path, plugin: str) -> None:
    (tmp_path / "world.yaml").write_text("properties: {}\nlayers: []\nmodels: [{name: it, model: it.yaml}]\n")
    (tmp_path / "it.yaml").write_text(
        "bodies: [{name: base, footprints: [{type: circle, radius: 1, density: 1}]}]\n"
        f"plugins:\n  - {PLUGINS[plugin]}\n"
    )
    facts, _ = read_world_facts(tmp_path / "world.yaml")
    assert facts.problems == ()
    ways = {end.publishes for end in facts.endpoints if end.topic != "/tf"}
    right = {frozenset({True}): "publishes", frozenset({False}): "subscribes"}.get(frozenset(ways), "both")
    assert keys_of(SPEAKERS)[plugin].right == (right,)
