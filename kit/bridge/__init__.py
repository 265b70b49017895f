"""Floor 4: bridging a running world to ROS 2's wire, so that what drives a robot here drives one elsewhere.

``Bridge`` joins one node of a graph to a ``Wire``, by an allow-list of routes: nothing else leaves or enters. Commands
that move robots pass a ``MotionGuard``: a speed limit, a watchdog, and a stop that lasts until it is lifted.
"""
