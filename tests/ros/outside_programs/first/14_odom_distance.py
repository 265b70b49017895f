import rclpy
from rclpy.node import Node
from rclpy.subscription import Subscription
from rclpy.publisher import Publisher
from rclpy.timer import Timer
from nav_msgs.msg import Odometry
from geometry_msgs.msg import Twist
from std_msgs.msg import Float64
import math


class DistanceCounter(Node):
    sub: Subscription
    total_pub: Publisher
    timer: Timer

    def __init__(self) -> None:
        super().__init__("distance_counter")
        self.last_xy = None
        self.total = 0.0
        self.sub = self.create_subscription(Odometry, "odom", self.on_odom, 10)
        self.total_pub = self.create_publisher(Float64, "moved_distance", 10)
        self.cmd_pub = self.create_publisher(Twist, "cmd_vel", 10)
        self.timer = self.create_timer(0.2, self.drive)
        self.stopped = False

    def on_odom(self, msg: Odometry) -> None:
        xy = (msg.pose.pose.position.x, msg.pose.pose.position.y)
        if self.last_xy is not None:
            self.total += math.dist(xy, self.last_xy)
        self.last_xy = xy
        self.total_pub.publish(Float64(data=self.total))

    def drive(self) -> None:
        out = Twist()
        if self.total < 2.0:
            out.linear.x = 0.4
            out.angular.z = 0.4
        elif not self.stopped:
            self.stopped = True
            self.get_logger().info(f"I have moved {self.total:.1f} metres")
        self.cmd_pub.publish(out)


def main():
    rclpy.init()
    rclpy.spin(DistanceCounter())


if __name__ == "__main__":
    main()
