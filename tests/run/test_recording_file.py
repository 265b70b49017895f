"""Recordings are on the disk while their run goes on, and what a killed run has left is restored."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

from kit.msg.geometry_msgs import Twist, Vector3
from kit.part_file import BeingWrittenError, part_path
from kit.run import recording as recording_module
from kit.run import recording_file
from kit.run.episode import run_until
from kit.run.recording import Recorder, Recording, load_recording, rerun
from kit.run.recording_file import RecordingFile, restore_recordings
from kit.run.scenario import find_scenario
from kit.run.session import Session


def drive(file: RecordingFile, ticks: int) -> Recording:
    """Records a drive without completing its file."""
    with Session(find_scenario("maze"), seed=3) as session:
        recorder = Recorder.for_scenario(session.scenario, session.runner.simulation, file)
        session.runner.observers.append(recorder)
        for _ in range(4):
            session.runner.accept("/cmd_vel", Twist(linear=Vector3(x=0.2)))
            run_until(session.runner, ticks=ticks // 4)
        return recorder.recording()


@pytest.fixture(autouse=True)
def _every_tick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(recording_file, "INTERVAL_S", -1.0)


@pytest.mark.parametrize("lost", [0, 1, 2000])
def test_a_killed_run_is_restored_to_the_last_whole_line(tmp_path: Path, lost: int) -> None:
    with RecordingFile(tmp_path / "run.npz") as file:
        whole = drive(file, 40)
    left = tmp_path / "left"
    left.mkdir()
    part = part_path(left / "run.npz")
    shutil.copy(part_path(tmp_path / "run.npz"), part)
    data = part.read_bytes()
    part.write_bytes(data[: len(data) - lost])
    (notice,) = restore_recordings(left)
    restored = load_recording(left / "run.npz")
    assert str(left / "run.npz") in notice
    assert restored.ticks == 40 if lost < 2 else 0 < restored.ticks < 40
    assert np.array_equal(restored.poses, whole.poses[: len(restored.poses)])
    assert np.array_equal(rerun(restored, find_scenario("maze").world).poses, restored.poses)
    assert [path.name for path in left.iterdir()] == ["run.npz"]
    assert list(restore_recordings(left)) == []


def test_what_is_being_written_is_left_alone_and_a_second_writer_refused(tmp_path: Path) -> None:
    file = RecordingFile(tmp_path / "run.npz")
    recording = drive(file, 8)
    assert list(restore_recordings(tmp_path)) == []
    with pytest.raises(BeingWrittenError, match="another program is writing"):
        RecordingFile(tmp_path / "run.npz")
    file.complete(recording)
    assert [path.name for path in tmp_path.iterdir()] == ["run.npz"]
    RecordingFile(tmp_path / "run.npz").close()
    assert load_recording(tmp_path / "run.npz").ticks == 8


def test_the_next_run_of_the_same_name_overwrites_nothing(tmp_path: Path) -> None:
    killed = RecordingFile(tmp_path / "run.npz")
    drive(killed, 8)
    killed.close()
    with RecordingFile(tmp_path / "run.npz") as file:
        assert "run-2.npz" in file.notices[0]
        file.complete(drive(file, 4))
    assert load_recording(tmp_path / "run.npz").ticks == 4
    assert load_recording(tmp_path / "run-2.npz").ticks == 8


def test_on_a_full_disk_what_was_written_is_kept_and_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = RecordingFile(tmp_path / "run.npz")
    recording = drive(file, 8)

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(recording_file, "save_recording", full)
        with pytest.raises(OSError, match=r"No space left.*0\.1 s of it are kept"), file:
            file.complete(recording)
    assert list(restore_recordings(tmp_path)) != []
    assert load_recording(tmp_path / "run.npz").ticks == 8


@pytest.mark.parametrize("content", [b"", b"not ours\n", b"[1, 2]\n"])
def test_a_part_that_is_none_is_no_recording(tmp_path: Path, content: bytes) -> None:
    part_path(tmp_path / "x").write_bytes(content)
    assert list(restore_recordings(tmp_path)) == []
    assert part_path(tmp_path / "x").exists() == bool(content)


@pytest.mark.parametrize(
    ("limit", "size"), [("MAX_RECORDED_BYTES", 12 * 32), ("MAX_HEADER_BYTES", (1 << 20) + 400)]
)
def test_a_run_that_is_too_long_for_a_recording_keeps_its_beginning(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, limit: str, size: int
) -> None:
    with RecordingFile(tmp_path / "whole.npz") as file:
        whole = drive(file, 40)
        assert file.remark == ""
    monkeypatch.setattr(recording_module, limit, size)
    with RecordingFile(tmp_path / "run.npz") as file:
        recording = drive(file, 40)
        assert f"first {recording.ticks} ticks" in file.remark
        file.complete(recording)
    loaded = load_recording(tmp_path / "run.npz")
    assert 0 < loaded.ticks == recording.ticks < 40
    assert np.array_equal(loaded.poses, whole.poses[: len(loaded.poses)])
    assert np.array_equal(rerun(loaded, find_scenario("maze").world).poses, loaded.poses)
