"""How the lessons on workspaces, on photographs and on real robots are found out anew: beside ``derivations.py``."""

from __future__ import annotations

import ast
import shutil
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Final
from xml.etree import ElementTree

import yaml

from kit.launch.package_creation import create_package
from kit.ros.packages import find_packages, read_package
from kit.school.lessons.records import LessonStep
from tests.school.lessons.derivations import Claim
from tests.school.quiz.derived.workspaces import LESSON as WORKSPACE_LESSON
from tests.school.quiz.derived.workspaces import SOURCES, order_reference, run_setup

# A real workspace


def built_copy(words: str, step: LessonStep, folder: Path) -> str:
    """Builds a package, changes its program, and reads the speed in the copy."""
    package = create_package("my_robot", folder / "src")
    program = package / "my_robot" / "driver.py"
    program.write_text("SPEED = 0.2\n")
    run_setup(package, "build_py", "--build-lib", str(folder / "install"))
    program.write_text("SPEED = 0.4\n")
    _, _, speed = (folder / "install" / "my_robot" / "driver.py").read_text().partition(" = ")
    return f"{float(speed):g}, since the copy was made before."


def layout_answers(words: str, step: LessonStep, folder: Path) -> str:
    """Compares what the key of the exercise says with what lies in the workspace."""
    key = yaml.safe_load((WORKSPACE_LESSON / "layout" / "secret.yaml").read_text())["answers"]
    right = {name: set(map(str, each["right"])) for name, each in key.items()}
    packages = {name: read_package(each) for name, each in find_packages([SOURCES]).items()}
    assert set(packages) == right["packages"]
    assert {each.name for each in packages["scout_driver"].executables} == right["program"]
    needs = {name: _needs_of(each.folder) for name, each in packages.items()}
    assert order_reference().build_order(needs)[:1] == list(right["first"])
    imported = {
        node.module.partition(".")[0] if isinstance(node, ast.ImportFrom) and node.module else name.name
        for node in ast.walk(ast.parse((SOURCES / "scout_driver/scout_driver/drive.py").read_text()))
        if isinstance(node, ast.Import | ast.ImportFrom)
        for name in node.names
    }
    assert imported - set(needs["scout_driver"]) == right["undeclared"]
    bringup = folder / "scout_bringup"
    shutil.copytree(SOURCES / "scout_bringup", bringup)
    run_setup(bringup, "egg_info", "install_data", "--install-dir", str(folder / "install"))
    share = folder / "install" / "share" / "scout_bringup"
    lying = {each.name for each in bringup.iterdir() if each.is_dir() and each.suffix != ".egg-info"}
    installed = {each.name for each in share.iterdir()}
    assert lying - installed - {"resource", "scout_bringup"} == right["left_out"]
    return "Two of them these commands answer"


def _needs_of(package: Path) -> list[str]:
    """What a package's package.xml says that it needs."""
    named = ElementTree.parse(package / "package.xml").iter("exec_depend")
    return [each.text or "" for each in named]


def order_of_a_build(words: str, step: LessonStep, folder: Path) -> str:
    """Of the packages in the picture."""
    needs = {}
    for line in step.picture.splitlines():
        name, _, others = line.partition("needs")
        needs[name.strip()] = [each.strip() for each in others.split(",")]
    return ", ".join(order_reference().build_order(needs))


PRACTICE_DERIVATIONS: Final[Mapping[str, Claim]] = MappingProxyType(
    {
        claim.__name__.replace("_", "-"): claim
        for claim in (
            built_copy,
            layout_answers,
            order_of_a_build,
        )
    }
)
"""By the name that a claim's ``derived`` gives."""
PRACTICE_DEAR: Final = frozenset({"built-copy", "layout-answers"})
"""Those that take more than a second: they run with the long tests."""
