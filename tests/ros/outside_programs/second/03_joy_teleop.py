#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from rclpy.node import QoSProfile
from sensor_msgs.msg import Joy
from geometry_msgs.msg import Twist


class JoyTeleop(Node):
    """axis 1: linear, axis 3: angular, button 4 must be held (enable), button 5: turbo"""

    def __init__(self):
        super().__init__('joy_teleop')
        p = self.declare_parameters('', [
            ('axis_linear', 1), ('axis_angular', 3), ('scale_linear', 0.2), ('scale_linear_turbo', 0.4),
            ('scale_angular', 0.5), ('enable_button', 4), ('turbo_button', 5)])
        self.p = {x.name: x.value for x in p}
        self.enabled = False
        self.pub = self.create_publisher(Twist, 'cmd_vel', QoSProfile(depth=10))
        self.sub = self.create_subscription(Joy, 'joy', self.on_joy, QoSProfile(depth=10))

    def on_joy(self, joy):
        p = self.p
        t = Twist()
        if joy.buttons[p['enable_button']]:
            scale = p['scale_linear_turbo'] if joy.buttons[p['turbo_button']] else p['scale_linear']
            t.linear.x = joy.axes[p['axis_linear']] * scale
            t.angular.z = joy.axes[p['axis_angular']] * p['scale_angular']
            self.pub.publish(t)
            if not self.enabled:
                self.get_logger().info('enabled')
            self.enabled = True
        elif self.enabled:
            # released: stop exactly once
            self.pub.publish(t)
            self.get_logger().info('released')
            self.enabled = False


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(JoyTeleop())


if __name__ == '__main__':
    main()
