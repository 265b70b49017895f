"""Messages as bytes and what comes with them: raw subscriptions, MessageInfo, loaned types by name, acknowledgements, an echo of any type."""
import threading

import rclpy
from geometry_msgs.msg import PoseWithCovarianceStamped
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.serialization import deserialize_message, serialize_message
from rclpy.wait_for_message import wait_for_message
from rosidl_runtime_py.utilities import get_message
from sensor_msgs.msg import Image, Imu, NavSatFix
from std_msgs.msg import ByteMultiArray, Header, MultiArrayDimension, String, UInt8MultiArray


class Echo(Node):
    """Subscribes to whatever there is, by the type that the graph tells."""

    def __init__(self):
        super().__init__('echo')
        self.sizes = {}
        self.kinds = {}

    def look(self):
        for name, types in self.get_topic_names_and_types():
            if name in self.kinds or name in ('/rosout', '/parameter_events'):
                continue
            self.kinds[name] = types[0]
            self.create_subscription(
                get_message(types[0]), name, lambda data, name=name: self.sizes.setdefault(name, []).append(len(data)),
                10, raw=True)


def main():
    rclpy.init()
    node, echo = Node('post'), Echo()
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    executor.add_node(echo)
    publishers = {kind: node.create_publisher(kind, f'/post/{kind.__name__.lower()}', 10)
                  for kind in (String, Imu, Image, PoseWithCovarianceStamped, UInt8MultiArray)}
    for _ in range(3):
        echo.look()
        executor.spin_once(timeout_sec=0.1)
    print('kinds', len(echo.kinds), echo.kinds['/post/posewithcovariancestamped'])

    image = Image(header=Header(frame_id='camera'), height=2, width=3, encoding='rgb8', step=9, data=bytes(range(18)))
    imu = Imu()
    imu.orientation_covariance[0] = -1.0
    imu.angular_velocity.z = 0.25
    pose = PoseWithCovarianceStamped()
    pose.pose.covariance = [float(number) for number in range(36)]
    array = UInt8MultiArray(data=[1, 2, 3])
    array.layout.dim.append(MultiArrayDimension(label='n', size=3, stride=3))
    for message in (String(data='hello'), imu, image, pose, array):
        publishers[type(message)].publish(message)
    publishers[String].publish(serialize_message(String(data='as bytes')))
    for _ in range(20):
        executor.spin_once(timeout_sec=0.02)
    print('sizes', echo.sizes['/post/string'], echo.sizes['/post/imu'], echo.sizes['/post/image'], echo.sizes['/post/uint8multiarray'])

    for message in (image, imu, pose, array, NavSatFix(latitude=38.7, status=NavSatFix().status)):
        again = deserialize_message(serialize_message(message), type(message))
        assert again == message, (again, message)
    print('again', type(image.data).__name__, image.data[5], imu.orientation_covariance.shape, pose.pose.covariance[7])
    print('bytes', ByteMultiArray(data=[b'\x01', b'\x02']).data[1])
    print('hello', serialize_message(String(data='hello')).hex())

    infos = []

    def with_info(message, info):
        infos.append((message.data, info['source_timestamp'] <= info['received_timestamp'], sorted(info)[:2]))
    node.create_subscription(String, '/post/string', with_info, 10)
    executor.spin_once(timeout_sec=0.05)
    publishers[String].publish(String(data='with'))
    for _ in range(5):
        executor.spin_once(timeout_sec=0.02)
    print('info', infos[0][:2])
    print('acknowledged', publishers[String].wait_for_all_acked(rclpy.duration.Duration(seconds=1)))

    node.create_timer(0.1, lambda: publishers[String].publish(String(data='tick')))
    waiter = Node('waiter')
    late = Node('late')
    thread = threading.Thread(target=executor.spin, daemon=True)
    thread.start()
    ok, message = wait_for_message(String, waiter, '/post/string', time_to_wait=2.0)
    print('waited', ok, message.data)
    ok, message = wait_for_message(String, waiter, '/post/nothing', time_to_wait=0.3)
    print('waited', ok, message)
    for wrong in (lambda: node.create_publisher(String, 'bad topic', 10), lambda: node.create_publisher(String, '3d', 10),
                  lambda: publishers[String].publish('text'), lambda: node.create_subscription(String, 'x//y', print, 10)):
        try:
            wrong()
            print('taken')
        except Exception as problem:
            print('refused', type(problem).__name__)
    print('names', publishers[String].topic_name, node.resolve_topic_name('~/x'), late.resolve_service_name('y'))
    executor.shutdown()
    thread.join(timeout=1)
    rclpy.shutdown()


if __name__ == '__main__':
    main()
