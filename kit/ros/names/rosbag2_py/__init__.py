"""rosbag2_py of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.bag_files import (
    BagMetadata,
    ConverterOptions,
    Info,
    ReadOrderSortBy,
    SequentialReader,
    SequentialWriter,
    StorageFilter,
    StorageOptions,
    TopicInformation,
    TopicMetadata,
    get_default_storage_id,
    get_registered_readers,
    get_registered_writers,
)
from kit.ros.late_names import import_late_name

__all__ = [
    "BagMetadata",
    "ConverterOptions",
    "Info",
    "ReadOrderSortBy",
    "SequentialReader",
    "SequentialWriter",
    "StorageFilter",
    "StorageOptions",
    "TopicInformation",
    "TopicMetadata",
    "get_default_storage_id",
    "get_registered_readers",
    "get_registered_writers",
]

if TYPE_CHECKING:
    CompressionMode: Any
    CompressionOptions: Any
    MessageDefinition: Any
    PlayOptions: Any
    Player: Any
    ReadOrder: Any
    RecordOptions: Any
    Recorder: Any
    Reindexer: Any
    SequentialCompressionReader: Any
    SequentialCompressionWriter: Any
    bag_rewrite: Any
else:
    _LATE_NAMES = {
        "CompressionMode": "!compressed bags",
        "CompressionOptions": "!compressed bags",
        "MessageDefinition": "!definitions by hand; a bag holds those of its topics",
        "PlayOptions": "!a player of bags; `ros2 bag play` is one",
        "Player": "!a player of bags; `ros2 bag play` is one",
        "ReadOrder": "!another order than that of time",
        "RecordOptions": "!a recorder of a whole graph; `ros2 bag record` is one",
        "Recorder": "!a recorder of a whole graph; `ros2 bag record` is one",
        "Reindexer": "!nothing: bags are repaired when they are read",
        "SequentialCompressionReader": "!compressed bags",
        "SequentialCompressionWriter": "!compressed bags",
        "bag_rewrite": "!bags made of others",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
