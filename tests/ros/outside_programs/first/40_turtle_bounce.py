import rclpy, random
from rclpy.node import Node
from rclpy.publisher import Publisher
from geometry_msgs.msg import Twist
from turtlesim.msg import Pose

LOW, HIGH = 1.5, 9.5

class Bouncer(Node):
    """Swims about without ever touching the window's edge"""
    def __init__(self):
        super().__init__('bouncer')
        self.cmd: Publisher = self.create_publisher(Twist, '/turtle1/cmd_vel', 10)
        self.create_subscription(Pose, '/turtle1/pose', self.on_pose, 10)
        self.inside = True
        self.near = 0
        self.lo = 99.0
        self.hi = -99.0
        self.create_timer(30.0, self.report)

    def on_pose(self, pose):
        self.lo = min(self.lo, pose.x, pose.y)
        self.hi = max(self.hi, pose.x, pose.y)
        out = pose.x < LOW or pose.x > HIGH or pose.y < LOW or pose.y > HIGH
        t = Twist()
        if out:
            if self.inside:
                self.near += 1
                self.get_logger().info('edge ahead! (%d)' % self.near)
            t.linear.x = 1.0
            t.angular.z = 2.0
        else:
            t.linear.x = 2.5
        self.inside = not out
        self.cmd.publish(t)

    def report(self):
        verdict = 'never touched' if self.lo > 0.05 and self.hi < 11.0 else 'TOUCHED'
        self.get_logger().info('%s the edge, range %.1f..%.1f' % (verdict, self.lo, self.hi))


def main():
    rclpy.init()
    rclpy.spin(Bouncer())

if __name__ == '__main__':
    main()
