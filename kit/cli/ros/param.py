"""``kit ros param``: the parameters of nodes."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import click
import yaml

from kit.cli.lazy_group import HintingGroup
from kit.cli.ros.world_client import exit_with_error, with_world_client
from kit.inspection.client import InspectionClient
from kit.inspection.graph_text import absolute_name, node_names
from kit.inspection.parameter_text import description, format_value, nest_by_name, type_name_of
from kit.msg.message import Message, Service
from kit.msg.rcl_interfaces import (
    DescribeParameters,
    GetParameters,
    ListParameters,
    Parameter,
    ParameterValue,
    SetParameters,
    SetParametersResult,
)
from kit.ros.exceptions import InvalidRosArguments
from kit.ros.graph.naming import validate_full_topic_name
from kit.ros.parameters.parameter import Parameter as TypedParameter
from kit.ros.parameters.parameter import parameter_value_to_python
from kit.ros.parameters.parameter_files import AmbiguousValue, get_parameter_value, read_parameter_file

SERVICE_TIMEOUT_S: Final = 5.0
"""How long a node may take to answer [s]."""

hidden_nodes = click.option("--include-hidden-nodes", "hidden", is_flag=True, help="Include hidden nodes.")


@click.group(cls=HintingGroup)
def command() -> None:
    """Read and change parameters: settings of running nodes."""


@command.command("list")
@click.argument("name", required=False, metavar="[NODE]")
@hidden_nodes
@click.option("--param-type", is_flag=True, help="Show their types too.")
@click.option("--param-prefixes", multiple=True, help="List only parameters below this name.")
@click.option("--filter", "pattern", help="List only parameters that match this regular expression.")
@with_world_client
def list_parameters(
    client: InspectionClient,
    name: str | None,
    hidden: bool,
    param_type: bool,
    param_prefixes: Sequence[str],
    pattern: str | None,
) -> None:
    """List the parameters of all nodes, or of one node."""
    nodes = (
        [_find_node_or_exit(client, name, hidden=hidden)] if name else node_names(client.graph, hidden=hidden)
    )
    for node in dict.fromkeys(nodes):
        if f"{node}/list_parameters" not in client.graph.directory.services:
            continue
        if not name:
            click.echo(f"{node}:")
        names = [
            each
            for each in _parameter_names(client, node, param_prefixes)
            if not pattern or re.search(pattern, each)
        ]
        types = {}
        if param_type:
            types = {each.name: type_name_of(each.type) for each in _describe(client, node, names)}
        for each in names:
            click.echo(f"  {each} (type: {types[each]})" if param_type else f"  {each}")


@command.command()
@click.argument("name", metavar="NODE")
@click.argument("parameter")
@click.option("--hide-type", is_flag=True, help="Print only the value.")
@hidden_nodes
@with_world_client
def get(client: InspectionClient, name: str, parameter: str, hide_type: bool, hidden: bool) -> None:
    """Print a parameter's value.

    \b
    kit ros param get /random_walk speed
    """
    node = _find_node_or_exit(client, name, hidden=hidden)
    request = GetParameters.Request(names=[parameter])
    values = _call_service(client, GetParameters, node, "get_parameters", request).values
    if not values:
        exit_with_error("Parameter not set")
    click.echo(format_value(values[0], hide_type=hide_type))


@command.command("set", context_settings={"ignore_unknown_options": True})  # a value may be -1
@click.argument("name", metavar="NODE")
@click.argument("pairs", nargs=-1, required=True, metavar="PARAMETER VALUE [PARAMETER VALUE ...]")
@hidden_nodes
@with_world_client
def set_parameters(client: InspectionClient, name: str, pairs: Sequence[str], hidden: bool) -> None:
    """Set one or more parameters.

    \b
    kit ros param set /random_walk speed 0.3
    """
    for word in (name, *pairs[::2]):
        if word.startswith("-"):
            raise click.NoSuchOption(word)
    if len(pairs) % 2:
        exit_with_error(
            "Parameters must be provided as name/value pairs: name value [name value ...]. "
            f"Got {len(pairs)} argument(s)."
        )
    node = _find_node_or_exit(client, name, hidden=hidden)
    try:
        parameters = [
            Parameter(name=each, value=get_parameter_value(value))
            for each, value in zip(pairs[::2], pairs[1::2], strict=True)
        ]
    except AmbiguousValue as problem:
        exit_with_error(str(problem))
    results = _set(client, node, parameters)
    for parameter, result in zip(parameters, results, strict=True):
        prefix = f"{parameter.name}: " if len(parameters) > 1 else ""
        _print_result(result, f"{prefix}Set parameter successful", f"{prefix}Setting parameter failed")
    _exit_for_results(results)


@command.command()
@click.argument("name", metavar="NODE")
@click.argument("parameters", nargs=-1, required=True)
@hidden_nodes
@with_world_client
def describe(client: InspectionClient, name: str, parameters: Sequence[str], hidden: bool) -> None:
    """Print the descriptions and allowed values of parameters."""
    for descriptor in _describe(client, _find_node_or_exit(client, name, hidden=hidden), parameters):
        for line in description(descriptor):
            click.echo(line)


@command.command()
@click.argument("name", metavar="NODE")
@hidden_nodes
@with_world_client
def dump(client: InspectionClient, name: str, hidden: bool) -> None:
    """Print all parameters of a node as a file for `load` and `--params-file`."""
    node = _find_node_or_exit(client, name, hidden=hidden)
    names = _parameter_names(client, node)
    values = _call_service(
        client, GetParameters, node, "get_parameters", GetParameters.Request(names=names)
    ).values
    tree = nest_by_name(zip(names, map(parameter_value_to_python, values), strict=True))
    click.echo(yaml.dump({node: {"ros__parameters": tree}}, default_flow_style=False))


@command.command()
@click.argument("name", metavar="NODE")
@click.argument("file", type=click.Path(path_type=Path))
@hidden_nodes
@with_world_client
def load(client: InspectionClient, name: str, file: Path, hidden: bool) -> None:
    """Set a node's parameters from a file."""
    node = _find_node_or_exit(client, name, hidden=hidden)
    try:
        given = [entry for entry in read_parameter_file(str(file)) if entry.node in (node, "/**")]
    except InvalidRosArguments as problem:
        exit_with_error(str(problem).removeprefix("--params-file "))
    if not given:
        exit_with_error(f"Param file does not contain parameters for {node}, only for other nodes: {file}")
    parameters = [TypedParameter.to_parameter_msg(each) for entry in given for each in entry.parameters]
    results = _set(client, node, parameters)
    for parameter, result in zip(parameters, results, strict=True):
        text = f"Set parameter {parameter.name}"
        _print_result(result, f"{text} successful", f"{text} failed")
    _exit_for_results(results)


@command.command()
@click.argument("name", metavar="NODE")
@click.argument("parameter")
@hidden_nodes
@with_world_client
def delete(client: InspectionClient, name: str, parameter: str, hidden: bool) -> None:
    """Delete a parameter."""
    node = _find_node_or_exit(client, name, hidden=hidden)
    results = _set(client, node, [Parameter(name=parameter, value=ParameterValue())])
    _print_result(results[0], "Deleted parameter successfully", "Deleting parameter failed")
    _exit_for_results(results)


def _find_node_or_exit(client: InspectionClient, name: str, *, hidden: bool) -> str:
    """The full name of an existing node with parameters; exits if there is none."""
    node = absolute_name(name)
    if node not in node_names(client.graph, hidden=hidden):
        exit_with_error("Node not found")
    if f"{node}/get_parameters" not in client.graph.directory.services:
        exit_with_error(f"The node {node} has no parameter services")
    validate_full_topic_name(node)
    return node


def _call_service(
    client: InspectionClient, cls: type[Service], node: str, service: str, request: Message
) -> Any:
    return client.call(cls, f"{node}/{service}", request, timeout_s=SERVICE_TIMEOUT_S)


def _parameter_names(client: InspectionClient, node: str, prefixes: Sequence[str] = ()) -> list[str]:
    request = ListParameters.Request(prefixes=list(prefixes))
    return sorted(_call_service(client, ListParameters, node, "list_parameters", request).result.names)


def _describe(client: InspectionClient, node: str, names: Sequence[str]) -> list[Any]:
    request = DescribeParameters.Request(names=list(names))
    return list(_call_service(client, DescribeParameters, node, "describe_parameters", request).descriptors)


def _set(client: InspectionClient, node: str, parameters: Sequence[Parameter]) -> list[SetParametersResult]:
    request = SetParameters.Request(parameters=list(parameters))
    return list(_call_service(client, SetParameters, node, "set_parameters", request).results)


def _print_result(result: SetParametersResult, done: str, failed: str) -> None:
    reason = f": {result.reason}" if result.reason else ""
    click.echo(f"{done if result.successful else failed}{reason}", err=not result.successful)


def _exit_for_results(results: Sequence[SetParametersResult]) -> None:
    if not all(result.successful for result in results):
        raise SystemExit(1)
