"""rclpy.type_support of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.exceptions import NoTypeSupportImportedException as NoTypeSupportImportedException
    from kit.ros.type_support import (
        Msg as Msg,
        MsgT as MsgT,
        Srv as Srv,
        SrvEventT as SrvEventT,
        SrvRequestT as SrvRequestT,
        SrvResponseT as SrvResponseT,
        SrvT as SrvT,
        check_for_type_support as check_for_type_support,
        check_is_valid_msg_type as check_is_valid_msg_type,
        check_is_valid_srv_type as check_is_valid_srv_type,
    )
    CommonMsgSrvMetaClass: Any
    MsgMetaClass: Any
    ProtocolType: Any
    PyCapsule: Any
else:
    _LATE_NAMES = {
        "CommonMsgSrvMetaClass": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "Msg": "kit.ros.type_support:Msg",
        "MsgMetaClass": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "MsgT": "kit.ros.type_support:MsgT",
        "NoTypeSupportImportedException": "kit.ros.exceptions:NoTypeSupportImportedException",
        "ProtocolType": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "PyCapsule": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "Srv": "kit.ros.type_support:Srv",
        "SrvEventT": "kit.ros.type_support:SrvEventT",
        "SrvRequestT": "kit.ros.type_support:SrvRequestT",
        "SrvResponseT": "kit.ros.type_support:SrvResponseT",
        "SrvT": "kit.ros.type_support:SrvT",
        "check_for_type_support": "kit.ros.type_support:check_for_type_support",
        "check_is_valid_msg_type": "kit.ros.type_support:check_is_valid_msg_type",
        "check_is_valid_srv_type": "kit.ros.type_support:check_is_valid_srv_type",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
