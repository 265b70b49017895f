import rclpy
from course_interfaces.msg import Parcel, RobotStatus

rclpy.init()
node = rclpy.create_node('delivery_watch')
told = False


def heard(msg: RobotStatus):
    global told
    if msg.state == RobotStatus.DRIVING and not told:
        told = True
        flags = 0
        for parcel in msg.load:
            flags |= parcel.flags
        words = [word for word, bit in (('fragile', Parcel.FRAGILE), ('heavy', Parcel.HEAVY)) if flags & bit]
        print(f'watcher: {len(msg.load)} parcels, {" and ".join(words)}, route of {len(msg.route)}, doors {msg.doors}',
              flush=True)


node.create_subscription(RobotStatus, 'status', heard, 10)
rclpy.spin(node)
