"""sensor_msgs_py.point_cloud2: point clouds from and to NumPy."""

from __future__ import annotations

import struct
from array import array

import numpy as np
import pytest

from kit.msg.sensor_msgs import PointCloud2, PointField
from kit.msg.std_msgs import Header
from kit.ros.point_clouds import (
    create_cloud,
    create_cloud_xyz32,
    dtype_from_fields,
    read_points,
    read_points_list,
    read_points_numpy,
)

HEADER = Header(frame_id="laser")
POINTS = [(1.0, 2.0, 3.0), (4.0, float("nan"), 6.0), (7.0, 8.0, 9.0)]
FIELDS = [
    PointField(name="x", offset=0, datatype=PointField.FLOAT32, count=1),
    PointField(name="rgb", offset=4, datatype=PointField.UINT8, count=3),
    PointField(name="time", offset=8, datatype=PointField.FLOAT64, count=1),
]


def test_the_bytes_are_those_of_the_points() -> None:
    cloud = create_cloud_xyz32(HEADER, POINTS)
    assert bytes(cloud.data) == struct.pack("<9f", *(value for point in POINTS for value in point))
    assert (cloud.point_step, cloud.row_step, cloud.width, cloud.height) == (12, 36, 3, 1)
    assert [field.name for field in cloud.fields] == ["x", "y", "z"]
    assert (cloud.header, cloud.is_bigendian) == (HEADER, False)


def test_points_come_back() -> None:
    cloud = create_cloud_xyz32(HEADER, POINTS)
    read = read_points(cloud)
    assert read.dtype.names == ("x", "y", "z")
    np.testing.assert_array_equal(read["x"], [1, 4, 7])
    np.testing.assert_array_equal(read_points_numpy(cloud, ["z", "x"])[0], [3, 1])
    assert read_points_list(cloud, skip_nans=True)[1].z == 9.0
    assert len(read_points(cloud, ["x", "z"], skip_nans=True)) == 3
    assert read_points(cloud, uvs=[2, 0])["x"].tolist() == [7, 1]


def test_mixed_types_and_gaps() -> None:
    points = [(0.5, 1, 2, 3, 1e-9), (1.5, 4, 5, 6, 2e-9)]
    cloud = create_cloud(HEADER, FIELDS, points, step=20)
    assert cloud.point_step == 20
    assert bytes(cloud.data)[20:40] == struct.pack("<f3Bxd4x", 1.5, 4, 5, 6, 2e-9)
    assert read_points_list(cloud)[0]._fields == ("x", "rgb_0", "rgb_1", "rgb_2", "time")
    assert [tuple(point) for point in read_points_list(cloud)] == points
    assert dtype_from_fields(FIELDS).itemsize == 16
    with pytest.raises(ValueError, match="same datatype"):
        read_points_numpy(cloud)
    again = create_cloud(HEADER, FIELDS, read_points(cloud))
    assert read_points_list(again) == read_points_list(cloud)


def test_organized_clouds() -> None:
    cloud = create_cloud_xyz32(HEADER, np.arange(18, dtype=np.float32).reshape(2, 3, 3))
    assert (cloud.height, cloud.width, cloud.row_step) == (2, 3, 36)
    assert read_points(cloud, reshape_organized_cloud=True).shape == (2, 3)
    assert read_points(cloud, ["x"], uvs=[(2, 1)])["x"].tolist() == [15]


def test_a_big_endian_cloud_is_read() -> None:
    field = PointField(name="x", datatype=PointField.FLOAT32, count=1)
    cloud = PointCloud2(
        width=1,
        height=1,
        fields=[field],
        point_step=4,
        is_bigendian=True,
        data=array("B", struct.pack(">f", 2.5)),
    )
    assert read_points(cloud)["x"].tolist() == [2.5]


def test_an_empty_cloud_and_mistakes() -> None:
    cloud = create_cloud_xyz32(HEADER, [])
    assert (cloud.width, len(read_points(cloud))) == (0, 0)
    with pytest.raises(ValueError, match="no field w; it has: x, y, z"):
        read_points(cloud, ["x", "w"])
    with pytest.raises(ValueError, match="3 values"):
        create_cloud_xyz32(HEADER, [(1.0, 2.0)])
    with pytest.raises(TypeError, match="PointCloud2"):
        read_points(HEADER)  # type: ignore[arg-type]  # the mistake
