"""One program, two drivers: everything is renamed by its arguments, as in the tutorial on node arguments."""
import sys

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from rclpy.utilities import remove_ros_args


class Driver(Node):
    def __init__(self, name):
        super().__init__(name, automatically_declare_parameters_from_overrides=True)
        self.speed = self.get_parameter_or('speed', rclpy.Parameter('speed', value=0.1)).value
        self.laps = self.get_parameter('laps').value if self.has_parameter('laps') else 0
        self.pub = self.create_publisher(Twist, 'drive', 10)
        self.get_logger().info(
            f'{self.get_fully_qualified_name()} speed {self.speed} laps {self.laps} on {self.pub.topic_name}')
        self.create_timer(0.2, self.tick)
        self.left = 10

    def tick(self):
        self.left -= 1
        self.pub.publish(Twist() if self.left <= 0 else Twist(linear=self.vector()))

    def vector(self):
        from geometry_msgs.msg import Vector3
        return Vector3(x=self.speed)


def main():
    rclpy.init(args=sys.argv)
    rest = remove_ros_args(sys.argv)
    print('own arguments', rest[1:])
    first, second = Driver('first'), Driver('second')
    executor = rclpy.executors.SingleThreadedExecutor()
    for node in (first, second):
        executor.add_node(node)
    while first.left > 0 or second.left > 0:
        executor.spin_once()
    rclpy.shutdown()


main()
