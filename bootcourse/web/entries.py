"""The compiled functions that the page calls, with their types: `wasm.py` compiles them to WebAssembly.

Most are the library's own as they are. `decide` and `rule` work on one road in given memory, since the library's loops
over many roads allocate arrays, which WebAssembly without numba's runtime cannot. All they call is the library's.
"""

import numba
from numba import types

from bootcourse.learn import records
from bootcourse.learn.compiled import update
from bootcourse.learn.compiled_training import advance, begin, demonstrate
from bootcourse.road import twin
from bootcourse.road.constants import constants
from bootcourse.road.formulas import weighted_reward
from bootcourse.road.observation import observe
from bootcourse.road.traffic import look_around, sort_by_x
from bootcourse.rule import decide_rule, track
from bootcourse.scenario import DEFAULT


def decide(cars, action, c, order, around, directions, outcome, trace):
    """One decision on one road, as `twin.decide`: outcome (5,) is r_v, r_y, r_θ, the reward and the accident.

    order (vehicles,), around (lanes, vehicles, 2) and directions (vehicles, 2) are room to work in. trace (steps,
    vehicles, 10) receives the cars after each simulation step, after an accident the last again.
    """
    twin.command(cars, action, c)
    sort_by_x(cars, order)
    accident = twin.NO_ACCIDENT
    for step in range(c.steps):
        if accident == twin.NO_ACCIDENT:
            accident = twin.simulate(cars, order, around, directions, c)
        twin.copy_state(cars, trace[step])
    r_v, r_y, r_theta = twin.reward_terms(cars, c)
    outcome[0], outcome[1], outcome[2], outcome[4] = r_v, r_y, r_theta, accident
    if accident == twin.NO_ACCIDENT:
        outcome[3] = weighted_reward(r_v, r_y, r_theta, c.w_v, c.w_y, c.w_theta)
    else:
        outcome[3] = c.accident


def rule(cars, c, order, around, outcome):
    """The rule on one road, as `rule.drive_rule`: outcome (5,) is its action, speed, lane, distance and reason."""
    sort_by_x(cars, order)
    look_around(cars, order, around, c)
    speed, lane, distance, reason = decide_rule(cars, around, c)
    outcome[0], outcome[1], outcome[2] = track(cars, speed, lane, c), speed, lane
    outcome[3], outcome[4] = distance, reason


def _array(kind, dimensions: int) -> types.Array:
    return types.Array(kind, dimensions, "C")


SCENARIO = numba.from_dtype(constants(DEFAULT).dtype)
REALS, CARS, TRACE = (_array(types.float64, dimensions) for dimensions in (1, 2, 3))
ORDER, AROUND = _array(types.int64, 1), _array(types.int64, 3)

# The records of the learner, by their names in the page. The page makes one of each: see learn_worker.js.
RECORDS = {
    "agent": records.AGENT,
    "batch": records.BATCHES,
    "coefficients": records.COEFFICIENTS,
    "work": records.WORK,
    "plan": records.PLAN,
    "run": records.RUN,
    "memory": records.MEMORY,
    "curves": records.CURVES,
}
AGENT, BATCH, COEFFICIENTS, WORK, PLAN, RUN, MEMORY, CURVES = map(numba.from_dtype, RECORDS.values())

# The name in the page: the function, and the types of its arguments.
ENTRIES = {
    "place": (twin.place.py_func, (REALS, SCENARIO, CARS)),
    "observe": (observe.py_func, (CARS, SCENARIO, _array(types.float32, 1))),
    "decide": (decide, (CARS, types.int64, SCENARIO, ORDER, AROUND, CARS, REALS, TRACE)),
    "rule": (rule, (CARS, SCENARIO, ORDER, AROUND, REALS)),
    "update": (update.py_func, (AGENT, BATCH, COEFFICIENTS, WORK)),
    "begin": (begin.py_func, (AGENT, PLAN, RUN, types.int64, SCENARIO)),
    "demonstrate": (
        demonstrate.py_func,
        (RUN, MEMORY, COEFFICIENTS, PLAN, SCENARIO, types.int64),
    ),
    "advance": (
        advance.py_func,
        (AGENT, BATCH, COEFFICIENTS, WORK, PLAN, RUN, MEMORY, CURVES, SCENARIO, types.int64),
    ),
}
