"""Programs run by hand that read the terminal: ``kit ros run`` and ``kit run`` in a real pseudo-terminal."""

from __future__ import annotations

import fcntl
import os
import re
import signal
import struct
import subprocess
import sys
import termios
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import kit as kit_package
from kit.inspection.sockets import running_worlds, sockets_folder
from tests.launch.conftest import kit
from tests.tui.input.conftest import Terminal
from tests.waiting import wait_until

KIT = str(Path(kit_package.__file__).with_name("__main__.py"))
HEADER = """
import os, select, sys, termios, tty
import rclpy
from rclpy.node import Node
from std_msgs.msg import String

def count_ticks(node):
    node.ticks = 0
    def tick():
        node.ticks += 1
    node.create_timer(0.05, tick)
"""
ASKS = """
def main():
    rclpy.init()
    name = input("Name? ")
    node = Node("asker")
    count_ticks(node)
    while node.ticks < 3:
        rclpy.spin_once(node)
    began = node.get_clock().now().nanoseconds
    goal = input(f"Goal of {name}? ")
    passed = node.get_clock().now().nanoseconds - began
    print("goal", goal, "passed" if passed > 0 else "stood still")
    try:
        input("More? ")
    except EOFError:
        print("no more")
    try:
        print("spinning", flush=True)
        rclpy.spin(node)
    except KeyboardInterrupt:
        print("interrupted", node.ticks > 3)
    print("columns", os.get_terminal_size(0).columns)
"""
KEYS = """
def get_key(settings):
    tty.setraw(sys.stdin.fileno())
    readable, _, _ = select.select([sys.stdin], [], [], 0.1)
    key = sys.stdin.read(1) if readable else ""
    termios.tcsetattr(sys.stdin, termios.TCSADRAIN, settings)
    return key

def main():
    settings = termios.tcgetattr(sys.stdin)
    rclpy.init()
    node = Node("teleop")
    out = node.create_publisher(String, "keys", 10)
    print("ready", flush=True)
    while True:
        key = get_key(settings)
        if key:
            out.publish(String(data=key))
            print("key", repr(key), flush=True)
        if key == "\\x03":
            break
    print("left")
"""
LISTENS = """
from pynput import keyboard

def main():
    rclpy.init()
    node = Node("listener")
    heard = []
    def on_press(key):
        try:
            heard.append(key.char)
        except AttributeError:
            heard.append(key.name)
        print("heard", heard[-1], flush=True)
        if key == keyboard.Key.esc:
            return False
    def on_release(key):
        print("released", flush=True)
    with keyboard.Listener(on_press=on_press, on_release=on_release) as listener:
        print("ready", flush=True)
        listener.join()
    print("left", heard)
"""

SHELL = """
import os, signal, subprocess, sys
signal.signal(signal.SIGTTOU, signal.SIG_IGN)
command = [sys.executable, *sys.argv[1:]]
child = subprocess.Popen(command, process_group=0, preexec_fn=lambda: os.tcsetpgrp(0, os.getpid()))
print("job", child.pid, flush=True)
_, status = os.waitpid(child.pid, os.WUNTRACED)
assert os.WIFSTOPPED(status)
os.tcsetpgrp(0, os.getpgrp())
print("suspended", flush=True)
sys.stdin.readline()
os.tcsetpgrp(0, child.pid)
print("resumed", flush=True)
os.kill(child.pid, signal.SIGCONT)
_, status = os.waitpid(child.pid, 0)
sys.exit(os.waitstatus_to_exitcode(status))
"""
"""What a shell does with one job."""


@pytest.fixture
def run(tmp_path: Path) -> Iterator[Callable[..., Terminal]]:
    """``kit WORDS`` in a terminal, with this program as ``program.py``."""
    made: list[Terminal] = []

    def start(program: str, *words: str, shell: str | None = None) -> Terminal:
        file = tmp_path / "program.py"
        file.write_text(HEADER + program)
        command = [KIT, *(str(file) if word == "FILE" else word for word in words)]
        if shell is not None:
            (tmp_path / "shell.py").write_text(shell)
            command.insert(0, str(tmp_path / "shell.py"))
        made.append(Terminal(*command))
        return made[-1]

    yield start
    for terminal in made:
        terminal.close()


def shown(terminal: Terminal, text: str) -> None:
    terminal.until(lambda: text.encode() in terminal.output, text)


@pytest.mark.long
def test_a_node_asks_before_it_spins_and_between(run: Callable[..., Terminal]) -> None:
    terminal = run(ASKS, "ros", "run", "FILE")
    fcntl.ioctl(terminal.fd, termios.TIOCSWINSZ, struct.pack("HHHH", 30, 97, 0, 0))
    shown(terminal, "Name? ")
    terminal.send(b"Adx\x7fa\n")  # the terminal's own line editing
    shown(terminal, "Goal of Ada? ")
    terminal.pump(0.3)
    terminal.send(b"1 2\n")
    shown(terminal, "goal 1 2 passed")
    shown(terminal, "More? ")
    terminal.send(b"\x04")
    shown(terminal, "no more")
    shown(terminal, "spinning")
    terminal.pump(0.3)
    terminal.send(b"\x03")
    shown(terminal, "interrupted True")
    assert terminal.wait() == 130
    assert b"columns 97" in terminal.output
    terminal.assert_sane()


@pytest.mark.long
def test_single_keys_of_a_program_in_raw_mode(run: Callable[..., Terminal]) -> None:
    terminal = run(KEYS, "ros", "run", "FILE")
    shown(terminal, "ready")
    for key in ("w", "a"):
        assert _send_until(terminal, key.encode(), f"key '{key}'".encode())
    assert _send_until(terminal, b"\x03", b"left")
    assert terminal.wait() in (0, 130)
    terminal.assert_sane()


@pytest.mark.long
def test_the_usual_teleoperation_drives_a_world(run: Callable[..., Terminal], tmp_path: Path) -> None:
    """``ros2 run teleop_twist_keyboard teleop_twist_keyboard``, beside a world in another terminal."""
    workspace = tmp_path / "workspace"
    with kit(
        workspace, "run", "turtlebot", "--serve", "--steps", "100000", "--controller", "forward"
    ) as world:
        wait_until(lambda: running_worlds(sockets_folder(workspace)))
        words = ("--ros-args", "-r", "cmd_vel:=typed")
        terminal = run("", "ros", "run", "teleop_twist_keyboard", "teleop_twist_keyboard", *words)
        shown(terminal, "speed 0.5")
        terminal.send(b"q")
        shown(terminal, "speed 0.55")
        with kit(workspace, "ros", "topic", "echo", "--once", "/typed", "geometry_msgs/msg/Twist") as echo:
            while echo.poll() is None:
                terminal.send(b"j")
                terminal.pump(0.2)
            assert echo.stdout is not None
            heard = echo.stdout.read()
        assert "z: 1.1\n" in heard, heard
        terminal.send(b"\x03")
        assert terminal.wait() == 0
        terminal.assert_sane()
        world.kill()


@pytest.mark.long
def test_a_listener_of_pynput_s_hears_the_terminal(run: Callable[..., Terminal]) -> None:
    terminal = run(LISTENS, "ros", "run", "FILE")
    shown(terminal, "ready")
    terminal.send(b"w")
    shown(terminal, "heard w")
    shown(terminal, "released")
    terminal.send(b"\x1b[A")
    shown(terminal, "heard up")
    terminal.send(b"\x1b")
    shown(terminal, "left ['w', 'up', 'esc']")
    assert terminal.wait() == 0
    terminal.assert_sane()


@pytest.mark.long
def test_a_killed_program_and_a_second_ctrl_c_leave_the_terminal_as_it_was(
    run: Callable[..., Terminal],
) -> None:
    stubborn = """
def main():
    rclpy.init()
    node = Node("stubborn")
    tty.setcbreak(0)
    while True:
        try:
            print("ready", flush=True)
            os.read(0, 1)
        except KeyboardInterrupt:
            print("no", flush=True)
"""
    terminal = run(stubborn, "ros", "run", "FILE")
    shown(terminal, "ready")
    terminal.send(b"\x03")
    shown(terminal, "no")
    terminal.send(b"\x03")
    assert terminal.wait() == 130
    terminal.assert_sane()


@pytest.mark.long
def test_ctrl_z_suspends_and_the_program_goes_on_afterwards(run: Callable[..., Terminal]) -> None:
    terminal = run(ASKS, "ros", "run", "FILE", shell=SHELL)
    shown(terminal, "Name? ")
    terminal.send(b"\x1a")
    shown(terminal, "suspended")
    assert termios.tcgetattr(terminal.other_fd) == terminal.attributes_before
    terminal.send(b"fg\n")
    shown(terminal, "resumed")
    terminal.until(lambda: termios.tcgetattr(terminal.other_fd) != terminal.attributes_before, "raw mode")
    terminal.send(b"Ada\n")
    shown(terminal, "Goal of Ada? ")
    child = int(re.findall(rb"job (\d+)", terminal.output)[0])
    os.kill(child, signal.SIGTERM)
    assert terminal.wait() == 128 + signal.SIGTERM
    terminal.assert_sane()


@pytest.mark.long
def test_a_run_s_controller_asks_while_the_world_goes_on_in_real_time(run: Callable[..., Terminal]) -> None:
    terminal = run(ASKS, "run", "simple", "--controller", "FILE", "--steps", "100000")
    shown(terminal, "Name? ")
    terminal.send(b"Ada\n")
    shown(terminal, "Goal of Ada? ")
    terminal.pump(0.5)
    terminal.send(b"1 2\n")
    shown(terminal, "goal 1 2 passed")
    shown(terminal, "More? ")
    terminal.send(b"\x03")
    terminal.wait()
    ticks = re.search(rb"run +(\d+) steps", terminal.output)
    assert ticks is not None
    assert 5 <= int(ticks[1]) < 50_000, "as fast as it goes, these steps take less than ten seconds"
    terminal.assert_sane()


@pytest.mark.long
def test_what_is_piped_in_is_the_program_s_input(tmp_path: Path) -> None:
    file = tmp_path / "program.py"
    file.write_text(HEADER + ASKS.replace("rclpy.spin(node)", "return"))
    done = subprocess.run(
        [sys.executable, KIT, "ros", "run", str(file)],
        input="Ada\n1 2\n",
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert "goal 1 2" in done.stdout
    assert "no more" in done.stdout


def _send_until(terminal: Terminal, key: bytes, text: bytes) -> bool:
    """Sends a key until the program has read it: outside of its reads it is not in raw mode, as on any terminal."""
    while text not in terminal.output and terminal.process.poll() is None:
        terminal.send(key)
        terminal.pump(0.2)
    return text in terminal.output or terminal.process.poll() is not None
