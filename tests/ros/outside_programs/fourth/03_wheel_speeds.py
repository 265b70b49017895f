"""Inverse and forward kinematics of a differential drive (wheel radius 33 mm, track 0.16 m)."""
import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from nav_msgs.msg import Odometry
from rclpy.node import Node
from std_msgs.msg import Float32MultiArray, MultiArrayDimension

R = 0.033
L = 0.16


class WheelSpeeds(Node):
    def __init__(self):
        super().__init__("wheel_speeds")
        self.declare_parameter("radius", R)
        self.declare_parameter("track", L)
        self.wheels = self.create_publisher(Float32MultiArray, "wheel_speeds", 10)
        self.estimate = self.create_publisher(TwistStamped, "estimated_twist", 10)
        self.create_subscription(Twist, "cmd_vel", self.to_wheels, 10)
        self.create_subscription(Float32MultiArray, "wheel_speeds", self.to_body, 10)
        self.create_subscription(Odometry, "odom", self.compare, 10)
        self.cmd = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.drive)
        self.ticks = 0
        self.last = None
        self.worst = 0.0

    def drive(self):
        self.ticks += 1
        msg = Twist()
        if self.ticks <= 60:
            msg.linear.x = 0.3
            msg.angular.z = 0.3
        self.cmd.publish(msg)
        if self.ticks == 65:
            self.get_logger().info(f"worst difference {self.worst:.3f}")
            raise SystemExit

    def to_wheels(self, twist):
        radius = self.get_parameter("radius").get_parameter_value().double_value
        track = self.get_parameter("track").value
        left = (twist.linear.x - twist.angular.z * track / 2) / radius
        right = (twist.linear.x + twist.angular.z * track / 2) / radius
        out = Float32MultiArray()
        out.layout.dim.append(MultiArrayDimension(label="wheel", size=2, stride=2))
        out.data = [left, right]
        self.wheels.publish(out)

    def to_body(self, wheels):
        left, right = wheels.data
        est = TwistStamped()
        est.header.stamp = self.get_clock().now().to_msg()
        est.header.frame_id = "base_link"
        est.twist.linear.x = R * (left + right) / 2
        est.twist.angular.z = R * (right - left) / L
        self.estimate.publish(est)
        self.last = est.twist
        if self.ticks == 30:
            print("wheels %.2f %.2f" % (left, right))

    def compare(self, odom):
        if self.last is not None and 20 < self.ticks < 55:
            self.worst = max(self.worst, abs(odom.twist.twist.linear.x - self.last.linear.x),
                             abs(odom.twist.twist.angular.z - self.last.angular.z))


def main():
    rclpy.init()
    node = WheelSpeeds()
    try:
        rclpy.spin(node)
    except SystemExit:
        print("done")
    node.destroy_node()
    rclpy.shutdown()


main()
