import rclpy
from builtin_interfaces.msg import Time as TimeMsg
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import CameraInfo, Image


class Camera(Node):
    def __init__(self):
        super().__init__('camera_node')
        self.declare_parameter('fps', 10)
        self.declare_parameter('width', 4)
        self.pub = self.create_publisher(Image, 'image_raw', qos_profile_sensor_data)
        self.info = self.create_publisher(CameraInfo, 'camera_info', qos_profile_sensor_data)
        self.period = 1.0 / self.get_parameter('fps').get_parameter_value().integer_value
        self.create_timer(self.period, self.capture)

    def capture(self):
        w = self.get_parameter('width').value
        stamp: TimeMsg = self.get_clock().now().to_msg()
        img = Image(height=2, width=w, encoding='rgb8', is_bigendian=0, step=3 * w)
        img.header.stamp = stamp
        img.header.frame_id = self.get_namespace().strip('/') + '_camera'
        img.data = bytes(range(6 * w))
        self.pub.publish(img)
        info = CameraInfo(header=img.header, height=img.height, width=img.width, distortion_model='plumb_bob')
        info.d = [0.0] * 5
        info.k[0] = info.k[4] = 500.0
        info.k[8] = 1.0
        self.info.publish(info)


def main():
    rclpy.init()
    rclpy.spin(Camera())
