"""A trained policy drives: scans in, commands out. Needs rclpy and numpy, nothing else."""

import base64
import io
import json
import math
import zlib

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

# --- what was learned ---
TRAINED_ON = ""
STEP_TIME = 0.1  # s
TWISTS: list[list[float]] = []  # m/s forward and rad/s to the left, move by move
CHOICES: list[int] = []  # how many moves, or pairs of moves, there are to choose from
TOPICS: list[str] = []  # before each robot's topics
RAYS: list[list[int]] = []  # by robot: rays given as they are
SECTORS: list[int] = []  # which sector each ray belongs to
CLIP, SCALE = 2.0, 1.0  # how far it sees [m], and what ranges are multiplied by
POLICY = ""
# --- what was learned ---


class ExportedPolicy:
    """The network, from its arrays."""

    def __init__(self) -> None:
        with np.load(io.BytesIO(zlib.decompress(base64.b64decode(POLICY))), allow_pickle=False) as stored:
            arrays = {name: stored[name] for name in stored.files}
        self.relu = json.loads(arrays["about"].tobytes())["activation"] == "relu"
        count = sum(name.removeprefix("weights_").isdigit() for name in arrays)
        self.layers = [(arrays[f"weights_{i}"], arrays[f"bias_{i}"]) for i in range(count)]
        self.gates = [
            arrays[name]
            for name in ("weights_seen", "bias_seen", "weights_kept", "bias_kept")
            if name in arrays
        ]
        if self.gates:
            self.hidden = self.cell = np.zeros(len(self.gates[2]))

    def moves(self, x: np.ndarray) -> list[int]:
        """Each robot's best move for what is seen."""
        if self.gates:
            x = self.apply_lstm(x)
        for weights, bias in self.layers[:-1]:
            x = x @ weights + bias
            x = np.maximum(x, 0) if self.relu else np.tanh(x)
        weights, bias = self.layers[-1]
        parts = np.split(x @ weights + bias, np.cumsum(CHOICES)[:-1])
        best = [int(part.argmax()) for part in parts]
        return list(divmod(best[0], len(TWISTS))) if len(best) < len(TOPICS) else best

    def apply_lstm(self, x: np.ndarray) -> np.ndarray:
        """A layer with memory."""
        weights_seen, bias_seen, weights_kept, bias_kept = self.gates
        gates = np.split(x @ weights_seen + bias_seen + self.hidden @ weights_kept + bias_kept, 4)
        enter, forget, _, out = ((np.tanh(gate / 2) + 1) / 2 for gate in gates)
        self.cell = forget * self.cell + enter * np.tanh(gates[2])
        self.hidden = out * np.tanh(self.cell)
        return self.hidden


def observe_scan(robot: int, ranges: np.ndarray) -> np.ndarray:
    """What the policy sees of one robot's scan: some rays, then the shortest of each sector."""
    seen = np.clip(np.nan_to_num(ranges, nan=CLIP, posinf=CLIP), 0.0, CLIP)
    minima = np.full(max(SECTORS) + 1, CLIP)
    np.minimum.at(minima, SECTORS, seen)
    return np.concatenate((seen[RAYS[robot]], minima)) * SCALE


class PolicyNode(Node):
    """Chooses a move each time that a step is over and every robot has a new scan."""

    def __init__(self) -> None:
        super().__init__("policy")
        self.model = ExportedPolicy()
        self.scans: dict[int, np.ndarray] = {}
        self.next_step = -math.inf
        self.drives = [self.create_publisher(Twist, f"{prefix}cmd_vel", 10) for prefix in TOPICS]
        for robot, prefix in enumerate(TOPICS):
            self.create_subscription(
                LaserScan, f"{prefix}static_laser", lambda scan, robot=robot: self.on_scan(robot, scan), 10
            )
        self.get_logger().info(f"Trained on {TRAINED_ON}.")

    def on_scan(self, robot: int, scan: LaserScan) -> None:
        if len(scan.ranges) != len(SECTORS):
            self.get_logger().error(
                f"The policy knows a lidar of {len(SECTORS)} rays, this one has {len(scan.ranges)}."
            )
            return
        now = scan.header.stamp.sec + scan.header.stamp.nanosec * 1e-9
        if now < self.next_step - 0.5 * STEP_TIME:
            return
        self.scans[robot] = observe_scan(robot, np.array(scan.ranges, dtype=np.float64))
        if len(self.scans) < len(TOPICS):
            return
        seen = np.concatenate([self.scans[each] for each in range(len(TOPICS))]).astype(np.float32)
        for drive, move in zip(self.drives, self.model.moves(seen), strict=True):
            command = Twist()
            command.linear.x, command.angular.z = TWISTS[move]
            drive.publish(command)
        self.scans.clear()
        self.next_step = now + STEP_TIME


def main(args: list[str] | None = None) -> None:
    rclpy.init(args=args)
    rclpy.spin(PolicyNode())


if __name__ == "__main__":
    main()
