"""Walks an L in Lisbon: 29 m east, then 30 m north, a fix every 0.1 s; every tenth is lost."""
import math

import rclpy
from rclpy.node import Node
from sensor_msgs.msg import NavSatFix, NavSatStatus


class FakeGps(Node):
    def __init__(self):
        super().__init__("fake_gps")
        self.pub = self.create_publisher(NavSatFix, "fix", 10)
        self.n = 0
        self.lost = 0
        self.create_timer(0.1, self.tick)

    def tick(self):
        if self.pub.get_subscription_count() < 1:
            return
        fix = NavSatFix()
        fix.header.stamp = self.get_clock().now().to_msg()
        fix.header.frame_id = "gps"
        fix.status.service = NavSatStatus.SERVICE_GPS
        if (self.n + self.lost) % 10 == 9:
            self.lost += 1
            fix.status.status = NavSatStatus.STATUS_NO_FIX
            fix.latitude = fix.longitude = math.nan
        else:
            fix.status.status = NavSatStatus.STATUS_FIX
            east, north = min(self.n, 29), max(0, self.n - 29)
            fix.latitude = 38.7369 + math.degrees(north / 6378137.0)
            fix.longitude = -9.1427 + math.degrees(east / 6378137.0 / math.cos(math.radians(38.7369)))
            fix.position_covariance_type = NavSatFix.COVARIANCE_TYPE_UNKNOWN
            self.n += 1
        self.pub.publish(fix)


rclpy.init()
rclpy.spin(FakeGps())
