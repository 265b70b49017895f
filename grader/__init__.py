"""The autograder, beside the kit: it runs what a student wrote as a guest in another process, and judges what it saw.

Nothing of a student's is imported, unpickled or collected here. A student's program says actions or rewards; the
world, the seeds, the recordings, the checks and the points are ours.
"""
