import rclpy
from rclpy.node import Node
from rcl_interfaces.msg import SetParametersResult


class Tuned(Node):
    def __init__(self):
        super().__init__('tuned')
        self.declare_parameter('gain', 1.0)
        self.declare_parameter('name', 'motor')
        self.add_on_set_parameters_callback(self.check)

    def check(self, params):
        for p in params:
            if p.name == 'gain' and p.value < 0:
                return SetParametersResult(successful=False, reason='gain must not be negative')
        return SetParametersResult(successful=True)


rclpy.init()
rclpy.spin(Tuned())
