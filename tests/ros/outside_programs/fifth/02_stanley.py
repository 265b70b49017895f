"""Stanley controller on a path that another node of this process publishes once, latched."""
import math

import rclpy
from geometry_msgs.msg import PoseStamped, Twist
from nav_msgs.msg import Odometry, Path
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

LATCHED = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class PathServer(Node):
    def __init__(self):
        super().__init__('path_server')
        self.publisher = self.create_publisher(Path, 'plan', LATCHED)
        path = Path()
        path.header.frame_id = 'odom'
        path.header.stamp = self.get_clock().now().to_msg()
        for i in range(81):
            pose = PoseStamped()
            pose.header = path.header
            pose.pose.position.x = 0.05 * i
            pose.pose.position.y = 0.8 * math.sin(0.05 * i * math.pi / 2)
            pose.pose.orientation.w = 1.0
            path.poses.append(pose)
        self.publisher.publish(path)


class Stanley(Node):
    def __init__(self):
        super().__init__('stanley')
        self.path = []
        self.errors = []
        self.finished = False
        self.cmd = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Path, 'plan', self.on_path, LATCHED)
        self.create_subscription(Odometry, 'odom', self.on_odom, 10)

    def on_path(self, path):
        self.path = [(p.pose.position.x, p.pose.position.y) for p in path.poses]
        self.get_logger().info(f'path of {len(self.path)} poses in {path.header.frame_id}')

    def on_odom(self, odom):
        if not self.path or self.finished:
            return
        p, q = odom.pose.pose.position, odom.pose.pose.orientation
        yaw = 2 * math.atan2(q.z, q.w)
        i = min(range(len(self.path)), key=lambda k: math.dist(self.path[k], (p.x, p.y)))
        twist = Twist()
        if i >= len(self.path) - 2:
            self.finished = True
        else:
            (x0, y0), (x1, y1) = self.path[i], self.path[i + 1]
            along = math.atan2(y1 - y0, x1 - x0)
            cross = math.cos(along) * (p.y - y0) - math.sin(along) * (p.x - x0)
            self.errors.append(abs(cross))
            steer = math.remainder(along - yaw, math.tau) - math.atan2(1.5 * cross, 0.4)
            twist.linear.x = 0.4
            twist.angular.z = max(-2.0, min(2.0, 2.5 * steer))
        self.cmd.publish(twist)


def main():
    rclpy.init()
    executor = SingleThreadedExecutor()
    server, follower = PathServer(), Stanley()
    executor.add_node(server)
    executor.add_node(follower)
    try:
        while rclpy.ok() and not follower.finished:
            executor.spin_once(timeout_sec=1.0)
        worst = max(follower.errors)
        follower.get_logger().info('end of path, worst error ' + ('small' if worst < 0.3 else f'{worst:.2f}'))
    finally:
        executor.shutdown()
        follower.destroy_node()
        server.destroy_node()
        rclpy.shutdown()


main()
