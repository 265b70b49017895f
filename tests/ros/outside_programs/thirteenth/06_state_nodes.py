"""Sensors become symbols, symbols change states, states become commands: three nodes in one executor drive to a corner."""
import math
from enum import Enum, auto

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String


class State(Enum):
    AHEAD = auto()
    TURN = auto()
    ALONG = auto()
    DONE = auto()


class Encoder(Node):
    """Says 'wall' where the way ahead is short, 'clear' where it is long, 'square' after each quarter of a turn."""

    def __init__(self):
        super().__init__('encoder')
        self.symbols = self.create_publisher(String, 'symbols', 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, rclpy.qos.qos_profile_sensor_data)
        self.create_subscription(Odometry, 'odom', self.on_odom, 10)
        self.quarter = 0

    def on_scan(self, scan):
        count = math.radians(10) / scan.angle_increment
        front = list(scan.ranges[: int(count)]) + list(scan.ranges[-int(count):])
        nearest = min((each for each in front if math.isfinite(each)), default=scan.range_max)
        self.symbols.publish(String(data='wall' if nearest < 0.8 else 'clear'))

    def on_odom(self, odom):
        q = odom.pose.pose.orientation
        yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
        if yaw > math.pi / 2 - 0.02 and self.quarter == 0:
            self.quarter = 1
            self.symbols.publish(String(data='square'))


class Machine(Node):
    NEXT = {
        (State.AHEAD, 'wall'): State.TURN,
        (State.TURN, 'square'): State.ALONG,
        (State.ALONG, 'wall'): State.DONE,
    }

    def __init__(self):
        super().__init__('machine')
        self.state = State.AHEAD
        self.states = self.create_publisher(String, 'states', 10)
        self.create_subscription(String, 'symbols', self.on_symbol, 10)

    def on_symbol(self, symbol):
        following = self.NEXT.get((self.state, symbol.data))
        if following is not None:
            self.get_logger().info(f'{self.state.name} -> {following.name}')
            self.state = following
        self.states.publish(String(data=self.state.name))


class Motor(Node):
    COMMANDS = {'AHEAD': (0.4, 0.0), 'TURN': (0.0, 0.5), 'ALONG': (0.4, 0.0), 'DONE': (0.0, 0.0)}

    def __init__(self):
        super().__init__('motor')
        self.commands = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(String, 'states', self.on_state, 10)

    def on_state(self, state):
        command = Twist()
        command.linear.x, command.angular.z = self.COMMANDS[state.data]
        self.commands.publish(command)
        if state.data == 'DONE':
            self.get_logger().info('in the corner')
            rclpy.shutdown()


def main():
    rclpy.init()
    executor = MultiThreadedExecutor()
    for node in (Encoder(), Machine(), Motor()):
        executor.add_node(node)
    try:
        executor.spin()
    except ExternalShutdownException:
        pass
    print('over')


if __name__ == '__main__':
    main()
