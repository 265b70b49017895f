#!/usr/bin/env python3
import math
import rclpy
from rclpy.node import Node
from builtin_interfaces.msg import Duration
from geometry_msgs.msg import Point, PoseStamped, Twist
from nav_msgs.msg import Odometry, Path
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray


class Trail(Node):
    def __init__(self):
        super().__init__('trail')
        self.path = Path(header=Header(frame_id='odom'))
        self.path_pub = self.create_publisher(Path, '/trail/path', 10)
        self.marker_pub = self.create_publisher(MarkerArray, '/trail/markers', 10)
        self.cmd_pub = self.create_publisher(Twist, '/cmd_vel', 10)
        self.odom_sub = self.create_subscription(Odometry, '/odom', self.odom_callback, 10)
        self.marker_timer = self.create_timer(0.5, self.markers)
        self.cmd_timer = self.create_timer(0.1, self.drive)
        self.finished = False

    def odom_callback(self, msg: Odometry):
        pose = PoseStamped(header=msg.header, pose=msg.pose.pose)
        if self.path.poses:
            a, b = self.path.poses[-1].pose.position, pose.pose.position
            if math.hypot(a.x - b.x, a.y - b.y) < 0.1:
                return
        self.path.poses.append(pose)
        self.path.header.stamp = msg.header.stamp
        self.path_pub.publish(self.path)

    def markers(self):
        arr = MarkerArray()
        line = Marker()
        line.header.frame_id = 'odom'
        line.header.stamp = self.get_clock().now().to_msg()
        line.ns, line.id = 'trail', 0
        line.type, line.action = Marker.LINE_STRIP, Marker.ADD
        line.scale.x = 0.03
        line.color = ColorRGBA(r=1.0, g=0.5, b=0.0, a=1.0)
        line.lifetime = Duration(sec=2, nanosec=0)
        line.points = [Point(x=p.pose.position.x, y=p.pose.position.y, z=0.0) for p in self.path.poses]
        arr.markers.append(line)
        for i, p in enumerate(self.path.poses[::5]):
            m = Marker(type=Marker.SPHERE, id=i + 1, ns='trail')
            m.header = line.header
            m.pose = p.pose
            m.scale.x = m.scale.y = m.scale.z = 0.1
            m.color.a = m.color.g = 1.0
            arr.markers.append(m)
        self.marker_pub.publish(arr)

    def drive(self):
        t = Twist()
        if len(self.path.poses) < 25:
            t.linear.x, t.angular.z = 0.4, -0.25
        elif not self.finished:
            self.finished = True
            self.get_logger().info(f'{len(self.path.poses)} poses in the path')
        self.cmd_pub.publish(t)


def main(args=None):
    rclpy.init(args=args)
    node = Trail()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        node.get_logger().info('interrupted')


if __name__ == '__main__':
    main()
