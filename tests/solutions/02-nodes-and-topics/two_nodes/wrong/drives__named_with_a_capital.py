"""Two nodes: a watcher that looks, and a driver that drives. All that connects them is the topic wall_ahead.

watcher: hears the laser (static_laser, LaserScan), says on wall_ahead (Bool) whether a wall is within 0.5 m ahead
driver:  hears wall_ahead, tells the wheels (cmd_vel, Twist): 0.4 m/s ahead, or 1.0 rad/s to the left at a wall
"""

# Lesson: Call it `heartbeat`, in small letters

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool


class Watcher(Node):
    def __init__(self):
        super().__init__("watcher")
        self.warn = self.create_publisher(Bool, "wall_ahead", 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)

    def on_scan(self, scan):
        near = [distance for distance in scan.ranges[38:53] if distance < 0.5]  # nan is never smaller
        self.warn.publish(Bool(data=bool(near)))


class Driver(Node):
    def __init__(self):
        super().__init__("Driver")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Bool, "wall_ahead", self.on_wall, 10)

    def on_wall(self, message):
        command = Twist()
        if message.data:
            command.angular.z = 1.0
        else:
            command.linear.x = 0.4
        self.drive.publish(command)


def main(args=None):
    rclpy.init(args=args)
    executor = SingleThreadedExecutor()  # one spins a single node; an executor spins several
    executor.add_node(Watcher())
    executor.add_node(Driver())
    executor.spin()


if __name__ == "__main__":
    main()
