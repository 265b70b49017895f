"""A program on the robot's side that knows nothing of the kit: zenoh-ros2-sdk, with its own serializer and hashes.

``python independent_peer.py PORT DEFINITIONS``. It publishes /scan and /chatter, tells of each /cmd_vel that comes,
serves /switch, and calls /kit_switch for each line of its input; what happens it prints, a line of JSON each.
"""

import json
import sys
import threading
import time
from types import SimpleNamespace

from zenoh_ros2_sdk import (
    ROS2Publisher,
    ROS2ServiceClient,
    ROS2ServiceServer,
    ROS2Subscriber,
    message_registry,
)
from zenoh_ros2_sdk.session import ZenohSession

PORT, DEFINITIONS = int(sys.argv[1]), sys.argv[2]
HERE = {"router_ip": "127.0.0.1", "router_port": PORT}
print_lock = threading.Lock()


def tell(what: str, **values: object) -> None:
    with print_lock:
        print(json.dumps({"what": what, **values}), flush=True)


def main() -> None:
    ZenohSession.get_instance("127.0.0.1", PORT)
    message_registry.get_registry(DEFINITIONS)
    chatter = ROS2Publisher("/chatter", "std_msgs/msg/String", **HERE)
    scans = ROS2Publisher("/scan", "sensor_msgs/msg/LaserScan", **HERE)
    commands = ROS2Subscriber(
        "/cmd_vel",
        "geometry_msgs/msg/Twist",
        lambda twist: tell("cmd_vel", forward=twist.linear.x, turn=twist.angular.z),
        **HERE,
    )
    session = ZenohSession.get_instance()
    responses = session.register_message_type(None, "std_srvs/srv/SetBool_Response")

    def switch(request: SimpleNamespace) -> object:
        tell("asked", data=bool(request.data))
        return responses(success=not request.data, message="by the robot")

    server = ROS2ServiceServer("/switch", "std_srvs/srv/SetBool", switch, **HERE)
    client = ROS2ServiceClient("/kit_switch", "std_srvs/srv/SetBool", timeout=20.0, **HERE)
    header = session.store.types["std_msgs/msg/Header"]
    stamp = session.store.types["builtin_interfaces/msg/Time"]
    has_ended = threading.Event()

    def publish() -> None:
        import numpy as np

        count = 0
        while not has_ended.wait(0.05):
            count += 1
            chatter.publish(data=f"hello {count}")
            scans.publish(
                header=header(stamp=stamp(sec=count, nanosec=5), frame_id="laser"),
                angle_min=-1.5,
                angle_max=1.5,
                angle_increment=0.5,
                time_increment=0.0,
                scan_time=0.1,
                range_min=0.0,
                range_max=8.0,
                ranges=np.array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0], dtype=np.float32),
                intensities=np.array([], dtype=np.float32),
            )

    publisher = threading.Thread(target=publish)
    publisher.start()
    tell("ready")
    for line in sys.stdin:
        if line.strip() == "call":
            response = client.call(data=True)
            answer = None if response is None else [bool(response.success), str(response.message)]
            tell("answered", response=answer)
    has_ended.set()
    publisher.join()
    for each in (commands, server, client, chatter, scans):
        each.close()
    time.sleep(0.1)
    session.close()


main()
