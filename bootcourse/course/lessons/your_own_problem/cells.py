"""What ships of the study on other problems (`bootcourse/research/elsewhere.py`), and which of it the lesson shows."""

from functools import cache

from bootcourse.research.computed import experiment
from bootcourse.research.elsewhere_claims import Cells

THREE = ("mountain-car", "cartpole", "lander")
TWO = ("cloning", "soft")
BONUSES = {f"c = {c}": f"both, c = {c}" for c in (0, 0.03, 0.1, 0.3, 1)} | {"c = 2": "both"}


@cache
def cells() -> Cells:
    return Cells(experiment("elsewhere"))
