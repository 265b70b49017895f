"""Bug-free bumper: drive until the wall is 1 m ahead, back off, turn to where the scan is longest, three times; all in one coroutine."""
import math

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.task import Future
from sensor_msgs.msg import LaserScan


class Rescue(Node):
    def __init__(self):
        super().__init__('rescue')
        self.scan = self.yaw = None
        self.waiting = []
        self.create_subscription(LaserScan, 'scan', self.on_scan, qos_profile_sensor_data)
        self.create_subscription(Odometry, 'odom', self.on_odom, qos_profile_sensor_data)
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 1)
        self.create_timer(0.05, self.tick)

    def on_scan(self, scan):
        self.scan = scan

    def on_odom(self, odom):
        q = odom.pose.pose.orientation
        self.yaw = 2 * math.atan2(q.z, q.w)

    def tick(self):
        waiting, self.waiting = self.waiting, []
        for future in waiting:
            future.set_result(None)

    def next_tick(self):
        future = Future(executor=self.executor)
        self.waiting.append(future)
        return future

    def drive(self, v=0.0, w=0.0):
        twist = Twist()
        twist.linear.x, twist.angular.z = v, w
        self.publisher.publish(twist)

    def ahead(self):
        beams = [r for r in (*self.scan.ranges[:15], *self.scan.ranges[-15:]) if math.isfinite(r)]
        return min(beams, default=self.scan.range_max)

    async def sleep(self, seconds):
        until = self.get_clock().now() + rclpy.duration.Duration(seconds=seconds)
        while self.get_clock().now() < until:
            await self.next_tick()

    async def mission(self):
        while self.scan is None or self.yaw is None:
            await self.next_tick()
        for number in range(3):
            while self.ahead() > 1.0:
                self.drive(0.6)
                await self.next_tick()
            print(f'wall {number + 1} at {self.ahead():.1f}')
            self.drive(-0.3)
            await self.sleep(1.0)
            best = max(range(len(self.scan.ranges)), key=lambda i: min(self.scan.ranges[i], self.scan.range_max))
            target = self.yaw + self.scan.angle_min + best * self.scan.angle_increment
            while abs(error := math.remainder(target - self.yaw, math.tau)) > 0.05:
                self.drive(0.0, max(-1.0, min(1.0, 2 * error)))
                await self.next_tick()
        self.drive()
        await self.sleep(0.3)
        return 'three walls seen'


def main():
    rclpy.init()
    node = Rescue()
    executor = rclpy.get_global_executor()
    executor.add_node(node)
    task = executor.create_task(node.mission)
    executor.spin_until_future_complete(task)
    print(task.result())
    rclpy.shutdown()


if __name__ == '__main__':
    main()
