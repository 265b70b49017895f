import math

import rclpy
import tf2_geometry_msgs  # noqa: F401  registers the types
from geometry_msgs.msg import PoseStamped, TransformStamped, Twist
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import Buffer, StaticTransformBroadcaster, TransformException, TransformListener


def yaw_of(q):
    return math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))


class GoalInMap(Node):
    def __init__(self):
        super().__init__("goal_in_map")
        self.static = StaticTransformBroadcaster(self)
        t = TransformStamped()
        t.header.stamp = self.get_clock().now().to_msg()
        t.header.frame_id, t.child_frame_id = "map", "odom"
        t.transform.translation.x, t.transform.translation.y = 3.0, 1.0
        t.transform.rotation.z, t.transform.rotation.w = math.sin(math.pi / 4), math.cos(math.pi / 4)
        self.static.sendTransform(t)
        self.buffer = Buffer(cache_time=Duration(seconds=5))
        self.listener = TransformListener(self.buffer, self)
        self.goal = PoseStamped()
        self.goal.header.frame_id = "map"
        self.goal.pose.position.x, self.goal.pose.position.y = 3.0, 3.0   # 2 m ahead in odom
        self.goal.pose.orientation.z = self.goal.pose.orientation.w = math.sqrt(0.5)
        self.pub = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.05, self.control)
        self.there = False

    def control(self):
        self.goal.header.stamp = Time().to_msg()
        try:
            local = self.buffer.transform(self.goal, "base_link", timeout=Duration(seconds=0))
        except TransformException as problem:
            self.get_logger().info(f"waiting: {type(problem).__name__}", once=True)
            return
        x, y = local.pose.position.x, local.pose.position.y
        cmd = Twist()
        if math.hypot(x, y) > 0.1 and not self.there:
            cmd.linear.x = min(0.4, math.hypot(x, y))
            cmd.angular.z = 1.5 * math.atan2(y, x)
        elif abs(yaw_of(local.pose.orientation)) > 0.05:
            self.there = True
            cmd.angular.z = 1.0 * yaw_of(local.pose.orientation)
        else:
            there = self.buffer.lookup_transform("map", "base_link", Time())
            self.get_logger().info("in map at %.1f %.1f facing %.1f" % (
                there.transform.translation.x, there.transform.translation.y, yaw_of(there.transform.rotation)))
            print(self.buffer.can_transform("map", "nowhere", Time()), "map" in self.buffer.all_frames_as_yaml())
            self.pub.publish(cmd)
            raise SystemExit
        self.pub.publish(cmd)


def main(args=None):
    rclpy.init(args=args)
    try:
        rclpy.spin(GoalInMap())
    except SystemExit:
        rclpy.logging.get_logger("Quitting").info("Done")


if __name__ == "__main__":
    main()
