"""Packages as they lie: found, read, and never run."""

from __future__ import annotations

import importlib
import os
from pathlib import Path

import pytest

from kit.msg import interfaces
from kit.ros.packages import (
    SEARCH_VARIABLE,
    PackageError,
    PackageExecutable,
    find_packages,
    installed_files,
    read_package,
)

XML = (
    "<package format='3'><name>pkg</name><version>1.2.3</version><description> a\n b </description></package>"
)
SETUP = """
from setuptools import setup
package_name = 'pkg'
submodules = [package_name + '/deep']
raise SystemExit('never run')
setup(name=package_name, packages=[package_name] + submodules, version=open('VERSION').read(), {})
"""


def package(folder: Path, setup: str = "", **files: str) -> Path:
    folder.mkdir(parents=True)
    (folder / "package.xml").write_text(XML)
    if setup:
        (folder / "setup.py").write_text(SETUP.format(setup))
    for name, text in files.items():
        (folder / name.replace("__", ".")).write_text(text)
    return folder


@pytest.mark.parametrize(
    ("written", "name", "module"),
    [
        ("entry_points={'console_scripts': ['run = pkg.main:main']}", "run", "pkg.main"),
        ("entry_points={'console_scripts': ['run=pkg.__init__:main',],}", "run", "pkg.__init__"),
        (
            "entry_points={'console_scripts': [package_name + ' = ' + package_name + '.a:main']}",
            "pkg",
            "pkg.a",
        ),
        ("entry_points={'console_scripts': [f'{package_name} = {package_name}.b:main']}", "pkg", "pkg.b"),
        ("entry_points={'console_scripts': 'run = pkg.c:main'}", "run", "pkg.c"),
    ],
)
def test_programs_are_read_from_setup_py_without_running_it(
    written: str, name: str, module: str, tmp_path: Path
) -> None:
    found = read_package(package(tmp_path / "p", written))
    assert found.executables == (PackageExecutable(name, module, "main"),)
    assert (found.name, found.version, found.description) == ("pkg", "1.2.3", "a b")


def test_programs_may_stand_in_other_files(tmp_path: Path) -> None:
    configured = package(
        tmp_path / "a", setup__cfg="[options.entry_points]\nconsole_scripts =\n    run = pkg.m:go\n"
    )
    assert read_package(configured).executables == (PackageExecutable("run", "pkg.m", "go"),)
    project = package(tmp_path / "b", pyproject__toml="[project.scripts]\nrun = 'pkg.m:go'\n")
    assert read_package(project).executables == (PackageExecutable("run", "pkg.m", "go"),)
    moved = package(
        tmp_path / "c", "package_dir={'': 'src'}, entry_points={'console_scripts': ['r = pkg.m:go']}"
    )
    assert read_package(moved).source == moved / "src"


@pytest.mark.parametrize(
    ("written", "message"),
    [
        ("entry_points={'console_scripts': make()}", r"setup\.py:6: .*computed"),
        ("entry_points={'console_scripts': ['run pkg.main']}", "must look like"),
        ("entry_points={'console_scripts': ['run = pkg.main']}", "must look like"),
        ("entry_points=(", r"setup\.py:6"),
    ],
)
def test_unreadable_packages_are_reported_with_file_and_line(
    written: str, message: str, tmp_path: Path
) -> None:
    with pytest.raises(PackageError, match=message):
        read_package(package(tmp_path / "p", written))


def test_broken_manifests_are_refused(tmp_path: Path) -> None:
    with pytest.raises(PackageError, match=r"no package\.xml"):
        read_package(tmp_path)
    (tmp_path / "package.xml").write_text("<package>\n<name>x</nam></package>")
    with pytest.raises(PackageError, match=r"package\.xml:2:\d+: broken XML"):
        read_package(tmp_path)
    (tmp_path / "package.xml").write_text("<package/>")
    with pytest.raises(PackageError, match="no <name>"):
        read_package(tmp_path)


def test_programs_and_their_files_are_found_by_name(tmp_path: Path) -> None:
    found = read_package(
        package(tmp_path / "p", "entry_points={'console_scripts': ['run = pkg.m:go', 'x = pkg.n:go']}")
    )
    (tmp_path / "p" / "pkg").mkdir()
    (tmp_path / "p" / "pkg" / "m.py").touch()
    assert found.file_of(found.executable("run")) == tmp_path / "p/pkg/m.py"
    with pytest.raises(PackageError, match="has no executable 'rin'; it has: run, x"):
        found.executable("rin")
    with pytest.raises(PackageError, match=r"there is no .*n\.py"):
        found.file_of(found.executable("x"))


def test_composable_nodes_are_found_by_entry_point_or_by_their_place(tmp_path: Path) -> None:
    folder = package(tmp_path / "a", "entry_points={'rclpy_components': ['pkg::Talker = pkg.nodes:Talker']}")
    (folder / "pkg").mkdir()
    (folder / "pkg" / "nodes.py").touch()
    found = read_package(folder)
    assert found.executables == ()
    for plugin in (
        "pkg::Talker",
        "pkg.nodes:Talker",
        "pkg.nodes::Talker",
        "pkg::nodes::Talker",
        "pkg.nodes.Talker",
    ):
        assert found.component(plugin).entry == "pkg.nodes:Talker", plugin
    for plugin in ("pkg::Nobody", "Talker", "pkg.none:Talker", "../x:Y"):
        with pytest.raises(PackageError, match="no composable node"):
            found.component(plugin)


def test_packages_are_found_in_workspaces(tmp_path: Path) -> None:
    package(tmp_path / "ws/src/group/one")
    package(tmp_path / "ws/src/other/two")
    (tmp_path / "ws/src/other/COLCON_IGNORE").touch()
    package(tmp_path / "ws/src/one/inside")
    package(tmp_path / "ws/.hidden/three")
    package(tmp_path / "ws/a/b/c/d/too_deep")
    assert find_packages([tmp_path / "ws"]) == {"pkg": tmp_path / "ws/src/group/one"}
    assert find_packages([tmp_path / "nowhere"]) == {}


@pytest.mark.usefixtures("import_names")
def test_the_resource_index_knows_packages_and_those_with_interfaces(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = package(tmp_path / "pkg")
    (folder / "msg").mkdir()
    (folder / "msg" / "Reading.msg").write_text("float64 value\n")
    monkeypatch.setenv(SEARCH_VARIABLE, str(tmp_path))
    monkeypatch.setattr(interfaces, "_registry", interfaces._InterfaceRegistry())
    interfaces.register_packages({"pkg": str(folder)})
    resources = importlib.import_module("ament_index_python.resources")
    assert resources.get_resources("packages") == {"pkg": str(folder)}
    assert resources.get_resource("packages", "pkg") == ("", str(folder))
    assert resources.get_resource("rosidl_interfaces", "pkg") == ("msg/Reading.msg\n", str(folder))
    assert resources.has_resource("packages", "other") is False
    assert resources.get_resources("rviz_common__pluginlib__plugin") == {}
    with pytest.raises(LookupError, match="Could not find the resource 'other' of type 'packages'"):
        resources.get_resource("packages", "other")


def test_scripts_that_cmake_installs_are_programs(tmp_path: Path) -> None:
    (tmp_path / "scripts").mkdir()
    (tmp_path / "scripts" / "talker.py").write_text("print('talks')\n")
    (tmp_path / "package.xml").write_text(
        "<package><name>mixed</name><export><build_type>ament_cmake</build_type></export></package>"
    )
    (tmp_path / "CMakeLists.txt").write_text(
        "add_executable(fast src/fast.cpp)\ninstall(TARGETS fast DESTINATION lib/${PROJECT_NAME})\n"
        'install(PROGRAMS\n  scripts/talker.py "scripts/gone.py" # scripts/other.py\n  DESTINATION lib/${PROJECT_NAME})\n'
    )
    package = read_package(tmp_path)
    (talker,) = package.executables
    assert (talker.name, talker.entry) == ("talker.py", None)
    assert package.file_of(talker) == tmp_path / "scripts" / "talker.py"


DOUBLED = "setup(entry_points={'console_scripts': a})"


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("package.xml", '<?xml version="1.0" encoding="x-none"?><package/>'),
        ("package.xml", '<?xml version="1.0" encoding="utf-7"?><package/>'),
        ("setup.py", "x = " + "-" * 90_000 + "1"),
        ("setup.py", "setup(entry_points={[]: 1})"),
        ("setup.py", "a = 'xxxxxxxxxx'\n" + "a = f'{a}{a}'\n" * 60 + DOUBLED),
        ("setup.py", "a = []\n" + "a = [a, a]\n" * 60 + "setup(entry_points={'console_scripts': f'{a}'})"),
        ("pyproject.toml", "project = 3"),
        ("pyproject.toml", "project.scripts = 3"),
        ("pyproject.toml", "project.entry-points = [1]"),
        ("pyproject.toml", "a = " + "[" * 50_000),
    ],
)
def test_a_hostile_manifest_is_refused_by_name(name: str, text: str, tmp_path: Path) -> None:
    (tmp_path / "package.xml").write_text("<package><name>p</name></package>")
    (tmp_path / name).write_text(text)
    with pytest.raises(PackageError, match=name):
        read_package(tmp_path)


@pytest.mark.parametrize("name", ["../../etc", "/etc", "..", "a/b", "p" * 300, "p\u202eg", "p g"])
def test_a_name_that_cannot_be_a_folders_is_none(name: str, tmp_path: Path) -> None:
    folder = package(tmp_path / "pkg")
    (folder / "package.xml").write_text(XML.replace("pkg", name))
    with pytest.raises(PackageError, match="no name of a package"):
        read_package(folder)
    assert find_packages([tmp_path]) == {}


def test_a_list_doubled_line_by_line_stays_small(tmp_path: Path) -> None:
    (tmp_path / "package.xml").write_text("<package><name>p</name></package>")
    (tmp_path / "setup.py").write_text("a = ['x = y:z']\n" + "a = a + a\n" * 60 + DOUBLED)
    assert len(read_package(tmp_path).executables) <= 100_000


def test_a_named_pipe_as_manifest_holds_nobody(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "package.xml")
    with pytest.raises(PackageError, match="not a plain file"):
        read_package(tmp_path)


def test_a_package_installs_its_own_files_alone(tmp_path: Path) -> None:
    own = tmp_path / "p"
    own.mkdir()
    (own / "mine.txt").touch()
    (tmp_path / "secret.yaml").touch()
    (own / "link.yaml").symlink_to(tmp_path / "secret.yaml")
    (own / "setup.py").write_text(
        "from glob import glob\nsetup(data_files=[('share/p/a', ['mine.txt', 'link.yaml', '../secret.yaml', "
        f"{str(tmp_path / 'secret.yaml')!r}]), ('share/p/b', glob('../*.yaml')), ('share/p/c', glob('/etc/*'))])"
    )
    assert installed_files("p", own) == {"a/mine.txt": own / "mine.txt"}


def test_a_link_that_leads_nowhere_hides_no_package(tmp_path: Path) -> None:
    (tmp_path / "a_link").symlink_to("a_link")
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "package.xml").write_text("<package><name>mine</name></package>")
    assert find_packages([tmp_path]) == {"mine": tmp_path / "mine"}
