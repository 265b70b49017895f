#!/usr/bin/env python3
# lidar says False after 4 s, camera falls silent after 7 s; each works again after its restart
import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import Trigger


class Sensor(Node):
    def __init__(self, name, fail_after, silent):
        super().__init__(name)
        self.pub = self.create_publisher(Bool, f'/{name}_state', 10)
        self.create_service(Trigger, f'/{name}/restart', self.restart)
        self.left = int(fail_after / 0.2)
        self.silent = silent
        self.create_timer(0.2, self.tick)

    def tick(self):
        self.left -= 1
        if self.left > 0:
            self.pub.publish(Bool(data=True))
        elif not self.silent:
            self.pub.publish(Bool(data=False))

    def restart(self, request, response):
        self.left = 10000
        response.success = True
        response.message = 'restarted'
        return response


rclpy.init()
executor = rclpy.executors.SingleThreadedExecutor()
nodes = [Sensor('lidar', 4.0, False), Sensor('camera', 7.0, True)]
for n in nodes:
    executor.add_node(n)
executor.spin()
