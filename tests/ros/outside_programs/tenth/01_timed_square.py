"""Drive the turtle along a square with one timer and a table of timed moves.

Meant: four sides and four turns by simulated time, a line at each corner, the pen's colour
changed at each corner by the service, and the turtle back where it began (0.3 units, 0.1 rad).
"""
import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from turtlesim.msg import Pose
from turtlesim.srv import SetPen


class TimedSquare(Node):
    SIDE = 2.0
    SPEED = 1.0
    TURN = math.pi / 4

    def __init__(self):
        super().__init__('timed_square')
        self.publisher = self.create_publisher(Twist, 'turtle1/cmd_vel', 10)
        self.create_subscription(Pose, 'turtle1/pose', self.on_pose, 10)
        self.pen = self.create_client(SetPen, 'turtle1/set_pen')
        while not self.pen.wait_for_service(timeout_sec=1.0):
            self.get_logger().info('waiting for the pen')
        self.pose = None
        self.start = None
        self.phase = 0
        self.began = None
        self.timer = self.create_timer(0.05, self.tick)

    def on_pose(self, pose):
        if self.start is None:
            self.start = pose
        self.pose = pose

    def tick(self):
        if self.pose is None:
            return
        now = self.get_clock().now()
        if self.began is None:
            self.began = now
        driving = self.phase % 2 == 0
        length = self.SIDE / self.SPEED if driving else (math.pi / 2) / self.TURN
        if (now - self.began).nanoseconds >= length * 1e9 - 1:
            self.phase += 1
            self.began = now
            if not driving:
                self.corner()
            if self.phase == 8:
                self.publisher.publish(Twist())
                self.timer.cancel()
                self.end_timer = self.create_timer(0.5, self.report)
                return
            driving = self.phase % 2 == 0
        twist = Twist()
        if driving:
            twist.linear.x = self.SPEED
        else:
            twist.angular.z = self.TURN
        self.publisher.publish(twist)

    def corner(self):
        number = self.phase // 2
        request = SetPen.Request(r=60 * number, g=0, b=255 - 60 * number, width=3, off=0)
        self.pen.call_async(request).add_done_callback(
            lambda future, n=number: self.get_logger().info(f'corner {n}, pen {future.result()!r}'))

    def report(self):
        self.end_timer.cancel()
        away = math.hypot(self.pose.x - self.start.x, self.pose.y - self.start.y)
        turned = math.remainder(self.pose.theta - self.start.theta, 2 * math.pi)
        closed = away < 0.3 and abs(turned) < 0.1
        self.get_logger().info(f'square closed: {closed}')
        raise SystemExit


def main():
    rclpy.init()
    node = TimedSquare()
    try:
        rclpy.spin(node)
    except SystemExit:
        rclpy.logging.get_logger('main').info('done')
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
