"""Writes the stubs from which type checkers know the message classes: ``python -m tests.msg.stubs``.

The stubs are derived from the texts in ``definitions``, which stay the one source; a test compares them.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import kit
from kit.msg.fields import FieldKind, FixedArrayKind, MessageKind, ScalarKind, SequenceKind
from kit.msg.interfaces import PACKAGES, Interface, interfaces
from kit.msg.message import Message, Service

_PARTS = ("action", "msg", "srv")


def stub_files() -> dict[str, str]:
    """The text of every stub, by its path within the package ``kit``."""
    files: dict[str, str] = {}
    for package in PACKAGES:
        files[f"msg/{package}.pyi"] = _package_stub(package)
        for part in _PARTS:
            names = [cls.__name__ for cls in interfaces(package) if cls.__ros_type__.split("/")[1] == part]
            if names:
                lines = [f"from kit.msg.{package} import {name} as {name}\n" for name in names]
                files[f"ros/names/{package}/{part}/__init__.pyi"] = "".join(lines)
    return files


def _package_stub(package: str) -> str:
    classes = [line for cls in interfaces(package) for line in _interface_lines(cls, package)]
    text = "\n".join(classes)
    used = sorted(other for other in PACKAGES if f" {other}." in text or f"[{other}." in text)
    header = [
        "from array import array as _array",
        "from typing import ClassVar as _ClassVar",
        "",
        "import numpy as _np",
        "from numpy.typing import NDArray as _NDArray",
        "",
        *(f"from kit.msg import {other} as {other}" for other in used),
        "from kit.msg.message import Action as _Action",
        "from kit.msg.message import Message as _Message",
        "from kit.msg.message import Service as _Service",
        "",
    ]
    return "\n".join([*header, text, ""])


def _interface_lines(cls: Interface, package: str) -> Iterator[str]:
    if issubclass(cls, Message):
        yield from _message_lines(cls, cls.__name__, package)
    elif issubclass(cls, Service):
        yield from _service_lines(cls, cls.__name__, package)
    else:
        yield f"class {cls.__name__}(_Action):"
        for name in ("Goal", "Result", "Feedback"):
            yield from _indented(_message_lines(getattr(cls, name), name, package))
        yield "    class Impl:"
        for name in ("SendGoalService", "GetResultService"):
            yield from _indented(_indented(_service_lines(getattr(cls.Impl, name), name, package)))
        yield from _indented(_indented(_message_lines(cls.Impl.FeedbackMessage, "FeedbackMessage", package)))
        yield "        GoalStatusMessage = action_msgs.GoalStatusArray"
        yield "        CancelGoalService = action_msgs.CancelGoal"


def _service_lines(cls: type[Service], name: str, package: str) -> Iterator[str]:
    yield f"class {name}(_Service):"
    yield from _indented(_message_lines(cls.Request, "Request", package))
    yield from _indented(_message_lines(cls.Response, "Response", package))


def _message_lines(cls: type[Message], name: str, package: str) -> Iterator[str]:
    yield f"class {name}(_Message):"
    for constant in cls.__ros_constants__:
        yield f"    {constant.name}: _ClassVar[{_python_type(constant.kind, package)}]"
    for field in cls.__ros_fields__:
        yield f"    {field.name}: {_python_type(field.kind, package)} = ..."
    if not cls.__ros_constants__ and not cls.__ros_fields__:
        yield "    pass"


def _indented(lines: Iterator[str]) -> Iterator[str]:
    return (f"    {line}" for line in lines)


def _python_type(kind: FieldKind, package: str) -> str:
    """The annotation of a field of this kind in the stub of a package."""
    if isinstance(kind, ScalarKind):
        return kind.python_type.__name__
    if isinstance(kind, MessageKind):
        owner, _, name = kind.cls.__ros_type__.partition("/")
        name = name.rpartition("/")[2].replace("_", ".")  # the goal of an action
        return name if owner == package else f"{owner}.{name}"
    if isinstance(kind, FixedArrayKind):
        number = "bool" if kind.item.text == "bool" else {"char": "uint8"}.get(kind.item.text, kind.item.text)
        return f"_NDArray[_np.{number}]"
    assert isinstance(kind, SequenceKind)
    item = _python_type(kind.item, package)
    return f"_array[{item}]" if kind.type_code else f"list[{item}]"


if __name__ == "__main__":
    for path, text in stub_files().items():
        file = Path(kit.__file__).parent / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
