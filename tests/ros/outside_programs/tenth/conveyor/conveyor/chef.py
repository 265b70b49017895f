import rclpy
from rclpy.node import Node


class Chef(Node):
    def __init__(self):
        super().__init__('chef', automatically_declare_parameters_from_overrides=True)
        for name in ('speed', 'menu.first', 'menu.sizes', 'shift', 'tools', 'note'):
            value = self.get_parameter_or(name).value
            if value is not None and not isinstance(value, (str, float)):
                value = list(value)
            self.get_logger().info(f'{name} = {value!r}')
        menu = self.get_parameters_by_prefix('menu')
        self.get_logger().info('menu: ' + ', '.join(sorted(menu)))
        self.create_timer(0.2, self.leave)

    def leave(self):
        raise SystemExit


def main():
    rclpy.init()
    rclpy.spin(Chef())
