import os
import time
import unittest

import launch
import launch.actions
import launch_testing
import launch_testing.actions
import launch_testing.asserts
import launch_testing.markers
import pytest
import rclpy
from launch_testing.util import KeepAliveProc
from std_msgs.msg import Int64


@pytest.mark.launch_test
@launch_testing.markers.keep_alive
@launch_testing.parametrize('prefix', ['', '/a'])
def generate_test_description(prefix):
    path = os.path.join(os.path.dirname(__file__), 'count_up.py')
    counter = launch.actions.ExecuteProcess(
        cmd=['python3', path, '--ros-args', '-r', f'count:={prefix}/count', '-r', '__node:=renamed'],
        additional_env={'PYTHONUNBUFFERED': '1'})
    return launch.LaunchDescription([counter, launch_testing.actions.ReadyToTest()]), {'counter': counter, 'prefix': prefix}


class TestCounting(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rclpy.init()

    @classmethod
    def tearDownClass(cls):
        rclpy.shutdown()

    def setUp(self):
        self.node = rclpy.create_node('test_counting')

    def tearDown(self):
        self.node.destroy_node()

    def test_counts(self, prefix):
        got = []
        sub = self.node.create_subscription(Int64, f'{prefix}/count', lambda m: got.append(m.data), 10)
        try:
            end = time.time() + 20
            while time.time() < end and len(got) < 5:
                rclpy.spin_once(self.node, timeout_sec=0.5)
            self.assertGreaterEqual(len(got), 5)
            self.assertEqual(got, list(range(got[0], got[0] + len(got))))
            self.assertIn('renamed', self.node.get_node_names())
        finally:
            self.node.destroy_subscription(sub)

    def test_output(self, proc_output, counter):
        proc_output.assertWaitFor('sent 3', timeout=20, process=counter, stream='stdout')


@launch_testing.post_shutdown_test()
class TestAfter(unittest.TestCase):
    def test_exit(self, proc_info, proc_output, counter):
        launch_testing.asserts.assertExitCodes(proc_info, allowable_exit_codes=[0, -2, 130], process=counter)
        launch_testing.asserts.assertInStderr(proc_output, 'bye', counter)
