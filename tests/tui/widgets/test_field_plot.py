"""Which field of a message can be plotted, and the curve of one over the last messages."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kit.ros.graph.topic_statistics import FieldSample
from kit.tui.widgets.field_plot import LARGEST, field_curve, first_field, item_count, plot_note, why_not
from tests.tui.lesson_stage import row_text

VALUES = {"header.stamp.sec": 3, "x": 0.5, "ranges": [1.0, 2.0], "intensities": list[float]()}


def samples(*numbers: float) -> list[FieldSample]:
    return [FieldSample(count * 500_000_000, {"x": number}) for count, number in enumerate(numbers)]


def test_the_newest_message_is_at_zero_seconds() -> None:
    curve = field_curve("x", samples(1.0, 2.0, 4.0))
    np.testing.assert_allclose(curve.x, [-1.0, -0.5, 0.0])
    np.testing.assert_allclose(curve.y, [1.0, 2.0, 4.0])
    assert curve.name == "x"


@pytest.mark.parametrize("number", [math.nan, math.inf, -math.inf, LARGEST])
def test_what_no_scale_can_hold_is_a_gap(number: float) -> None:
    curve = field_curve("x", samples(1.0, number, 4.0))
    assert curve.has_gaps
    np.testing.assert_array_equal(np.isnan(curve.y), [False, True, False])
    assert "1 of them not finite" in row_text(plot_note(curve))
    held = math.nextafter(LARGEST, 0.0)
    np.testing.assert_array_equal(field_curve("x", samples(held, -held)).y, [held, -held])


def test_messages_without_the_field_are_left_out() -> None:
    mixed = [FieldSample(0, {}), *samples(1.0, 2.0)]
    np.testing.assert_allclose(field_curve("x", mixed).y, [1.0, 2.0])
    assert len(field_curve("y", mixed).y) == 0


def test_what_can_be_plotted() -> None:
    assert [why_not(VALUES, field) == "" for field in ("x", "ranges", "intensities", "name")] == [
        True,
        True,
        False,
        False,
    ]
    assert [item_count(VALUES, field) for field in ("x", "ranges", "intensities", "name")] == [0, 2, 0, 0]


def test_the_first_choice_is_a_number_of_the_message_itself() -> None:
    assert first_field(["header.stamp.sec", "name", "x"], VALUES) == "x"
    assert first_field(["header.stamp.sec", "name"], VALUES) == "header.stamp.sec"
    assert first_field(["name"], {}) == "name"
    assert first_field([], {}) == ""
