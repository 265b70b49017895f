"""A hallway as a Gymnasium environment: a robot and its sensors become
something an agent can learn from."""

import math

import gymnasium
import numpy as np
import rclpy
from flatland_msgs.msg import Collisions
from flatland_msgs.srv import MoveModel
from geometry_msgs.msg import Pose2D, Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

# action 0 forward, 1 left, 2 right: m/s, rad/s
MOVES = ((0.5, 0.0), (0.0, 1.57), (0.0, -1.57))
MAX_STEPS = 200
ARRIVED = 0.2  # m from the beacon
FAR = 2.0  # m: farther than this the agent does not see


class HallwayEnv(gymnasium.Env):
    def __init__(self):
        self.robot = Robot()
        self.steps = 0
        # What may be done, and what is seen: the wrong sizes so far.
        self.action_space = gymnasium.spaces.Discrete(1)
        self.observation_space = gymnasium.spaces.Box(0.0, 1.0, shape=(9,), dtype=np.float32)

    def observation(self):
        """Nine numbers: the nearest range of each sector, at most FAR."""
        return np.zeros(9, dtype=np.float32)  # from self.robot.ranges

    def reset(self, *, seed=None, options=None):
        """Begins an episode: the robot at its home, but for a little
        chance."""
        super().reset(seed=seed)
        # dx and dy within 0.05 m, the turn within 0.2 rad, all drawn
        # from self.np_random, then:
        # self.robot.put(dx, dy, turn)
        return self.observation(), {}

    def step(self, action):
        """One action, a tenth of a second."""
        # self.robot.drive(*MOVES[action]) drives. Then self.robot knows
        # has_bumped and to_beacon [m].
        return self.observation(), 0.0, False, False, {}


# ---- Below: the robot. Finished; nothing to change. ----


class Robot(Node):
    """A robot that drives for a tenth of a second at a time: until every
    sensor has spoken again."""

    def __init__(self):
        super().__init__("hallway")
        self.home = self.declare_parameter("home", [0.0, 0.0, math.pi / 2]).value
        self.model = self.declare_parameter("model", "serp").value
        # 91 distances [m] from the newest scan; nan: nothing within
        # reach
        self.ranges = None
        self.has_bumped = None  # whether anything touches it
        # m from the hull to the beacon in the target
        self.to_beacon = None
        self.commands = self.create_publisher(Twist, "cmd_vel", 10)
        self.move_model = self.create_client(MoveModel, "/move_model")
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)
        self.create_subscription(Collisions, "collisions", self.on_collisions, 10)
        self.create_subscription(LaserScan, "/beacon_laser", self.on_beacon, 10)

    def put(self, dx, dy, turn):
        """Puts the robot beside its home, and waits for what it sees
        from there."""
        self.commands.publish(Twist())
        x, y, theta = self.home
        pose = Pose2D(x=x + dx, y=y + dy, theta=theta + turn)
        moved = self.move_model.call_async(MoveModel.Request(name=self.model, pose=pose))
        rclpy.spin_until_future_complete(self, moved)
        self.sense()
        self.sense()  # the first may still be from where it was

    def drive(self, speed, turn):
        """Drives for a tenth of a second: m/s, rad/s."""
        command = Twist()
        command.linear.x, command.angular.z = speed, turn
        self.commands.publish(command)
        self.sense()

    def sense(self):
        """Waits until every sensor has spoken."""
        self.ranges = self.has_bumped = self.to_beacon = None
        while self.ranges is None or self.has_bumped is None or self.to_beacon is None:
            rclpy.spin_once(self)

    def on_scan(self, scan):
        self.ranges = list(scan.ranges)

    def on_collisions(self, message):
        self.has_bumped = bool(message.collisions)

    def on_beacon(self, scan):
        self.to_beacon = min((each for each in scan.ranges if not math.isnan(each)), default=10.0)


def main(args=None):
    """Three episodes with an agent that has learnt nothing yet: it draws
    its actions."""
    rclpy.init(args=args)
    env = HallwayEnv()
    for episode in range(3):
        env.reset(seed=episode)
        env.action_space.seed(episode)
        total, over, steps = 0.0, False, 0
        while not over and steps < 1000:
            _, reward, terminated, truncated, _ = env.step(env.action_space.sample())
            total, over, steps = total + reward, terminated or truncated, steps + 1
        env.robot.get_logger().info(
            f"episode {episode}: {steps} steps, rewards {total:.2f}, terminated {terminated}, truncated {truncated}"
        )


if __name__ == "__main__":
    main()
