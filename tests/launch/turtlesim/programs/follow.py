"""Tutorial: broadcast each turtle's frame to tf2, and let turtle2 follow turtle1 by what the buffer says."""

import math

import rclpy
from geometry_msgs.msg import TransformStamped, Twist
from rclpy.node import Node
from tf2_ros import Buffer, TransformBroadcaster, TransformException, TransformListener
from tf_transformations import quaternion_from_euler
from turtlesim.msg import Pose
from turtlesim.srv import Spawn


class Frames(Node):
    def __init__(self):
        super().__init__("frames")
        self.broadcaster = TransformBroadcaster(self)
        for name in ("turtle1", "turtle2"):
            self.create_subscription(Pose, f"/{name}/pose", lambda pose, name=name: self.send(name, pose), 1)
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.publisher = self.create_publisher(Twist, "turtle2/cmd_vel", 1)
        self.spawner = self.create_client(Spawn, "spawn")
        self.spawner.wait_for_service()
        self.spawner.call_async(Spawn.Request(name="turtle2", x=2.0, y=2.0, theta=0.0))
        self.create_timer(0.1, self.follow)
        self.distance = math.inf

    def send(self, name, pose):
        frame = TransformStamped()
        frame.header.stamp = self.get_clock().now().to_msg()
        frame.header.frame_id = "world"
        frame.child_frame_id = name
        frame.transform.translation.x = pose.x
        frame.transform.translation.y = pose.y
        x, y, z, w = quaternion_from_euler(0, 0, pose.theta)
        frame.transform.rotation.x, frame.transform.rotation.y = x, y
        frame.transform.rotation.z, frame.transform.rotation.w = z, w
        self.broadcaster.sendTransform(frame)

    def follow(self):
        try:
            found = self.buffer.lookup_transform("turtle2", "turtle1", rclpy.time.Time())
        except TransformException as problem:
            self.get_logger().info(f"Could not transform: {problem}", once=True)
            return
        x, y = found.transform.translation.x, found.transform.translation.y
        self.distance = math.hypot(x, y)
        command = Twist()
        command.angular.z = 1.0 * math.atan2(y, x)
        command.linear.x = 0.5 * self.distance
        self.publisher.publish(command)


def main():
    rclpy.init()
    node = Frames()
    while node.distance > 1.0:
        rclpy.spin_once(node)
    print("follows")


if __name__ == "__main__":
    main()
