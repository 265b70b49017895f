"""A trained policy drives: scans in, commands out. Needs rclpy and numpy, nothing else.

It subscribes to the robots' lidars, and to their odometry if it was trained to see its speed, its pose, where the target is
or how much of its goal is achieved, and publishes their commands; remap the topics to the robot's own. A message on goal_pose
moves the target; a target that moves is known by its transform on /tf. Parameters:

    max_scan_age    the robot is told to stop when no scan has come for this long [s]
    speed_scale     every command is multiplied by this, 0 to 1
    lidar_yaw       how the lidar is turned on the robot, to the left [rad]
    target          x and y of the target, in odometry's frame [m]
    targets         x1, y1, x2, y2, ... of several targets that are to be reached one after the other [m]
    target_radius   how near the target a robot has arrived [m]
    target_heading  the heading asked for at the target [rad]
    leader_frame    the frame on /tf of a target that moves; empty for one that stands

A lidar may have any number of rays: the ones nearest to the directions that the policy knows are taken. A direction that
it does not look in counts as free.
"""

import base64
import io
import json
import math
import zlib
from collections.abc import Callable, Sequence  # noqa: F401 - what stands below for a goal's count needs them
from typing import Any, NamedTuple  # noqa: F401 - likewise

import numpy as np
import rclpy
from builtin_interfaces.msg import Time
from geometry_msgs.msg import PoseStamped, Quaternion, Twist
from nav_msgs.msg import Odometry
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage

# --- what was learned ---
TRAINED_ON = ""
STEP_TIME = 0.1  # s
TWISTS: list[list[float]] = []  # m/s forward and rad/s to the left, move by move
BOUNDS: list[list[float]] = []  # instead of moves: least and greatest m/s, least and greatest rad/s
CHOICES: list[int] = []  # how many moves, or pairs of moves, there are to choose from
TOPICS: list[list[str]] = []  # of each robot: its commands, its scans, its odometry
RAYS: list[list[int]] = []  # by robot: rays given as they are
SECTORS: list[int] = []  # which sector each ray belongs to
ANGLES: list[float] = []  # rad, the direction of each ray, to the left of straight ahead
# what follows the numbers of each robot's scan: speeds, last_action, own_pose, target and others
PARTS: list[str] = []
FRAMES = 1  # how many of the last observations it sees, the newest last
CLIP, SCALE = 2.0, 1.0  # how far it sees [m], and what ranges, distances and coordinates are multiplied by
TARGET_CLIP, PLACE_CLIP = 4.0, 100.0  # how far it is told of the target, and of its own place [m]
TARGETS: list[float] = []  # x1, y1, x2, y2, ... [m] where no parameter says them
TARGET_HEADING = 0.0  # rad, likewise
TARGET_RADIUS = 0.0  # m, likewise
LEADER_FRAME = ""  # likewise
HULL: list[list[list[float]]] = []  # convex parts of a robot [m]; empty where the middle of its axle arrives
HEADING_TOLERANCE = math.pi  # how far from the target's heading a robot has still arrived [rad]
GOAL: dict[str, Any] = {}  # what is known of the goal that is counted
# rays to the left, by which the distance to a wall is told; those to the right mirror them
LEFT_RAYS: list[int] = []
POLICY = ""
# --- what was learned ---


# --- how its goal is counted ---
from kit.learning.policies.node_goals.goal_count import (  # noqa: E402 - its text stands here when a node is written
    GoalProgress,
    NodeCount,
)

COUNT: type[NodeCount] = NodeCount
# --- how its goal is counted ---


SILENCE = 2.0  # s without a scan until it is said
PATIENCE = 0.5  # s with scans and without what else it is to be told, until it is said
EARLY = 0.25  # a scan that comes by this share of a step too early is taken; a scan twice a step is not
CHECK_PERIOD = 0.05  # s


class ExportedPolicy:
    """The network, or the table, from its arrays."""

    def __init__(self) -> None:
        with np.load(io.BytesIO(zlib.decompress(base64.b64decode(POLICY))), allow_pickle=False) as stored:
            self.arrays = {name: stored[name] for name in stored.files}
        about = json.loads(self.arrays["about"].tobytes())
        self.relu = about["activation"] == "relu"
        self.actions_are = about["chance"][0]
        count = sum(name.removeprefix("weights_").isdigit() for name in self.arrays)
        self.layers = [(self.arrays[f"weights_{i}"], self.arrays[f"bias_{i}"]) for i in range(count)]
        self.gates = [
            self.arrays[name]
            for name in ("weights_seen", "bias_seen", "weights_kept", "bias_kept")
            if name in self.arrays
        ]
        self.forget()

    def forget(self) -> None:
        """Begins again, as at the start of an episode."""
        if self.gates:
            self.hidden = self.cell = np.zeros(len(self.gates[2]))

    def twists(self, x: np.ndarray) -> list[list[float]]:
        """Each robot's best command for what is seen: m/s forward and rad/s to the left."""
        scores = self.look_up(x) if "values" in self.arrays else self.compute_scores(x)
        if BOUNDS:
            shares = (self.bound(scores).reshape(-1, 2) + 1) / 2
            low, high = np.array(BOUNDS).T
            commands: list[list[float]] = (low + shares * (high - low)).tolist()
            return commands
        parts = np.split(scores, np.cumsum(CHOICES)[:-1])
        best = [int(part.argmax()) for part in parts]
        if len(best) < len(TOPICS):  # one number for all robots
            best = [int(move) for move in np.unravel_index(best[0], (len(TWISTS),) * len(TOPICS))]
        return [TWISTS[move] for move in best]

    def bound(self, outputs: np.ndarray) -> np.ndarray:
        """Continuous actions, from -1 to 1."""
        if self.actions_are == "tanh-normal":
            outputs = outputs[: len(outputs) // 2]  # the others say how they scattered in training
        bounded: np.ndarray = np.clip(outputs, -1, 1) if self.actions_are == "normal" else np.tanh(outputs)
        return bounded

    def look_up(self, x: np.ndarray) -> np.ndarray:
        """The table's row for the state that is seen."""
        edges, used = self.arrays["edges"], self.arrays["used"]
        bins = np.searchsorted(edges, x[used], side="right")
        row: np.ndarray = self.arrays["values"][bins @ (len(edges) + 1) ** np.arange(len(used))[::-1]]
        return row

    def compute_scores(self, x: np.ndarray) -> np.ndarray:
        """The network's scores."""
        if self.gates:
            x = self.apply_lstm(x)
        for weights, bias in self.layers[:-1]:
            x = x @ weights + bias
            x = np.maximum(x, 0) if self.relu else np.tanh(x)
        weights, bias = self.layers[-1]
        scores: np.ndarray = x @ weights + bias
        return scores

    def apply_lstm(self, x: np.ndarray) -> np.ndarray:
        """A layer with memory."""
        weights_seen, bias_seen, weights_kept, bias_kept = self.gates
        gates = np.split(x @ weights_seen + bias_seen + self.hidden @ weights_kept + bias_kept, 4)
        enter, forget, _, out = ((np.tanh(gate / 2) + 1) / 2 for gate in gates)
        self.cell = forget * self.cell + enter * np.tanh(gates[2])
        self.hidden = out * np.tanh(self.cell)
        return self.hidden


def find_rays(scan: LaserScan, yaw: float) -> np.ndarray:
    """Which ray of a scan lies nearest to each direction that the policy knows; -1 where it has none there."""
    angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges)) + yaw
    apart = np.abs((angles[None, :] - np.array(ANGLES)[:, None] + math.pi) % (2 * math.pi) - math.pi)
    nearest = apart.argmin(axis=1)
    return np.where(apart.min(axis=1) <= abs(scan.angle_increment), nearest, -1)


def heading_of(turn: Quaternion) -> float:
    """The rotation about the vertical axis [rad]."""
    return 2.0 * math.atan2(turn.z, turn.w)


def hull_distance(pose: np.ndarray, x: float, y: float) -> float:
    """The distance from a robot's hull to a point [m]: 0 inside it. From its axle, where that is what arrives."""
    dx, dy = x - pose[0], y - pose[1]
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    point = np.array([cos * dx + sin * dy, cos * dy - sin * dx])
    if not HULL:
        return float(np.hypot(*point))
    return min(part_distance(np.array(part), point) for part in HULL)


def part_distance(corners: np.ndarray, point: np.ndarray) -> float:
    """The distance from a convex polygon, whose corners go counter-clockwise, to a point [m]: 0 inside it."""
    sides, to_point = np.roll(corners, -1, axis=0) - corners, point - corners
    if (sides[:, 0] * to_point[:, 1] - sides[:, 1] * to_point[:, 0] >= 0).all():
        return 0.0
    along = np.clip((sides * to_point).sum(axis=1) / (sides**2).sum(axis=1), 0.0, 1.0)
    return float(np.hypot(*(to_point - along[:, None] * sides).T).min())


def observe_scan(robot: int, ranges: np.ndarray) -> np.ndarray:
    """What the policy sees of one robot's scan: some rays, then the shortest of each sector."""
    seen = np.clip(np.nan_to_num(ranges, nan=CLIP, posinf=CLIP), 0.0, CLIP)
    minima = np.full(max(SECTORS, default=-1) + 1, CLIP)
    if SECTORS:
        np.minimum.at(minima, SECTORS, seen)
    return np.concatenate((seen[RAYS[robot]], minima)) * SCALE


class PolicyNode(Node):
    """Chooses a command each time that a step is over and every robot has a new scan; stops when scans stay away."""

    def __init__(self) -> None:
        super().__init__("policy")
        self.model = ExportedPolicy()
        self.max_scan_age = float(self.declare_parameter("max_scan_age", max(0.5, 3 * STEP_TIME)).value)
        self.speed_scale = min(1.0, max(0.0, float(self.declare_parameter("speed_scale", 1.0).value)))
        self.lidar_yaw = float(self.declare_parameter("lidar_yaw", 0.0).value)
        self.scans: dict[int, np.ndarray] = {}
        self.beside = np.full((len(TOPICS), 2), math.inf)
        self.radius = float(self.declare_parameter("target_radius", TARGET_RADIUS).value)
        self.target_heading = float(self.declare_parameter("target_heading", TARGET_HEADING).value)
        self.leader_frame = self.declare_parameter("leader_frame", LEADER_FRAME).value
        target = self.declare_parameter("target", Parameter.Type.DOUBLE_ARRAY).value
        targets = self.declare_parameter("targets", Parameter.Type.DOUBLE_ARRAY).value
        route = np.array(targets or target or TARGETS, dtype=float).reshape(-1, 2).tolist()
        self.progress = GoalProgress(COUNT(GOAL), self.is_inside, route, len(TOPICS))
        self.motion = {part: [[0.0, 0.0] for _ in TOPICS] for part in ("speeds", "last_action")}
        self.poses: dict[int, tuple[float, float, float]] = {}
        self.pose_stamps: dict[int, float] = {}
        self.leader_stamp = -math.inf
        self.stamps: dict[str, float] = {}
        self.missing_since = math.inf
        self.frames: list[np.ndarray] = []
        self.rays: dict[int, tuple[tuple[float, ...], np.ndarray]] = {}
        self.next_step = self.last_stamp = -math.inf
        self.is_moving = False
        self.drives = [self.create_publisher(Twist, commands, 10) for commands, _, _ in TOPICS]
        self.lidars = [
            self.create_subscription(
                LaserScan, scans, lambda scan, robot=robot: self.on_scan(robot, scan), 10
            )
            for robot, (_, scans, _) in enumerate(TOPICS)
        ]
        self.counts_goal = bool({"achieved", "arrived"} & set(PARTS)) or len(route) > 1
        self.needs_poses = self.counts_goal or bool({"own_pose", "target", "target_heading"} & set(PARTS))
        if self.needs_poses or "speeds" in PARTS:
            self.odometry = [
                self.create_subscription(
                    Odometry, odometry, lambda odom, robot=robot: self.on_odometry(robot, odom), 10
                )
                for robot, (_, _, odometry) in enumerate(TOPICS)
            ]
        if "target" in PARTS:
            self.goal = self.create_subscription(PoseStamped, "goal_pose", self.on_goal, 10)
        if self.leader_frame:
            self.transforms = self.create_subscription(TFMessage, "/tf", self.on_transforms, 100)
        self.heard = [self.seconds()] * len(TOPICS)
        self.silent = [False] * len(TOPICS)
        self.create_timer(CHECK_PERIOD, self.check_scans)
        self.get_logger().info(f"Trained on {TRAINED_ON}.")

    def seconds(self) -> float:
        """The time of the node's clock."""
        return self.get_clock().now().nanoseconds * 1e-9

    def note_message_time(self, source: str, stamp: Time) -> float:
        """The time of a message [s]. Where time goes back, the world has begun again: so does the node."""
        now: float = stamp.sec + stamp.nanosec * 1e-9
        if now < self.stamps.get(source, -math.inf):
            self.stamps.clear()
            self.poses.clear()
            self.pose_stamps.clear()
            self.scans.clear()
            self.leader_stamp, self.next_step = -math.inf, -math.inf
            self.forget()
            self.progress.forget()
            if not self.leader_frame:
                self.progress.begin_route(self.progress.route)
        self.stamps[source] = now
        return now

    def on_scan(self, robot: int, scan: LaserScan) -> None:
        self.heard[robot] = self.seconds()
        if self.silent[robot]:
            self.silent[robot] = False
            self.get_logger().info(f"scans come on {self.lidars[robot].topic_name}")
        now = self.note_message_time(f"scan {robot}", scan.header.stamp)
        self.last_stamp = now
        if now < self.next_step - EARLY * STEP_TIME:
            return
        is_overdue = len(self.scans) == len(TOPICS)  # scans have waited for odometry that has not come
        ranges = self.take_ranges(robot, scan)
        self.scans[robot] = observe_scan(robot, ranges)
        if LEFT_RAYS:
            seen = np.nan_to_num(ranges, nan=math.inf)
            self.beside[robot] = seen[LEFT_RAYS].min(), seen[::-1][LEFT_RAYS].min()
        if is_overdue:
            self.step()
        else:
            self.step_when_known()

    def on_odometry(self, robot: int, odom: Odometry) -> None:
        self.pose_stamps[robot] = self.note_message_time(f"odometry {robot}", odom.header.stamp)
        self.motion["speeds"][robot] = [odom.twist.twist.linear.x, odom.twist.twist.angular.z]
        place = odom.pose.pose.position
        self.poses[robot] = place.x, place.y, heading_of(odom.pose.pose.orientation)
        self.step_when_known()

    def on_goal(self, goal: PoseStamped) -> None:
        self.progress.begin_route([[goal.pose.position.x, goal.pose.position.y]])
        self.target_heading = heading_of(goal.pose.orientation)

    def on_transforms(self, message: TFMessage) -> None:
        for each in message.transforms:
            if each.child_frame_id.lstrip("/") == self.leader_frame:
                self.progress.target = [each.transform.translation.x, each.transform.translation.y]
                self.leader_stamp = self.note_message_time("leader", each.header.stamp)
                self.step_when_known()

    def step_when_known(self) -> None:
        """Acts once every robot has a new scan and what it is told beside it is not older."""
        if len(self.scans) < len(TOPICS):
            return
        stamps = [*self.pose_stamps.values()] if self.needs_poses else []
        stamps += [self.leader_stamp] if self.leader_frame else []
        if all(stamp > self.last_stamp - 1e-6 for stamp in stamps):
            self.step()

    def step(self) -> None:
        """Chooses a command for each robot and publishes it."""
        if not self.knows_places():
            return
        self.count_goal()
        twists = self.model.twists(self.observe())
        self.motion["last_action"] = twists
        for drive, twist in zip(self.drives, twists, strict=True):
            command = Twist()
            command.linear.x, command.angular.z = (self.speed_scale * part for part in twist)
            drive.publish(command)
        self.is_moving = True
        self.scans.clear()
        self.next_step = self.last_stamp + STEP_TIME

    def count_goal(self) -> None:
        """Counts how much of the goal is achieved, where that is told or a route goes on."""
        if self.counts_goal:
            poses = np.array([self.poses[robot] for robot in range(len(TOPICS))])
            self.progress.step(poses, self.beside)

    def is_inside(self, robot: int, pose: np.ndarray, place: Sequence[float]) -> bool:
        """Whether a robot at this pose has arrived."""
        x, y = place
        turn = (pose[2] - self.target_heading + math.pi) % (2 * math.pi) - math.pi
        return hull_distance(pose, x, y) <= self.radius and bool(abs(turn) <= HEADING_TOLERANCE)

    def knows_places(self) -> bool:
        """Whether all is known that it is to be told beside scans; says once what is missing."""
        if "target" in PARTS and not all(map(math.isfinite, self.progress.target)):
            missing = (
                f"no transform of {self.leader_frame} on /tf"
                if self.leader_frame
                else "no target: set the parameter target to [x, y], or publish goal_pose"
            )
        elif self.needs_poses and len(self.poses) < len(TOPICS):
            missing = f"no odometry on {', '.join(each.topic_name for each in self.odometry)}"
        else:
            return True
        self.missing_since = min(self.missing_since, self.seconds())
        if self.seconds() - self.missing_since >= PATIENCE:
            self.get_logger().warning(f"the robot stands: {missing}", once=True)
        return False

    def part_numbers(self, part: str, robot: int) -> list[float]:
        """The numbers of one part of what a robot is told beside its scan."""
        if part in self.motion:
            return self.motion[part][robot]
        if part in ("achieved", "arrived"):
            return self.progress.part_numbers(part, robot)
        x, y, heading = self.poses[robot]
        if part == "own_pose":
            place = (min(max(each, -PLACE_CLIP), PLACE_CLIP) * SCALE for each in (x, y))
            return [*place, math.cos(heading), math.sin(heading)]
        if part == "target_heading":
            return [math.cos(self.target_heading - heading), math.sin(self.target_heading - heading)]
        ahead, aside = self.progress.target[0] - x, self.progress.target[1] - y
        turn = (math.atan2(aside, ahead) - heading + math.pi) % (2 * math.pi) - math.pi
        return [min(math.hypot(ahead, aside), TARGET_CLIP) * SCALE, turn / math.pi]

    def observe(self) -> np.ndarray:
        """What the policy sees: of every robot its scan and its motion; of as many steps as it was trained with."""
        parts: list[np.ndarray] = []
        for robot in range(len(TOPICS)):
            parts += [self.scans[robot], *(np.array(self.part_numbers(name, robot)) for name in PARTS)]
        frame = np.concatenate(parts).astype(np.float32)
        self.frames = [*(self.frames or [frame] * FRAMES)[1 - FRAMES :], frame][-FRAMES:]
        return np.concatenate(self.frames)

    def forget(self) -> None:
        """Begins again, as at the start of an episode."""
        self.model.forget()
        self.frames.clear()
        self.motion["last_action"] = [[0.0, 0.0] for _ in TOPICS]

    def take_ranges(self, robot: int, scan: LaserScan) -> np.ndarray:
        """The ranges in the directions that the policy knows, NaN where there is none."""
        layout = (len(scan.ranges), scan.angle_min, scan.angle_increment)
        if robot not in self.rays or self.rays[robot][0] != layout:
            self.rays[robot] = layout, find_rays(scan, self.lidar_yaw)
            missing = int((self.rays[robot][1] < 0).sum())
            if missing:
                self.get_logger().warning(
                    f"the lidar does not look in {missing} of the {len(ANGLES)} directions that the policy knows: "
                    "they count as free"
                )
        ranges = np.array(scan.ranges, dtype=np.float64)
        if scan.range_min > 0.0:
            ranges[ranges == 0.0] = np.nan  # as some lidars say that nothing came back
        rays = self.rays[robot][1]
        return np.where(rays < 0, np.nan, ranges[rays])

    def check_scans(self) -> None:
        """Stops the robot when scans stay away, and says so when none come at all."""
        now = self.seconds()
        ages = [now - heard for heard in self.heard]
        if self.is_moving and max(ages) > self.max_scan_age:
            self.get_logger().warning(f"no scan for {self.max_scan_age:g} s: stopping the robot")
            self.is_moving = False
            self.scans.clear()
            self.forget()
        if not self.is_moving and max(ages) > self.max_scan_age:
            self.stop()
        for robot, age in enumerate(ages):
            if age > SILENCE and not self.silent[robot]:
                self.silent[robot] = True
                self.get_logger().warning(self.describe_silence(robot))

    def describe_silence(self, robot: int) -> str:
        """Says which topic is silent, and which there are."""
        topic = self.lidars[robot].topic_name
        others = [
            name
            for name, types in self.get_topic_names_and_types()
            if "sensor_msgs/msg/LaserScan" in types and name != topic and self.count_publishers(name)
        ]
        if self.count_publishers(topic):
            what = "it has a publisher, but no messages arrive"
        elif others:
            what = f"this world has {', '.join(others)}: remap static_laser to one of them"
        else:
            what = "no node publishes a LaserScan here"
        return f"no scan on {topic} for {SILENCE:g} s; {what}"

    def stop(self) -> None:
        """Tells the robots to stand."""
        for drive in self.drives:
            drive.publish(Twist())


def main(args: list[str] | None = None) -> None:
    # Without rclpy's own handlers Ctrl-C leaves the node able to publish: the robot is told to stop.
    rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    node = PolicyNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # ended from outside
    finally:
        if rclpy.ok():
            node.stop()


if __name__ == "__main__":
    main()
