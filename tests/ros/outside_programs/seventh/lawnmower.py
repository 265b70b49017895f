import math
import sys

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from std_srvs.srv import Empty
from turtlesim.msg import Pose
from turtlesim.srv import SetPen, TeleportAbsolute


class Lawnmower(Node):
    LOW, HIGH, LANE = 1.0, 10.0, 1.5

    def __init__(self):
        super().__init__('lawnmower')
        self.pose = Pose()
        self.create_subscription(Pose, 'turtle1/pose', lambda m: setattr(self, 'pose', m), 10)
        self.cmd = self.create_publisher(Twist, 'turtle1/cmd_vel', 10)

    def call(self, kind, name, **fields):
        client = self.create_client(kind, name)
        client.wait_for_service()
        future = client.call_async(kind.Request(**fields))
        rclpy.spin_until_future_complete(self, future)
        return future.result()

    def drive(self, v, w):
        msg = Twist()
        msg.linear.x = float(v)
        msg.angular.z = float(w)
        self.cmd.publish(msg)
        rclpy.spin_once(self)

    def straight(self, reached):
        while rclpy.ok() and not reached():
            self.drive(2, 0)

    def turn(self, side):
        """Half a turn in a small arc, to the left (1) or the right (-1)."""
        goal = 0.0 if abs(self.pose.theta) > math.pi / 2 else math.pi
        while rclpy.ok():
            error = math.remainder(goal - self.pose.theta, 2 * math.pi)
            if abs(error) < 0.02:
                break
            if abs(error) > 1.0:
                w = side * 1.2
            else:
                w = max(-1.2, min(1.2, 3 * error))
            self.drive(abs(w) * self.LANE / 2, w)

    def mow(self):
        self.call(SetPen, 'turtle1/set_pen', r=0, g=255, b=0, width=5, off=1)
        self.call(TeleportAbsolute, 'turtle1/teleport_absolute', x=self.LOW, y=self.LOW, theta=0.0)
        self.call(SetPen, 'turtle1/set_pen', r=0, g=255, b=0, width=5, off=0)
        self.call(Empty, 'clear')
        lanes, side = 0, 1
        while True:
            self.straight(lambda: self.pose.x > self.HIGH if side > 0 else self.pose.x < self.LOW)
            lanes += 1
            self.get_logger().info(f'lane {lanes} at y={self.pose.y:.1f}')
            if self.pose.y + self.LANE > self.HIGH:
                break
            self.turn(side)
            side = -side
        self.drive(0, 0)
        self.get_logger().info(f'{lanes} lanes mown')


def main():
    rclpy.init(args=sys.argv)
    node = Lawnmower()
    node.mow()
    node.destroy_node()
    rclpy.shutdown()
    sys.exit(0)


main()
