"""A packed task: all that it reads in one file, sound again elsewhere; archives that lie write nothing outside."""

from __future__ import annotations

import io
import lzma
import shutil
import zipfile
from pathlib import Path

import numpy as np
import pytest

from kit.learning.authoring.task_archive import TaskArchiveError, pack_task, unpack_task
from kit.learning.authoring.task_check import check_task
from kit.learning.environment.batch import BatchEnv
from kit.learning.tasks.catalogue import tasks_folder
from kit.learning.tasks.task_reader import read_task
from kit.mapmaking.map_drawing import read_drawing
from kit.mapmaking.new_map import write_map

DRAWING = "#########\n#S      #\n#   ##  #\n#      T#\n#########"
TASK = """\
summary: Through my room
world: room/world.yaml
robots: serp
cases:
  - {name: there, start: [0.75, 1.75, 0], target: [3.75, 0.75]}
actions: {twists: {forward: [0.4, 0], left: [0, 1.2], right: [0, -1.2]}}
observation: {sectors: 13}
reward: {file: rewards/mine.py}
goal: {kind: target}
"""


@pytest.fixture
def task(tmp_path: Path) -> Path:
    folder = tmp_path / "home"
    write_map(folder / "room", read_drawing(DRAWING), title="Room", source="drawn")
    (folder / "rewards").mkdir()
    (folder / "rewards" / "mine.py").write_text("def reward(reached):\n    return 1.0 * reached\n")
    (folder / "diary.txt").write_text("private")
    (folder / "my_task.yaml").write_text(TASK)
    return folder / "my_task.yaml"


@pytest.mark.long
def test_a_packed_task_is_the_same_task_elsewhere(task: Path, tmp_path: Path) -> None:
    archive = tmp_path / "mine.zip"
    packed = {file.relative_to(task.parent).as_posix() for file in pack_task(task, archive)}
    assert packed == {
        *("my_task.yaml", "rewards/mine.py", "room/world.yaml", "room/map.yaml", "room/map.png"),
        "room/serp.model.yaml",
    }
    before = BatchEnv(read_task(task).task, 3, 1).reset()
    shutil.rmtree(task.parent)
    unpacked = unpack_task(archive, tmp_path / "elsewhere")
    assert unpacked == tmp_path / "elsewhere" / "my_task" / "task.yaml"
    read = read_task(unpacked)
    check_task(read)
    assert read.task.name == "my_task"
    assert np.array_equal(BatchEnv(read.task, 3, 1).reset(), before)
    with pytest.raises(TaskArchiveError, match="already exists"):
        unpack_task(archive, tmp_path / "elsewhere")


def test_the_same_task_makes_the_same_bytes_and_maps_of_the_kit_are_left_out(tmp_path: Path) -> None:
    for name in ("one.zip", "two.zip"):
        assert len(pack_task(tasks_folder() / "turn.yaml", tmp_path / name)) == 1
    assert (tmp_path / "one.zip").read_bytes() == (tmp_path / "two.zip").read_bytes()


def test_a_task_in_a_package_is_packed_with_the_models_beside_its_world(task: Path, tmp_path: Path) -> None:
    package = tmp_path / "package"
    shutil.copytree(task.parent, package / "hall")
    (package / "models").mkdir()
    model, world = package / "models" / "serp.model.yaml", package / "hall" / "room" / "world.yaml"
    (world.parent / model.name).rename(model)
    world.write_text(world.read_text().replace(model.name, f"../../models/{model.name}"))
    (package / "package.xml").write_text("<package/>")
    archive = tmp_path / "task.zip"
    packed = pack_task(package / "hall" / task.name, archive)
    assert model.resolve() in packed
    assert "diary.txt" not in {file.name for file in packed}
    shutil.rmtree(package)
    unpacked = unpack_task(archive, tmp_path / "elsewhere")
    check_task(read_task(unpacked))
    assert unpacked == tmp_path / "elsewhere" / "my_task" / "hall" / "task.yaml"


def test_a_task_that_reads_files_elsewhere_is_not_packed(task: Path, tmp_path: Path) -> None:
    inner = task.parent / "inner"
    inner.mkdir()
    (tmp_path / "model.yaml").write_text((task.parent / "room" / "serp.model.yaml").read_text())
    (task.parent / "room" / "serp.model.yaml").unlink()
    (task.parent / "room" / "serp.model.yaml").symlink_to(tmp_path / "model.yaml")
    with pytest.raises(Exception, match="outside"):  # the world's reader says so first
        pack_task(task, tmp_path / "mine.zip")
    assert not (tmp_path / "mine.zip").exists()


@pytest.mark.parametrize(
    "names",
    [
        ("../evil", "mine/task.yaml"),
        ("/tmp/evil", "mine/task.yaml"),
        ("mine/../../evil", "mine/task.yaml"),
        ("mine\\..\\evil", "mine/task.yaml"),
        ("mine/.bashrc", "mine/task.yaml"),
        ("task.yaml",),
        ("mine/other.yaml",),
        ("mine/task.yaml", "yours/task.yaml"),
        (),
    ],
)
def test_an_archive_that_is_none_of_ours_writes_nothing(tmp_path: Path, names: tuple[str, ...]) -> None:
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        for name in names:
            archive.writestr(name, "summary: x")
    (tmp_path / "bad.zip").write_bytes(data.getvalue())
    with pytest.raises(TaskArchiveError, match=r"bad\.zip"):
        unpack_task(tmp_path / "bad.zip", tmp_path / "out")
    assert not (tmp_path / "out").exists()
    assert sorted(each.name for each in tmp_path.iterdir()) == ["bad.zip"]


def test_a_bomb_and_a_damaged_file_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("kit.learning.authoring.task_archive.MAX_BYTES", 2**20)
    with zipfile.ZipFile(tmp_path / "bomb.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("mine/task.yaml", bytes(2 * 2**20))
    with pytest.raises(TaskArchiveError, match="more than 1 MiB"):
        unpack_task(tmp_path / "bomb.zip", tmp_path)
    (tmp_path / "half.zip").write_bytes(b"PK\x03\x04 and no more")
    with pytest.raises(TaskArchiveError, match="damaged"):
        unpack_task(tmp_path / "half.zip", tmp_path)


def test_a_damaged_lzma_archive_is_refused(tmp_path: Path) -> None:
    """Its errors are of a class of their own."""
    file = tmp_path / "lzma.zip"
    with zipfile.ZipFile(file, "w", zipfile.ZIP_LZMA) as archive:
        archive.writestr("mine/task.yaml", b"summary: x\n" * 50)
    content = bytearray(file.read_bytes())
    start = content.index(b"task.yaml") + len(b"task.yaml")
    content[start + 4 : start + 9] = b"\xff" * 5  # properties that there are not
    file.write_bytes(content)
    with zipfile.ZipFile(file) as archive, pytest.raises(lzma.LZMAError):
        archive.read("mine/task.yaml")
    with pytest.raises(TaskArchiveError, match="damaged"):
        unpack_task(file, tmp_path / "out")
