"""A camera driver: one thread grabs frames, another writes statistics at its own rate, the executor answers a service."""

import queue
import threading
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import CameraInfo, Image
from std_msgs.msg import Float32
from std_srvs.srv import SetBool


class FakeDevice:
    """Blocks until the next frame, as cv2.VideoCapture.read does."""

    def __init__(self, fps):
        self.period = 1.0 / fps
        self.number = 0

    def read(self):
        time.sleep(self.period)
        self.number += 1
        return True, bytes((self.number + i) % 256 for i in range(64 * 48))


class CameraNode(Node):
    def __init__(self):
        super().__init__("camera")
        self.images = self.create_publisher(Image, "image_raw", qos_profile_sensor_data)
        self.infos = self.create_publisher(CameraInfo, "camera_info", qos_profile_sensor_data)
        self.rate_pub = self.create_publisher(Float32, "fps", 10)
        self.create_service(SetBool, "record", self.on_record)
        self.create_timer(0.1, self.drain)
        self.frames = queue.Queue(maxsize=30)
        self.recording = True
        self.grabbed = 0
        self.stop = threading.Event()
        self.threads = [
            threading.Thread(target=self.grab, name="grab", daemon=True),
            threading.Thread(target=self.report, name="report", daemon=True),
        ]
        for each in self.threads:
            each.start()

    def grab(self):
        device = FakeDevice(20)
        while rclpy.ok() and not self.stop.is_set():
            ok, data = device.read()
            if not ok or not self.recording:
                continue
            image = Image(height=48, width=64, encoding="mono8", step=64, data=data)
            image.header.frame_id = "camera"
            image.header.stamp = self.get_clock().now().to_msg()
            self.grabbed += 1
            try:
                self.frames.put_nowait(image)
            except queue.Full:
                self.get_logger().warn("dropped a frame", throttle_duration_sec=1.0)

    def report(self):
        rate = self.create_rate(2.0)
        before = 0
        while not self.stop.is_set():
            try:
                rate.sleep()
            except Exception:
                return
            self.rate_pub.publish(Float32(data=(self.grabbed - before) * 2.0))
            before = self.grabbed

    def drain(self):
        while not self.frames.empty():
            image = self.frames.get()
            self.images.publish(image)
            self.infos.publish(CameraInfo(header=image.header, height=48, width=64))

    def on_record(self, request, response):
        self.recording = request.data
        response.success = True
        response.message = "recording" if request.data else "paused"
        return response


class Viewer(Node):
    def __init__(self):
        super().__init__("viewer")
        self.create_subscription(Image, "image_raw", self.on_image, qos_profile_sensor_data)
        self.create_subscription(Float32, "fps", self.on_fps, 10)
        self.switch = self.create_client(SetBool, "record")
        self.images = 0
        self.rates = []
        self.age = 0.0
        self.create_timer(3.0, self.pause)

    def on_image(self, image):
        self.images += 1
        stamp = rclpy.time.Time.from_msg(image.header.stamp)
        self.age = max(self.age, (self.get_clock().now() - stamp).nanoseconds / 1e9)

    def on_fps(self, rate):
        self.rates.append(rate.data)

    def pause(self):
        if self.switch.service_is_ready() and len(self.rates) < 8:
            self.switch.call_async(SetBool.Request(data=False)).add_done_callback(
                lambda future: self.get_logger().info(f"now {future.result().message} after {self.images} images")
            )
        else:
            self.get_logger().info(f"rates {self.rates[1:5]} then {self.rates[-1]}; oldest under 0.2 s: {self.age < 0.2}")
            raise ExternalShutdownException


def main():
    rclpy.init()
    camera, viewer = CameraNode(), Viewer()
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(camera)
    executor.add_node(viewer)
    try:
        executor.spin()
    except ExternalShutdownException:
        pass
    finally:
        camera.stop.set()
        camera.threads[0].join(timeout=1.0)
        camera.destroy_node()
        viewer.destroy_node()
        rclpy.try_shutdown()
    print("closed", camera.threads[0].is_alive())


if __name__ == "__main__":
    main()
