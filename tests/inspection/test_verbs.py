"""What ``kit ros`` prints, word for word as ROS 2's commands do."""

from __future__ import annotations

import re
from pathlib import Path
from textwrap import dedent

import pytest

from kit.cli.ros import ABSENT, VERBS
from kit.msg.std_srvs import SetBool
from kit.ros.node.node import create_graph_node
from kit.ros.node.qos import qos_profile_services_default
from kit.ros.node.service_introspection import ServiceIntrospectionState
from tests.inspection.conftest import Kit, Stage
from tests.waiting import wait_until

NODE_INFO = """\
/demo/talker
  Subscribers:
    /demo/orders: std_msgs/msg/String
  Publishers:
    /demo/chatter: std_msgs/msg/String
    /demo/points: geometry_msgs/msg/PointStamped
    /parameter_events: rcl_interfaces/msg/ParameterEvent
    /rosout: rcl_interfaces/msg/Log
  Service Servers:
    /demo/switch: std_srvs/srv/SetBool
    /demo/talker/describe_parameters: rcl_interfaces/srv/DescribeParameters
    /demo/talker/get_parameter_types: rcl_interfaces/srv/GetParameterTypes
    /demo/talker/get_parameters: rcl_interfaces/srv/GetParameters
    /demo/talker/list_parameters: rcl_interfaces/srv/ListParameters
    /demo/talker/set_parameters: rcl_interfaces/srv/SetParameters
    /demo/talker/set_parameters_atomically: rcl_interfaces/srv/SetParametersAtomically
  Service Clients:

  Action Servers:

  Action Clients:

"""

TOPIC_INFO = """\
Type: std_msgs/msg/String

Publisher count: 1

Node name: talker
Node namespace: /demo
Topic type: std_msgs/msg/String
Topic type hash: RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18
Endpoint type: PUBLISHER
GID: *
QoS profile:
  Reliability: RELIABLE
  History (Depth): KEEP_LAST (10)
  Durability: VOLATILE
  Lifespan: Infinite
  Deadline: Infinite
  Liveliness: AUTOMATIC
  Liveliness lease duration: Infinite

Subscription count: 0

"""

GOLDEN = {
    "node list": "/TeleOpKeys\n/demo/talker\n/flatland_server\n",
    "node list -c": "3\n",
    "node info /demo/talker": NODE_INFO,
    "topic type /demo/chatter": "std_msgs/msg/String\n",
    "topic find std_msgs/msg/String": "/demo/chatter\n/demo/orders\n/teleopkeys\n",
    "topic find std_msgs/msg/String -c": "3\n",
    "topic info /demo/chatter": "Type: std_msgs/msg/String\nPublisher count: 1\nSubscription count: 0\n",
    "topic info /demo/chatter -v": TOPIC_INFO,
    "topic echo /demo/chatter --once": "data: hello\n---\n",
    "topic echo /demo/chatter --once --csv": "hello\n",
    "topic echo /demo/chatter --once --field data": "hello\n---\n",
    "topic echo /demo/chatter --once -l 2": "data: he...\n---\n",
    "topic echo /demo/chatter --once --no-str": "data: '<string length: <5>>'\n---\n",
    "topic echo /demo/points --once --field point": "x: 1.5\ny: 0.0\nz: 0.0\n---\n",
    "topic echo /demo/points --once --field header.frame_id": "map\n---\n",
    "topic echo /demo/points --once --field point --flow-style": "{x: 1.5, y: 0.0, z: 0.0}\n---\n",
    "service type /demo/switch": "std_srvs/srv/SetBool\n",
    "service find std_srvs/srv/SetBool": "/demo/switch\n",
    "service info /demo/switch": "Type: std_srvs/srv/SetBool\nClients count: 0\nServices count: 1\n",
    "service call /demo/switch std_srvs/srv/SetBool {data:\u00a0true}": (
        "requester: making request: std_srvs.srv.SetBool_Request(data=True)\n\n"
        "response:\nstd_srvs.srv.SetBool_Response(success=True, message='on')\n\n"
    ),
    "param list /demo/talker": "  level\n  use_sim_time\n  volume.high\n  words\n",
    "param list /demo/talker --param-type": (
        "  level (type: integer)\n  use_sim_time (type: boolean)\n  volume.high (type: double)\n  words (type: string)\n"
    ),
    "param list --param-prefixes volume": "/TeleOpKeys:\n/demo/talker:\n  volume.high\n/flatland_server:\n",
    "param get /demo/talker volume.high": "Double value is: 0.5\n",
    "param get demo/talker words": "String value is: hello\n",
    "param get /demo/talker level": "Integer value is: 4\n",
    "param get /demo/talker use_sim_time": "Boolean value is: True\n",
    "param get /demo/talker level --hide-type": "4\n",
    "param get /demo/talker nothing": "Parameter not set.\n",
    "param describe /demo/talker level": (
        "Parameter name: level\n  Type: integer\n  Description: how often\n  Constraints:\n"
        "    Min value: 0\n    Max value: 10\n    Step: 2\n"
    ),
    "param dump /demo/talker": (
        "/demo/talker:\n  ros__parameters:\n    level: 4\n    use_sim_time: true\n    volume:\n      high: 0.5\n"
        "    words: hello\n\n"
    ),
    "interface show std_srvs/srv/SetBool --no-comments": "bool data\n---\nbool success\nstring message\n",
    "interface show geometry_msgs/msg/PointStamped --no-comments": (
        "std_msgs/Header header\n\tbuiltin_interfaces/Time stamp\n\t\tint32 sec\n\t\tuint32 nanosec\n"
        "\tstring frame_id\nPoint point\n\tfloat64 x\n\tfloat64 y\n\tfloat64 z\n"
    ),
    "interface proto std_srvs/srv/SetBool": '"data: false\n"\n',
    "interface proto geometry_msgs/msg/Point --no-quotes": "x: 0.0\ny: 0.0\nz: 0.0\n\n",
    "interface package std_srvs": "std_srvs/srv/Empty\nstd_srvs/srv/SetBool\nstd_srvs/srv/Trigger\n",
}


@pytest.mark.parametrize("line", GOLDEN)
def test_a_verb_prints_what_ros2_prints(line: str, kit_ros: Kit) -> None:
    out, err, code = kit_ros(*(word.replace("\u00a0", " ") for word in line.split(" ")))
    assert (re.sub(r"GID: \S+", "GID: *", out), err, code) == (GOLDEN[line], "", 0)


REFUSED = {
    "node info /nobody": ("Unable to find node '/nobody'", 1),
    "topic info /nothing": ("Unknown topic '/nothing'", 1),
    "topic type /nothing": ("", 1),
    "topic echo /nothing": ("Could not determine the type for the passed topic", 1),
    "topic echo /demo/points --once --field point.w": ("Invalid field 'point.w': there is no 'w'", 1),
    "topic pub /x std_msgs/msg/Strin": ("did you mean 'std_msgs/msg/String'?", 1),
    "topic pub /x std_msgs/msg/String {dada:\u00a0a}": (
        "Failed to populate field: std_msgs/msg/String has no field",
        1,
    ),
    "topic pub /x std_msgs/msg/String [1]": ("needs to be a dictionary in YAML format", 1),
    "topic pub /x std_msgs/msg/Int32 {data:\u00a0012}": ("two ways: it is 10 in base eight", 1),
    "topic pub /x std_msgs/msg/Float64 {data:\u00a01:30}": ("the number 90", 1),
    "service call /demo/add example_interfaces/srv/AddTwoInts {a:\u00a01_000}": ("the number 1000", 1),
    "param set /demo/talker level 1_000": ("the number 1000", 1),
    "topic pub /x std_msgs/msg/String {data": ("not YAML", 1),
    "topic pub /9 std_msgs/msg/String --once": ("must not start with a number", 1),
    "topic pub /x geometry_msgs/msg/Vector3 {x:\u00a0.inf} --once -w 0": ("is not a finite number", 1),
    "topic delay /demo/chatter": ("msg does not have header", 1),
    "service info /nothing": ("Unknown service '/nothing'", 1),
    "service call /demo/switch std_srvs/srv/SetBoo": ("did you mean 'std_srvs/srv/SetBool'?", 1),
    "service call /demo/switch std_srvs/srv/SetBool {data:\u00a0maybe}": ("data: needs true or false", 1),
    "param get /nobody level": ("Node not found", 1),
    "param set /demo/talker level 5": ("Setting parameter failed: ", 1),
    "param set /demo/talker level": ("name/value pairs", 1),
    "param set /demo/talker level high": ("expected 'INTEGER' got 'STRING'", 1),
    "param load /demo/talker nowhere.yaml": ("nowhere.yaml", 1),
    "interface show std_msgs/msg/Sting": ("did you mean 'std_msgs/msg/String'?", 1),
    "interface package std_massages": ("Unknown package", 1),
    "topic hzz /demo/chatter": ("Did you mean", 2),
    "node list --world other": ("No running world is named other; running: simple-", 2),
}


@pytest.mark.parametrize("line", REFUSED)
def test_refusals_explain_themselves(line: str, kit_ros: Kit) -> None:
    message, expected = REFUSED[line]
    out, err, code = kit_ros(*(word.replace("\u00a0", " ") for word in line.split(" ")))
    assert message in err
    assert code == expected
    assert "Traceback" not in out + err


def test_lists_show_what_is_asked(kit_ros: Kit) -> None:
    names, _, _ = kit_ros("topic", "list")
    typed, _, _ = kit_ros("topic", "list", "-t")
    counted, _, _ = kit_ros("topic", "list", "-c")
    assert "/demo/chatter" in names.splitlines()
    assert "/demo/chatter [std_msgs/msg/String]" in typed.splitlines()
    assert int(counted) == len(names.splitlines()) == len(typed.splitlines())
    services, _, _ = kit_ros("service", "list", "-t")
    assert "/pause [std_srvs/srv/Empty]" in services.splitlines()
    verbose, _, _ = kit_ros("topic", "list", "-v")
    published, subscribed = verbose.split("Subscribed topics:\n")
    assert published.startswith("Published topics:\n")
    assert " * /demo/chatter [std_msgs/msg/String] 1 publisher\n" in published
    assert " * /demo/orders [std_msgs/msg/String] 1 subscriber\n" in subscribed


def test_interfaces_are_listed_by_kind(kit_ros: Kit) -> None:
    out, _, _ = kit_ros("interface", "list")
    messages, rest = out.split("Services:\n")
    services, actions = rest.split("Actions:\n")
    assert "    geometry_msgs/msg/Twist\n" in messages
    assert "    std_srvs/srv/Trigger\n" in services
    assert "    example_interfaces/action/Fibonacci\n" in actions
    only, _, _ = kit_ros("interface", "list", "-s")
    assert only == "Services:\n" + services
    packages, _, _ = kit_ros("interface", "packages", "-s")
    assert "std_srvs" in packages.split()
    assert "std_msgs" not in packages.split()


def test_what_is_published_is_heard(kit_ros: Kit, stage: Stage) -> None:
    out, err, code = kit_ros("topic", "pub", "--once", "/demo/orders", "std_msgs/msg/String", "data: go")
    assert out == ("publisher: beginning loop\npublishing #1: std_msgs.msg.String(data='go')\n\n")
    assert (err, code) == ("", 0)
    wait_until(lambda: stage.talker.heard[-1:] == ["go"])
    kit_ros("topic", "pub", "-t", "3", "-r", "20", "/demo/orders", "std_msgs/msg/String", "{data: again}")
    wait_until(lambda: stage.talker.heard[-3:] == ["again"] * 3)


def test_stamps_are_filled_in_when_a_message_is_published(kit_ros: Kit, stage: Stage) -> None:
    out, _, _ = kit_ros(
        "topic",
        "pub",
        "--once",
        "-w",
        "0",
        "/p",
        "geometry_msgs/msg/PointStamped",
        "{header: auto, point: {x: 1e-3}}",
    )
    assert "x=0.001" in out
    found = re.search(r"sec=(\d+), nanosec=(\d+)", out)
    assert found is not None
    assert 0 < int(found[1]) + int(found[2]) / 1e9 <= stage.graph.now_ns / 1e9


def test_parameters_are_set_kept_and_loaded(kit_ros: Kit, tmp_path: Path, stage: Stage) -> None:
    node = create_graph_node(stage.graph, "settings")
    node.declare_parameter("a", 1.5)
    node.declare_parameter("b.c", [1, 2])
    dumped, _, _ = kit_ros("param", "dump", "/settings")
    out, _, code = kit_ros("param", "set", "/settings", "a", "2.5")
    assert (out, code, node.get_parameter("a").value) == ("Set parameter successful\n", 0, 2.5)
    kit_ros("param", "set", "/settings", "a", "-2.5")
    assert node.get_parameter("a").value == -2.5
    assert kit_ros("param", "set", "/settings", "--aa", "1")[2] == 2
    out, _, code = kit_ros("param", "set", "/settings", "a", "3.5", "b.c", "[3]")
    assert out == "a: Set parameter successful\nb.c: Set parameter successful\n"
    file = tmp_path / "settings.yaml"
    file.write_text(dumped)
    out, _, code = kit_ros("param", "load", "/settings", str(file))
    assert sorted(out.splitlines()) == [
        "Set parameter a successful",
        "Set parameter b.c successful",
        "Set parameter use_sim_time successful",
    ]
    assert (node.get_parameter("a").value, list(node.get_parameter("b.c").value)) == (1.5, [1, 2])
    _, err, code = kit_ros("param", "load", "/demo/talker", str(file))
    assert code == 1
    assert "/demo/talker" in err
    node.destroy_node()


def test_a_paused_world_answers(kit_ros: Kit, stage: Stage) -> None:
    stage.live.set_paused(True)
    try:
        wait_until(lambda: stage.session.runner.paused)
        before = stage.graph.now_ns
        assert kit_ros("param", "get", "/demo/talker", "level")[0] == "Integer value is: 4\n"
        assert kit_ros("node", "list", "-c")[0] == "3\n"
        kit_ros("topic", "pub", "--once", "/demo/orders", "std_msgs/msg/String", "data: still")
        assert stage.talker.heard[-1] == "still"
        assert stage.graph.now_ns == before
    finally:
        stage.live.set_paused(False)


def test_only_messages_that_are_asked_for_are_shown(kit_ros: Kit) -> None:
    echo = ("topic", "echo", "/demo/points", "--once", "--filter")
    out, _, code = kit_ros(*echo, "m.point.x > 1", "--field", "point.x")
    assert (out, code) == ("1.5\n---\n", 0)
    for wrong, why in (("m.point.", "not a Python expression"), ("m.nothing > 1", "AttributeError")):
        out, err, code = kit_ros(*echo, wrong)
        assert (out, code) == ("", 1)
        assert why in err


def test_verbs_that_are_not_here_say_why(kit_ros: Kit) -> None:
    for verb in ABSENT:
        out, err, code = kit_ros(verb, "list")
        assert (out, code) == ("", 2)
        assert ABSENT[verb].split("\n")[0][:20] in " ".join(err.split())
    assert "checks passed" in kit_ros("doctor")[0]


def test_the_events_of_a_service_are_printed_by_name(kit_ros: Kit, stage: Stage) -> None:
    with stage.graph.lock:
        node = create_graph_node(stage.graph, "introspected")
        service = node.create_service(SetBool, "watched", lambda request, response: response)
        service.configure_introspection(
            node.get_clock(), qos_profile_services_default, ServiceIntrospectionState.CONTENTS
        )
        client = node.create_client(SetBool, "watched")
        node.create_timer(0.1, lambda: client.call_async(SetBool.Request(data=True)))
    try:
        out, err, code = kit_ros("service", "echo", "/watched", "--once")
    finally:
        with stage.graph.lock:
            node.destroy_node()
    assert (err, code) == ("", 0)
    assert re.match(r"info:\n  event_type: (REQUEST_RECEIVED|RESPONSE_SENT)\n  stamp:\n", out)
    assert re.search(r"\nrequest:( \[\]|\n- data: true)\nresponse:", out)
    assert kit_ros("service", "echo", "/nothing")[1:] == ("Unknown service '/nothing'\n", 1)


def test_every_verb_explains_itself(kit_ros: Kit) -> None:
    out, _, code = kit_ros("--help")
    assert code == 0
    for group in VERBS:
        assert f"  {group} " in out
        text, _, code = kit_ros(group, "--help")
        assert code == 0, text
        for verb in re.findall(
            r"^  (\w+) ", text.partition("Commands:")[2].partition("\n\n")[0], re.MULTILINE
        ):
            text, _, code = kit_ros(group, verb, "--help")
            assert code == 0, text
            assert len(dedent(text).splitlines()) > 3
