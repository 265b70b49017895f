"""Go to a goal from odometry with a P controller; parameters goal_x, goal_y; reports the error and the time."""
import math
import rclpy
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from geometry_msgs.msg import Twist, Point
from nav_msgs.msg import Odometry
from tf_transformations import euler_from_quaternion


class GoToGoal(Node):
    def __init__(self):
        super().__init__("go_to_goal")
        self.declare_parameters("", [("dx", 0.5), ("dy", 0.0), ("kp", 0.8), ("tolerance", 0.05)])
        self.pub = self.create_publisher(Twist, "/cmd_vel", 10)
        self.sub = self.create_subscription(Odometry, "/odom", self.on_odom, qos_profile_sensor_data)
        self.goal = None
        self.t0 = self.get_clock().now()

    def on_odom(self, msg):
        p = msg.pose.pose.position
        q = msg.pose.pose.orientation
        _, _, yaw = euler_from_quaternion([q.x, q.y, q.z, q.w])
        if self.goal is None:
            c, s = math.cos(yaw), math.sin(yaw)
            dx = self.get_parameter("dx").get_parameter_value().double_value
            dy = self.get_parameter("dy").value
            self.goal = Point(x=p.x + c * dx - s * dy, y=p.y + s * dx + c * dy, z=0.0)
        ex, ey = self.goal.x - p.x, self.goal.y - p.y
        dist = math.hypot(ex, ey)
        cmd = Twist()
        if dist < self.get_parameter("tolerance").value:
            self.pub.publish(cmd)
            took = (self.get_clock().now() - self.t0).nanoseconds / 1e9
            self.get_logger().info(f"goal reached, error {dist:.3f} m after {took:.1f} s")
            raise SystemExit(0)
        turn = math.atan2(ey, ex) - yaw
        turn = math.atan2(math.sin(turn), math.cos(turn))
        cmd.angular.z = 1.5 * turn
        cmd.linear.x = max(0.0, self.get_parameter("kp").value * dist * math.cos(turn))
        self.pub.publish(cmd)


def main(args=None):
    rclpy.init(args=args)
    node = GoToGoal()
    rclpy.spin(node)


if __name__ == "__main__":
    main()
