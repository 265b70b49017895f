import math

import rclpy
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.node import Node
from std_msgs.msg import Float32


class Station(Node):

    def __init__(self):
        super().__init__('station')
        rate = self.declare_parameter(
            'rate', 1.0,
            ParameterDescriptor(
                description='readings per second',
                floating_point_range=[FloatingPointRange(from_value=0.1, to_value=20.0, step=0.0)]))
        self.declare_parameter('base', 0.0)
        self.declare_parameter('sensors', ['temperature'])
        self.publishers_by_sensor = {
            sensor: self.create_publisher(Float32, sensor, 10)
            for sensor in self.get_parameter('sensors').get_parameter_value().string_array_value
        }
        self.count = 0
        self.create_timer(1.0 / rate.value, self.measure)
        self.get_logger().info(
            f'{self.get_fully_qualified_name()} measures {", ".join(self.publishers_by_sensor)} at {rate.value} Hz')

    def measure(self):
        self.count += 1
        value = self.get_parameter('base').value + math.sin(self.count / 10)
        for sensor, publisher in self.publishers_by_sensor.items():
            publisher.publish(Float32(data=value if sensor == 'temperature' else abs(value)))


def main(args=None):
    rclpy.init(args=args)
    node = Station()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
