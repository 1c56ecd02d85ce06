"""bootcourse: a trap on the highway, and how an imperfect driver pulls a learner out of it."""

import gymnasium as _gym

__version__ = "0.1.0"

_gym.register(
    id="Trap-v0",
    entry_point="bootcourse.road.trap_env:TrapEnv",
    vector_entry_point="bootcourse.road.vector_env:TrapVectorEnv",
)
