"""Rotations as Euler angles, quaternions and matrices, under the names of ROS 2's ``tf_transformations``.

Quaternions are ``(x, y, z, w)``; angles are in radians. ``axes`` names a sequence: ``s`` for static axes, ``r``
for rotating ones, then the three axes in turn: ``sxyz`` is roll, pitch, yaw about the axes of the world.
Only functions that take or return a matrix load numpy.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import reduce
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from kit.arrays import FloatArray

    Matrix = FloatArray

Quaternion = tuple[float, float, float, float]

_TINY = 1e-12


def quaternion_from_euler(ai: float, aj: float, ak: float, axes: str = "sxyz") -> Quaternion:
    """The rotation by three angles about the three axes in turn."""
    first, second, third, rotating = _axes(axes)
    turns = [_about(axis, angle) for axis, angle in ((first, ai), (second, aj), (third, ak))]
    # A turn about a static axis comes before, that is left of, what has been done; one about a rotating axis after.
    return reduce(quaternion_multiply, turns if rotating else turns[::-1])


def euler_from_quaternion(quaternion: Sequence[float], axes: str = "sxyz") -> tuple[float, float, float]:
    """The three angles; the inverse of ``quaternion_from_euler``. The quaternion need not be of unit length."""
    return _euler(_rows(quaternion), axes)


def quaternion_multiply(quaternion1: Sequence[float], quaternion0: Sequence[float]) -> Quaternion:
    """The rotation ``quaternion0`` followed by ``quaternion1``."""
    x0, y0, z0, w0 = quaternion0
    x1, y1, z1, w1 = quaternion1
    return (
        w1 * x0 + x1 * w0 + y1 * z0 - z1 * y0,
        w1 * y0 - x1 * z0 + y1 * w0 + z1 * x0,
        w1 * z0 + x1 * y0 - y1 * x0 + z1 * w0,
        w1 * w0 - x1 * x0 - y1 * y0 - z1 * z0,
    )


def quaternion_conjugate(quaternion: Sequence[float]) -> Quaternion:
    x, y, z, w = quaternion
    return -x, -y, -z, w


def quaternion_inverse(quaternion: Sequence[float]) -> Quaternion:
    x, y, z, w = quaternion
    square = x * x + y * y + z * z + w * w
    return -x / square, -y / square, -z / square, w / square


def quaternion_about_axis(angle: float, axis: Sequence[float]) -> Quaternion:
    """The rotation by ``angle`` about ``axis``, which need not be of unit length."""
    length = math.hypot(*axis)
    sine = math.sin(angle / 2) / length
    return axis[0] * sine, axis[1] * sine, axis[2] * sine, math.cos(angle / 2)


def quaternion_slerp(quat0: Sequence[float], quat1: Sequence[float], fraction: float) -> Quaternion:
    """The rotation at ``fraction`` of the shortest way from ``quat0`` (0) to ``quat1`` (1), at a steady speed."""
    a, b = _unit(quat0), _unit(quat1)
    dot = math.fsum(p * q for p, q in zip(a, b, strict=True))
    if dot < 0:  # the same rotation, written so that the way to it is the short one
        dot, b = -dot, (-b[0], -b[1], -b[2], -b[3])
    angle = math.acos(min(1.0, dot))
    if angle < 1e-6:
        before, after = 1 - fraction, fraction
    else:
        before, after = (math.sin(part * angle) / math.sin(angle) for part in (1 - fraction, fraction))
    return _unit([before * p + after * q for p, q in zip(a, b, strict=True)])


def rotate_vector(quaternion: Sequence[float], vector: Sequence[float]) -> tuple[float, float, float]:
    """The vector, turned."""
    rows = _rows(quaternion)
    x, y, z = (math.fsum(a * b for a, b in zip(row, vector, strict=True)) for row in rows)
    return x, y, z


def quaternion_matrix(quaternion: Sequence[float]) -> Matrix:
    """The rotation as a (4, 4) homogeneous matrix."""
    matrix = identity_matrix()
    matrix[:3, :3] = _rows(quaternion)
    return matrix


def quaternion_from_matrix(matrix: Any) -> Quaternion:
    """The rotation in the upper left (3, 3) of a matrix."""
    return quaternion_from_euler(*euler_from_matrix(matrix))


def euler_matrix(ai: float, aj: float, ak: float, axes: str = "sxyz") -> Matrix:
    """Converts as ``quaternion_from_euler`` does, to a (4, 4) homogeneous matrix."""
    return quaternion_matrix(quaternion_from_euler(ai, aj, ak, axes))


def euler_from_matrix(matrix: Any, axes: str = "sxyz") -> tuple[float, float, float]:
    """The three angles of the rotation in the upper left (3, 3) of a matrix."""
    return _euler([[float(matrix[row][column]) for column in range(3)] for row in range(3)], axes)


def identity_matrix() -> Matrix:
    """(4, 4)."""
    import numpy

    return numpy.identity(4)


def translation_matrix(direction: Sequence[float]) -> Matrix:
    """The translation by ``(x, y, z)`` as a (4, 4) homogeneous matrix."""
    matrix = identity_matrix()
    matrix[:3, 3] = direction[:3]
    return matrix


def translation_from_matrix(matrix: Any) -> Matrix:
    """The ``(x, y, z)`` of a homogeneous matrix."""
    import numpy

    return numpy.array(matrix, dtype=float)[:3, 3].copy()


def concatenate_matrices(*matrices: Any) -> Matrix:
    """Their product, from left to right."""
    return reduce(lambda left, right: left @ right, matrices, identity_matrix())


def inverse_matrix(matrix: Any) -> Matrix:
    import numpy

    return numpy.linalg.inv(matrix)


def vector_norm(data: Sequence[float]) -> float:
    return math.hypot(*data)


def unit_vector(data: Sequence[float]) -> Matrix:
    import numpy

    array = numpy.array(data, dtype=float)
    unit: Matrix = array / numpy.linalg.norm(array)
    return unit


def _unit(quaternion: Sequence[float]) -> Quaternion:
    length = math.hypot(*quaternion)
    x, y, z, w = (part / length for part in quaternion)
    return x, y, z, w


def _about(axis: int, angle: float) -> Quaternion:
    parts = [0.0, 0.0, 0.0]
    parts[axis] = math.sin(angle / 2)
    return parts[0], parts[1], parts[2], math.cos(angle / 2)


def _axes(axes: str) -> tuple[int, int, int, bool]:
    """The axes of a sequence as 0, 1, 2, and whether they rotate. ValueError if there is no such sequence."""
    name = axes.lower()
    numbers = ["xyz".find(letter) for letter in name[1:]]
    if len(name) != 4 or name[0] not in "sr" or -1 in numbers or numbers[1] in (numbers[0], numbers[2]):
        raise ValueError(
            f"there is no axis sequence '{axes}'; write s or r and three axes, as in 'sxyz' or 'rzyz'"
        )
    return numbers[0], numbers[1], numbers[2], name[0] == "r"


def _rows(quaternion: Sequence[float]) -> list[list[float]]:
    """The rotation matrix; the quaternion's length does not matter, a zero one turns nothing."""
    x, y, z, w = quaternion
    square = x * x + y * y + z * z + w * w
    s = 2 / square if square > _TINY else 0.0
    return [
        [1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
        [s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)],
        [s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)],
    ]


def _euler(m: Sequence[Sequence[float]], axes: str) -> tuple[float, float, float]:
    """Reads the angles off the matrix of three turns about static axes ``i``, ``j`` and ``k`` or again ``i``."""
    first, second, third, rotating = _axes(axes)
    # Turns about rotating axes are those about static ones in the opposite order.
    i, j, last = (third, second, first) if rotating else (first, second, third)
    k = 3 - i - j
    sign = 1 if (j - i) % 3 == 1 else -1
    if last == i:
        a, c = math.atan2(m[i][j], sign * m[i][k]), math.atan2(m[j][i], -sign * m[k][i])
        sine = math.hypot(m[i][j], m[i][k])
        b = math.atan2(sine, m[i][i])
        locked = sine < _TINY
    else:
        a, c = math.atan2(sign * m[k][j], m[k][k]), math.atan2(sign * m[j][i], m[i][i])
        cosine = math.hypot(m[i][i], m[j][i])
        b = math.atan2(-sign * m[k][i], cosine)
        locked = cosine < _TINY
    if locked:  # the first and the last axis are one: the whole turn counts for the first
        a, c = math.atan2(-sign * m[j][k], m[j][j]), 0.0
    return (c, b, a) if rotating else (a, b, c)
