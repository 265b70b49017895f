"""Files that make a CI service grade what is pushed to it or handed in there.

The job that runs students' code has a read-only token and no secrets. For a grade that counts, keep the workflow and the
assignment in the teacher's repository, not in the student's: whoever may push may change both.

Every trusted program starts with ``-P`` in a folder that the student cannot write: ``python -m pip`` in the checkout would run a
student's ``pip.py``. What is reported is what this run has written, outside the checkout.

One workflow grades all assignments of a repository. The kit is installed from its source repository with its tested versions,
never by a name that a package index would have to resolve.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from pkgutil import iter_modules
from types import MappingProxyType
from typing import Final

from grader.ci import services
from grader.ci.ci_service import CiService

_FOUND: Final[list[CiService]] = [
    import_module(f"{services.__name__}.{module.name}").SERVICE for module in iter_modules(services.__path__)
]

SERVICES: Final[Mapping[str, CiService]] = MappingProxyType({each.name: each for each in _FOUND})
"""Every service by its name on the command line."""
REPOSITORY_SERVICES: Final = tuple(each.name for each in _FOUND if each.is_in_students_repository)
"""Those whose workflow lies in the repository of the student."""
