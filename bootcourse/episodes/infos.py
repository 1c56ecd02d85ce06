"""What the environments of a `VectorEnv` report in `info`, read in one place for curves and evaluations.

A quantity that an environment does not report in a step is unknown there, NaN. Success is the exception: many
environments report it only when they succeed, so where any episode reports it, one that does not is no success.
"""

import numpy as np


def reported(name: str, infos: dict, roads: int) -> np.ndarray:
    """What each environment says of the decision just made, (roads,) float; NaN where it says nothing, or no number.

    infos: as `step` returns them, in any autoreset mode. Where an episode has ended and the next has begun in the same
    step, they hold the first info of the new one, and the last of the old one is its "final_info".
    """
    values = _column(name, infos, roads)
    if "final_info" in infos:
        ended = infos["_final_info"]
        values[ended] = _column(name, infos["final_info"], roads)[ended]
    return values


def _column(name: str, infos: dict, roads: int) -> np.ndarray:
    """gymnasium's array of that name where its mask `_name` holds; zeros or None stand elsewhere."""
    given, mask = infos.get(name), infos.get(f"_{name}", True)
    if np.shape(given) != (roads,) or given.dtype.kind not in "biufO":
        return np.full(roads, np.nan)
    if given.dtype.kind == "O":
        given = np.array([each if isinstance(each, (int, float, np.bool_, np.number)) else np.nan for each in given])
    return np.where(mask, given, np.nan).astype(float)


def known_success(reports: np.ndarray) -> np.ndarray:
    """The success of episodes, from what each reported at its end: unknown, NaN, only if none of them reported it."""
    return reports if np.isnan(reports).all() else np.where(np.isnan(reports), 0.0, reports)
