"""A planner that computes in a thread of its own while the executor keeps the robot still; then the route is driven."""

import math
import threading

import rclpy
from geometry_msgs.msg import PoseStamped, Twist
from nav_msgs.msg import Odometry, Path
from rclpy.node import Node

SIZE = 61
CELL = 0.1
GOAL = (2.0, 1.5)


def value_iteration(goal, blocked):
    """Costs to the goal on a grid, in plain Python, until nothing changes."""
    costs = [[math.inf] * SIZE for _ in range(SIZE)]
    costs[goal[0]][goal[1]] = 0.0
    changed = True
    while changed:
        changed = False
        for x in range(SIZE):
            for y in range(SIZE):
                if (x, y) in blocked or (x, y) == goal:
                    continue
                best = costs[x][y]
                for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, -1), (1, -1), (-1, 1)):
                    i, j = x + dx, y + dy
                    if 0 <= i < SIZE and 0 <= j < SIZE:
                        best = min(best, costs[i][j] + math.hypot(dx, dy))
                if best < costs[x][y] - 1e-9:
                    costs[x][y] = best
                    changed = True
    return costs


class Planner(Node):
    def __init__(self):
        super().__init__("thinks_beside")
        self.cmd = self.create_publisher(Twist, "/cmd_vel", 10)
        self.paths = self.create_publisher(Path, "plan", 1)
        self.create_subscription(Odometry, "/odom", self.on_odom, 10)
        self.create_timer(0.05, self.control)
        self.pose = None
        self.route = None
        self.waited = 0
        self.lock = threading.Lock()
        self.thread = None

    def on_odom(self, msg):
        q = msg.pose.pose.orientation
        self.pose = (msg.pose.pose.position.x, msg.pose.pose.position.y, 2 * math.atan2(q.z, q.w))
        if self.thread is None:
            self.get_logger().info("planning")
            self.thread = threading.Thread(target=self.plan, args=(self.cell(*self.pose[:2]),))
            self.thread.start()

    @staticmethod
    def cell(x, y):
        return round(x / CELL) + SIZE // 2, round(y / CELL) + SIZE // 2

    def plan(self, start):
        blocked = {(40, y) for y in range(20, 41)}
        costs = value_iteration(self.cell(*GOAL), blocked)
        route, at = [], start
        while costs[at[0]][at[1]] > 0:
            at = min(
                (
                    (at[0] + dx, at[1] + dy)
                    for dx in (-1, 0, 1)
                    for dy in (-1, 0, 1)
                    if 0 <= at[0] + dx < SIZE and 0 <= at[1] + dy < SIZE
                ),
                key=lambda each: costs[each[0]][each[1]],
            )
            route.append(((at[0] - SIZE // 2) * CELL, (at[1] - SIZE // 2) * CELL))
        message = Path()
        message.header.frame_id = "odom"
        message.header.stamp = self.get_clock().now().to_msg()
        for x, y in route:
            pose = PoseStamped(header=message.header)
            pose.pose.position.x, pose.pose.position.y = x, y
            message.poses.append(pose)
        self.paths.publish(message)
        with self.lock:
            self.route = route
        self.get_logger().info(f"planned {len(route)} cells")

    def control(self):
        with self.lock:
            if self.route is None:
                self.waited += 1
                return
            while len(self.route) > 1 and math.dist(self.pose[:2], self.route[0]) < 0.25:
                self.route.pop(0)
            x, y = self.route[0]
            last = len(self.route) == 1
        command = Twist()
        if last and math.dist(self.pose[:2], (x, y)) < 0.08:
            self.cmd.publish(command)
            self.get_logger().info("there")
            raise SystemExit
        error = math.atan2(y - self.pose[1], x - self.pose[0]) - self.pose[2]
        error = math.atan2(math.sin(error), math.cos(error))
        command.angular.z = 2.0 * error
        command.linear.x = 0.4 * max(0.0, math.cos(error)) ** 2
        self.cmd.publish(command)


def main():
    rclpy.init()
    node = Planner()
    try:
        rclpy.spin(node)
    except SystemExit:
        pass
    print("waited for the plan:", node.waited > 0)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
