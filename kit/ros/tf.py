"""Transforms between frames: the broadcasters, buffer and listener of ROS 2's ``tf2_ros``."""

from __future__ import annotations

import threading
from bisect import bisect_right
from collections.abc import Callable, Iterable
from contextlib import suppress
from typing import TYPE_CHECKING

from kit.msg.builtin_interfaces import Time as TimeMessage
from kit.msg.geometry_msgs import Quaternion, Transform, TransformStamped, Vector3
from kit.msg.tf2_msgs import TFMessage
from kit.ros.execution.callback_groups import ReentrantCallbackGroup
from kit.ros.execution.context import get_default_context
from kit.ros.execution.executors import ExternalShutdownException, SingleThreadedExecutor
from kit.ros.execution.task import Future
from kit.ros.node.qos import DurabilityPolicy, QoSProfile
from kit.ros.node.time import S_TO_NS, ClockType, Duration, Time
from kit.ros.rotations import quaternion_inverse, quaternion_multiply, quaternion_slerp, rotate_vector
from kit.ros.tf_conversion import BufferInterface

if TYPE_CHECKING:
    from kit.ros.graph.graph import Graph
    from kit.ros.node.node import Node

_DYNAMIC = QoSProfile(depth=100)
_STATIC = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_NOW = Time(clock_type=ClockType.ROS_TIME)
_NO_WAIT = Duration()


class TransformException(Exception):
    """Base class: a transform is not available."""


class LookupException(TransformException):
    """A frame is not known."""


class ConnectivityException(TransformException):
    """Two frames are not in the same tree."""


class ExtrapolationException(TransformException):
    """The time is before the oldest or after the newest known transform."""


class InvalidArgumentException(TransformException):
    """A frame name is empty or begins with a slash."""


class TransformTimeoutException(TransformException):
    """A transform did not come in time: ``tf2_ros.TimeoutException``. Never raised here; programs catch it."""


class Rigid:
    """A translation ``(x, y, z)`` [m] and a rotation ``(x, y, z, w)``."""

    __slots__ = ("rotation", "translation")

    def __init__(
        self,
        translation: tuple[float, float, float] = (0.0, 0.0, 0.0),
        rotation: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0),
    ) -> None:
        self.translation = translation
        self.rotation = rotation

    @classmethod
    def from_msg(cls, message: Transform) -> Rigid:
        t, q = message.translation, message.rotation
        return cls((t.x, t.y, t.z), (q.x, q.y, q.z, q.w))

    def to_msg(self) -> Transform:
        (x, y, z), (qx, qy, qz, qw) = self.translation, self.rotation
        return Transform(translation=Vector3(x=x, y=y, z=z), rotation=Quaternion(x=qx, y=qy, z=qz, w=qw))

    def then(self, inner: Rigid) -> Rigid:
        """Composes two transforms: ``inner`` is given in this frame, the result in this frame's parent."""
        x, y, z = self.translation
        dx, dy, dz = rotate_vector(self.rotation, inner.translation)
        return Rigid((x + dx, y + dy, z + dz), quaternion_multiply(self.rotation, inner.rotation))

    def inverse(self) -> Rigid:
        back = quaternion_inverse(self.rotation)
        x, y, z = rotate_vector(back, self.translation)
        return Rigid((-x, -y, -z), back)

    def towards(self, other: Rigid, fraction: float) -> Rigid:
        """Interpolates between this transform (0) and the other one (1)."""
        x, y, z = (a + (b - a) * fraction for a, b in zip(self.translation, other.translation, strict=True))
        return Rigid((x, y, z), quaternion_slerp(self.rotation, other.rotation, fraction))


class _Frame:
    """A frame: its parent, and its transforms in the parent by time."""

    def __init__(self, parent: str, *, is_static: bool) -> None:
        self.parent = parent
        self.is_static = is_static
        self.times: list[int] = []
        self.transforms: list[Rigid] = []

    def yaml_lines(self) -> str:
        """The frame's parent, rate [Hz] and times [s], as ROS 2 describes frames."""
        newest, oldest = (self.times[-1], self.times[0]) if self.times else (0, 0)
        length_s = (newest - oldest) / S_TO_NS
        rate = 0.0 if self.is_static or not length_s else (len(self.times) - 1) / length_s
        return (
            f"  parent: '{self.parent}'\n  broadcaster: 'default_authority'\n  rate: {rate:.3f}\n"
            f"  most_recent_transform: {newest / S_TO_NS:.6f}\n  oldest_transform: {oldest / S_TO_NS:.6f}\n"
            f"  buffer_length: {length_s:.3f}\n"
        )

    def add(self, time_ns: int, transform: Rigid, keep_ns: int) -> None:
        if self.is_static:
            self.times, self.transforms = [time_ns], [transform]
            return
        index = bisect_right(self.times, time_ns)
        if index and self.times[index - 1] == time_ns:
            self.transforms[index - 1] = transform
            return
        self.times.insert(index, time_ns)
        self.transforms.insert(index, transform)
        old = bisect_right(self.times, self.times[-1] - keep_ns - 1)
        del self.times[:old], self.transforms[:old]

    def transform_at(self, time_ns: int, name: str) -> Rigid:
        """Its transform at a time, interpolated between known times. Raises ExtrapolationException."""
        times = self.times
        if self.is_static:
            return self.transforms[0]
        if not times[0] <= time_ns <= times[-1]:
            when, edge = ("past", times[0]) if time_ns < times[0] else ("future", times[-1])
            raise ExtrapolationException(
                f"Lookup would require extrapolation into the {when}.  Requested time {time_ns / 1e9:.6f} but the "
                f"{'earliest' if when == 'past' else 'latest'} data for frame '{name}' is at time {edge / 1e9:.6f}"
            )
        index = bisect_right(times, time_ns)
        if times[index - 1] == time_ns:
            return self.transforms[index - 1]
        before, after = times[index - 1], times[index]
        fraction = (time_ns - before) / (after - before)
        return self.transforms[index - 1].towards(self.transforms[index], fraction)


class Buffer(BufferInterface):
    """The tree of frames over the last ten seconds, or over ``cache_time``."""

    def __init__(self, cache_time: Duration | None = None, node: Node | None = None) -> None:
        super().__init__()
        self._keep_ns = (cache_time or Duration(seconds=10)).nanoseconds
        self._node = node
        self._frames: dict[str, _Frame] = {}
        self._lock = threading.Lock()
        """Held while frames are changed or looked up: the thread of a listener may add some meanwhile."""
        self._waited_in: Graph | None = None
        """The graph in which other threads may wait for transforms."""
        self._awaited: list[tuple[Future[bool], Callable[[], bool]]] = []

    def set_transform(self, transform: TransformStamped, authority: str) -> None:
        """Adds the transform of ``child_frame_id`` in ``header.frame_id``. Raises InvalidArgumentException."""
        self._add(transform, is_static=False)

    def set_transform_static(self, transform: TransformStamped, authority: str) -> None:
        """Adds a transform that holds for all times."""
        self._add(transform, is_static=True)

    def clear(self) -> None:
        """Removes all frames."""
        self._frames.clear()

    def lookup_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Time | TimeMessage = _NOW,
        timeout: Duration = _NO_WAIT,
    ) -> TransformStamped:
        """The transform of ``source_frame`` in ``target_frame``; time zero means the newest common time.

        A message's stamp will do as the time, here as in the methods below.

        Waits up to ``timeout`` for it; in a callback that the transforms have to wait for, in vain. Raises
        LookupException, ConnectivityException, ExtrapolationException, InvalidArgumentException.
        """
        if timeout.nanoseconds > 0:
            self._wait_for(target_frame, source_frame, time, timeout)
        return self._lookup(target_frame, source_frame, time)

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Time | TimeMessage = _NOW,
        timeout: Duration = _NO_WAIT,
        return_debug_tuple: bool = False,
    ) -> bool | tuple[bool, str]:
        """True if ``lookup_transform`` would succeed; with ``return_debug_tuple`` also the reason if not."""
        if timeout.nanoseconds > 0:
            self._wait_for(target_frame, source_frame, time, timeout)
        try:
            self._lookup(target_frame, source_frame, time)
        except TransformException as problem:
            return (False, str(problem)) if return_debug_tuple else False
        return (True, "") if return_debug_tuple else True

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Time | TimeMessage,
        source_frame: str,
        source_time: Time | TimeMessage,
        fixed_frame: str,
        timeout: Duration = _NO_WAIT,
    ) -> TransformStamped:
        """The transform of ``source_frame`` at one time in ``target_frame`` at another; ``fixed_frame`` does not move
        between the two. Raises what ``lookup_transform`` raises."""
        there = self.lookup_transform(target_frame, fixed_frame, target_time, timeout)
        here = self.lookup_transform(fixed_frame, source_frame, source_time, timeout)
        result = TransformStamped(header=there.header, child_frame_id=source_frame)
        result.transform = Rigid.from_msg(there.transform).then(Rigid.from_msg(here.transform)).to_msg()
        return result

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Time | TimeMessage,
        source_frame: str,
        source_time: Time | TimeMessage,
        fixed_frame: str,
        timeout: Duration = _NO_WAIT,
        return_debug_tuple: bool = False,
    ) -> bool | tuple[bool, str]:
        """True if ``lookup_transform_full`` would succeed; with ``return_debug_tuple`` also the reason if not."""
        try:
            self.lookup_transform_full(
                target_frame, target_time, source_frame, source_time, fixed_frame, timeout
            )
        except TransformException as problem:
            return (False, str(problem)) if return_debug_tuple else False
        return (True, "") if return_debug_tuple else True

    def wait_for_transform_async(
        self, target_frame: str, source_frame: str, time: Time | TimeMessage
    ) -> Future[bool]:
        """A future that is done as soon as the transform can be looked up."""
        future: Future[bool] = Future()

        def is_there() -> bool:
            return self.can_transform(target_frame, source_frame, time) is True

        if is_there():
            future.set_result(True)
        else:
            self._awaited.append((future, is_there))
        return future

    async def lookup_transform_async(
        self, target_frame: str, source_frame: str, time: Time | TimeMessage
    ) -> TransformStamped:
        """Awaits the transform, in a coroutine callback."""
        await self.wait_for_transform_async(target_frame, source_frame, time)
        return self.lookup_transform(target_frame, source_frame, time)

    def all_frames_as_string(self) -> str:
        """Each frame and its parent, as sentences."""
        return "".join(
            f"Frame {name} exists with parent {frame.parent}.\n" for name, frame in self._frames.items()
        )

    def all_frames_as_yaml(self) -> str:
        """Each frame with its parent, and how often and how lately it was told; static ones have no rate."""
        return (
            "".join(f"{name}:\n{frame.yaml_lines()}" for name, frame in sorted(self._frames.items())) or "{}"
        )

    def _add(self, transform: TransformStamped, *, is_static: bool) -> None:
        child, parent = transform.child_frame_id.lstrip("/"), transform.header.frame_id.lstrip("/")
        if not child or not parent or child == parent:
            raise InvalidArgumentException(
                f"a transform from '{parent}' to '{child}': two different names are needed"
            )
        stamp = Time.from_msg(transform.header.stamp).nanoseconds
        with self._lock:
            frame = self._frames.get(child)
            if frame is None or frame.parent != parent or frame.is_static != is_static:
                frame = self._frames[child] = _Frame(parent, is_static=is_static)
            frame.add(stamp, Rigid.from_msg(transform.transform), self._keep_ns)
        if (
            self._waited_in is not None
        ):  # without the lock: who waits looks for the transform with the graph's
            self._waited_in.notify()
        if self._awaited:
            self._finish_awaited()

    def _finish_awaited(self) -> None:
        """Finishes the futures whose transform is there now."""
        ready = [future for future, is_there in self._awaited if not future.done() and is_there()]
        self._awaited = [entry for entry in self._awaited if not entry[0].done() and entry[0] not in ready]
        for future in ready:
            future.set_result(True)

    def _wait_for(self, target: str, source: str, time: Time | TimeMessage, timeout: Duration) -> None:
        graph = get_default_context().graph if self._node is None else self._node.handle.graph
        work = graph.thread_state.work
        if work is not None and work[0].is_exclusive and graph.waiter is None:
            return  # time cannot pass in it
        until = graph.now_ns + timeout.nanoseconds
        self._waited_in = graph
        graph.wait(lambda: self.can_transform(target, source, time) is True, until, what="lookup_transform()")

    def _lookup(self, target: str, source: str, time: Time | TimeMessage) -> TransformStamped:
        with self._lock:
            return self._combined(target, source, time)

    def _combined(self, target: str, source: str, time: Time | TimeMessage) -> TransformStamped:
        up, down = self._paths(target, source)
        wanted = (Time.from_msg(time) if isinstance(time, TimeMessage) else time).nanoseconds
        if wanted == 0:
            newest = [
                self._frames[name].times[-1] for name in (*up, *down) if not self._frames[name].is_static
            ]
            wanted = min(newest, default=0)
        result = TransformStamped(child_frame_id=source)
        result.header.frame_id = target
        result.header.stamp = Time(nanoseconds=wanted).to_msg()
        result.transform = self._chain(up, wanted).inverse().then(self._chain(down, wanted)).to_msg()
        return result

    def _chain(self, path: list[str], time_ns: int) -> Rigid:
        """The transform of the first frame of a path in the parent of its last."""
        transform = Rigid()
        for name in path:
            transform = self._frames[name].transform_at(time_ns, name).then(transform)
        return transform

    def _paths(self, target: str, source: str) -> tuple[list[str], list[str]]:
        """The frames from target and from source up to their common ancestor, without it."""
        for name in (target, source):
            if not name or name.startswith("/"):
                raise InvalidArgumentException(
                    f"Invalid argument '{name}': a frame name is not empty and has no slash"
                )
            if name not in self._frames and all(frame.parent != name for frame in self._frames.values()):
                raise LookupException(f'"{name}" passed to lookupTransform does not exist.')
        up, down = self._ancestors(target), self._ancestors(source)
        if up[-1] != down[-1]:
            raise ConnectivityException(
                f"Could not find a connection between '{target}' and '{source}' because they are not part of the same "
                "tree. Tf has two or more unconnected trees."
            )
        while up and down and up[-1] == down[-1]:
            up.pop()
            down.pop()
        return up, down

    def _ancestors(self, name: str) -> list[str]:
        """The frame, its parent, and so on up to the root."""
        way = [name]
        while name in self._frames:
            name = self._frames[name].parent
            if name in way:
                raise ConnectivityException(f"the frames {', '.join(way)} are each other's parents")
            way.append(name)
        return way


class TransformListener:
    """Fills a buffer with the transforms of ``/tf`` and ``/tf_static`` while the node is spun."""

    def __init__(
        self,
        buffer: Buffer,
        node: Node,
        *,
        spin_thread: bool = False,
        qos: QoSProfile | int | None = None,
        static_qos: QoSProfile | int | None = None,
    ) -> None:
        self.buffer = buffer
        self.node = node
        self.group = ReentrantCallbackGroup()
        self.tf_sub = node.create_subscription(
            TFMessage, "/tf", self.callback, _DYNAMIC if qos is None else qos, callback_group=self.group
        )
        static = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.tf_static_sub = node.create_subscription(
            TFMessage,
            "/tf_static",
            self.static_callback,
            static if static_qos is None else static_qos,
            callback_group=self.group,
        )
        if spin_thread:
            self.executor = SingleThreadedExecutor(context=node.context)
            self.dedicated_listener_thread = threading.Thread(target=self._spin, name="tf-listener")
            self.dedicated_listener_thread.start()

    def _spin(self) -> None:
        """Spins the node, so that another thread may wait for transforms, until the context is shut down."""
        with suppress(ExternalShutdownException):
            self.executor.add_node(self.node)
            self.executor.spin()
            self.executor.remove_node(self.node)

    def unregister(self) -> None:
        """Stops spinning and destroys the subscriptions."""
        if hasattr(self, "executor"):
            self.executor.shutdown()
        self.node.destroy_subscription(self.tf_sub)
        self.node.destroy_subscription(self.tf_static_sub)

    def callback(self, data: TFMessage) -> None:
        for transform in data.transforms:
            self.buffer.set_transform(transform, "default_authority")

    def static_callback(self, data: TFMessage) -> None:
        for transform in data.transforms:
            self.buffer.set_transform_static(transform, "default_authority")


class TransformBroadcaster:
    """Publishes transforms on ``/tf``."""

    def __init__(self, node: Node, qos: QoSProfile | int = _DYNAMIC) -> None:
        self.pub_tf = node.create_publisher(TFMessage, "/tf", qos)

    def sendTransform(self, transform: TransformStamped | Iterable[TransformStamped]) -> None:  # noqa: N802 - ROS's name
        """Publishes one transform, or a list of them."""
        self.pub_tf.publish(TFMessage(transforms=_as_list(transform)))


class StaticTransformBroadcaster:
    """Publishes transforms that hold for all times on ``/tf_static``, also to later subscriptions."""

    def __init__(self, node: Node, qos: QoSProfile | int | None = None) -> None:
        self.pub_tf = node.create_publisher(TFMessage, "/tf_static", _STATIC if qos is None else qos)
        self.net_message = TFMessage()

    def sendTransform(self, transform: TransformStamped | Iterable[TransformStamped]) -> None:  # noqa: N802 - ROS's name
        """Publishes one transform, or a list of them; those of other frames published before stay valid."""
        new = _as_list(transform)
        children = {entry.child_frame_id for entry in new}
        kept = [entry for entry in self.net_message.transforms if entry.child_frame_id not in children]
        self.net_message.transforms = kept + new
        self.pub_tf.publish(self.net_message)


def _as_list(transform: TransformStamped | Iterable[TransformStamped]) -> list[TransformStamped]:
    return [transform] if isinstance(transform, TransformStamped) else list(transform)
