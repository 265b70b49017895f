"""Time that a program waits for passes, however it waits, and by as many readings of a clock on every machine."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Final

import pytest

from kit.host.child.simulated_waits import LOCK_WEIGHT
from kit.host.node_process import NodeProcess
from kit.host.sandbox.limits import Limits
from kit.host.waiter import CALLBACK_WAIT_S
from kit.msg.std_msgs import String
from kit.ros.graph.graph import MAX_READS, READS_PER_STEP, Graph
from kit.ros.node.node import create_graph_node
from kit.run.lockstep import exchange_until_idle
from tests.host.conftest import QUICK, Student

TICK_NS = 10_000_000

PROGRAM = """
import asyncio, datetime, queue, sched, threading, time
from concurrent import futures
import rclpy
from rclpy.node import Node
from rclpy.time import Duration
from std_msgs.msg import String

reads = 0
rclpy.init()
node = Node("waiter")
says = node.create_publisher(String, "said", 10)

def say(name, began):
    passed = (node.get_clock().now() - began).nanoseconds / 1e9
    says.publish(String(data=f"{{name}} {{passed:.2f}} {{reads}}"))

def wait_a_second():
    global reads
{wait}

{use}
"""

USES = {
    "before the first spin": "began = node.get_clock().now()\nwait_a_second()\nsay('x', began)\nrclpy.spin(node)",
    "in a callback": """
def callback():
    timer.cancel()
    began = node.get_clock().now()
    wait_a_second()
    say('x', began)

timer = node.create_timer(0.1, callback)
rclpy.spin(node)
""",
}

WAITS = {
    "ROS clock": "now = node.get_clock().now\nt0 = now()\nwhile now() - t0 < Duration(seconds=1):\n    reads += 1",
    "time": "t0 = time.time()\nwhile time.time() - t0 < 1:\n    reads += 1",
    "monotonic": "t0 = time.monotonic()\nwhile time.monotonic() - t0 < 1:\n    reads += 1",
    "perf_counter": "t0 = time.perf_counter_ns()\nwhile time.perf_counter_ns() - t0 < 1e9:\n    reads += 1",
    "datetime": "end = datetime.datetime.now() + datetime.timedelta(seconds=1)\nwhile datetime.datetime.now() < end:\n    reads += 1",
    "sleep": "time.sleep(1)",
    "polls": "t0 = time.time()\nwhile time.time() - t0 < 1:\n    rclpy.ok()\n    reads += 1",
    "asked event": "done = threading.Event()\nthreading.Timer(1, done.set).start()\nwhile not done.is_set():\n    reads += 1",
    "asked queue": "q = queue.Queue()\nthreading.Timer(1, q.put, (1,)).start()\nwhile True:\n    try:\n        q.get_nowait()\n        break\n    except queue.Empty:\n        reads += 1",
    "queue asked for its length": "q = queue.Queue()\nthreading.Timer(1, q.put, (1,)).start()\nwhile q.qsize() < 1:\n    reads += 1",
    "queue asked whether it is empty": "q = queue.PriorityQueue()\nthreading.Timer(1, q.put, (1,)).start()\nwhile q.empty():\n    reads += 1",
    "queue asked whether it is full": "q = queue.Queue(1)\nq.put(1)\nthreading.Timer(1, q.get).start()\nwhile q.full():\n    reads += 1",
    "queue asked for room": "q = queue.Queue(1)\nq.put(1)\nthreading.Timer(1, q.get).start()\nwhile True:\n    try:\n        q.put_nowait(2)\n        break\n    except queue.Full:\n        reads += 1",
    "queue asked with no time": "q = queue.Queue()\nthreading.Timer(1, q.put, (1,)).start()\nwhile True:\n    try:\n        q.get(timeout=0)\n        break\n    except queue.Empty:\n        reads += 1",
    "asked simple queue": "q = queue.SimpleQueue()\nthreading.Timer(1, q.put, (1,)).start()\nwhile True:\n    try:\n        q.get_nowait()\n        break\n    except queue.Empty:\n        reads += 1",
    "simple queue asked whether it is empty": "q = queue.SimpleQueue()\nthreading.Timer(1, q.put, (1,)).start()\nwhile q.empty():\n    reads += 1",
    "asked lock": "lock = threading.Lock()\nlock.acquire()\nthreading.Timer(1, lock.release).start()\nwhile not lock.acquire(blocking=False):\n    reads += 1",
    "lock asked whether it is held": "lock = threading.Lock()\nlock.acquire()\nthreading.Timer(1, lock.release).start()\nwhile lock.locked():\n    reads += 1",
    "asked reentrant lock": "lock = threading.RLock()\ndef hold():\n    with lock:\n        time.sleep(1)\nthreading.Thread(target=hold).start()\nwhile not lock.acquire(False):\n    reads += 1",
    "asked semaphore": "s = threading.Semaphore(0)\nthreading.Timer(1, s.release).start()\nwhile not s.acquire(blocking=False):\n    reads += 1",
    "asked event with no time": "done = threading.Event()\nthreading.Timer(1, done.set).start()\nwhile not done.wait(0):\n    reads += 1",
    "asked thread": "thread = threading.Thread(target=time.sleep, args=(1,))\nthread.start()\nwhile thread.is_alive():\n    reads += 1",
    "join with no time": "thread = threading.Thread(target=time.sleep, args=(1,))\nthread.start()\nwhile thread in threading.enumerate():\n    thread.join(0)\n    reads += 1",
    "asked future of a pool": "pool = futures.ThreadPoolExecutor(1)\nfuture = pool.submit(time.sleep, 1)\nwhile not future.done():\n    reads += 1",
    "asked future of ROS": "future = rclpy.task.Future()\nthreading.Timer(1, future.set_result, (1,)).start()\nwhile not future.done():\n    reads += 1",
    "variable under a lock": "lock, found = threading.Lock(), []\nthreading.Timer(1, found.append, (1,)).start()\nwhile True:\n    with lock:\n        if found:\n            break\n    reads += 1",
    "variable under a condition": "c, found = threading.Condition(), []\nthreading.Timer(1, found.append, (1,)).start()\nwhile True:\n    with c:\n        if found:\n            break\n    reads += 1",
    "datetime and sleep": "end = datetime.datetime.now() + datetime.timedelta(seconds=1)\nwhile datetime.datetime.now() < end:\n    time.sleep(0.1)",
    "asyncio": "asyncio.run(asyncio.sleep(1))",
    "event": "threading.Event().wait(1)",
    "event without a limit": "done = threading.Event()\nthreading.Timer(1, done.set).start()\ndone.wait()",
    "queue": "try:\n    queue.Queue().get(timeout=1)\nexcept queue.Empty:\n    pass",
    "simple queue": "try:\n    queue.SimpleQueue().get(timeout=1)\nexcept queue.Empty:\n    pass",
    "filled queue": "q = queue.Queue(maxsize=1)\nthreading.Timer(1, q.put, (1,)).start()\nq.get()",
    "condition": "condition = threading.Condition()\nwith condition:\n    condition.wait(1)",
    "condition for": "condition = threading.Condition()\nwith condition:\n    condition.wait_for(lambda: False, timeout=1)",
    "lock": "lock = threading.Lock()\nlock.acquire()\nlock.acquire(timeout=1)",
    "semaphore": "threading.Semaphore(0).acquire(timeout=1)",
    "barrier": "try:\n    threading.Barrier(2).wait(1)\nexcept threading.BrokenBarrierError:\n    pass",
    "join": "thread = threading.Thread(target=time.sleep, args=(5,), daemon=True)\nthread.start()\nthread.join(timeout=1)",
    "join to the end": "thread = threading.Thread(target=time.sleep, args=(1,))\nthread.start()\nthread.join()",
    "held lock": "lock = threading.Lock()\ndef hold():\n    with lock:\n        time.sleep(1)\nthreading.Thread(target=hold).start()\ntime.sleep(0.01)\nwith lock:\n    pass",
    "held reentrant lock": "lock = threading.RLock()\ndef hold():\n    with lock, lock:\n        time.sleep(1)\nthreading.Thread(target=hold).start()\ntime.sleep(0.01)\nwith lock:\n    pass",
    "pool": "with futures.ThreadPoolExecutor(2) as pool:\n    pool.submit(time.sleep, 1).result()",
    "pool's result in time": "pool = futures.ThreadPoolExecutor(2)\ntry:\n    pool.submit(time.sleep, 1.5).result(timeout=1)\nexcept futures.TimeoutError:\n    pass",
    "sched": "s = sched.scheduler(time.monotonic, time.sleep)\ns.enter(0.3, 1, lambda: s.enter(0.7, 1, print))\ns.run()",
    "asyncio's thread": "async def main():\n    await asyncio.wait_for(asyncio.to_thread(time.sleep, 1), 2)\nasyncio.run(main())",
    "timer": "done = threading.Event()\nthreading.Timer(1, done.set).start()\nwhile not done.wait(0.05):\n    pass",
}
CASES = [(wait, use) for wait in WAITS for use in USES]


def said_by(student: Student, wait: str, use: str, seconds: float = 2.5) -> list[str]:
    """What a program says that waits so."""
    body = "\n".join(f"    {line}" for line in WAITS[wait].splitlines())
    return run(student(PROGRAM.format(wait=body, use=USES[use])), seconds)


def run(file: Path, seconds: float, limits: Limits = QUICK) -> list[str]:
    """What a program says in so many simulated seconds."""
    heard: list[str] = []
    graph = Graph(log_sink=lambda record: None)
    node = create_graph_node(graph, "listener")
    node.create_subscription(String, "said", lambda message: heard.append(message.data), 100)
    with NodeProcess.start(graph, file, limits=limits) as process:
        while graph.now_ns < seconds * 1e9:
            exchange_until_idle(graph, [process])
            assert process.failure is None, process.failure
            graph.advance(graph.now_ns + TICK_NS)
    return heard


@pytest.mark.sampled(6)
@pytest.mark.parametrize(("wait", "use"), CASES, ids=lambda each: each.replace(" ", "-"))
def test_a_second_passes(student: Student, wait: str, use: str) -> None:
    (said,) = said_by(student, wait, use)
    assert 1.0 <= float(said.split()[1]) <= 1.06, said


GUARDED: Final = ("variable under a lock", "variable under a condition", "join with no time")
"""Loops that do nothing but acquire a lock, which may also guard what is computed."""
POLLED: Final = [name for name, wait in WAITS.items() if "reads += 1" in wait]
COUNTED: Final = [(name, use) for name in POLLED for use in USES]


@pytest.mark.sampled(6)
@pytest.mark.parametrize(("name", "use"), COUNTED)
def test_a_loop_takes_as_many_readings_on_every_machine(student: Student, name: str, use: str) -> None:
    """As many as the steps of a second take, not as the machine makes in a second: also where each takes longer."""
    slow = WAITS[name].replace("reads += 1", "reads += 1; sum(range(1_000))")
    counts = []
    for wait in (WAITS[name], slow):
        body = "\n".join(f"    {line}" for line in wait.splitlines())
        (said,) = run(student(PROGRAM.format(wait=body, use=USES[use])), 2.5)
        counts.append(int(said.split()[2]))
    assert counts[0] == counts[1]
    most = MAX_READS + READS_PER_STEP * (1e9 / TICK_NS + 4)
    assert counts[0] <= (most if name not in GUARDED else most / LOCK_WEIGHT)


def test_what_waits_for_less_than_a_tick_or_for_no_multiple_of_it_waits_no_longer(student: Student) -> None:
    file = student(
        """
        import threading, time
        import rclpy
        from std_msgs.msg import String

        rclpy.init()
        node = rclpy.create_node("quick")
        says = node.create_publisher(String, "said", 10)
        calls = []
        node.create_timer(0.004, lambda: calls.append(node.get_clock().now().nanoseconds))
        threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
        began = node.get_clock().now()

        def say(*words):
            passed = (node.get_clock().now() - began).nanoseconds / 1e6
            says.publish(String(data=" ".join(map(str, (*words, passed)))))

        for _ in range(7):
            time.sleep(0.003)
        say("slept")
        for _ in range(2):
            time.sleep(0.025)
        say("slept")
        rate = node.create_rate(250)
        for _ in range(5):
            rate.sleep()
        say("looped")
        say(len(calls), {later - early for early, later in zip(calls, calls[1:])})
        time.sleep(1)
        """
    )
    assert run(file, 0.3) == ["slept 21.0", "slept 71.0", "looped 91.0", "22 {4000000} 91.0"]


def test_a_few_readings_let_no_time_pass(student: Student) -> None:
    body = f"for _ in range({MAX_READS // 2 - 2}): node.get_clock().now(); time.time()"
    file = student(PROGRAM.format(wait=f"    {body}", use=USES["in a callback"]))
    assert run(file, 0.5) == ["x 0.00 0"]


@pytest.mark.long
def test_a_thread_that_computes_is_waited_for_by_its_processor_time(student: Student) -> None:
    """Time stands still meanwhile, longer than for one that blocks elsewhere."""
    file = student(
        f"""
        import threading, time
        import rclpy
        from std_msgs.msg import String

        rclpy.init()
        node = rclpy.create_node("thinker")
        says = node.create_publisher(String, "said", 10)
        begin = threading.Event()

        def think():
            begin.wait()
            until = time.process_time() + {1.4 * CALLBACK_WAIT_S}
            while time.process_time() < until:
                pass
            says.publish(String(data=f"{{node.get_clock().now().nanoseconds / 1e9:.2f}}"))

        threading.Thread(target=think).start()
        timer = node.create_timer(0.2, lambda: (timer.cancel(), begin.set()))
        rclpy.spin(node)
        """
    )
    assert run(file, 0.5, replace(QUICK, reply_s=4 * CALLBACK_WAIT_S)) == ["0.20"]


def test_a_stopwatch_never_shows_the_same_time_twice(student: Student) -> None:
    wait = "    a, b = time.perf_counter(), time.perf_counter()\n    assert 0 < b - a < 1e-4"
    file = student(PROGRAM.format(wait=wait, use=USES["in a callback"]))
    assert run(file, 0.5) == ["x 0.00 0"]


def test_a_latched_message_arrives_once_at_a_later_subscription_of_the_same_program(student: Student) -> None:
    file = student(
        """
        import rclpy
        from rclpy.node import Node
        from rclpy.qos import QoSProfile, DurabilityPolicy
        from std_msgs.msg import String

        def main():
            rclpy.init()
            node = Node("both")
            says = node.create_publisher(String, "said", 10)
            latched = QoSProfile(depth=2, durability=DurabilityPolicy.TRANSIENT_LOCAL)
            publisher = node.create_publisher(String, "latched", latched)
            for text in ("a", "b", "c"):
                publisher.publish(String(data=text))

            def subscribe():
                timer.cancel()
                for name, quality in (("first", latched), ("second", latched), ("volatile", 10)):
                    node.create_subscription(
                        String, "latched", lambda m, name=name: says.publish(String(data=f"{name} {m.data}")), quality
                    )

            timer = node.create_timer(0.2, subscribe)
            rclpy.spin(node)
        """
    )
    assert sorted(run(file, 1.0)) == ["first b", "first c", "second b", "second c"]


def test_what_a_program_published_before_it_failed_arrives(student: Student) -> None:
    file = student(
        """
        import rclpy
        from rclpy.node import Node
        from std_msgs.msg import String

        def main():
            rclpy.init()
            node = Node("ending")
            says = node.create_publisher(String, "said", 10)

            def end():
                says.publish(String(data="stop"))
                raise SystemExit(3)

            node.create_timer(0.2, end)
            rclpy.spin(node)
        """
    )
    graph, heard = Graph(log_sink=lambda record: None), []
    node = create_graph_node(graph, "listener")
    node.create_subscription(String, "said", lambda message: heard.append(message.data), 100)
    with NodeProcess.start(graph, file, limits=QUICK) as process:
        while process.failure is None and graph.now_ns < 1e9:
            exchange_until_idle(graph, [process])
            graph.advance(graph.now_ns + TICK_NS)
        assert process.failure is not None
        assert process.failure.status == 3
        graph.run_due()
    assert heard == ["stop"]


ENDING = """
import atexit, threading, time
from concurrent.futures import ThreadPoolExecutor
import rclpy
from std_msgs.msg import String

def main():
    rclpy.init()
    node = rclpy.create_node("ending")
    says = node.create_publisher(String, "said", 10)
    say = lambda text: says.publish(String(data=f"{text} {node.get_clock().now().nanoseconds / 1e9:.2f}"))
    atexit.register(say, "first registered")
    atexit.register(say, "second registered")
    pool = ThreadPoolExecutor(2)
    pool.submit(say, "pool").result()
    threading.Thread(target=lambda: (time.sleep(0.5), say("thread"))).start()
    say("main")
    {ending}
"""


@pytest.mark.parametrize("ending", ["pass", "raise SystemExit(0)", "raise SystemExit(3)"])
def test_a_program_ends_as_in_python(student: Student, ending: str) -> None:
    """Idle pools do not keep it; its threads do; then what it has registered is called, the last first."""
    graph, heard = Graph(log_sink=lambda record: None), []
    node = create_graph_node(graph, "listener")
    node.create_subscription(String, "said", lambda message: heard.append(message.data), 100)
    with NodeProcess.start(graph, student(ENDING.replace("{ending}", ending)), limits=QUICK) as process:
        while process.is_running and graph.now_ns < 3e9:
            exchange_until_idle(graph, [process])
            graph.advance(graph.now_ns + TICK_NS)
        assert not process.is_running
        graph.run_due()
    assert [text.rpartition(" ")[0] for text in heard] == [
        "pool",
        "main",
        "thread",
        "second registered",
        "first registered",
    ]
    assert float(heard[-1].split()[-1]) >= 0.5


def test_a_listener_that_spins_by_itself_fills_the_buffer(student: Student) -> None:
    file = student(
        """
        import threading
        import rclpy
        from geometry_msgs.msg import TransformStamped
        from rclpy.duration import Duration
        from rclpy.time import Time
        from std_msgs.msg import String
        from tf2_ros import Buffer, TransformBroadcaster, TransformListener

        def main():
            rclpy.init()
            node = rclpy.create_node("looker")
            says = node.create_publisher(String, "said", 10)
            buffer = Buffer()
            TransformListener(buffer, node, spin_thread=True)
            broadcaster = TransformBroadcaster(node)
            transform = TransformStamped(child_frame_id="b")
            transform.header.frame_id = "a"
            threading.Timer(0.5, broadcaster.sendTransform, (transform,)).start()
            buffer.lookup_transform("a", "b", Time(), timeout=Duration(seconds=2))
            says.publish(String(data=f"{node.get_clock().now().nanoseconds / 1e9:.1f}"))
            rclpy.shutdown()
        """
    )
    assert run(file, 1.5) == ["0.5"]


def test_callbacks_of_one_instant_begin_in_their_order_though_they_run_in_threads(student: Student) -> None:
    """The first of them take longest: without their order, the last would speak first."""
    file = student(
        """
        import rclpy
        from rclpy.callback_groups import ReentrantCallbackGroup
        from rclpy.executors import MultiThreadedExecutor
        from std_msgs.msg import String

        rclpy.init()
        node = rclpy.create_node("many")
        says = node.create_publisher(String, "said", 100)
        group = ReentrantCallbackGroup()

        def callback(number):
            sum(range(100_000 * (6 - number)))
            says.publish(String(data=f"{number}"))

        for number in range(6):
            node.create_timer(0.5, lambda number=number: callback(number), group)
        executor = MultiThreadedExecutor(6)
        executor.add_node(node)
        executor.spin()
        """
    )
    assert run(file, 1.2) == [*"012345"] * 2
