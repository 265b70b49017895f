"""ROS 2's launch system: the elements of launch files, and the service that runs a launch file.

A launch file is code of its author, so it runs in a process of its own. Its requests to start and end processes leave
that process as plain data (``service.Request``), and events of these processes are sent back the same way. So nothing
here starts a process, and the process that does never imports a launch file.
"""
