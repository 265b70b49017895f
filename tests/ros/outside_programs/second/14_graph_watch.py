#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from std_msgs.msg import String, Int32


def main():
    rclpy.init()
    # rules for this node only, or the ghost would be renamed as well
    watcher = Node('will_be_renamed', cli_args=['--ros-args', '-r', '__node:=watcher', '-r', 'chat:=/lobby/chat'])
    ghost = rclpy.create_node('ghost', namespace='/attic')
    p1 = watcher.create_publisher(String, 'chat', 10)
    p2 = ghost.create_publisher(Int32, 'footsteps', 10)
    p3 = ghost.create_publisher(Int32, '/footsteps', 10)
    s1 = ghost.create_subscription(String, '/lobby/chat', lambda m: None, 10)
    log = watcher.get_logger()
    log.info('my name: ' + watcher.get_name())

    seen = False
    for attempt in range(50):
        rclpy.spin_once(watcher, timeout_sec=0.1)
        if ('ghost', '/attic') in watcher.get_node_names_and_namespaces() and watcher.count_subscribers('/lobby/chat') == 1:
            seen = True
            break
    log.info('ghost seen' if seen else 'no ghost')
    topics = dict(watcher.get_topic_names_and_types())
    for t in sorted(topics):
        if 'footsteps' in t or 'chat' in t:
            log.info(f'{t}: {topics[t][0]}')
    log.info('publishers of /attic/footsteps: %d' % watcher.count_publishers('/attic/footsteps'))
    info = watcher.get_subscriptions_info_by_topic('/lobby/chat')[0]
    log.info(f'{info.node_namespace}/{info.node_name} listens to {info.topic_type}, {info.qos_profile.reliability.name}')
    log.info('resolved: ' + watcher.resolve_topic_name('chat'))

    ghost.destroy_publisher(p3)
    for attempt in range(50):
        rclpy.spin_once(watcher, timeout_sec=0.1)
        if watcher.count_publishers('/footsteps') == 0:
            log.info('the footsteps have stopped')
            break
    ghost.destroy_node()
    watcher.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
