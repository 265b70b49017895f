"""Transforms messages from frame to frame: which function does so for which type, and those of geometry_msgs.

ROS 2 has them in ``tf2_ros.buffer_interface`` and ``tf2_geometry_msgs``; a program imports the latter so that
``Buffer.transform`` knows its types.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, ClassVar

from kit.msg.geometry_msgs import (
    Point,
    PointStamped,
    Pose,
    PoseStamped,
    PoseWithCovarianceStamped,
    Quaternion,
    Transform,
    TransformStamped,
    Vector3,
    Vector3Stamped,
)
from kit.ros.node.time import Duration, Time
from kit.ros.rotations import quaternion_multiply, rotate_vector

if TYPE_CHECKING:
    from kit.msg.builtin_interfaces import Time as TimeMessage

DoTransform = Callable[[Any, TransformStamped], Any]

_NO_WAIT = Duration()


class TypeException(Exception):
    """No function is known that transforms or converts this type."""


class NotImplementedException(Exception):
    """A buffer does not offer this."""


class TransformRegistration:
    """The functions that transform messages, by their type. There is one table in the program."""

    _by_type: ClassVar[dict[type[Any], DoTransform]] = {}

    def add(self, key: type[Any], callback: DoTransform) -> None:
        self._by_type[key] = callback

    def get(self, key: type[Any]) -> DoTransform:
        """Raises TypeException for a type that is not registered."""
        try:
            return self._by_type[key]
        except KeyError:
            raise TypeException(
                f"Type {key.__name__} is not loaded or supported; for geometry_msgs: import tf2_geometry_msgs"
            ) from None


class ConvertRegistration:
    """The functions that convert objects from and to messages, by type. There is one table in the program."""

    _to_msg: ClassVar[dict[type[Any], Callable[[Any], Any]]] = {}
    _from_msg: ClassVar[dict[type[Any], Callable[[Any], Any]]] = {}
    _convert: ClassVar[dict[tuple[type[Any], type[Any]], Callable[[Any], Any]]] = {}

    def add_from_msg(self, key: type[Any], callback: Callable[[Any], Any]) -> None:
        self._from_msg[key] = callback

    def add_to_msg(self, key: type[Any], callback: Callable[[Any], Any]) -> None:
        self._to_msg[key] = callback

    def add_convert(self, key: tuple[type[Any], type[Any]], callback: Callable[[Any], Any]) -> None:
        self._convert[key] = callback

    def get_from_msg(self, key: type[Any]) -> Callable[[Any], Any]:
        return _find(self._from_msg, key, key)

    def get_to_msg(self, key: type[Any]) -> Callable[[Any], Any]:
        return _find(self._to_msg, key, key)

    def get_convert(self, key: tuple[type[Any], type[Any]]) -> Callable[[Any], Any]:
        return _find(self._convert, key, key[1])


def _find(table: dict[Any, Callable[[Any], Any]], key: Any, kind: type[Any]) -> Callable[[Any], Any]:
    """Raises TypeException."""
    if key not in table:
        raise TypeException(f"Type {kind.__name__} is not loaded or supported")
    return table[key]


def convert(a: Any, b_type: type[Any]) -> Any:
    """The object as a ``b_type``, through a message if there is no direct way. Raises TypeException."""
    registration = ConvertRegistration()
    try:
        return registration.get_convert((type(a), b_type))(a)
    except TypeException:
        if isinstance(a, b_type):
            return a
        return registration.get_from_msg(b_type)(registration.get_to_msg(type(a))(a))


class BufferInterface:
    """Transforms stamped messages by the transforms that a subclass looks up."""

    def __init__(self) -> None:
        self.registration = TransformRegistration()

    def lookup_transform(
        self, target_frame: str, source_frame: str, time: Time, timeout: Duration = _NO_WAIT
    ) -> TransformStamped:
        raise NotImplementedException

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
        timeout: Duration = _NO_WAIT,
    ) -> TransformStamped:
        raise NotImplementedException

    def transform(
        self,
        object_stamped: Any,
        target_frame: str,
        timeout: Duration = _NO_WAIT,
        new_type: type[Any] | None = None,
    ) -> Any:
        """The message in ``target_frame``, at its own time; with ``new_type``, converted to that.

        Raises TypeException for a type that no imported package transforms, and what ``lookup_transform`` raises.
        """
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        found = self.lookup_transform(target_frame, header.frame_id, _as_time(header.stamp), timeout)
        result = do_transform(object_stamped, found)
        return result if new_type is None else convert(result, new_type)

    def transform_full(
        self,
        object_stamped: Any,
        target_frame: str,
        target_time: Time,
        fixed_frame: str,
        timeout: Duration = _NO_WAIT,
        new_type: type[Any] | None = None,
    ) -> Any:
        """Transforms as ``transform`` does, to another time; ``fixed_frame`` does not move between the two times."""
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        found = self.lookup_transform_full(
            target_frame, target_time, header.frame_id, _as_time(header.stamp), fixed_frame, timeout
        )
        result = do_transform(object_stamped, found)
        return result if new_type is None else convert(result, new_type)


def _as_time(stamp: TimeMessage) -> Time:
    return Time.from_msg(stamp)


# geometry_msgs


def do_transform_point(point: PointStamped, transform: TransformStamped) -> PointStamped:
    """The point in the frame ``transform.header.frame_id``."""
    result = PointStamped(header=_header(transform))
    result.point = _point(point.point, transform.transform)
    return result


def do_transform_vector3(vector3: Vector3Stamped, transform: TransformStamped) -> Vector3Stamped:
    """The vector, rotated; a vector has no place, so it is not moved."""
    vector = vector3.vector
    x, y, z = rotate_vector(_quaternion(transform.transform.rotation), (vector.x, vector.y, vector.z))
    return Vector3Stamped(header=_header(transform), vector=Vector3(x=x, y=y, z=z))


def do_transform_pose(pose: Pose, transform: TransformStamped) -> Pose:
    """The pose, without a header."""
    if isinstance(pose, PoseStamped):
        raise TypeError(
            "do_transform_pose takes a Pose; for a PoseStamped there is do_transform_pose_stamped"
        )
    turn = quaternion_multiply(_quaternion(transform.transform.rotation), _quaternion(pose.orientation))
    return Pose(
        position=_point(pose.position, transform.transform),
        orientation=Quaternion(**dict(zip("xyzw", map(float, turn), strict=True))),
    )


def do_transform_pose_stamped(pose: PoseStamped, transform: TransformStamped) -> PoseStamped:
    """The pose in the frame ``transform.header.frame_id``."""
    return PoseStamped(header=_header(transform), pose=do_transform_pose(pose.pose, transform))


def do_transform_pose_with_covariance_stamped(
    pose: PoseWithCovarianceStamped, transform: TransformStamped
) -> PoseWithCovarianceStamped:
    """The pose and its covariance in the frame ``transform.header.frame_id``."""
    result = PoseWithCovarianceStamped(header=_header(transform))
    result.pose.pose = do_transform_pose(pose.pose.pose, transform)
    covariance: Any = transform_covariance(pose.pose.covariance.tolist(), transform)
    result.pose.covariance = covariance  # the field takes any sequence of 36 numbers
    return result


def transform_covariance(cov_in: Sequence[float], transform: TransformStamped) -> list[float]:
    """The 6 x 6 covariance, as 36 numbers, with its position and its rotation part rotated."""
    turn = _quaternion(transform.transform.rotation)
    columns = [rotate_vector(turn, axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))]
    rotation = [[columns[j][i] for j in range(3)] for i in range(3)]
    result = [0.0] * 36
    for row in (0, 3):
        for column in (0, 3):
            for i in range(3):
                for j in range(3):
                    result[(row + i) * 6 + column + j] = sum(
                        rotation[i][k] * float(cov_in[(row + k) * 6 + column + m]) * rotation[j][m]
                        for k in range(3)
                        for m in range(3)
                    )
    return result


def to_msg_msg(msg: Any) -> Any:
    """The message itself."""
    return msg


from_msg_msg = to_msg_msg


def register_geometry_messages() -> None:
    """Makes ``Buffer.transform`` and ``convert`` know the types of geometry_msgs."""
    transforms: dict[type[Any], DoTransform] = {
        PointStamped: do_transform_point,
        Vector3Stamped: do_transform_vector3,
        PoseStamped: do_transform_pose_stamped,
        PoseWithCovarianceStamped: do_transform_pose_with_covariance_stamped,
    }
    conversions = ConvertRegistration()
    for cls, function in transforms.items():
        TransformRegistration().add(cls, function)
        conversions.add_to_msg(cls, to_msg_msg)
        conversions.add_from_msg(cls, from_msg_msg)


def _header(transform: TransformStamped) -> Any:
    return transform.header.__deepcopy__(None)


def _quaternion(rotation: Quaternion) -> tuple[float, float, float, float]:
    return rotation.x, rotation.y, rotation.z, rotation.w


def _point(point: Point, transform: Transform) -> Point:
    x, y, z = rotate_vector(_quaternion(transform.rotation), (point.x, point.y, point.z))
    move = transform.translation
    return Point(x=x + move.x, y=y + move.y, z=z + move.z)
