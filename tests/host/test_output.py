"""What a program prints, on its way to a screen."""

from __future__ import annotations

from kit.host.output import MAX_DUMP_LINES, MAX_LINE, OutputCollector, OutputLine, StackPosition

DUMP = b"""Fatal Python error: Segmentation fault

Thread 0x00007f9c (most recent call first):
  File "/usr/lib/python3.11/threading.py", line 324 in wait
  File "/home/ada/robots/drive.py", line 99 in main

Current thread 0x00007f9d (most recent call first):
  File "/home/ada/robots/drive.py", line 12 in on_scan
  File "/kit/ros/ready_queue.py", line 5 in perform
"""


def test_lines_arrive_whole_and_in_order() -> None:
    output = OutputCollector(1000)
    output.feed("out", b"one\ntw")
    output.feed("err", b"warning\r\n")
    output.feed("out", b"o\nthree")
    assert output.take().lines == (
        OutputLine("out", "one"),
        OutputLine("err", "warning"),
        OutputLine("out", "two"),
    )
    output.finish()
    assert output.take().lines == (OutputLine("out", "three"),)
    assert output.take().lines == ()


def test_a_flood_is_counted_and_dropped() -> None:
    output = OutputCollector(1000)
    for _ in range(100):
        output.feed("out", b"x" * 99 + b"\n")
    printed = output.take()
    assert len(printed.lines) == 10
    assert printed.dropped == 9000
    assert "9,000" in printed.omission
    output.feed("out", b"again\n")
    assert output.take().lines == (OutputLine("out", "again"),)


def test_an_endless_line_takes_no_memory() -> None:
    output = OutputCollector(10**6)
    for _ in range(100):
        output.feed("out", b"y" * 65536)
    output.finish()
    printed = output.take()
    assert [len(line.text) for line in printed.lines] == [MAX_LINE]
    assert printed.dropped > 6_000_000


def test_what_is_cut_from_a_long_line_is_counted() -> None:
    output = OutputCollector(10**6)
    output.feed("out", "é".encode() * (MAX_LINE + 100) + b"\nshort\n")
    printed = output.take()
    assert [len(line.text) for line in printed.lines] == [MAX_LINE, 5]
    assert printed.dropped == 200


def test_nothing_steers_the_terminal() -> None:
    output = OutputCollector(1000)
    output.feed("out", b"\x1b[2J::error::\x07 \xff\xfe \xc2\x9b31m\n")
    (line,) = output.take().lines
    assert line.text.isprintable()


def test_where_a_program_was_is_read_and_not_shown() -> None:
    output = OutputCollector(10_000)
    output.feed("err", b"before\n" + DUMP)
    assert output.position("/home/ada/robots") == StackPosition("drive.py", 12, "on_scan")
    assert output.position("/home/bob") is None
    assert output.take().lines == (OutputLine("err", "before"),)


def test_where_a_program_was_with_letters_beyond_ascii() -> None:
    output = OutputCollector(10_000)
    output.feed(
        "err", b'Current thread 0x01 (most recent call first):\n  File "/home/j\\xfcrgen/r.py", line 3 in f\n'
    )
    assert output.position("/home/jürgen") == StackPosition("r.py", 3, "f")


def test_where_a_program_was_takes_little_memory() -> None:
    output = OutputCollector(100)
    output.feed("err", DUMP + b'  File "/x", line 1 in f\n' * 100_000)
    assert output.position("/home/ada/robots") == StackPosition("drive.py", 12, "on_scan")


def test_a_long_stack_dump_is_kept_up_to_its_last_line() -> None:
    own = b'  File "/home/ada/robots/drive.py", line 7 in go\n'
    head = b"Current thread 0x00007f9d (most recent call first):\n"
    for others, found in (
        (MAX_DUMP_LINES - 2, StackPosition("drive.py", 7, "go")),
        (MAX_DUMP_LINES - 1, None),
    ):
        output = OutputCollector(1000)
        output.feed("err", head + b'  File "/kit/x.py", line 1 in f\n' * others + own)
        assert output.position("/home/ada/robots") == found
        assert output.take().lines == ()
