"""Recordings in their files: what is too long for them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from kit.msg.builtin_interfaces import Time
from kit.run.recording import MAX_TIME_S, Recording, RecordingError, load_recording, save_recording


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
