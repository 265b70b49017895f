"""Processes that a program forks, as multiprocessing does, leave it alone: they compute and wait by the wall clock."""

from __future__ import annotations

from pathlib import Path

from tests.launch.conftest import Launched

LAUNCH = """
from launch import LaunchDescription
from launch.actions import ExecuteProcess

def generate_launch_description():
    return LaunchDescription([ExecuteProcess(cmd=["python3", {file!r}], name="program")])
"""

PROGRAM = """
import multiprocessing
import os
import sys
import threading
import time

import rclpy
from rclpy.node import Node
from std_msgs.msg import Int32

def square(number):
    time.sleep(0.02)
    threading.Event().wait(0.02)
    return number * number

def end_with(number):
    sys.exit(number)

def main():
    heard = []
    node_process = multiprocessing.Process(target=rclpy.init)
    node_process.start()
    node_process.join()
    print("nodes", node_process.exitcode, flush=True)

    rclpy.init()
    node = Node("parent")
    publisher = node.create_publisher(Int32, "count", 10)
    node.create_subscription(Int32, "count", lambda msg: heard.append(msg.data), 10)
    with multiprocessing.Pool(2) as pool:
        job = pool.map_async(square, range(4))
        while not job.ready():
            rclpy.spin_once(node, timeout_sec=0.01)
        print("squares", job.get(), flush=True)

    child = os.fork()
    if child == 0:
        publisher.publish(Int32(data=1))
        time.sleep(0.02)
        end_with(5)
    print("fork", os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
    publisher.publish(Int32(data=2))
    while not heard:
        rclpy.spin_once(node, timeout_sec=0.01)
    print("heard", heard, flush=True)

main()
"""


def test_processes_that_a_program_forks_do_not_disturb_it(tmp_path: Path, launch: Launched) -> None:
    program, file = tmp_path / "program.py", tmp_path / "forks.launch.py"
    program.write_text(PROGRAM)
    file.write_text(LAUNCH.format(file=str(program)))
    out, err, status = launch(file, "--plain")
    lines = [line.removeprefix("[program-1] ") for line in out.splitlines() if line.startswith("[program-1]")]
    assert lines == ["nodes 1", "squares [0, 1, 4, 9]", "fork 5", "heard [2]"], out + err
    assert status == 0
    assert "nodes cannot be in a process that the program has forked" in err
    assert err.count("what it sends goes nowhere") == 1
