"""Fuzzes what others describe: launch files, ROS packages, lessons, lists of a class, layers, pictures, drives of a board."""

from __future__ import annotations

import io
import json
import random
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

import numpy as np
from PIL import Image, ImageDraw

from grader.cohort.marks import read_marks
from grader.cohort.roster import read_roster
from grader.cohort.submission_times import read_submission_times
from kit.layers.requirements_file import read_requirements
from kit.mapmaking.photo import PhotoError, open_photo
from kit.msg.definition_parser import DefinitionError, parse_definition
from kit.ros.exceptions import InvalidRosArguments
from kit.ros.launch.context import LaunchError
from kit.ros.launch.frontend.markup_reader import read_launch_description
from kit.ros.launch.service import LaunchService
from kit.ros.packages import PackageError, read_package
from kit.ros.parameters.parameter_files import read_parameter_file
from kit.run.recording import load_recording
from kit.school.game.shared_drives import DriveRefused, read_shared_drives, share_drives
from kit.school.lessons.reading import read_lesson
from kit.world.documents import UnusableFile
from kit.world.layer_reader import read_image
from kit.world.problems import WorldError
from tests.fuzz.damage import (
    damage_bytes,
    damage_files,
    damage_json,
    damage_value,
    damage_words,
    nudge_json,
)
from tests.fuzz.files import ROOT, SOLUTIONS, clear, damaged_archive, members_of
from tests.grader.cohort.test_class_list import ROSTERS
from tests.grader.packed import array_bytes, zipped
from tests.layers.test_requirements_file import WHOLE
from tests.tui.lesson_folder import write_lessons

PROGRAMS: Final = ROOT / "tests" / "ros" / "outside_programs"


def _found(*patterns: str, folder: Path = PROGRAMS) -> Sequence[Path]:
    """Returns the files of these names, at least one."""
    found = sorted({file for pattern in patterns for file in folder.rglob(pattern) if file.is_file()})
    assert found, patterns
    return found


class LaunchFileTarget:
    """Damaged launch files in XML and YAML, read and carried out up to the processes that they ask for. None is started."""

    def __init__(self, folder: Path) -> None:
        self._files = [
            (file.name, file.read_bytes())
            for file in _found("*.launch.xml", "*.launch.yaml", "*_launch.yaml")
        ]

    def attempt(self, rng: random.Random) -> str:
        """Reads one launch file."""
        name, content = rng.choice(self._files)
        files = damage_files(rng, {name: content})
        try:
            description = read_launch_description(f"/launch/{name}", files[name])
            if b"command" not in files[name]:  # a substitution that runs one
                LaunchService(f"/launch/{name}", {}, environment={}).start(description)
        except LaunchError:
            return f"{name[-4:]}: refused"
        return f"{name[-4:]}: read"


class PackageTarget:
    """Damaged manifests, message definitions and parameter files of ROS packages."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder / "package"
        self._manifests = [file.read_bytes() for file in _found("package.xml")]
        self._definitions = [
            (file.suffix[1:], file.read_bytes())
            for file in _found("*.msg", "*.srv", "*.action", folder=ROOT / "kit" / "msg" / "definitions")
        ]
        self._parameters = [
            content for file in _found("*.yaml") if b"ros__parameters" in (content := file.read_bytes())
        ]

    def attempt(self, rng: random.Random) -> str:
        """Reads one file."""
        way = rng.choice((self._read_manifest, self._read_definition, self._read_parameters))
        name = way.__name__.removeprefix("_read_")
        try:
            way(rng)
        except (PackageError, DefinitionError, InvalidRosArguments):
            return f"{name}: refused"
        return f"{name}: read"

    def _read_manifest(self, rng: random.Random) -> None:
        files = damage_files(rng, {"package.xml": rng.choice(self._manifests)})
        clear(self._folder).joinpath("package.xml").write_bytes(files["package.xml"])
        read_package(self._folder)

    def _read_definition(self, rng: random.Random) -> None:
        part, content = rng.choice(self._definitions)
        files = damage_files(rng, {"Some": content})
        parse_definition(files["Some"].decode("utf-8", "replace"), part, "Some")

    def _read_parameters(self, rng: random.Random) -> None:
        files = damage_files(rng, {"params.yaml": rng.choice(self._parameters)})
        file = clear(self._folder) / "params.yaml"
        file.write_bytes(files[file.name])
        read_parameter_file(str(file))


class LessonTarget:
    """Damaged lessons of somebody else's, with their exercises."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder / "theirs" / "01-colours"
        lessons = write_lessons(folder / "whole")
        whole = lessons / "01-colours"
        outcomes = clear(self._folder.parent) / "outcomes.yaml"
        outcomes.write_bytes((lessons / outcomes.name).read_bytes())
        self._files = {
            str(file.relative_to(whole)): file.read_bytes() for file in whole.rglob("*") if file.is_file()
        }

    def attempt(self, rng: random.Random) -> str:
        """Reads one lesson."""
        name = rng.choice([name for name in sorted(self._files) if name.endswith(".yaml")])
        changed = (
            {name: damage_value(rng, self._files, name)}
            if rng.random() < 0.5
            else damage_files(rng, {name: self._files[name]})
        )
        files = {**self._files, **changed}
        clear(self._folder)
        for each, content in files.items():
            (self._folder / each).parent.mkdir(exist_ok=True)
            (self._folder / each).write_bytes(content)
        try:
            read_lesson(self._folder, is_foreign=True)
        except WorldError:
            return "refused"
        return "read"


MARKS: Final = b"""
ada: {points: {reached: 2.5}, comments: {reached: nearly}, extra: -1, comment: Well done}
bruno: {final: 4}
"""
TIMES: Final = b"""\
name,submitted,student
ada,2026-03-02T09:30+01:00,ada
"b, c",2026-03-02 09:31:00+00:00,bruno
"""


class ClassListTarget:
    """Damaged rosters, times of handing in, and marks of a class."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        rosters = [file.read_bytes() for file in sorted(ROSTERS.glob("*.csv"))]
        times = [(ROSTERS / "moodle_worksheet.csv").read_bytes(), TIMES]
        self._ways: Sequence[tuple[str, Sequence[bytes], Callable[[Path], object]]] = (
            ("roster.csv", rosters, read_roster),
            ("times.csv", times, read_submission_times),
            ("marks.yaml", [MARKS], read_marks),
        )

    def attempt(self, rng: random.Random) -> str:
        """Reads one list."""
        name, contents, read = rng.choice(self._ways)
        file = self._folder / name
        file.write_bytes(damage_files(rng, {name: rng.choice(contents)})[name])
        try:
            read(file)
        except (ValueError, WorldError):
            return f"{name}: refused"
        return f"{name}: read"


class RequirementsTarget:
    """Damaged files that say who must collide and who must be seen."""

    def __init__(self, folder: Path) -> None:
        self._file = folder / "yard.layers.yaml"

    def attempt(self, rng: random.Random) -> str:
        """Reads one file."""
        self._file.write_bytes(damage_files(rng, {self._file.name: WHOLE.encode()})[self._file.name])
        try:
            read_requirements(self._file)
        except WorldError:
            return "refused"
        return "read"


class PictureTarget:
    """Damaged pictures of every format: as the map of a world, and as a photograph of one."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        drawn = Image.new("RGBA", (320, 300), "white")
        ImageDraw.Draw(drawn).rectangle((20, 20, 280, 260), outline="black", width=30)
        self._pictures = []
        for form, mode, options in FORMS:
            out = io.BytesIO()
            drawn.convert(mode).save(out, form, **options)
            self._pictures.append(out.getvalue())

    def attempt(self, rng: random.Random) -> str:
        """Reads one picture."""
        content = rng.choice(self._pictures)
        for _ in range(rng.choice((1, 1, 3))):
            content = damage_bytes(rng, {"picture": content[:1200]}, "picture") + content[1200:]
        file = self._folder / rng.choice(("map.png", "map.jpg", "map.bmp", "map.pgm"))
        file.write_bytes(content)
        outcomes = []
        for read in (read_image, open_photo):
            try:
                read(file)
            except (UnusableFile, PhotoError):
                outcomes.append("refused")
            else:
                outcomes.append("read")
        return f"map {outcomes[0]}, photograph {outcomes[1]}"


FORMS: Final[Sequence[tuple[str, str, dict[str, object]]]] = (
    ("PNG", "RGBA", {}),
    ("PNG", "P", {}),
    ("PNG", "L", {"optimize": True}),
    ("JPEG", "RGB", {}),
    ("JPEG", "L", {"progressive": True}),
    ("BMP", "RGB", {}),
    ("PPM", "L", {}),
    ("GIF", "P", {}),
    ("TIFF", "L", {}),
    ("TIFF", "RGB", {"compression": "tiff_lzw"}),
    ("WEBP", "RGB", {"lossless": True}),
)


class SharedDriveTarget:
    """Damaged drives that another user of the machine has put on a board."""

    def __init__(self, folder: Path) -> None:
        file = folder / "drives.npz"
        share_drives([load_recording(SOLUTIONS / "01-drive" / "flag" / "solution.npz")], file, ["stopped"])
        self._members = members_of(file.read_bytes())
        with np.load(file) as arrays:
            self._content = json.loads(bytes(arrays["drives"]))

    def attempt(self, rng: random.Random) -> str:
        """Reads one file."""
        if rng.random() < 0.3:
            data = damaged_archive(rng, self._members)
        else:
            content = json.dumps(rng.choice((damage_json, nudge_json))(rng, self._content)).encode()
            if rng.random() < 0.2:
                content = damage_words(rng, {"drives": content}, "drives")
            data = zipped({"drives.npy": array_bytes(np.frombuffer(content, dtype=np.uint8))})
        try:
            read_shared_drives(data)
        except DriveRefused:
            return "refused"
        return "read"
