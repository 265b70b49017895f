"""Plain records about a world and its runs, sent as JSON. Lengths in metres, angles in radians.

They are not the world's own records, since a confined process that has read a stranger's world writes them: what arrives is
checked value by value, and holds no arrays, functions or files.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, Self

from kit.world.documents import WIDER_ROOT
from kit.world.problems import WorldError

Box = tuple[float, float, float, float]
"""Left, bottom, right, top."""
PoseTriple = tuple[float, float, float]


class JsonRecord:
    """A record of plain values and tuples of them; ``RECORD_FIELDS`` gives the type of fields that hold records."""

    RECORD_FIELDS: Mapping[str, type[JsonRecord]] = {}

    @classmethod
    def from_json(cls, content: Mapping[str, Any]) -> Self:
        """Makes the record from the output of ``dataclasses.asdict``, sent as JSON."""
        names = [field.name for field in fields(cls)]  # type: ignore[arg-type]  # every heir is a dataclass
        return cls(**{name: cls._field_value(name, content[name]) for name in names})

    @classmethod
    def _field_value(cls, name: str, value: Any) -> Any:
        part = cls.RECORD_FIELDS.get(name)
        if part is not None:
            return tuple(map(part.from_json, value))
        return _as_tuple(value)


def _as_tuple(value: Any) -> Any:
    return tuple(map(_as_tuple, value)) if isinstance(value, list) else value


@dataclass(frozen=True)
class WallFacts(JsonRecord):
    """One entry of ``layers`` that has a map."""

    map: str
    """The map file's name without its ending; checks use it as the walls' name."""
    source: str
    """The name of the picture or .dat file."""
    names: tuple[str, ...]
    box: Box | None
    """Around all of them; None if there are none."""
    segments: int


@dataclass(frozen=True)
class ShapeFacts(JsonRecord):
    """One footprint."""

    kind: str
    """circle or polygon"""
    box: Box
    """Box in its body's frame."""
    sensor: bool
    collision: bool
    density: float


@dataclass(frozen=True)
class BodyFacts(JsonRecord):
    """One body of a model."""

    RECORD_FIELDS = {"shapes": ShapeFacts}  # noqa: RUF012  # read only
    name: str
    kind: str
    pose: PoseTriple
    """Pose in the model's frame."""
    shapes: tuple[ShapeFacts, ...]

    @property
    def box(self) -> Box | None:
        """Around all its footprints, in its own frame."""
        if not self.shapes:
            return None
        left, bottom, right, top = zip(*(shape.box for shape in self.shapes), strict=True)
        return min(left), min(bottom), max(right), max(top)


@dataclass(frozen=True)
class JointFacts(JsonRecord):
    """One joint, and where its two ends are in the model's frame at the start."""

    name: str
    kind: str
    bodies: tuple[str, str]
    ends: tuple[tuple[float, float], tuple[float, float]]


@dataclass(frozen=True)
class PluginFacts(JsonRecord):
    """One plugin of a model."""

    name: str
    type: str
    body: str
    """The body that carries it; empty if it names none."""
    rays: int
    """Number of rays of a laser; for other plugins this and the next three are 0."""
    first: float
    last: float
    range: float
    layers: tuple[str, ...] = ()
    """Names of the layers that a laser looks at."""


@dataclass(frozen=True)
class ModelFacts(JsonRecord):
    RECORD_FIELDS = {"bodies": BodyFacts, "joints": JointFacts, "plugins": PluginFacts}  # noqa: RUF012  # read only
    name: str
    namespace: str
    pose: PoseTriple
    bodies: tuple[BodyFacts, ...]
    joints: tuple[JointFacts, ...]
    plugins: tuple[PluginFacts, ...]


@dataclass(frozen=True)
class CollisionFacts(JsonRecord):
    """Whether two things collide. A thing is (model, body), or ("", map) for walls."""

    a: tuple[str, str]
    b: tuple[str, str]
    collides: bool
    why: str


@dataclass(frozen=True)
class SightFacts(JsonRecord):
    """Whether a laser, ``model/plugin``, sees a thing."""

    laser: str
    thing: tuple[str, str]
    sees: bool
    why: str


@dataclass(frozen=True)
class EndpointFacts(JsonRecord):
    """One topic of a plugin."""

    model: str
    topic: str
    type: str
    publishes: bool


@dataclass(frozen=True)
class WorldFacts(JsonRecord):
    """A world as it was read; or the problems that kept it from being read, and nothing else."""

    RECORD_FIELDS = {  # noqa: RUF012  # read only
        "walls": WallFacts,
        "models": ModelFacts,
        "collisions": CollisionFacts,
        "sights": SightFacts,
        "endpoints": EndpointFacts,
    }
    problems: tuple[str, ...] = ()
    layers: tuple[str, ...] = ()
    """Every layer name."""
    walls: tuple[WallFacts, ...] = ()
    models: tuple[ModelFacts, ...] = ()
    collisions: tuple[CollisionFacts, ...] = ()
    sights: tuple[SightFacts, ...] = ()
    endpoints: tuple[EndpointFacts, ...] = ()
    picture: str = ""

    @classmethod
    def of_unreadable(cls, error: WorldError, file: Path) -> WorldFacts:
        """Returns the facts of the world ``file``, which cannot be read."""
        return cls(tuple(_without_folder(str(each), file.parent) for each in error.problems))

    def model(self, name: str) -> ModelFacts | None:
        return next((each for each in self.models if each.name == name), None)


def _without_folder(problem: str, folder: Path) -> str:
    """Removes from a problem the path of the temporary copy, and advice that only applies to a command line."""
    text = problem.replace(f"{folder}/", "").replace(f'the folder "{folder}"', "the world's folder")
    return text.removesuffix(WIDER_ROOT)


@dataclass(frozen=True)
class TopicStatistics(JsonRecord):
    """The messages on one topic while the world ran."""

    topic: str
    count: int
    spread: float
    """Of a laser: the standard deviation of one ray's readings, over all rays that always hit. Of an odometry: of x and
    of y. Else 0."""


@dataclass(frozen=True)
class RunFacts(JsonRecord):
    """A world that ran for some seconds, or the reason why it could not."""

    RECORD_FIELDS = {"topics": TopicStatistics}  # noqa: RUF012  # read only
    problem: str = ""
    """Why it did not run to its end: the driver failed, or no model can be driven."""
    seconds: float = 0.0
    topics: tuple[TopicStatistics, ...] = ()
    reached_s: float | None = None
    start: tuple[float, ...] = ()
    """x and y of the robot's start in the world [m]; empty without a robot."""
    target_distance: float | None = None
    """From the robot's hull to the target at the end [m]."""
    distance: float = 0.0
    undriven: float = 0.0
    """How far the robot moves in the same time while nobody drives it [m]."""
    bumps: int = 0
    joint_gap: float = 0.0
    """How far apart two ends of one joint have been at most, after the first half second [m]."""
    widest_joint: str = ""
    """That joint's name."""
    is_reachable: bool = False
    """Whether a robot of this size finds a way from the start to the target."""
    is_enclosed: bool = False
    """Whether the walls hold the robot in."""
    picture: str = ""
    finished: bool = True
    """False where the run was ended because it took too long."""


@dataclass(frozen=True, slots=True)
class WorldRunSpec:
    """A run to make of a world."""

    name: str
    seed: int
    time_s: float
    driver: str
    """The driver's Python file; empty for none."""
    robot: str
    """The model; empty: the first with a drive."""
    target: tuple[float, float] | None
    radius: float
    until_reached: bool
