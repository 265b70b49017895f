"""What on a sheet may be no wall is left out, shown and told; a plain drawing is not doubted."""

from __future__ import annotations

import os
import pty
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image, ImageDraw

from kit.cli import main
from kit.mapmaking.doubts import DOUBTS, judge_strokes
from kit.mapmaking.photo import PhotoScale, plan_from_photo, whole_picture
from kit.mapmaking.strokes import find_strokes
from tests.mapmaking.judging import judge
from tests.mapmaking.nuisances import KINDS
from tests.mapmaking.photos import draw_photo

PEN = 12


def drawn(size: tuple[int, int] = (1400, 1000)) -> tuple[Image.Image, ImageDraw.ImageDraw]:
    """Clean paper with two rooms, and what draws on it."""
    image = Image.new("RGB", size, "white")
    draw = ImageDraw.Draw(image)
    draw.rectangle((100, 100, 1300, 900), outline="black", width=PEN)
    draw.line((700, 100, 700, 600), fill="black", width=PEN)
    return image, draw


def test_a_plain_drawing_is_not_doubted() -> None:
    image, _ = drawn()
    found = find_strokes(image)
    assert found.remarks == ()
    assert not found.doubtful.any()


@pytest.mark.parametrize(("gap", "is_wall"), [(9, True), (60, False)])
def test_what_lies_beyond_a_short_break_in_a_stroke_is_a_wall(gap: int, is_wall: bool) -> None:
    strokes = np.zeros((700, 1000), dtype=np.bool_)
    strokes[50:650, 50:950] = True
    strokes[66:634, 66:934] = False
    strokes[66:150, 500:516] = True
    strokes[150 + gap : 185 + gap, 500:516] = True
    judged = judge_strokes(strokes, np.zeros_like(strokes), strokes)
    assert (judged.remarks == ()) == is_wall
    assert bool(judged.walls[160 + gap, 508]) == is_wall


def test_the_lesson_s_photograph_is_not_doubted() -> None:
    """Its strokes are of two widths, as a hand draws them, and lie half in a shadow."""
    photo = Path(__file__).parents[2] / "lessons" / "35-photo-to-map" / "sheet" / "starter" / "plan.jpg"
    with Image.open(photo) as image:
        assert plan_from_photo(image.convert("RGB"), PhotoScale(sheet_width=5.0)).strokes.remarks == ()


@pytest.mark.parametrize(
    ("what", "said"),
    [
        ("squares", "pale lines"),
        ("fold", "pale lines"),
        ("word", "small pieces"),
        ("slip", "small pieces"),
        ("measure", "thin lines"),
        ("measure with arrows", "thin lines"),
        ("outside", "beyond the outer wall"),
        ("room", "a room without a door"),
    ],
)
def test_what_else_is_drawn_is_told_and_no_wall(what: str, said: str) -> None:
    image, draw = drawn()
    plain = find_strokes(image).walls
    match what:
        case "squares":
            lines = Image.new("RGB", image.size, "white")
            rules = ImageDraw.Draw(lines)
            for place in range(20, 1400, 40):
                rules.line((place, 0, place, 1000), fill=(200, 200, 215), width=2)
                rules.line((0, place, 1400, place), fill=(200, 200, 215), width=2)
            image = Image.fromarray(np.minimum(np.asarray(lines), np.asarray(image)))
        case "fold":
            draw.line((0, 720, 1400, 730), fill=(190, 190, 190), width=8)
        case "word":
            for x in (300, 340, 380):
                draw.line((x, 400, x + 10, 440), fill="black", width=PEN)
        case "slip":
            draw.line((300, 500, 350, 520), fill="black", width=PEN)
        case "measure":
            draw.line((150, 800, 600, 800), fill="black", width=4)
        case "measure with arrows":  # its point is so near to the wall that the break is bridged
            draw.line((815, 700, 1262, 700), fill="black", width=10)
            draw.polygon(((1284, 700), (1254, 685), (1254, 715)), fill="black")
            draw.polygon(((800, 700), (830, 685), (830, 715)), fill="black")
        case "outside":
            draw.line((40, 200, 40, 700), fill="black", width=PEN)
        case "room":
            draw.rectangle((900, 300, 1150, 600), outline="black", width=PEN)
    found = find_strokes(image)
    assert any(said in remark for remark in found.remarks), found.remarks
    if what != "room":  # which is made of walls
        assert int((found.walls & ~plain).sum()) < 0.02 * plain.sum()
        assert found.doubtful.any()
        assert all(each.boxes() for each in found.doubts)
    read = plan_from_photo(image, PhotoScale(5.0), corners=whole_picture(image))
    assert read.keeping(DOUBTS).plan.walls.sum() > plain.sum()
    assert read.keeping(DOUBTS).strokes.doubts == ()


def sheet_in_doubt(folder: Path) -> Path:
    """A picture with a fold and a word."""
    image, draw = drawn()
    draw.line((0, 720, 1400, 730), fill=(190, 190, 190), width=8)
    for x in (300, 340, 380):
        draw.line((x, 400, x + 10, 440), fill="black", width=PEN)
    image.save(folder / "sheet.png")
    return folder / "sheet.png"


def walls_of(folder: Path) -> int:
    """How many pixels of wall the map in a workspace has."""
    with Image.open(next(folder.glob("worlds/hall/map.png"))) as picture:
        return int((np.asarray(picture) < 128).sum())


def test_options_say_which_doubtful_lines_are_walls(tmp_path: Path) -> None:
    sheet, counts, told = sheet_in_doubt(tmp_path), {}, {}
    for kinds in ((), ("none",), ("small",), ("all",)):
        folder = tmp_path / "-".join(("home", *kinds))
        words = ["maps", "from-photo", str(sheet), "hall", "--corners", "whole", "--width", "5"]
        chosen = [word for kind in kinds for word in ("--keep", kind)]
        made = CliRunner().invoke(main, [*words, *chosen, "--workspace", str(folder)])
        assert made.exit_code == 0, made.output
        counts[kinds], told[kinds] = walls_of(folder), made.output
    assert counts[()] == counts[("none",)] < counts[("small",)] < counts[("all",)]
    assert "--keep pale" in told[()]
    assert "--keep small" in told[()]
    assert "--keep pale" in told[("small",)]
    assert "--keep small" not in told[("small",)]
    assert "--keep" not in told[("all",)]


@pytest.mark.parametrize(("typed", "is_made"), [(b"\n2\n", True), (b"\nq\n", False)])
def test_a_terminal_asks_of_each_kind(tmp_path: Path, typed: bytes, is_made: bool) -> None:
    sheet = sheet_in_doubt(tmp_path)
    words = ["maps", "from-photo", str(sheet), "hall", "--corners", "whole", "--width", "5"]
    command = [sys.executable, "-m", "kit", *words, "--workspace", str(tmp_path / "home")]
    leader, follower = pty.openpty()
    process = subprocess.Popen(
        command,
        stdin=follower,
        stdout=follower,
        stderr=follower,
        env={**os.environ, "TERM": "dumb", "COLUMNS": "80"},
    )
    os.close(follower)
    os.write(leader, typed)
    printed = b""
    with suppress(OSError):  # the other end is closed
        while part := os.read(leader, 1 << 16):
            printed += part
    os.close(leader)
    assert (process.wait() == 0) is is_made, printed.decode()
    assert b"pale lines" in printed
    assert b"small pieces" in printed
    if is_made:
        told = " ".join(printed.decode().split())
        assert "--keep pale" in told
        assert "--keep small" not in told
        image, _ = drawn()
        assert walls_of(tmp_path / "home") > int(find_strokes(image).walls.sum())
    else:
        assert b"No map was made" in printed
        assert not (tmp_path / "home" / "worlds" / "hall").exists()


@pytest.mark.long
@pytest.mark.parametrize("kind", KINDS)
def test_a_photograph_is_read_or_doubted(kind: str) -> None:
    for seed in (51, 52, 53):
        found = judge(draw_photo(seed, kind))
        assert found.is_right or found.remarks or found.refusal


def test_on_refusal_the_overlay_is_written_and_nothing_is_called_too_small(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    image = Image.new("RGB", (1400, 1000), "white")
    draw = ImageDraw.Draw(image)
    draw.rectangle((100, 200, 660, 700), outline="black", width=10)
    draw.line((380, 200, 380, 520), fill="black", width=10)
    image.save("crisp.png")
    words = ["maps", "from-photo", "crisp.png", "hall", "--corners", "whole", "--width"]
    for width in ("5", "15"):
        made = CliRunner().invoke(main, [*words, width, "--workspace", str(tmp_path / width)])
        assert made.exit_code == 0, made.output
    draw.rectangle((640, 300, 700, 500), fill="white")  # the outer wall is open
    image.save("crisp.png")
    refused = CliRunner().invoke(main, [*words, "5", "--workspace", str(tmp_path / "open")])
    assert refused.exit_code != 0
    assert "hall-overlay.png" in refused.output
    with Image.open("hall-overlay.png") as overlay:
        assert overlay.size[0] > 100
