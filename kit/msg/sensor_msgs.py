"""Readings of sensors: the interfaces of ROS 2's package sensor_msgs."""

from typing import Annotated, ClassVar

from kit.msg.builtin_interfaces import Time
from kit.msg.fields import (
    AddedIn,
    boolean,
    float32,
    float32_array,
    float64,
    float64_9,
    float64_12,
    float64_array,
    int8,
    int32_array,
    string,
    uint8,
    uint8_array,
    uint16,
    uint32,
    zero,
)
from kit.msg.geometry_msgs import Point32, Quaternion, Transform, Twist, Vector3, Wrench
from kit.msg.message import Message
from kit.msg.std_msgs import Header


class BatteryState(Message):
    POWER_SUPPLY_STATUS_UNKNOWN: ClassVar[uint8] = 0
    POWER_SUPPLY_STATUS_CHARGING: ClassVar[uint8] = 1
    POWER_SUPPLY_STATUS_DISCHARGING: ClassVar[uint8] = 2
    POWER_SUPPLY_STATUS_NOT_CHARGING: ClassVar[uint8] = 3
    POWER_SUPPLY_STATUS_FULL: ClassVar[uint8] = 4
    POWER_SUPPLY_HEALTH_UNKNOWN: ClassVar[uint8] = 0
    POWER_SUPPLY_HEALTH_GOOD: ClassVar[uint8] = 1
    POWER_SUPPLY_HEALTH_OVERHEAT: ClassVar[uint8] = 2
    POWER_SUPPLY_HEALTH_DEAD: ClassVar[uint8] = 3
    POWER_SUPPLY_HEALTH_OVERVOLTAGE: ClassVar[uint8] = 4
    POWER_SUPPLY_HEALTH_UNSPEC_FAILURE: ClassVar[uint8] = 5
    POWER_SUPPLY_HEALTH_COLD: ClassVar[uint8] = 6
    POWER_SUPPLY_HEALTH_WATCHDOG_TIMER_EXPIRE: ClassVar[uint8] = 7
    POWER_SUPPLY_HEALTH_SAFETY_TIMER_EXPIRE: ClassVar[uint8] = 8
    POWER_SUPPLY_TECHNOLOGY_UNKNOWN: ClassVar[uint8] = 0
    POWER_SUPPLY_TECHNOLOGY_NIMH: ClassVar[uint8] = 1
    POWER_SUPPLY_TECHNOLOGY_LION: ClassVar[uint8] = 2
    POWER_SUPPLY_TECHNOLOGY_LIPO: ClassVar[uint8] = 3
    POWER_SUPPLY_TECHNOLOGY_LIFE: ClassVar[uint8] = 4
    POWER_SUPPLY_TECHNOLOGY_NICD: ClassVar[uint8] = 5
    POWER_SUPPLY_TECHNOLOGY_LIMN: ClassVar[uint8] = 6
    POWER_SUPPLY_TECHNOLOGY_TERNARY: ClassVar[uint8] = 7
    POWER_SUPPLY_TECHNOLOGY_VRLA: ClassVar[uint8] = 8

    header: Header = zero
    voltage: float32 = zero
    temperature: float32 = zero
    current: float32 = zero
    charge: float32 = zero
    capacity: float32 = zero
    design_capacity: float32 = zero
    percentage: float32 = zero
    power_supply_status: uint8 = zero
    power_supply_health: uint8 = zero
    power_supply_technology: uint8 = zero
    present: boolean = zero
    cell_voltage: float32_array = zero
    cell_temperature: float32_array = zero
    location: string = zero
    serial_number: string = zero


class RegionOfInterest(Message):
    x_offset: uint32 = zero
    y_offset: uint32 = zero
    height: uint32 = zero
    width: uint32 = zero
    do_rectify: boolean = zero


class CameraInfo(Message):
    header: Header = zero
    height: uint32 = zero
    width: uint32 = zero
    distortion_model: string = zero
    d: float64_array = zero
    k: float64_9 = zero
    r: float64_9 = zero
    p: float64_12 = zero
    binning_x: uint32 = zero
    binning_y: uint32 = zero
    roi: RegionOfInterest = zero


class ChannelFloat32(Message):
    name: string = zero
    values: float32_array = zero


class CompressedImage(Message):
    header: Header = zero
    format: string = zero
    data: uint8_array = zero


class FluidPressure(Message):
    header: Header = zero
    fluid_pressure: float64 = zero
    variance: float64 = zero


class Illuminance(Message):
    header: Header = zero
    illuminance: float64 = zero
    variance: float64 = zero


class Image(Message):
    header: Header = zero
    height: uint32 = zero
    width: uint32 = zero
    encoding: string = zero
    is_bigendian: uint8 = zero
    step: uint32 = zero
    data: uint8_array = zero


class Imu(Message):
    header: Header = zero
    orientation: Quaternion = zero
    orientation_covariance: float64_9 = zero
    angular_velocity: Vector3 = zero
    angular_velocity_covariance: float64_9 = zero
    linear_acceleration: Vector3 = zero
    linear_acceleration_covariance: float64_9 = zero


class JointState(Message):
    header: Header = zero
    name: list[string] = zero
    position: float64_array = zero
    velocity: float64_array = zero
    effort: float64_array = zero


class Joy(Message):
    header: Header = zero
    axes: float32_array = zero
    buttons: int32_array = zero


class JoyFeedback(Message):
    TYPE_LED: ClassVar[uint8] = 0
    TYPE_RUMBLE: ClassVar[uint8] = 1
    TYPE_BUZZER: ClassVar[uint8] = 2

    type: uint8 = zero
    id: uint8 = zero
    intensity: float32 = zero


class JoyFeedbackArray(Message):
    array: list[JoyFeedback] = zero


class LaserEcho(Message):
    echoes: float32_array = zero


class LaserScan(Message):
    header: Header = zero
    angle_min: float32 = zero
    angle_max: float32 = zero
    angle_increment: float32 = zero
    time_increment: float32 = zero
    scan_time: float32 = zero
    range_min: float32 = zero
    range_max: float32 = zero
    ranges: float32_array = zero
    intensities: float32_array = zero


class MagneticField(Message):
    header: Header = zero
    magnetic_field: Vector3 = zero
    magnetic_field_covariance: float64_9 = zero


class MultiDOFJointState(Message):
    header: Header = zero
    joint_names: list[string] = zero
    transforms: list[Transform] = zero
    twist: list[Twist] = zero
    wrench: list[Wrench] = zero


class MultiEchoLaserScan(Message):
    header: Header = zero
    angle_min: float32 = zero
    angle_max: float32 = zero
    angle_increment: float32 = zero
    time_increment: float32 = zero
    scan_time: float32 = zero
    range_min: float32 = zero
    range_max: float32 = zero
    ranges: list[LaserEcho] = zero
    intensities: list[LaserEcho] = zero


class NavSatStatus(Message):
    STATUS_UNKNOWN: ClassVar[int8] = -2
    STATUS_NO_FIX: ClassVar[int8] = -1
    STATUS_FIX: ClassVar[int8] = 0
    STATUS_SBAS_FIX: ClassVar[int8] = 1
    STATUS_GBAS_FIX: ClassVar[int8] = 2
    SERVICE_UNKNOWN: ClassVar[uint16] = 0
    SERVICE_GPS: ClassVar[uint16] = 1
    SERVICE_GLONASS: ClassVar[uint16] = 2
    SERVICE_COMPASS: ClassVar[uint16] = 4
    SERVICE_GALILEO: ClassVar[uint16] = 8

    status: int8 = -2
    service: uint16 = zero


class NavSatFix(Message):
    COVARIANCE_TYPE_UNKNOWN: ClassVar[uint8] = 0
    COVARIANCE_TYPE_APPROXIMATED: ClassVar[uint8] = 1
    COVARIANCE_TYPE_DIAGONAL_KNOWN: ClassVar[uint8] = 2
    COVARIANCE_TYPE_KNOWN: ClassVar[uint8] = 3

    header: Header = zero
    status: NavSatStatus = zero
    latitude: float64 = zero
    longitude: float64 = zero
    altitude: float64 = zero
    position_covariance: float64_9 = zero
    position_covariance_type: uint8 = zero


class PointCloud(Message):
    header: Header = zero
    points: list[Point32] = zero
    channels: list[ChannelFloat32] = zero


class PointField(Message):
    INT8: ClassVar[uint8] = 1
    UINT8: ClassVar[uint8] = 2
    INT16: ClassVar[uint8] = 3
    UINT16: ClassVar[uint8] = 4
    INT32: ClassVar[uint8] = 5
    UINT32: ClassVar[uint8] = 6
    FLOAT32: ClassVar[uint8] = 7
    FLOAT64: ClassVar[uint8] = 8

    name: string = zero
    offset: uint32 = zero
    datatype: uint8 = zero
    count: uint32 = zero


class PointCloud2(Message):
    header: Header = zero
    height: uint32 = zero
    width: uint32 = zero
    fields: list[PointField] = zero
    is_bigendian: boolean = zero
    point_step: uint32 = zero
    row_step: uint32 = zero
    data: uint8_array = zero
    is_dense: boolean = zero


class Range(Message):
    ULTRASOUND: ClassVar[uint8] = 0
    INFRARED: ClassVar[uint8] = 1

    header: Header = zero
    radiation_type: uint8 = zero
    field_of_view: float32 = zero
    min_range: float32 = zero
    max_range: float32 = zero
    range: float32 = zero
    variance: Annotated[float32, AddedIn("iron")] = zero


class RelativeHumidity(Message):
    header: Header = zero
    relative_humidity: float64 = zero
    variance: float64 = zero


class Temperature(Message):
    header: Header = zero
    temperature: float64 = zero
    variance: float64 = zero


class TimeReference(Message):
    header: Header = zero
    time_ref: Time = zero
    source: string = zero
