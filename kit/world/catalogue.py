"""The catalogue of the kit's maps: their purpose, robots, starts and targets."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

from kit.extensions import folders
from kit.geometry import Pose
from kit.plain_files import is_file_there
from kit.plain_text import quoted, unknown_name
from kit.workspace import WorkspaceError, open_workspace
from kit.world.documents import open_document
from kit.world.yaml_section import Section

CARD_FILE = "about.yaml"
WORLD_FILE = "world.yaml"
WORLD_FOLDERS = ("worlds", "world")
ROBOT_FOLDERS = ("models", "robots")
"""Names of folders in a package of ROS without its ``package.xml``."""
MAX_PACKAGE_DEPTH = 5
"""A package is looked for in this many folders above a world file."""


class UnknownMap(LookupError):
    """No map has that name; the message offers the nearest one."""


@dataclass(frozen=True, slots=True)
class MapCase:
    """A task on a map: drive from ``start`` to within ``target_radius`` of ``target``. In metres and radians."""

    name: str
    start: Pose
    target: tuple[float, float]
    target_radius: float
    start_shift: tuple[float, float]
    """Largest random displacement of the start along x and y [m], to either side."""
    target_shift: tuple[float, float]
    is_heading_random: bool
    """Whether the start's heading is drawn at random."""
    group: str
    """Cases that results are given for together; may be empty."""
    partner_start: Pose | None
    """The start of the map's partner, if it has one; None: its pose in the world file."""


@dataclass(frozen=True, slots=True)
class MovingCart:
    """A cart that goes to and fro by itself, added to a map."""

    name: str
    start: Pose
    delta: Pose
    """From one end of its way to the other."""
    duration: float
    """Time from one end to the other [s]."""


def read_carts(section: Section) -> tuple[MovingCart, ...]:
    """Reads the ``carts`` of a level or a task, if it has any."""
    carts = []
    for cart in section.sections("carts", ()):
        carts.append(
            MovingCart(
                cart.name("name"),
                cart.pose("start"),
                Pose(*cart.point("delta"), 0.0),
                cart.number("duration", above=0),
            )
        )
        cart.finish()
    return tuple(carts)


@dataclass(frozen=True, slots=True, repr=False)
class MapCard:
    """One map of the catalogue."""

    name: str
    title: str
    summary: str
    source: str
    folder: Path
    world_file: Path
    robot: str
    """The model of the world that drives."""
    partner: str | None
    """The second model, where two drive as one."""
    cases: tuple[MapCase, ...]
    root: Path
    """The folder its world may read: that of all maps, since they share their robots."""
    carts: tuple[MovingCart, ...] = ()
    """Those that a task adds."""

    def __repr__(self) -> str:
        """``MapCard(turn: cases turn_a_to_b, turn_b_to_a)``"""
        cases = ", ".join(case.name for case in self.cases)
        return f"MapCard({self.name}: cases {cases or 'none'})"


def maps_folder() -> Path:
    """Returns the folder of the maps: in the installed package, or beside it in a checkout. Raises FileNotFoundError."""
    package = Path(__file__).resolve().parents[1]
    for folder in (package / "data" / "maps", package.parent / "maps"):
        if folder.is_dir():
            return folder
    raise FileNotFoundError(f"the maps are missing: neither in {package / 'data'} nor beside {package}")


def allowed_root_of(world_file: Path) -> Path | None:
    """The folder whose files a world file may read: all maps for one of the kit's, the package for one in a package; None for
    any other file, which gets its own folder.

    A package is the nearest folder above that holds a ``package.xml``; or, for a file in a folder ``worlds`` or ``world``, the
    folder above that if its robots lie beside in ``models`` or ``robots``.
    """
    with suppress(FileNotFoundError):
        folder = maps_folder()
        if world_file.resolve().is_relative_to(folder.resolve()):
            return folder
    return _package_folder(Path(os.path.abspath(world_file)))  # noqa: PTH100 - "..", but no link, is to be taken out


def _package_folder(world_file: Path) -> Path | None:
    """Never the user's home or the root of the disk: too much would be allowed."""
    too_wide = (Path.home(), Path(world_file.anchor))
    above = [folder for folder in world_file.parents[:MAX_PACKAGE_DEPTH] if folder not in too_wide]
    for folder in above:
        if (folder / "package.xml").is_file():
            return folder
    if world_file.parent.name in WORLD_FOLDERS and len(above) > 1:
        package = world_file.parent.parent
        if package in above and any((package / name).is_dir() for name in ROBOT_FOLDERS):
            return package
    return None


def all_maps(folder: Path | None = None) -> tuple[MapCard, ...]:
    """Returns the maps in a folder (default: the kit's own), sorted by name. Raises WorldError if a card is wrong.

    >>> "maze" in [card.name for card in kit.all_maps()]
    True
    """
    return tuple(_read_card(_map_folder(name, folder)) for name in map_names(folder))


def find_map(name: str, folder: Path | None = None) -> MapCard:
    """Returns the map of that name: its world file, its robot, and its cases with start and target in metres and radians.

    A map of the kit's, of another package's, or one of your own in the workspace; in this order.
    Raises UnknownMap, and WorldError if its card is wrong.

    >>> card = kit.find_map("pair_straight")
    >>> card.robot, card.partner, [case.name for case in card.cases]
    ('left', 'right', ['pair_straight'])
    """
    names = map_names(folder)
    own = own_map_folder(name) if folder is None and name not in names else None
    if own is not None and (card := own_card(own / WORLD_FILE)) is not None:
        return card
    if name not in names:
        raise UnknownMap(unknown_name("map", name, names, "kit maps"))
    return _read_card(_map_folder(name, folder))


def own_card(world_file: Path) -> MapCard | None:
    """The card beside a world file that is not of the kit; None without one. Raises WorldError if the card is wrong."""
    folder = world_file.parent
    if world_file.name != WORLD_FILE or not (folder / CARD_FILE).is_file():
        return None
    return replace(_read_card(folder), root=allowed_root_of(world_file) or folder)


def own_map_folder(name: str) -> Path | None:
    """The folder of the user's own map of that name in the workspace; None if there is none."""
    if not name or Path(name).name != name:
        return None
    try:
        folder = open_workspace(make=False).worlds / name
    except WorkspaceError:
        return None
    return folder if is_file_there(folder / WORLD_FILE) else None


def map_names(folder: Path | None = None) -> tuple[str, ...]:
    """The names of all maps, without reading them: every folder with a card is one. Without ``folder`` those of others'
    packages too."""
    places = [maps_folder(), *_folders_of_others()] if folder is None else [folder]
    return tuple(sorted({card.parent.name for place in places for card in place.glob(f"[!.]*/{CARD_FILE}")}))


def _folders_of_others() -> list[Path]:
    return [folder for _, folder in folders("maps")]


def _map_folder(name: str, folder: Path | None) -> Path:
    """The folder of a map that there is; the kit's own go before those of others."""
    if folder is not None:
        return folder / name
    for place in (maps_folder(), *_folders_of_others()):
        if (place / name / CARD_FILE).is_file():
            return place / name
    raise UnknownMap(f"there is no map {quoted(name)}")


def _read_card(folder: Path) -> MapCard:
    with open_document(folder / CARD_FILE) as section:
        return MapCard(
            name=folder.name,
            title=section.name("title", folder.name),
            summary=section.text("summary", ""),
            source=section.text("source", ""),
            folder=folder,
            world_file=folder / WORLD_FILE,
            robot=section.name("robot", "serp"),
            partner=section.name("partner") if section.has("partner") else None,
            cases=tuple(_cases_from(section.sections("cases", at_least=1))),
            root=folder.parent,
        )


def _cases_from(sections: tuple[Section, ...]) -> Iterator[MapCase]:
    names: set[str] = set()
    for section in sections:
        case = MapCase(
            name=section.name("name"),
            start=section.pose("start"),
            target=section.point("target"),
            target_radius=section.number("target_radius", 0.2, above=0),
            start_shift=section.point("start_shift", (0.0, 0.0)),
            target_shift=section.point("target_shift", (0.0, 0.0)),
            is_heading_random=section.flag("any_heading", False),
            group=section.text("group", ""),
            partner_start=section.pose("partner_start") if section.has("partner_start") else None,
        )
        section.finish()
        if case.name in names:
            section.error(f"a case named {quoted(case.name)} already exists", "name")
        names.add(case.name)
        yield case
