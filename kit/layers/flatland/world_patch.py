"""Writes a plan back into the user's own world and model files: previewed, applied at once, and checked.

Only lists of layer names are touched (``yaml_edits``). A model file serves every world that names it, so a file
that another world names as well is left alone, like one that cannot be edited without a guess; and because half a
patch would be a broken world, nothing is written unless every file can be.
"""

from __future__ import annotations

import difflib
import os
import re
from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Final

from kit.layers.flatland.layer_lists import find_layer_lists
from kit.layers.flatland.requirement_binding import bind_requirements
from kit.layers.flatland.world_planning import WorldPlan
from kit.layers.flatland.yaml_edits import (
    AddListItem,
    RemoveListItem,
    SetNameList,
    UnsafeEdit,
    YamlChange,
    apply_changes,
)
from kit.layers.flatland.yaml_scalars import format_flow_list
from kit.layers.requirements_file import RequirementsFile
from kit.plain_text import counted
from kit.workspace import write_atomically
from kit.world.collision_rules import CollisionRules
from kit.world.documents import MAX_YAML_BYTES, UnusableFile, read_bytes
from kit.world.problems import WorldError
from kit.world.records import SourceLocation, World

_ALL_LAYERS: Final = ("all",)
_MAX_SEARCHED_FILES: Final = 2000


class PatchError(Exception):
    """A patch that was not applied, or was taken back; the message says why."""


@dataclass(frozen=True, slots=True)
class FilePatch:
    """One file as it is and as it shall be."""

    path: Path
    before: bytes
    after: bytes


@dataclass(frozen=True, slots=True)
class SkippedFile:
    """One file that is not patched: why, and what to write in it by hand."""

    path: Path
    reason: str
    by_hand: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class WorldPatch:
    files: tuple[FilePatch, ...]
    skipped: tuple[SkippedFile, ...]

    def diff(self) -> str:
        """Returns the changes as a unified diff. Line ends as in the files."""
        return "".join(_file_diff(file) for file in self.files)


@dataclass(frozen=True, slots=True)
class _PlannedChange:
    """One change, where it belongs, what to do in words, and why the planner cannot do it, if it cannot."""

    location: SourceLocation
    change: YamlChange
    text: str
    objection: str = ""


def build_patch(plan: WorldPlan, *, root: Path | None = None, also_shared: bool = False) -> WorldPatch:
    """The patch that makes a world's files say what a plan says.

    ``root``: where else to look for worlds that share a model file. ``also_shared``: patch such files as well.
    """
    if plan.is_unchanged:
        return WorldPatch((), ())
    by_file: defaultdict[Path, list[_PlannedChange]] = defaultdict(list)
    for wanted in _planned_changes(plan):
        by_file[wanted.location.file].append(wanted)
    world = plan.world_case.layer_lists.world
    files: list[FilePatch] = []
    left: list[SkippedFile] = []
    for path, changes in sorted(by_file.items()):
        try:
            if path != world.file and not also_shared and (others := _other_world_files(path, world, root)):
                raise UnsafeEdit(
                    f"{', '.join(map(str, others[:3]))} names it too, and would change along with it"
                )
            if objections := [wanted.objection for wanted in changes if wanted.objection]:
                raise UnsafeEdit(objections[0])
            files.append(_file_patch(path, [wanted.change for wanted in changes]))
        except UnsafeEdit as reason:
            left.append(SkippedFile(path, str(reason), tuple(wanted.text for wanted in changes)))
    return WorldPatch(tuple(files), tuple(left))


def apply_patch(patch: WorldPatch, wrong: Callable[[], Sequence[str]]) -> None:
    """Writes every file of the patch, each atomically, then asks ``wrong`` what is not as it should be.

    If anything is, or a file cannot be written or has changed meanwhile, every file gets its old content back and
    PatchError says why. A patch that leaves a file alone is not applied. (A kill between two files leaves each
    of them whole, the earlier new and the later old: the preview says which.)
    """
    if patch.skipped:
        raise PatchError(f"{patch.skipped[0].path} has to be changed by hand, so no file was written")
    done: list[FilePatch] = []
    try:
        for file in patch.files:
            if _read_content(file.path) != file.before:
                raise PatchError(f"{file.path} has changed since it was read")
            done.append(file)
            _write_world_file(file.path, file.after)
        try:
            problems = list(wrong())
        except WorldError as error:
            problems = [str(error)]
        if problems:
            raise PatchError(f"the result would not do what was asked: {problems[0]}")
    except (OSError, UnsafeEdit) as error:
        _restore_files(done)
        raise PatchError(f"{error}: nothing was changed") from error
    except BaseException:  # Ctrl-C too: no half-written patch stays; raised again
        _restore_files(done)
        raise


def behaviour_differences(
    before: World, after: World, *, one_model_never_collides: bool = False
) -> list[str]:
    """Lists the differences between two states of a world: collisions, what lasers see, and walls."""
    found = []
    old, new = CollisionRules(before), CollisionRules(after)
    if [body.name for body in old.bodies] != [body.name for body in new.bodies]:
        return ["the bodies and walls are no longer the same"]
    for (a, b, was), (_, _, now) in zip(old.contact_rules(), new.contact_rules(), strict=True):
        if one_model_never_collides and a.model is not None and a.model == b.model:
            continue
        if was.kind != now.kind:
            found.append(f"{a.name} {was.kind.value} {b.name} before, and {now.kind.value} it after")
    for (laser, body, saw), (_, _, sees) in zip(old.visibilities(), new.visibilities(), strict=True):
        if saw.is_visible != sees.is_visible:
            found.append(f"{laser.name} {'sees' if sees.is_visible else 'no longer sees'} {body.name}")
    return found


def make_recheck(
    plan: WorldPlan, reread: Callable[[], World], *, requirements: RequirementsFile | None = None
) -> Callable[[], Sequence[str]]:
    """The check of what the files say by then: what was asked, with as many names as planned.

    ``reread`` loads the world again. Asked is what the requirements say; without any, that the world behaves as it did.
    """
    layer_lists = plan.world_case.layer_lists
    ignore_self_collisions = layer_lists.one_model_never_collides

    def wrong() -> Sequence[str]:
        world = reread()
        if requirements is None:
            found = behaviour_differences(
                layer_lists.world, world, one_model_never_collides=ignore_self_collisions
            )
        else:
            now = bind_requirements(
                requirements, find_layer_lists(world, one_model_never_collides=ignore_self_collisions)
            )
            found = [str(breach) for breach in now.current_breaches]
        if len(world.layer_bits) != plan.size:
            found.append(f"the world names {counted(len(world.layer_bits), 'layer')}, not {plan.size}")
        return found

    return wrong


# What has to be written


def _planned_changes(plan: WorldPlan) -> Iterator[_PlannedChange]:
    case, assignment = plan.world_case.case, plan.assignment
    every = frozenset(layer.name for layer in assignment.layers)
    for entity in case.entities:
        for layer_list in plan.world_case.entities[entity.name]:
            key = "name" if entity.kind == "map" else "layers"
            yield from _list_change(
                layer_list.location, key, layer_list.names, assignment.layers_of(entity.name), every
            )
    for name, laser in plan.world_case.lasers.items():
        yield from _list_change(laser.location, "layers", laser.names, assignment.watches[name], every)
    yield from _mapless_layer_changes(plan)


def _list_change(
    location: SourceLocation,
    key: str,
    written: tuple[str, ...],
    names: tuple[str, ...],
    every: frozenset[str],
) -> Iterator[_PlannedChange]:
    means = every if written == _ALL_LAYERS and key == "layers" else frozenset(written)
    if means == frozenset(names) and (names or written != _ALL_LAYERS):
        return
    objection = ""
    if names == _ALL_LAYERS and key == "layers":
        objection = 'a layer is called "all", which by itself means every layer: give it another name'
    stay = [name for name in written if name in names]
    ordered = (*stay, *(name for name in names if name not in stay))
    change = SetNameList((location.line, location.column), key, ordered)
    yield _PlannedChange(location, change, f"{location}: {key}: {format_flow_list(ordered)}", objection)


def _mapless_layer_changes(plan: WorldPlan) -> Iterator[_PlannedChange]:
    """Entries without a map: what is planned for them, what is no longer needed, what is missing."""
    world = plan.world_case.layer_lists.world
    maps = {entity.name for entity in plan.world_case.case.entities if entity.kind == "map"}
    free = [layer.name for layer in plan.assignment.layers if layer.members.isdisjoint(maps)]
    entries = [layer for layer in world.layers if layer.walls is None]
    known = {name for entry in entries for name in entry.names}
    fresh = tuple(name for name in free if name not in known)
    for entry in entries:
        names = tuple(name for name in entry.names if name in free) + fresh
        fresh = ()
        location = entry.location
        if not names:
            yield _PlannedChange(
                location,
                RemoveListItem((location.line, location.column)),
                f"{location}: remove this entry of layers",
            )
        else:
            yield from _list_change(location, "name", entry.names, names, frozenset())
    if fresh:
        yield _PlannedChange(
            SourceLocation(world.file),
            AddListItem("layers", fresh),
            f"{world.file}: add to layers: - name: {format_flow_list(fresh)}",
        )


# Files


def _file_patch(path: Path, changes: Sequence[YamlChange]) -> FilePatch:
    before = _read_content(path)
    try:
        text = before.decode("utf-8")
    except UnicodeDecodeError as error:
        raise UnsafeEdit("it is not a text in UTF-8") from error
    mark = "\ufeff" if text.startswith("\ufeff") else ""
    after = mark + apply_changes(text.removeprefix(mark), changes)
    if not os.access(path, os.W_OK):
        raise UnsafeEdit("you have no permission to write it")
    return FilePatch(path, before, after.encode("utf-8"))


def _read_content(path: Path) -> bytes:
    try:
        return read_bytes(path, MAX_YAML_BYTES)
    except UnusableFile as error:
        raise UnsafeEdit(str(error)) from error


def _write_world_file(path: Path, content: bytes) -> None:
    mode = path.stat().st_mode
    write_atomically(path, content)
    path.chmod(mode)


def _restore_files(done: Sequence[FilePatch]) -> None:
    for file in done:
        _write_world_file(file.path, file.before)


def _other_world_files(path: Path, world: World, root: Path | None) -> list[Path]:
    """Other world files nearby that name a file: beside the world, beside the file, and in the folders below these."""
    folders = dict.fromkeys(folder for folder in (world.file.parent, path.parent, root) if folder is not None)
    near = (
        file
        for folder in folders
        for pattern in ("*.yaml", "*.yml", "*/*.yaml", "*/*.yml")
        for file in folder.glob(pattern)
    )
    named = re.compile(rb"(?<![\w.-])" + re.escape(path.name.encode()))
    own = {world.file.resolve(), path.resolve()}
    found = []
    for file in dict.fromkeys(candidate.resolve() for candidate in islice(near, _MAX_SEARCHED_FILES)):
        if file not in own:
            try:
                text = read_bytes(file, MAX_YAML_BYTES)
            except UnusableFile:
                continue
            if named.search(text) and b"models:" in text:
                found.append(file)
    return sorted(found)


def _file_diff(file: FilePatch) -> str:
    before, after = (
        content.decode("utf-8").splitlines(keepends=True) for content in (file.before, file.after)
    )
    lines = difflib.unified_diff(before, after, str(file.path), str(file.path))
    return "".join(
        line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n" for line in lines
    )
