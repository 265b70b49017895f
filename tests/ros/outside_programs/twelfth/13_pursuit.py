"""Pure pursuit: follows a path of arcs that a latched topic brings, publishes the point it looks at, stops at the end."""
import math

import rclpy
from geometry_msgs.msg import PointStamped, PoseStamped, Twist
from nav_msgs.msg import Odometry, Path
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL, reliability=ReliabilityPolicy.RELIABLE)


class Planner(Node):
    """An S of two half circles of 1 m radius, published once."""

    def __init__(self):
        super().__init__('planner')
        path = Path()
        path.header.frame_id = 'odom'
        path.header.stamp = self.get_clock().now().to_msg()
        for number in range(101):
            angle = math.pi * number / 50
            pose = PoseStamped(header=path.header)
            if angle <= math.pi:
                pose.pose.position.x, pose.pose.position.y = math.sin(angle), 1 - math.cos(angle)
            else:
                pose.pose.position.x, pose.pose.position.y = math.sin(angle), 3 + math.cos(angle - math.pi) * -1
            path.poses.append(pose)
        self.publisher = self.create_publisher(Path, 'plan', LATCHED)
        self.publisher.publish(path)


class Pursuit(Node):
    def __init__(self):
        super().__init__('pursuit')
        self.speed = self.declare_parameter('speed', 0.4).value
        self.ahead = self.declare_parameter('lookahead', 0.3).get_parameter_value().double_value
        self.path = []
        self.next = 0
        self.worst = 0.0
        self.pose = None
        self.done = rclpy.task.Future()
        self.create_subscription(Path, 'plan', self.on_path, LATCHED)
        self.create_subscription(Odometry, 'odom', self.on_odom, 10)
        self.command = self.create_publisher(Twist, 'cmd_vel', 10)
        self.carrot = self.create_publisher(PointStamped, 'carrot', 10)
        self.timer = self.create_timer(1 / 20, self.control)

    def on_path(self, message):
        self.path = [(each.pose.position.x, each.pose.position.y) for each in message.poses]
        self.get_logger().info(f'path of {len(self.path)} poses in {message.header.frame_id}')

    def on_odom(self, message):
        position, q = message.pose.pose.position, message.pose.pose.orientation
        self.pose = position.x, position.y, math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y ** 2 + q.z ** 2))

    def control(self):
        if not self.path or self.pose is None:
            return
        x, y, yaw = self.pose
        while self.next < len(self.path) - 1 and math.dist(self.path[self.next], (x, y)) < self.ahead:
            self.next += 1
        self.worst = max(self.worst, min(math.dist(each, (x, y)) for each in self.path))
        gx, gy = self.path[self.next]
        if self.next == len(self.path) - 1 and math.dist((gx, gy), (x, y)) < 0.1:
            self.command.publish(Twist())
            self.timer.cancel()
            self.done.set_result(self.worst)
            return
        message = PointStamped()
        message.header.frame_id = 'odom'
        message.header.stamp = self.get_clock().now().to_msg()
        message.point.x, message.point.y = gx, gy
        self.carrot.publish(message)
        local_y = -math.sin(yaw) * (gx - x) + math.cos(yaw) * (gy - y)
        curvature = 2 * local_y / max((gx - x) ** 2 + (gy - y) ** 2, 1e-6)
        twist = Twist()
        twist.linear.x = self.speed
        twist.angular.z = max(-2.0, min(2.0, self.speed * curvature))
        self.command.publish(twist)


def main(args=None):
    rclpy.init(args=args)
    planner, pursuit = Planner(), Pursuit()
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(planner)
    executor.add_node(pursuit)
    executor.spin_until_future_complete(pursuit.done)
    pursuit.get_logger().info(f'arrived, worst deviation {pursuit.done.result():.2f} m')
    end = pursuit.get_clock().now() + rclpy.duration.Duration(seconds=0.5)
    while pursuit.get_clock().now() < end:
        executor.spin_once(timeout_sec=0.1)
    rclpy.shutdown()


if __name__ == '__main__':
    main()
