"""The curve as a widget: shows its frame, and sends little when a point is added."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from textual.app import App
from textual.pilot import Pilot

from kit.render.curve import Axes, Curve
from kit.render.encode import AsciiEncoder
from kit.tui.widgets.chart_views import LearningCurveView
from tests.tui.tape import Display, TapeDriver, painted, run_in


class CurveApp(App[None]):
    def __init__(self) -> None:
        super().__init__(driver_class=TapeDriver)
        self.theme = "ansi-dark"
        self.view = LearningCurveView(Axes("steps", low=0, high=1, goal=0.8))

    def compose(self) -> Any:
        yield self.view

    def take(self) -> str:
        assert isinstance(self._driver, TapeDriver)
        return self._driver.take()


def learning(count: int) -> list[Curve]:
    x = 1000.0 * np.arange(1, count + 1)
    return [Curve("accuracy", x, 1 - np.exp(-x / 20_000))]


@pytest.mark.long
def test_a_growing_curve_is_shown_and_costs_few_bytes() -> None:
    app = CurveApp()
    sizes = []

    async def script(pilot: Pilot[None]) -> None:
        await painted(app)
        display = Display(60, 10)
        for count in range(1, 50):
            app.view.show(learning(count))
            await painted(app)
            text = app.take()
            sizes.append(len(text.encode()))
            display.feed(text)
            assert app.view.frame is not None
            assert display.rows == app.view.frame.rows()
        assert not app.view.show(learning(49))
        await painted(app)
        assert app.take() == ""

    run_in(app, script, (60, 10))
    assert np.median(sizes[1:]) < 200


def test_no_data_and_little_room_are_no_trouble() -> None:
    app = CurveApp()

    async def script(pilot: Pilot[None]) -> None:
        app.view.show([])
        for size in ((60, 10), (3, 2), (1, 1), (30, 5)):
            await pilot.resize_terminal(*size)
            await painted(app)
            assert app.view.frame is not None
            assert app.view.frame.shape == (app.view.size.height, app.view.size.width)

    run_in(app, script, (60, 10))


def test_glyphs_can_be_chosen() -> None:
    app = CurveApp()
    app.view = LearningCurveView(encoder=AsciiEncoder())

    async def script(pilot: Pilot[None]) -> None:
        app.view.show(learning(20))
        assert app.view.frame is not None
        assert all(row.isascii() for row in app.view.frame.rows())

    run_in(app, script, (60, 10))
