"""Widgets that show charts: curves over a course, and shares stacked on each other."""

from __future__ import annotations

from collections.abc import Sequence

from textual import events

from kit.render.curve import Axes, Curve, draw_curves
from kit.render.encode import UNICODE_GLYPHS, BrailleEncoder, Encoder, GlyphSet
from kit.render.palettes import ANSI_PALETTE, Palette
from kit.render.stacked_chart import ChartPart, StackedCounts, draw_stacked_chart
from kit.tui.widgets.frame_view import FrameView


class CurveView(FrameView):
    """Shows curves; give it new data no more often than people look, twice a second at most."""

    DEFAULT_CSS = "CurveView { width: 1fr; height: 10; }"

    def __init__(
        self,
        axes: Axes | None = None,
        encoder: Encoder | None = None,
        palette: Palette = ANSI_PALETTE,
        *,
        id: str | None = None,  # noqa: A002 - Textual's own name
        classes: str | None = None,
    ) -> None:
        super().__init__(palette, id=id, classes=classes)
        self._axes = axes or Axes()
        self._encoder = encoder or BrailleEncoder()
        self._curves: Sequence[Curve] = ()

    def show(self, curves: Sequence[Curve], axes: Axes | None = None) -> bool:
        """Draws these curves from now on, on other axes if given; says whether anything looks different."""
        self._curves = curves
        self._axes = axes or self._axes
        return self._redraw()

    def on_resize(self, event: events.Resize) -> None:
        self._redraw()

    def _redraw(self) -> bool:
        columns, rows = self.size
        if not columns or not rows:
            return False
        return self.show_frame(draw_curves(self._curves, self._axes, columns, rows, self._encoder))


class StackedChartView(FrameView):
    """Shows shares; give it new data no more often than people look, twice a second at most."""

    DEFAULT_CSS = "StackedChartView { width: 1fr; height: 10; }"

    def __init__(
        self,
        parts: Sequence[ChartPart],
        palette: Palette = ANSI_PALETTE,
        symbols: GlyphSet = UNICODE_GLYPHS,
        *,
        margin: int = 0,
        id: str | None = None,  # noqa: A002 - Textual's own name
    ) -> None:
        super().__init__(palette, id=id)
        self._symbols = symbols
        self._parts = parts
        self._margin = margin
        self._shares: StackedCounts | None = None

    def show(self, shares: StackedCounts) -> bool:
        """Draws these shares from now on; says whether anything looks different."""
        self._shares = shares
        return self._redraw()

    def on_resize(self, event: events.Resize) -> None:
        self._redraw()

    def _redraw(self) -> bool:
        columns, rows = self.size
        if not columns or not rows or self._shares is None:
            return False
        return self.show_frame(
            draw_stacked_chart(self._shares, self._parts, columns, rows, self._margin, self._symbols)
        )
