"""Opens what a user names (a file, an example, a map of the kit) as a planning task."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from kit.layers.examples import EXAMPLES
from kit.layers.flatland.layer_lists import find_layer_lists, read_world_layers
from kit.layers.flatland.requirement_binding import bind_requirements
from kit.layers.flatland.world_case import WorldCase, current_case, to_requirements_file
from kit.layers.flatland.world_planning import WorldPlan, plan_world
from kit.layers.planning import DEFAULT_TIME_LIMIT, LayerPlan, solve_layers
from kit.layers.requirements import LayerCase
from kit.layers.requirements_file import RequirementsFile, is_world_file, read_requirements, requirements_text
from kit.plain_text import quoted, unknown_name
from kit.world.catalogue import WORLD_FILE, allowed_root_of, find_map, map_names, own_map_folder
from kit.world.records import World


class UnknownPlanningTask(LookupError):
    """No file, example or map has that name; the message offers the nearest one."""


@dataclass(frozen=True, slots=True)
class WorldSource:
    """Loads a world, repeatedly."""

    read: Callable[[], World]
    root: Path | None


@dataclass(frozen=True, slots=True)
class PlanningTask:
    """A case, and where it comes from."""

    case: LayerCase
    world: WorldCase | None = None
    requirements: RequirementsFile | None = None
    source: WorldSource | None = None

    def as_requirements(self) -> str:
        """The case as the text of a requirements file."""
        return requirements_text(
            self.case,
            requirements=self.requirements if self.world is None else to_requirements_file(self.world),
        )


def open_task(
    target: str,
    *,
    requirements: Path | None = None,
    one_model_never_collides: bool = False,
    root: Path | None = None,
    environment: Mapping[str, str] | None = None,
) -> PlanningTask:
    """The case that ``target`` stands for: a requirements file, a world file or its folder, an example, a map.

    ``requirements``: what is asked of the world that ``target`` is; by default that it behaves as it does. Raises
    UnknownTask, and WorldError with all that is wrong in the files.
    """
    path, own_root = _find_file(target)
    ignore_self_collisions = one_model_never_collides
    if path is None:
        return _task_without_world(EXAMPLES[target], None, ignore_self_collisions)
    asked = None if requirements is None else read_requirements(requirements)
    if asked is None and not is_world_file(path):
        asked = read_requirements(path)
        if asked.world is None:
            return _task_without_world(asked.case, asked, ignore_self_collisions)
        path, own_root = asked.world, allowed_root_of(asked.world)
    root = own_root if root is None else root
    source = WorldSource(lambda: read_world_layers(path, root=root, environment=environment), root)
    layer_lists = find_layer_lists(source.read(), one_model_never_collides=ignore_self_collisions)
    world_case = current_case(layer_lists) if asked is None else bind_requirements(asked, layer_lists)
    return PlanningTask(world_case.case, world_case, asked, source)


def solve_task(
    task: PlanningTask, *, time_limit: float = DEFAULT_TIME_LIMIT
) -> tuple[LayerPlan, WorldPlan | None]:
    """The plan of the case; and where it is a world's, the plan in the world's own names."""
    if task.world is None:
        return solve_layers(task.case, time_limit=time_limit), None
    world_plan = plan_world(task.world, time_limit=time_limit)
    return world_plan.plan, world_plan


def _task_without_world(
    case: LayerCase, requirements: RequirementsFile | None, ignore_self_collisions: bool
) -> PlanningTask:
    return PlanningTask(
        case.without_self_collisions() if ignore_self_collisions else case, requirements=requirements
    )


def _find_file(target: str) -> tuple[Path | None, Path | None]:
    """The file meant, and the folder it may use if that is not its own; no file for an example. A map in the workspace is
    found by its name, after those of the kit."""
    path = Path(target)
    try:
        if path.is_dir():
            path /= WORLD_FILE
        if path.exists():
            return path, allowed_root_of(path)
    except (OSError, ValueError) as error:  # no permission; a name too long; a NUL in it
        raise UnknownPlanningTask(f"{quoted(target)} cannot be opened") from error
    if target in EXAMPLES:
        return None, None
    maps = map_names()
    if target in maps:
        card = find_map(target)
        return card.world_file, card.root
    own = own_map_folder(target)
    if own is not None:
        return own / WORLD_FILE, allowed_root_of(own / WORLD_FILE)
    known = () if "/" in target or path.suffix else (*EXAMPLES, *maps)
    if known:
        raise UnknownPlanningTask(unknown_name("file, map or example", target, known))
    raise UnknownPlanningTask(f"There is no file {quoted(target)}.")
