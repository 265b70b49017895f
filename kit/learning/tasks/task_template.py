"""Writes new task files: after a task of the kit's, on a map of the kit's, or for a world of one's own.

Packs a task with its world and its reward into one zip file to send, and unpacks such a file safely.

The archive holds one folder with the task's name: ``NAME/task.yaml``, and beside it what the task reads, at the same
places as on the sender's disk. Maps of the kit are not packed: every kit has them.
"""

from __future__ import annotations

import io
import lzma
import math
import re
import shutil
import zipfile
import zlib
from pathlib import Path, PurePosixPath
from typing import Final

from kit.learning.environment.batch_map import (
    BatchMap,
    hull_radius,
    hull_width,
    load_batch_map,
    measure_floor,
)
from kit.learning.environment.tasks import task_names, tasks_folder
from kit.learning.tasks.task_check import check_task
from kit.learning.tasks.task_reader import TASK_FILE, read_task, task_name
from kit.plain_text import is_printable, quoted
from kit.run.scenario import own_map_folder
from kit.sim.plugins.diff_drive import DiffDriveParams
from kit.sim.simulation import load_world
from kit.workspace import errors_name_file, write_atomically
from kit.world.catalogue import (
    WORLD_FILE,
    MapCard,
    allowed_root_of,
    find_map,
    map_names,
    maps_folder,
    own_card,
)
from kit.world.documents import collected_reads

NAME_PATTERN = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,59}")
STANDARD = """\
actions:
  twists:                     # m/s forward, rad/s to the left; or linear: [0, 0.4] and angular: [-1.5, 1.5]
    forward: [{fast:g}, 0]
    left: [0, {turn:g}]
    right: [0, -{turn:g}]
    forward_left: [{slow:g}, {turn:g}]
    forward_right: [{slow:g}, -{turn:g}]
observation:
  sectors: 13                 # the shortest range of each
  target: true                # distance and direction of the target
  scale: 0.5                  # multiplies ranges and distances
reward:
  terms:                      # `kit task keys` names them all
    progress: 1.0
    elapsed: -0.01
    collided: -2.0
    reached: 2.0
goal: {{kind: target}}          # or patrol, cover, wall, follow, avoid
target: {{radius: 0.2}}
step: {{time: 0.2, collision_checks: 2, limit: 400}}
start: {{noise: 0.05, max_rotation: 0.3}}
endings: {{collision: terminated, time: truncated}}
preset: hallway               # the kit's settings for learning
success: 0.95                 # training ends when so many episodes of every case surely succeed
"""


class NewTaskError(Exception):
    """A task cannot be made; the message says why and what to do."""


def new_task_file(name: str, source: str, folder: Path) -> Path:
    """Writes a task's file and returns it: ``folder/NAME/task.yaml``, or ``NAME.yaml`` beside a world: in the folder
    ``source``, or in the workspace's map of that name.

    NewTaskError if the name is taken or nothing is known by ``source``; UnsupportedWorld; WorldError.
    """
    if not NAME_PATTERN.fullmatch(name):
        raise NewTaskError(f"{quoted(name)}: a task's name may contain letters, digits, '_' and '-'.")
    path = Path(source)
    if not path.exists():
        path = own_map_folder(source) or path
    if source in task_names():
        file, text = folder / name / TASK_FILE, (tasks_folder() / f"{source}.yaml").read_text()
    elif source in map_names():
        file, text = folder / name / TASK_FILE, _map_text(find_map(source))
    elif (path / WORLD_FILE).is_file():
        file, text = path / f"{name}.yaml", _world_text(path / WORLD_FILE)
    else:
        raise NewTaskError(
            f"{quoted(source)} is not one of the kit's tasks or maps, nor a map of yours, nor a folder with a {WORLD_FILE}. "
            "`kit task list` and `kit maps` list them."
        )
    if file.exists():
        raise NewTaskError(f"{file} already exists: choose another name.")
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)
    return file


def _map_text(card: MapCard) -> str:
    cases = "".join(
        f"#   - {{name: {case.name}, start: [{case.start.x:g}, {case.start.y:g}, {case.start.theta:g}], "
        f"target: [{case.target[0]:g}, {case.target[1]:g}]}}\n"
        for case in card.cases
        if case.partner_start is None
    )
    own = "# Without its own cases, a task has those of its maps:\n# cases:\n" + cases if cases else ""
    return f"summary: Drive to the target on {card.name}\nmaps: [{card.name}]\n{own}{_standard(load_batch_map(card))}"


def _standard(batch_map: BatchMap) -> str:
    """What every new task begins with, with actions that the robot's motors can do."""
    robot = batch_map.robot
    return STANDARD.format(
        fast=min(0.4, robot.max_speed), slow=min(0.3, robot.max_speed), turn=min(1.2, robot.max_turn_rate)
    )


def _world_text(world_file: Path) -> str:
    """A task with the starts and targets of the map's card; without one, from the robot's place in the world to the
    farthest place that it can reach."""
    known = own_card(world_file)
    if known is not None and known.partner is None:
        cases = "".join(
            f"  - name: {case.name}\n    start: [{case.start.x:g}, {case.start.y:g}, {case.start.theta:g}]\n"
            f"    target: [{case.target[0]:g}, {case.target[1]:g}]\n"
            for case in known.cases
        )
        return _own_world_text(world_file, load_batch_map(known), cases)
    world = load_world(world_file, root=allowed_root_of(world_file))
    robots = [
        model.name
        for model in world.models
        if any(isinstance(plugin.params, DiffDriveParams) for plugin in model.plugins)
    ]
    if not robots:
        raise NewTaskError(f"{world_file}: no model in it has a DiffDrive, so there is nothing to train.")
    folder = world_file.parent
    card = MapCard(
        folder.name,
        folder.name,
        "",
        "",
        folder,
        world_file,
        robots[0],
        None,
        (),
        allowed_root_of(world_file) or folder,
    )
    batch_map = load_batch_map(card, (robots[0],))
    start = batch_map.starts[0]
    x, y = _farthest_place(batch_map)
    case = f"  - name: there\n    start: [{start.x:g}, {start.y:g}, {start.theta:g}]\n    target: [{x:.2f}, {y:.2f}]\n"
    return _own_world_text(world_file, batch_map, case)


def _own_world_text(world_file: Path, batch_map: BatchMap, cases: str) -> str:
    robots = ", ".join(batch_map.robot_names)
    return (
        f"summary: Drive to the target\nworld: {world_file.name}\nrobots: {robots}\ncases:\n{cases}"
        f"{_standard(batch_map)}"
    )


def _farthest_place(batch_map: BatchMap) -> tuple[float, float]:
    floor, start = measure_floor(batch_map), batch_map.starts[0]
    reached = floor.reached_from(start.x, start.y, hull_width(batch_map))
    cells = floor.area_cells(None, reached & (floor.clearance > hull_radius(batch_map)))
    if not len(cells):
        raise NewTaskError(
            f"{batch_map.name}: the robot touches a wall at its start: move it in the world first."
        )
    x, y = max(cells.tolist(), key=lambda cell: math.hypot(cell[0] - start.x, cell[1] - start.y))
    return x, y


MAX_FILES: Final = 200
MAX_BYTES: Final = 64 * 1024 * 1024
"""Largest total size of all files, unpacked."""
EARLIEST: Final = (1980, 1, 1, 0, 0, 0)
"""The date of every file in the archive: the same task makes the same bytes."""


PACKAGE_FILE: Final = "package.xml"


class TaskArchiveError(Exception):
    """A task cannot be packed, or a file is no packed task; the message says why and what to do."""


def pack_task(file: Path, archive: Path) -> tuple[Path, ...]:
    """Checks a task and writes it with all that it reads into a zip file; returns the packed files.

    Raises WorldError, UnsupportedWorld and RewardFileError if the task is not sound, TaskArchiveError if it reads files
    outside its folder or too many, and OSError.
    """
    task_file = file.resolve()
    folder, kit_maps = task_file.parent, maps_folder().resolve()
    with collected_reads() as found:
        read = read_task(task_file)
        check_task(read)
        for card in read.task.map_cards:
            if not card.world_file.resolve().is_relative_to(kit_maps):
                load_world(card.world_file, root=card.root)
    files = {each.resolve() for each in found if not each.resolve().is_relative_to(kit_maps)} | {task_file}
    if read.task.reward_file is not None:
        files.add(read.task.reward_file.resolve())
    top = _folder_of_all(folder, files)
    if top is None:
        outside = sorted(str(each) for each in files if not each.is_relative_to(folder))
        raise TaskArchiveError(
            f"{file}: it reads {', '.join(outside)}, outside its own folder. Put the task beside its world, or copy "
            "those files into its folder."
        )
    if top != folder and (top / PACKAGE_FILE).is_file():
        files.add(top / PACKAGE_FILE)  # what makes the folder a package, whose worlds may read its models
    if len(files) > MAX_FILES or sum(each.stat().st_size for each in files) > MAX_BYTES:
        raise TaskArchiveError(
            f"{file}: {len(files)} files; at most {MAX_FILES} files with a total of {MAX_BYTES // 2**20} MiB are packed."
        )
    if task_file.name != TASK_FILE and folder / TASK_FILE in files:
        raise TaskArchiveError(f"{file}: it reads another {TASK_FILE}; rename that file.")
    ordered = (task_file, *sorted(files - {task_file}))
    write_atomically(archive, _archive_bytes(task_name(task_file), top, ordered))
    return ordered


def _folder_of_all(folder: Path, files: set[Path]) -> Path | None:
    """The folder of the task, or of the package that it lies in, whichever holds all the files first; None if none does."""
    package = allowed_root_of(folder / TASK_FILE)
    tops = [folder] if package is None else [folder, package.resolve()]
    return next((top for top in tops if all(each.is_relative_to(top) for each in files)), None)


def _archive_bytes(name: str, folder: Path, files: tuple[Path, ...]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as opened:
        for number, each in enumerate(files):
            placed = each.with_name(TASK_FILE) if number == 0 else each
            info = zipfile.ZipInfo(f"{name}/{placed.relative_to(folder).as_posix()}", EARLIEST)
            info.compress_type = zipfile.ZIP_DEFLATED
            opened.writestr(info, each.read_bytes())
    return buffer.getvalue()


def unpack_task(archive: Path, folder: Path) -> Path:
    """Writes a packed task into a new folder of its name in ``folder``, all of it or nothing, and returns the task's file.

    Nothing is written outside that folder, whatever the archive says, and nothing is left of a task that cannot be
    used. Raises TaskArchiveError, OSError if the archive cannot be read or the folder not written, and as ``check_task``.
    """
    contents = _read_archive(archive)
    tops = {path.parts[0] for path in contents}
    found = [path for path in contents if path.name == TASK_FILE]
    task_files = [path for path in found if len(path.parts) == min(len(each.parts) for each in found)]
    if len(tops) != 1 or len(task_files) != 1:
        raise TaskArchiveError(
            f"{archive}: not a packed task; it must contain one folder with a {TASK_FILE}. `kit task pack` creates such a file."
        )
    made = folder / task_files[0].parts[0]
    if made.exists():
        raise TaskArchiveError(
            f"{made} already exists: move it away, or unpack elsewhere with --dest FOLDER."
        )
    file = folder / Path(*task_files[0].parts)
    try:
        for path, data in contents.items():
            target = folder / Path(*path.parts)
            with errors_name_file(target):
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(data)
        check_task(read_task(file))
    except BaseException:  # Ctrl-C too leaves nothing half made
        shutil.rmtree(made, ignore_errors=True)
        raise
    return file


def _read_archive(archive: Path) -> dict[PurePosixPath, bytes]:
    """Names and contents. Raises TaskArchiveError for what is damaged, too large, or leads out of its folder."""
    contents: dict[PurePosixPath, bytes] = {}
    left = MAX_BYTES
    try:
        with zipfile.ZipFile(archive) as opened:
            entries = [entry for entry in opened.infolist() if not entry.is_dir()]
            if len(entries) > MAX_FILES:
                raise TaskArchiveError(f"{archive}: {len(entries)} files; at most {MAX_FILES} are unpacked.")
            for entry in entries:
                path = _checked_path(archive, entry.filename)
                with opened.open(entry) as member:
                    data = member.read(left + 1)
                left -= len(data)
                if left < 0:
                    raise TaskArchiveError(f"{archive}: it unpacks to more than {MAX_BYTES // 2**20} MiB.")
                contents[path] = data
    # RuntimeError: zipfile's, of an encrypted member or an unknown method of packing; MemoryError: a huge dictionary
    except (
        zipfile.BadZipFile, zlib.error, lzma.LZMAError, EOFError, RuntimeError, ValueError, MemoryError,
    ) as error:  # fmt: skip
        raise TaskArchiveError(f"{archive}: damaged, or not a zip file ({error}).") from None
    return contents


def _checked_path(archive: Path, name: str) -> PurePosixPath:
    path = PurePosixPath(name)
    is_safe = is_printable(name) and "\\" not in name and not path.is_absolute() and ".." not in path.parts
    if not is_safe or len(path.parts) < 2 or any(part.startswith(".") for part in path.parts):
        raise TaskArchiveError(
            f"{archive}: it contains a file named {quoted(name)}, which does not belong in a packed task."
        )
    return path
