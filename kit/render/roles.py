"""Roles of dots and characters: a meaning, not a colour. ``role_looks`` gives each a shape, a palette a style."""

from __future__ import annotations

from enum import IntEnum


class Role(IntEnum):
    """Roles in order of importance: where several meet, the highest is drawn."""

    EMPTY = 0
    FLOOR = 1
    """Where a robot can be: behind what stands there."""
    LIT_FAR = 2
    """Floor that a laser sees, away from it and near it."""
    LIT_NEAR = 3
    BEAM = 4
    FIELD = 5
    PATH = 6
    GHOST_OTHER = 7
    """A former drive: a classmate's, then the agent's, the program's, the one by hand, the reference's."""
    GHOST_AGENT = 8
    GHOST_PROGRAM = 9
    GHOST_KEYS = 10
    GHOST_REFERENCE = 11
    TRAIL = 12
    TRAIL_2 = 13
    PEN_WHITE = 14
    PEN_RED = 15
    PEN_YELLOW = 16
    PEN_GREEN = 17
    PEN_CYAN = 18
    PEN_BLUE = 19
    PEN_MAGENTA = 20
    WALL = 21
    WALL_HIT = 22
    """A wall where a laser's ray ends on it."""
    BODY = 23
    """What stands or moves in the world and is no robot: a cart, a table."""
    CURVE_4 = 24
    CURVE_3 = 25
    CURVE_2 = 26
    CURVE_1 = 27
    HIT = 28
    TARGET = 29
    ROBOT_2 = 30
    ROBOT = 31
    CONTACT = 32
    TEXT = 33


ROBOT_ROLES = (Role.ROBOT, Role.ROBOT_2)
"""The first robot's role, the second's, the third's as the first's again; their glyphs tell them apart too."""

LIT_ROLES = (Role.LIT_NEAR, Role.LIT_FAR)
"""Floor that a laser sees, from the laser outwards."""

SHADES = (Role.FLOOR, *LIT_ROLES)
"""Roles that are only ever seen behind others."""

TRAIL_ROLES = (Role.TRAIL, Role.TRAIL_2)

CURVE_ROLES = (Role.CURVE_1, Role.CURVE_2, Role.CURVE_3, Role.CURVE_4)
"""The first curve's of a plot, the second's, ..., the fifth's as the first's again; numbers and dashes tell them apart
too."""
