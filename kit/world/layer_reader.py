"""The layers of a world file, and the maps they name."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import partial
from pathlib import Path
from types import MappingProxyType

from kit.plain_text import quoted
from kit.world.documents import WorldDocuments
from kit.world.files import UnusableFile
from kit.world.records import MAX_LAYERS, Color, Layer, Walls
from kit.world.walls import walls_from_image, walls_from_lines
from kit.world.yaml_section import Section

WHITE: Color = (1.0, 1.0, 1.0, 1.0)

DRAWING_KEYS: Mapping[str, str] = MappingProxyType(
    {**dict.fromkeys((".png", ".jpg", ".jpeg", ".bmp", ".ppm", ".pgm"), "image"), ".dat": "data"}
)
"""Endings of files that hold walls themselves, and the key of the layer file that names such a one."""


class LayerReader:
    """Reads the layers in order, and hands out their bits in that order."""

    def __init__(self, documents: WorldDocuments) -> None:
        self._documents = documents
        self._layer_bits: dict[str, int] = {}
        self._maps: dict[Path, Walls | None] = {}

    @property
    def layer_bits(self) -> Mapping[str, int]:
        """The bit of every name read so far."""
        return MappingProxyType(dict(self._layer_bits))

    def read(self, sections: Iterable[Section]) -> tuple[Layer, ...]:
        return tuple(self._read_layer(section) for section in sections)

    def _read_layer(self, section: Section) -> Layer:
        names = section.names("name")
        properties = section.section("properties", None)
        layer = Layer(
            names=names,
            bits=self._register_names(names, section),
            color=section.color("color", WHITE),
            walls=self._read_walls(section) if section.text("map", "") else None,
            properties=properties.remaining_values() if properties else MappingProxyType({}),
            location=section.location,
        )
        section.finish()
        return layer

    def _register_names(self, names: tuple[str, ...], section: Section) -> int:
        """The bits of the names; a name that is taken, or one too many, gets none."""
        before = len(self._layer_bits)
        bits = 0
        for name in filter(None, names):
            if name in self._layer_bits:
                section.error(f"a layer named {quoted(name)} already exists", "name")
            elif len(self._layer_bits) < MAX_LAYERS:
                self._layer_bits[name] = 1 << len(self._layer_bits)
                bits |= self._layer_bits[name]
            else:
                count = f"{len(names)} here after {before} before"
                section.error(f"a world has at most {MAX_LAYERS} layer names: {count} are too many", "name")
                break
        return bits

    def _read_walls(self, section: Section) -> Walls | None:
        file = self._documents.referenced_file(section, "map")
        if file is None:
            return None
        if file.suffix.lower() in DRAWING_KEYS:
            key = DRAWING_KEYS[file.suffix.lower()]
            section.error(
                f"a layer's map is a YAML file that names the drawing, not the drawing: name a file in which "
                f'"{key}: {file.name}" stands',
                "map",
            )
            return None
        if file not in self._maps and len(self._maps) == MAX_LAYERS:
            return None  # there are too many layers, which is reported; further images would only cost time
        if file not in self._maps:
            found = self._documents.section(file, section.location_of("map"))
            self._maps[file] = None if found is None else self._read_map(found, file)
        return self._maps[file]

    def _read_map(self, section: Section, file: Path) -> Walls | None:
        origin = section.pose("origin")
        if section.text("type", "") == "line_segments":
            key = "data"
            read = partial(walls_from_lines, scale=section.number("scale"), problems=self._documents.problems)
        else:
            key = "image"
            read = partial(
                walls_from_image,
                resolution=section.number("resolution", above=0),
                occupied_thresh=section.number("occupied_thresh"),
            )
        source = self._documents.referenced_file(section, key)
        section.finish(ignore_unknown=True)
        if source is None:
            return None
        try:
            local = read(source)
        except UnusableFile as error:
            section.error(f"cannot read {quoted(str(source), 200)}: {error}", key)
            return None
        local.setflags(write=False)
        return Walls(local_segments=local, origin=origin, file=file, drawing_file=source)
