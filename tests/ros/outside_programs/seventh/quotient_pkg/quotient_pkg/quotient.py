import rclpy
from rclpy.node import Node
from rclpy.subscription import Subscription
from rclpy.publisher import Publisher
from std_msgs.msg import Int16


class Quotient(Node):
    """Outputs x / 5 whenever 5 divides the number that came in."""

    DIVISOR = 5

    def __init__(self) -> None:
        super().__init__('quotient_node')
        self.sub: Subscription = self.create_subscription(Int16, '/rand_num', self.on_number, 10)
        self.pub: Publisher = self.create_publisher(Int16, 'quotient', 10)

    def on_number(self, msg: Int16) -> None:
        quotient, remainder = divmod(msg.data, self.DIVISOR)
        if remainder:
            self.get_logger().debug(f'{msg.data} is not divisible')
            return
        self.pub.publish(Int16(data=quotient))
        self.get_logger().info(f'{msg.data} / {self.DIVISOR} = {quotient}')


def main(args=None):
    try:
        with rclpy.init(args=args):
            rclpy.spin(Quotient())
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
