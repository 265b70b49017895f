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
        "LaunchTestFailure": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "LaunchTestFailureRepr": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "LaunchTestItem": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "LaunchTestModule": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "LaunchTestRunner": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "LoadTestsFromPythonModule": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "ReprFileLocation": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "TestCase": "unittest:TestCase",
        "find_launch_test_entrypoint": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "pytest_addhooks": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "pytest_addoption": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "pytest_configure": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "pytest_launch_collect_makemodule": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "pytest_pycollect_makemodule": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
