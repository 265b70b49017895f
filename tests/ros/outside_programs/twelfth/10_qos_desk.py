"""A desk for questions on quality of service: profiles by name, what fits what, what late ones get, what endpoints tell."""
import rclpy
from rclpy.duration import Duration
from rclpy.endpoint_info import EndpointTypeEnum
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSCompatibility,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
    qos_check_compatible,
    qos_profile_parameters,
    qos_profile_sensor_data,
    qos_profile_services_default,
    qos_profile_system_default,
)
from std_msgs.msg import Int32


def spin(executor, node, seconds):
    end = node.get_clock().now() + Duration(seconds=seconds)
    while node.get_clock().now() < end:
        executor.spin_once(timeout_sec=0.05)


def main():
    rclpy.init()
    print('sensor', qos_profile_sensor_data.reliability.name, qos_profile_sensor_data.depth)
    print('keys', sorted(QoSPresetProfiles.get_from_short_key(key).depth for key in ('sensor_data', 'services_default')))
    print('parameters', qos_profile_parameters.depth, qos_profile_services_default.history == HistoryPolicy.KEEP_LAST)
    print('short', ReliabilityPolicy.get_from_short_key('best_effort').name, DurabilityPolicy.short_keys()[-1] != '')
    print('system', qos_profile_system_default.reliability.short_key)
    try:
        QoSProfile(history=HistoryPolicy.KEEP_LAST)
    except Exception as problem:
        print('no depth', type(problem).__name__)
    print('same', QoSProfile(depth=5) == QoSProfile(depth=5), QoSProfile(depth=5) == QoSProfile(depth=6))
    fits, reason = qos_check_compatible(qos_profile_sensor_data, QoSProfile(depth=1))
    print('compatible', fits == QoSCompatibility.ERROR, bool(reason))
    print('fine', qos_check_compatible(QoSProfile(depth=1), qos_profile_sensor_data)[0] == QoSCompatibility.OK)

    node, reader = Node('desk'), Node('reader', namespace='/late')
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    executor.add_node(reader)
    events = []
    latched = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    publisher = node.create_publisher(
        Int32, '/board', latched, event_callbacks=PublisherEventCallbacks(matched=lambda info: events.append(
            ('matched', info.current_count, info.total_count))))
    for number in range(6):
        publisher.publish(Int32(data=number))
    spin(executor, node, 0.3)
    got = {'latched': [], 'volatile': [], 'shallow': []}
    kept = reader.create_subscription(Int32, '/board', lambda message: got['latched'].append(message.data), latched)
    reader.create_subscription(Int32, '/board', lambda message: got['volatile'].append(message.data), 10)
    reader.create_subscription(
        Int32, '/board', lambda message: got['shallow'].append(message.data),
        QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
    spin(executor, node, 0.5)
    publisher.publish(Int32(data=6))
    spin(executor, node, 0.3)
    print('latched', got['latched'], 'volatile', got['volatile'], 'shallow', got['shallow'][-1])
    print('counts', publisher.get_subscription_count(), kept.get_publisher_count(), node.count_subscribers('/board'))
    reader.destroy_subscription(kept)
    spin(executor, node, 0.3)
    print('matched', events[0][1:] , events[-1][1:])

    wrong = []
    reader.create_subscription(
        Int32, 'weak', lambda message: None, QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE),
        event_callbacks=SubscriptionEventCallbacks(incompatible_qos=lambda info: wrong.append(info.total_count)))
    node.create_publisher(Int32, '/late/weak', qos_profile_sensor_data)
    spin(executor, node, 0.4)
    print('incompatible', wrong)

    manual = QoSProfile(
        depth=1, liveliness=LivelinessPolicy.MANUAL_BY_TOPIC, liveliness_lease_duration=Duration(seconds=0.5))
    life = []
    alive = node.create_publisher(Int32, '/alive', manual)
    reader.create_subscription(
        Int32, '/alive', lambda message: None, manual,
        event_callbacks=SubscriptionEventCallbacks(liveliness=lambda info: life.append((info.alive_count, info.not_alive_count))))
    alive.publish(Int32())
    for _ in range(4):
        spin(executor, node, 0.25)
        alive.assert_liveliness()
    steady = list(life)
    spin(executor, node, 1.2)
    print('alive', steady[-1], 'then', life[-1])

    found = node.get_publishers_info_by_topic('/board')[0]
    print('endpoint', found.node_name, found.topic_type, found.endpoint_type == EndpointTypeEnum.PUBLISHER,
          found.qos_profile.durability.name)
    print('readers', sorted({each.node_namespace for each in node.get_subscriptions_info_by_topic('/board')}))
    rclpy.shutdown()


if __name__ == '__main__':
    main()
