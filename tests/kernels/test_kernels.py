"""The formulas, each against something simpler: known numbers, numpy, or another way to the same thing."""

from __future__ import annotations

import ctypes
import math
import os
import subprocess
import sys
from pathlib import Path
from statistics import NormalDist
from typing import Any

import numpy as np
import pytest

from kit.kernels import compilation, grids, kernel_cache, kernels, world_kernels
from kit.kernels.lidar_index import make_beams, make_wall_blocks
from kit.sim import motors
from tests.cases import every_case
from tests.kernels import scans

FAR = np.float32(0.1)
"""As rays count: 1 / distance."""
NOTHING = kernels.Shapes(
    np.zeros((0, 3)),
    np.zeros(0, dtype=np.int64),
    np.zeros((0, 2)),
    np.zeros(1, dtype=np.int64),
    np.zeros(0, dtype=np.int64),
)
SQUARE = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])


def singles(*values: float) -> list[np.float32]:
    return [np.float32(value) for value in values]


# Motion


def test_straight_ahead_and_on_the_spot() -> None:
    assert kernels.twist_step(1, 2, math.pi / 2, 0.5, 0, 0, 2) == pytest.approx((1, 3, math.pi / 2))
    assert kernels.twist_step(1, 2, 3, 0, 0, math.pi / 2, 1) == (1, 2, 3 + math.pi / 2)


def test_a_quarter_circle() -> None:
    pose = kernels.twist_step(0, 0, 0, 1, 0, 1, math.pi / 2)
    assert pose == pytest.approx((1, 1, math.pi / 2))


@pytest.mark.parametrize("twist", [(0.5, 0.0, 1.57), (-1.0, 0.3, -4.0), (0.3, 0.0, 1e-9)])
def test_short_steps_lead_where_a_long_one_does(twist: tuple[float, float, float]) -> None:
    pose = (0.3, -0.2, 1.0)
    whole = kernels.twist_step(*pose, *twist, 1.0)
    for _ in range(100):
        pose = kernels.twist_step(*pose, *twist, 0.01)
    assert pose == pytest.approx(whole, abs=1e-12)


def test_a_tricycle_turns_about_the_point_where_its_axles_meet() -> None:
    forward, turn = motors.tricycle_twist(0.5, 0.3, 0.9)
    assert forward / turn == pytest.approx(0.9 / math.tan(0.3))
    assert math.hypot(forward, turn * 0.9) == pytest.approx(0.5)


# Flatland's own table. Acceleration, deceleration and speed limit; dt; then current, target -> new
LIMITS = [
    ((0, 0, 0), 0.05, [(0, 1, 1), (1, 1, 1), (0.1, 1, 1)]),
    ((0, 0, 0), 0.1, [(-100, 1, 1), (-100, -1, -1), (-100, -21, -21)]),
    ((0, 0, 1), 0.05, [(0, 1, 1), (1, 1, 1), (0, 2, 1)]),
    ((0, 0, 1), 0.1, [(0, -1, -1), (0, -0.5, -0.5), (1, -0.5, -0.5), (-100, -1, -1), (0, -3, -1)]),
    ((9, 9, 0), 0.05, [(0, 1, 0.45), (1, 0, 0.55), (10, 0, 9.55), (-10, 0, -9.55), (5, -5, 4.55)]),
    ((9, 9, 0), 0.05, [(-3, -2, -2.55)]),
    ((1, 9, 0), 0.05, [(0, 1, 0.05), (0.97, 1, 1), (1, 0, 0.55), (-1, -2, -1.05), (-2, -1, -1.55)]),
    ((1, 9, 0), 0.05, [(-2, 1, -1.55), (-1, 2, -0.55), (1, 3, 1.05), (3, -1, 2.55)]),
    ((1, 2, 0), 0.05, [(2, 0, 1.9), (0.08, -1, -0.01)]),
    ((0, 2, 0), 0.05, [(2, 0, 1.9), (0.08, -1, -1)]),
    ((2, 0, 0), 0.05, [(2, 0, 0), (1, -1, -0.1)]),
    ((1, 9, 0.5), 0.05, [(0, 1, 0.05), (0.48, 1.48, 0.5), (1, 2, 0.55), (0.55, 2, 0.5)]),
]


@every_case(
    ("limits", "dt", "current", "target", "new"),
    [(limits, dt, *case) for limits, dt, cases in LIMITS for case in cases],
)
def test_limits_of_a_motor(
    limits: tuple[float, float, float], dt: float, current: float, target: float, new: float
) -> None:
    acceleration, deceleration, top = map(float, limits)
    found = motors.limited_speed(float(current), float(target), acceleration, deceleration, top, dt)
    assert found == pytest.approx(new, abs=1e-9)


# Rays


def test_a_ray_and_a_segment() -> None:
    def nearness(*ends: float) -> float:
        ax, ay, bx, by = singles(*ends)
        return kernels.ray_segment_nearness(
            *singles(1, 0), ax, ay, bx, by, np.float32(1) / (ax * by - ay * bx)
        )

    assert nearness(2, -1, 2, 3) == nearness(2, 3, 2, -1) == 0.5
    assert nearness(-4, -1, -4, 3) == -0.25
    with np.errstate(divide="ignore", invalid="ignore"):
        for miss in ((2, 1, 2, 3), (-2, 1, -2, 3), (2, 0, 5, 0)):  # beside, behind and beside, along
            assert not abs(nearness(*miss)) > 0  # 0, or nan


@every_case("count", range(6))
def test_the_nearest_of_some_segments(count: int) -> None:
    ends = np.array([(far, -1.0, far, 1.0) for far in (5.0, 3.0, 11.0, 2.0, 4.0)[:count]]).reshape(-1, 4)
    ranges, walls = (
        np.zeros(9, dtype=np.float32),
        kernels.WallBlocks(ends, np.array([0, count]), np.zeros((1, 3))),
    )
    scans.scan((0.5, 0.0, 0.0), make_beams([0.0] * 9), 10.0, walls, NOTHING, 1, ranges)
    nearest = min(ends[:, 0], default=math.inf) - 0.5
    assert ranges == pytest.approx(nearest if nearest < 10 else math.nan, nan_ok=True)


def test_no_ray_slips_between_segments_that_share_an_end() -> None:
    rng = np.random.default_rng(0)
    for x, y in rng.uniform(-5, 5, (2000, 2)):
        corner = np.float32(x), np.float32(y)
        length = math.hypot(*corner)
        cos, sin = np.float32(corner[0] / length), np.float32(corner[1] / length)
        left = np.float32(corner[0] - y), np.float32(corner[1] + x)
        right = np.float32(corner[0] + y), np.float32(corner[1] - x)
        found = [
            kernels.ray_segment_nearness(
                *(cos, sin, *one, *other, np.float32(1) / (one[0] * other[1] - one[1] * other[0]))
            )
            for one, other in ((left, corner), (corner, right))
        ]
        assert max(found) == pytest.approx(1 / length, rel=1e-5)


def test_a_ray_and_a_circle() -> None:
    assert kernels.ray_circle_nearness(*singles(1, 0, 3, 0, 0.5), FAR) == np.float32(0.4)
    assert kernels.ray_circle_nearness(*singles(0, 1, 0.3, 2, 0.5), FAR) == pytest.approx(1 / 1.6)
    for miss in ((3, 1, 0.5), (-3, 0, 0.5), (0.2, 0, 0.5), (11, 0, 0.5)):  # beside, behind, inside, far
        assert kernels.ray_circle_nearness(*singles(1, 0, *miss), FAR) == FAR


# Distances


def test_a_point_and_a_segment() -> None:
    assert kernels.point_segment_distance(0.5, 2.0, 0.0, 0.0, 1.0, 0.0) == 2
    assert kernels.point_segment_distance(4.0, 4.0, 0.0, 0.0, 1.0, 0.0) == 5
    assert kernels.point_segment_distance(3.0, 4.0, 0.0, 0.0, 0.0, 0.0) == 5


def test_a_point_and_a_polygon() -> None:
    assert kernels.point_polygon_distance(0.5, 0.5, SQUARE) == 0
    assert kernels.point_polygon_distance(1.0, 0.5, SQUARE) == 0
    assert kernels.point_polygon_distance(3.0, 0.5, SQUARE) == 2
    assert kernels.point_polygon_distance(4.0, 5.0, SQUARE) == 5
    assert kernels.point_in_polygon(1.0, 1.0, SQUARE)
    assert not kernels.point_in_polygon(1.0001, 1.0, SQUARE)


@every_case(
    ("segment", "meets"),
    [
        ((-3, 0, 3, 0), True),  # through
        ((0, 0, 0.1, 0.1), True),  # inside
        ((1, -3, 1, 3), True),  # along an edge
        ((0.5, 0.5, 0.5, 0.5), True),  # a point
        ((0, 3, 3, 0), False),  # past a corner
        ((2, -3, 2, 3), False),
        ((1.001, 0, 5, 0), False),
        ((1.5, 1, 1, 1.5), False),
    ],
)
def test_a_segment_and_a_polygon(segment: tuple[float, ...], meets: bool) -> None:
    assert kernels.segment_intersects_polygon(*map(float, segment), SQUARE) == meets


def test_a_segment_meets_a_polygon_where_one_of_its_points_does() -> None:
    rng = np.random.default_rng(3)
    hexagon = np.array([[math.cos(a), math.sin(a)] for a in np.arange(6) * math.pi / 3])
    for ax, ay, bx, by in rng.uniform(-3, 3, (300, 4)):
        points = [(ax + t * (bx - ax), ay + t * (by - ay)) for t in np.linspace(0, 1, 400)]
        nearest = min(kernels.point_polygon_distance(x, y, hexagon) for x, y in points)
        if not 0 < nearest < 0.01:  # between two of the points
            assert kernels.segment_intersects_polygon(ax, ay, bx, by, hexagon) == (nearest == 0)


# Noise


def test_normal_noise_is_normal() -> None:
    draws = np.array([kernels.normal(7, i) for i in range(40_000)])
    assert abs(draws.mean()) < 0.02
    assert draws.std() == pytest.approx(1, abs=0.02)
    assert (draws**4).mean() == pytest.approx(3, abs=0.15)
    assert abs(np.corrcoef(draws[1:], draws[:-1])[0, 1]) < 0.02
    neighbour = np.array([kernels.normal(8, i) for i in range(40_000)])
    assert abs(np.corrcoef(draws, neighbour)[0, 1]) < 0.02


def test_normal_noise_is_as_rare_as_it_should_be() -> None:
    draws = np.sort([kernels.normal(3, i) for i in range(200_000)])
    for share in (0.001, 0.01, 0.1, 0.3, 0.5, 0.8, 0.95, 0.999):
        expected = NormalDist().inv_cdf(share)
        assert draws[int(share * len(draws))] == pytest.approx(
            expected, abs=0.07 if abs(expected) > 3 else 0.02
        )
    assert np.abs(draws).max() < 4.9


def test_uniform_noise_fills_its_range() -> None:
    draws = np.array([kernels.uniform(2**63 - 1, i) for i in range(20_000)])
    assert draws.min() >= 0
    assert draws.max() < 1
    assert np.histogram(draws, 10, (0, 1))[0] == pytest.approx(np.full(10, 2000), rel=0.1)


def test_noise_has_no_memory() -> None:
    forwards = [kernels.normal(5, i) for i in range(10)]
    assert [kernels.normal(5, i) for i in reversed(range(10))] == forwards[::-1]
    scans = np.full((3, 10), 3, dtype=np.float32)
    for scan, number in zip(scans, (6, 7, 6), strict=True):
        kernels.add_noise(scan, 0.5, 5, number)
    assert scans[0].tobytes() == scans[2].tobytes() != scans[1].tobytes()
    few = np.full(4, 3, dtype=np.float32)
    kernels.add_noise(few, 0.5, 5, 6)
    assert few.tobytes() == scans[0, :4].tobytes()


def test_the_noise_of_scans_is_normal_and_independent() -> None:
    scans = np.zeros((20_000, 12), dtype=np.float32)
    for number, scan in enumerate(scans):
        kernels.add_noise(scan, 1.0, 9, number)
    assert np.abs(scans.mean(axis=0)).max() < 0.03
    assert scans.std(axis=0) == pytest.approx(np.ones(12), abs=0.02)
    assert (scans**4).mean() == pytest.approx(3, abs=0.05)
    assert np.abs(np.corrcoef(scans.T) - np.eye(12)).max() < 0.03
    assert abs(np.corrcoef(scans[1:, 0], scans[:-1, 0])[0, 1]) < 0.03
    other = np.zeros((20_000, 12), dtype=np.float32)
    for number, scan in enumerate(other):
        kernels.add_noise(scan, 1.0, 10, number)
    assert abs(np.corrcoef(scans.ravel(), other.ravel())[0, 1]) < 0.01


def test_nothing_stays_nothing() -> None:
    ranges = np.array([math.nan, 1], dtype=np.float32)
    kernels.add_noise(ranges, 0.5, 5, 0)
    assert math.isnan(ranges[0])
    assert ranges[1] != 1


# Scans


def walls(count: int, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    middles = rng.uniform(-8, 8, (count, 2))
    half = rng.uniform(-0.5, 0.5, (count, 2))
    return np.hstack([middles - half, middles + half])


def plainly(x: float, y: float, angle: float, ends: np.ndarray, reach: float) -> float:
    """The nearest crossing of a ray with segments, in double precision, by solving two equations."""
    direction = np.array([math.cos(angle), math.sin(angle)])
    nearest = math.nan
    for x1, y1, x2, y2 in ends:
        matrix = np.array([[direction[0], x1 - x2], [direction[1], y1 - y2]])
        if abs(np.linalg.det(matrix)) > 1e-12:
            t, u = np.linalg.solve(matrix, [x1 - x, y1 - y])
            if 0 <= u <= 1 and 0 <= t <= reach and not t >= nearest:
                nearest = t
    return nearest


@pytest.mark.parametrize("count", [0, 1, 16, 17, 300])
def test_a_scan_is_exact(count: int) -> None:
    ends = walls(count)
    angles = np.linspace(-3, 3, 37)
    ranges = np.empty(37, dtype=np.float32)
    scans.scan((0.5, -1.0, 0.7), make_beams(angles), 6.0, make_wall_blocks(ends), NOTHING, 1, ranges)
    expected = [plainly(0.5, -1.0, 0.7 + angle, ends, 6.0) for angle in angles]
    assert ranges == pytest.approx(np.array(expected), abs=1e-5, nan_ok=True)


def test_blocks_never_change_what_is_seen() -> None:
    ends = walls(1000, seed=4)
    angles = np.linspace(-math.pi, math.pi, 181)
    whole = make_wall_blocks(ends, size=1000)
    for size in (1, 7, 16, 64):
        blocks = make_wall_blocks(ends, size)
        assert sorted(map(tuple, blocks.ends)) == sorted(map(tuple, ends))
        for x, y in np.random.default_rng(size).uniform(-9, 9, (50, 2)):
            one, other = np.empty((2, 181), dtype=np.float32)
            scans.scan((x, y, 0.1), make_beams(angles), 20.0, whole, NOTHING, 1, one)
            scans.scan((x, y, 0.1), make_beams(angles), 20.0, blocks, NOTHING, 1, other)
            assert one.tobytes() == other.tobytes()


def test_far_from_the_origin_it_is_as_exact() -> None:
    """Single precision would be wrong by centimetres here."""
    ends = walls(50)
    near, far = np.empty((2, 19), dtype=np.float32)
    rays = make_beams(np.linspace(-3, 3, 19))
    scans.scan((0.0, 0.0, 0.0), rays, 6.0, make_wall_blocks(ends), NOTHING, 1, near)
    moved = make_wall_blocks(ends + 1e6)
    scans.scan((1e6, 1e6, 0.0), rays, 6.0, moved, NOTHING, 1, far)
    assert far == pytest.approx(near, abs=1e-5, nan_ok=True)


def test_shapes_hide_walls_by_their_layers_but_not_around_the_sensor() -> None:
    shapes = kernels.Shapes(
        np.array([[2.0, 0.0, 0.5], [0.0, 0.1, 1.0]]),  # one ahead, one around the sensor
        np.array([1, 7]),
        np.vstack([SQUARE + np.array([0.0, 3.0]), SQUARE * 0.5]),  # one to the left, one around
        np.array([0, 4, 8]),
        np.array([2, 7]),
    )
    room = make_wall_blocks(np.array([[-5.0, 5, 5, 5], [5, 5, 5, -5]]))
    seen = {}
    for bits in (1, 2, 3, 4):
        ranges = np.empty(2, dtype=np.float32)
        scans.scan((0.0, 0.0, 0.0), make_beams([0.0, math.pi / 2]), 10.0, room, shapes, bits, ranges)
        seen[bits] = [round(float(r), 5) for r in ranges]
    assert seen == {1: [1.5, 5.0], 2: [5.0, 2.0], 3: [1.5, 2.0], 4: [5.0, 5.0]}


def test_shapes_go_with_their_bodies() -> None:
    local = kernels.Shapes(
        np.array([[1.0, 0.0, 0.5]]), np.array([1]), SQUARE, np.array([0, 4]), np.array([1])
    )
    world = local._replace(circles=local.circles.copy(), corners=local.corners.copy())
    poses = np.array([[5.0, 5.0, 0.0], [0.0, 2.0, math.pi / 2]])
    kernels.place_shapes(
        poses, np.array([1]), np.zeros(4, dtype=np.int64), local.circles, local.corners, world
    )
    assert world.circles == pytest.approx(np.array([[0, 3, 0.5]]))
    assert world.corners == pytest.approx(SQUARE + 5)


@pytest.mark.long
def test_what_is_kept_on_disk_holds_until_any_file_of_kernels_is_edited() -> None:
    files = {file.name for file in Path(kernels.__file__).parent.glob("*.py")}
    assert {"kernels.py", "world_kernels.py"} <= files == {name for name, *_ in kernel_cache.SOURCE_STAMP}
    for kernel in (kernels.scan_with, world_kernels.step_worlds, grids.interpolate_tables):
        kept: Any = kernel
        assert kept._cache._cache_file._source_stamp == kernel_cache.SOURCE_STAMP


@pytest.mark.long
def test_compile_kernels_compiles_all_that_a_world_calls() -> None:
    """After it, a run compiles nothing: that would stall the screen for seconds."""
    code = (
        "from kit.kernels import kernels; kernels.compile_kernels();"
        "jitted = {n: f for n, f in vars(kernels).items() if hasattr(f, 'signatures')};"
        "before = {n: list(f.signatures) for n, f in jitted.items()};"
        "import sys; from pathlib import Path; from kit.sim.simulation import load_world;"
        "from kit.sim.simulation import Simulation; from kit.msg.geometry_msgs import Twist, Vector3;"
        "s = Simulation(load_world(sys.argv[1]), seed=1);"
        "s.accept('/r/cmd_vel', Twist(linear=Vector3(x=1.0)));"
        "s.step(3);"
        "print([n for n, f in jitted.items() if list(f.signatures) != before[n]])"
    )
    world = "tests/sim/worlds/laser/driven.world.yaml"
    run = subprocess.run([sys.executable, "-c", code, world], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"


def test_without_a_place_to_remember_it_a_formula_is_compiled_all_the_same(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def nowhere(function: object, stamp: object = None) -> None:
        raise RuntimeError("cannot cache function: no locator available")

    monkeypatch.setattr(compilation, "KernelCache", nowhere)

    def twice(value: float) -> float:
        return 2.0 * value

    assert compilation.jit(twice)(21.0) == 42.0


def test_c_code_can_call_a_function() -> None:
    def twice(value: float) -> float:
        return 2.0 * value

    address = compilation.c_function(twice, "float64(float64)")
    assert ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)(address)(21.0) == 42.0


def test_a_settings_file_of_numbas_in_the_current_folder_is_not_read(tmp_path: Path) -> None:
    """It would name the cache, from which numba unpickles, and the folder may be a student's."""
    (tmp_path / ".numba_config.yaml").write_text(f"cache_dir: {tmp_path / 'cache'}\n")
    code = """
from kit.kernels.compilation import jit
from numba.core import config
print(repr(config.CACHE_DIR))
jit(abs_of := lambda x: abs(x))(1.0)
print(repr(config.CACHE_DIR))
"""
    run = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stderr
    assert str(tmp_path) not in run.stdout
    assert not (tmp_path / "cache").exists()
    control = subprocess.run(
        [sys.executable, "-c", "from numba.core import config; print(config.CACHE_DIR)"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
    )
    assert str(tmp_path) in control.stdout


def test_no_environment_keeps_kernels_from_being_compiled() -> None:
    """As Python they take a hundred times as long, and what a budget of time allows would depend on it."""
    code = "from kit.kernels import kernels; print(hasattr(kernels.twist_step, 'signatures'))"
    for imported, said in (("", "True"), ("import numba; ", "False")):  # numba reads it when it is imported
        run = subprocess.run(
            [sys.executable, "-c", imported + code],
            env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
            capture_output=True,
            text=True,
            check=True,
        )
        assert run.stdout.split() == [said]


def test_what_kernels_do_not_use_is_not_imported_and_can_be_later() -> None:
    code = """
import sys
from kit.kernels import compilation, numba_import
assert compilation.jit(lambda x: x + 1.0)(1.0) == 2.0
print({*numba_import.UNUSED, "pycparser", "unittest"} & {*sys.modules})
import cffi, scipy.linalg
print(scipy.linalg.det([[2.0]]), cffi.FFI().typeof("int").cname)
"""
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    assert run.stdout.split() == ["set()", "2.0", "int"]


def test_kernels_from_the_disk_import_nothing_that_compiles(tmp_path: Path) -> None:
    kernel = tmp_path / "kernel.py"
    kernel.write_text("from kit.kernels.compilation import jit\n@jit\ndef more(x):\n    return x + 1.0\n")
    code = "import sys, kernel; print(kernel.more(1.0), 'numba.np.arraymath' in sys.modules)"
    for said in (["2.0", "True"], ["2.0", "False"]):  # compiled, then read
        run = subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), *filter(None, sys.path)])},
            capture_output=True,
            text=True,
            check=False,
        )
        assert run.stdout.split() == said, run.stderr
