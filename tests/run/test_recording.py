"""Recordings in their files: what is too long for them, and a tick that was interrupted."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from kit.arrays import FloatArray
from kit.geometry import Pose
from kit.msg.builtin_interfaces import Time
from kit.run.recording import MAX_TIME_S, Recorder, Recording, RecordingError, load_recording, save_recording
from kit.sim.simulation import Simulation


def test_a_recording_is_as_long_as_a_stamp_can_say(tmp_path: Path) -> None:
    assert Time(sec=MAX_TIME_S).sec == MAX_TIME_S
    file = tmp_path / "drive.npz"

    def load(step_size: float) -> Recording:
        poses, counts = np.zeros((2, 3)), np.ones(2, dtype=np.int64)
        models = ((0, ("serp",)),)
        save_recording(Recording("maze", None, 1, step_size, models, (), poses, counts), file)
        return load_recording(file)

    assert load(MAX_TIME_S / 2).ticks == 2
    with pytest.raises(RecordingError, match=f"more than {MAX_TIME_S} s"):
        load(math.nextafter(MAX_TIME_S / 2, math.inf))


def test_a_recording_ends_before_the_tick_that_was_interrupted(tmp_path: Path) -> None:
    is_interrupted = False

    def poses() -> Iterator[Pose]:
        yield Pose(1.0, 2.0, 0.5)
        if is_interrupted:
            raise KeyboardInterrupt
        yield Pose(3.0, 4.0, -0.5)

    stand_in = SimpleNamespace(seed=1, step_size=0.01, model_names=("serp", "box"), poses=poses)
    simulation = cast("Simulation", stand_in)
    recorder = Recorder("maze", None, simulation)
    recorder.on_step(simulation)
    is_interrupted = True
    with pytest.raises(KeyboardInterrupt):
        recorder.on_step(simulation)
    save_recording(recorder.recording(), tmp_path / "run.npz")
    recording = load_recording(tmp_path / "run.npz")
    assert recording.ticks == 1
    assert recording.track("box").tolist() == [[3.0, 4.0, -0.5]]


def test_a_run_in_which_nothing_moves_is_known() -> None:
    still = np.tile([[1.0, 2.0, 0.5], [3.0, 0.0, 0.0]], (4, 1))
    turned = still.copy()
    turned[-1, 2] += 0.1

    def recording(poses: FloatArray, counts: tuple[int, ...] = (2, 2, 2, 2)) -> Recording:
        models = ((0, ("serp", "crate")),)
        return Recording("simple", None, 1, 0.01, models, (), poses, np.array(counts))

    assert not recording(still).moves()
    assert recording(turned).moves()
    assert not recording(still[:0], ()).moves()
