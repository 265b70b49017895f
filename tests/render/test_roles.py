"""Palettes: every role has an ink, and without colours nothing has a colour."""

from __future__ import annotations

import pytest

from kit.render.roles import PALETTES, ROBOT_ROLES, Role


@pytest.mark.parametrize("name", PALETTES)
def test_every_role_has_an_ink(name: str) -> None:
    assert set(PALETTES[name]) == set(Role)


def test_no_colour_has_none_but_tells_hits_and_robots_from_walls_by_weight() -> None:
    palette = PALETTES["none"]
    assert all(ink.color is None for ink in palette.values())
    assert palette[Role.HIT].bold
    assert palette[Role.ROBOT].bold
    assert not palette[Role.WALL].bold


@pytest.mark.parametrize("name", ["16", "256", "truecolor"])
def test_what_matters_differs_in_colour_too(name: str) -> None:
    inks = [
        PALETTES[name][role].color for role in (Role.WALL, Role.HIT, Role.TARGET, Role.CONTACT, *ROBOT_ROLES)
    ]
    assert len(set(inks)) == len(inks)


def test_walls_are_in_the_terminals_own_ink() -> None:
    assert all(palette[Role.WALL].color is None for palette in PALETTES.values())
