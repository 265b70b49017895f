"""Reads the layers of a world file, and the walls of the maps they name, from pictures or lists of segments.

A wall has no thickness: it runs along the edges between dark and bright pixels, so a line drawn one pixel
wide gives two parallel walls. Beyond its rim a picture counts as bright. That is the rule of Flatland's ROS 2
fork and of its releases up to 1.4.1; later ones trace outlines through the middles of the pixels instead.
"""

from __future__ import annotations

import io
import re
import warnings
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Final

import numpy as np
from PIL import Image

from kit.arrays import BoolArray, FloatArray, IndexArray, Uint8Array
from kit.plain_text import counted, join_with_and, quoted
from kit.world.documents import UnusableFile, WorldDocuments, read_bytes
from kit.world.map_server import FREE_THRESH, MODES, MapServerKeys, count_read_otherwise
from kit.world.problems import ProblemCollector
from kit.world.records import (
    MAX_LAYERS,
    Color,
    Layer,
    ReadingRemark,
    SourceLocation,
    Walls,
    turn_remark,
)
from kit.world.yaml_section import MAX_NUMBER, Section
from kit.world.yaml_tree import parse_number

MAX_IMAGE_BYTES = 32_000_000
MAX_PIXELS = 4096 * 4096
MAX_LINES_BYTES = 16_000_000
MAX_SEGMENTS = 100_000
"""Wall segments of one map; Flatland's largest public map has some 5,000."""
MAX_REPORTED_LINES = 10
"""Mistakes reported of one .dat file."""

FORMATS = ("PNG", "JPEG", "BMP", "PPM")
MAX_JPEG_SCANS = 100
"""How often a JPEG may go over its pixels: progressive ones do it about ten times."""
START_OF_JPEG, START_OF_SCAN, END_OF_JPEG = b"\xff\xd8", b"\xda", b"\xd9"
JPEG_MARKER = re.compile(rb"\xff+([^\x00\x01\xff\xd0-\xd7])", re.DOTALL)
"""Begins a segment and is followed by its length, as those are not that stand among the pixels."""

# Luma weights of red, green and blue in 1/32768, as OpenCV and libpng have them.
_LUMA = np.array([9798, 19235, 3735], dtype=np.uint32)
_LUMA_SHIFT = 15


def dark_pixels(grey: Uint8Array, occupied_thresh: float) -> BoolArray:
    """Which pixels of (rows, columns) grey levels are dark: not between ``occupied_thresh`` and 1 of white."""
    shades = (np.arange(256) * (1 / 255)).astype(np.float32)
    found: BoolArray = ~((shades >= np.float32(occupied_thresh)) & (shades <= 1))[grey]
    return found


def open_picture(content: bytes, formats: Iterable[str] = FORMATS) -> Image.Image:
    """Opens a picture, whose pixels are decoded later. Raises UnusableFile for one that would take minutes to decode, and
    what Pillow raises."""
    if content.startswith(START_OF_JPEG) and _has_more_scans(content, MAX_JPEG_SCANS):
        raise UnusableFile(f"it goes over its pixels more than {MAX_JPEG_SCANS} times: save it again")
    with warnings.catch_warnings():
        # Pillow's own: of the size, for which whoever opens a picture has a stricter limit, and of remarks that are damaged.
        warnings.simplefilter("ignore")
        return Image.open(io.BytesIO(content), formats=tuple(formats))


def _has_more_scans(jpeg: bytes, most: int) -> bool:
    """Whether the picture goes over its pixels more often; what comes after it, such as a telephone's film, does not count."""
    scans, place = 0, len(START_OF_JPEG)
    while scans <= most and (found := JPEG_MARKER.search(jpeg, place)) and found[1] != END_OF_JPEG:
        scans += found[1] == START_OF_SCAN
        place = found.end() + int.from_bytes(jpeg[found.end() : found.end() + 2])
    return scans > most


def read_image(file: Path) -> tuple[Uint8Array, Uint8Array | None]:
    """A picture as (rows, columns) grey levels, the top row first, and the opacity of the pixels likewise; None if it has none.
    Raises UnusableFile."""
    content = read_bytes(file, MAX_IMAGE_BYTES)
    try:
        with open_picture(content) as image:
            if image.width * image.height > MAX_PIXELS:
                raise UnusableFile(
                    f"the picture has {image.width} x {image.height} pixels, "
                    f"but at most {MAX_PIXELS} are read: reduce its resolution"
                )
            alpha = None
            if image.has_transparency_data:
                alpha = np.asarray(image.convert("RGBA"))[..., 3]
            return _grey_levels(image), alpha
    except UnusableFile:
        raise
    except Image.DecompressionBombError as error:
        raise UnusableFile(f"the picture is too large: at most {MAX_PIXELS} pixels are read") from error
    except Exception as error:  # Pillow's decoders raise whatever a broken file makes of them
        known = ", ".join(FORMATS)
        raise UnusableFile(f"it is not a readable picture (formats: {known}), or it is damaged") from error


def _grey_levels(image: Image.Image) -> Uint8Array:
    if image.mode.startswith("I"):  # 16 bits: the high byte, as OpenCV takes it
        return (np.asarray(image).astype(np.uint32) >> 8).astype(np.uint8)
    if image.mode in ("1", "L", "LA"):
        return np.asarray(image.convert("L"))
    rgb = np.asarray(image.convert("RGB"))
    # OpenCV leaves a PNG's colours to libpng, which rounds down; its own formats it rounds to the nearest.
    half = 0 if image.format == "PNG" else 1 << (_LUMA_SHIFT - 1)
    grey = np.empty(rgb.shape[:2], dtype=np.uint8)
    for row in range(0, len(rgb), 256):  # in strips, for the memory's sake
        grey[row : row + 256] = (rgb[row : row + 256] @ _LUMA + half) >> _LUMA_SHIFT
    return grey


def trace_edges(dark: BoolArray, resolution: float) -> FloatArray:
    """The edges between the dark and the bright pixels of (rows, columns): (n, 4) ``x1 y1 x2 y2`` [m].

    Edges along one grid line are joined. First those along rows, from the top, then those along columns, from
    the left. Linear in the number of pixels. Raises Unusable if there are more than MAX_SEGMENTS.
    """
    rows = len(dark)
    y, x1, x2 = _edge_runs(dark)
    x, y1, y2 = _edge_runs(dark.T)
    if len(y) + len(x) > MAX_SEGMENTS:
        raise UnusableFile(
            f"the picture has {len(y) + len(x)} wall segments, but at most {MAX_SEGMENTS} are read: "
            "it is noisy, or its resolution is too high"
        )
    across = np.column_stack([x1, rows - y, x2, rows - y])
    upright = np.column_stack([x, rows - y2, x, rows - y1])
    return np.concatenate([across, upright]) * resolution


def _edge_runs(dark: BoolArray) -> tuple[IndexArray, IndexArray, IndexArray]:
    """The maximal runs along which two neighbouring rows differ: the line between them, first and last corner."""
    rows, columns = dark.shape
    padded = np.zeros((rows + 2, columns), dtype=np.bool_)
    padded[1:-1] = dark
    differs = np.zeros((rows + 1, columns + 2), dtype=np.bool_)
    np.not_equal(padded[:-1], padded[1:], out=differs[:, 1:-1])
    line, start_or_end = np.nonzero(differs[:, :-1] != differs[:, 1:])
    return line[0::2], start_or_end[0::2], start_or_end[1::2]


def walls_from_lines(file: Path, scale: float, problems: ProblemCollector) -> FloatArray:
    """The walls (n, 4) ``x1 y1 x2 y2`` [m] of a .dat file: four numbers a line, times ``scale``.

    Lines that are no segment are noted. Raises Unusable if the file cannot be read.
    """
    text = read_bytes(file, MAX_LINES_BYTES).decode("latin-1")
    if text.count("\n") > MAX_SEGMENTS:
        raise UnusableFile(f"it has more than {MAX_SEGMENTS} lines")
    segments: list[tuple[float, ...]] = []
    bad = 0
    for number, line in enumerate(_split_lines(text), start=1):
        segment = _parse_segment(line)
        if segment is not None:
            segments.append(segment)
            continue
        bad += 1
        if bad > MAX_REPORTED_LINES:
            break
        problems.add(
            SourceLocation(file, number),
            f"{quoted(line.strip())} is not a segment: give four numbers x1 y1 x2 y2",
        )
    return np.array(segments, dtype=np.float64).reshape(-1, 4) * scale


def _split_lines(text: str) -> Iterator[str]:
    """The lines; a final newline does not begin another one."""
    return iter(text.removesuffix("\n").split("\n") if text else ())


def _parse_segment(line: str) -> tuple[float, ...] | None:
    """The first four numbers of the line; what follows them is not looked at, as in Flatland."""
    numbers = [parse_number(word) for word in line.split(maxsplit=4)[:4]]
    if len(numbers) < 4:
        return None
    found = tuple(number for number in numbers if number is not None and abs(number) <= MAX_NUMBER)
    return found if len(found) == 4 else None


NEGATED: Final = ("true", "yes", "on", "y")
"""What ``negate`` may be, as text, for map_server to take light pixels as occupied; so it does for every number but 0."""

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
                f"a layer's map is a YAML file that names the drawing, not the drawing itself: give a file that contains "
                f'"{key}: {file.name}"',
                "map",
            )
            return None
        if file not in self._maps and len(self._maps) == MAX_LAYERS:
            return None  # there are too many layers, which is reported; further images would only cost time
        if file not in self._maps:
            found = self._documents.section(file, section.location_of("map"))
            self._maps[file] = None if found is None else self.read_map(found, file)
        return self._maps[file]

    def _read_threshold(self, section: Section) -> float:
        threshold = section.number("occupied_thresh")
        if 1 < threshold <= 100:
            section.error(
                f"must be a share of 1: {threshold / 100:g} if {threshold:g} means percent", "occupied_thresh"
            )
        return threshold

    def read_map(self, section: Section, file: Path) -> Walls | None:
        """The walls that a layer's map file describes. What is wrong is noted.

        =============== ===============================================================================
        origin          where the drawing's lower left corner lies in the world [m, m, rad]
        type            ``line_segments`` for a file of lines; anything else, or nothing, for a picture
        image           the picture, relative to this file
        resolution      size of a pixel [m]
        occupied_thresh how bright a wall stays below, 0 black to 1 white
        free_thresh     how dark the floor is at most, to ROS's map_server; of no effect here
        negate          1: walls are bright, to ROS's map_server; of no effect here
        mode            how grey becomes darkness, to ROS's map_server; of no effect here
        data            file of lines ``x1 y1 x2 y2``, relative to this file
        scale           length of the file's unit [m]
        =============== ===============================================================================
        """
        origin = section.pose("origin")
        readings = {turn_remark(section.location_of("origin"), "the origin", origin.theta)}
        resolution, keys = 0.0, None
        if section.text("type", "") == "line_segments":
            key, scale = "data", section.number("scale")
        else:
            key = "image"
            resolution = section.number("resolution", above=0)
            if resolution > 1:
                remark = f"a pixel is {resolution:g} m wide. If {resolution:g} means pixels per metre, write {1 / resolution:g}."
                readings.add(ReadingRemark(section.location_of("resolution"), remark))
            keys = self._read_keys(section, readings)
        source = self._documents.referenced_file(section, key)
        section.finish(ignore_unknown=True)
        if source is None:
            return None
        try:
            if keys is None:
                local = walls_from_lines(source, scale, self._documents.problems)
            else:
                grey, alpha = read_image(source)
                dark = dark_pixels(grey, keys.occupied_thresh)
                local = trace_edges(dark, resolution)
                readings.add(_reading_remark(section, dark, grey, alpha, keys))
        except UnusableFile as error:
            section.error(f"cannot read {quoted(str(source), 200)}: {error}", key)
            return None
        local.setflags(write=False)
        return Walls(
            local_segments=local,
            origin=origin,
            file=file,
            drawing_file=source,
            readings=tuple(sorted(filter(None, readings))),
        )

    def _read_keys(self, section: Section, readings: set[ReadingRemark | None]) -> MapServerKeys:
        """The keys of ROS's map_server. Flatland uses the first alone, so what it does not use may be anything: what
        map_server would refuse or take otherwise than it looks is added to ``readings``."""
        threshold = self._read_threshold(section)
        free = parse_number(section.text("free_thresh", "") or "")
        negate = section.text("negate", "0").lower()
        mode = section.text("mode", "trinary").lower()
        if free is not None and free > 1:
            remark = f'"free_thresh" is a share of 1 to ROS\'s map_server, and has no effect here: {free / 100:g} if {free:g} means percent.'
            readings.add(ReadingRemark(section.location_of("free_thresh"), remark))
        if mode not in MODES:
            remark = f"the mode has no effect here; ROS's map_server refuses {quoted(mode)}: there is {join_with_and(MODES)}."
            readings.add(ReadingRemark(section.location_of("mode"), remark))
        return MapServerKeys(
            threshold,
            FREE_THRESH if free is None else free,
            bool(parse_number(negate)) or negate in NEGATED,
            MODES.get(mode, "trinary"),
        )


def _reading_remark(
    section: Section, dark: BoolArray, grey: Uint8Array, alpha: Uint8Array | None, keys: MapServerKeys
) -> ReadingRemark | None:
    """How the picture was read, if ROS's map_server reads it otherwise."""
    count = count_read_otherwise(dark, grey, alpha, keys)
    if not count:
        return None
    unused = [
        name for name, is_used in (("negate", keys.negate), ("mode", keys.mode != "trinary")) if is_used
    ]
    whatever = f", without regard to {join_with_and(unused)}" if unused else ""
    return ReadingRemark(
        section.location_of(unused[0] if unused else "occupied_thresh"),
        f"read as Flatland reads it: walls are what is darker than {keys.occupied_thresh:g} of white{whatever}. "
        f"ROS's map_server takes {counted(count, 'pixel')} of {grey.size} otherwise.",
    )
