"""A widget that shows a frame of characters and repaints only what differs from the frame before."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.color import Color as RichColor
from rich.segment import Segment
from rich.style import Style
from textual.filter import LineFilter
from textual.geometry import Region
from textual.strip import Strip
from textual.widget import Widget

from kit.render.palettes import ANSI_PALETTE, Palette
from kit.render.role_looks import Color, RoleStyle
from kit.render.roles import Role
from kit.tui.textual_patches import PlacedRun, crop_left, write_runs

if TYPE_CHECKING:  # numpy is imported by whoever makes a frame
    from kit.render.encode import CellSpan, Frame


class FrameView(Widget):
    """Shows ``Frame``s in the colours of a palette. Does nothing while none is given."""

    can_focus = False

    def __init__(
        self,
        palette: Palette = ANSI_PALETTE,
        *,
        id: str | None = None,  # noqa: A002 - Textual's own name
        classes: str | None = None,
    ) -> None:
        super().__init__(id=id, classes=classes)
        self._palette = palette
        self._is_dim = False
        self._frame: Frame | None = None
        self._strips: dict[int, Strip] = {}
        self._styles: dict[tuple[int, int], Style | None] = {}

    def on_mount(self) -> None:
        crop_left(self.screen)

    @property
    def is_dim(self) -> bool:
        """Whether all of it is drawn dim: what it shows is not open yet."""
        return self._is_dim

    @is_dim.setter
    def is_dim(self, is_dim: bool) -> None:
        if is_dim != self._is_dim:
            self._is_dim = is_dim
            self._strips.clear()
            self._styles.clear()
            self.refresh()

    @property
    def frame(self) -> Frame | None:
        """The frame that is shown."""
        return self._frame

    def show_frame(self, frame: Frame) -> bool:
        """Shows a frame from now on; says whether anything looks different."""
        from kit.render.encode import changed_spans

        spans = changed_spans(self._frame, frame)
        is_resized = self._frame is None or self._frame.shape != frame.shape
        if is_resized:
            self._strips.clear()
        self._frame = frame
        for span in spans:
            self._strips.pop(span.row, None)
        if spans and (is_resized or not self._write(spans)):
            self.refresh(*(Region(start, row, stop - start, 1) for row, start, stop in spans))
        return bool(spans)

    def _write(self, spans: Sequence[CellSpan]) -> bool:
        """Sends the spans of the frame to the terminal without Textual's compositor, where that is possible."""
        frame = self._frame
        if frame is None or frame.shape != (self.size.height, self.size.width) or self._has_surroundings:
            return False
        return write_runs(
            self,
            (
                PlacedRun(span.row, column, text, self._style(fg, bg))
                for span in spans
                for text, fg, bg, column in frame.runs(*span)
            ),
        )

    @property
    def _has_surroundings(self) -> bool:
        """Whether there are borders or blanks around the frame."""
        return self.gutter.totals != (0, 0)

    def show_nothing(self) -> None:
        """No frame any more."""
        if self._frame is not None:
            self._frame = None
            self._strips.clear()
            self.refresh()

    def get_line_filters(self) -> Sequence[LineFilter]:
        """None: the palette is already what the terminal takes."""
        return ()

    def notify_style_update(self) -> None:
        """The theme may have changed."""
        super().notify_style_update()
        self._strips.clear()
        self._styles.clear()

    def render_lines(self, crop: Region) -> list[Strip]:
        """The rows themselves where nothing is around them: Textual's way to borders and tints takes as long as to paint."""
        if self._has_surroundings:
            return super().render_lines(crop)
        rows = [self.render_line(y) for y in crop.line_range]
        left, right = crop.column_span
        return rows if (left, right) == (0, self.size.width) else [row.crop(left, right) for row in rows]

    def render_line(self, y: int) -> Strip:
        strip = self._strips.get(y)
        if strip is None:
            strip = self._strips[y] = self._strip(y)
        return strip

    def _strip(self, y: int) -> Strip:
        width = self.size.width
        if self._frame is None or y >= self._frame.shape[0]:
            return Strip([Segment(" " * width, self._style(0, 0))], width)
        segments = [Segment(run.text, self._style(run.fg, run.bg)) for run in self._frame.runs(y)]
        return Strip(segments, self._frame.shape[1]).adjust_cell_length(width, self._style(0, 0))

    def _style(self, foreground: int, background: int) -> Style | None:
        roles = foreground, background
        if roles not in self._styles:
            self._styles[roles] = self._made_style(
                self._palette[Role(foreground)], self._palette[Role(background)]
            )
        return self._styles[roles]

    def _made_style(self, foreground: RoleStyle, background: RoleStyle) -> Style | None:
        """None, which costs no bytes, for the terminal's own colours."""
        style = Style(
            color=_rich(foreground.color),
            bgcolor=_rich(background.color),
            bold=foreground.bold or None,
            dim=self._is_dim or foreground.dim or None,
        )
        if not self.app.native_ansi_color:
            style = self.rich_style + style
        return style or None


def _rich(color: Color) -> RichColor | None:
    if isinstance(color, tuple):
        return RichColor.from_rgb(*color)
    return (
        None
        if color is None
        else RichColor.parse(str(color) if isinstance(color, str) else f"color({color})")
    )
