"""Reads a launch file in XML or YAML into the same launch description that a Python launch file returns."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, Final
from xml.parsers import expat

from kit.plain_text import nearest_name
from kit.ros.launch.actions import (
    DeclareBooleanLaunchArgument,
    DeclareLaunchArgument,
    IncludeLaunchDescription,
    Log,
    LogDebug,
    LogError,
    LogInfo,
    LogWarning,
    ScopedIncludeLaunchDescription,
    Shutdown,
    TimerAction,
)
from kit.ros.launch.bounds import MAX_DEPTH, NESTED_TOO_DEEPLY
from kit.ros.launch.context import LaunchError, LaunchFileLocation
from kit.ros.launch.entity import Action, Condition, IfCondition, LaunchDescription, UnlessCondition
from kit.ros.launch.frontend.element import Element, Problems, TextPosition, Texts
from kit.ros.launch.frontend.substitution_parser import split_words
from kit.ros.launch.loops import ForEach, ForLoop, with_loop_values
from kit.ros.launch.parameters import Parameter, ParameterFile, ParameterValue
from kit.ros.launch.processes import (
    ComposableNode,
    ComposableNodeContainer,
    ExecuteProcess,
    LifecycleNode,
    LoadComposableNodes,
    Node,
    PushRosNamespace,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetROSLogDir,
    SetUseSimTime,
)
from kit.ros.launch.settings import (
    AppendEnvironmentVariable,
    GroupAction,
    PopEnvironment,
    PopLaunchConfigurations,
    PushEnvironment,
    PushLaunchConfigurations,
    ReplaceEnvironmentVariables,
    ResetEnvironment,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    UnsetEnvironmentVariable,
    UnsetLaunchConfiguration,
)

ROOT = "launch"


def read_launch_description(path: str, source: bytes) -> LaunchDescription:
    """The description of a launch file. Raises LaunchError, which names every mistake with its line and column."""
    problems = Problems(path)
    if path.endswith(".xml"):
        root = read_xml(source, problems)
        if root.tag != ROOT:
            root.problem(f"an XML launch file starts with <{ROOT}>, not <{root.tag}>")
        root.text("version", None)
        deprecated = root.text("deprecated", None)
    else:
        from kit.ros.launch.frontend.yaml_elements import read_yaml  # only now: it takes PyYAML

        root, deprecated = read_yaml(source, problems), None
    actions = read_actions(root.take_actions())
    root.finish()
    problems.raise_if_any()
    return LaunchDescription(actions, deprecated_reason=deprecated)


def read_xml(source: bytes, problems: Problems) -> Element:
    """The root element. Raises LaunchError where this is no XML."""
    parser = expat.ParserCreate()
    parser.buffer_text = True
    open_elements: list[Element] = []
    roots: list[Element] = []

    def start(name: str, attributes: dict[str, str]) -> None:
        place = TextPosition(parser.CurrentLineNumber, parser.CurrentColumnNumber + 1)
        element = Element(name.replace("-", "_"), place, problems, dict(attributes))
        (open_elements[-1].children if open_elements else roots).append(element)
        open_elements.append(element)
        if len(open_elements) > MAX_DEPTH:
            raise LaunchError(NESTED_TOO_DEEPLY, LaunchFileLocation(problems.file, place.line))

    def text(data: str) -> None:
        if data.strip() and open_elements:
            place = TextPosition(parser.CurrentLineNumber, parser.CurrentColumnNumber + 1)
            problems.add(
                place, f"the text '{data.strip()[:30]}' does not belong in <{open_elements[-1].tag}>"
            )

    def declare_entity(*_: object) -> None:
        raise LaunchError(
            "a launch file must not define entities",
            LaunchFileLocation(problems.file, parser.CurrentLineNumber),
        )

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda name: open_elements.pop()
    parser.CharacterDataHandler = text
    parser.EntityDeclHandler = declare_entity
    try:
        parser.Parse(source, True)
    except expat.ExpatError as problem:
        problems.add(
            TextPosition(problem.lineno, problem.offset + 1),
            f"this is not XML: {expat.ErrorString(problem.code)}",
        )
        problems.raise_if_any()
    return roots[0]


Reader = Callable[[Element, Condition | None], Action]

_TYPES: Final = {"bool": bool, "int": int, "float": float, "str": str}
_IGNORED_OF_PROCESSES: Final = (
    "emulate_tty",
    "sigterm_timeout",
    "sigkill_timeout",
    "log_cmd",
    "output_format",
)


def read_action(element: Element) -> Action | None:
    """The action that an element stands for; mistakes are added to its problems, and then there may be none."""
    reader = _READERS.get(element.tag)
    if reader is None:
        near = nearest_name(element.tag, _READERS)
        hint = f"did you mean <{near}>?" if near else f"available: {', '.join(_READERS)}"
        element.problem(f"there is no action <{element.tag}>; {hint}")
        return None
    action = reader(element, _read_condition(element))
    element.finish()
    action.location = LaunchFileLocation(element.problems.file, element.place.line)
    return action


def read_actions(elements: list[Element]) -> list[Action]:
    """The actions of several elements."""
    return [action for action in map(read_action, elements) if action is not None]


def _read_condition(element: Element) -> Condition | None:
    wanted, unwanted = element.texts("if", None), element.texts("unless", None)
    if wanted is not None and unwanted is not None:
        element.problem(f"<{element.tag}> has both 'if' and 'unless'")
    if wanted is not None:
        return IfCondition(wanted)
    return None if unwanted is None else UnlessCondition(unwanted)


def _read_argument(element: Element, condition: Condition | None) -> Action:
    choices = [choice.text("value") for choice in _finished(element.take("choice"), "value")]
    return DeclareLaunchArgument(
        element.text("name"),
        default_value=element.texts("default", None),
        description=element.text("description", None),
        choices=choices or None,
        condition=condition,
    )


def _read_boolean_argument(element: Element, condition: Condition | None) -> Action:
    return DeclareBooleanLaunchArgument(
        element.text("name"),
        default_value=element.texts("default", None),
        description=element.text("description", None),
        condition=condition,
    )


def _finished(elements: list[Element], *names: str) -> list[Element]:
    """Elements that have these attributes and no others."""
    for each in elements:
        for name in names:
            each.text(name)
        each.finish()
    return elements


def _read_pairs(element: Element, tag: str, first: str, second: str) -> list[tuple[Texts, Texts]]:
    return [(each.texts(first), each.texts(second)) for each in _finished(element.take(tag), first, second)]


def _read_let(element: Element, condition: Condition | None) -> Action:
    return SetLaunchConfiguration(element.texts("name"), element.texts("value"), condition=condition)


def _read_include(
    element: Element,
    condition: Condition | None,
    made: type[IncludeLaunchDescription] = IncludeLaunchDescription,
) -> Action:
    given = [*_read_pairs(element, "arg", "name", "value"), *_read_pairs(element, "let", "name", "value")]
    return made(element.texts("file"), launch_arguments=given, condition=condition)


def _read_scoped_include(element: Element, condition: Condition | None) -> Action:
    return _read_include(element, condition, ScopedIncludeLaunchDescription)


def _read_replaced_environment(element: Element, condition: Condition | None) -> Action:
    pairs = _read_pairs(element, "env", "name", "value")
    return ReplaceEnvironmentVariables({_key(name): value for name, value in pairs}, condition=condition)


def _read_group(element: Element, condition: Condition | None) -> Action:
    kept = _read_pairs(element, "keep", "name", "value")
    # A text as key: the names of a group's own configurations are constant.
    configurations: dict[str, Any] = {
        "".join(part.describe().strip("'") for part in name): value for name, value in kept
    }
    return GroupAction(
        read_actions(element.take_actions("keep")),
        scoped=element.flag("scoped", True),
        forwarding=element.flag("forwarding", True),
        launch_configurations=configurations,
        condition=condition,
    )


def _read_node(element: Element, condition: Condition | None) -> Action:
    return _make_node(Node, element, condition)


def _read_lifecycle_node(element: Element, condition: Condition | None) -> Action:
    element.text("name")
    element.text("namespace", "")
    return _make_node(LifecycleNode, element, condition)


def _make_node(made: type[Node], element: Element, condition: Condition | None) -> Node:
    more: dict[str, Any] = {}
    if made is LifecycleNode:
        more["autostart"] = element.flag("autostart", False)
    return made(
        package=element.texts("pkg", None),
        executable=element.texts("exec"),
        name=element.texts("name", None),
        namespace=element.texts("namespace", "" if made is LifecycleNode else None),
        exec_name=element.texts("exec_name", None),
        arguments=split_words(element.texts("args", ())),
        ros_arguments=split_words(element.texts("ros_args", ())),
        parameters=[_read_parameter(each) for each in element.take("param")],
        remappings=_read_pairs(element, "remap", "from", "to"),
        condition=condition,
        **_read_process_options(element),
        **more,
    )


def _read_process_options(element: Element) -> dict[str, Any]:
    for name in _IGNORED_OF_PROCESSES:
        element.text(name, None)
    on_exit = element.text("on_exit", None)
    if on_exit not in (None, "shutdown"):
        element.problem(f"'on_exit' of <{element.tag}> can only be shutdown, not '{on_exit}'")
    respawn_max = element.number("respawn_max_retries", None)
    return {
        "cwd": element.texts("cwd", None),
        "prefix": element.texts("launch-prefix", None),
        "output": element.text("output", "log"),
        "respawn": element.texts("respawn", "false"),
        "respawn_delay": element.number("respawn_delay", None),
        "additional_env": {_key(name): value for name, value in _read_pairs(element, "env", "name", "value")},
        **({} if on_exit is None else {"on_exit": [Shutdown(reason="a process that is needed has ended")]}),
        **({} if respawn_max is None else {"respawn_max_retries": int(respawn_max)}),
    }


def _key(texts: Texts) -> Any:
    return tuple(texts)


def _read_parameter(element: Element) -> Any:
    """A parameter, a group of them, or a file of them."""
    file = element.texts("from", None)
    if file is not None:
        allowed = element.flag("allow_substs", False)
        element.finish()
        return ParameterFile(file, allow_substs=allowed)
    name = element.texts("name")
    nested = element.take("param")
    if nested:
        element.finish()
        return {_key(name): _nested_parameters(nested)}
    value = _read_parameter_value(element)
    element.finish()
    return Parameter(name, value.value, value_type=value.value_type)


def _nested_parameters(elements: list[Element]) -> dict[Any, Any]:
    found = {}
    for element in elements:
        name, nested = element.texts("name"), element.take("param")
        found[_key(name)] = _nested_parameters(nested) if nested else _read_parameter_value(element)
        element.finish()
    return found


def _read_parameter_value(element: Element) -> ParameterValue:
    value, separator, kind = (
        element.texts("value"),
        element.text("value-sep", None) or element.text("sep", None),
        element.text("type", None),
    )
    if separator:
        parts = [part.strip() for part in str(element.attributes.get("value", "")).split(separator)]
        value = element.parse(f"[{', '.join(parts)}]")
    if kind is not None and kind not in _TYPES:
        element.problem(f"'type' of <param> must be one of {', '.join(_TYPES)}, not '{kind}'")
    return ParameterValue(value, value_type=None if kind is None else _TYPES.get(kind))


def _read_executable(element: Element, condition: Condition | None) -> Action:
    command = element.texts("cmd")
    shell = element.flag("shell", False)
    return ExecuteProcess(
        cmd=[command] if shell else split_words(command),
        name=element.texts("name", None),
        shell=shell,
        condition=condition,
        **_read_process_options(element),
    )


def _read_timer(element: Element, condition: Condition | None) -> Action:
    return TimerAction(
        period=element.texts("period"), actions=read_actions(element.take_actions()), condition=condition
    )


def _read_for(element: Element, condition: Condition | None) -> Action:
    name, actions = element.text("name"), read_actions(element.take_actions())
    return ForLoop(
        element.texts("len"), function=lambda i: with_loop_values({name: i}, actions), condition=condition
    )


def _read_for_each(element: Element, condition: Condition | None) -> Action:
    actions = read_actions(element.take_actions())
    return ForEach(
        element.texts("values"),
        function=lambda **values: with_loop_values(values, actions),
        condition=condition,
    )


def _read_append(element: Element, condition: Condition | None) -> Action:
    return AppendEnvironmentVariable(
        element.texts("name"),
        element.texts("value"),
        prepend=element.flag("prepend", False),
        separator=element.texts("separator", ":"),
        condition=condition,
    )


def _read_log(element: Element, condition: Condition | None) -> Action:
    level = element.texts("level", None)
    return Log(msg=element.texts("message"), level=level or "INFO", condition=condition)


def _read_log_at(made: type[LogInfo | LogWarning | LogError | LogDebug]) -> Reader:
    """The reader of an action whose name says its level."""

    def read(element: Element, condition: Condition | None) -> Action:
        element.text("level", None)
        return made(msg=element.texts("message"), condition=condition)

    return read


def _read_plain(made: Callable[..., Action]) -> Reader:
    """The reader of an action without arguments."""
    return lambda element, condition: made(condition=condition)


def _read_set_parameter(element: Element, condition: Condition | None) -> Action:
    return SetParameter(element.texts("name"), ParameterValue(element.texts("value")), condition=condition)


def _read_namespace(element: Element, condition: Condition | None) -> Action:
    return PushRosNamespace(element.texts("namespace"), condition=condition)


def _read_container(element: Element, condition: Condition | None) -> Action:
    for name in ("pkg", "exec", "args", "ros_args", *_IGNORED_OF_PROCESSES):
        element.text(name, None)
    element.take("param", "remap", "env")
    _read_process_options(element)
    return ComposableNodeContainer(
        name=element.texts("name"),
        namespace=element.texts("namespace"),
        composable_node_descriptions=_read_composable_nodes(element),
        condition=condition,
    )


def _read_load(element: Element, condition: Condition | None) -> Action:
    return LoadComposableNodes(
        target_container=element.texts("target"),
        composable_node_descriptions=_read_composable_nodes(element),
        condition=condition,
    )


def _read_composable_nodes(element: Element) -> list[ComposableNode]:
    return [_read_composable_node(each) for each in element.take("composable_node")]


def _read_composable_node(element: Element) -> ComposableNode:
    for extra in element.take("extra_arg"):
        _finished([extra], "name", "value")
    node = ComposableNode(
        package=element.texts("pkg"),
        plugin=element.texts("plugin"),
        name=element.texts("name", None),
        namespace=element.texts("namespace", None),
        parameters=[_read_parameter(each) for each in element.take("param")],
        remappings=_read_pairs(element, "remap", "from", "to"),
        condition=_read_condition(element),
    )
    element.finish()
    node.location = LaunchFileLocation(element.problems.file, element.place.line)
    return node


_READERS: Final[Mapping[str, Reader]] = MappingProxyType(
    {
        "append_env": _read_append,
        "arg": _read_argument,
        "bool_arg": _read_boolean_argument,
        "executable": _read_executable,
        "for": _read_for,
        "for_each": _read_for_each,
        "group": _read_group,
        "include": _read_include,
        "let": _read_let,
        "lifecycle_node": _read_lifecycle_node,
        "load_composable_node": _read_load,
        "log": _read_log,
        "log_debug": _read_log_at(LogDebug),
        "log_error": _read_log_at(LogError),
        "log_info": _read_log_at(LogInfo),
        "log_warning": _read_log_at(LogWarning),
        "node": _read_node,
        "node_container": _read_container,
        "pop_env": _read_plain(PopEnvironment),
        "pop_vars": _read_plain(PopLaunchConfigurations),
        "push-ros-namespace": _read_namespace,
        "push_env": _read_plain(PushEnvironment),
        "push_ros_namespace": _read_namespace,
        "push_vars": _read_plain(PushLaunchConfigurations),
        "rep_env": _read_replaced_environment,
        "reset": lambda element, condition: UnsetLaunchConfiguration(
            element.texts("name"), condition=condition
        ),
        "reset_env": _read_plain(ResetEnvironment),
        "ros_timer": _read_timer,
        "scoped_include": _read_scoped_include,
        "set_env": lambda element, condition: SetEnvironmentVariable(
            element.texts("name"), element.texts("value"), condition=condition
        ),
        "set_parameter": _read_set_parameter,
        "set_parameters_from_file": lambda element, condition: SetParametersFromFile(
            element.texts("filename"), condition=condition
        ),
        "set_remap": lambda element, condition: SetRemap(
            element.texts("from"), element.texts("to"), condition=condition
        ),
        "set_ros_log_dir": lambda element, condition: SetROSLogDir(
            element.texts("new_log_dir"), condition=condition
        ),
        "set_use_sim_time": lambda element, condition: SetUseSimTime(
            ParameterValue(element.texts("value")), condition=condition
        ),
        "shutdown": lambda element, condition: Shutdown(
            reason=element.text("reason", "reason not given"), condition=condition
        ),
        "timer": _read_timer,
        "unset_env": lambda element, condition: UnsetEnvironmentVariable(
            element.texts("name"), condition=condition
        ),
        "unset_launch_configuration": lambda element, condition: UnsetLaunchConfiguration(
            element.texts("name"), condition=condition
        ),
    }
)
"""The actions by tag."""
