import threading

import rclpy
from rclpy.executors import SingleThreadedExecutor
from turtlesim.msg import Pose
from turtlesim.srv import Spawn, TeleportRelative


def wait(future):
    while rclpy.ok() and not future.done():
        pass
    return future.result()


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node("poller")
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    thread = threading.Thread(target=executor.spin)
    thread.start()

    ready = threading.Event()
    latest = []

    def on_pose(msg):
        latest[:] = [msg]
        ready.set()

    node.create_subscription(Pose, "/turtle1/pose", on_pose, 1)
    while not ready.is_set():
        pass
    print(f"first pose {latest[0].x:.2f} {latest[0].y:.2f}")

    teleport = node.create_client(TeleportRelative, "/turtle1/teleport_relative")
    while not teleport.service_is_ready():
        pass
    for step in range(4):
        wait(teleport.call_async(TeleportRelative.Request(linear=2.0, angular=1.5707963)))
        print("side", step + 1)
    spawn = node.create_client(Spawn, "/spawn")
    spawn.wait_for_service()
    answer = wait(spawn.call_async(Spawn.Request(x=1.0, y=1.0, theta=0.0, name="buddy")))
    print("hello", answer.name)

    executor.shutdown()
    rclpy.try_shutdown()
    while thread.is_alive():
        pass
    print("joined by polling")


if __name__ == "__main__":
    main()
