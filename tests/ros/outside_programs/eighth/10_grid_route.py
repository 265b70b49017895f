"""Reads a map of occupied and free cells, inflates it, finds a way by Dijkstra's rule and drives it."""

import heapq
import math

import numpy as np
import rclpy
from geometry_msgs.msg import Pose, PoseStamped, Twist
from nav_msgs.msg import MapMetaData, OccupancyGrid, Odometry, Path
from nav_msgs.srv import GetMap
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile


class Maps(Node):
    """As map_server: a kept topic and a service."""

    def __init__(self):
        super().__init__("maps")
        cells = np.zeros((24, 40), dtype=np.int8)
        cells[0, :] = cells[-1, :] = 100
        cells[:, 0] = cells[:, -1] = 100
        cells[0:16, 24] = 100
        cells[20, 5] = -1
        self.grid = OccupancyGrid()
        self.grid.header.frame_id = "map"
        self.grid.info = MapMetaData(resolution=0.1, width=40, height=24)
        self.grid.info.origin.position.x = -2.0
        self.grid.info.origin.position.y = -1.2
        self.grid.info.origin.orientation.w = 1.0
        self.grid.data = cells.flatten().tolist()
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_publisher(OccupancyGrid, "map", kept).publish(self.grid)
        self.create_service(GetMap, "map_server/map", self.give)

    def give(self, request, response):
        response.map = self.grid
        return response


class Planner(Node):
    GOAL = (1.4, -0.6)

    def __init__(self):
        super().__init__("planner")
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_subscription(OccupancyGrid, "map", self.on_map, kept)
        self.path_pub = self.create_publisher(Path, "plan", kept)
        self.pub = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Odometry, "odom", self.on_odom, 10)
        self.route = []

    def on_map(self, grid):
        cells = np.array(grid.data, dtype=np.int8).reshape(grid.info.height, grid.info.width)
        share = [int((cells == value).sum()) for value in (100, 0, -1)]
        self.get_logger().info(f"{share[0]} occupied, {share[1]} free, {share[2]} unknown")
        blocked = cells != 0
        grown = blocked.copy()
        for row, column in zip(*np.nonzero(blocked)):
            grown[max(0, row - 2) : row + 3, max(0, column - 2) : column + 3] = True
        self.info = grid.info
        start, goal = self.cell(0.0, 0.0), self.cell(*self.GOAL)
        cells_on_way = self.dijkstra(grown, start, goal)
        path = Path()
        path.header = grid.header
        for row, column in cells_on_way:
            pose = PoseStamped(header=grid.header, pose=Pose())
            pose.pose.position.x = grid.info.origin.position.x + (column + 0.5) * grid.info.resolution
            pose.pose.position.y = grid.info.origin.position.y + (row + 0.5) * grid.info.resolution
            path.poses.append(pose)
        self.path_pub.publish(path)
        length = sum(
            math.dist((a.pose.position.x, a.pose.position.y), (b.pose.position.x, b.pose.position.y))
            for a, b in zip(path.poses, path.poses[1:])
        )
        self.get_logger().info(f"route of {length:.1f} m, {len(path.poses)} cells")
        self.route = [(each.pose.position.x, each.pose.position.y) for each in path.poses]

    def cell(self, x, y):
        origin = self.info.origin.position
        return int((y - origin.y) / self.info.resolution), int((x - origin.x) / self.info.resolution)

    @staticmethod
    def dijkstra(blocked, start, goal):
        queue, before, cost = [(0.0, start)], {}, {start: 0.0}
        while queue:
            so_far, here = heapq.heappop(queue)
            if here == goal:
                break
            for dr in (-1, 0, 1):
                for dc in (-1, 0, 1):
                    there = (here[0] + dr, here[1] + dc)
                    if there == here or blocked[there]:
                        continue
                    new = so_far + math.hypot(dr, dc)
                    if new < cost.get(there, math.inf):
                        cost[there], before[there] = new, here
                        heapq.heappush(queue, (new, there))
        way = [goal]
        while way[-1] != start:
            way.append(before[way[-1]])
        return way[::-1]

    def on_odom(self, odom):
        if not self.route:
            return
        position, q = odom.pose.pose.position, odom.pose.pose.orientation
        while len(self.route) > 1 and math.dist((position.x, position.y), self.route[0]) < 0.25:
            self.route.pop(0)
        x, y = self.route[0]
        left = math.dist((position.x, position.y), (x, y))
        command = Twist()
        if len(self.route) == 1 and left < 0.05:
            self.pub.publish(command)
            self.get_logger().info(f"arrived at {position.x:.1f} {position.y:.1f}")
            self.route = []
            return
        yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y**2 + q.z**2))
        error = math.remainder(math.atan2(y - position.y, x - position.x) - yaw, math.tau)
        command.linear.x = 0.3 if abs(error) < 0.5 else 0.0
        command.angular.z = max(-1.5, min(1.5, 3.0 * error))
        self.pub.publish(command)


def main():
    rclpy.init()
    maps, planner = Maps(), Planner()
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(maps)
    executor.add_node(planner)
    executor.spin()


if __name__ == "__main__":
    main()
