import rclpy
from rclpy.node import Node
from sensor_msgs.msg import BatteryState
from std_msgs.msg import String


class Monitor(Node):
    def __init__(self):
        super().__init__('monitor')
        self.low = self.declare_parameter('low', 0.1).value
        self.frames = {}
        self.told = set()
        self.alarm = self.create_publisher(String, 'alarm', 10)
        for name in ('a', 'b'):
            self.create_subscription(BatteryState, name, lambda msg, name=name: self.heard(name, msg), 10)

    def heard(self, name, msg):
        first = len(self.frames)
        self.frames[name] = msg.header.frame_id
        if first == 1 and len(self.frames) == 2:
            print(f'monitor hears a from {self.frames["a"]}, b from {self.frames["b"]}', flush=True)
        robot = msg.header.frame_id.split('/')[0]
        if msg.percentage < self.low:
            self.alarm.publish(String(data=f'{robot} {msg.percentage:.0%}'))
            if robot not in self.told:
                self.told.add(robot)
                print('low:', robot, flush=True)


rclpy.init()
rclpy.spin(Monitor())
