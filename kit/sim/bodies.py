"""The bodies of a model as pymunk has them, and as plugins handle them.

A drive's velocity is the chord of the exact arc, so that where a robot gets to does not depend on the length
of the step, and turning on the spot does not drift.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache, partial
from typing import Any

import pymunk
from pymunk._chipmunk_cffi import ffi
from pymunk._chipmunk_cffi import lib as chipmunk  # pymunk's properties cost several times what they call

from kit.geometry import Pose
from kit.kernels import compilation, kernels
from kit.world.records import Body

_make_pose: Callable[[tuple[float, float, float]], Pose] = partial(tuple.__new__, Pose)
"""As ``Pose(x, y, theta)``, in a third of the time."""
_position, _angle = chipmunk.cpBodyGetPosition, chipmunk.cpBodyGetAngle
_velocity, _set_velocity = chipmunk.cpBodyGetVelocity, chipmunk.cpBodySetVelocity
_turn_rate, _set_turn_rate = chipmunk.cpBodyGetAngularVelocity, chipmunk.cpBodySetAngularVelocity
_update_position = chipmunk.cpBodyUpdatePosition

BodyTwist = tuple[float, float, float]
"""Forward and to the left [m/s], turn [rad/s], in a body's own frame."""


@dataclass(eq=False, slots=True)
class RigidBody:
    """One pymunk body: a body of a model, or several that stiff welds make one."""

    body: pymunk.Body
    outer_radius: float
    """Its farthest point from the centre of mass [m]."""
    max_travel: float
    """Longest move at once that cannot pass through a wall [m]."""
    max_speed: float
    """Limit of the commanded speed [m/s]."""
    max_turn_rate: float
    """Limit of the commanded turn rate [rad/s]."""
    is_static: bool
    linear_damping: float
    angular_damping: float
    commanded_twist: BodyTwist | None = None
    """Twist of the centre of mass that a drive commands for the next step; None without a drive."""
    held_pose: Pose | None = None
    """Pose that it keeps during the next step, whatever pushes it; None if it moves freely."""
    center: tuple[float, float] = field(init=False)
    """The centre of mass in its own frame [m]."""
    is_damped: bool = field(init=False)
    _handle: Any = field(init=False)
    """Chipmunk's own body."""
    _pose: Pose | None = field(init=False, default=None)
    """Its pose, until it moves: to ask pymunk takes longer."""

    def __post_init__(self) -> None:
        x, y = self.body.center_of_gravity
        self.center = x, y
        self.is_damped = bool(self.linear_damping or self.angular_damping)
        self._handle = self.body._body

    @property
    def pose(self) -> Pose:
        """Of its origin, in the world."""
        if self._pose is None:
            place = _position(self._handle)
            self._pose = _make_pose((place.x, place.y, _angle(self._handle)))
        return self._pose

    def set_pose(self, pose: Pose) -> None:
        """Sets the pose; velocities stay."""
        self.body.angle = pose.theta
        self.body.position = pose.x, pose.y
        self._pose = None
        if self.is_static and self.body.space is not None:
            self.body.space.reindex_shapes_for_body(self.body)

    def keep_position(self) -> None:
        """Has Chipmunk leave the pose as it is, without asking Python in each step; see ``Physics.step``."""
        chipmunk.cpBodySetPositionUpdateFunc(self._handle, _stay_put())

    def speed_bound(self) -> float:
        """Returns an upper bound on the speed of its points in the next step [m/s], without impacts."""
        if self.commanded_twist is not None:
            forward, lateral, turn = self.commanded_twist
            return math.hypot(forward, lateral) + abs(turn) * self.outer_radius
        return self._speed() + abs(self.body.angular_velocity) * self.outer_radius

    def _speed(self) -> float:
        velocity = _velocity(self._handle)
        return math.sqrt(velocity.x**2 + velocity.y**2)

    def update_velocity(self, dt: float) -> None:
        """Sets the velocity for the next ``dt``, before contacts act on it."""
        twist = self.commanded_twist
        if twist is not None:
            _set_velocity(self._handle, kernels.mean_velocity(self.pose.theta, *twist, dt))
            _set_turn_rate(self._handle, twist[2])
        if self.is_damped:
            self.body.velocity /= 1.0 + dt * self.linear_damping
            self.body.angular_velocity /= 1.0 + dt * self.angular_damping

    def update_pose(self, dt: float) -> None:
        """Moves with its velocity for ``dt``, after contacts acted on it; at most ``max_travel``."""
        body = self.body
        distance = (self._speed() + abs(_turn_rate(self._handle)) * self.outer_radius) * dt
        if self.held_pose is not None or not math.isfinite(distance):  # the solver gives up on absurd joints
            stay = self.held_pose or self.pose
            body.velocity, body.angular_velocity = (0.0, 0.0), 0.0
            pymunk.Body.update_position(body, dt)  # uses up what pymunk would correct
            self.set_pose(stay)
            return
        if distance > self.max_travel:
            body.velocity *= self.max_travel / distance
            body.angular_velocity *= self.max_travel / distance
        _update_position(self._handle, dt)
        self._pose = None


@dataclass(eq=False, slots=True)
class PhysicalBody:
    """A body of a model in the simulation. Poses and velocities are those of its origin, wherever its mass is."""

    model: str
    description: Body
    rigid: RigidBody
    offset: Pose
    """Its pose in the frame of the rigid body."""
    shapes: list[pymunk.Shape] = field(default_factory=list)
    """One per footprint."""
    _poses: tuple[Pose, Pose] = field(init=False, default=(Pose(), Pose()))
    """A pose of the rigid body, and its own one then."""
    _lever: tuple[float, float, float, float] = field(init=False)
    """Cosine and sine of its angle in the rigid body, and from its origin to the centre of mass there [m]."""

    def __post_init__(self) -> None:
        (x, y), offset = self.rigid.center, self.offset
        self._lever = math.cos(offset.theta), math.sin(offset.theta), x - offset.x, y - offset.y

    @property
    def name(self) -> str:
        return self.description.name

    @property
    def pose(self) -> Pose:
        """In the world."""
        carrier = self.rigid.pose
        if self._poses[0] is not carrier:
            self._poses = carrier, carrier.compose(self.offset)
        return self._poses[1]

    @property
    def velocity(self) -> tuple[float, float, float]:
        """In the world frame: m/s, m/s, rad/s."""
        x, y = self._from_center()
        vx, vy = self.rigid.body.velocity
        turn = self.rigid.body.angular_velocity
        return vx - turn * y, vy + turn * x, turn

    def set_velocity(self, vx: float, vy: float, turn: float) -> None:
        """Sets the velocity in the world frame once; later steps change it as usual."""
        if self.rigid.is_static:  # things in contact would feel it
            return
        x, y = self._from_center()
        self.rigid.body.velocity = (
            clamp(vx + turn * y, self.rigid.max_speed),
            clamp(vy - turn * x, self.rigid.max_speed),
        )
        self.rigid.body.angular_velocity = clamp(turn, self.rigid.max_turn_rate)

    def drive(self, forward: float, lateral: float, turn: float) -> None:
        """Moves the body with this twist for one step, whatever it weighs, as far as contacts let it."""
        forward, lateral = clamp(forward, self.rigid.max_speed), clamp(lateral, self.rigid.max_speed)
        turn = clamp(turn, self.rigid.max_turn_rate)
        cos, sin, x, y = self._lever
        self.rigid.commanded_twist = (
            cos * forward - sin * lateral - turn * y,
            sin * forward + cos * lateral + turn * x,
            turn,
        )

    def set_pose(self, pose: Pose) -> None:
        """Puts the body, and what is stiffly welded to it, there. Velocities stay."""
        self.rigid.set_pose(pose.compose(self.offset.relative(Pose())))

    def hold(self, pose: Pose) -> None:
        """Puts the body there for a whole step, at rest: it passes through what is in its way."""
        self.set_pose(pose)
        self.rigid.held_pose = self.rigid.pose

    def _from_center(self) -> tuple[float, float]:
        """The origin as seen from the centre of mass, in the world frame [m]."""
        cx, cy = self.rigid.center
        theta = self.rigid.body.angle
        return Pose(0.0, 0.0, theta).transform_point(self.offset.x - cx, self.offset.y - cy)


@cache
def _stay_put() -> Any:
    """A function for Chipmunk in place of its position update."""

    def stay(body: int, dt: float) -> None: ...

    return ffi.cast("cpBodyPositionFunc", compilation.c_function(stay, "void(voidptr, float64)"))


def clamp(value: float, limit: float) -> float:
    """Returns ``value`` limited to [-limit, limit]."""
    return value if -limit <= value <= limit else min(max(value, -limit), limit)
