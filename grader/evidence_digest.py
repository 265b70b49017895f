"""What evidence depends on in an assignment's folder, as a digest: whatever only judges it may change."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Final

import yaml

from kit.extensions import installed_extensions

ASSIGNMENT_FILE: Final = "assignment.yaml"
"""The name is the kit's too, whose reader of lessons loads numpy: a slip in YAML is told without."""
YAML_LOADER: Final = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
"""The one that the kit reads with, which takes some texts that the other does not."""
JUDGEMENT_KEYS: Final = ("title", "id", "checks", "tests")
"""Keys of the sheet that decide what evidence is worth and what is said of it, not what is found. What a criterion asks for
is part of what is found about it: see ``grader.evidence.findings``."""


def evidence_digest(folder: Path, test_files: Sequence[str], packages: tuple[str, ...] = ()) -> str:
    """Returns a digest of what decides what is found about a submission: of the sheet only the keys and values that count,
    however they are written, and of the other files all but the teacher's own tests."""
    parsed = hashlib.sha256(
        folder_digest(folder, ignored=(ASSIGNMENT_FILE, *test_files), packages=packages).encode()
    )
    with suppress(
        OSError, UnicodeDecodeError, yaml.YAMLError
    ):  # the sheet's own reader reports what is wrong with it
        root = yaml.compose((folder / ASSIGNMENT_FILE).read_text(encoding="utf-8-sig"), Loader=YAML_LOADER)
        if isinstance(root, yaml.MappingNode):
            kept = [pair for pair in root.value if pair[0].value not in JUDGEMENT_KEYS]
            parsed.update(repr(_yaml_content(yaml.MappingNode(root.tag, kept))).encode())
    return parsed.hexdigest()[:16]


def _yaml_content(node: yaml.Node) -> object:
    """What a YAML node says, without how it is written."""
    if isinstance(node, yaml.MappingNode):
        return {_yaml_content(key): _yaml_content(value) for key, value in node.value}
    if isinstance(node, yaml.SequenceNode):
        return [_yaml_content(each) for each in node.value]
    return str(node.value)


def folder_digest(folder: Path, *, ignored: Sequence[str] = (), packages: tuple[str, ...] = ()) -> str:
    """Returns a digest of all files in the folder that grading depends on, but for those of these names, and of the versions
    of the packages that it needs."""
    parsed = hashlib.sha256()
    sources = {each.source for each in installed_extensions() if each.package in packages} if packages else ()
    for source in sorted(sources):
        parsed.update(source.encode())
    for file in sorted(path for path in folder.rglob("*") if path.is_file()):
        name = file.relative_to(folder)
        if (
            str(name) in ignored
            or Path(name.parts[0]).name.partition(".")[0] in IGNORED_STEMS
            or TRANSLATION.fullmatch(name.as_posix())
            or any(part.startswith((".", "__")) for part in name.parts)
        ):
            continue
        parsed.update(repr((name.as_posix(), file.stat().st_size)).encode())
        parsed.update(file.read_bytes())
    return parsed.hexdigest()[:16]


IGNORED_STEMS: Final = ("README", "starter", "solution", "wrong")
"""Files and folders, without their endings, that may change without changing the assignment's version."""
TRANSLATION: Final = re.compile(r"assignment\.[a-z]{2}\.yaml")
"""Words in another language, which change nothing of what is graded either."""
