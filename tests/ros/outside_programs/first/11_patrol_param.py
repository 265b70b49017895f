#!/usr/bin/env python3
import math

import rclpy
from rclpy.node import Node, Parameter
from rclpy.qos import QoSProfile
from geometry_msgs.msg import Twist, Pose2D
from nav_msgs.msg import Odometry
from std_msgs.msg import Int32


class Patrol(Node):
    """Visits the waypoints of the parameter 'waypoints' [x0, y0, x1, y1, ...] 'laps' times."""

    def __init__(self, **kwargs):
        super().__init__('patrol', **kwargs)
        self.declare_parameters(
            namespace='',
            parameters=[
                ('waypoints', [1.5, 0.0, 1.5, 1.5, 0.0, 1.5, 0.0, 0.0]),
                ('tolerance', 0.15),
                ('max_speed', 0.3),
                ('laps', 1),
            ])
        flat = self.get_parameter('waypoints').get_parameter_value().double_array_value
        self.points = list(zip(flat[0::2], flat[1::2]))
        self.tol = self.get_parameter('tolerance').value
        self.vmax = self.get_parameter('max_speed').value
        self.laps = self.get_parameter('laps').get_parameter_value().integer_value
        self.todo = self.points * self.laps
        self.index = 0
        self.stop_ticks = 0
        self.pose = Pose2D()
        self.have_pose = False

        qos = QoSProfile(depth=10)
        self.cmd = self.create_publisher(Twist, 'cmd_vel', qos)
        self.reached = self.create_publisher(Int32, 'patrol/reached', qos)
        self.create_subscription(Odometry, 'odom', self.on_odom, qos)
        self.timer = self.create_timer(0.1, self.on_timer)
        self.get_logger().info('%d waypoints, max speed %.2f' % (len(self.todo), self.vmax))

    def on_odom(self, msg):
        o = msg.pose.pose.orientation
        self.pose.x = msg.pose.pose.position.x
        self.pose.y = msg.pose.pose.position.y
        self.pose.theta = math.atan2(2 * (o.w * o.z + o.x * o.y), 1 - 2 * (o.y * o.y + o.z * o.z))
        self.have_pose = True

    def on_timer(self):
        if not self.have_pose:
            return
        if self.index >= len(self.todo):
            self.cmd.publish(Twist())
            self.stop_ticks += 1
            if self.stop_ticks < 5:
                return
            self.timer.cancel()
            self.get_logger().info('Patrol complete')
            raise SystemExit
        gx, gy = self.todo[self.index]
        dx = gx - self.pose.x
        dy = gy - self.pose.y
        if math.hypot(dx, dy) < self.tol:
            self.get_logger().info(f'Reached waypoint {self.index}: {gx:.1f}, {gy:.1f}')
            self.reached.publish(Int32(data=self.index))
            self.index += 1
            return
        err = math.atan2(dy, dx) - self.pose.theta
        err = math.atan2(math.sin(err), math.cos(err))
        t = Twist()
        t.linear.x = self.vmax * max(0.0, math.cos(err)) ** 3
        t.angular.z = max(min(1.5 * err, 1.0), -1.0)
        self.cmd.publish(t)


def main(args=None):
    rclpy.init(args=args)
    node = Patrol(parameter_overrides=[Parameter('tolerance', Parameter.Type.DOUBLE, 0.2)])
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, SystemExit):
        rclpy.logging.get_logger('main').info('Quitting')
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
