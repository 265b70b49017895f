import rclpy
from rclpy.node import Node
from rclpy.parameter import Parameter


class Other(Node):
    def __init__(self):
        super().__init__('other_node')
        self.declare_parameter('a_double_param', 1.0)
        self.value = 3.0
        self.create_timer(1.0, self.change)

    def change(self):
        self.value += 0.4
        self.set_parameters([Parameter('a_double_param', Parameter.Type.DOUBLE, self.value)])


rclpy.init()
rclpy.spin(Other())
