from kit.msg.visualization_msgs import (
    ImageMarker,
    InteractiveMarker,
    InteractiveMarkerControl,
    InteractiveMarkerFeedback,
    InteractiveMarkerInit,
    InteractiveMarkerPose,
    InteractiveMarkerUpdate,
    Marker,
    MarkerArray,
    MenuEntry,
    MeshFile,
    UVCoordinate,
)

__all__ = [
    "ImageMarker",
    "InteractiveMarker",
    "InteractiveMarkerControl",
    "InteractiveMarkerFeedback",
    "InteractiveMarkerInit",
    "InteractiveMarkerPose",
    "InteractiveMarkerUpdate",
    "Marker",
    "MarkerArray",
    "MenuEntry",
    "MeshFile",
    "UVCoordinate",
]
