"""A reward of your own. Its parameters' names say what it is told; take
only those you need:

reached, collided                 True or False
distance, previous_distance       m to the target in a straight line,
                                  after and before the step
to_go, previous_to_go             m to the target along the way
front                             m of room ahead
move, previous_move               what it did: 0 stop, 1 forward, 2 back
                                  (only the perfect learner), 3 left,
                                  4 right
"""


def reward(reached, collided):
    return 0.0
