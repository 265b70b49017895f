"""Frames of characters, the spans that differ between two, and the encoders from dots to characters."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from kit.arrays import Uint8Array
from kit.render.raster import Grid
from kit.render.role_looks import ROLE_LOOKS
from kit.render.roles import SHADES, Role

BLANK = ord(" ")

MERGE_GAP = 3
"""Unchanged characters that are cheaper to send again than to jump over: moving the cursor costs six to nine bytes, a
character of dots three."""


class CellSpan(NamedTuple):
    """The characters ``start`` to ``stop`` (exclusive) of a row."""

    row: int
    start: int
    stop: int


class StyledRun(NamedTuple):
    """Characters with one foreground and one background role."""

    text: str
    fg: int
    bg: int
    column: int
    """Column of its first character."""


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """Rows of characters, each with a foreground and a background role, 0 for none."""

    glyphs: NDArray[np.uint32]
    """(rows, columns) Unicode code points, all one character wide."""
    fg: Uint8Array
    bg: Uint8Array

    @classmethod
    def empty(cls, columns: int, rows: int) -> Frame:
        shape = (rows, columns)
        return cls(
            np.full(shape, BLANK, dtype=np.uint32), np.zeros(shape, np.uint8), np.zeros(shape, np.uint8)
        )

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        rows, columns = self.glyphs.shape
        return rows, columns

    def text(self, row: int, start: int = 0, stop: int | None = None) -> str:
        return str(self.glyphs[row, start:stop].astype("<u4").tobytes(), "utf-32-le")

    def rows(self) -> list[str]:
        """The characters alone, row by row, without the blanks at the ends."""
        return [self.text(row).rstrip() for row in range(self.shape[0])]

    def runs(self, row: int, start: int = 0, stop: int | None = None) -> Iterator[StyledRun]:
        """Yields the row's characters from ``start`` to ``stop``, cut where foreground or background changes. A blank takes
        the foreground before it, whichever that is, since none is seen of it: fewer cuts, fewer bytes."""
        foregrounds, backgrounds = self.fg[row, start:stop].tolist(), self.bg[row, start:stop].tolist()
        if not foregrounds:
            return
        text = self.text(row, start, stop)
        cut, fg, bg = 0, foregrounds[0], backgrounds[0]
        for place, glyph in enumerate(text):
            next_fg = fg if glyph == " " else foregrounds[place]
            if (next_fg, backgrounds[place]) != (fg, bg):
                yield StyledRun(text[cut:place], fg, bg, start + cut)
                cut, fg, bg = place, next_fg, backgrounds[place]
        yield StyledRun(text[cut:], fg, bg, start + cut)


def changed_spans(before: Frame | None, after: Frame, gap: int = MERGE_GAP) -> list[CellSpan]:
    """Returns the spans in which ``after`` differs, merged where ``gap`` or fewer characters lie between.

    Without a frame before, or after one of another size, everything differs.
    """
    rows, columns = after.shape
    if before is None or before.shape != after.shape:
        return [CellSpan(row, 0, columns) for row in range(rows)] if columns else []
    changed = before.glyphs != after.glyphs
    changed |= before.fg != after.fg
    changed |= before.bg != after.bg
    spans = []
    for row in np.flatnonzero(changed.any(axis=1)).tolist():
        where = np.flatnonzero(changed[row])
        cuts = np.flatnonzero(np.diff(where) > gap + 1)
        starts = where[np.concatenate(([0], cuts + 1))]
        stops = where[np.concatenate((cuts, [-1]))] + 1
        spans += [
            CellSpan(row, start, stop) for start, stop in zip(starts.tolist(), stops.tolist(), strict=True)
        ]
    return spans


@dataclass(frozen=True, slots=True)
class GlyphSet:
    """Single characters that stand for a thing as a whole. Strings of directions start at the right and
    go round counter-clockwise in equal turns."""

    robot_arrows: tuple[str, ...]
    """Arrows of the first robot, the second, ..., then from the first again."""
    field_arrows: str
    """Arrows of a field."""
    strong_field_arrows: str
    """Arrows where it is strong."""
    weak_field_dot: str
    """A place where the field is next to nothing."""
    target: str
    contact: str
    heading_strokes: str = ""
    """Strokes that show a robot's heading where a line of dots would be too coarse to."""
    axes: tuple[str, str, str, str] = ("│", "┤", "└", "─")
    """Characters of a chart's axes: the upright axis, a tick on it, the corner, the level axis."""


UNICODE_GLYPHS = GlyphSet(
    robot_arrows=("►◥▲◤◄◣▼◢", "▷◹△◸◁◺▽◿"),
    field_arrows="→↗↑↖←↙↓↘",
    strong_field_arrows="⇒⇗⇑⇖⇐⇙⇓⇘",
    weak_field_dot="·",
    target="◎",
    contact="×",
)
ASCII_GLYPHS = GlyphSet(
    robot_arrows=(">^<v",),
    field_arrows=">^<v",
    strong_field_arrows="}A{V",
    weak_field_dot="'",
    target="*",
    contact="X",
    heading_strokes="-/|\\-/|\\",
    axes=("|", "+", "+", "-"),
)


class Encoder(Protocol):
    """Turns a grid of roles, ``across`` x ``down`` dots in a character, into a frame."""

    @property
    def across(self) -> int: ...
    @property
    def down(self) -> int: ...
    @property
    def symbols(self) -> GlyphSet: ...

    def encode(self, grid: Grid, *, coarse: bool = False) -> Frame:
        """``grid``: (rows * down, columns * across) uint8 roles. ``coarse``: a dot is so wide in the world that walls must
        not be drawn thicker than the dots are."""
        ...


class BrailleEncoder:
    """2 x 4 dots in a character, one foreground role for all of them: the highest. What is thinner than a
    wall gives way to what is not, so that it does not blur it.

    Walls are quarter blocks, crisp and closed, in the laser's role where a ray ends on them. Without colours
    (``mono``) a lidar hit is a bullet, which no wall looks like. With ``layers`` a wall is the background of what
    stands in front of it.
    """

    across, down, symbols = 2, 4, UNICODE_GLYPHS

    def __init__(self, mono: bool = False, layers: bool = False) -> None:
        self._mono = mono
        self._layers = layers

    # Unicode numbers the dots of a braille pattern down the left column, then down the right one, and
    # later added the lowest row.
    _bits = np.array(((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80)), dtype=np.uint8)[
        ..., None, None
    ]
    _quarter_bits = np.array(((1, 2), (4, 8)), dtype=np.uint8)[..., None, None]
    _bullet = ord("•")
    _wall_behind = 2
    """Dots of a wall in a character from which on the wall is its background."""
    _body, _edge = 6, 3
    """Dots of a robot in a character from which on it is drawn in quarter blocks: anywhere, and beside such a one."""
    _blocks = np.array([ord(glyph) for glyph in " ▘▝▀▖▌▞▛▗▚▐▜▄▙▟█"], dtype=np.uint32)
    """By their quarters: 1 upper left, 2 upper right, 4 lower left, 8 lower right."""

    def encode(self, grid: Grid, *, coarse: bool = False) -> Frame:
        # The eight dots of all characters, (4, 2, rows, columns), each of them in one piece of memory.
        rows, columns = grid.shape
        dots = np.ascontiguousarray(grid.reshape(rows // 4, 4, columns // 2, 2).transpose(1, 3, 0, 2))
        fg = dots.max(axis=(0, 1))
        bg = np.zeros_like(fg)
        walls = (dots == Role.WALL) | (dots == Role.WALL_HIT)
        least = np.clip(fg, 1, Role.WALL)
        if self._layers and not coarse:
            in_front = (fg > Role.TARGET) & (walls.sum(axis=(0, 1), dtype=np.uint8) >= self._wall_behind)
            least[in_front] = Role.BODY
            bg[in_front] = Role.WALL
        patterns = np.bitwise_or.reduce((dots >= least) * self._bits, axis=(0, 1))
        glyphs = np.where(patterns > 0, patterns + np.uint32(0x2800), np.uint32(BLANK))
        quarters = np.bitwise_or.reduce((walls[0::2] | walls[1::2]) * self._quarter_bits, axis=(0, 1))
        solid = (quarters > 0) & (fg <= Role.TARGET) & (fg != Role.BODY)
        if coarse:  # quarter blocks would close narrow ways
            solid[:] = False
        glyphs[solid] = self._blocks[quarters[solid]]
        fg[solid & (fg == Role.TARGET)] = Role.WALL
        if self._layers:
            self._fill_robots(glyphs, fg, dots)
        if self._mono:
            glyphs[(fg == Role.HIT) | (fg == Role.WALL_HIT)] = self._bullet
        return Frame(glyphs, fg, bg)

    def _fill_robots(self, glyphs: Grid, fg: Grid, dots: Grid) -> None:
        """Makes robots' bodies solid: characters that are full of them, and their edges beside those. A line of dots, as that of
        a heading, stays one."""
        rows, columns = np.nonzero((fg == Role.ROBOT) | (fg == Role.ROBOT_2))
        if not len(rows):
            return
        own = dots[:, :, rows, columns] == fg[rows, columns]
        counts = own.sum(axis=(0, 1))
        # With a margin around them: of a large picture they are a small part.
        down, across = rows - rows.min() + 1, columns - columns.min() + 1
        full = np.zeros((down.max() + 2, across.max() + 2), dtype=bool)
        full[down, across] = counts >= self._body
        beside = (
            full[down - 1, across] | full[down + 1, across] | full[down, across - 1] | full[down, across + 1]
        )
        is_solid = full[down, across] | (beside & (counts >= self._edge))
        quarters = np.bitwise_or.reduce((own[0::2] | own[1::2]) * self._quarter_bits[..., 0], axis=(0, 1))
        glyphs[rows[is_solid], columns[is_solid]] = self._blocks[quarters[is_solid]]


class HalfBlockEncoder:
    """1 x 2 dots in a character, each with a colour of its own; what is thin is a dot or a shade.

    Without colours (``mono``) two different things in one character are one full block.
    """

    across, down, symbols = 1, 2, UNICODE_GLYPHS

    _upper, _lower, _full = ord("▀"), ord("▄"), ord("█")
    _thin = np.zeros(max(Role) + 1, dtype=np.uint32)
    """The glyph of each role that is thin; 0 for others."""
    _thin[[role for role in Role if role is Role.BEAM or Role.PATH <= role < Role.WALL]] = ord("·")
    _thin[Role.HIT] = ord("▒")

    def __init__(self, mono: bool = False) -> None:
        self._mono = mono

    def encode(self, grid: Grid, *, coarse: bool = False) -> Frame:
        upper, lower = grid[0::2], grid[1::2]
        both = (upper > 0) & (lower > 0)
        glyphs = np.full(upper.shape, BLANK, dtype=np.uint32)
        glyphs[upper > 0] = self._upper
        glyphs[(lower > 0) & (upper == 0)] = self._lower
        top = np.maximum(upper, lower)
        if self._mono:
            glyphs[both] = self._full
            fg, bg = top.copy(), np.zeros_like(top)
        else:
            glyphs[both & (upper == lower)] = self._full
            fg = np.where(upper > 0, upper, lower)
            bg = np.where(both & (upper != lower), lower, 0).astype(np.uint8)
        thin = self._thin[top]
        is_thin = thin > 0
        bg[is_thin] = Role.EMPTY
        return Frame(np.where(is_thin, thin, glyphs), np.where(is_thin, top, fg), bg)


class AsciiEncoder:
    """One dot in a character: the character says what it is, with colours or without."""

    across, down, symbols = 1, 1, ASCII_GLYPHS

    shapes: Mapping[Role, str] = MappingProxyType(
        {role: look.shape for role, look in ROLE_LOOKS.items() if role not in SHADES}
    )

    def __init__(self, mono: bool = False) -> None:
        self._glyphs = np.full(len(Role), BLANK, dtype=np.uint32)
        for role, shape in self.shapes.items():
            self._glyphs[role] = ord(shape)

    def encode(self, grid: Grid, *, coarse: bool = False) -> Frame:
        return Frame(self._glyphs[grid], grid.copy(), np.zeros_like(grid))


ENCODERS: Mapping[str, Callable[[bool], Encoder]] = MappingProxyType(
    {"braille": BrailleEncoder, "block": HalfBlockEncoder, "ascii": AsciiEncoder}
)
"""Encoders by the user's name for them (``--glyphs``); called with whether there are no colours."""
