from kit.ros.node.timer import Rate, Timer, TimerInfo

__all__ = ["Rate", "Timer", "TimerInfo"]
