"""ROS 2's launch system: what a launch file is made of, and the run of one.

A launch file is a program of its author's. It is run in a process of its own; what it wants started, said and
ended leaves that process as plain data (``service.Request``), and what became of it comes back the same way. So
nothing here starts anything, and whoever does never imports a launch file.
"""
