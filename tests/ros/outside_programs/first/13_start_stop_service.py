#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist
from std_srvs.srv import SetBool


class CircleDriver(Node):
    def __init__(self):
        super().__init__('circle_driver')
        self.driving = False
        self.srv = self.create_service(SetBool, 'drive', self.drive_callback)
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.timer = self.create_timer(0.1, self.tick)
        self.get_logger().info('Service Server Ready')

    def drive_callback(self, request, response):
        self.driving = request.data
        if request.data:
            response.message = 'driving in a circle'
        else:
            response.message = 'standing still'
        response.success = True
        return response

    def tick(self):
        cmd = Twist()
        if self.driving:
            cmd.linear.x = 0.3
            cmd.angular.z = 0.6
        self.pub.publish(cmd)


def main(args=None):
    rclpy.init(args=args)
    node = CircleDriver()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
