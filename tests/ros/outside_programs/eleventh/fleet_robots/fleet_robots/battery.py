import rclpy
from rclpy.node import Node
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from sensor_msgs.msg import BatteryState


class Battery(Node):
    def __init__(self):
        super().__init__('battery', automatically_declare_parameters_from_overrides=True)
        self.charge = self.get_parameter('charge').value
        self.drain = self.get_parameter_or('drain', rclpy.Parameter('drain', value=0.01)).value
        scale = ParameterDescriptor(floating_point_range=[FloatingPointRange(from_value=0.0, to_value=2.0)])
        self.scale = self.declare_parameter('scale', 1.0, scale).value
        self.pub = self.create_publisher(BatteryState, 'battery_state', 10)
        self.create_timer(0.25, self.tick)
        self.get_logger().info(f'{self.get_fully_qualified_name()} starts at {self.charge}')

    def tick(self):
        self.charge = max(0.0, self.charge - self.drain * 0.25 * self.scale)
        msg = BatteryState(percentage=self.charge, present=True)
        msg.power_supply_status = BatteryState.POWER_SUPPLY_STATUS_DISCHARGING
        msg.header.stamp = self.get_clock().now().to_msg()
        msg.header.frame_id = self.get_parameter('frame_prefix').value + 'base_link'
        self.pub.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Battery())
