#!/usr/bin/env python3
import math
import threading
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist, Pose
from nav_msgs.msg import Odometry


class Mailbox:
    """holds the newest message; get() waits for one that is newer than the last one taken"""

    def __init__(self):
        self.cond = threading.Condition()
        self.msg = None
        self.count = 0
        self.taken = 0

    def put(self, msg):
        with self.cond:
            self.msg = msg
            self.count += 1
            self.cond.notify_all()

    def get(self, timeout=None):
        with self.cond:
            if not self.cond.wait_for(lambda: self.count > self.taken, timeout=timeout):
                return None
            self.taken = self.count
            return self.msg


class Robot(Node):
    def __init__(self):
        super().__init__('mailbox_robot')
        self.box = Mailbox()
        self.silent_box = Mailbox()
        self.sub = self.create_subscription(Odometry, 'odom', self.box.put, 10)
        self.sub2 = self.create_subscription(Pose, 'nobody_publishes_this', self.silent_box.put, 10)
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)

    def go(self, metres, speed=0.4):
        p0 = self.box.get().pose.pose.position
        d = 0.0
        while d < metres:
            msg = Twist()
            msg.linear.x = speed
            self.pub.publish(msg)
            odom = self.box.get(timeout=1.0)
            if odom is None:
                self.get_logger().error('odometry is silent')
                break
            p = odom.pose.pose.position
            d = math.hypot(p.x - p0.x, p.y - p0.y)
        self.pub.publish(Twist())
        return d


def main(args=None):
    rclpy.init(args=args)
    robot = Robot()
    spinner = threading.Thread(target=rclpy.spin, args=(robot,), daemon=True)
    spinner.start()
    t0 = robot.get_clock().now().nanoseconds
    nothing = robot.silent_box.get(timeout=1.5)
    waited = (robot.get_clock().now().nanoseconds - t0) * 1e-9
    print(f'silent topic: {nothing} after {waited:.1f} s')
    for leg in (1.0, 0.5):
        print('went %.2f m' % robot.go(leg))
    robot.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
