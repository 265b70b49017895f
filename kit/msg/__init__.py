"""ROS 2 message and service classes, without ROS: ``from kit.msg.geometry_msgs import Twist``.

One module per ROS package. They behave as the classes ROS 2 generates for Python, and load neither numpy nor
anything else heavy. ``message`` builds the classes, ``fields`` says what a field can hold, ``interfaces``
finds a class by its ROS name and writes its definition, ``conversion`` turns messages into plain data and back.
"""
