"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
from tools.course.known import rule_drives, shipped_runs


@cache
def demonstrated_q() -> np.ndarray:
    """After training, what the shipped agents with demonstrations only think of the rule's actions, (agents,).

    The mean over the first 20 seconds of the rule's drives on 20 roads.
    """
    drives = rule_drives()[:20]
    seen = np.concatenate([drive.observations[:20] for drive in drives])
    did = np.concatenate([drive.actions[:20] for drive in drives])
    values = [run.agent.q_values(seen) for run in shipped_runs("demos")]
    return np.array([each[np.arange(len(did)), did].mean() for each in values])
