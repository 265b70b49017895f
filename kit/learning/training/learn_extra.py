"""The extra ``learn``: the packages that training needs, and the versions that a run depends on."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from platform import machine, python_version, system

from kit.installation import install_command

# The packages of the extra ``learn``

REQUIRED_PACKAGES = ("torch", "stable_baselines3", "sb3_contrib")
RECORDED_PACKAGES = (
    "robot-learning-kit",
    "torch",
    "stable-baselines3",
    "sb3-contrib",
    "gymnasium",
    "numpy",
    "numba",
)


class LearnExtraMissing(Exception):
    """The extra ``learn`` is not installed; the message says how to install it."""


def require_learn_extra() -> None:
    """LearnExtraMissing if training cannot start. Imports nothing."""
    missing = [name for name in REQUIRED_PACKAGES if find_spec(name) is None]
    if missing:
        raise LearnExtraMissing(
            f"Training needs packages that are not installed: {', '.join(missing)}. To have them, type:\n  {install_command('learn')}\n"
            "Viewing runs, and testing and playing trained policies, work without them."
        )


def versions() -> dict[str, str]:
    """Returns the versions of packages, Python and machine that a run depends on."""
    found = {"python": python_version(), "machine": f"{system()} {machine()}"}
    for name in RECORDED_PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found
