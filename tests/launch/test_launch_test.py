"""Tests for launch_testing: the launch and its tests are one run; what is told of them, and the exit code."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from textwrap import dedent
from xml.etree import ElementTree as ET

import pytest
from click.testing import CliRunner

from kit.cli import main

HEAD = """
import sys, time, unittest
import launch, launch_testing, launch_testing.actions, launch_testing.asserts, launch_testing.markers
from launch.actions import ExecuteProcess, TimerAction
from launch_testing.actions import ReadyToTest
from launch_testing_ros import WaitForTopics
"""
COUNTER = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import Int32

class Counter(Node):
    def __init__(self):
        super().__init__('counter')
        self.out = self.create_publisher(Int32, 'count', 10)
        self.count = 0
        self.create_timer(0.1, self.tick)
        self.get_logger().info('counting begins')

    def tick(self):
        self.count += 1
        self.out.publish(Int32(data=self.count))

rclpy.init()
try:
    rclpy.spin(Counter())
except KeyboardInterrupt:
    print('bye')
"""
COUNTED = """
@launch_testing.markers.keep_alive
def generate_test_description():
    counter = ExecuteProcess(cmd=[sys.executable, {counter!r}], name='counter')
    short = ExecuteProcess(cmd=['sh', '-c', 'echo 12; exit 3'], name='short')
    actions = [counter, TimerAction(period=1.0, actions=[short]), TimerAction(period=0.5, actions=[ReadyToTest()])]
    return launch.LaunchDescription(actions), {{'counter': counter, 'short': short}}

class TestActive(unittest.TestCase):
    def setUp(self, short):
        self.short = short

    def test_a_log_line(self, proc_output, counter):
        proc_output.assertWaitFor('counting begins', process=counter, timeout=1)

    def test_an_end(self, proc_info, proc_output):
        began = time.time()
        proc_info.assertWaitForShutdown(self.short, timeout=5)
        self.assertAlmostEqual(time.time() - began, 0.5, delta=0.05)
        proc_output.assertWaitFor('12', process='short', stream='stdout')

    def test_topics(self):
        from std_msgs.msg import Int32
        with WaitForTopics([('count', Int32)], timeout=1.0) as topics:
            self.assertEqual(topics.topics_received(), {{'count'}})
        with self.assertRaises(RuntimeError), WaitForTopics([('other', Int32)], timeout=0.3):
            pass

@launch_testing.post_shutdown_test()
class TestAfter(unittest.TestCase):
    def test_ends(self, proc_info, proc_output, counter):
        launch_testing.asserts.assertExitCodes(proc_info, process=counter)
        self.assertEqual(proc_info[{named}].returncode, 3)
        with launch_testing.asserts.assertSequentialStdout(proc_output, counter) as said:
            said.assertInText('bye')
"""

Tested = Callable[..., tuple[str, int]]


@pytest.fixture
def launch_test(tmp_path: Path) -> Tested:
    """``kit ros launch_test`` of a file with this text: what is printed, and the exit code."""

    def run(text: str, *words: str) -> tuple[str, int]:
        file = tmp_path / "test_it.launch.py"
        file.write_text(HEAD + dedent(text), encoding="utf-8")
        (tmp_path / "counter.py").write_text(COUNTER, encoding="utf-8")
        runner = CliRunner(env={"KIT_WORKSPACE": str(tmp_path / "workspace")})
        result = runner.invoke(main, ["ros", "launch_test", str(file), *words])
        if result.exception is not None and not isinstance(result.exception, SystemExit):
            raise result.exception
        return result.output, result.exit_code

    return run


def test_a_launch_is_tested_while_it_runs_and_after_it(launch_test: Tested, tmp_path: Path) -> None:
    text = COUNTED.format(counter=str(tmp_path / "counter.py"), named="'short'")
    printed, code = launch_test(text, "--junit-xml", str(tmp_path / "results.xml"), "--package-name", "mine")
    assert code == 0, printed
    assert "Ran 3 tests" in printed
    assert "Ran 1 test " in printed
    root = ET.parse(tmp_path / "results.xml").getroot()
    assert {key: root.get(key) for key in ("tests", "failures", "errors", "skipped")} == {
        "tests": "4",
        "failures": "0",
        "errors": "0",
        "skipped": "0",
    }
    named = {(case.get("classname"), case.get("name")): case.get("time") for case in root.iter("testcase")}
    assert named["mine.TestActive", "test_an_end"] == "0.510"
    assert ("mine.TestAfter", "test_ends") in named


def test_a_program_that_lets_the_ctrl_c_of_the_shutdown_through_ends_by_its_signal(
    launch_test: Tested, tmp_path: Path
) -> None:
    (tmp_path / "plain.py").write_text("import rclpy\nrclpy.init()\nrclpy.spin(rclpy.create_node('plain'))\n")
    printed, code = launch_test(
        f"""
        def generate_test_description():
            programs = [
                ExecuteProcess(cmd=[sys.executable, {f"{tmp_path}/"!r} + name + '.py'], name=name)
                for name in ('plain', 'counter')
            ]
            return launch.LaunchDescription([*programs, ReadyToTest()]), {{'plain': programs[0], 'counter': programs[1]}}

        class TestActive(unittest.TestCase):
            def test_output(self, proc_output, counter):
                proc_output.assertWaitFor('counting begins', process=counter)

        @launch_testing.post_shutdown_test()
        class TestAfter(unittest.TestCase):
            def test_ends(self, proc_info, plain, counter):
                self.assertEqual([proc_info[plain].returncode, proc_info[counter].returncode], [-2, 0])
        """
    )
    assert code == 0, printed


def test_each_value_is_a_launch_of_its_own(launch_test: Tested, tmp_path: Path) -> None:
    printed, code = launch_test(
        """
        @launch_testing.parametrize('word', ['left', 'right'])
        def generate_test_description(word):
            said = ExecuteProcess(cmd=['echo', word], name='said')
            keep = launch_testing.util.KeepAliveProc()
            return launch.LaunchDescription([said, keep, ReadyToTest()]), {'said': said}

        class TestWord(unittest.TestCase):
            def test_word(self, proc_output, said, word):
                proc_output.assertWaitFor('left', process=said, stream='stdout')
        """,
        "--junit-xml",
        str(tmp_path / "results.xml"),
    )
    assert code == 1
    assert "test_word[left]" in printed
    assert "'left' is not on stdout" in printed
    (failed,) = ET.parse(tmp_path / "results.xml").getroot().findall(".//testcase[failure]")
    assert failed.get("name") == "test_word[right]"


@pytest.mark.parametrize(
    ("actions", "wrong"),
    [
        ("ExecuteProcess(cmd=['sh', '-c', 'echo lost >&2; exit 4']), ReadyToTest()", "exited with 4"),
        ("ExecuteProcess(cmd=['true']), ReadyToTest()", "keep_alive"),
        (
            "launch_testing.util.KeepAliveProc(), TimerAction(period=20.0, actions=[ReadyToTest()])",
            "Timed out waiting for processes to start up",
        ),
    ],
)
def test_a_launch_that_ends_before_its_tests_has_failed(
    launch_test: Tested, actions: str, wrong: str
) -> None:
    printed, code = launch_test(
        f"""
        def generate_test_description():
            return launch.LaunchDescription([{actions}])

        class TestNever(unittest.TestCase):
            def test_never(self, proc_output):
                proc_output.assertWaitFor('never', timeout=60)
        """
    )
    assert code == 1
    assert wrong in printed


@pytest.mark.parametrize(
    ("text", "code", "wrong"),
    [
        ("def generate_launch_description(): return None", 2, "generate_test_description"),
        ("def generate_test_description(): return launch.LaunchDescription([])", 2, "ReadyToTest"),
        ("def generate_test_description(): return 1 / 0", 2, "test_it.launch.py:7: ZeroDivisionError"),
        (
            "@unittest.skip('not today')\ndef generate_test_description(): pass",
            0,
            "the launch is skipped: not today",
        ),
    ],
)
def test_what_is_no_test_is_told(launch_test: Tested, text: str, code: int, wrong: str) -> None:
    printed, exit_code = launch_test(text)
    assert exit_code == code, printed
    assert wrong in printed


def test_a_launch_file_sends_to_its_own_tests_what_its_handlers_see(launch_test: Tested) -> None:
    """They are one program, as in ROS 2."""
    printed, code = launch_test(
        """
        seen = []

        def generate_test_description():
            on_output = launch.event_handlers.OnProcessIO(on_stdout=lambda event: seen.append(event.text))
            return launch.LaunchDescription([
                launch.actions.DeclareLaunchArgument('word'),
                launch.actions.RegisterEventHandler(on_output),
                ExecuteProcess(cmd=['echo', launch.substitutions.LaunchConfiguration('word')]),
                launch_testing.util.KeepAliveProc(),
                TimerAction(period=1.0, actions=[ReadyToTest()]),
            ])

        class TestSeen(unittest.TestCase):
            def test_seen(self, test_args):
                self.assertEqual(seen, [b'hello\\n'])
                self.assertEqual(test_args, {'word': 'hello'})
        """,
        "word:=hello",
    )
    assert code == 0, printed
