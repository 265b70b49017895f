import sys

import rclpy
from rclpy.node import Node
from std_msgs.msg import Int32
from std_srvs.srv import Trigger


class Counter(Node):
    def __init__(self):
        super().__init__('counter')
        self.declare_parameter('limit', 1000)
        self.count = 0
        self.publisher = self.create_publisher(Int32, 'count', 10)
        self.create_timer(0.1, self.tick)
        self.create_service(Trigger, 'restart', self.restart)
        self.get_logger().info('counting begins')

    def tick(self):
        self.count += 1
        self.publisher.publish(Int32(data=self.count))
        if self.count == self.get_parameter('limit').value:
            self.get_logger().warning('limit reached')
            raise SystemExit(7)

    def restart(self, _request, response):
        response.success, response.message = True, f'was {self.count}'
        self.count = 0
        return response


def main():
    rclpy.init(args=sys.argv)
    node = Counter()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        print('counter is told to stop', file=sys.stderr)
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
