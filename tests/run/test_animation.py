"""A recording as a file to show around: every ending, its length, its errors."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from PIL import Image

from kit.run import animation
from kit.run.animation import AnimationSettings, ExportError, count_frames, export_recording, recorded_scenes
from kit.run.headless import run_episode
from kit.run.recording import Recording, load_recording
from kit.run.scenario import Scenario, find_scenario


@pytest.fixture(scope="module")
def drive(tmp_path_factory: pytest.TempPathFactory) -> tuple[Recording, Scenario]:
    """A second and a quarter of driving forward."""
    file = tmp_path_factory.mktemp("drive") / "run.npz"
    run_episode("simple", "forward", seconds=1.25, record=file)
    return load_recording(file), find_scenario("simple")


def test_every_ending_has_all_frames_at_their_times(
    tmp_path: Path, drive: tuple[Recording, Scenario]
) -> None:
    settings, drawn = AnimationSettings(speed=2.0, fps=10.0, size=(160, 120)), []
    count = count_frames(drive[0], settings)
    assert count == 8  # every 0.2 s from 0 to 1.2 s, and the end
    for ending in ("gif", "svg"):
        export_recording(*drive, tmp_path / f"run.{ending}", settings, on_frame=lambda: drawn.append(1))
    assert len(drawn) == 2 * count
    with Image.open(tmp_path / "run.gif") as picture:
        assert picture.width == 160
        assert picture.height <= 120
        assert picture.info["duration"] == 100
    values = [
        each.attrib["values"] for each in ET.parse(tmp_path / "run.svg").iter() if "values" in each.attrib
    ]
    assert {len(each.split(";")) for each in values} == {count}
    export_recording(*drive, tmp_path / "run.cast", AnimationSettings(speed=2.0), title="Mine")
    header, *events = map(json.loads, (tmp_path / "run.cast").read_text().splitlines())
    assert (header["width"], header["height"], header["title"]) == (80, 24, "Mine")
    assert [time_s for time_s, _, _ in events[:-1]] == [0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.625]


def test_the_scenes_are_those_of_the_run(drive: tuple[Recording, Scenario]) -> None:
    recording, scenario = drive
    scenes = list(recorded_scenes(recording, scenario, 50))
    assert [round(shown.time_s, 6) for shown in scenes] == [0, 0.5, 1.0, 1.25]
    track = recording.track(scenario.robot or "")
    for shown, tick in zip(scenes[1:], (50, 100, 125), strict=True):
        assert np.array_equal(shown.scene.robots[0].pose, track[tick - 1])
        assert len(shown.scene.hits)


def test_what_cannot_be_written_is_said_before_the_work(
    tmp_path: Path, drive: tuple[Recording, Scenario]
) -> None:
    with pytest.raises(ExportError, match=r"\.cast, \.gif, \.svg"):
        export_recording(*drive, tmp_path / "run.mp4")
    with pytest.raises(FileNotFoundError):
        export_recording(*drive, tmp_path / "nowhere" / "run.gif")
    long = Recording("simple", None, 0, 0.01, (), (), np.empty((0, 3)), np.zeros(100_000, dtype=np.int64))
    with pytest.raises(ExportError, match="A speed of 4 is enough"):
        export_recording(long, drive[1], tmp_path / "run.gif")
    export = count_frames(long, AnimationSettings(speed=4.0))
    assert export <= 3000


def test_as_many_frames_are_drawn_as_are_allowed(
    tmp_path: Path, drive: tuple[Recording, Scenario], monkeypatch: pytest.MonkeyPatch
) -> None:
    settings = AnimationSettings(speed=2.0, fps=10.0)
    count = count_frames(drive[0], settings)
    monkeypatch.setattr(animation, "MAX_FRAMES", count)
    export_recording(*drive, tmp_path / "run.cast", settings)
    monkeypatch.setattr(animation, "MAX_FRAMES", count - 1)
    with pytest.raises(ExportError, match=f"makes {count} frames; {count - 1} is the most"):
        export_recording(*drive, tmp_path / "run.cast", settings)
