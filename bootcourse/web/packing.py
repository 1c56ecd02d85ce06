"""Numbers, networks and scenarios as text for the scripts: minds.js and road.js read them."""

import base64
import gzip

import numpy as np
import torch

from bootcourse.road.constants import constants
from bootcourse.road.twin import uniforms_needed
from bootcourse.scenario import Scenario
from bootcourse.web.wasm import FREE

EXACT, SHORT = 4, 3  # bytes of a float32 that are kept: all for actors; without the last for critics (error 2^-16)


def packed(data: bytes) -> str:
    """Bytes as compressed text, for `unpack` in minds.js."""
    return base64.b64encode(gzip.compress(data, 9, mtime=0)).decode()


def packed_network(parameters: list[torch.Tensor], member: int, precision: int) -> dict:
    """One network of some that are trained together: the sizes of its layers, and its weights for minds.js.

    The weights are sorted by bytes (all first bytes, all second ...), because those with the exponents compress well.
    """
    arrays = [parameter[member].numpy() for parameter in parameters]
    weights = np.concatenate([array.ravel() for array in arrays]).astype("<f4")
    planes = weights.view(np.uint8).reshape(-1, 4)[:, 4 - precision :].T
    return {"sizes": [len(arrays[0]), *(array.shape[1] for array in arrays[::2])], "weights": packed(planes.tobytes())}


def scenario_data(scenario: Scenario) -> dict:
    """What the page needs of a scenario: the record that the compiled code reads, and what the picture shows."""
    return {
        "record": base64.b64encode(constants(scenario).tobytes()).decode(),
        "vehicles": scenario.vehicles,
        "uniforms": uniforms_needed(scenario.vehicles),
        "observation": scenario.observation_size,
        "lanes": scenario.road.lanes,
        "laneWidth": scenario.road.lane_width,
        "steps": scenario.clock.steps,
        "dt": scenario.clock.dt,
        "decisions": scenario.clock.decisions,
        "length": scenario.car.length,
        "width": scenario.car.width,
        "free": FREE,
    }
