import rclpy
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from std_msgs.msg import String


class Camera(LifecycleNode):
    def __init__(self):
        super().__init__("camera")
        self.publisher = None
        self.timer = None

    def on_configure(self, state):
        self.publisher = self.create_lifecycle_publisher(String, "pictures", 10)
        self.timer = self.create_timer(0.05, self.take)
        return TransitionCallbackReturn.SUCCESS

    def take(self):
        self.publisher.publish(String(data="a picture"))


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Camera())


if __name__ == "__main__":
    main()
