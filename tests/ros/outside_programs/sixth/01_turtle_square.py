"""Turtlesim: draw a square of side 2 by a state machine on the pose, then stop."""
import math
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist
from turtlesim.msg import Pose


class Square(Node):
    def __init__(self):
        super().__init__("turtle_square")
        self.pub = self.create_publisher(Twist, "turtle1/cmd_vel", 10)
        self.create_subscription(Pose, "turtle1/pose", self.on_pose, 10)
        self.pose = None
        self.sides = 0
        self.state = "forward"
        self.origin = None
        self.done = rclpy.task.Future()
        self.timer = self.create_timer(0.02, self.tick)

    def on_pose(self, msg):
        self.pose = msg

    def tick(self):
        if self.pose is None:
            return
        cmd = Twist()
        if self.origin is None:
            self.origin = (self.pose.x, self.pose.y)
            self.heading = self.pose.theta
            self.start = self.origin
        if self.state == "forward":
            left = 2.0 - math.dist(self.origin, (self.pose.x, self.pose.y))
            if left < 0.01:
                self.sides += 1
                self.state = "turn"
                self.heading = math.atan2(math.sin(self.heading + math.pi / 2), math.cos(self.heading + math.pi / 2))
            else:
                cmd.linear.x = min(1.0, 2.0 * left + 0.05)
        elif self.state == "turn":
            err = math.atan2(math.sin(self.heading - self.pose.theta), math.cos(self.heading - self.pose.theta))
            if abs(err) < 0.005:
                if self.sides == 4:
                    self.get_logger().info("square done, %.2f from the start" % math.dist(self.start, (self.pose.x, self.pose.y)))
                    self.done.set_result(True)
                    self.timer.cancel()
                self.state = "forward"
                self.origin = (self.pose.x, self.pose.y)
            else:
                cmd.angular.z = max(-1.5, min(1.5, 3.0 * err))
        self.pub.publish(cmd)


def main(args=None):
    rclpy.init(args=args)
    node = Square()
    rclpy.spin_until_future_complete(node, node.done)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
