import rclpy
from geometry_msgs.msg import Twist
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Bool
from std_srvs.srv import SetBool, Trigger

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class EmergencyStop(Node):
    def __init__(self):
        super().__init__("emergency_stop")
        io, srv = MutuallyExclusiveCallbackGroup(), MutuallyExclusiveCallbackGroup()
        self.state = self.create_publisher(Bool, "estop/engaged", LATCHED)
        self.out = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Twist, "cmd_vel_raw", self.forward, 10, callback_group=io)
        self.create_service(SetBool, "estop", self.engage, callback_group=srv)
        self.create_service(Trigger, "estop/reset_count", self.reset_count, callback_group=srv)
        self.engaged = False
        self.blocked = 0
        self.state.publish(Bool(data=False))

    def engage(self, request, response):
        self.engaged = request.data
        if self.engaged:
            for _ in range(3):
                self.out.publish(Twist())
        self.state.publish(Bool(data=self.engaged))
        response.success = True
        response.message = "engaged" if self.engaged else "released"
        self.get_logger().warning("emergency stop " + response.message)
        return response

    def reset_count(self, request, response):
        response.success, response.message = self.blocked > 0, f"{self.blocked} commands were blocked"
        self.blocked = 0
        return response

    def forward(self, msg):
        if self.engaged:
            self.blocked += 1
        else:
            self.out.publish(msg)


def main():
    rclpy.init()
    node = EmergencyStop()
    executor = MultiThreadedExecutor(num_threads=2)
    executor.add_node(node)
    try:
        executor.spin()
    except KeyboardInterrupt:
        pass
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()


main()
