"""Anda em frente até bater, e deve então ser mandado para casa.

O mundo tem um serviço para isso: /move_model, do tipo MoveModel, põe um
modelo numa pose.
"""

import rclpy
from flatland_msgs.msg import Collisions
from flatland_msgs.srv import MoveModel
from geometry_msgs.msg import Pose2D, Twist
from rclpy.node import Node


class Home(Node):
    def __init__(self):
        super().__init__("home")
        # x, y, theta
        self.home = self.declare_parameter("home", [0.0, 0.0, 0.0]).value
        # o nome do robô no mundo
        self.model = self.declare_parameter("model", "serp").value
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Collisions, "collisions", self.on_collisions, 10)
        self.create_timer(0.1, self.go)
        # TODO: um cliente para /move_model

    def go(self):
        command = Twist()
        command.linear.x = 0.6
        self.drive.publish(command)

    def on_collisions(self, message):
        """Chamada dez vezes por segundo; message.collisions diz o que
        toca no robô."""
        if not message.collisions:
            return
        # TODO: pedir que self.model seja posto em self.home


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Home())


if __name__ == "__main__":
    main()
