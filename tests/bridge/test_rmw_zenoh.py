"""Keys, tokens and attachments, as rmw_zenoh_cpp's sources write them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit.bridge.rmw_zenoh import (
    Attachment,
    EntityKind,
    WireEndpoint,
    data_key,
    dds_type_name,
    encode_qos,
    endpoint_token,
    make_gid,
    node_token,
    parse_token,
    ros_type_name,
)
from kit.ros.node.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from kit.ros.serialization import Serializer
from tests.cases import every_case

STRING = "std_msgs/msg/String"


def test_the_key_of_a_topic() -> None:
    from kit.msg.std_msgs import String

    known = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
    assert Serializer().type_hash(String) == known
    assert data_key(2, "/a/chatter", STRING, known) == f"2/a/chatter/std_msgs::msg::dds_::String_/{known}"
    assert (
        ros_type_name(dds_type_name("example_interfaces/srv/AddTwoInts"))
        == "example_interfaces/srv/AddTwoInts"
    )
    for wrong in ("std_msgs/msg/String", "std_msgs::msg::String", "std_msgs::msg::dds_::String", ""):
        with pytest.raises(ValueError, match="no type of ROS"):
            ros_type_name(wrong)


def test_tokens_name_node_topic_type_and_quality() -> None:
    assert node_token(0, "aac3178e", 0, "/talker") == "@ros2_lv/0/aac3178e/0/0/NN/%/%/talker"
    endpoint = WireEndpoint(EntityKind.PUBLISHER, "/left/arm/talker", "/left/chatter", STRING, "RIHS01_df66")
    token = endpoint_token(3, "aac3178e", 0, 10, endpoint, QoSProfile(depth=7))
    assert token == (
        "@ros2_lv/3/aac3178e/0/10/MP/%/%left%arm/talker/%left%chatter/std_msgs::msg::dds_::String_/RIHS01_df66/"
        "::,7:,:,:,,"
    )
    read = parse_token(token)
    assert read is not None
    assert (read.kind, read.node, read.name, read.type_name, read.qos) == (
        EntityKind.PUBLISHER,
        "/left/arm/talker",
        "/left/chatter",
        STRING,
        "::,7:,:,:,,",
    )


@every_case(
    "token",
    [
        "",
        "@ros2_lv",
        "@ros2_lv/0/a/0/0/NN/%/%/talker",
        "@ros2_lv/0/a/0/1/XX/%/%/n/%t/std_msgs::msg::dds_::String_/h/::,:,:,:,,",
        "@ros2_lv/0/a/0/1/MP/%/%/n/%t/String/h/::,:,:,:,,",
        "@other/0/a/0/1/MP/%/%/n/%t/std_msgs::msg::dds_::String_/h/::,:,:,:,,",
        "@ros2_lv/0/a/0/1/MP/%/%/n/%t/std_msgs::msg::dds_::String_/h/::,:,:,:,,/more",
    ],
)
def test_what_is_no_endpoints_token_is_passed_over(token: str) -> None:
    assert parse_token(token) is None


@pytest.mark.long
@given(st.text(max_size=200))
def test_no_token_breaks_the_reader(token: str) -> None:
    parse_token(token)
    parse_token(f"@ros2_lv/0/a/0/1/MP/%/%/n/{token}")


def test_quality_leaves_out_what_is_usual() -> None:
    assert encode_qos(QoSProfile(depth=42)) == "::,:,:,:,,"
    latched = QoSProfile(
        depth=1,
        reliability=ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL,
    )
    assert encode_qos(latched) == "2:1:,1:,:,:,,"
    assert encode_qos(QoSProfile(history=HistoryPolicy.KEEP_ALL, depth=42)).split(":")[2] == "2,"


def test_an_attachment_is_two_numbers_and_sixteen_bytes_with_their_length() -> None:
    gid = bytes(range(16))
    packed = Attachment(1, 2, gid).pack()
    assert packed == bytes([1, *[0] * 7, 2, *[0] * 7, 16]) + gid
    assert Attachment.unpack(packed) == Attachment(1, 2, gid)
    for wrong in (b"", packed[:-1], packed + b"\0", packed[:16] + b"\x0f" + gid):
        with pytest.raises(ValueError, match="an attachment"):
            Attachment.unpack(wrong)
    assert len(make_gid("a")) == 16
    assert make_gid("a") != make_gid("b")


def test_services_have_the_hashes_of_ros() -> None:
    """The first is printed in rmw_zenoh's documentation; both are what zenoh-ros2-sdk computes."""
    from kit.msg.interfaces import find_service

    known = {
        "example_interfaces/srv/AddTwoInts": "e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a",
        "std_srvs/srv/SetBool": "abe9e4bb6b41b40e6789712c00ec8871923e089af3f667a79992a428cff2da0a",
    }
    for name, digest in known.items():
        assert Serializer().service_type_hash(find_service(name)) == f"RIHS01_{digest}"
