#!/usr/bin/env python3
import heapq
import math
import numpy as np
import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, DurabilityPolicy
from builtin_interfaces.msg import Time
from geometry_msgs.msg import PoseStamped, Quaternion, Twist
from nav_msgs.msg import MapMetaData, OccupancyGrid, Odometry, Path
from std_msgs.msg import Header

RES = 0.25
N = 40                       # 10 m x 10 m, origin in the corner (-5, -5)


def cell(x, y):
    return int((x + 5.0) / RES), int((y + 5.0) / RES)


def centre(c):
    return -5.0 + (c[0] + 0.5) * RES, -5.0 + (c[1] + 0.5) * RES


def astar(grid, start, goal):
    open_set = [(0.0, start)]
    came, cost = {start: None}, {start: 0.0}
    while open_set:
        _, current = heapq.heappop(open_set)
        if current == goal:
            path = []
            while current is not None:
                path.append(current)
                current = came[current]
            return path[::-1]
        for dx in (-1, 0, 1):
            for dy in (-1, 0, 1):
                n = (current[0] + dx, current[1] + dy)
                if n == current or not (0 <= n[0] < N and 0 <= n[1] < N) or grid[n[1], n[0]] > 50:
                    continue
                new = cost[current] + math.hypot(dx, dy)
                if new < cost.get(n, math.inf):
                    cost[n], came[n] = new, current
                    heapq.heappush(open_set, (new + math.dist(n, goal), n))
    return None


class Planner(Node):
    def __init__(self):
        super().__init__('astar_planner')
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.map_pub = self.create_publisher(OccupancyGrid, 'map', latched)
        self.path_pub = self.create_publisher(Path, 'plan', latched)
        self.cmd_pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.path = None
        self.create_subscription(Odometry, 'odom', self.on_odom, 10)

        self.grid = np.zeros((N, N), dtype=np.int8)
        x0, y0 = cell(1.0, -2.0)
        x1, y1 = cell(1.5, 2.0)
        self.grid[y0:y1, x0:x1] = 100        # an imagined wall between start and goal
        m = OccupancyGrid(header=Header(frame_id='odom'), info=MapMetaData(resolution=RES, width=N, height=N))
        m.header.stamp = self.get_clock().now().to_msg()
        m.info.origin.position.x = m.info.origin.position.y = -5.0
        m.data = self.grid.ravel().tolist()
        self.map_pub.publish(m)

    def on_odom(self, odom):
        p = odom.pose.pose.position
        q = odom.pose.pose.orientation
        if self.path is None:
            cells = astar(self.grid, cell(p.x, p.y), cell(3.0, 0.1))
            self.path = [centre(c) for c in cells]
            plan = Path()
            plan.header.frame_id = 'odom'
            plan.header.stamp = odom.header.stamp
            assert isinstance(plan.header.stamp, Time)
            for x, y in self.path:
                ps = PoseStamped(header=plan.header)
                ps.pose.position.x, ps.pose.position.y = x, y
                ps.pose.orientation = Quaternion(w=1.0)
                plan.poses.append(ps)
            self.path_pub.publish(plan)
            length = sum(math.dist(a, b) for a, b in zip(self.path, self.path[1:]))
            self.get_logger().info(f'{len(self.path)} cells, {length:.1f} m')
        while len(self.path) > 1 and math.dist(self.path[0], (p.x, p.y)) < 0.4:
            self.path.pop(0)
        cmd = Twist()
        dx, dy = self.path[0][0] - p.x, self.path[0][1] - p.y
        yaw = 2 * math.atan2(q.z, q.w)
        e = math.atan2(math.sin(math.atan2(dy, dx) - yaw), math.cos(math.atan2(dy, dx) - yaw))
        if len(self.path) == 1 and math.hypot(dx, dy) < 0.1:
            self.cmd_pub.publish(cmd)
            self.get_logger().info('goal reached', once=True)
            return
        cmd.linear.x = 0.5 * max(0.0, math.cos(e)) ** 3
        cmd.angular.z = 2.0 * e
        self.cmd_pub.publish(cmd)


def main(args=None):
    rclpy.init(args=args)
    try:
        rclpy.spin(Planner())
    except KeyboardInterrupt:
        pass


if __name__ == '__main__':
    main()
