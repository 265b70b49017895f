"""launch_testing.pytest.hooks of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from unittest import TestCase as TestCase
    LaunchTestFailure: Any
    LaunchTestFailureRepr: Any
    LaunchTestItem: Any
    LaunchTestModule: Any
    LaunchTestRunner: Any
    LoadTestsFromPythonModule: Any
    ReprFileLocation: Any
    find_launch_test_entrypoint: Any
    pytest_addhooks: Any
    pytest_addoption: Any
    pytest_configure: Any
    pytest_launch_collect_makemodule: Any
    pytest_pycollect_makemodule: Any
else:
    _LATE_NAMES = {
        "LaunchTestFailure": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "LaunchTestFailureRepr": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "LaunchTestItem": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "LaunchTestModule": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "LaunchTestRunner": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "LoadTestsFromPythonModule": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "ReprFileLocation": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "TestCase": "unittest:TestCase",
        "find_launch_test_entrypoint": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "pytest_addhooks": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "pytest_addoption": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "pytest_configure": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "pytest_launch_collect_makemodule": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "pytest_pycollect_makemodule": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
