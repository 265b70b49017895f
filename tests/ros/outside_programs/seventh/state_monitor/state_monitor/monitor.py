from functools import partial

import rclpy
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import Bool
from state_monitor_interfaces.srv import ComponentError


class StateMonitor(Node):
    def __init__(self):
        super().__init__('state_monitor')
        self.declare_parameter('sensors', Parameter.Type.STRING_ARRAY)
        self.declare_parameter('timeout', 2.0)
        self.sensors = self.get_parameter('sensors').get_parameter_value().string_array_value
        self.timeout = Duration(seconds=self.get_parameter('timeout').value)
        self.last = {name: self.get_clock().now() for name in self.sensors}
        self.bad = set()
        self.reported = set()
        self.client = self.create_client(ComponentError, 'component_error')
        self.state_pub = self.create_publisher(Bool, 'robot_state', 1)
        for name in self.sensors:
            self.create_subscription(Bool, f'{name}_state', partial(self.heard, name), 10)
        self.create_timer(0.1, self.check)
        self.before = None

    def heard(self, name, msg):
        self.last[name] = self.get_clock().now()
        if msg.data:
            self.bad.discard(name)
            self.reported.discard(name)
        else:
            self.bad.add(name)

    def check(self):
        now = self.get_clock().now()
        for name in self.sensors:
            if now - self.last[name] > self.timeout:
                self.bad.add(name)
        for name in sorted(self.bad - self.reported):
            if self.client.service_is_ready():
                self.reported.add(name)
                future = self.client.call_async(ComponentError.Request(component=name))
                future.add_done_callback(lambda f, n=name: self.get_logger().info(
                    f'error of {n} reported: accepted={f.result().accepted}'))
        ok = not self.bad
        self.state_pub.publish(Bool(data=ok))
        if ok != self.before:
            self.before = ok
            self.get_logger().info(f'robot state: {"OK" if ok else "ERROR"}')


def main():
    rclpy.init()
    node = StateMonitor()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
