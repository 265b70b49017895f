"""The bodies of a model: how they are made of its description, as pymunk has them, and as plugins handle them.

Dynamic bodies that a stiff weld (``frequency: 0``) joins become **one** rigid body, at once at its anchors. Box2D's
welds give way a little, so that in Flatland a robot lags behind its own wheels; and one body is quicker than
three. They stay apart, pulling at each other as in Flatland, where two of them overlap and would collide, or where
they are damped differently.

A drive's velocity is the chord of the exact arc, so that where a robot gets to does not depend on the length
of the step, and turning on the spot does not drift.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cache, partial
from typing import Any

import pymunk
from pymunk._chipmunk_cffi import ffi
from pymunk._chipmunk_cffi import lib as chipmunk  # pymunk's properties cost several times what they call

from kit.geometry import Pose
from kit.kernels import compilation, kernels
from kit.world.records import Body, Circle, Footprint, Joint, Model

ERROR_BIAS = 0.5**100
"""Share of a contact's or joint's error left after a second: half of it goes every 10 ms."""

MAX_TRAVEL, MAX_ROTATION = 2.0, math.pi / 2
"""Nothing is driven farther in a step [m, rad]: Box2D's limits, which are 200 m/s at steps of 0.01 s."""

MIN_MASS, MIN_GYRATION = 1e-15, 1e-6
"""Bodies lighter than this [kg] count as massless, and no radius of gyration is smaller [m]: else the solver overflows."""

RESTITUTION_TYPE = 1
"""pymunk's collision type of footprints with restitution."""

_BODY_TYPES = {
    "dynamic": pymunk.Body.DYNAMIC,
    "kinematic": pymunk.Body.KINEMATIC,
    "static": pymunk.Body.STATIC,
}

_TRAVEL_SHARE = 0.4
"""A stride, as a share of the thinnest footprint: at half of it, a wall could end up behind the middle."""

WeldedGroup = dict[str, Pose]
"""Names of bodies that move as one, and their poses in the frame of the first."""

_make_pose: Callable[[tuple[float, float, float]], Pose] = partial(tuple.__new__, Pose)
"""Makes a pose as ``Pose(x, y, theta)`` does, in a third of the time."""
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
        """Pose of its origin in the world."""
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
        x, y = velocity.x, velocity.y
        return math.sqrt(x * x + y * y)

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
        """The body's pose in the world frame: m, m, rad."""
        carrier = self.rigid.pose
        if self._poses[0] is not carrier:
            self._poses = carrier, carrier.compose(self.offset)
        return self._poses[1]

    @property
    def velocity(self) -> tuple[float, float, float]:
        """The body's velocity in the world frame: m/s, m/s, rad/s."""
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
        """Moves the body, and all bodies stiffly welded to it, to a pose. Velocities stay."""
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


@dataclass(frozen=True, slots=True)
class ModelAssembly:
    """A model as pymunk bodies and constraints."""

    bodies: tuple[PhysicalBody, ...]
    """Bodies in the order of the file."""
    rigid_bodies: tuple[RigidBody, ...]
    constraints: tuple[pymunk.Constraint, ...]
    never_touching: frozenset[frozenset[PhysicalBody]]
    """Pairs of bodies whose joint keeps them from colliding."""


def assemble_model(model: Model, step_size: float) -> ModelAssembly:
    """Builds a model's bodies, shapes and joints, in no space yet. ``step_size`` [s] bounds speed and stiffness."""
    described = {body.name: body for body in model.bodies}
    built: dict[str, PhysicalBody] = {}
    rigids = []
    for group in _welded_groups(model):
        members = [(described[name], offset) for name, offset in group.items()]
        rigid, bodies = _build_rigid_body(model.name, members, step_size)
        rigid.set_pose(model.pose.compose(members[0][0].pose))
        rigids.append(rigid)
        built |= {body.name: body for body in bodies}
    constraints: list[pymunk.Constraint] = []
    for joint in model.joints:
        a, b = (built[anchor.body] for anchor in joint.anchors)
        if a.rigid is not b.rigid and not _are_both_fixed(a, b):
            constraints += _constraints(joint, a, b, step_size)
    return ModelAssembly(
        bodies=tuple(built[body.name] for body in model.bodies),
        rigid_bodies=tuple(rigids),
        constraints=tuple(constraints),
        never_touching=frozenset(
            frozenset(built[anchor.body] for anchor in joint.anchors)
            for joint in model.joints
            if not joint.collide_connected
        ),
    )


# Groups of welded bodies


def _welded_groups(model: Model) -> list[WeldedGroup]:
    """The model's bodies, in groups that move as one. The first weld found decides the pose of a body."""
    described = {body.name: body for body in model.bodies}
    welded: dict[str, list[tuple[str, Pose]]] = {name: [] for name in described}
    for joint in model.joints:
        if _is_stiff(joint, described):
            for a, b, offset in _weld_offsets(joint):
                welded[a].append((b, offset))
    groups: list[WeldedGroup] = []
    seen: set[str] = set()
    for name in described:
        if name in seen:
            continue
        group = {name: Pose()}
        waiting = [name]
        for a in waiting:
            for b, offset in welded[a]:
                if b not in group:
                    group[b] = group[a].compose(offset)
                    waiting.append(b)
        seen |= group.keys()
        groups += (
            [{one: Pose()} for one in group] if _has_overlap(group, described, model.joints) else [group]
        )
    return groups


def _is_stiff(joint: Joint, described: dict[str, Body]) -> bool:
    a, b = (described[anchor.body] for anchor in joint.anchors)
    same_damping = (a.linear_damping, a.angular_damping) == (b.linear_damping, b.angular_damping)
    return joint.kind == "weld" and joint.frequency == 0 and a.kind == b.kind == "dynamic" and same_damping


def _weld_offsets(joint: Joint) -> tuple[tuple[str, str, Pose], ...]:
    """Yields, for either body of a weld, the other one and its pose in the first one's frame."""
    (a, (ax, ay)), (b, (bx, by)) = ((anchor.body, anchor.point) for anchor in joint.anchors)
    offset = Pose(ax, ay, joint.angle).compose(Pose(-bx, -by))
    return (a, b, offset), (b, a, offset.relative(Pose()))


def _has_overlap(group: WeldedGroup, described: dict[str, Body], joints: Iterable[Joint]) -> bool:
    """Returns whether two bodies of the group overlap and may collide."""
    apart = {
        frozenset(anchor.body for anchor in joint.anchors) for joint in joints if not joint.collide_connected
    }
    space = pymunk.Space()
    owners: dict[pymunk.Shape, str] = {}
    for name, offset in group.items():
        for footprint in described[name].footprints:
            shape = _build_shape(space.static_body, footprint, offset)
            for overlapping in space.shape_query(shape):  # only those that its layers let it collide with
                other = owners.get(overlapping.shape, name)
                if other != name and frozenset((other, name)) not in apart:
                    return True
            owners[shape] = name
            space.add(shape)
    return False


# Bodies and shapes


def _build_rigid_body(
    model: str, members: list[tuple[Body, Pose]], step_size: float
) -> tuple[RigidBody, list[PhysicalBody]]:
    """One rigid body of the members, at the origin."""
    first = members[0][0]
    body = pymunk.Body(body_type=_BODY_TYPES[first.kind])
    body.position_func = _keep_position
    shapes = [
        [_build_shape(body, footprint, offset) for footprint in member.footprints]
        for member, offset in members
    ]
    if first.kind == "dynamic":
        masses = [
            (shape, footprint.density * shape.area)
            for (member, _), own in zip(members, shapes, strict=True)
            for footprint, shape in zip(member.footprints, own, strict=True)
        ]
        _set_mass(body, masses)
    solid = [f for member, _ in members for f in member.footprints if f.mask and not f.sensor]
    rigid = RigidBody(
        body=body,
        outer_radius=max(
            (_farthest_distance(shape, body.center_of_gravity) for s in shapes for shape in s), default=0.0
        ),
        max_travel=_TRAVEL_SHARE * min((_narrowest_gap(footprint) for footprint in solid), default=math.inf),
        max_speed=MAX_TRAVEL / step_size,
        max_turn_rate=MAX_ROTATION / step_size,
        is_static=first.kind == "static",
        linear_damping=first.linear_damping if first.kind == "dynamic" else 0.0,
        angular_damping=first.angular_damping if first.kind == "dynamic" else 0.0,
    )
    bodies = [
        PhysicalBody(model, member, rigid, offset, own)
        for (member, offset), own in zip(members, shapes, strict=True)
    ]
    return rigid, bodies


def _keep_position(body: pymunk.Body, dt: float) -> None:
    """Replaces pymunk's position update: ``Physics.step`` moves bodies after the contacts, not before."""


def _build_shape(body: pymunk.Body, footprint: Footprint, offset: Pose) -> pymunk.Shape:
    """One footprint of a body at ``offset`` in pymunk's body."""
    form = footprint.shape
    shape: pymunk.Shape
    if isinstance(form, Circle):
        shape = pymunk.Circle(body, form.radius, offset.transform_point(*form.center))
    else:
        shape = pymunk.Poly(body, [offset.transform_point(*corner) for corner in form.points])
    shape.sensor = footprint.sensor
    shape.filter = pymunk.ShapeFilter(categories=footprint.category, mask=footprint.mask)
    shape.friction = friction_factor(footprint.friction)
    shape.elasticity = footprint.restitution
    shape.collision_type = RESTITUTION_TYPE if footprint.restitution else 0
    return shape


def _set_mass(body: pymunk.Body, masses: list[tuple[pymunk.Shape, float]]) -> None:
    """Gives the body the mass, centre of mass and moment of inertia of its shapes with their masses [kg].

    Without any mass it weighs 1 kg about its origin and nothing turns it, as in Box2D.
    """
    total = sum(mass for _, mass in masses)
    if total < MIN_MASS:
        body.mass, body.moment = 1.0, math.inf
        return
    x = sum(mass * shape.center_of_gravity.x for shape, mass in masses) / total
    y = sum(mass * shape.center_of_gravity.y for shape, mass in masses) / total
    moment = sum(_moment_of_inertia(shape, mass, (x, y)) for shape, mass in masses)
    body.mass, body.moment = total, max(moment, total * MIN_GYRATION**2)
    body.center_of_gravity = x, y


def _moment_of_inertia(shape: pymunk.Shape, mass: float, center: tuple[float, float]) -> float:
    """Its moment of inertia about ``center`` [kg m^2]."""
    x, y = center
    if isinstance(shape, pymunk.Circle):
        return pymunk.moment_for_circle(mass, 0.0, shape.radius, (shape.offset.x - x, shape.offset.y - y))
    assert isinstance(shape, pymunk.Poly)
    return pymunk.moment_for_poly(mass, shape.get_vertices(), (-x, -y))


def friction_factor(friction: float) -> float:
    """pymunk multiplies two frictions, Box2D takes the root of the product."""
    return math.sqrt(friction)


def _farthest_distance(shape: pymunk.Shape, center: tuple[float, float]) -> float:
    """How far its farthest point lies from ``center`` [m]."""
    if isinstance(shape, pymunk.Circle):
        return math.dist(shape.offset, center) + shape.radius
    assert isinstance(shape, pymunk.Poly)
    return max(math.dist(corner, center) for corner in shape.get_vertices())


def _narrowest_gap(footprint: Footprint) -> float:
    """The narrowest gap it fits through [m]."""
    form = footprint.shape
    if isinstance(form, Circle):
        return 2.0 * form.radius
    ends = zip(form.points, form.points[1:] + form.points[:1], strict=True)
    return min(
        max(abs((bx - ax) * (y - ay) - (by - ay) * (x - ax)) for x, y in form.points)
        / math.dist((ax, ay), (bx, by))
        for (ax, ay), (bx, by) in ends
    )


# Joints


def _are_both_fixed(a: PhysicalBody, b: PhysicalBody) -> bool:
    """A joint between two bodies that nothing can push has nothing to do."""
    return "dynamic" not in (a.description.kind, b.description.kind)


def _constraints(joint: Joint, a: PhysicalBody, b: PhysicalBody, step_size: float) -> list[pymunk.Constraint]:
    """Returns the constraints that hold two bodies at their anchors, and at their angle where the joint fixes it."""
    (anchor_a, anchor_b) = (
        body.offset.transform_point(*anchor.point) for body, anchor in zip((a, b), joint.anchors, strict=True)
    )
    first, second = a.rigid.body, b.rigid.body
    twisted = a.offset.theta - b.offset.theta  # how far the angle of the rigids is from that of the bodies
    found: list[pymunk.Constraint] = [pymunk.PivotJoint(first, second, anchor_a, anchor_b)]
    if joint.limits is not None:
        low, high = joint.limits
        found.append(pymunk.RotaryLimitJoint(first, second, low + twisted, high + twisted))
    elif joint.kind == "weld" and joint.frequency == 0:
        found.append(pymunk.GearJoint(first, second, joint.angle + twisted, 1.0))
    elif joint.kind == "weld":
        found.append(_make_spring(joint, first, second, joint.angle + twisted, step_size))
    for constraint in found:
        constraint.error_bias = ERROR_BIAS
        constraint.max_bias = MAX_TRAVEL / step_size
    return found


def _make_spring(
    joint: Joint, a: pymunk.Body, b: pymunk.Body, angle: float, step_size: float
) -> pymunk.DampedRotarySpring:
    """A soft weld, which swings about ``angle`` with its frequency and damping ratio.

    No quicker than a radian per step: beyond, a spring that is integrated step by step explodes.
    """
    inertia = sum(1.0 / body.moment for body in (a, b) if body.body_type == pymunk.Body.DYNAMIC)
    effective = 1.0 / inertia if inertia > 0.0 else 0.0
    omega = min(math.tau * joint.frequency, 1.0 / step_size)
    return pymunk.DampedRotarySpring(
        a, b, -angle, effective * omega**2, 2.0 * effective * joint.damping * omega
    )
