"""The instruments of a large screen, as rows of text."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from kit.controllers import find_controller
from kit.document.rows import Row, row
from kit.ros.log import LoggingSeverity, LogRecord
from kit.run.scenario import find_scenario
from kit.run.session import Session
from kit.run.view import LASER_DIRECTIONS, View, ViewBuilder
from kit.tui.rows.chart_rows import CHART_ROWS, laser_chart, stretched_chart, time_chart
from kit.tui.rows.instrument_rows import (
    CARD_WIDTH,
    CODE_WIDTH,
    COLUMN_GAP,
    ENOUGH,
    MARGIN,
    Listing,
    PanelWidths,
    SpeedHistory,
    figure_rows,
    instruments,
    panel_widths,
    tells_messages,
    with_charts,
)
from kit.tui.rows.readout_rows import failure_or_messages, readout
from tests.cases import every_case
from tests.tui.lesson_stage import row_text


@pytest.fixture(scope="module")
def views() -> list[View]:
    """Ten seconds of a random walk in the maze."""
    views = []
    with Session(find_scenario("maze"), always_scan=True) as session:
        session.drive_with(find_controller("random_walk"))
        builder = ViewBuilder(session)
        for tick in range(1000):
            session.runner.tick()
            if tick % 10 == 9:
                views.append(builder.build())
    return views


def texts(rows: list[Row] | tuple[Row, ...]) -> list[str]:
    return [row_text(parts) for parts in rows]


def figures(view: View, width: int) -> list[Row]:
    return figure_rows("robot", readout(view, "hold"), width)


def test_the_panel_keeps_to_its_size_and_leaves_out_the_least_important(views: list[View]) -> None:
    history = SpeedHistory()
    for view in views:
        history.add(view)
    program = [row(f"line {number}") for number in range(100)]
    for size in ((44, 30), (44, 12), (58, 46), (58, 60)):
        rows = texts(
            instruments(
                views[-1],
                history,
                figures(views[-1], size[0]),
                Listing(program),
                (),
                PanelWidths(size[0]),
                size[1],
            )
        )
        assert len(rows) <= size[1]
        assert max(map(len, rows)) <= size[0]
        assert "robot" in rows[0]
        assert any("line 5" in line for line in rows) is (size[1] > 40)


def test_a_panel_with_room_tells_the_newest_messages(views: list[View]) -> None:
    view = replace(views[-1], messages=[LogRecord(0, LoggingSeverity.WARN, "fields", "A wall", "", "", 0)])
    for height, is_told in ((46, True), (10, False)):
        panel = instruments(view, SpeedHistory(), figures(view, 58), Listing(), (), PanelWidths(58), height)
        assert tells_messages(panel) is is_told
        assert any("A wall" in line for line in texts(panel)) is is_told


def test_a_chart_without_room_is_left_out_whole(views: list[View]) -> None:
    history = SpeedHistory()
    for view in views:
        history.add(view)
    for height in range(8, 46):
        rows = texts(
            instruments(views[-1], history, figures(views[-1], 58), Listing(), (), PanelWidths(58), height)
        )
        titles = [number for number, line in enumerate(rows) if line.startswith("── ")]
        for first, last in pairwise([*titles[1:], len(rows)]):
            assert last - first == 1 + CHART_ROWS, (height, rows[first])


@pytest.mark.parametrize(
    ("columns", "rows", "shape", "width"),
    [
        (80, 24, 1.0, 0),
        (120, 35, 1.0, 50),  # 70 columns of 35 rows are as wide as they are high
        (120, 35, 0.5, 60),
        (120, 35, 1.5, 0),  # the picture needs them
        (120, 36, 1.5, 46),
        (200, 50, 1.5, 60),
        (200, 50, 0.4, 60),
        (200, 24, 1.0, 0),
    ],
)
def test_instruments_get_the_columns_that_the_picture_leaves(
    columns: int, rows: int, shape: float, width: int
) -> None:
    assert panel_widths(columns, rows, shape).total == (width - MARGIN if width else 0)


@pytest.mark.parametrize(
    ("size", "shape", "wanted"),
    [((200, 50), 0.4, CARD_WIDTH), ((200, 50), 0.8, CARD_WIDTH), ((200, 50), 0.4, CODE_WIDTH)],
)
def test_what_belongs_beside_the_instruments_stands_there_where_the_picture_is_narrow(
    views: list[View], size: tuple[int, int], shape: float, wanted: int
) -> None:
    widths = panel_widths(*size, shape, wanted)
    assert ENOUGH * wanted <= widths.beside <= wanted
    assert widths.total + MARGIN + 2 * size[1] * shape <= size[0]
    history = SpeedHistory()
    for view in views:
        history.add(view)
    program = [row(f"line {number} {'x' * 100}") for number in range(100)]
    card = [row("the card")]
    shown = instruments(
        views[-1], history, figures(views[-1], widths.instruments), Listing(program), card, widths, 46
    )
    rows = texts(shown)
    column = widths.instruments + COLUMN_GAP
    assert rows[0][column:] == "the card"
    assert all("line" not in each[:column] for each in rows)
    assert [each[column:].split()[1] for each in rows[2:]] == ["line"] * 44
    assert max(map(len, rows)) == widths.total
    assert sum(each.startswith("── ") for each in rows) == 4  # the robot and three charts


@pytest.mark.parametrize("shape", [0.9, 1.0])
def test_code_has_the_width_that_is_left_where_two_columns_have_no_room(shape: float) -> None:
    widths = panel_widths(200, 50, shape, CODE_WIDTH)
    assert widths == PanelWidths(CODE_WIDTH)
    assert panel_widths(200, 50, 1.5, CODE_WIDTH) == panel_widths(200, 50, 1.5)


def test_a_program_is_shown_from_its_first_class_on(views: list[View]) -> None:
    lines = ["import rclpy", "", "", "class Mine(Node):", "    pass", *["# more"] * 50]
    program = [row((line, "keyword")) for line in lines]
    rows = texts(
        instruments(
            views[-1], SpeedHistory(), figures(views[-1], 58), Listing(program), (), PanelWidths(58), 40
        )
    )
    assert not any("import rclpy" in line for line in rows)
    assert any(line.startswith("  4 class Mine") for line in rows)


def test_the_newest_message_is_told_to_its_end_where_there_is_room(views: list[View]) -> None:
    def said(text: str, time_s: float = 3.0) -> LogRecord:
        return LogRecord(round(time_s * 1e9), LoggingSeverity.WARN, "fields", text, "", "", 0)

    long = " ".join(f"word{number}" for number in range(14))
    alone = texts(failure_or_messages(replace(views[-1], messages=[said(long)]), 2, 80))
    assert len(alone) == 2
    assert " ".join(" ".join(alone).split()).endswith(long)
    pushed = texts(failure_or_messages(replace(views[-1], messages=[said("older", 1.5), said(long)]), 2, 80))
    assert pushed == alone
    above = texts(failure_or_messages(replace(views[-1], messages=[said(long), said("newer")]), 2, 80))
    assert len(above[0]) == 80
    assert above[1].endswith("newer")
    both = texts(failure_or_messages(replace(views[-1], messages=[said("with it"), said(long)]), 2, 80))
    assert both[0].endswith("with it")
    assert len(both[1]) == 80
    assert above[0].endswith("…")
    assert both[1].endswith("…"), "what is cut says so"
    assert all(len(line) <= 80 for line in (*alone, *above, *both))


def test_the_laser_by_direction_is_what_the_sides_say(views: list[View]) -> None:
    for view in views[::20]:
        angles = (np.arange(LASER_DIRECTIONS) + 0.5) / LASER_DIRECTIONS * math.tau - math.pi
        front = view.laser[np.abs(angles) <= math.pi / 4]
        assert np.nanmin(front) == pytest.approx(dict(view.nearest)["front"], abs=1e-6)


def test_the_laser_chart_has_the_left_on_the_left() -> None:
    laser = np.full(LASER_DIRECTIONS, np.nan)
    laser[LASER_DIRECTIONS * 3 // 4] = 2.0  # 90 degrees to the left
    (top, *_) = texts(laser_chart(laser, 46))
    assert top.startswith(" 2.0m")
    assert 6 + 40 / 4 - 2 <= top.index("█") <= 6 + 40 / 4 + 2


def test_a_minute_is_charted_and_a_restart_begins_again(views: list[View]) -> None:
    history = SpeedHistory()
    for view in views:
        history.add(view)
    assert len(history.forward_speeds) == pytest.approx(views[-1].time_s / 0.2, abs=2)
    history.add(views[0])
    assert len(history.forward_speeds) == 1


@every_case("window", [20, 50, 300])
def test_a_chart_over_time_covers_its_window(window: int) -> None:
    for first in (0, window // 2, window - 1):
        values = [9.0, *([0.0] * first), 1.0, *([0.0] * (window - first - 1))]
        (*_, lowest) = texts(time_chart(values, 46, 1.0, window, 1))
        seen = [number for number, glyph in enumerate(lowest[6:]) if glyph == "█"]
        assert seen, "a value of the window"
        assert seen[0] == pytest.approx(first * 40 / window, abs=1)


def test_the_charts_cover_all_of_a_short_drive(views: list[View]) -> None:
    history, told = SpeedHistory(), []
    for seconds in range(0, 90, 5):
        history.add(replace(views[-1], time_s=float(seconds)))
        told += [line for line in texts(with_charts(views[-1], history, (), (46, 31))) if "last" in line]
    spans = [int(line.split("last ")[1].split(" s")[0]) for line in told]
    assert spans == sorted(spans)
    assert all(
        span >= min(seconds, 60) and span <= max(20, 3 * seconds)
        for span, seconds in zip(spans, range(0, 90, 5), strict=True)
    )


@every_case("values", [[0.0], [0.1, 0.5], [-0.5, 0.5], [-1e-9] * 500, [0.3] * 500])
def test_a_chart_over_time_has_its_size(values: list[float]) -> None:
    rows = texts(time_chart(values, 46, 0.1, 300))
    assert len(rows) == CHART_ROWS
    assert {len(line) for line in rows} == {46}


def test_what_turns_right_goes_down() -> None:
    rows = texts(time_chart([-1.0] * 10, 46, 0.5, 20))
    assert "█" in rows[-1]
    assert "█" not in rows[0]


@every_case("values", [[0.0, -9.0, -12.0], [0.0, 3.0, -1.0], [0.0, 1.0, 2.0], [-1.0, -1.0], [0.0, 0.0]])
def test_a_stretched_chart_gives_each_side_the_rows_that_it_needs(values: list[float]) -> None:
    title, *rows = texts(stretched_chart("lead", "s", values, 46, 0.5, 7))
    assert "lead" in title
    assert len(rows) == 7
    assert {len(line) for line in rows} == {6 + 6 * len(values)}
    bars = sum(any(glyph in line for glyph in "▁▂▃▄▅▆▇█▀━") for line in rows)
    assert bars >= 6 or not any(values)


@every_case("theta", [-math.pi, math.pi, 3 * math.pi, math.radians(-179.6), math.radians(180.4)])
def test_a_robot_that_faces_back_has_a_heading_of_180(theta: float, views: list[View]) -> None:
    view = views[-1]
    assert view.pose is not None
    turned = replace(view, pose=view.pose._replace(theta=theta))
    line = next(line for line in texts(readout(turned, None)) if "heading" in line)
    assert line.split()[1] == "180"


def test_charts_stand_below_the_figures_of_a_narrow_panel_and_nothing_moves_with_the_first_scan(
    views: list[View],
) -> None:
    history = SpeedHistory()
    history.add(views[-1])
    silent = replace(
        views[-1],
        laser=np.full(LASER_DIRECTIONS, np.nan),
        nearest=tuple((side, None) for side, _ in views[-1].nearest),
    )
    told = [
        texts(with_charts(view, history, readout(view, "hold"), (22, 31))) for view in (silent, views[-1])
    ]
    for rows in told:
        assert len(rows) <= 31
        assert max(map(len, rows)) <= 22
    titles = [[(number, line) for number, line in enumerate(rows) if "── " in line] for rows in told]
    assert titles[0] == titles[1]
    assert len(titles[0]) == 2
    figures = readout(views[-1], "hold")
    assert with_charts(views[-1], history, figures, (22, len(figures) + CHART_ROWS)) == list(figures)
