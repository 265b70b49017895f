"""What is told of a rate is what it was judged by."""

import pytest

from grader.driving.message_rate import MessageRate


@pytest.mark.parametrize(
    ("per_second", "is_uneven"),
    [
        (dict.fromkeys(range(10), 10), False),
        ({0: 100}, True),
        (dict.fromkeys(range(0, 10, 2), 20), True),
        (dict.fromkeys(range(10), 99), False),
        ({}, False),
    ],
)
def test_only_what_was_judged_by_its_evenness_is_told_of_it(
    per_second: dict[int, int], is_uneven: bool
) -> None:
    rate = MessageRate(per_second, 10.0, 10.0)
    told = rate.describe(f"{sum(per_second.values())} messages came on /cmd_vel")
    assert f"{sum(per_second.values())} messages came on /cmd_vel in 10 s; 100 are asked for." in told
    assert ("do not come evenly" in told) == is_uneven
    assert f"{rate.error:.0%}" in told or not is_uneven


def test_a_slow_rate_is_looked_at_in_spans_that_should_hold_some() -> None:
    rate = MessageRate(dict.fromkeys((0, 1, 2), 5), 0.5, 30.0)
    assert rate.mean_error == 0.0
    assert rate.uneven_share == 1.0
    assert "counted every 8 seconds" in rate.describe("15 lines")
