"""The numbers of a scenario in the flat form that compiled code reads."""

from functools import lru_cache
from typing import NamedTuple

from bootcourse.scenario import Scenario


class Constants(NamedTuple):
    """Units and sources stand beside the fields of `bootcourse.scenario`."""

    lanes: int
    lane_width: float
    road_length: float
    speed_limit: float
    steps: int
    dt: float
    length: float
    width: float
    ego_speed: float
    max_speed: float
    min_speed: float
    ego_acceleration: float
    ego_steering: float
    trap_speed: float
    d1_low: float
    d1_high: float
    d2_low: float
    d2_high: float
    lead: float
    headway: float
    spacing_low: float
    spacing_high: float
    speed_low: float
    speed_high: float
    desired_speed: float
    a_max: float
    b: float
    s0: float
    time_gap: float
    delta: float
    politeness: float
    a_threshold: float
    safe_braking: float
    lane_change_delay: float
    braking_limit: float
    tau_heading: float
    tau_lateral: float
    w_v: float
    w_y: float
    w_theta: float
    accident: float
    neighbours: int
    sight: float
    rule_v_min: float
    rule_v_max: float
    rule_n: int
    t_safe: float
    floor: float


@lru_cache(maxsize=64)
def constants(scenario: Scenario) -> Constants:
    """The compiled road's view of a scenario."""
    s, t = scenario, scenario.traffic
    return Constants(
        lanes=s.road.lanes,
        lane_width=float(s.road.lane_width),
        road_length=float(s.road.length),
        speed_limit=float(s.road.speed_limit),
        steps=s.clock.steps,
        dt=s.clock.dt,
        length=float(s.car.length),
        width=float(s.car.width),
        ego_speed=float(s.ego.speed),
        max_speed=float(s.ego.max_speed),
        min_speed=float(s.ego.min_speed),
        ego_acceleration=float(s.ego.acceleration),
        ego_steering=float(s.ego.steering),
        trap_speed=float(s.traps.speed),
        d1_low=float(s.traps.d1[0]),
        d1_high=float(s.traps.d1[1]),
        d2_low=float(s.traps.d2[0]),
        d2_high=float(s.traps.d2[1]),
        lead=float(t.lead),
        headway=float(t.headway),
        spacing_low=float(t.spacing[0]),
        spacing_high=float(t.spacing[1]),
        speed_low=float(t.speed[0]),
        speed_high=float(t.speed[1]),
        desired_speed=float(t.desired_speed),
        a_max=float(t.a_max),
        b=float(t.b),
        s0=float(t.s0),
        time_gap=float(t.time_gap),
        delta=float(t.delta),
        politeness=float(t.politeness),
        a_threshold=float(t.a_threshold),
        safe_braking=float(t.safe_braking),
        lane_change_delay=float(t.lane_change_delay),
        braking_limit=float(t.braking_limit),
        tau_heading=float(t.tau_heading),
        tau_lateral=float(t.tau_lateral),
        w_v=float(s.reward.w_v),
        w_y=float(s.reward.w_y),
        w_theta=float(s.reward.w_theta),
        accident=float(s.reward.accident),
        neighbours=s.sight.neighbours,
        sight=float(s.sight.distance),
        rule_v_min=float(s.rule.v_min),
        rule_v_max=float(s.rule.v_max),
        rule_n=s.rule.n,
        t_safe=float(s.rule.t_safe),
        floor=float(s.rule.floor),
    )
