"""Pictures and lists of segments become walls by Flatland's rule."""

from __future__ import annotations

import io
import time
import zlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from PIL import Image

from kit.arrays import BoolArray, FloatArray
from kit.world.documents import UnusableFile
from kit.world.layer_reader import (
    MAX_IMAGE_BYTES,
    MAX_LINES_BYTES,
    MAX_PIXELS,
    MAX_SEGMENTS,
    read_image,
    trace_edges,
    walls_from_lines,
)
from kit.world.problems import ProblemCollector, WorldError
from tests.world.picture_walls import walls_from_image

Segments = set[tuple[float, ...]]


def segments(walls: FloatArray) -> Segments:
    return {tuple(float(number) for number in np.round(wall, 9)) for wall in walls}


def dark(*rows: str) -> BoolArray:
    """A picture drawn in text, # for a dark pixel."""
    return np.array([[pixel == "#" for pixel in row] for row in rows])


def test_a_pixel_within_has_four_sides() -> None:
    assert segments(trace_edges(dark("...", ".#.", "..."), 0.5)) == {
        (0.5, 1.0, 1.0, 1.0),
        (0.5, 0.5, 1.0, 0.5),
        (0.5, 0.5, 0.5, 1.0),
        (1.0, 0.5, 1.0, 1.0),
    }


def test_the_rim_is_walled_where_it_is_dark_and_open_where_it_is_bright() -> None:
    assert segments(trace_edges(dark("#."), 1)) == {(0, 1, 1, 1), (0, 0, 1, 0), (0, 0, 0, 1), (1, 0, 1, 1)}
    assert len(trace_edges(dark("..", ".."), 1)) == 0


def test_a_line_one_pixel_wide_is_two_walls_and_runs_are_joined() -> None:
    walls = segments(trace_edges(dark(".....", "#####", "....."), 1))
    assert walls == {(0, 2, 5, 2), (0, 1, 5, 1), (0, 1, 0, 2), (5, 1, 5, 2)}


def test_walls_that_meet_at_a_corner_only_are_not_joined_round_it() -> None:
    walls = segments(trace_edges(dark("#.", ".#"), 1))
    assert {
        (0, 1, 2, 1),
        (1, 0, 1, 2),
    } <= walls  # each grid line is one run: the sides of both pixels lie on it
    assert len(walls) == 6


def test_flatlands_own_picture_of_rings(tmp_path: Path) -> None:
    """The picture of Flatland's simple_test_A, and the segments its test lists for it."""
    bright = np.full((5, 5), 255, dtype=np.uint8)
    bright[0, :] = bright[-1, :] = bright[:, 0] = bright[:, -1] = bright[2, 2] = 0
    Image.fromarray(bright).save(tmp_path / "rings.png")
    walls = walls_from_image(tmp_path / "rings.png", resolution=0.05, occupied_thresh=0.65)
    lying = [
        (0.25, 0, 0.25),
        (0.2, 0.05, 0.2),
        (0.15, 0.1, 0.15),
        (0.1, 0.1, 0.15),
        (0.05, 0.05, 0.2),
        (0, 0, 0.25),
    ]
    assert segments(walls) == {(a, y, b, y) for y, a, b in lying} | {(x, a, x, b) for x, a, b in lying}


def naive(picture: BoolArray) -> Segments:
    """The same rule, pixel by pixel."""
    rows, columns = picture.shape

    def is_dark(row: int, column: int) -> bool:
        return 0 <= row < rows and 0 <= column < columns and bool(picture[row, column])

    def runs(flips: list[bool]) -> list[tuple[int, int]]:
        ends = [i for i, (a, b) in enumerate(zip([False, *flips], [*flips, False], strict=True)) if a != b]
        return list(zip(ends[::2], ends[1::2], strict=True))

    found: Segments = set()
    for row in range(rows + 1):
        for a, b in runs([is_dark(row - 1, column) != is_dark(row, column) for column in range(columns)]):
            found.add((a, rows - row, b, rows - row))
    for column in range(columns + 1):
        for a, b in runs([is_dark(row, column - 1) != is_dark(row, column) for row in range(rows)]):
            found.add((column, rows - b, column, rows - a))
    return found


@given(arrays(np.bool_, array_shapes(min_dims=2, max_dims=2, max_side=9)))
def test_every_picture_gives_the_walls_of_the_rule(picture: BoolArray) -> None:
    walls = trace_edges(picture, 1.0)
    assert segments(walls) == naive(picture)
    assert len(walls) == len(segments(walls))


@given(arrays(np.bool_, array_shapes(min_dims=2, max_dims=2, max_side=9)))
def test_every_wall_around_dark_pixels_closes(picture: BoolArray) -> None:
    walls = trace_edges(picture, 1.0)
    edges = ((picture[:, 1:] != picture[:, :-1]).sum(), (picture[1:] != picture[:-1]).sum())
    rim = picture[0].sum() + picture[-1].sum() + picture[:, 0].sum() + picture[:, -1].sum()
    assert np.abs(walls[:, 2:] - walls[:, :2]).sum() == sum(edges) + rim
    assert (walls[:, :2] <= walls[:, 2:]).all()


@pytest.mark.parametrize(
    ("threshold", "darkest_bright"), [(0.65, 166), (0.0, 0), (1.0, 255), (0.5, 128), (0.2, 51)]
)
def test_a_pixel_is_dark_below_the_threshold(tmp_path: Path, threshold: float, darkest_bright: int) -> None:
    file = tmp_path / "ramp.png"
    Image.fromarray(np.repeat(np.arange(256, dtype=np.uint8), 2).reshape(256, 2)).save(file)
    walls = walls_from_image(file, resolution=1, occupied_thresh=threshold)
    assert {float(y) for x1, y, x2, y2 in walls if y == y2} == (
        {256.0, 256.0 - darkest_bright} if darkest_bright else set()
    )


def test_a_threshold_no_pixel_reaches_leaves_all_dark(tmp_path: Path) -> None:
    Image.new("L", (2, 2), 255).save(tmp_path / "white.png")
    assert len(walls_from_image(tmp_path / "white.png", resolution=1, occupied_thresh=1.5)) == 4


COLORS: list[tuple[str, object, str, int]] = [
    # mode, pixel, format, grey: the luma 0.299 R + 0.587 G + 0.114 B, which libpng rounds down
    ("L", 77, "PNG", 77),
    ("LA", (77, 0), "PNG", 77),
    ("1", 255, "PNG", 255),
    ("RGB", (77, 77, 77), "PNG", 77),
    ("RGBA", (77, 77, 77, 0), "PNG", 77),
    ("RGB", (255, 0, 0), "PNG", 76),
    ("RGB", (0, 255, 0), "PNG", 149),
    ("RGB", (0, 255, 0), "BMP", 150),
    ("RGB", (0, 0, 255), "PNG", 29),
    ("RGBA", (255, 0, 0, 0), "PNG", 76),
    ("RGB", (10, 200, 90), "PPM", 131),
    ("L", 200, "PPM", 200),
    ("I;16", 200 * 256 + 255, "PNG", 200),
    ("CMYK", (0, 0, 0, 0), "JPEG", 255),
]


@pytest.mark.parametrize(("mode", "pixel", "format_", "grey"), COLORS)
def test_every_kind_of_picture_becomes_grey(
    tmp_path: Path, mode: str, pixel: tuple[int, ...], format_: str, grey: int
) -> None:
    file = tmp_path / "picture"
    Image.new(mode, (3, 2), pixel).save(file, format_)
    assert read_image(file)[0].tolist() == [[grey] * 3] * 2


def test_a_palette_is_looked_up_and_its_transparency_ignored(tmp_path: Path) -> None:
    picture = Image.new("P", (2, 1))
    picture.putpalette([0, 0, 0, 255, 255, 255])
    picture.putpixel((1, 0), 1)
    picture.save(tmp_path / "palette.png", transparency=1)
    assert read_image(tmp_path / "palette.png")[0].tolist() == [[0, 255]]


def test_a_large_map_is_quick(tmp_path: Path) -> None:
    picture = np.full((1000, 1000, 4), 255, dtype=np.uint8)
    for i in range(0, 1000, 20):
        picture[i : i + 10, i : i + 10, :3] = 0
    Image.fromarray(picture).save(tmp_path / "large.png")
    start = time.process_time()
    walls = walls_from_image(tmp_path / "large.png", resolution=0.05, occupied_thresh=0.65)
    assert time.process_time() - start < 1.0
    assert len(walls) == 200


def test_a_large_map_in_memory_is_traced_quickly() -> None:
    start = time.process_time()
    assert len(trace_edges(np.zeros((1000, 1000), dtype=np.bool_), 0.05)) == 0
    assert time.process_time() - start < 0.5


def test_a_noisy_picture_is_refused() -> None:
    noise = np.random.default_rng(1).random((600, 600)) < 0.5
    with pytest.raises(UnusableFile, match=str(MAX_SEGMENTS)):
        trace_edges(noise, 1.0)


def png(width: int, height: int) -> bytes:
    """A small file that claims to be a large picture."""
    content = io.BytesIO()
    Image.new("L", (1, 1)).save(content, "PNG")
    data = bytearray(content.getvalue())
    data[16:24] = width.to_bytes(4, "big") + height.to_bytes(4, "big")
    data[29:33] = zlib.crc32(data[12:29]).to_bytes(4, "big")
    return bytes(data)


@pytest.mark.parametrize(
    ("width", "height"), [(5000, 4000), (10_000, 10_000), (60_000, 60_000), (2**31 - 1, 2**31 - 1)]
)
def test_a_picture_that_would_unpack_to_too_many_pixels_is_refused(
    tmp_path: Path, width: int, height: int
) -> None:
    (tmp_path / "bomb.png").write_bytes(png(width, height))
    with pytest.raises(UnusableFile, match=str(MAX_PIXELS)):
        read_image(tmp_path / "bomb.png")


BROKEN = {
    "empty": b"",
    "text": b"not a picture",
    "header only": b"\x89PNG\r\n\x1a\n",
    "no pixels": png(0, 0),
    "too few pixels": png(100, 100),
    "an animation": b"GIF89a" + bytes(20),
    "postscript": b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 1 1\n",
}


@pytest.mark.parametrize("content", BROKEN.values(), ids=BROKEN.keys())
def test_a_broken_picture_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "broken.png").write_bytes(content)
    with pytest.raises(UnusableFile):
        read_image(tmp_path / "broken.png")


@given(st.data())
def test_a_damaged_picture_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, data: st.DataObject
) -> None:
    content = io.BytesIO()
    Image.fromarray(np.arange(64, dtype=np.uint8).reshape(8, 8)).save(
        content, data.draw(st.sampled_from(["PNG", "BMP", "PPM", "JPEG"]))
    )
    damaged = bytearray(content.getvalue())
    for _ in range(data.draw(st.integers(1, 4))):
        damaged[data.draw(st.integers(0, len(damaged) - 1))] = data.draw(st.integers(0, 255))
    file = tmp_path_factory.mktemp("damaged") / "picture"
    file.write_bytes(damaged[: data.draw(st.integers(0, len(damaged)))])
    try:
        grey = read_image(file)[0]
    except UnusableFile:
        return
    assert grey.dtype == np.uint8
    assert grey.ndim == 2


def test_a_huge_picture_file_is_not_read(tmp_path: Path) -> None:
    with (tmp_path / "huge.png").open("wb") as file:
        file.write(png(10, 10))
        file.truncate(1 << 30)
    with pytest.raises(UnusableFile, match=f"{MAX_IMAGE_BYTES // 1_000_000} MB"):
        read_image(tmp_path / "huge.png")


def test_a_picture_that_goes_over_its_pixels_again_and_again_is_refused(tmp_path: Path) -> None:
    """Of 40 bytes each: a picture of a megabyte takes a minute, and one of the largest size half an hour."""
    content = io.BytesIO()
    Image.new("L", (64, 64)).save(content, "JPEG", progressive=True)
    usual = content.getvalue()
    (tmp_path / "usual.jpg").write_bytes(usual)
    assert read_image(tmp_path / "usual.jpg")[0].shape == (64, 64)
    first = usual.index(b"\xff\xda")
    scan = usual[first : usual.index(b"\xff", first + 2)]
    (tmp_path / "again.jpg").write_bytes(usual[:first] + 200 * scan + usual[first:])
    with pytest.raises(UnusableFile, match="over its pixels"):
        read_image(tmp_path / "again.jpg")
    (tmp_path / "film.jpg").write_bytes(usual + 200 * scan)  # telephones put a film behind a picture
    assert read_image(tmp_path / "film.jpg")[0].shape == (64, 64)


def lines(tmp_path: Path, text: str, scale: float = 1.0) -> FloatArray:
    file = tmp_path / "lines.dat"
    file.write_text(text)
    problems = ProblemCollector()
    walls = walls_from_lines(file, scale, problems)
    problems.raise_if_any()
    return walls


def test_lines_are_scaled_segments(tmp_path: Path) -> None:
    walls = lines(tmp_path, "1 2 3 4\n-1\t-2  -3 -4 # and more\n0.1 0.2 .3 4e-1", 0.1)
    assert np.allclose(walls, [[0.1, 0.2, 0.3, 0.4], [-0.1, -0.2, -0.3, -0.4], [0.01, 0.02, 0.03, 0.04]])


def test_no_lines_are_no_walls(tmp_path: Path) -> None:
    assert lines(tmp_path, "").shape == (0, 4)


@pytest.mark.parametrize(
    "text",
    ["\n", "1 2 3 4\n\n", "1 2 3 4\n\n1 2 3 4", "1 2 3", "a b c d", "1,2,3,4", "1 2 3 inf", "1 2 3 1_0"],
)
def test_what_is_no_segment_is_noted(tmp_path: Path, text: str) -> None:
    with pytest.raises(WorldError):
        lines(tmp_path, text)


def test_of_many_bad_lines_some_are_noted(tmp_path: Path) -> None:
    with pytest.raises(WorldError) as caught:
        lines(tmp_path, "x\n" * 50_000)
    assert [problem.location.line for problem in caught.value.problems] == list(range(1, 11))


def test_a_huge_file_of_lines_is_not_read(tmp_path: Path) -> None:
    with (tmp_path / "huge.dat").open("wb") as file:
        file.write(b"0 0 1 1 # ")
        file.truncate(MAX_LINES_BYTES + 1)
    with pytest.raises(UnusableFile, match=f"{MAX_LINES_BYTES // 1_000_000} MB"):
        walls_from_lines(tmp_path / "huge.dat", 1.0, ProblemCollector())


def test_too_many_lines_are_refused(tmp_path: Path) -> None:
    with pytest.raises(UnusableFile, match=str(MAX_SEGMENTS)):
        lines(tmp_path, "0 0 0 0\n" * (MAX_SEGMENTS + 1))


def test_many_lines_are_quick(tmp_path: Path) -> None:
    start = time.process_time()
    assert len(lines(tmp_path, "0.125 0.5 12.25 1e-3\n" * 10_000)) == 10_000
    assert time.process_time() - start < 1.0
