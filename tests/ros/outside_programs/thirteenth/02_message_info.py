"""Callbacks that take the message's information too: how old a message is, and a counter of late ones."""
import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, qos_profile_sensor_data
from sensor_msgs.msg import Range
from std_msgs.msg import Header


class Sonar(Node):
    def __init__(self):
        super().__init__('sonar')
        self.publisher = self.create_publisher(Range, 'sonar', qos_profile_sensor_data)
        self.timer = self.create_timer(0.2, self.measure)
        self.distance = 2.0

    def measure(self):
        msg = Range()
        msg.header = Header(frame_id='sonar_link', stamp=self.get_clock().now().to_msg())
        msg.radiation_type = Range.ULTRASOUND
        msg.field_of_view = 0.26
        msg.min_range, msg.max_range = 0.02, 4.0
        msg.range = self.distance
        self.distance -= 0.25
        self.publisher.publish(msg)


class Watch(Node):
    def __init__(self):
        super().__init__('watch')
        self.ages = []
        self.stamps = []
        self.create_subscription(Range, 'sonar', self.on_range, QoSProfile(depth=5, reliability=2))

    def on_range(self, msg, info):
        now = self.get_clock().now()
        self.stamps.append(info['source_timestamp'])
        self.ages.append(info['received_timestamp'] - info['source_timestamp'])
        age = (now - rclpy.time.Time.from_msg(msg.header.stamp)).nanoseconds
        if msg.range < 1.0:
            self.get_logger().warning(f'close: {msg.range:.2f} m, seen {age >= 0}', throttle_duration_sec=0.5)
        if msg.radiation_type == Range.ULTRASOUND and len(self.stamps) == 8:
            gaps = [b - a for a, b in zip(self.stamps, self.stamps[1:])]
            print('gaps', all(150_000_000 <= gap <= 250_000_000 for gap in gaps))
            print('ages', all(0 <= each < 100_000_000 for each in self.ages))
            raise SystemExit


def main():
    rclpy.init()
    executor = rclpy.executors.SingleThreadedExecutor()
    sonar, watch = Sonar(), Watch()
    for node in (sonar, watch):
        executor.add_node(node)
    try:
        executor.spin()
    except SystemExit:
        print('seen', len(watch.stamps))
    finally:
        for node in (sonar, watch):
            node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
