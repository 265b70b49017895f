"""Monte Carlo localisation: a robot that was put somewhere in a room
finds out where it is.

Write `weigh` and `resample`; the rest is complete. Then:
kit run simple --controller FILE --steps 2000
"""

import math

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from tf_transformations import euler_from_quaternion


def weigh(expected, measured, spread):
    """One weight for each particle, from what it would measure; the
    weights' sum is 1.

    expected: for each particle the list of distances that the laser would
              measure there [m]
    measured: the distances that the laser did measure, as many [m]; nan
              where a ray met nothing
    spread:   by how much a measurement is usually off [m]
    """
    return [1 / len(expected)] * len(expected)  # write this


def resample(weights, first):
    """The numbers of the particles that live on, as many as there are
    weights: the heavier, the more often.

    Think of the weights as pieces of a stick of length 1, in their
    order. n marks stand on the stick, 1/n apart, the first one at
    `first`, which is below 1/n. Each mark chooses the piece that it
    stands on.
    """
    return list(range(len(weights)))  # write this


# From here on everything is complete.

PARTICLES = 1000
SPREAD = 2.0  # m
RAYS = range(0, 91, 7)  # every seventh ray is enough
ROOM = [(-4.4, -2.5, 3.65, 2.48), (-3.2, -1.5, -2.0, -0.9), (-0.9, 1.2, 0.5, 1.4), (1.2, -0.7, 1.4, 1.7)]
ROOM += [(2.2, -1.7, 2.4, -0.8), (2.2, -1.7, 3.1, -1.5), (-2.85, 0.85, -2.15, 1.55)]


def walls():
    """(n, 4) the sides of all rectangles."""
    return np.array(
        [
            side
            for x, y, right, top in ROOM
            for side in ((x, y, right, y), (x, top, right, top), (x, y, x, top), (right, y, right, top))
        ]
    )


def look(particles, angles, sides):
    """(particles, rays) what the laser would measure at each particle
    [m]."""
    heading = particles[:, 2:3] + angles
    dx, dy = np.cos(heading)[..., None], np.sin(heading)[..., None]
    x, y = particles[:, 0, None, None], particles[:, 1, None, None]
    ax, ay, ux, uy = sides[:, 0], sides[:, 1], sides[:, 2] - sides[:, 0], sides[:, 3] - sides[:, 1]
    with np.errstate(divide="ignore", invalid="ignore"):
        cross = dx * uy - dy * ux
        ray = ((ax - x) * uy - (ay - y) * ux) / cross
        along = ((ax - x) * dy - (ay - y) * dx) / cross
    hit = (ray > 0) & (along >= 0) & (along <= 1)
    return np.where(hit, ray, 10.0).min(axis=2)


class Localiser(Node):
    def __init__(self):
        super().__init__("localiser")
        self.chance = np.random.default_rng(1)
        low, high = (-4.4, -2.5, -math.pi), (3.65, 2.48, math.pi)
        # anywhere, any heading
        self.particles = self.chance.uniform(low, high, (PARTICLES, 3))
        self.sides = walls()
        self.pose = self.seen_from = self.truth = None
        self.scans = 0
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Odometry, "odom", self.on_odom, 10)
        # for the log alone
        self.create_subscription(Odometry, "odometry/ground_truth", self.on_truth, 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)
        self.create_timer(2.0, self.tell)

    def on_odom(self, odom):
        self.pose = self.pose_of(odom)

    def on_truth(self, odom):
        self.truth = self.pose_of(odom)

    def pose_of(self, odom):
        place, q = odom.pose.pose.position, odom.pose.pose.orientation
        return np.array([place.x, place.y, euler_from_quaternion([q.x, q.y, q.z, q.w])[2]])

    def on_scan(self, scan):
        command = Twist()
        ahead = min((each for each in scan.ranges[38:53] if not math.isnan(each)), default=9.0)
        command.linear.x, command.angular.z = (0.4, 0.1) if ahead > 0.7 else (0.0, 0.8)
        self.drive.publish(command)
        self.scans += 1
        # twice a second is enough
        if self.pose is None or self.scans % 5:
            return
        self.move()
        angles = np.array([scan.angle_min + k * scan.angle_increment for k in RAYS])
        expected = look(self.particles, angles, self.sides)
        weights = weigh(expected.tolist(), [scan.ranges[k] for k in RAYS], SPREAD)
        chosen = resample(weights, float(self.chance.uniform(0, 1 / PARTICLES)))
        self.particles = self.particles[chosen]

    def move(self):
        """Moves every particle as the odometry says that the robot
        moved, and a little more by chance."""
        if self.seen_from is not None:
            before, now = self.seen_from, self.pose
            way = math.hypot(*(now[:2] - before[:2]))
            turn = math.remainder(now[2] - before[2], 2 * math.pi)
            moved = way + self.chance.normal(0, 0.03, PARTICLES)
            self.particles[:, 2] += turn + self.chance.normal(0, 0.03, PARTICLES)
            self.particles[:, 0] += moved * np.cos(self.particles[:, 2])
            self.particles[:, 1] += moved * np.sin(self.particles[:, 2])
        self.seen_from = self.pose

    def tell(self):
        middle, spread = self.particles[:, :2].mean(axis=0), self.particles[:, :2].std(axis=0)
        off = math.hypot(*(middle - self.truth[:2]))
        told = f"spread over {math.hypot(*spread):.1f} m; their middle is {off:.1f} m off"
        self.get_logger().info(told)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Localiser())


if __name__ == "__main__":
    main()
