#!/usr/bin/env python3
# the lookup waits for a transform that somebody publishes only later; the listener spins in its own thread
import math
import time
import rclpy
from rclpy.duration import Duration
from rclpy.time import Time
from geometry_msgs.msg import PointStamped, TransformStamped
import tf2_geometry_msgs  # noqa: F401
from tf2_ros import Buffer, LookupException, StaticTransformBroadcaster, TransformException, TransformListener

rclpy.init()
node = rclpy.create_node('mount_lookup')
buffer = Buffer(cache_time=Duration(seconds=20.0))
listener = TransformListener(buffer, node, spin_thread=True)

static = StaticTransformBroadcaster(node)
t = TransformStamped()
t.header.stamp = node.get_clock().now().to_msg()
t.header.frame_id = 'gripper'
t.child_frame_id = 'tip'
t.transform.translation.z = 0.1
t.transform.rotation.w = 1.0
static.sendTransform(t)

try:
    buffer.lookup_transform('arm', 'tip', Time())
except LookupException as e:
    print('lookup:', e.__class__.__name__)
except TransformException as e:
    print('transform:', e.__class__.__name__)

t0 = time.monotonic()
tf = buffer.lookup_transform('arm', 'tip', Time(), timeout=Duration(seconds=5.0))
print('came after %.0f s' % (time.monotonic() - t0))
print('tip at %.2f %.2f %.2f' % tuple(getattr(tf.transform.translation, k) for k in 'xyz'))

p = PointStamped()
p.header.frame_id = 'tip'
p.point.z = 0.4
q = buffer.transform(p, 'arm', timeout=Duration(seconds=1))
print('point %.2f in %s' % (q.point.x, q.header.frame_id))
print(buffer.can_transform('arm', 'moon', Time()))
node.destroy_node()
rclpy.shutdown()
