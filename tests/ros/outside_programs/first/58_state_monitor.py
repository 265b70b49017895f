#!/usr/bin/env python3
from functools import partial

import rclpy
from rclpy.node import Node
from rclpy.duration import Duration
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from std_msgs.msg import Bool
from std_srvs.srv import Trigger


class StateMonitor(Node):
    """Watches sensors; a sensor that says False or nothing for 'timeout' s is restarted by its service."""

    def __init__(self):
        super().__init__('state_monitor')
        self.declare_parameter('sensors', ['lidar', 'camera'])
        self.declare_parameter('timeout', 1.0)
        self.timeout = Duration(seconds=self.get_parameter('timeout').value)
        self.sensors = self.get_parameter('sensors').get_parameter_value().string_array_value
        self.ok = {}
        self.seen = {}
        self.clients_ = {}
        self.restarting = set()
        group = MutuallyExclusiveCallbackGroup()
        for s in self.sensors:
            self.seen[s] = self.get_clock().now()
            self.ok[s] = True
            self.create_subscription(Bool, f'/{s}_state', partial(self.on_state, s), 10)
            self.clients_[s] = self.create_client(Trigger, f'/{s}/restart', callback_group=group)
        self.pub = self.create_publisher(Bool, '/robot_state', 10)
        self.create_timer(0.25, self.check)

    def on_state(self, sensor, msg):
        self.seen[sensor] = self.get_clock().now()
        self.ok[sensor] = msg.data

    async def check(self):
        now = self.get_clock().now()
        bad = [s for s in self.sensors if not self.ok[s] or now - self.seen[s] > self.timeout]
        self.pub.publish(Bool(data=not bad))
        for s in bad:
            if s in self.restarting or not self.clients_[s].service_is_ready():
                continue
            self.restarting.add(s)
            self.get_logger().error(f'{s} is broken, restarting it')
            result = await self.clients_[s].call_async(Trigger.Request())
            self.get_logger().info(f'{s}: {result.message}')
            self.ok[s] = True
            self.seen[s] = self.get_clock().now()
            self.restarting.discard(s)


def main(args=None):
    rclpy.init(args=args)
    node = StateMonitor()
    executor = MultiThreadedExecutor(num_threads=2)
    executor.add_node(node)
    try:
        executor.spin()
    except KeyboardInterrupt:
        pass
    node.destroy_node()


if __name__ == '__main__':
    main()
