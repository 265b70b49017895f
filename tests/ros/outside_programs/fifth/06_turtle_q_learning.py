#!/usr/bin/env python3
"""A turtle learns its way over a grid of 5 x 5 by Q-learning; the world is turtlesim, moved by teleport."""
import random
import sys

import rclpy
from rclpy.node import Node
from std_srvs.srv import Empty
from turtlesim.msg import Pose
from turtlesim.srv import SetPen, TeleportAbsolute

MOVES = [(1, 0), (-1, 0), (0, 1), (0, -1)]
GOAL = (4, 4)
HOLES = {(1, 1), (3, 2), (1, 3)}


class Env(Node):
    def __init__(self):
        super().__init__('turtle_env')
        self.teleport = self.create_client(TeleportAbsolute, '/turtle1/teleport_absolute')
        self.pen = self.create_client(SetPen, '/turtle1/set_pen')
        self.clear = self.create_client(Empty, '/clear')
        for client in (self.teleport, self.pen, self.clear):
            client.wait_for_service()
        self.pose = None
        self.create_subscription(Pose, '/turtle1/pose', lambda m: setattr(self, 'pose', m), 10)
        self.call(self.pen, SetPen.Request(off=1))

    def call(self, client, request):
        future = client.call_async(request)
        rclpy.spin_until_future_complete(self, future)
        return future.result()

    def place(self, cell):
        self.call(self.teleport, TeleportAbsolute.Request(x=1.5 + 2.0 * cell[0], y=1.5 + 2.0 * cell[1], theta=0.0))
        self.cell = cell

    def reset(self):
        self.place((0, 0))
        return self.cell

    def step(self, action):
        x, y = self.cell[0] + MOVES[action][0], self.cell[1] + MOVES[action][1]
        if not (0 <= x < 5 and 0 <= y < 5):
            return self.cell, -1.0, False
        self.place((x, y))
        if self.cell in HOLES:
            return self.cell, -10.0, True
        return self.cell, (10.0 if self.cell == GOAL else -1.0), self.cell == GOAL


def main():
    rclpy.init()
    random.seed(3)
    env, q = Env(), {}
    for episode in range(150):
        state, done, steps = env.reset(), False, 0
        while not done and steps < 60:
            values = q.setdefault(state, [0.0] * 4)
            action = random.randrange(4) if random.random() < 0.2 else values.index(max(values))
            nxt, reward, done = env.step(action)
            target = reward + (0 if done else 0.95 * max(q.setdefault(nxt, [0.0] * 4)))
            values[action] += 0.5 * (target - values[action])
            state, steps = nxt, steps + 1
    env.call(env.pen, SetPen.Request(r=255, width=3, off=0))
    state, done, way = env.reset(), False, 0
    while not done and way < 20:
        state, _, done = env.step(q[state].index(max(q[state])))
        way += 1
    env.pose = None
    while env.pose is None:
        rclpy.spin_once(env)
    print(f'learned a way of {way} steps, at {env.pose.x:.1f} {env.pose.y:.1f}', flush=True)
    env.call(env.clear, Empty.Request())
    env.destroy_node()
    rclpy.shutdown()
    sys.exit(0 if way == 8 else 1)


if __name__ == '__main__':
    main()
