"""What goes on and on, in a terminal of its own: its lines, and its end by Ctrl-C or with the world."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

from tests.inspection.conftest import Stage
from tests.waiting import wait_until

EXIT_INTERRUPTED = 130


@contextmanager
def terminal(workspace: Path, *words: str, cwd: Path | None = None) -> Iterator[subprocess.Popen[str]]:
    """``kit ros ...`` in a process of its own."""
    process = subprocess.Popen(
        [sys.executable, "-m", "kit", "ros", *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=cwd,
        env={**os.environ, "KIT_WORKSPACE": str(workspace)},
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def lines(process: subprocess.Popen[str], count: int) -> list[str]:
    assert process.stdout is not None
    return [process.stdout.readline() for _ in range(count)]


def interrupted(process: subprocess.Popen[str]) -> tuple[str, int]:
    """What it still complains about after Ctrl-C, and its exit code."""
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=10)
    return err, process.returncode


@pytest.mark.long
def test_meters_report_every_second_of_the_world(stage: Stage) -> None:
    """Twenty times as fast as real time, and yet 10 Hz: the world's time counts."""
    with (
        terminal(stage.workspace, "topic", "hz", "/demo/chatter", "-w", "20") as hz,
        terminal(stage.workspace, "topic", "bw", "/demo/chatter") as bw,
        terminal(stage.workspace, "topic", "delay", "/demo/points") as delay,
        terminal(stage.workspace, "topic", "echo", "/demo/chatter") as echo,
    ):
        rate = lines(hz, 8)
        assert rate[0::2] == ["average rate: 10.000\n"] * 4
        assert rate[7] == "\tmin: 0.100s max: 0.100s std dev: 0.00000s window: 20\n"
        subscribed, bandwidth, sizes = lines(bw, 3)
        assert subscribed == "Subscribed to [/demo/chatter]\n"
        assert bandwidth.split()[1] == "B/s"
        assert bandwidth.split()[2] == "from"
        assert sizes == "\tMessage size mean: 14 B min: 14 B max: 14 B\n"
        late, statistics = lines(delay, 2)
        assert late == "average delay: 0.020\n"
        assert statistics.startswith("\tmin: 0.020s max: 0.020s std dev: 0.00000s window: ")
        assert lines(echo, 4) == ["data: hello\n", "---\n"] * 2
        for process in (hz, bw, delay, echo):
            assert interrupted(process) == ("", EXIT_INTERRUPTED)


@pytest.mark.long
def test_publishing_again_and_again(stage: Stage) -> None:
    with terminal(
        stage.workspace,
        "topic",
        "pub",
        "-r",
        "10",
        "-p",
        "2",
        "/demo/orders",
        "std_msgs/msg/String",
        "data: go",
    ) as process:
        assert lines(process, 5) == [
            "publisher: beginning loop\n",
            "publishing #2: std_msgs.msg.String(data='go')\n",
            "\n",
            "publishing #4: std_msgs.msg.String(data='go')\n",
            "\n",
        ]
        assert interrupted(process) == ("", EXIT_INTERRUPTED)


def test_a_pipe_that_closes_early_is_no_trouble(stage: Stage) -> None:
    with terminal(stage.workspace, "topic", "echo", "/demo/chatter") as process:
        lines(process, 2)
        assert process.stdout is not None
        process.stdout.close()
        process.stdout = None
        assert process.stderr is not None
        assert "Traceback" not in process.stderr.read()
        process.wait(timeout=10)


@pytest.mark.long
@pytest.mark.parametrize(
    "words", [("service", "call", "/later", "std_srvs/srv/Empty"), ("topic", "hz", "/later")]
)
def test_waiting_for_what_is_not_there_yet_ends_by_ctrl_c(words: tuple[str, ...], stage: Stage) -> None:
    with terminal(stage.workspace, *words) as process:
        stream = process.stdout if words[0] == "service" else process.stderr
        assert stream is not None
        assert stream.readline().startswith(("waiting for service", "WARNING: topic [/later]"))
        assert interrupted(process) == ("", EXIT_INTERRUPTED)


@pytest.mark.long
def test_a_bag_recorded_from_another_terminal_is_read_by_an_independent_reader(
    stage: Stage, tmp_path: Path
) -> None:
    with terminal(
        stage.workspace, "bag", "record", "/demo/chatter", "/demo/points", "-o", "drive", cwd=tmp_path
    ) as process:
        assert process.stderr is not None
        assert any("Recording" in line for line in process.stderr)
        wait_until(lambda: stage.graph.subscription_count("/demo/chatter"))
        # Ten times as long as needed: on a busy machine the recorder is behind when it is interrupted.
        enough = stage.graph.now_ns + 20_000_000_000
        wait_until(lambda: stage.graph.now_ns > enough)
        err, code = interrupted(process)
    assert code == EXIT_INTERRUPTED
    assert "messages in drive" in err
    with (tmp_path / "drive" / "drive_0.mcap").open("rb") as opened:
        found = [
            (channel.topic, message.log_time, decoded)
            for _, channel, message, decoded in make_reader(
                opened, decoder_factories=[DecoderFactory()]
            ).iter_decoded_messages()
        ]
    chatter = [(time, message.data) for topic, time, message in found if topic == "/demo/chatter"]
    assert len(chatter) >= 20
    assert {data for _, data in chatter} == {"hello"}
    assert {time % 100_000_000 for time, _ in chatter} == {0}
    points = [message for topic, _, message in found if topic == "/demo/points"]
    assert {(point.header.frame_id, point.point.x) for point in points} == {("map", 1.5)}
