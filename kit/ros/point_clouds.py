"""Reads and makes point clouds with NumPy: ROS 2's ``sensor_msgs_py.point_cloud2``."""

from __future__ import annotations

import sys
from array import array
from collections import namedtuple
from collections.abc import Iterable, Sequence
from typing import Any, Final

import numpy as np
from numpy.lib.recfunctions import structured_to_unstructured, unstructured_to_structured
from numpy.typing import NDArray

from kit.msg.sensor_msgs import PointCloud2, PointField
from kit.msg.std_msgs import Header
from kit.plain_text import counted

DUMMY_FIELD_PREFIX: Final = "unnamed_field"

_DATATYPES: Final[dict[int, Any]] = {
    PointField.INT8: np.dtype(np.int8),
    PointField.UINT8: np.dtype(np.uint8),
    PointField.INT16: np.dtype(np.int16),
    PointField.UINT16: np.dtype(np.uint16),
    PointField.INT32: np.dtype(np.int32),
    PointField.UINT32: np.dtype(np.uint32),
    PointField.FLOAT32: np.dtype(np.float32),
    PointField.FLOAT64: np.dtype(np.float64),
}


def read_points(
    cloud: PointCloud2,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[Any] | None = None,
    reshape_organized_cloud: bool = False,
) -> NDArray[Any]:
    """The points as a structured array with a field for each of ``field_names``, by default all of the cloud's.

    ``skip_nans`` drops points with a NaN in one of them. ``uvs``: only the points at these indices, or at these
    ``(column, row)``. ``reshape_organized_cloud``: of shape ``(height, width)`` if the cloud has rows. Raises ValueError
    for a field that the cloud does not have.
    """
    _check_is_cloud(cloud)
    points = np.ndarray(
        shape=(cloud.width * cloud.height,),
        dtype=dtype_from_fields(cloud.fields, point_step=cloud.point_step),
        buffer=cloud.data,
    )
    if field_names is not None:
        unknown = [name for name in field_names if name not in (points.dtype.names or ())]
        if unknown:
            known = ", ".join(points.dtype.names or ())
            raise ValueError(f"the cloud has no field {', '.join(unknown)}; it has: {known}")
        points = points[list(field_names)]
    if bool(sys.byteorder != "little") != bool(cloud.is_bigendian):
        points = points.byteswap()
    if skip_nans and not cloud.is_dense:
        has_nan = np.zeros(len(points), dtype=bool)
        for name in points.dtype.names or ():
            values = points[name]
            if values.dtype.kind == "f":
                nans = np.isnan(values)
                has_nan |= nans if nans.ndim == 1 else nans.any(axis=tuple(range(1, nans.ndim)))
        points = points[~has_nan]
    if uvs is not None:
        chosen = np.asarray(list(uvs))
        if chosen.ndim == 2:
            chosen = chosen[:, 1] * cloud.width + chosen[:, 0]
        points = points[chosen]
    if reshape_organized_cloud and cloud.height > 1:
        points = points.reshape(cloud.height, cloud.width)
    return points


def read_points_numpy(
    cloud: PointCloud2,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[Any] | None = None,
    reshape_organized_cloud: bool = False,
) -> NDArray[Any]:
    """The points as an array of shape ``(points, fields)``. Raises ValueError if the fields have different types."""
    _check_is_cloud(cloud)
    kinds = {field.datatype for field in cloud.fields if field_names is None or field.name in field_names}
    if len(kinds) > 1:
        raise ValueError("All fields need to have the same datatype. Use `read_points()` otherwise.")
    structured = read_points(cloud, field_names, skip_nans, uvs, reshape_organized_cloud)
    return structured_to_unstructured(structured)


def read_points_list(
    cloud: PointCloud2,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[Any] | None = None,
) -> list[Any]:
    """The points as named tuples."""
    _check_is_cloud(cloud)
    points = read_points(cloud, field_names, skip_nans, uvs)
    make = namedtuple("Point", points.dtype.names or ())  # type: ignore[misc]  # fields known only at run time
    return [make._make(point) for point in points.tolist()]


def dtype_from_fields(fields: Iterable[PointField], point_step: int | None = None) -> np.dtype[Any]:
    """The structured type of points with these fields, of ``point_step`` bytes."""
    names, formats, offsets = [], [], []
    for index, field in enumerate(fields):
        datatype = _DATATYPES[field.datatype]
        name = field.name or f"{DUMMY_FIELD_PREFIX}_{index}"
        count = max(field.count, 1)
        for item in range(count):
            names.append(f"{name}_{item}" if count > 1 else name)
            formats.append(datatype)
            offsets.append(field.offset + item * datatype.itemsize)
    layout: Any = {"names": names, "formats": formats, "offsets": offsets}
    if point_step is not None:
        layout["itemsize"] = point_step
    dtype: np.dtype[Any] = np.dtype(layout)
    return dtype


def create_cloud(
    header: Header, fields: Iterable[PointField], points: Any, step: int | None = None
) -> PointCloud2:
    """A cloud of ``points``: a structured array, or rows of values in the order of the fields.

    ``step`` [bytes] from point to point; by default as close as the fields allow. Rows of rows make an organized cloud.
    """
    fields = list(fields)
    layout = dtype_from_fields(fields, point_step=step)
    if isinstance(points, np.ndarray) and points.dtype.names is not None:
        if points.dtype.names != layout.names:
            raise ValueError(f"the points have the fields {points.dtype.names}, the cloud {layout.names}")
        values = points.astype(layout) if points.dtype != layout else points
    else:
        rows = np.asarray(
            [tuple(point) for point in points] if not isinstance(points, np.ndarray) else points
        )
        if not rows.size:
            rows = rows.reshape(0, len(layout.names or ()))
        if rows.shape[-1] != len(layout.names or ()):
            raise ValueError(
                f"a point has {counted(len(layout.names or ()), 'value')} here, not {rows.shape[-1]}"
            )
        values = unstructured_to_structured(rows, dtype=layout)
    if values.ndim not in (1, 2):
        raise ValueError("Too many dimensions! Points can only be organized in max. two dimensions")
    height = 1 if values.ndim == 1 else values.shape[0]
    width = values.shape[-1]
    # Bytes between the fields are not copied by NumPy; a fresh buffer makes them zero.
    data = np.zeros(values.size, dtype=layout)
    for name in layout.names or ():
        data[name] = values[name].ravel()
    return PointCloud2(
        header=header,
        height=height,
        width=width,
        is_dense=False,
        is_bigendian=sys.byteorder != "little",
        fields=fields,
        point_step=layout.itemsize,
        row_step=layout.itemsize * width,
        data=array("B", data.tobytes()),
    )


def create_cloud_xyz32(header: Header, points: Any, step: int | None = None) -> PointCloud2:
    """A cloud of points ``(x, y, z)`` in single precision."""
    fields = [
        PointField(name=name, offset=4 * index, datatype=PointField.FLOAT32, count=1)
        for index, name in enumerate("xyz")
    ]
    if not isinstance(points, np.ndarray):
        points = np.asarray([tuple(point) for point in points], dtype=np.float32)
    return create_cloud(header, fields, points, step)


def _check_is_cloud(cloud: object) -> None:
    if not isinstance(cloud, PointCloud2):
        raise TypeError(f"a sensor_msgs.msg.PointCloud2 is needed here, not {type(cloud).__name__}")
