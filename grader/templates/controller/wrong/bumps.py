"""Round the corner: steer to where there is most room."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

AHEAD = 45


class Corner(Node):
    def __init__(self) -> None:
        super().__init__("corner")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)

    def on_scan(self, scan: LaserScan) -> None:
        room = [10.0 if math.isnan(distance) else distance for distance in scan.ranges]
        # A ray is as good as its neighbours: the robot is not as thin as a ray.
        free = {k: min(room[k - 4 : k + 5]) for k in range(AHEAD - 24, AHEAD + 25)}
        angle = (max(free, key=lambda k: free[k]) - AHEAD) * scan.angle_increment
        command = Twist()
        command.angular.z = 2.0 * angle
        command.linear.x = 0.4 * max(0.0, math.cos(angle)) * min(1.0, free[AHEAD] / 0.5)
        self.drive.publish(command)


def main(args: list[str] | None = None) -> None:
    rclpy.init(args=args)
    rclpy.spin(Corner())


if __name__ == "__main__":
    main()
