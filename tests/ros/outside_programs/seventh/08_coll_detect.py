import threading

import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient
from rclpy.qos import QoSProfile, ReliabilityPolicy, HistoryPolicy
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool, Float32MultiArray, MultiArrayDimension


class CollDetect(Node):
    def __init__(self):
        super().__init__('coll_detect')
        self.declare_parameters(namespace='', parameters=[
            ('k11', 1.5), ('kr11', 1.5), ('collision_threshold', 0.5), ('t_delay', 0.0)])
        self.add_on_set_parameters_callback(self.on_set)
        self.threshold = self.get_parameter('collision_threshold').value
        qos = QoSProfile(reliability=ReliabilityPolicy.BEST_EFFORT, history=HistoryPolicy.KEEP_LAST, depth=1)
        self.create_subscription(LaserScan, 'scan', self.on_scan, qos)
        self.create_subscription(Float32MultiArray, 'vw_estimate', self.on_vw, 10)
        self.pub = self.create_publisher(Bool, 'lidar_stop', 10)
        self.v = 0.0
        self.before = None

    def on_set(self, params):
        for p in params:
            if p.name == 'collision_threshold':
                if p.type_ != Parameter.Type.DOUBLE or p.value < 0:
                    return SetParametersResult(successful=False, reason='the threshold must be a distance')
                self.threshold = p.value
                self.get_logger().info(f'threshold is now {p.value}')
        return SetParametersResult(successful=True)

    def on_vw(self, msg):
        assert msg.layout.dim[0].label == 'vw'
        self.v = msg.data[0]

    def on_scan(self, scan):
        nearest = min(r for r in scan.ranges if r > scan.range_min)
        k, kr = self.get_parameter('k11').value, self.get_parameter('kr11').value
        stop = nearest < self.threshold + self.v * (kr / k ** 2)
        self.pub.publish(Bool(data=stop))
        if stop != self.before:
            self.before = stop
            self.get_logger().info('STOP' if stop else 'free')


class Tuner(Node):
    """Estimates nothing: 0.3 m/s for ever. Asks for other thresholds."""

    def __init__(self):
        super().__init__('tuner')
        self.pub = self.create_publisher(Float32MultiArray, 'vw_estimate', 10)
        self.params = AsyncParameterClient(self, 'coll_detect')
        self.steps = iter([-1.0, 50.0, 0.01])
        self.timer = self.create_timer(1.0, self.next)

    def next(self):
        msg = Float32MultiArray(data=[0.3, 0.0])
        msg.layout.dim.append(MultiArrayDimension(label='vw', size=2, stride=2))
        self.pub.publish(msg)
        if not self.params.services_are_ready():
            return
        try:
            value = next(self.steps)
        except StopIteration:
            self.timer.cancel()
            future = self.params.list_parameters([], 0)
            future.add_done_callback(lambda f: self.get_logger().info(
                'parameters: ' + ', '.join(sorted(n for n in f.result().result.names if n in ('k11', 'kr11', 't_delay')))))
            return
        future = self.params.set_parameters([Parameter('collision_threshold', value=value)])
        future.add_done_callback(self.told)

    def told(self, future):
        (result,) = future.result().results
        self.get_logger().info('accepted' if result.successful else f'refused: {result.reason}')


def main():
    rclpy.init()
    detect, tuner = CollDetect(), Tuner()
    thread = threading.Thread(target=rclpy.spin, args=(detect,), daemon=True)
    thread.start()
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(tuner)
    executor.spin()


if __name__ == '__main__':
    main()
