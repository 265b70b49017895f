"""Turtlesim: spawn turtle2, move it with teleport, chase with tf2, kill when caught."""
import math
import sys
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import TransformStamped, Twist
from tf2_ros import TransformBroadcaster, TransformException
from tf2_ros.buffer import Buffer
from tf2_ros.transform_listener import TransformListener
from turtlesim.msg import Pose
from turtlesim.srv import Kill, Spawn


class Chase(Node):
    def __init__(self):
        super().__init__("chase")
        self.br = TransformBroadcaster(self)
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.spawner = self.create_client(Spawn, "spawn")
        self.killer = self.create_client(Kill, "kill")
        while not self.spawner.wait_for_service(timeout_sec=1.0):
            self.get_logger().info("waiting for spawn...")
        for name in ("turtle1", "turtle2"):
            self.create_subscription(Pose, f"/{name}/pose", lambda m, n=name: self.on_pose(m, n), 1)
        self.pub = self.create_publisher(Twist, "/turtle1/cmd_vel", 1)
        fut = self.spawner.call_async(Spawn.Request(x=9.0, y=2.0, theta=1.0, name="turtle2"))
        fut.add_done_callback(lambda f: self.get_logger().info(f"spawned {f.result().name}"))
        self.caught = False
        self.create_timer(0.1, self.on_timer)

    def on_pose(self, msg, name):
        t = TransformStamped()
        t.header.stamp = self.get_clock().now().to_msg()
        t.header.frame_id = "world"
        t.child_frame_id = name
        t.transform.translation.x = msg.x
        t.transform.translation.y = msg.y
        t.transform.rotation.z = math.sin(msg.theta / 2)
        t.transform.rotation.w = math.cos(msg.theta / 2)
        self.br.sendTransform(t)

    def on_timer(self):
        if self.caught:
            return
        try:
            t = self.buffer.lookup_transform("turtle1", "turtle2", rclpy.time.Time())
        except TransformException as ex:
            self.get_logger().info(f"not yet: {type(ex).__name__}", throttle_duration_sec=1.0)
            return
        x, y = t.transform.translation.x, t.transform.translation.y
        d = math.hypot(x, y)
        cmd = Twist()
        if d < 0.3:
            self.caught = True
            self.pub.publish(cmd)
            self.killer.call_async(Kill.Request(name="turtle2")).add_done_callback(self.finish)
            return
        cmd.angular.z = 2.0 * math.atan2(y, x)
        cmd.linear.x = min(1.5, 0.8 * d)
        self.pub.publish(cmd)

    def finish(self, future):
        self.get_logger().info("caught and killed turtle2")
        raise SystemExit


def main():
    rclpy.init()
    node = Chase()
    try:
        rclpy.spin(node)
    except SystemExit:
        rclpy.logging.get_logger("Quitting").info("Done")
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == "__main__":
    sys.exit(main())
