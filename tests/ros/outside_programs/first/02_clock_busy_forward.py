import rclpy
from rclpy.node import Node
from rclpy.time import Duration
from geometry_msgs.msg import Twist


class Forward(Node):

    def __init__(self):
        super().__init__('forward')
        self.cmd_pub = self.create_publisher(Twist, '/cmd_vel', 1)

    def drive(self, speed, seconds):
        msg = Twist()
        msg.linear.x = speed
        start = self.get_clock().now()
        while self.get_clock().now() - start < Duration(seconds=seconds):
            self.cmd_pub.publish(msg)
        self.stop()

    def stop(self):
        self.cmd_pub.publish(Twist())


def main(args=None):
    rclpy.init(args=args)
    node = Forward()
    # wait until the robot listens
    while node.cmd_pub.get_subscription_count() == 0:
        rclpy.spin_once(node, timeout_sec=0.1)
    node.get_logger().info('robot is there, going forward')
    node.drive(0.3, 3)
    node.get_logger().info('going back')
    node.drive(-0.3, 1)
    rclpy.spin_once(node, timeout_sec=0.5)
    node.get_logger().info('done')
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
