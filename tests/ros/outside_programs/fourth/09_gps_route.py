import math
from collections import deque

import rclpy
from geometry_msgs.msg import PointStamped
from nav_msgs.msg import Path
from geometry_msgs.msg import PoseStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import NavSatFix, NavSatStatus

EARTH = 6378137.0


class GpsRoute(Node):
    def __init__(self):
        super().__init__("gps_route", parameter_overrides=[])
        self.datum = None
        self.window = deque(maxlen=5)
        self.total = 0.0
        self.path = Path()
        self.path.header.frame_id = "map"
        self.path_pub = self.create_publisher(Path, "gps/path", 1)
        self.local_pub = self.create_publisher(PointStamped, "gps/local", 10)
        self.lost = 0
        self.sub = self.create_subscription(NavSatFix, "fix", self.on_fix, 10)

    def on_fix(self, fix: NavSatFix) -> None:
        if fix.status.status == NavSatStatus.STATUS_NO_FIX or math.isnan(fix.latitude):
            self.lost += 1
            self.get_logger().warning("no fix", once=True)
            return
        here = fix
        if self.datum is None:
            self.datum = here
            self.get_logger().info(f"datum {here.latitude:.4f} {here.longitude:.4f}")
        east = math.radians(here.longitude - self.datum.longitude) * EARTH * math.cos(math.radians(self.datum.latitude))
        north = math.radians(here.latitude - self.datum.latitude) * EARTH
        self.window.append((east, north))
        x = sum(p[0] for p in self.window) / len(self.window)
        y = sum(p[1] for p in self.window) / len(self.window)
        point = PointStamped()
        point.header = fix.header
        point.point.x, point.point.y = x, y
        self.local_pub.publish(point)
        pose = PoseStamped(header=point.header)
        pose.pose.position = point.point
        if self.path.poses:
            last = self.path.poses[-1].pose.position
            self.total += math.hypot(x - last.x, y - last.y)
        self.path.poses.append(pose)
        self.path.header.stamp = fix.header.stamp
        self.path_pub.publish(self.path)
        if len(self.path.poses) == 60:
            self.get_logger().info(f"walked {self.total:.0f} m, {self.lost} fixes lost")
            raise ExternalShutdownException()


def main():
    try:
        with rclpy.init():
            rclpy.spin(GpsRoute())
    except (KeyboardInterrupt, ExternalShutdownException):
        print("bye")


main()
