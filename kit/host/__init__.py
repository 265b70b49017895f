"""Floor 4: student code in its own interpreter, always: at the desk, in training and in the grader.

``guest`` has a student's nodes in our graph, ``batch`` calls a student's functions, ``reload`` exchanges a file
while it runs; all of them on ``launcher``, which starts, feeds, limits and ends one child. ``child`` is what
runs there. ``wire`` is what both sides write and read, ``protocol`` what we let a child say; ``confine`` is how
far it is locked in, and ``failure`` what is told when it stops.
"""
