#!/usr/bin/env python
# roomba like behaviour
import random
import rclpy, math
from rclpy.node import Node
from rclpy.qos import QoSPresetProfiles
from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan

class Roomba(Node):

  def __init__(self):
    super().__init__('roomba')
    self.vel = self.create_publisher(Twist, 'cmd_vel', 5)
    self.create_subscription(LaserScan, 'scan', self.on_scan,
                             QoSPresetProfiles.SENSOR_DATA.value)
    self.turning = 0     # ticks left to turn
    self.dir = 1
    self.front = None
    self.bounces = 0
    self.create_timer(0.1, self.step)

  def on_scan(self, m):
    best = m.range_max
    for i in range(len(m.ranges)):
      a = m.angle_min + i*m.angle_increment
      a = math.atan2(math.sin(a), math.cos(a))
      if abs(a) < 0.5 and m.ranges[i] >= m.range_min and m.ranges[i] < best:
        best = m.ranges[i]
    self.front = best

  def step(self):
    if self.front is None: return
    t = Twist()
    if self.turning > 0:
      self.turning -= 1
      t.angular.z = 0.8*self.dir
    elif self.front < 0.8:
      self.bounces += 1
      self.get_logger().info('bounce number %d' % self.bounces)
      self.dir = random.choice([-1, 1])
      self.turning = random.randint(22, 38)
    else:
      t.linear.x = 0.5
    self.vel.publish(t)


def main():
  rclpy.init()
  n = Roomba()
  try:
    rclpy.spin(n)
  except KeyboardInterrupt:
    pass
  finally:
    n.destroy_node()

if __name__ == '__main__':
  main()
