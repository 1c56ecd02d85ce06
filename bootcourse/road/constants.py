"""The numbers of a scenario as a flat numpy record for compiled code.

A record is passed as one pointer; copying a tuple of fifty numbers at every call costs more than the formulas.
"""

from functools import lru_cache

import numpy as np

from bootcourse.scenario import Scenario


@lru_cache(maxsize=64)
def constants(scenario: Scenario) -> np.record:
    """The numbers of a scenario as a record: `constants(s).dt`, `.a_max` ...; units as in `bootcourse.scenario`."""
    s, t = scenario, scenario.traffic
    whole = {"lanes": s.road.lanes, "steps": s.clock.steps, "neighbours": s.sight.neighbours, "rule_n": s.rule.n}
    real = {
        "lane_width": s.road.lane_width,
        "speed_limit": s.road.speed_limit,
        "dt": s.clock.dt,
        "length": s.car.length,
        "width": s.car.width,
        "ego_speed": s.ego.speed,
        "max_speed": s.ego.max_speed,
        "min_speed": s.ego.min_speed,
        "ego_acceleration": s.ego.acceleration,
        "ego_steering": s.ego.steering,
        "trap_speed": s.traps.speed,
        "d1_low": s.traps.d1[0],
        "d1_high": s.traps.d1[1],
        "d2_low": s.traps.d2[0],
        "d2_high": s.traps.d2[1],
        "lead": t.lead,
        "headway": t.headway,
        "spacing_low": t.spacing[0],
        "spacing_high": t.spacing[1],
        "speed_low": t.speed[0],
        "speed_high": t.speed[1],
        "desired_speed": t.desired_speed,
        "a_max": t.a_max,
        "b": t.b,
        "s0": t.s0,
        "time_gap": t.time_gap,
        "delta": t.delta,
        "politeness": t.politeness,
        "a_threshold": t.a_threshold,
        "safe_braking": t.safe_braking,
        "lane_change_delay": t.lane_change_delay,
        "braking_limit": t.braking_limit,
        "tau_heading": t.tau_heading,
        "tau_lateral": t.tau_lateral,
        "w_v": s.reward.w_v,
        "w_y": s.reward.w_y,
        "w_theta": s.reward.w_theta,
        "accident": s.reward.accident,
        "sight": s.sight.distance,
        "rule_v_min": s.rule.v_min,
        "rule_v_max": s.rule.v_max,
        "t_safe": s.rule.t_safe,
        "floor": s.rule.floor,
    }
    dtype = [(name, np.int64) for name in whole] + [(name, np.float64) for name in real]
    return np.rec.array([(*whole.values(), *real.values())], dtype=dtype)[0]
