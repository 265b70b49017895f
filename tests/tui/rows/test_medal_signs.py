"""The looks of medals."""

from __future__ import annotations

from rich.color import ColorSystem

from kit.school.game.medal import Medal
from kit.tui.rows.medal_signs import MEDAL_SIGNS, MEDAL_STYLES
from kit.tui.widgets.text_rows import STYLES


def test_medals_differ_by_their_letter_and_by_their_look_in_16_colours_too() -> None:
    medals = [
        medal for medal in Medal if medal not in (Medal.NONE, Medal.RECORD)
    ]  # which looks like a master's
    assert len({MEDAL_SIGNS[medal] for medal in medals}) == len(medals)
    for system in (ColorSystem.TRUECOLOR, ColorSystem.EIGHT_BIT, ColorSystem.STANDARD):
        styles = [STYLES[MEDAL_STYLES[medal]] for medal in medals]
        looks = {(each.color and each.color.downgrade(system).get_ansi_codes(), each.bold) for each in styles}
        assert len(looks) == len(medals)
    bronze = STYLES[MEDAL_STYLES[Medal.BRONZE]].color
    assert bronze is not None
    assert bronze.downgrade(ColorSystem.STANDARD).number == 3, "brown"
