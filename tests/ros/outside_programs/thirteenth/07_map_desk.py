"""A desk that hands out a map as a service and as a kept topic; a clerk asks for both, compares them and plans a route."""
from collections import deque

import rclpy
from geometry_msgs.msg import Pose, PoseStamped
from nav_msgs.msg import OccupancyGrid, Path
from nav_msgs.srv import GetMap
from rclpy.node import Node
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy

ROWS = [
    '..........',
    '.####.###.',
    '.#......#.',
    '.#.####.#.',
    '.#.#..#.#.',
    '.#.#.##.#.',
    '.#.#....#.',
    '.#.######.',
]
LATCHED = QoSProfile(depth=1, reliability=QoSReliabilityPolicy.RELIABLE, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)


class Desk(Node):
    def __init__(self):
        super().__init__('desk')
        self.grid = OccupancyGrid()
        self.grid.header.frame_id = 'map'
        self.grid.header.stamp = self.get_clock().now().to_msg()
        info = self.grid.info
        info.map_load_time = self.grid.header.stamp
        info.resolution = 0.5
        info.width, info.height = len(ROWS[0]), len(ROWS)
        info.origin = Pose()
        info.origin.position.x = -2.5
        info.origin.orientation.w = 1.0
        self.grid.data = [100 if sign == '#' else 0 for row in reversed(ROWS) for sign in row]
        self.create_publisher(OccupancyGrid, 'map', LATCHED).publish(self.grid)
        self.create_service(GetMap, 'get_map', self.on_request)

    def on_request(self, request, response):
        response.map = self.grid
        return response


class Clerk(Node):
    def __init__(self):
        super().__init__('clerk')
        self.topic_map = None
        self.create_subscription(OccupancyGrid, '/map', self.on_map, LATCHED)
        self.client = self.create_client(GetMap, '/get_map')
        self.route = self.create_publisher(Path, 'route', 1)

    def on_map(self, grid):
        self.topic_map = grid

    def cell(self, info, x, y):
        return (int((x - info.origin.position.x) / info.resolution), int((y - info.origin.position.y) / info.resolution))

    def plan(self, grid, start, goal):
        info = grid.info
        first, last = self.cell(info, *start), self.cell(info, *goal)
        came, open_cells = {first: None}, deque([first])
        while open_cells:
            here = open_cells.popleft()
            if here == last:
                break
            for step in ((1, 0), (-1, 0), (0, 1), (0, -1)):
                there = here[0] + step[0], here[1] + step[1]
                inside = 0 <= there[0] < info.width and 0 <= there[1] < info.height
                if inside and there not in came and grid.data[there[1] * info.width + there[0]] == 0:
                    came[there] = here
                    open_cells.append(there)
        if last not in came:
            return None
        cells = []
        while last is not None:
            cells.append(last)
            last = came[last]
        path = Path()
        path.header.frame_id = grid.header.frame_id
        for column, row in reversed(cells):
            pose = PoseStamped()
            pose.header = path.header
            pose.pose.position.x = info.origin.position.x + (column + 0.5) * info.resolution
            pose.pose.position.y = info.origin.position.y + (row + 0.5) * info.resolution
            path.poses.append(pose)
        return path


def main():
    rclpy.init()
    desk, clerk = Desk(), Clerk()
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(desk)
    executor.add_node(clerk)
    assert clerk.client.wait_for_service(timeout_sec=5.0)
    future = clerk.client.call_async(GetMap.Request())
    executor.spin_until_future_complete(future, timeout_sec=5.0)
    grid = future.result().map
    while clerk.topic_map is None:
        executor.spin_once(timeout_sec=0.1)
    print('same', grid == clerk.topic_map, len(grid.data), sum(1 for each in grid.data if each))
    path = clerk.plan(grid, (-2.2, 0.2), (0.3, 1.9))
    print('to the inner room:', len(path.poses), 'poses, ends at', path.poses[-1].pose.position.x, path.poses[-1].pose.position.y)
    clerk.route.publish(path)
    print('to a wall:', clerk.plan(grid, (-2.2, 0.2), (-1.9, 0.3)))
    executor.shutdown()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
