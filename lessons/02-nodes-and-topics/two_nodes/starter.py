"""Two nodes: a watcher that looks, and a driver that drives. All that
connects them is the topic wall_ahead.

watcher: subscribes to the laser (static_laser, LaserScan), publishes on
         wall_ahead (Bool) whether a wall is within 0.5 m ahead
driver:  subscribes to wall_ahead, commands the wheels (cmd_vel, Twist):
         0.4 m/s ahead, or 1.0 rad/s to the left at a wall
"""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool


class Watcher(Node):
    def __init__(self):
        super().__init__("watcher")
        # TODO


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        # TODO


def main(args=None):
    rclpy.init(args=args)
    # one spins a single node; an executor spins several
    executor = SingleThreadedExecutor()
    executor.add_node(Watcher())
    # TODO: the driver too
    executor.spin()


if __name__ == "__main__":
    main()
