"""The server of the action turn_to: it turns the robot to a heading, and
says on the way how far it is."""

import math
import time

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.action import ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from tf_transformations import euler_from_quaternion
from turtlesim.action import RotateAbsolute


class Turner(Node):
    def __init__(self):
        super().__init__("turner")
        self.heading = 0.0
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Odometry, "odom", self.on_odom, 10)
        self.server = ActionServer(
            self,
            RotateAbsolute,
            "turn_to",
            self.execute,
            cancel_callback=lambda handle: CancelResponse.ACCEPT,
            callback_group=ReentrantCallbackGroup(),
        )

    def on_odom(self, odom):
        q = odom.pose.pose.orientation
        self.heading = euler_from_quaternion([q.x, q.y, q.z, q.w])[2]

    def turn(self, rate):
        """Publishes a rate of turning [rad/s]."""
        command = Twist()
        command.angular.z = rate
        self.drive.publish(command)

    def left_to(self, theta):
        """How far it still is to this heading, the short way round:
        positive to the left [rad]."""
        return math.remainder(theta - self.heading, 2 * math.pi)

    def execute(self, handle):
        """Called with each accepted goal: handle.request.theta is the
        heading that is wanted [rad]."""
        left = self.left_to(handle.request.theta)
        # TODO: as long as abs(left) > 0.05: turn at 0.5 rad/s to the
        #       right side, publish how far it still is as feedback,
        #       sleep for 0.05 s, look again; and if
        #       handle.is_cancel_requested, stop turning and end the goal
        #       as canceled
        handle.succeed()
        return RotateAbsolute.Result(delta=0.0)


def main(args=None):
    rclpy.init(args=args)
    executor = MultiThreadedExecutor()
    executor.add_node(Turner())
    executor.spin()


if __name__ == "__main__":
    main()
