"""Floor 4: student code in its own interpreter, always: at the desk, in training and in the grader.

The parent's side: ``guest`` (a student's nodes in our graph), ``batch`` (a student's functions), ``reload``,
and below them ``launcher``, which starts, feeds, limits and ends one child. The child's side: ``bootstrap``
(the first code to run), ``agent``, ``pump``. Both sides share ``protocol``, ``failure`` and ``limits``; how far
the child is locked in is ``confine``.
"""
