from kit.ros.timer import Rate, Timer, TimerInfo

__all__ = ["Rate", "Timer", "TimerInfo"]
