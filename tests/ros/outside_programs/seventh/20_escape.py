"""Asks a Trigger service where there is room and drives there; and a static sensor frame seen by tf2."""
import math

import rclpy
import tf2_geometry_msgs  # noqa: F401
from geometry_msgs.msg import PointStamped, TransformStamped, Twist
from nav_msgs.msg import Odometry
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_srvs.srv import Trigger
from tf2_ros import Buffer, StaticTransformBroadcaster, TransformListener, TransformBroadcaster


class CrashDirection(Node):
    def __init__(self):
        super().__init__('crash_direction')
        self.scan = None
        self.create_subscription(LaserScan, 'scan', self.keep, rclpy.qos.qos_profile_sensor_data)
        self.create_service(Trigger, '/crash_direction_service', self.answer)
        self.static = StaticTransformBroadcaster(self)
        t = TransformStamped()
        t.header.stamp = self.get_clock().now().to_msg()
        t.header.frame_id, t.child_frame_id = 'my_base', 'my_mast'
        t.transform.translation.x, t.transform.translation.z = 0.1, 0.5
        t.transform.rotation.z = math.sin(math.pi / 4)
        t.transform.rotation.w = math.cos(math.pi / 4)
        self.static.sendTransform(t)
        self.moving = TransformBroadcaster(self)
        self.create_subscription(Odometry, 'odom', self.on_odom, 10)

    def on_odom(self, m):
        t = TransformStamped(header=m.header, child_frame_id='my_base')
        t.header.frame_id = 'my_odom'
        t.transform.translation.x = m.pose.pose.position.x
        t.transform.translation.y = m.pose.pose.position.y
        t.transform.rotation = m.pose.pose.orientation
        self.moving.sendTransform(t)

    def keep(self, msg):
        self.scan = msg

    def answer(self, request: Trigger.Request, response: Trigger.Response):
        if self.scan is None:
            response.message = 'no scan'
            return response
        best = {}
        for name, a in (('front', 0.0), ('left', math.pi / 2), ('right', -math.pi / 2)):
            i = round(((a - self.scan.angle_min) % (2 * math.pi)) / self.scan.angle_increment) % len(self.scan.ranges)
            r = self.scan.ranges[i]
            best[name] = r if math.isfinite(r) else self.scan.range_max
        response.success = True
        response.message = max(best, key=best.get)
        return response


class Escape(Node):
    def __init__(self):
        super().__init__('escape')
        group = MutuallyExclusiveCallbackGroup()
        self.cli = self.create_client(Trigger, '/crash_direction_service', callback_group=group)
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.start = self.create_timer(0.5, self.go)
        self.answers = []

    def wait(self, seconds):
        self.get_clock().sleep_for(rclpy.duration.Duration(seconds=seconds))

    def drive(self, seconds, v, w):
        msg = Twist()
        msg.linear.x, msg.angular.z = v, w
        end = self.get_clock().now() + rclpy.duration.Duration(seconds=seconds)
        while self.get_clock().now() < end:
            self.pub.publish(msg)
            self.wait(0.05)
        self.pub.publish(Twist())

    def go(self):
        self.start.cancel()
        self.cli.wait_for_service()
        while True:
            answer = self.cli.call(Trigger.Request())
            if answer.success:
                break
            self.wait(0.1)
        self.get_logger().info(f'room: {answer.message}')
        turn = {'front': 0.0, 'left': 1.0, 'right': -1.0}[answer.message]
        self.drive(math.pi / 2, 0.0, turn)
        can = self.buffer.can_transform('my_odom', 'my_mast', rclpy.time.Time(), timeout=rclpy.duration.Duration(seconds=2.0))
        self.get_logger().info(f'tf: {can}')
        p = PointStamped()
        p.header.frame_id = 'my_mast'
        p.point.x = 1.0
        before = self.buffer.transform(p, 'my_base')
        self.get_logger().info(f'one ahead of the mast: {before.point.x:.1f} {before.point.y:.1f} {before.point.z:.1f}')
        a = self.buffer.lookup_transform('my_odom', 'my_base', rclpy.time.Time()).transform.translation
        self.drive(2.0, 0.2, 0.0)
        self.wait(0.3)
        b = self.buffer.lookup_transform('my_odom', 'my_base', rclpy.time.Time()).transform.translation
        self.get_logger().info(f'driven {math.hypot(b.x - a.x, b.y - a.y):.1f} m')
        frames = self.buffer.all_frames_as_yaml()
        self.get_logger().info(f'frames: {"my_mast" in frames and "my_base" in frames}')
        rclpy.get_default_context().on_shutdown(lambda: print('shut down'))
        rclpy.shutdown()


def main():
    rclpy.init()
    executor = MultiThreadedExecutor()
    executor.add_node(CrashDirection())
    executor.add_node(Escape())
    try:
        executor.spin()
    except rclpy.executors.ExternalShutdownException:
        print('ended from inside')


if __name__ == '__main__':
    main()
