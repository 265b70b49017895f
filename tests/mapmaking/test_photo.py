"""A photograph of a drawing becomes a map: the walls are where they were drawn, and what is no drawing is refused."""

from __future__ import annotations

import os
import re
import struct
import warnings
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import EpsImagePlugin, Image, ImageDraw, ImageOps

from kit.cli import main
from kit.mapmaking.photo import PhotoError, PhotoScale, open_photo, plan_from_photo
from kit.mapmaking.sheet import find_sheet
from kit.run.scenario import find_scenario
from kit.world.layer_reader import read_image
from tests.mapmaking.judging import judge
from tests.mapmaking.photos import SHEET, draw_photo

SEEDS = (0, 2, 4)


@pytest.mark.long
@pytest.mark.parametrize("seed", SEEDS)
def test_the_walls_are_found_to_two_centimetres(seed: int) -> None:
    found = judge(draw_photo(seed))
    assert found.is_right, found


@pytest.mark.long
def test_the_corners_of_the_sheet_are_found_to_two_pixels() -> None:
    photo = draw_photo(1)
    apart = np.hypot(*(np.array(find_sheet(photo.image)) - np.array(photo.corners)).T)
    assert apart.max() < 2


@pytest.mark.long
def test_a_photograph_becomes_a_world_to_drive_in(tmp_path: Path) -> None:
    draw_photo(6).image.save(tmp_path / "plan.jpg")
    command = [
        "maps",
        "from-photo",
        str(tmp_path / "plan.jpg"),
        "--width",
        "5",
        "--workspace",
        str(tmp_path / "kit"),
    ]
    result = CliRunner().invoke(main, command)
    assert result.exit_code == 0, result.output
    assert "narrowest passage" in result.output
    folder = tmp_path / "kit" / "worlds" / "plan"
    assert (folder / "overlay.png").is_file()
    scenario = find_scenario(str(folder))
    assert scenario.case is not None
    assert scenario.robot == "serp"
    again = CliRunner().invoke(main, command)
    assert again.exit_code == 2
    assert "already exists" in again.output


def flat(draw: bool = True, size: tuple[int, int] = (900, 700)) -> Image.Image:
    """A sheet seen straight from above, with one square of strokes."""
    image = Image.new("RGB", size, (60, 50, 45))
    paint = ImageDraw.Draw(image)
    paint.rectangle((100, 100, 800, 595), fill=(235, 233, 228))
    if draw:
        paint.rectangle((170, 170, 730, 525), outline=(30, 30, 40), width=8)
    return image


@pytest.mark.long
def test_the_scale_comes_from_the_sheet_or_from_the_walls() -> None:
    by_sheet = plan_from_photo(flat(), PhotoScale(sheet_width=7.0)).plan
    by_walls = plan_from_photo(flat(), PhotoScale(walls_width=5.61)).plan
    assert by_sheet.size[0] == pytest.approx(7.0)
    assert by_walls.resolution == pytest.approx(by_sheet.resolution, rel=0.01)


@pytest.mark.long
def test_corners_may_be_named() -> None:
    named = ((100.0, 100.0), (801.0, 100.0), (801.0, 596.0), (100.0, 596.0))
    plan = plan_from_photo(flat(), PhotoScale(sheet_width=SHEET[0]), corners=named).plan
    found = plan_from_photo(flat(), PhotoScale(sheet_width=SHEET[0])).plan
    assert (plan.walls != found.walls).mean() < 0.01


@pytest.mark.sampled(4)
@pytest.mark.parametrize(
    ("picture", "told"),
    [
        (flat(draw=False), "empty"),
        (Image.new("RGB", (900, 700), (200, 200, 200)), "darker table"),
        (Image.effect_noise((900, 700), 120).convert("RGB"), "--corners"),
        (Image.effect_mandelbrot((900, 700), (-2, -1.5, 1, 1.5), 60).convert("RGB"), "--corners"),
    ],
    ids=["no drawing", "no sheet", "noise", "another picture"],
)
def test_what_is_no_drawing_is_refused_with_a_way_out(picture: Image.Image, told: str) -> None:
    with pytest.raises(PhotoError, match=told):
        plan_from_photo(picture, PhotoScale(sheet_width=5.0))


@pytest.mark.parametrize(
    ("content", "told"),
    [(b"not a readable picture", "not a readable picture"), (b"", "not a readable picture")],
)
def test_a_file_that_is_no_picture_is_named(tmp_path: Path, content: bytes, told: str) -> None:
    (tmp_path / "cat.jpg").write_bytes(content)
    with pytest.raises(PhotoError, match=told):
        open_photo(tmp_path / "cat.jpg")


def test_no_other_program_draws_a_picture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As Pillow has PostScript drawn, under whatever name the file has."""
    drawn = []
    monkeypatch.setattr(
        EpsImagePlugin, "Ghostscript", lambda *given, **named: drawn.append(given) or flat().im
    )
    file = tmp_path / "plan.jpg"
    Image.new("RGB", (800, 600)).save(file, "EPS")
    with pytest.raises(PhotoError, match="not a readable picture"):
        open_photo(file)
    assert not drawn
    with Image.open(file) as opened:
        opened.load()
    assert drawn, "it would have been"


def test_a_named_pipe_is_no_photograph(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "plan.jpg")
    with pytest.raises(PhotoError, match="not a plain file"):
        open_photo(tmp_path / "plan.jpg")


def test_a_tiny_picture_is_refused(tmp_path: Path) -> None:
    Image.new("L", (20, 20)).save(tmp_path / "tiny.png")
    with pytest.raises(PhotoError, match="at least"):
        open_photo(tmp_path / "tiny.png")


def test_the_scale_is_asked_for(tmp_path: Path) -> None:
    flat().save(tmp_path / "plan.png")
    result = CliRunner().invoke(
        main, ["maps", "from-photo", str(tmp_path / "plan.png"), "--workspace", str(tmp_path)]
    )
    assert result.exit_code == 2
    assert "--walls-width" in result.output


def test_what_is_wrong_with_a_file_is_said(tmp_path: Path) -> None:
    file = tmp_path / "plan.jpg"
    Image.new("RGB", (800, 600)).save(file)
    with pytest.raises(PhotoError, match="almost all black"):
        open_photo(file)
    noise = np.random.default_rng(0).integers(0, 255, (600, 800), dtype=np.uint8)
    Image.fromarray(noise).save(file)
    file.write_bytes(file.read_bytes()[:20_000])
    with pytest.raises(PhotoError, match=r"truncated.*Copy it again"):
        open_photo(file)


def test_whatever_a_decoder_makes_of_a_damaged_file_it_is_a_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def of_a_damaged_tiff(image: Image.Image) -> Image.Image:
        raise TypeError("'str' object cannot be interpreted as an integer")

    file = tmp_path / "plan.png"
    Image.new("RGB", (800, 600)).save(file)
    monkeypatch.setattr(ImageOps, "exif_transpose", of_a_damaged_tiff)
    with pytest.raises(PhotoError, match="not a readable picture"):
        open_photo(file)


def test_damaged_remarks_of_a_picture_warn_of_nothing(tmp_path: Path) -> None:
    entries = struct.pack("<H", 600) + 50 * struct.pack("<HHII", 34665, 4, 1, 8)
    file = tmp_path / "plan.jpg"
    Image.effect_noise((800, 600), 80).save(file, exif=b"Exif\0\0II*\0\x08\0\0\0" + entries)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        open_photo(file)
        read_image(file)


def test_pictures_of_every_kind_show_the_same(tmp_path: Path) -> None:
    """16 bits a pixel, what is transparent, and what the camera held sideways."""
    plan = Image.new("L", (800, 600), 250)
    ImageDraw.Draw(plan).rectangle((100, 100, 700, 500), outline=0, width=8)
    expected = np.asarray(plan).astype(int)

    def seen(name: str, image: Image.Image, **options: object) -> np.ndarray:
        image.save(tmp_path / name, **options)
        return np.asarray(open_photo(tmp_path / name).convert("L")).astype(int)

    deep = Image.fromarray(np.asarray(plan).astype(np.uint16) * 257)
    assert np.abs(seen("deep.png", deep) - expected * 255 / 250).max() < 2
    clear = Image.new("RGBA", plan.size, (0, 0, 0, 0))
    ImageDraw.Draw(clear).rectangle((100, 100, 700, 500), outline=(0, 0, 0, 255), width=8)
    assert np.abs(seen("clear.png", clear) - expected).max() < 8
    exif = Image.Exif()
    exif[274] = 6  # held to the right
    sideways = plan.transpose(Image.Transpose.ROTATE_90)
    assert np.abs(seen("sideways.jpg", sideways, exif=exif, quality=95) - expected).mean() < 2


@pytest.mark.long
def test_a_scan_is_the_whole_picture(tmp_path: Path) -> None:
    scan = Image.new("L", (1240, 877), 250)
    draw = ImageDraw.Draw(scan)
    draw.rectangle((100, 100, 1100, 780), outline=20, width=8)
    scan.save(tmp_path / "scan.png")
    command = ["maps", "from-photo", str(tmp_path / "scan.png"), "--width", "5"]
    where = ["--workspace", str(tmp_path / "kit")]
    refused = CliRunner().invoke(main, [*command, *where])
    assert refused.exit_code == 2
    assert "--corners whole" in refused.output
    made = CliRunner().invoke(main, [*command, *where, "--corners", "whole"])
    assert made.exit_code == 0, made.output
    scenario = find_scenario(str(tmp_path / "kit" / "worlds" / "scan"))
    ends = np.concatenate(
        [layer.walls.segments for layer in scenario.world.layers if layer.walls is not None]
    )
    assert ends[:, ::2].min() == pytest.approx(100 / 1240 * 5, abs=0.04)
    assert ends[:, ::2].max() == pytest.approx(1100 / 1240 * 5, abs=0.04)


@pytest.mark.parametrize(("option", "sheet", "walls"), [("--width", 7.0, 5.68), ("--walls-width", 4.92, 4.0)])
def test_the_scale_is_told_as_it_was_read(tmp_path: Path, option: str, sheet: float, walls: float) -> None:
    """The sheet is 701 pixels wide, the walls on it 569."""
    flat().save(tmp_path / "plan.png")
    given = f"{sheet:g}" if option == "--width" else f"{walls:g}"
    words = ["maps", "from-photo", str(tmp_path / "plan.png"), option, given, "--workspace", str(tmp_path)]
    output = CliRunner().invoke(main, words).output
    (line,) = " ".join(output.split()).split("Scale: ")[1:]
    told = re.findall(r"[\d.]*\d", line.partition("apart")[0])
    assert float(told[0]) == pytest.approx(sheet, rel=0.02)
    assert float(told[2]) == pytest.approx(walls, rel=0.02)
    assert option in line


def test_the_scale_of_a_drawing_in_characters_is_told(tmp_path: Path) -> None:
    words = ["maps", "new", "hall", "--from", "-", "--cell", "0.4", "--workspace", str(tmp_path)]
    drawing = "\n".join(["#" * 12, *["#" + " " * 10 + "#"] * 6, "#" * 12])
    output = CliRunner().invoke(main, words, input=drawing).output
    assert "0.4 m; the drawing is 4.8 m by 3.2 m" in " ".join(output.split())
