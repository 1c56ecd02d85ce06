"""What the process that forks the others loads before the first check: the lessons, and the road's compiled code.

On a machine that has not compiled the road yet, the first check that drives does so, instead of each first check.
"""

import numpy as np

from bootcourse.course.lessons import registry
from bootcourse.road.compiled import CACHE_FOLDER
from bootcourse.road.vector_env import TrapVectorEnv

registry()
if CACHE_FOLDER is not None and any(CACHE_FOLDER.rglob("*.nbc")):
    env = TrapVectorEnv(1)
    env.reset(seed=0)
    env.step(np.array([0]))
