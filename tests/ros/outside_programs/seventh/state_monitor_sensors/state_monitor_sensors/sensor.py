import time

import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import Trigger


class Sensor(Node):
    def __init__(self):
        super().__init__('sensor')
        self.declare_parameters('', [('frequency', 2.0), ('fails_after', 6.0), ('restart_time', 0.5),
                                     ('sensors', [''])])
        name = self.get_name()
        self.ok = True
        self.pub = self.create_publisher(Bool, f'{name}_state', 10)
        self.create_service(Trigger, '~/restart', self.restart, callback_group=MutuallyExclusiveCallbackGroup())
        self.create_timer(1.0 / self.get_parameter('frequency').value, self.tick)
        after = self.get_parameter('fails_after').value
        if after > 0:
            self.failure = self.create_timer(after, self.fail)

    def tick(self):
        self.pub.publish(Bool(data=self.ok))

    def fail(self):
        self.failure.cancel()
        self.ok = False
        self.get_logger().error('I am broken')

    def restart(self, request, response):
        time.sleep(self.get_parameter('restart_time').value)
        self.ok = True
        response.success = True
        response.message = 'restarted'
        return response


def main(args=None):
    rclpy.init(args=args)
    node = Sensor()
    executor = MultiThreadedExecutor()
    rclpy.spin(node, executor=executor)
