"""The counter, tested as the documentation of launch_testing shows."""
import os
import sys
import unittest

import launch
import launch_ros.actions
import launch_testing
import launch_testing.actions
import launch_testing.asserts
import launch_testing.markers
import pytest
import rclpy
from launch.actions import ExecuteProcess, TimerAction
from launch_testing_ros import WaitForTopics
from rclpy.node import Node
from std_msgs.msg import Int32
from std_srvs.srv import Trigger


@pytest.mark.launch_test
@launch_testing.markers.keep_alive
def generate_test_description():
    path = os.path.join(os.path.dirname(__file__), 'counter.py')
    counter = ExecuteProcess(cmd=[sys.executable, path], name='counter')
    limited = ExecuteProcess(
        cmd=[sys.executable, path, '--ros-args', '-r', '__ns:=/limited', '-p', 'limit:=10'],
        name='limited')
    return (
        launch.LaunchDescription([
            counter,
            limited,
            TimerAction(period=1.0, actions=[launch_testing.actions.ReadyToTest()]),
        ]),
        {'counter': counter, 'limited': limited},
    )


class TestCounter(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rclpy.init()

    @classmethod
    def tearDownClass(cls):
        rclpy.shutdown()

    def setUp(self):
        self.node = rclpy.create_node('test_counter')

    def tearDown(self):
        self.node.destroy_node()

    def test_announces_itself(self, proc_output, counter):
        proc_output.assertWaitFor('counting begins', timeout=5, process=counter)

    def test_limit(self, proc_info, proc_output, limited):
        proc_output.assertWaitFor('limit reached', process=limited, timeout=10)
        proc_info.assertWaitForShutdown(process=limited, timeout=10)

    def test_counts_upwards(self):
        heard = []
        self.node.create_subscription(Int32, 'count', lambda m: heard.append(m.data), 10)
        end = self.node.get_clock().now() + rclpy.duration.Duration(seconds=2)
        while self.node.get_clock().now() < end and len(heard) < 10:
            rclpy.spin_once(self.node, timeout_sec=0.1)
        self.assertEqual(len(heard), 10)
        self.assertEqual(heard, list(range(heard[0], heard[0] + 10)))

    def test_restart(self):
        client = self.node.create_client(Trigger, 'restart')
        self.assertTrue(client.wait_for_service(timeout_sec=5.0))
        future = client.call_async(Trigger.Request())
        rclpy.spin_until_future_complete(self.node, future, timeout_sec=5.0)
        self.assertTrue(future.result().success)
        self.assertRegex(future.result().message, r'was \d+')

    def test_topics(self):
        with WaitForTopics([('count', Int32)], timeout=5.0) as topics:
            self.assertEqual(topics.topics_received(), {'count'})


@launch_testing.post_shutdown_test()
class TestAfterwards(unittest.TestCase):
    def test_exit_codes(self, proc_info, counter, limited):
        launch_testing.asserts.assertExitCodes(
            proc_info, [0, 7, -2], process=counter)
        self.assertEqual(proc_info[limited].returncode, 7)

    def test_output(self, proc_output, counter):
        launch_testing.asserts.assertInStderr(proc_output, 'counter is told to stop', counter)
