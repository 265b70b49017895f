import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist
import math


class DrawSquare(Node):

    def __init__(self):
        super().__init__('draw_square')
        self.declare_parameter('side', 2.0)
        self.pub = self.create_publisher(Twist, 'turtle1/cmd_vel', 10)
        self.period = 0.02
        self.timer = self.create_timer(self.period, self.loop)
        self.phase = 'wait'
        self.count = 0
        self.corners = 0

    def loop(self):
        side = self.get_parameter('side').get_parameter_value().double_value
        msg = Twist()
        if self.phase == 'wait':
            if self.pub.get_subscription_count() > 0:
                self.phase = 'line'
            return
        self.count += 1
        if self.phase == 'line':
            msg.linear.x = 1.0
            if self.count * self.period >= side:
                self.phase, self.count = 'turn', 0
        elif self.phase == 'turn':
            msg.angular.z = 1.0
            if self.count * self.period >= math.pi / 2:
                self.phase, self.count = 'line', 0
                self.corners += 1
                if self.corners == 4:
                    self.phase = 'stop'
        else:
            self.get_logger().info('Square drawn.', once=True)
        self.pub.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    n = DrawSquare()
    rclpy.spin(n)
    n.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
