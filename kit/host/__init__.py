"""Floor 4: runs student code in an interpreter of its own, always: interactively, in training and in the grader.

``node_process`` has a student's nodes in the kit's graph, ``student_functions`` calls a student's functions,
``file_watcher`` detects a saved file. They use ``process``, which starts, limits and ends one process; ``child`` is
what runs there, ``sandbox`` confines it. Both sides use ``wire``; ``protocol`` checks what a process sends.
"""
