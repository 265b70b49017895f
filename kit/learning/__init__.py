"""Learning: tasks, environments, training. Importing it registers the environments with Gymnasium."""

import gymnasium

from kit.learning.environment.tasks import HALLWAY, TURN, WHEELCHAIRS

for _id, _class, _task in (
    ("RobotKit/Turn-v0", "TurnEnv", TURN),
    ("RobotKit/Hallway-v0", "HallwayEnv", HALLWAY),
    ("RobotKit/Wheelchairs-v0", "WheelchairsEnv", WHEELCHAIRS),
):
    gymnasium.register(
        _id,
        entry_point=f"kit.learning.environment.env:{_class}",
        vector_entry_point="kit.learning.environment.vector_env:BatchVectorEnv",
        kwargs={"task": _task},
    )
