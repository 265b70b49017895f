"""The 256 colours of xterm, and the nearest of them to a colour."""

from __future__ import annotations

Rgb = tuple[int, int, int]
"""Red, green and blue, 0 to 255."""

_XTERM_LEVELS = (0, 95, 135, 175, 215, 255)
_GREYISH = 40
"""A colour whose parts differ by less is reduced to a grey: the cube has none near it but with a hue of their own."""


def nearest_xterm_color(rgb: Rgb) -> int:
    """The number, 16 to 255, of the nearest colour in xterm's cube and its row of greys."""
    greys: dict[int, Rgb] = {number: xterm_rgb(number) for number in (16, *range(232, 256), 231)}
    if max(rgb) - min(rgb) < _GREYISH:
        candidates = greys
    else:
        steps = [min(range(6), key=lambda step: abs(_XTERM_LEVELS[step] - part)) for part in rgb]
        number = 16 + 36 * steps[0] + 6 * steps[1] + steps[2]
        candidates = {number: xterm_rgb(number), **greys}

    def distance(number: int) -> int:
        return sum((a - b) ** 2 for a, b in zip(candidates[number], rgb, strict=True))

    return min(candidates, key=distance)


def xterm_rgb(number: int) -> Rgb:
    """The colour 16 to 255 of xterm's 256."""
    if number >= 232:
        level = 8 + 10 * (number - 232)
        return level, level, level
    red, rest = divmod(number - 16, 36)
    green, blue = divmod(rest, 6)
    return _XTERM_LEVELS[red], _XTERM_LEVELS[green], _XTERM_LEVELS[blue]
