"""Figures of discrete SAC: what the temperature does in the chain's trap."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.course import charts
from bootcourse.methods import style


def leaving(alphas: Sequence[float], leave: Sequence[float]) -> Figure:
    """How probable leaving the chain's trap is by the soft equation, over the temperature."""
    title = "With a small α the agent leaves the trap, with a large one its choice is nearly even"
    named, looks = {"π(leave | trap)": np.array(leave)}, [style("sac")]
    marks = {"both actions alike": 0.5}
    return charts.lines(alphas, named, title, "temperature α", "probability of leaving", "x", marks, (0, 1.05), looks)
