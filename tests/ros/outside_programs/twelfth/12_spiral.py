#!/usr/bin/env python3
# catch-all exercise of a first course: turtle1 spirals outwards until it is near the wall, changes its pen, comes home by
# an action and a teleport; a second turtle is spawned where the first one turned back.
import math
from functools import partial

import rclpy
from geometry_msgs.msg import Twist
from rclpy.action import ActionClient
from rclpy.node import Node
from std_srvs.srv import Empty
from turtlesim.action import RotateAbsolute
from turtlesim.msg import Color, Pose
from turtlesim.srv import Kill, SetPen, Spawn, TeleportAbsolute, TeleportRelative


class SpiralNode(Node):
    def __init__(self):
        super().__init__("spiral_turtle")
        self.pose_ = None
        self.state_ = "spiral"
        self.turn_ = 3.0
        self.colors_ = set()
        self.cmd_vel_publisher_ = self.create_publisher(Twist, "turtle1/cmd_vel", 10)
        self.create_subscription(Pose, "turtle1/pose", self.callback_pose, 10)
        self.create_subscription(Color, "turtle1/color_sensor", self.callback_color, 10)
        self.rotate_client_ = ActionClient(self, RotateAbsolute, "turtle1/rotate_absolute")
        self.control_timer_ = self.create_timer(0.1, self.control_loop)
        self.call("turtle1/set_pen", SetPen, SetPen.Request(r=255, g=0, b=0, width=4, off=0), "pen")

    def callback_pose(self, msg):
        self.pose_ = msg

    def callback_color(self, msg):
        self.colors_.add((msg.r, msg.g, msg.b))

    def call(self, name, kind, request, word, then=None):
        client = self.create_client(kind, name)
        while not client.wait_for_service(1.0):
            self.get_logger().warn("Waiting for server...")
        future = client.call_async(request)
        future.add_done_callback(partial(self.callback_called, word=word, then=then))

    def callback_called(self, future, word, then):
        try:
            answer = future.result()
            self.get_logger().info(f"{word} done {getattr(answer, 'name', '')}".strip())
        except Exception as e:
            self.get_logger().error("Service call failed %r" % (e,))
        if then is not None:
            then()

    def control_loop(self):
        if self.pose_ is None or self.state_ != "spiral":
            return
        margin = min(self.pose_.x, self.pose_.y, 11.0 - self.pose_.x, 11.0 - self.pose_.y)
        msg = Twist()
        if margin < 1.5:
            self.cmd_vel_publisher_.publish(msg)
            self.state_ = "home"
            self.call("spawn", Spawn, Spawn.Request(x=self.pose_.x, y=self.pose_.y, theta=0.0, name="mark"), "spawn", self.rotate)
            return
        msg.linear.x = 2.0
        msg.angular.z = self.turn_
        self.turn_ = max(self.turn_ * 0.985, 0.3)
        self.cmd_vel_publisher_.publish(msg)

    def rotate(self):
        self.rotate_client_.wait_for_server()
        goal = RotateAbsolute.Goal()
        goal.theta = math.pi / 2
        self.rotate_client_.send_goal_async(goal, feedback_callback=self.feedback).add_done_callback(self.accepted)

    def feedback(self, feedback_msg):
        self.remaining_ = feedback_msg.feedback.remaining

    def accepted(self, future):
        future.result().get_result_async().add_done_callback(self.rotated)

    def rotated(self, future):
        self.get_logger().info("status %d, error %.2f" % (future.result().status, abs(self.pose_.theta - math.pi / 2)))
        self.call("turtle1/set_pen", SetPen, SetPen.Request(off=1), "pen up", self.teleport)

    def teleport(self):
        self.call("turtle1/teleport_absolute", TeleportAbsolute,
                  TeleportAbsolute.Request(x=5.5, y=5.5, theta=math.pi), "teleport", self.forward)

    def forward(self):
        self.call("turtle1/teleport_relative", TeleportRelative,
                  TeleportRelative.Request(linear=1.0, angular=math.pi / 2), "relative", self.clear)

    def clear(self):
        self.call("clear", Empty, Empty.Request(), "clear", self.last)

    def last(self):
        self.create_timer(0.5, self.finish)

    def finish(self):
        self.get_logger().info("home at %.1f %.1f %.2f, colors %d" % (
            self.pose_.x, self.pose_.y, self.pose_.theta, len(self.colors_)))
        raise SystemExit


def main(args=None):
    rclpy.init(args=args)
    node = SpiralNode()
    try:
        rclpy.spin(node)
    except SystemExit:
        pass
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
