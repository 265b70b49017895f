"""Follow the wall on the right with a PD controller at 0.4 m."""
import math
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan
import rclpy.qos


class WallFollower(Node):
    def __init__(self):
        super().__init__("wall_follower", parameter_overrides=[rclpy.Parameter("side", rclpy.Parameter.Type.STRING, "right")])
        self.side = -1 if self.declare_parameter("side", "left").value == "right" else 1
        self.want = self.declare_parameter("distance", 0.4).value
        self.scan = None
        self.last = 0.0
        self.samples = []
        self.sub = self.create_subscription(LaserScan, "/scan", self.cb, rclpy.qos.qos_profile_sensor_data)
        self.pub = self.create_publisher(Twist, "/cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.control)
        self.report = self.create_timer(10.0, self.tell)

    def cb(self, msg):
        self.scan = msg

    def at(self, angle):
        s = self.scan
        i = round((angle - s.angle_min) / s.angle_increment) % len(s.ranges)
        r = s.ranges[i]
        return s.range_max if math.isinf(r) or math.isnan(r) or r < s.range_min else r

    def control(self):
        if self.scan is None:
            return
        front = min(self.at(math.radians(a)) for a in range(-20, 21, 5))
        wall = min(self.at(self.side * math.radians(a)) for a in range(40, 111, 5))
        self.samples.append(wall)
        t = Twist()
        if front < 0.45:
            t.angular.z = -self.side * 1.0
        else:
            t.linear.x = 0.12
            if wall < 1.0:
                e = wall - self.want
                t.angular.z = self.side * max(-0.9, min(0.9, 2.0 * e + 4.0 * (e - self.last)))
                self.last = e
        self.pub.publish(t)

    def tell(self):
        near = sum(abs(s - self.want) < 0.2 for s in self.samples) / len(self.samples)
        self.get_logger().info("%d of 100 samples near the wall" % round(100 * near))
        self.samples.clear()


def main():
    rclpy.init()
    rclpy.spin(WallFollower())


if __name__ == "__main__":
    main()
