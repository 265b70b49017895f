"""The student's version of an assignment: which of its files go out, and which secret would go out with them.

The sheet goes out without what students may not see yet: criteria whose ``visibility`` is not ``visible``, and files of
teacher tests that hold such tests. ``secret.yaml``, the solution, the wrong solutions and the reference stay. What goes out is
then searched for what stays: whole files under another name, secret seeds, sentences of the secret file, passages of the
solution; archives are searched inside.
"""

from __future__ import annotations

import io
import re
import stat
import zipfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import yaml

from grader.assignment import TEACHERS_STEMS, Assignment
from grader.evidence_digest import ASSIGNMENT_FILE, YAML_LOADER
from grader.reading import SECRET_FILE
from grader.submitted_files import is_ignored_name
from grader.teacher_tests.reading import read_teacher_tests
from kit.plain_text import join_names
from kit.results.grading_result import Visibility

REFERENCE: Final = "reference"
MAX_FILE: Final = 32 << 20
"""Bytes of one file that goes out."""
SHORTEST_SEED: Final = 10_000
"""A smaller number also stands where it is no seed: as a size, a year, a place."""
SHORTEST_SENTENCE: Final = 16
"""Characters of a text of the secret file that is looked for; a shorter one may be a word of the task itself."""
PASSAGE: Final = 4
"""As many lines of the solution in a row, not in the starter, count as a part of it."""
SHORTEST_FILE: Final = 32
"""Bytes from which on two equal files are no chance."""


class ReleaseRefused(Exception):
    """There is no student's version: the message says where a secret would go out, or what the sheet lacks then."""


@dataclass(frozen=True, slots=True)
class StudentVersion:
    """What students get."""

    files: Mapping[str, bytes]
    """By relative path."""
    kept_back: tuple[str, ...]
    """The files and folders that stay, as the teacher calls them."""
    hidden_criteria: tuple[str, ...]
    """The ids of what was left out of the sheet, because students may not see its outcome yet."""


def student_version(assignment: Assignment, *, with_reference: bool = False) -> StudentVersion:
    """Returns what students get of the assignment. ``with_reference``: also what checks compare with.

    Raises ReleaseRefused where a secret would go out, OSError.
    """
    folder = assignment.folder
    hidden = {each.id for each in assignment.tests if each.visibility is not Visibility.VISIBLE}
    hidden_tests = {
        file.name
        for file in assignment.teacher_test_files
        if any(each.id in hidden for each in read_teacher_tests(file))
    }
    out: dict[str, bytes] = {}
    kept: dict[str, bytes] = {}
    for name, file in _files(folder):
        stem = name.split("/")[0].partition(".")[0].casefold()
        is_reference = stem == REFERENCE
        stays = (stem in TEACHERS_STEMS and not (is_reference and with_reference)) or name in hidden_tests
        (kept if stays else out)[name] = _content(file, name, folder)
    if hidden:
        positions = [i for i, each in enumerate(assignment.criteria) if each.id in hidden]
        tests = [each.name for each in assignment.teacher_test_files if each.name not in hidden_tests]
        text = out[ASSIGNMENT_FILE].decode("utf-8-sig")
        out[ASSIGNMENT_FILE] = _without_criteria(text, positions, tests if hidden_tests else None).encode()
        # A translation is a list of the same length: it would name them too.
        for name in [each for each in out if re.fullmatch(r"assignment\.[a-z]{2}\.yaml", each)]:
            del out[name]
    found = list(_find_leaks(out, kept, assignment, with_reference=with_reference))
    if found:
        raise ReleaseRefused("\n".join(found))
    names = sorted({name.split("/")[0] + "/" * ("/" in name) for name in kept})
    hidden_ids = [each.id for each in assignment.criteria if each.id in hidden]
    return StudentVersion(out, tuple(names), (*hidden_ids, *sorted(hidden_tests)))


def _files(folder: Path) -> Iterator[tuple[str, Path]]:
    """Yields the files of an assignment with their relative names, without what no assignment needs."""
    for file in sorted(folder.rglob("*")):
        parts = file.relative_to(folder).parts
        if any(is_ignored_name(part) for part in parts):
            continue
        if file.suffix == ".pyc" or (file.is_dir() and not file.is_symlink()):
            continue
        yield "/".join(parts), file


def _content(file: Path, name: str, folder: Path) -> bytes:
    if not file.resolve().is_relative_to(folder.resolve()):
        raise ReleaseRefused(f"{name}: a link that leads out of the assignment. Put a copy in its place.")
    if (
        file.is_symlink()
        and file.resolve().relative_to(folder.resolve()).parts[0].partition(".")[0] in TEACHERS_STEMS
    ):
        raise ReleaseRefused(f"{name}: a link to {file.resolve().name}, which stays with you. Remove it.")
    if not stat.S_ISREG(file.stat().st_mode):
        raise ReleaseRefused(f"{name}: neither a file nor a folder. Remove it.")
    if file.stat().st_size > MAX_FILE:
        raise ReleaseRefused(f"{name}: larger than {MAX_FILE >> 20} MiB.")
    return file.read_bytes()


def _without_criteria(text: str, positions: Sequence[int], tests: Sequence[str] | None) -> str:
    """Returns the sheet without the criteria at these positions, and with only these files of tests where given. All else
    stays as it is written, comments too."""
    root = yaml.compose(text, Loader=YAML_LOADER)
    assert isinstance(root, yaml.MappingNode)  # it was read before
    lines = text.split("\n")
    gone: set[int] = set()

    def end_before(line: int) -> int:
        """The line after the last one that belongs to what ends before this one; what stands apart does not."""
        while line and (not lines[line - 1].strip() or lines[line - 1].startswith("#")):
            line -= 1
        return line

    for key, value in root.value:
        if key.value == "checks" and positions:
            if value.flow_style:
                raise ReleaseRefused(
                    f"{ASSIGNMENT_FILE}:{key.start_mark.line + 1}: write each check on a line of its own that begins with a "
                    "dash, so that those that students may not see can be left out."
                )
            starts = [each.start_mark.line for each in value.value]
            ends = [*starts[1:], end_before(_next_line(root, key, len(lines)))]
            for position in positions:
                gone.update(range(starts[position], ends[position]))
        elif key.value == "tests" and tests is not None:
            end = end_before(_next_line(root, key, len(lines)))
            gone.update(range(key.start_mark.line, end))
            if tests:
                lines[key.start_mark.line] = f"tests: [{', '.join(tests)}]"
                gone.discard(key.start_mark.line)
    return "\n".join(line for number, line in enumerate(lines) if number not in gone)


def _next_line(root: yaml.MappingNode, key: yaml.Node, count: int) -> int:
    """The line of the next key of the sheet."""
    later = [each.start_mark.line for each, _ in root.value if each.start_mark.line > key.start_mark.line]
    return min(later, default=count)


def _find_leaks(
    out: Mapping[str, bytes], kept: Mapping[str, bytes], assignment: Assignment, *, with_reference: bool
) -> Iterator[str]:
    """Yields a sentence for each place where something that stays would go out."""
    same = {data: name for name, data in kept.items() if len(data) >= SHORTEST_FILE}
    starters = {data for name, data in out.items() if name.partition(".")[0].split("/")[0] == "starter"}
    numbers = _secret_numbers(kept.get(SECRET_FILE, b""), assignment)
    sentences = _secret_sentences(kept.get(SECRET_FILE, b""))
    passages = _solution_passages(kept, out)
    for name, data in _unpack_archives(out):
        if data in same and data not in starters and not _is_shared(same[data], name):
            yield f"{name}: the same as {same[data]}, which stays with you. Remove it."
            continue
        yield from (
            f"{name}: holds the secret seed {_abbreviate_secret(number)} as {len(coded)} bytes. Remove it."
            for number, coded in ((n, n.to_bytes(8, "little")) for n in numbers if n >= 1 << 32)
            if coded in data
        )
        try:
            text = data.decode("utf-8")
        except UnicodeDecodeError:
            continue
        yield from _leaks_of_text(name, text, numbers, sentences)
        if not (with_reference and name.startswith(REFERENCE)):
            yield from _passages_in(name, text, passages)


def _is_shared(kept_name: str, name: str) -> bool:
    """Whether two files lie at the same place of a work that is a folder: what a solution leaves as it was."""
    return "/" in kept_name and kept_name.rpartition("/")[2] == name.rpartition("/")[2]


def _unpack_archives(files: Mapping[str, bytes]) -> Iterator[tuple[str, bytes]]:
    """Yields every file, and those in archives under ``ARCHIVE:NAME``."""
    for name, data in files.items():
        yield name, data
        if not zipfile.is_zipfile(io.BytesIO(data)):
            continue
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            for each in archive.infolist():
                if each.is_dir():
                    continue
                stem = each.filename.split("/")[-1].partition(".")[0].casefold()
                if stem in TEACHERS_STEMS:
                    raise ReleaseRefused(
                        f"{name}: the archive holds {each.filename}. Make it anew without that."
                    )
                if each.file_size > MAX_FILE or each.flag_bits & 1:
                    raise ReleaseRefused(
                        f"{name}: {each.filename} in it cannot be searched for secrets. Leave it out."
                    )
                yield f"{name}:{each.filename}", archive.read(each)


def _abbreviate_secret(number: int) -> str:
    """A secret number for a message, which may be copied into a mail: its first digits."""
    return f"{str(number)[:3]}..."


def _secret_numbers(secret: bytes, assignment: Assignment) -> tuple[int, ...]:
    written = {int(each) for each in re.findall(rb"(?<![\w.])\d{5,}(?![\w.])", secret)}
    return tuple(sorted({n for n in (*assignment.secret_seeds, *written) if n >= SHORTEST_SEED}))


def _secret_sentences(secret: bytes) -> tuple[str, ...]:
    """Returns the texts of several words in the secret file."""
    if not secret:
        return ()
    found = []
    for event in yaml.parse(secret.decode("utf-8-sig"), Loader=YAML_LOADER):
        if isinstance(event, yaml.ScalarEvent):
            text = " ".join(event.value.split())
            if (
                len(text) >= SHORTEST_SENTENCE and " " in text
            ):  # one word may be a choice that the sheet offers
                found.append(text)
    return tuple(found)


def _leaks_of_text(name: str, text: str, numbers: Iterable[int], sentences: Iterable[str]) -> Iterator[str]:
    lines = text.split("\n")
    for number in numbers:
        whole = re.compile(
            rf"(?<![0-9]){number}(?![0-9])|(?<![0-9a-fA-F]){number:x}(?![0-9a-fA-F])", re.IGNORECASE
        )
        for at, line in enumerate(lines, 1):
            if whole.search(line.replace("_", "")):
                yield f"{name}:{at}: holds the secret seed {_abbreviate_secret(number)}. Write another number, there or in {SECRET_FILE}."
    flat = " ".join(text.split())
    for sentence in sentences:
        if sentence in flat:
            yield f"{name}: holds a text of {SECRET_FILE}, which begins with {sentence[:12]!r}. Remove it."


def _solution_passages(kept: Mapping[str, bytes], out: Mapping[str, bytes]) -> Mapping[tuple[str, ...], str]:
    """Every few lines in a row of a solution that the starter does not have, with the file's name."""
    common: set[tuple[str, ...]] = set()
    for name, data in out.items():
        if name.split("/")[0].partition(".")[0] == "starter":
            common.update(key for key, _ in _line_runs(data))
    found: dict[tuple[str, ...], str] = {}
    for name, data in kept.items():
        if name.split("/")[0].partition(".")[0] in ("solution", REFERENCE):
            found |= {key: name for key, _ in _line_runs(data) if key not in common}
    return found


def _line_runs(data: bytes) -> Iterator[tuple[tuple[str, ...], int]]:
    """Yields each few lines of a text in a row, without blank ones, and the number of the first."""
    try:
        written = [(line.strip(), at) for at, line in enumerate(data.decode("utf-8").split("\n"), 1)]
    except UnicodeDecodeError:
        return
    lines = [(line, at) for line, at in written if line]
    for first in range(len(lines) - PASSAGE + 1):
        part = lines[first : first + PASSAGE]
        yield tuple(line for line, _ in part), part[0][1]


def _passages_in(name: str, text: str, passages: Mapping[tuple[str, ...], str]) -> Iterator[str]:
    if not passages or name.split("/")[0].partition(".")[0] == "starter":
        return
    for key, at in _line_runs(text.encode()):
        if key in passages:
            yield f"{name}:{at}: {PASSAGE} lines of {passages[key]} stand here. Remove them."
            return


def missing_for_practice(version: StudentVersion) -> str:
    """Says what students cannot do with their version; empty if nothing."""
    back = [each for each in version.kept_back if each.startswith(REFERENCE)]
    if not back:
        return ""
    return (
        f"The checks of this kind compare with {join_names(back)}, which stays with you: students cannot check their work "
        "themselves. If they may see it: --with-reference."
    )
