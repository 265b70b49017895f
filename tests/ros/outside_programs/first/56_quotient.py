import rclpy
from rclpy.node import Node
from std_msgs.msg import Int16


class Quotient(Node):

    def __init__(self):
        super().__init__('quotient')
        self.pub = self.create_publisher(Int16, 'quotient', 10)
        self.sub = self.create_subscription(Int16, 'rand_num', self.on_number, 10)

    def on_number(self, msg):
        quotient, remainder = divmod(msg.data, 5)
        if remainder == 0:
            out = Int16()
            out.data = quotient
            self.pub.publish(out)
            self.get_logger().info('%d / 5 = %d' % (msg.data, quotient))


def main(args=None):
    rclpy.init(args=args)
    node = Quotient()
    rclpy.spin(node)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
