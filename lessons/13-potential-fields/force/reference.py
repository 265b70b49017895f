"""The forces as they should be, and the cases they are tried on."""

import math


def point_force(x, y, cx, cy, intensity):
    dx, dy = cx - x, cy - y
    r = math.hypot(dx, dy)
    return [intensity * dx / r**3, intensity * dy / r**3]


def point_force_cases(chance):
    yield {"x": 0.0, "y": 0.0, "cx": 2.0, "cy": 0.0, "intensity": 15.0}
    yield {"x": 0.0, "y": 0.0, "cx": 0.0, "cy": 2.0, "intensity": 15.0}
    yield {"x": 1.0, "y": 0.0, "cx": -1.0, "cy": 0.0, "intensity": -1.0}
    yield {"x": 1.0, "y": 1.0, "cx": 0.5, "cy": 0.0, "intensity": -1.0}
    for _ in range(30):
        angle, away = chance.uniform(-math.pi, math.pi), chance.uniform(0.1, 3.0)
        x, y = chance.uniform(-2, 2), chance.uniform(-2, 2)
        yield {
            "x": x,
            "y": y,
            "cx": x + away * math.cos(angle),
            "cy": y + away * math.sin(angle),
            "intensity": chance.choice((15.0, -1.0, 4.0)),
        }


def line_force(x, y, ax, ay, bx, by, intensity):
    length = math.hypot(bx - ax, by - ay)
    ux, uy = (bx - ax) / length, (by - ay) / length
    along = (x - ax) * ux + (y - ay) * uy
    if not 0 <= along <= length:
        return [0.0, 0.0]
    return point_force(x, y, ax + along * ux, ay + along * uy, intensity)


def line_force_cases(chance):
    wall = {"ax": 0.0, "ay": 0.0, "bx": 2.0, "by": 0.0, "intensity": -1.0}
    yield {"x": 1.0, "y": 0.5, **wall}
    yield {"x": 1.0, "y": -0.5, **wall}
    yield {"x": -0.5, "y": 0.5, **wall}
    yield {"x": 2.5, "y": 0.5, **wall}
    for number in range(30):
        ax, ay, angle, length = (
            chance.uniform(-1, 1),
            chance.uniform(-1, 1),
            chance.uniform(-math.pi, math.pi),
            chance.uniform(0.5, 2.0),
        )
        beyond = chance.choice((chance.uniform(-0.5, 0.0), chance.uniform(1.0, 1.5)))
        along = (chance.uniform(0.0, 1.0) if number % 4 else beyond) * length
        aside = chance.choice((-1, 1)) * chance.uniform(0.1, 1.0)
        cos, sin = math.cos(angle), math.sin(angle)
        yield {
            "x": ax + along * cos - aside * sin,
            "y": ay + along * sin + aside * cos,
            "ax": ax,
            "ay": ay,
            "bx": ax + length * cos,
            "by": ay + length * sin,
            "intensity": -1.0,
        }
