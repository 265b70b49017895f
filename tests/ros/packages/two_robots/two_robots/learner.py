"""Trains in one thread while another spins, with the gym of that time."""

import threading
import time

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from gym import Env
from gym.spaces import Box, Discrete
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class LearnerEnv(Node, Env):
    def __init__(self):
        super().__init__('LearnerEnv')
        self.lidar_sample = []
        self.steps = 0
        self.pub = self.create_publisher(Twist, 'cmd_vel', 1)
        self.create_subscription(LaserScan, 'static_laser', self.process_lidar, 1)
        self.action_space = Discrete(3)
        self.observation_space = Box(0, 10, shape=(9,), dtype=np.float64)

    def reset(self):
        self.steps = 0
        self.lidar_sample = []
        self.wait_lidar_reading()
        time.sleep(0.1)
        return np.array(self.lidar_sample)

    def step(self, action):
        twist = Twist()
        twist.linear.x = 0.1 * float(action)
        self.pub.publish(twist)
        self.lidar_sample = []
        self.wait_lidar_reading()
        self.steps += 1
        done = self.steps >= 5
        return np.array(self.lidar_sample), -1.0, done, {'end_state': 'timeout' if done else ''}

    def process_lidar(self, data):
        rays = data.ranges
        size = len(rays) // 9
        self.lidar_sample = [min(rays[size * i:size * (i + 1)]) for i in range(9)]

    def wait_lidar_reading(self):
        while len(self.lidar_sample) != 9:
            pass

    def train(self, episodes):
        for episode in range(episodes):
            obs = self.reset()
            done = False
            while not done:
                obs, reward, done, info = self.step(self.action_space.sample())
            assert obs in self.observation_space
            self.get_logger().info(f'Training - Episode {episode} end state: {info["end_state"]}')
        self.get_logger().info('Training Finished.')


def main(args=None):
    rclpy.init()
    env = LearnerEnv()
    threading.Thread(target=env.train, args=(2,)).start()
    rclpy.spin(env)
