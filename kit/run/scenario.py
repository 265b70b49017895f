"""Scenarios: a map of the catalogue or a world file, the robots that drive in it, their start and target."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

from kit.geometry import Pose
from kit.plain_text import quoted
from kit.workspace import WorkspaceError, expand_home, open_workspace
from kit.world.catalogue import WORLD_FILE, MapCard, MapCase, find_map, map_names, own_card, own_map_folder
from kit.world.records import Model, World

BEACON = "beacon"
"""A model of this name stands where the case's target is."""
BEACON_RADIUS = 0.2
"""How near a beacon is near enough, in a world without a card [m]."""


@dataclass(frozen=True, slots=True)
class Scenario:
    """A world, the robots that drive in it, their start and target."""

    name: str
    """A map's name, or the path of a world file; ``find_scenario`` takes it."""
    title: str
    world: World
    robot: str | None
    """The model that drives; None in a world without models."""
    case: MapCase | None = None
    charges: Path | None = None
    """A charge file that replaces the world's own; see ``kit.fields.layout``."""
    targets: tuple[tuple[float, float], ...] = ()
    """Where there are several targets: all of them in their order [m, m], the case's first; one that is to be reached
    several times is there as often."""
    target_heading: float | None = None
    """The heading asked for at the target [rad]; None: any will do."""
    leader: str | None = None
    """The model that is the target, where that moves."""
    level: str | None = None
    """The level of the game under whose conditions this is; None: the map as it is."""

    @property
    def drivers(self) -> tuple[str, ...]:
        """All models that can drive, the robot first."""
        first = () if self.robot is None else (self.robot,)
        return tuple(dict.fromkeys((*first, *_models_with_drive(self.world))))

    @property
    def partners(self) -> tuple[str, ...]:
        """The models that drive from start to target: the robot, and where the case is one for two, or there is
        none, the second driver too."""
        is_alone = self.case is not None and self.case.partner_start is None
        return self.drivers[: 1 if is_alone else 2]

    @property
    def starts(self) -> tuple[Pose, ...]:
        """The partners' poses at the start."""
        poses = {model.name: model.pose for model in self.world.models}
        return tuple(poses[name] for name in self.partners)

    @property
    def leader_frame(self) -> str:
        """The frame on /tf of the target that moves; empty where nothing publishes it, and where no target moves."""
        from kit.sim.plugins.model_tf_publisher import (
            frame_in_world,
        )  # only where a target moves: it brings the simulator

        return next((frame_in_world(each) for each in self.world.models if each.name == self.leader), "")

    @property
    def driven(self) -> Model | None:
        """The robot's model; None without one."""
        return next((model for model in self.world.models if model.name == self.robot), None)

    @property
    def start(self) -> Pose | None:
        """The robot's pose at the start; None without one."""
        return None if self.driven is None else self.driven.pose


def scenario_on_map(card: MapCard, case: MapCase | None = None) -> Scenario:
    """The scenario of a case of a map, by default its first. Raises WorldError."""
    case = case or card.cases[0]
    poses = {card.robot: case.start, BEACON: Pose(*case.target)}
    if card.partner is not None and case.partner_start is not None:
        poses[card.partner] = case.partner_start
    from kit.sim.card_world import (
        load_card_world,  # only where a world is read: it brings the whole simulator
    )

    world = load_card_world(card)
    models = tuple(replace(model, pose=poses.get(model.name, model.pose)) for model in world.models)
    return Scenario(card.name, card.title, replace(world, models=models), card.robot, case)


def scenario_in_file(file: Path, root: Path | None = None) -> Scenario:
    """The scenario of a world file; its first model with a drive is the robot. Raises WorldError."""
    from kit.sim.simulation import load_world  # as above

    world = load_world(file, root=root)
    driven = _models_with_drive(world)
    robot = driven[0] if driven else next((model.name for model in world.models), None)
    title = file.stem if file.stem != "world" else file.parent.name
    return Scenario(str(file), title, world, robot, _case_of_world(world, driven))


def _case_of_world(world: World, driven: tuple[str, ...]) -> MapCase | None:
    """The case from the robots' poses to the beacon, where a world without a card has both."""
    poses = {model.name: model.pose for model in world.models}
    if not driven or BEACON not in poses:
        return None
    x, y, _ = poses[BEACON]
    partner = poses[driven[1]] if len(driven) > 1 else None
    return MapCase(
        "to the beacon",
        poses[driven[0]],
        (x, y),
        BEACON_RADIUS,
        (0.0, 0.0),
        (0.0, 0.0),
        is_heading_random=False,
        group="",
        partner_start=partner,
    )


def _models_with_drive(world: World) -> tuple[str, ...]:
    return tuple(
        model.name for model in world.models if any(plugin.type.endswith("Drive") for plugin in model.plugins)
    )


def find_scenario(name: str, case: str | None = None, root: Path | None = None) -> Scenario:
    """Finds a scenario by a map's name, a world file or its folder, or the name of the user's own map in the workspace; a
    map goes before a folder of that name, and that before a map in the workspace. A card beside a world file gives start
    and target, as for the kit's own maps.

    ``root``: the folder that its files must lie in; then no map of the workspace is looked for.

    Raises WorldError, UnknownMap, or LookupError for the case.
    """
    file = _own_world_file(name, root)
    if file is None:
        return _scenario_of_case(find_map(name), case)
    own = own_card(file) if root is None else None
    if own is None:
        return scenario_in_file(file, root)
    return replace(_scenario_of_case(own, case), name=str(file))


def find_recorded_scenario(
    place: str, case: str | None, recording: Path, root: Path | None = None
) -> Scenario:
    """Finds the scenario that a recording names, as ``find_scenario`` does; but a recording may be anybody's, so a file that
    is no map of the kit's or the workspace's must lie in the folder of the recording, in the current folder, or below.

    Raises as ``find_scenario``, and LookupError where it lies elsewhere.
    """
    file = _own_world_file(place, root)
    if root is None and file is not None:
        near = [recording.absolute().parent.resolve(), Path.cwd()]
        with suppress(WorkspaceError):
            near.append(open_workspace(make=False).worlds.resolve())
        if not any(file.resolve().is_relative_to(folder) for folder in near):
            raise LookupError(
                f"{recording}: was made in {quoted(place)}, which lies neither beside it nor in the current folder. "
                "If that is right, say where the world is: --root FOLDER."
            )
    return find_scenario(place, case, root)


def case_names(name: str) -> tuple[str, ...]:
    """The names of the cases of a map, found as ``find_scenario`` finds it; none where no card gives start and target.

    Raises WorldError and UnknownMap.
    """
    file = _own_world_file(name)
    card = find_map(name) if file is None else own_card(file)
    return () if card is None else tuple(case.name for case in card.cases)


def _own_world_file(name: str, root: Path | None = None) -> Path | None:
    """The world file that a name stands for, where it is not that of a map of the kit's."""
    if name in map_names():
        return None
    try:
        path = expand_home(name)
        if root is None and not path.exists():
            path = own_map_folder(name) or path
        if path.is_dir():
            path = path / WORLD_FILE
        return path.absolute() if path.is_file() or path.suffix in (".yaml", ".yml") else None
    except (OSError, ValueError):  # what cannot be a file's name is no map's either
        return None


def _scenario_of_case(card: MapCard, case: str | None) -> Scenario:
    if case is None:
        return scenario_on_map(card)
    for known in card.cases:
        if known.name == case:
            return scenario_on_map(card, known)
    raise LookupError(
        f"The map {card.name} has no case {case}; it has: {', '.join(each.name for each in card.cases)}."
    )
