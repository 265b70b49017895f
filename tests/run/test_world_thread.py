"""A run in a thread at a pace: when ticks are due, what is asked while it runs, and how it ends."""

from __future__ import annotations

import threading
import time

import pytest

from kit.ros.graph.graph import Graph
from kit.run.pacing import MAX_LAG_S, MAXIMUM, Schedule, SpeedMeter
from kit.run.runner import Runner
from kit.run.scenario import scenario_on_map
from kit.run.world_thread import WorldThread
from kit.sim.simulation import Simulation
from kit.world.catalogue import find_map
from tests.waiting import wait_until


def due_ticks(schedule: Schedule, now: float) -> int:
    count = 0
    while schedule.is_due(now):
        schedule.count_tick()
        count += 1
        assert count < 10_000
    return count


@pytest.mark.parametrize(("factor", "ticks"), [(1.0, 10), (10.0, 100), (0.5, 5)])
def test_so_many_ticks_are_due_as_the_factor_says(factor: float, ticks: int) -> None:
    schedule = Schedule(0.01, 0.0)
    schedule.set_factor(factor)
    schedule.restart(0.0)
    total = sum(due_ticks(schedule, step * 0.02) for step in range(1, 6))
    assert total == pytest.approx(ticks, abs=1)
    assert 0 <= schedule.seconds_until_next(0.1) <= 0.01 / factor + 1e-9


def test_a_run_that_fell_far_behind_does_not_jump() -> None:
    schedule = Schedule(0.01, 0.0)
    assert due_ticks(schedule, 100.0) <= MAX_LAG_S / 0.01 + 1


def test_as_fast_as_it_goes_is_always_due() -> None:
    schedule = Schedule(0.01, 0.0)
    schedule.set_factor(MAXIMUM)
    assert all(schedule.is_due(0.0) for _ in range(50))
    assert schedule.seconds_until_next(0.0) == 0.0


def test_the_meter_says_what_was_reached() -> None:
    meter = SpeedMeter()
    for step in range(1, 300):
        meter.add(0.05, step * 0.01)
    assert meter.factor == pytest.approx(5.0, rel=0.05)
    meter.restart()
    assert meter.factor == 0.0


@pytest.fixture
def runner() -> Runner:
    graph = Graph()
    return Runner(Simulation(scenario_on_map(find_map("gate")).world), graph)


def test_it_pauses_steps_and_goes_on(runner: Runner) -> None:
    with WorldThread(runner, factor=MAXIMUM, on_change=lambda runner: None) as live:
        wait_until(lambda: runner.simulation.tick > 100)
        live.set_paused(True)
        wait_until(lambda: live.pacing.paused)
        stood = runner.simulation.tick
        live.step(3)
        wait_until(lambda: runner.simulation.tick == stood + 3)
        live.set_paused(False)
        wait_until(lambda: runner.simulation.tick > stood + 100)


def test_jobs_are_done_in_the_worlds_thread_even_while_paused(runner: Runner) -> None:
    threads: list[str] = []
    with WorldThread(runner, on_change=lambda runner: None) as live:
        live.set_paused(True)
        wait_until(lambda: live.pacing.paused)
        live.post(lambda runner: threads.append(threading.current_thread().name))
        wait_until(lambda: threads)
    assert threads == ["world"]


def test_the_end_waits_for_a_job_that_has_set_the_clock_back(runner: Runner) -> None:
    """As a restart does: what comes after the end would otherwise take the world apart under it."""
    has_reset, may_end = threading.Event(), threading.Event()

    def restart(runner: Runner) -> None:
        runner.call_service("reset")
        has_reset.set()
        may_end.wait(10)

    with WorldThread(runner, factor=MAXIMUM, on_change=lambda runner: None) as live:
        wait_until(lambda: runner.simulation.tick > 0)
        live.post(restart)
        assert has_reset.wait(10)
        assert runner.simulation.tick == 0
        threading.Timer(0.1, may_end.set).start()
        assert live.stop()
        assert may_end.is_set()


@pytest.mark.long
def test_real_time_is_kept(runner: Runner) -> None:
    with WorldThread(runner, on_change=lambda runner: None):
        start, tick = time.monotonic(), runner.simulation.tick
        time.sleep(1.0)
        passed = time.monotonic() - start
        simulated = (runner.simulation.tick - tick) * runner.simulation.step_size
    assert simulated == pytest.approx(passed, abs=MAX_LAG_S + 0.1)


def test_a_job_that_fails_ends_the_run_and_is_told(runner: Runner) -> None:
    changes: list[int] = []
    with WorldThread(runner, on_change=lambda runner: changes.append(runner.simulation.tick)) as live:

        def fail(runner: Runner) -> None:
            raise ValueError("no")

        live.post(fail)
        wait_until(lambda: live.failure is not None)
        assert isinstance(live.failure, ValueError)
    assert changes
