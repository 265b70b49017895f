"""Palettes: every role has a style, and without colours nothing has a colour."""

from __future__ import annotations

import pytest

from kit.render.palettes import COLOR_SCHEMES, PALETTES, Palette
from kit.render.role_looks import LINE_DASHES, ROLE_LOOKS
from kit.render.roles import LIT_ROLES, ROBOT_ROLES, SHADES, Role
from kit.render.xterm_colors import Rgb, nearest_xterm_color
from tests.cases import every_case

EVERY_PALETTE: dict[str, Palette] = {
    **PALETTES,
    **{f"{name} 256": scheme.palette(True) for name, scheme in COLOR_SCHEMES.items()},
    **{f"{name} true": scheme.palette(False) for name, scheme in COLOR_SCHEMES.items()},
}


@every_case("name", EVERY_PALETTE)
def test_every_role_has_a_style(name: str) -> None:
    assert set(EVERY_PALETTE[name]) == set(Role)


def test_no_colour_has_none_but_tells_hits_and_robots_from_walls_by_weight() -> None:
    palette = PALETTES["none"]
    assert all(style.color is None for style in palette.values())
    assert palette[Role.HIT].bold
    assert palette[Role.ROBOT].bold
    assert not palette[Role.WALL].bold


GHOST_ROLES = [role for role in Role if role.name.startswith("GHOST_")]
MOVING = (Role.BODY, Role.TARGET, *GHOST_ROLES, *ROBOT_ROLES)
"""What is told apart at a glance while a level is driven."""


@every_case("name", [name for name in EVERY_PALETTE if name != "none"])
def test_what_matters_differs_in_colour_too(name: str) -> None:
    palette = EVERY_PALETTE[name]
    colors = [palette[role].color for role in (Role.WALL, Role.HIT, Role.TARGET, Role.CONTACT, *ROBOT_ROLES)]
    assert len(set(colors)) == len(colors)
    looks = {palette[role] for role in MOVING}
    assert len(looks) == len(MOVING)


def test_every_role_has_a_shape_of_its_own_and_every_ghost_a_line() -> None:
    drawn = [look.shape for role, look in ROLE_LOOKS.items() if role not in SHADES]
    assert len(set(drawn)) == len(drawn)
    assert {ROLE_LOOKS[role].shape for role in SHADES} == {" "}
    lines = {ROLE_LOOKS[role].line for role in GHOST_ROLES}
    assert len(lines) == len(GHOST_ROLES)
    dashes = [LINE_DASHES[line] for line in lines]
    assert len(set(dashes)) == len(dashes)


@every_case("name", [name for name, scheme in COLOR_SCHEMES.items() if scheme.dark])
def test_the_floor_that_a_laser_sees_is_the_darker_the_farther_it_is(name: str) -> None:
    for scheme in (COLOR_SCHEMES[name], COLOR_SCHEMES[name].reduced()):
        lights = [luminance(scheme.roles[role]) for role in (*LIT_ROLES, Role.FLOOR)]
        assert lights == sorted(lights, reverse=True)
        assert len(set(lights)) == 3


def test_walls_are_in_the_terminals_own_colour_and_the_floor_in_none() -> None:
    for palette in PALETTES.values():
        assert palette[Role.WALL].color is None
        assert all(palette[role].color is None for role in SHADES)


def luminance(color: Rgb) -> float:
    """Of WCAG 2.2."""
    linear = [c / 12.92 if (c := part / 255) <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for part in color]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: Rgb, other: Rgb) -> float:
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("reduced", [False, True])
@pytest.mark.parametrize("name", COLOR_SCHEMES)
def test_what_must_be_read_stands_out_from_what_lies_behind(name: str, reduced: bool) -> None:
    """WCAG asks 4.5 for text and 3 for pictures; the theme of high contrast 7 for text."""
    scheme = COLOR_SCHEMES[name].reduced() if reduced else COLOR_SCHEMES[name]
    text = 7.0 if name == "contrast" else 4.5
    for color in (scheme.foreground, scheme.accent, scheme.good, scheme.warn, scheme.bad):
        assert contrast(color, scheme.background) >= text, color
    for role in (Role.WALL, Role.HIT, Role.TARGET, Role.CONTACT, Role.BODY, *GHOST_ROLES, *ROBOT_ROLES):
        for shade in SHADES:
            assert contrast(scheme.roles[role], scheme.roles[shade]) >= 3.0, (role, shade)


@every_case(
    ("color", "number"),
    [
        ((0, 0, 0), 16),
        ((255, 255, 255), 231),
        ((95, 135, 175), 67),
        ((18, 18, 18), 233),
        ((142, 153, 172), 247),
    ],
)
def test_the_nearest_of_256_colours(color: Rgb, number: int) -> None:
    assert nearest_xterm_color(color) == number
