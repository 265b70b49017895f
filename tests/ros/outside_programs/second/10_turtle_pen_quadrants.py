#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from rclpy.client import Client
from geometry_msgs.msg import Twist
from turtlesim.msg import Pose, Color
from turtlesim.srv import SetPen


class PenChanger(Node):
    """circle round the middle; the pen is red in the right half and green in the left half"""

    def __init__(self):
        super().__init__("pen_changer")
        self.call_set_pen_: Client = self.create_client(SetPen, "/turtle1/set_pen")
        self.cmd_ = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.create_subscription(Pose, "/turtle1/pose", self.pose_callback, 10)
        self.previous_side_ = None
        self.calls_ = 0

    def pose_callback(self, pose: Pose):
        cmd = Twist()
        if pose.x > 9.0 or pose.x < 2.0 or pose.y > 9.0 or pose.y < 2.0:
            cmd.linear.x = 1.0
            cmd.angular.z = 1.4
        else:
            cmd.linear.x = 5.0
        self.cmd_.publish(cmd)

        side = "right" if pose.x > 5.5 else "left"
        if side != self.previous_side_:
            self.previous_side_ = side
            self.get_logger().info(f"Set pen to {'red' if side == 'right' else 'green'}")
            if side == "right":
                self.set_pen(255, 0, 0, 3)
            else:
                self.set_pen(0, 255, 0, 3)

    def set_pen(self, r, g, b, width, off=0):
        if not self.call_set_pen_.service_is_ready():
            return
        req = SetPen.Request()
        req.r, req.g, req.b, req.width, req.off = r, g, b, width, off
        self.call_set_pen_.call_async(req).add_done_callback(self.done)

    def done(self, future):
        self.calls_ += 1
        if future.exception() is not None:
            self.get_logger().error(str(future.exception()))
        elif self.calls_ == 3:
            self.get_logger().info("three pens set")


def main(args=None):
    rclpy.init(args=args)
    node = PenChanger()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    node.destroy_node()


if __name__ == "__main__":
    main()
