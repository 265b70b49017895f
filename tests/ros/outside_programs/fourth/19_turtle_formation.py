import math
from functools import partial

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from turtlesim.msg import Pose
from turtlesim.srv import SetPen, Spawn


class Formation(Node):
    OFFSETS = {"left": (-1.0, 1.0), "right": (-1.0, -1.0)}

    def __init__(self):
        super().__init__("formation")
        self.poses, self.pubs = {}, {}
        self.client = self.create_client(Spawn, "spawn")
        while not self.client.wait_for_service(timeout_sec=1.0):
            self.get_logger().info("service not available, waiting again...")
        self.adopt("turtle1")
        for i, name in enumerate(self.OFFSETS):
            future = self.client.call_async(Spawn.Request(x=1.0 + i, y=1.0, theta=0.0, name=name))
            future.add_done_callback(partial(self.spawned, wanted=name))
        self.started = None
        self.create_timer(0.02, self.control)

    def spawned(self, future, wanted):
        if future.result().name != wanted:
            self.get_logger().fatal("wrong name")
        self.adopt(wanted)
        pen = self.create_client(SetPen, f"{wanted}/set_pen")
        pen.wait_for_service(timeout_sec=1.0)
        pen.call_async(SetPen.Request(r=255, off=0, width=2))

    def adopt(self, name):
        self.pubs[name] = self.create_publisher(Twist, f"{name}/cmd_vel", 10)
        self.create_subscription(Pose, f"{name}/pose", lambda msg, name=name: self.poses.__setitem__(name, msg), 10)

    def control(self):
        if len(self.poses) < 3:
            return
        now = self.get_clock().now()
        self.started = self.started or now
        lead = self.poses["turtle1"]
        cmd = Twist()
        elapsed = (now - self.started).nanoseconds / 1e9
        cmd.linear.x, cmd.angular.z = (0.4, 0.2) if elapsed < 15 else (0.0, 0.0)
        self.pubs["turtle1"].publish(cmd)
        worst = 0.0
        for name, (dx, dy) in self.OFFSETS.items():
            me = self.poses[name]
            gx = lead.x + dx * math.cos(lead.theta) - dy * math.sin(lead.theta)
            gy = lead.y + dx * math.sin(lead.theta) + dy * math.cos(lead.theta)
            distance = math.hypot(gx - me.x, gy - me.y)
            worst = max(worst, distance)
            bearing = math.remainder(math.atan2(gy - me.y, gx - me.x) - me.theta, math.tau)
            cmd = Twist()
            if distance > 0.05:
                cmd.linear.x = min(2.0, 2.0 * distance) * max(0.0, math.cos(bearing))
                cmd.angular.z = 4.0 * bearing
            self.pubs[name].publish(cmd)
        if elapsed > 20:
            self.get_logger().info("formation kept" if worst < 0.2 else f"formation lost: {worst:.2f}")
            raise SystemExit(0 if worst < 0.2 else 1)


def main():
    rclpy.init()
    rclpy.spin(Formation())


if __name__ == "__main__":
    main()
