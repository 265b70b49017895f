"""A node spun in a background thread; the main thread works with a Rate, an Event and a Queue; a one-shot."""
import queue
import threading
import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Int32
from std_srvs.srv import SetBool, Trigger

rclpy.init()
node = rclpy.create_node("worker")
q = queue.Queue()
ready = threading.Event()
pub = node.create_publisher(Int32, "count", 10)
node.create_subscription(Int32, "count", lambda m: q.put(m.data), 10)


def on_trigger(req, res):
    ready.set()
    res.success, res.message = True, "ready"
    return res


node.create_service(Trigger, "ready", on_trigger)
cli = node.create_client(Trigger, "ready")
th = threading.Thread(target=rclpy.spin, args=(node,), daemon=True)
th.start()
t0 = node.get_clock().now()
rate = node.create_rate(5)
for i in range(10):
    pub.publish(Int32(data=i))
    rate.sleep()
took = (node.get_clock().now() - t0).nanoseconds / 1e9
print("ten at 5 Hz: %.1f s" % took)
print([q.get(timeout=1.0) for _ in range(10)])
try:
    q.get(timeout=0.5)
except queue.Empty:
    print("empty")
print(cli.call(Trigger.Request()).message, ready.wait(1.0))
print("%.1f" % ((node.get_clock().now() - t0).nanoseconds / 1e9))
node.destroy_rate(rate)
rclpy.shutdown()
th.join(timeout=2)
print("joined", not th.is_alive())
