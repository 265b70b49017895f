"""Shapes to draw: the interfaces of ROS 2's package visualization_msgs."""

from typing import ClassVar

from kit.msg.builtin_interfaces import Duration
from kit.msg.fields import boolean, float32, int32, string, uint8, uint8_array, uint32, uint64, zero
from kit.msg.geometry_msgs import Point, Pose, Quaternion, Vector3
from kit.msg.message import Message
from kit.msg.sensor_msgs import CompressedImage
from kit.msg.std_msgs import ColorRGBA, Header


class ImageMarker(Message):
    CIRCLE: ClassVar[int32] = 0
    LINE_STRIP: ClassVar[int32] = 1
    LINE_LIST: ClassVar[int32] = 2
    POLYGON: ClassVar[int32] = 3
    POINTS: ClassVar[int32] = 4
    ADD: ClassVar[int32] = 0
    REMOVE: ClassVar[int32] = 1

    header: Header = zero
    ns: string = zero
    id: int32 = zero
    type: int32 = zero
    action: int32 = zero
    position: Point = zero
    scale: float32 = zero
    outline_color: ColorRGBA = zero
    filled: uint8 = zero
    fill_color: ColorRGBA = zero
    lifetime: Duration = zero
    points: list[Point] = zero
    outline_colors: list[ColorRGBA] = zero


class MenuEntry(Message):
    FEEDBACK: ClassVar[uint8] = 0
    ROSRUN: ClassVar[uint8] = 1
    ROSLAUNCH: ClassVar[uint8] = 2

    id: uint32 = zero
    parent_id: uint32 = zero
    title: string = zero
    command: string = zero
    command_type: uint8 = zero


class UVCoordinate(Message):
    u: float32 = zero
    v: float32 = zero


class MeshFile(Message):
    filename: string = zero
    data: uint8_array = zero


class Marker(Message):
    ARROW: ClassVar[int32] = 0
    CUBE: ClassVar[int32] = 1
    SPHERE: ClassVar[int32] = 2
    CYLINDER: ClassVar[int32] = 3
    LINE_STRIP: ClassVar[int32] = 4
    LINE_LIST: ClassVar[int32] = 5
    CUBE_LIST: ClassVar[int32] = 6
    SPHERE_LIST: ClassVar[int32] = 7
    POINTS: ClassVar[int32] = 8
    TEXT_VIEW_FACING: ClassVar[int32] = 9
    MESH_RESOURCE: ClassVar[int32] = 10
    TRIANGLE_LIST: ClassVar[int32] = 11
    ARROW_STRIP: ClassVar[int32] = 12
    ADD: ClassVar[int32] = 0
    MODIFY: ClassVar[int32] = 0
    DELETE: ClassVar[int32] = 2
    DELETEALL: ClassVar[int32] = 3

    header: Header = zero
    ns: string = zero
    id: int32 = zero
    type: int32 = zero
    action: int32 = zero
    pose: Pose = zero
    scale: Vector3 = zero
    color: ColorRGBA = zero
    lifetime: Duration = zero
    frame_locked: boolean = zero
    points: list[Point] = zero
    colors: list[ColorRGBA] = zero
    texture_resource: string = zero
    texture: CompressedImage = zero
    uv_coordinates: list[UVCoordinate] = zero
    text: string = zero
    mesh_resource: string = zero
    mesh_file: MeshFile = zero
    mesh_use_embedded_materials: boolean = zero


class InteractiveMarkerControl(Message):
    INHERIT: ClassVar[uint8] = 0
    FIXED: ClassVar[uint8] = 1
    VIEW_FACING: ClassVar[uint8] = 2
    NONE: ClassVar[uint8] = 0
    MENU: ClassVar[uint8] = 1
    BUTTON: ClassVar[uint8] = 2
    MOVE_AXIS: ClassVar[uint8] = 3
    MOVE_PLANE: ClassVar[uint8] = 4
    ROTATE_AXIS: ClassVar[uint8] = 5
    MOVE_ROTATE: ClassVar[uint8] = 6
    MOVE_3D: ClassVar[uint8] = 7
    ROTATE_3D: ClassVar[uint8] = 8
    MOVE_ROTATE_3D: ClassVar[uint8] = 9

    name: string = zero
    orientation: Quaternion = zero
    orientation_mode: uint8 = zero
    interaction_mode: uint8 = zero
    always_visible: boolean = zero
    markers: list[Marker] = zero
    independent_marker_orientation: boolean = zero
    description: string = zero


class InteractiveMarker(Message):
    header: Header = zero
    pose: Pose = zero
    name: string = zero
    description: string = zero
    scale: float32 = zero
    menu_entries: list[MenuEntry] = zero
    controls: list[InteractiveMarkerControl] = zero


class InteractiveMarkerFeedback(Message):
    KEEP_ALIVE: ClassVar[uint8] = 0
    POSE_UPDATE: ClassVar[uint8] = 1
    MENU_SELECT: ClassVar[uint8] = 2
    BUTTON_CLICK: ClassVar[uint8] = 3
    MOUSE_DOWN: ClassVar[uint8] = 4
    MOUSE_UP: ClassVar[uint8] = 5

    header: Header = zero
    client_id: string = zero
    marker_name: string = zero
    control_name: string = zero
    event_type: uint8 = zero
    pose: Pose = zero
    menu_entry_id: uint32 = zero
    mouse_point: Point = zero
    mouse_point_valid: boolean = zero


class InteractiveMarkerInit(Message):
    server_id: string = zero
    seq_num: uint64 = zero
    markers: list[InteractiveMarker] = zero


class InteractiveMarkerPose(Message):
    header: Header = zero
    pose: Pose = zero
    name: string = zero


class InteractiveMarkerUpdate(Message):
    KEEP_ALIVE: ClassVar[uint8] = 0
    UPDATE: ClassVar[uint8] = 1

    server_id: string = zero
    seq_num: uint64 = zero
    type: uint8 = zero
    markers: list[InteractiveMarker] = zero
    poses: list[InteractiveMarkerPose] = zero
    erases: list[string] = zero


class MarkerArray(Message):
    markers: list[Marker] = zero
