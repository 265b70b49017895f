#!/usr/bin/env python3
import numpy as np
import rclpy
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import CameraInfo, Image
import message_filters


class Camera(Node):
    def __init__(self):
        super().__init__('fake_camera')
        self.img_pub = self.create_publisher(Image, 'camera/image_raw', 5)
        self.info_pub = self.create_publisher(CameraInfo, 'camera/camera_info', 5)
        self.i = 0
        self.create_timer(1 / 5, self.grab)

    def grab(self):
        h, w = 48, 64
        a = np.zeros((h, w, 3), dtype=np.uint8)
        col = (self.i * 8) % w
        a[:, col:col + 8] = (255, 0, 0)
        msg = Image(height=h, width=w, encoding='rgb8', is_bigendian=0, step=3 * w)
        msg.header.stamp = self.get_clock().now().to_msg()
        msg.header.frame_id = 'camera'
        msg.data = a.tobytes()
        info = CameraInfo(header=msg.header, height=h, width=w, distortion_model='plumb_bob')
        info.k = [50.0, 0.0, w / 2, 0.0, 50.0, h / 2, 0.0, 0.0, 1.0]
        info.d = [0.0] * 5
        self.img_pub.publish(msg)
        self.info_pub.publish(info)
        self.i += 1


class Tracker(Node):
    def __init__(self):
        super().__init__('stripe_tracker')
        self.bearings = []
        subs = [message_filters.Subscriber(self, Image, 'camera/image_raw'),
                message_filters.Subscriber(self, CameraInfo, 'camera/camera_info')]
        self.sync = message_filters.ApproximateTimeSynchronizer(subs, queue_size=5, slop=0.05)
        self.sync.registerCallback(self.on_pair)

    def on_pair(self, img, info):
        a = np.frombuffer(img.data, dtype=np.uint8).reshape(img.height, img.width, -1)
        columns = np.flatnonzero(a[..., 0].max(axis=0))
        fx, cx = info.k[0], info.k[2]
        self.bearings.append(float(np.degrees(np.arctan2(columns.mean() + 0.5 - cx, fx))))
        t = Time.from_msg(img.header.stamp)
        if len(self.bearings) == 8:
            print(f'at {t.nanoseconds / 1e9:.1f}: ' + ' '.join(f'{b:.0f}' for b in self.bearings))
            raise KeyboardInterrupt


def main():
    rclpy.init()
    executor = rclpy.executors.SingleThreadedExecutor()
    for cls in (Camera, Tracker):
        executor.add_node(cls())
    try:
        executor.spin()
    except KeyboardInterrupt:
        print('bye')
    finally:
        for n in executor.get_nodes():
            n.destroy_node()
        rclpy.shutdown()


if __name__ == '__main__':
    main()
