"""Actions that start processes: programs, nodes, containers of components, and the settings of the nodes after them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from kit.ros.graph.naming import absolute_namespace
from kit.ros.launch import parameters as parameter_arguments
from kit.ros.launch.context import LaunchContext, LaunchError
from kit.ros.launch.entity import Action, Condition, LaunchDescriptionEntity, to_entities
from kit.ros.launch.event_handlers import OnProcessExit
from kit.ros.launch.settings import SetEnvironmentVariable, perform_mapping
from kit.ros.launch.substitutions import (
    LaunchLogDir,
    SomeText,
    normalize_to_substitutions,
    perform_substitutions,
)
from kit.ros.launch.unavailable import SoftwareUnavailable

IGNORED_ARGUMENTS = frozenset(
    {
        "emulate_tty", "sigterm_timeout", "sigkill_timeout", "log_cmd", "cached_output", "output_format",
        "respawn_max_retries", "exec_name", "sigint_sigterm_timeout",
    }
)  # fmt: skip
"""Arguments of ROS 2's actions that have no effect here."""

CONFIGURE, ACTIVATE = 1, 3
"""The transitions of lifecycle_msgs/msg/Transition that start a node."""


class ExecuteProcess(Action):
    """Starts a program."""

    completes_later = True

    def __init__(
        self,
        *,
        cmd: Iterable[SomeText],
        name: SomeText | None = None,
        cwd: SomeText | None = None,
        env: Mapping[Any, SomeText] | None = None,
        additional_env: Mapping[Any, SomeText] | None = None,
        prefix: SomeText | None = None,
        shell: bool = False,
        output: SomeText | Mapping[str, str] = "log",
        respawn: bool | SomeText = False,
        respawn_delay: float | None = None,
        on_exit: Any = None,
        condition: Condition | None = None,
        **others: Any,
    ) -> None:
        super().__init__(condition=condition)
        strange = sorted(others.keys() - IGNORED_ARGUMENTS)
        if strange:
            raise TypeError(f"{type(self).__name__}() has no argument {', '.join(map(repr, strange))}")
        self.cmd = [normalize_to_substitutions(part) for part in cmd]
        self.title = None if name is None else normalize_to_substitutions(name)
        self.cwd = None if cwd is None else normalize_to_substitutions(cwd)
        self.env, self.additional_env = env, additional_env
        self.prefix = None if prefix is None else normalize_to_substitutions(prefix)
        self.shell = shell
        self.output = output
        self.respawn = (
            normalize_to_substitutions(str(respawn))
            if isinstance(respawn, bool)
            else normalize_to_substitutions(respawn)
        )
        self.respawn_delay = respawn_delay
        self.on_exit = on_exit
        self.number: int | None = None
        """The number of the process it has started."""
        self.process_details: dict[str, Any] | None = None
        """``cmd``, ``cwd`` and ``env`` of the process it has started, and ``name`` and ``pid`` once it runs."""

    def sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        return () if callable(self.on_exit) else to_entities(self.on_exit)

    def execute(self, context: LaunchContext) -> None:
        if self.on_exit is not None:
            context.register_event_handler(OnProcessExit(target_action=self, on_exit=self.on_exit))
        context.request("process", self, self.specification(context))

    def respawns(self, context: LaunchContext) -> bool:
        return perform_substitutions(context, self.respawn).lower() in ("true", "1")

    def specification(self, context: LaunchContext) -> dict[str, Any]:
        """The process to start, as plain data."""
        command = [perform_substitutions(context, part) for part in self.cmd]
        if not "".join(command if self.shell else command[:1]).strip():
            raise LaunchError("a process is to be started, and its command is empty")
        program = command[0].split()
        title = Path(program[0]).name if program else "process"
        return {
            "kind": "command",
            "title": title if self.title is None else perform_substitutions(context, self.title),
            "command": command,
            "shell": self.shell,
            **self._process_environment(context),
        }

    def _process_environment(self, context: LaunchContext) -> dict[str, Any]:
        environment = dict(context.environment)
        if self.env is not None:
            environment = perform_mapping(context, self.env)
        environment |= perform_mapping(context, self.additional_env or {})
        return {
            "environment": environment,
            "cwd": None
            if self.cwd is None
            else str(Path(perform_substitutions(context, self.cwd)).absolute()),
            "file": self.location.file if self.location else None,
            "line": self.location.line if self.location else None,
        }


class Executable:
    """The description of a program: its command, environment and working directory."""

    def __init__(
        self,
        *,
        cmd: Iterable[SomeText],
        prefix: SomeText | None = None,
        name: SomeText | None = None,
        cwd: SomeText | None = None,
        env: Mapping[Any, SomeText] | None = None,
        additional_env: Mapping[Any, SomeText] | None = None,
        arguments: Iterable[SomeText] | None = None,
    ) -> None:
        self.options: dict[str, Any] = {
            "cmd": [*cmd, *(arguments or ())],
            "prefix": prefix,
            "name": name,
            "cwd": cwd,
            "env": env,
            "additional_env": additional_env,
        }
        """The arguments of ``ExecuteProcess``."""


class ExecuteLocal(ExecuteProcess):
    """Starts the program that an ``Executable`` describes."""

    def __init__(self, *, process_description: Executable, **kwargs: Any) -> None:
        super().__init__(**process_description.options, **kwargs)
        self.process_description = process_description


class Node(ExecuteProcess):
    """Starts a program of a package, with a node's name, namespace, parameters and remappings."""

    def __init__(
        self,
        *,
        executable: SomeText,
        package: SomeText | None = None,
        name: SomeText | None = None,
        namespace: SomeText | None = None,
        exec_name: SomeText | None = None,
        parameters: Iterable[Any] | None = None,
        remappings: Iterable[tuple[SomeText, SomeText]] | None = None,
        ros_arguments: Iterable[SomeText] | None = None,
        arguments: Iterable[SomeText] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(cmd=[executable], name=exec_name, **kwargs)
        self.package = None if package is None else normalize_to_substitutions(package)
        self.executable = normalize_to_substitutions(executable)
        self.node_name = None if name is None else normalize_to_substitutions(name)
        self.namespace = None if namespace is None else normalize_to_substitutions(namespace)
        self.parameters = list(parameters or ())
        self.remappings = [
            (normalize_to_substitutions(match), normalize_to_substitutions(replacement))
            for match, replacement in remappings or ()
        ]
        self.ros_arguments = [normalize_to_substitutions(each) for each in ros_arguments or ()]
        self.arguments = [normalize_to_substitutions(each) for each in arguments or ()]

    def specification(self, context: LaunchContext) -> dict[str, Any]:
        executable = perform_substitutions(context, self.executable)
        own = [perform_substitutions(context, each) for each in self.arguments]
        ros = [perform_substitutions(context, each) for each in self.ros_arguments]
        if self.node_name is not None:
            ros += ["-r", f"__node:={perform_substitutions(context, self.node_name)}"]
        namespace = self._namespace(context)
        if namespace is not None:
            ros += ["-r", f"__ns:={namespace}"]
        for path in context.scope.parameter_files:
            ros += ["--params-file", path]
        for name, value in context.scope.parameters:
            ros += ["-p", f"{name}:={value}"]
        ros += parameter_arguments.arguments(context, self.parameters)
        remappings = [
            (perform_substitutions(context, match), perform_substitutions(context, to))
            for match, to in self.remappings
        ]
        for match, to in (*remappings, *context.scope.remappings):
            ros += ["-r", f"{match}:={to}"]
        return {
            "kind": "node",
            "title": Path(executable).name
            if self.title is None
            else perform_substitutions(context, self.title),
            "package": None if self.package is None else perform_substitutions(context, self.package),
            "executable": executable,
            "arguments": [*own, *(["--ros-args", *ros] if ros else [])],
            **self._process_environment(context),
        }

    def _namespace(self, context: LaunchContext) -> str | None:
        pushed = context.scope.namespace
        if self.namespace is None:
            return pushed or None
        return join_namespaces(pushed, perform_substitutions(context, self.namespace))


class SetROSLogDir(SetEnvironmentVariable):
    """Sets the folder for log files, for every process that is started afterwards."""

    def __init__(self, new_log_dir: SomeText, *, condition: Condition | None = None) -> None:
        super().__init__("ROS_LOG_DIR", new_log_dir, condition=condition)

    def execute(self, context: LaunchContext) -> None:
        folder = Path(
            perform_substitutions(context, LaunchLogDir()), perform_substitutions(context, self.value)
        )
        context.environment["ROS_LOG_DIR"] = str(folder.absolute())


class LifecycleNode(Node):
    """Starts a program with one lifecycle node. ``autostart``: it is configured and activated once it runs."""

    def __init__(
        self, *, name: SomeText, namespace: SomeText, autostart: bool | SomeText = False, **kwargs: Any
    ) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        self.autostart = normalize_to_substitutions(
            str(autostart) if isinstance(autostart, bool) else autostart
        )
        self.full_name = ""
        """Full name of the node, once it has started."""

    def execute(self, context: LaunchContext) -> None:
        super().execute(context)
        namespace = self._namespace(context) or "/"
        name = perform_substitutions(context, self.node_name or "")
        self.full_name = f"{namespace.rstrip('/')}/{name}"
        context.request("watch", self.full_name)
        if perform_substitutions(context, self.autostart).lower() in ("true", "1"):
            for transition in (CONFIGURE, ACTIVATE):
                context.request("transition", self.full_name, transition)


class LifecycleTransition(Action):
    """Makes lifecycle nodes of the launch, given by their full names, go through transitions, one after the other."""

    def __init__(
        self,
        *,
        lifecycle_node_names: Sequence[SomeText],
        transition_ids: Sequence[int | SomeText],
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        if not lifecycle_node_names or not transition_ids:
            raise ValueError("LifecycleTransition needs lifecycle_node_names and transition_ids")
        self.node_names = [normalize_to_substitutions(name) for name in lifecycle_node_names]
        self.transition_ids = [
            normalize_to_substitutions(str(each) if isinstance(each, int) else each)
            for each in transition_ids
        ]

    def execute(self, context: LaunchContext) -> None:
        for name in self.node_names:
            full_name = f"/{perform_substitutions(context, name).lstrip('/')}"
            for each in self.transition_ids:
                text = perform_substitutions(context, each)
                if not text.isdecimal():
                    raise LaunchError(
                        f"a transition of LifecycleTransition is '{text}', which is not a number"
                    )
                context.request("transition", full_name, int(text))


def join_namespaces(outer: str, inner: str) -> str:
    """Joins two namespaces; an absolute inner one replaces the outer."""
    if inner.startswith("/") or not outer:
        return absolute_namespace(inner)
    return f"{outer.rstrip('/')}/{inner}".rstrip("/") or "/"


class PushRosNamespace(Action):
    """Puts the following nodes of the group into a namespace."""

    def __init__(self, namespace: SomeText, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.namespace = normalize_to_substitutions(namespace)

    def execute(self, context: LaunchContext) -> None:
        context.scope.namespace = join_namespaces(
            context.scope.namespace, perform_substitutions(context, self.namespace)
        )


class SetParameter(Action):
    """Sets a parameter for all following nodes of the group."""

    def __init__(self, name: SomeText, value: Any, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.name, self.value = normalize_to_substitutions(name), value

    def execute(self, context: LaunchContext) -> None:
        values = {perform_substitutions(context, self.name): self.value}
        context.scope.parameters += parameter_arguments.flatten_parameters(context, values)


class SetUseSimTime(SetParameter):
    """Sets ``use_sim_time`` for all following nodes of the group."""

    def __init__(self, value: Any, *, condition: Condition | None = None) -> None:
        super().__init__("use_sim_time", value, condition=condition)


class SetParametersFromFile(Action):
    """Gives a parameter file to all following nodes of the group."""

    def __init__(
        self, filename: SomeText, *, node_name: str | None = None, condition: Condition | None = None
    ) -> None:
        super().__init__(condition=condition)
        self.file = parameter_arguments.ParameterFile(filename)

    def execute(self, context: LaunchContext) -> None:
        _, path = parameter_arguments.arguments(context, [self.file])
        context.scope.parameter_files.append(path)


class SetRemap(Action):
    """Sets a remapping for all following nodes of the group."""

    def __init__(self, src: SomeText, dst: SomeText, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.src, self.dst = normalize_to_substitutions(src), normalize_to_substitutions(dst)

    def execute(self, context: LaunchContext) -> None:
        context.scope.remappings.append(
            (perform_substitutions(context, self.src), perform_substitutions(context, self.dst))
        )


_EMPTY_REASON = (
    "a container for composable nodes, which is a process that loads them: the kit starts each composable node in a "
    "process of its own, and this container names none"
)


class ComposableNode(Node):
    """One component of a package: a class derived from ``Node``.

    ``plugin`` names it: by an entry point of the package's group ``rclpy_components``, or by its place, as
    ``my_package.talker:Talker`` (``::`` likewise).
    """

    def __init__(
        self,
        *,
        package: SomeText,
        plugin: SomeText,
        name: SomeText | None = None,
        namespace: SomeText | None = None,
        parameters: Iterable[Any] | None = None,
        remappings: Iterable[tuple[SomeText, SomeText]] | None = None,
        extra_arguments: Iterable[Any] | None = None,
        condition: Condition | None = None,
    ) -> None:
        """``extra_arguments``, as whether to share memory, have no effect here."""
        super().__init__(
            package=package,
            executable=plugin,
            name=name,
            namespace=namespace,
            exec_name=name,
            parameters=parameters,
            remappings=remappings,
            condition=condition,
        )

    def specification(self, context: LaunchContext) -> dict[str, Any]:
        return super().specification(context) | {"kind": "component"}


class LoadComposableNodes(Action):
    """Starts composable nodes."""

    def __init__(
        self,
        *,
        target_container: Any,
        composable_node_descriptions: Iterable[ComposableNode] | None = None,
        condition: Condition | None = None,
        **_: Any,
    ) -> None:
        super().__init__(condition=condition)
        self.descriptions = list(composable_node_descriptions or ())

    def sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        return self.descriptions

    def execute(self, context: LaunchContext) -> Iterable[LaunchDescriptionEntity]:
        return self.descriptions


class ComposableNodeContainer(LoadComposableNodes):
    """Starts composable nodes as well; the container itself is no node here."""

    def __init__(
        self,
        *,
        name: Any,
        namespace: Any,
        composable_node_descriptions: Iterable[ComposableNode] | None = None,
        condition: Condition | None = None,
        **_: Any,
    ) -> None:
        super().__init__(
            target_container=name,
            composable_node_descriptions=composable_node_descriptions,
            condition=condition,
        )

    def execute(self, context: LaunchContext) -> Iterable[LaunchDescriptionEntity]:
        if not self.descriptions:
            raise SoftwareUnavailable(_EMPTY_REASON)
        return super().execute(context)
