"""The format of worlds, made from the readers' own questions and the devices' own descriptions."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Final

from kit.document.blocks import Chapter, Code
from kit.fields.layout import read_charges
from kit.geometry import Pose
from kit.help.docstrings import docstring_blocks
from kit.help.key_tables import key_tables
from kit.help.topic import HelpTopic, Shelf, chapter
from kit.sim.plugin import PluginType, WorldPluginType
from kit.sim.plugins import plugin_types, world_plugin_types
from kit.world.documents import AllowedRoot, WorldDocuments
from kit.world.key_table import FormatKey, format_keys
from kit.world.layer_reader import LayerReader
from kit.world.loading import read_world
from kit.world.model_loading import ModelPlacement, read_model
from kit.world.plugin_reader import ModelScope, WorldScope
from kit.world.problems import ProblemCollector
from kit.world.records import Model, SourceLocation

WORLD: Final = """\
properties: {}
layers:
  - name: walls
    map: map.yaml
models:
  - name: robot
    model: robot.model.yaml
    pose: [0.5, 0.5, 0.0]
"""
MAP: Final = """\
type: line_segments
data: walls.dat
scale: 1.0
origin: [0.0, 0.0, 0.0]
"""
WALLS: Final = """\
0 0 4 0
4 0 4 3
4 3 0 3
0 3 0 0
"""
MODEL: Final = """\
bodies:
  - name: base
    footprints:
      - {type: circle, radius: 0.15, density: 1.0}
plugins:
  - {type: DiffDrive, name: drive, body: base}
  - type: Laser
    name: lidar
    body: base
    range: 3.0
    angle: {min: -1.57, max: 1.57, increment: 0.1}
    noise_std_dev: 0.01
"""
EXAMPLE: Final = {"world.yaml": WORLD, "map.yaml": MAP, "walls.dat": WALLS, "robot.model.yaml": MODEL}
"""The files of a whole world, by name."""

_FILE: Final = Path("file.yaml").absolute()
_HERE: Final = SourceLocation(_FILE)
_MODEL: Final = Model("model", "", Pose(), _FILE, (), (), (), _HERE)


def _documents() -> WorldDocuments:
    return WorldDocuments(AllowedRoot.of_folder(_FILE.parent), {}, ProblemCollector())


def world_keys() -> tuple[FormatKey, ...]:
    """The keys of a world file."""
    return format_keys(lambda section: read_world(section, _FILE, _documents(), None, None))


def map_keys() -> tuple[FormatKey, ...]:
    """The keys of a layer's map file."""
    alternatives = {"type": ("image", "line_segments")}
    return format_keys(lambda section: LayerReader(_documents()).read_map(section, _FILE), alternatives)


def model_keys() -> tuple[FormatKey, ...]:
    """The keys of a model file."""
    placement = ModelPlacement("model", "", Pose(), _FILE, _HERE)
    return format_keys(lambda section: read_model(section, placement, {}, None))


def charge_keys() -> tuple[FormatKey, ...]:
    """The keys of a charge file."""
    return format_keys(lambda section: read_charges(section, None))


def device_keys(device: PluginType | WorldPluginType) -> tuple[FormatKey, ...]:
    """The keys of a device, without those of every plugin."""
    if isinstance(device, PluginType):
        scope = ModelScope(_MODEL, {})
        return format_keys(lambda section: device.read_params(section, scope))
    world = WorldScope((), (), {})
    return format_keys(lambda section: device.read_params(section, world))


def device_documentation(device: PluginType | WorldPluginType) -> tuple[str, ...]:
    """The docstrings that explain a device and its parts."""
    return tuple(each.__doc__ or "" for each in (*device.parts, device.plugin))


def _chapters() -> tuple[Chapter, ...]:
    return (
        chapter(
            "A whole world",
            "A world is a folder of YAML files as Flatland, a simulator for ROS, reads them. These four files are one:",
            *(
                part
                for name, text in EXAMPLE.items()
                for part in (f"`{name}`", Code(tuple(text.splitlines())))
            ),
            "`kit world check world.yaml` reports every mistake of all files at once, with line and column, and what collides "
            "and what each laser sees. `kit drive world.yaml` opens it.",
        ),
        chapter(
            "In every file",
            """
- A key that the reader does not know is an error, and so is a key that appears twice.
- Lengths are in metres, angles in radians, counter-clockwise; x points forward and y to the left. A pose is `[x, y, theta]`.
- Numbers, `true` and `false` are those of YAML 1.2: `no` is a text, `1e-3` is a number.
- `$include file.yaml` stands for what that file holds; `$[include] file.yaml` in a list for all its documents.
- `env("NAME", default)` stands for an environment variable. `$eval` is refused: a world must not run code.
- A file may name files in the world's own folder, or in its package; `--root FOLDER` allows another.
""",
        ),
        chapter("World file", *key_tables("world", world_keys(), read_world.__doc__ or "")),
        chapter(
            "Map file of a layer",
            "What a layer's key `map` names: where its walls are drawn.",
            *key_tables("map", map_keys(), LayerReader.read_map.__doc__ or ""),
        ),
        chapter("Model file", *key_tables("model", model_keys(), read_model.__doc__ or "")),
        *_device_chapters(),
        chapter(
            "Charge file of a field",
            "`charges.yaml` beside a world says how its walls act in `kit fields show`; without it they are derived from the walls. "
            "`maps/pair_turn/charges.yaml` is an example.",
            *key_tables("charges", charge_keys(), read_charges.__doc__ or ""),
        ),
    )


def _device_chapters() -> Iterator[Chapter]:
    devices: list[PluginType | WorldPluginType] = [*plugin_types.values(), *world_plugin_types.values()]
    for device in devices:
        tables = key_tables(device.type.lower(), device_keys(device), *device_documentation(device))
        yield chapter(f"Device {device.type}", *docstring_blocks(device.plugin.__doc__ or ""), *tables)


TOPIC: Final = HelpTopic(
    "The world format", "every key of worlds, maps, models and devices", Shelf.REFERENCE, _chapters
)
