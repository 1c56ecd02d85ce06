"""bootcourse: a trap on the highway, and how an imperfect driver pulls a learner out of it."""

__version__ = "0.1.0"

try:
    import gymnasium as _gym
except ModuleNotFoundError:  # `bootcourse doctor` says what is missing, and needs nothing else from here
    pass
else:
    _gym.register(
        id="Trap-v0",
        entry_point="bootcourse.road.trap_env:TrapEnv",
        vector_entry_point="bootcourse.road.vector_env:TrapVectorEnv",
    )
