"""ROS 2's import names: there for those who ask, nowhere else."""

from __future__ import annotations

import importlib
import subprocess
import sys
from pathlib import Path

import pytest

from kit.msg.interfaces import PACKAGES, interfaces
from kit.msg.message import Message, Service
from kit.ros import NAMES_FOLDER
from kit.ros.late_names import is_absent_name
from tests.cases import every_case
from tests.ros.names import (
    find_absent,
    find_missing,
    find_shadowed,
    find_unresolved,
    read_programs,
    real_names,
)

FOLDER = Path(NAMES_FOLDER)
MODULES = sorted(
    str(file.relative_to(FOLDER).with_suffix("")).replace("/", ".").removesuffix(".__init__")
    for file in FOLDER.rglob("*.py")
)


def python(code: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Runs the code in a fresh process that knows the import names."""
    prelude = "import sys, kit.ros; kit.ros.install_import_names()\n"
    return subprocess.run(
        [sys.executable, "-c", prelude + code, *arguments],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


@pytest.mark.usefixtures("import_names")
@every_case("module", MODULES)
def test_every_name_can_be_imported(module: str) -> None:
    found = importlib.import_module(module)
    for name in getattr(found, "__all__", ()):
        assert hasattr(found, name)


@pytest.mark.usefixtures("import_names")
@every_case("package", PACKAGES)
def test_a_package_of_messages_has_all_of_them(package: str) -> None:
    for part, kind in (("msg", Message), ("srv", Service)):
        ours = {cls.__name__: cls for cls in interfaces(package) if issubclass(cls, kind)}
        if ours:
            named = importlib.import_module(f"{package}.{part}")
            assert {name: getattr(named, name) for name in named.__all__} == ours


@pytest.mark.usefixtures("import_names")
def test_every_name_of_ros_2_s_own_modules_is_here_or_says_what_it_would_need() -> None:
    """Those that a module defines, and those that it imports and so offers too."""
    names = real_names()
    assert len(names) > 2000
    assert find_unresolved(names) == []
    assert find_shadowed(names) == []
    absent = find_absent(names)
    rclpy = [name for name in absent if name.startswith(("rclpy.", "tf2_ros.", "message_filters."))]
    assert len(rclpy) <= 81
    assert len(absent) <= 545


@pytest.mark.usefixtures("import_names")
def test_a_name_that_the_kit_does_not_have_can_be_imported_but_not_used() -> None:
    from launch import LaunchService
    from rclpy.clock import ClockHandle

    class Mine(ClockHandle): ...

    def annotated(handle: ClockHandle | None) -> None: ...

    for use in (LaunchService, Mine, lambda: LaunchService.run):
        with pytest.raises(NotImplementedError, match="is not in the kit: it needs"):
            use()


@pytest.mark.usefixtures("import_names")
@every_case(
    "module, name",
    [
        ("rclpy.time", "Duration"),
        ("rclpy.node", "Parameter"),
        ("rclpy.node", "MutuallyExclusiveCallbackGroup"),
        ("rclpy.action.client", "GoalStatus"),
        ("rclpy.parameter", "ParameterType"),
        ("launch.actions.execute_process", "ExecuteProcess"),
        ("geometry_msgs.msg._twist", "Twist"),
        ("sensor_msgs.msg._laser_scan", "LaserScan"),
        ("tf2_msgs.msg._tf_message", "TFMessage"),
        ("std_srvs.srv._set_bool", "SetBool"),
        ("turtlesim_msgs.msg", "Pose"),
        ("turtlesim_msgs.srv", "Spawn"),
        ("turtlebot3_msgs.srv", "Sound"),
    ],
)
def test_a_name_that_a_module_offers_too_is_the_same_class(module: str, name: str) -> None:
    found = getattr(importlib.import_module(module), name)
    assert isinstance(found, type)
    assert found.__name__ == name
    assert not is_absent_name(found)


@pytest.mark.usefixtures("import_names")
@every_case(
    ("module", "name", "of"),
    [
        ("std_srvs.srv._set_bool", "SetBool_Request", "SetBool.Request"),
        ("example_interfaces.action._fibonacci", "Fibonacci_Goal", "Fibonacci.Goal"),
        ("example_interfaces.action._fibonacci", "Fibonacci_SendGoal", "Fibonacci.Impl.SendGoalService"),
        (
            "example_interfaces.action._fibonacci",
            "Fibonacci_GetResult_Response",
            "Fibonacci.Impl.GetResultService.Response",
        ),
        (
            "example_interfaces.action._fibonacci",
            "Fibonacci_FeedbackMessage",
            "Fibonacci.Impl.FeedbackMessage",
        ),
    ],
)
def test_what_generated_modules_have_besides_the_interface(module: str, name: str, of: str) -> None:
    generated = importlib.import_module(module)
    first, *inner = of.split(".")
    expected = getattr(generated, first)
    for word in inner:
        expected = getattr(expected, word)
    assert getattr(generated, name) is expected
    assert not hasattr(generated, f"{name}x")


@pytest.mark.sampled(4)
@pytest.mark.parametrize(
    "submodule", ["node", "qos", "time", "duration", "logging", "executors", "clock", "task"]
)
def test_submodules_are_there_after_a_plain_import(submodule: str) -> None:
    run = python(f"import rclpy; print(rclpy.{submodule}.__name__, hasattr(rclpy, 'nonsense'))")
    assert run.stdout.split() == [f"rclpy.{submodule}", "False"], run.stderr


@pytest.mark.usefixtures("import_names")
def test_public_programs_find_their_names() -> None:
    missing = find_missing(read_programs())
    assert len(missing) == 178
    assert sum(not names for names in missing.values()) >= 159


def test_without_the_folder_the_names_mean_nothing() -> None:
    for name in ("rclpy", "std_msgs", "tf2_ros"):
        run = subprocess.run(
            [sys.executable, "-c", f"import kit.ros.node.node, {name}"],
            capture_output=True,
            text=True,
            check=False,
        )
        assert f"No module named '{name}'" in run.stderr


def test_a_fresh_process_starts_light() -> None:
    run = python(
        "import rclpy; from rclpy.node import Node; from sensor_msgs.msg import LaserScan; from std_srvs.srv import Trigger\n"
        "rclpy.init(args=[]); n = Node('n'); n.create_subscription(LaserScan, 's', print, 1)\n"
        "print(*[m for m in ('numpy', 'yaml', 'rosbags', 'asyncio', 'numba', 'pymunk', 'logging') if m in sys.modules])"
    )
    assert run.stderr == ""
    assert run.stdout.split() == []


TALKER = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        self.publisher_ = self.create_publisher(String, "chatter", 10)
        self.subscription = self.create_subscription(String, "chatter", self.listener_callback, 10)
        self.timer = self.create_timer(0.001, self.timer_callback)
        self.graph, self.ready_queue, self.i = "mine", "mine too", 0

    def timer_callback(self):
        msg = String()
        msg.data = "Hello World: %d" % self.i
        self.publisher_.publish(msg)
        self.get_logger().info('Publishing: "%s"' % msg.data)
        self.i += 1

    def listener_callback(self, msg):
        self.get_logger().info('I heard: "%s"' % msg.data)
        if self.i == 3:
            raise SystemExit


def main(args=None):
    rclpy.init(args=args)
    talker = Talker()
    try:
        rclpy.spin(talker)
    finally:
        talker.destroy_node()
        rclpy.shutdown()


main()
"""


def test_the_first_program_of_every_tutorial_runs() -> None:
    run = python(TALKER)
    assert run.returncode == 0, run.stderr
    texts = [line.split("]: ")[1] for line in run.stderr.splitlines()]
    assert texts[:2] == ['Publishing: "Hello World: 0"', 'I heard: "Hello World: 0"']
    assert run.stderr.startswith("[INFO] [")


def test_and_with_arguments() -> None:
    run = python(TALKER, "--ros-args", "-r", "__node:=other", "-r", "chatter:=talk")
    assert "[other]: I heard" in run.stderr


def test_a_folder_without_an_init_is_no_package_of_the_kit() -> None:
    assert not (FOLDER / "__init__.py").exists()


def test_names_come_before_or_after_those_that_are_installed(tmp_path: Path) -> None:
    """As a student's own module, or an installed ROS 2."""
    (tmp_path / "launch.py").write_text("")
    (tmp_path / "my_msgs").mkdir()
    (tmp_path / "my_msgs" / "__init__.py").write_text("own = True")
    (tmp_path / "my_msgs" / "msg").mkdir()
    (tmp_path / "my_msgs" / "msg" / "Reading.msg").write_text("float64 value")
    for first in (True, False):
        code = (
            f"import sys, kit.ros; sys.path.insert(0, {str(tmp_path)!r})\n"
            f"kit.ros.install_import_names({{'my_msgs': {str(tmp_path / 'my_msgs')!r}}}, first={first})\n"
            "import launch, my_msgs; from my_msgs.msg import Reading; from std_msgs.msg import Header\n"
            "print(launch.__file__, my_msgs.own, Reading(value=1.0).value, Header.__base__.__module__)"
        )
        run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
        folder = FOLDER if first else tmp_path
        assert run.stdout.startswith(str(folder)), run.stderr
        assert run.stdout.split()[1:] == ["True", "1.0", "kit.msg.message"]
