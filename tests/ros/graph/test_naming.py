"""Names: what is allowed, where it goes wrong, what a relative one means."""

from __future__ import annotations

import pytest

from kit.ros.exceptions import (
    InvalidNamespaceException,
    InvalidNodeNameException,
    InvalidTopicNameException,
    NameValidationException,
)
from kit.ros.graph.graph import Graph
from kit.ros.graph.naming import (
    expand_topic_name,
    topic_or_service_is_hidden,
    validate_full_topic_name,
    validate_namespace,
    validate_node_name,
    validate_topic_name,
)
from kit.ros.node.node import create_graph_node
from tests.cases import every_case


@pytest.mark.parametrize("name", ["a", "A_1", "_x", "x" * 255])
def test_good_node_names(name: str) -> None:
    assert validate_node_name(name)


@every_case(
    ("name", "where"), [("", 0), ("1a", 0), ("a b", 1), ("a/b", 1), ("ab-c", 2), ("x" * 256, 255), ("ä", 0)]
)
def test_bad_node_names_say_where(name: str, where: int) -> None:
    with pytest.raises(InvalidNodeNameException) as problem:
        validate_node_name(name)
    assert problem.value.invalid_index == where
    assert str(problem.value).splitlines()[-1].index("^") == where + 3


@pytest.mark.parametrize("name", ["/", "/a", "/a/b_1"])
def test_good_namespaces(name: str) -> None:
    assert validate_namespace(name)


@every_case("name", ["", "a", "/a/", "//", "/a//b", "/1", "/a b"])
def test_bad_namespaces(name: str) -> None:
    with pytest.raises(InvalidNamespaceException):
        validate_namespace(name)


@every_case(
    "name", ["a", "/a", "a/b", "~", "~/a", "{node}/a", "/{ns}/a", "a_1", "{foo}_bar", "a/{ping}/b", "{_bar}"]
)
def test_good_topic_names(name: str) -> None:
    assert validate_topic_name(name)
    assert validate_topic_name(name, is_service=True)


@every_case(
    ("name", "place"),
    [
        *(
            ("123abc", 0),
            (" ", 0),
            ("foo bar", 3),
            ("/~", 1),
            ("~foo", 1),
            ("foo~", 3),
            ("foo/~bar", 4),
            ("foo/", 3),
            ("", 0),
        ),
        *(
            ("foo/123bar", 4),
            ("foo/bar}/baz", 7),
            ("foo/{bar", 4),
            ("{$}", 1),
            ("{{bar}_baz}", 1),
            ("foo/{bar/baz}", 8),
        ),
        ("{1foo}", 1),
    ],
)
def test_a_bad_topic_name_is_refused_where_ros_2_refuses_it(name: str, place: int) -> None:
    with pytest.raises(InvalidTopicNameException) as caught:
        validate_topic_name(name)
    assert caught.value.invalid_index == place


@pytest.mark.parametrize("name", ["relative", "/a b", "/a/", "/~"])
def test_a_full_name_is_absolute_and_plain(name: str) -> None:
    with pytest.raises(NameValidationException):
        validate_full_topic_name(name)
    with pytest.raises(NameValidationException):
        validate_full_topic_name(name, is_service=True)


@every_case(
    ("name", "namespace", "full"),
    [
        ("x", "/", "/x"),
        ("x", "/ns", "/ns/x"),
        ("/x", "/ns", "/x"),
        ("~", "/ns", "/ns/me"),
        ("~/x", "/", "/me/x"),
        ("{node}/x", "/ns", "/ns/me/x"),
        ("{ns}", "/my_ns", "/my_ns"),
        ("{namespace}/{node}/chatter", "/my_ns", "/my_ns/me/chatter"),
        ("/foo/{namespace}", "/my_ns", "/foo//my_ns"),  # which no publisher may have
    ],
)
def test_expansion(name: str, namespace: str, full: str) -> None:
    assert expand_topic_name(name, "me", namespace) == full


def test_an_unknown_substitution_is_an_error_of_its_value() -> None:
    with pytest.raises(ValueError, match="unknown substitution"):
        expand_topic_name("chatter/{bad_sub}", "me", "/")


def test_hidden_names() -> None:
    assert topic_or_service_is_hidden("/a/_b")
    assert not topic_or_service_is_hidden("/a/b_")


@pytest.mark.parametrize(
    ("namespace", "full"), [(None, "/n"), ("", "/n"), ("ns", "/ns/n"), ("/ns", "/ns/n"), ("/", "/n")]
)
def test_a_nodes_namespace_needs_no_slash(graph: Graph, namespace: str | None, full: str) -> None:
    assert create_graph_node(graph, "n", namespace).get_fully_qualified_name() == full


@pytest.mark.parametrize(("name", "namespace"), [("bad name", None), ("n", "/bad space"), ("n", "ends/")])
def test_a_node_with_a_bad_name_is_not_made(graph: Graph, name: str, namespace: str | None) -> None:
    with pytest.raises(NameValidationException):
        create_graph_node(graph, name, namespace)
    assert graph.nodes == ()
