"""Anda em frente, a uma velocidade que outros podem mudar; e para quando
lho pedem."""

import rclpy
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from std_srvs.srv import Trigger


class Limited(Node):
    def __init__(self):
        super().__init__("limited")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.go)
        # TODO: um parâmetro, limit, em m/s, 0.3 por omissão; os
        # negativos são recusados
        # TODO: um serviço, halt, do tipo Trigger

    def go(self):
        command = Twist()
        command.linear.x = 0.1  # TODO: o limite, tal como está agora
        self.drive.publish(command)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Limited())


if __name__ == "__main__":
    main()
