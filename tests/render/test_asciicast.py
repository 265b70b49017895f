"""Asciicasts: a terminal that plays the file shows the same characters in the same colours as the frames."""

from __future__ import annotations

import json

import numpy as np
import pyte
import pytest

from kit.render.asciicast import asciicast_lines
from kit.render.encode import Frame
from kit.render.roles import PALETTES, Palette, Role


def random_frames(count: int, columns: int, rows: int) -> list[Frame]:
    """Each differs from the one before in some characters."""
    rng = np.random.default_rng(1)
    frames = [Frame.empty(columns, rows)]
    letters = np.array([ord(letter) for letter in " ⣿⡇#►"], dtype=np.uint32)
    while len(frames) < count:
        before = frames[-1]
        changed = rng.random((rows, columns)) < 0.1
        glyphs = np.where(changed, rng.choice(letters, (rows, columns)), before.glyphs)
        fg = np.where(changed, rng.integers(0, len(Role), (rows, columns)), before.fg)
        frames.append(Frame(glyphs.astype(np.uint32), fg.astype(np.uint8), before.bg))
    return frames


@pytest.mark.parametrize("palette", PALETTES.values(), ids=PALETTES)
def test_a_terminal_that_plays_it_shows_every_frame(palette: Palette) -> None:
    frames = random_frames(6, 40, 12)
    header, *events = map(
        json.loads, asciicast_lines([(i / 10, each) for i, each in enumerate(frames)], palette)
    )
    assert (header["version"], header["width"], header["height"]) == (2, 40, 12)
    screen = pyte.Screen(40, 12)
    stream = pyte.Stream(screen)
    for number, (time_s, kind, text) in enumerate(events[:-1]):
        stream.feed(text)
        assert (time_s, kind) == (number / 10, "o")
        assert screen.display == [frames[number].text(row) for row in range(12)]
    last = frames[-1]
    for row, column in zip(*np.nonzero(last.glyphs != ord(" ")), strict=True):
        shown, style = screen.buffer[row][column], palette[Role(last.fg[row, column])]
        assert (shown.fg == "default") == (style.color is None)
        assert shown.bold == style.bold


def test_a_frame_that_changes_nothing_is_not_written() -> None:
    frame = Frame.empty(10, 3)
    lines = list(asciicast_lines([(0.0, frame), (0.5, frame), (1.0, frame)], PALETTES["16"]))
    assert len(lines) == 3  # header, first frame, end
    assert json.loads(lines[-1])[0] == 1.0


def test_no_frames_make_no_file() -> None:
    with pytest.raises(ValueError, match="no frames"):
        list(asciicast_lines([], PALETTES["16"]))
