from kit.ros.launch.events import Shutdown, matches_action

__all__ = ["Shutdown", "matches_action"]
