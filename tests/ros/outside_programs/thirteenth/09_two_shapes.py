"""Two turtles draw at the same time, a triangle and a square, each closing its shape by its own pose; the first one goes."""
import math
import sys

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from turtlesim.msg import Pose
from turtlesim.srv import Kill, SetPen, Spawn


def turned(by):
    return math.atan2(math.sin(by), math.cos(by))


class Drawer:
    """Drives one turtle along the sides of a regular polygon: turn to the next corner, go there, until all are done."""

    def __init__(self, node, name, x, y, sides, length):
        self.node, self.name, self.sides = node, name, sides
        self.corners, heading = [], 0.0
        for _ in range(sides):
            x, y = x + length * math.cos(heading), y + length * math.sin(heading)
            self.corners.append((x, y))
            heading += 2 * math.pi / sides
        self.pose = None
        self.is_done = False
        self.publisher = node.create_publisher(Twist, f'/{name}/cmd_vel', 10)
        node.create_subscription(Pose, f'/{name}/pose', self.on_pose, 10)

    def on_pose(self, pose):
        self.pose = pose
        if self.is_done:
            return
        x, y = self.corners[0]
        distance = math.hypot(x - pose.x, y - pose.y)
        if distance < 0.05:
            del self.corners[0]
            self.node.get_logger().info(f'{self.name}: {len(self.corners)} corners left')
            self.is_done = not self.corners
            self.publisher.publish(Twist())
            return
        error = turned(math.atan2(y - pose.y, x - pose.x) - pose.theta)
        command = Twist()
        command.angular.z = 4.0 * error
        if abs(error) < 0.2:
            command.linear.x = min(1.5, 1.0 * distance + 0.1)
        self.publisher.publish(command)


class Studio(Node):
    def __init__(self):
        super().__init__('studio')
        self.drawers = []
        self.clients_by_name = {}

    def call(self, kind, service, **fields):
        client = self.create_client(kind, service)
        while not client.wait_for_service(timeout_sec=1.0):
            self.get_logger().info(f'waiting for {service}')
        future = client.call_async(kind.Request(**fields))
        rclpy.spin_until_future_complete(self, future)
        return future.result()

    def prepare(self):
        for name, x, y, sides, length, color in (
            ('tri', 2.0, 2.0, 3, 3.0, (255, 0, 0)),
            ('sq', 6.5, 6.0, 4, 2.5, (0, 255, 0)),
        ):
            reply = self.call(Spawn, '/spawn', x=x, y=y, theta=0.0, name=name)
            print('spawned', reply.name)
            self.call(SetPen, f'/{name}/set_pen', r=color[0], g=color[1], b=color[2], width=4)
            self.drawers.append(Drawer(self, name, x, y, sides, length))
        self.call(Kill, '/kill', name='turtle1')


def main():
    rclpy.init(args=sys.argv)
    studio = Studio()
    studio.prepare()
    while rclpy.ok() and not all(each.is_done for each in studio.drawers):
        rclpy.spin_once(studio)
    for drawer, (x, y) in zip(studio.drawers, ((2.0, 2.0), (6.5, 6.0))):
        print(drawer.name, 'closed', math.hypot(drawer.pose.x - x, drawer.pose.y - y) < 0.1)
    print('turtles', sorted({topic.split('/')[1] for topic, _ in studio.get_topic_names_and_types() if topic.endswith('/pose')
                             and studio.count_publishers(topic)}))
    studio.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
