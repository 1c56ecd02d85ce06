"""Two ways to reach a lane with three steering angles: the nearest angle, and a search."""

import itertools

import numpy as np

from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.policies import PolicyOutput
from bootcourse.road.formulas import lane_keeping_steering
from bootcourse.road.state import EGO, HEADING, SPEED, Accident, Y
from bootcourse.rule import EDGE_COST, HEADING_COST, rule
from bootcourse.scenario import DEFAULT


def nearest_action(tau: float):
    """A driver with the rule's wishes, and of the three steering angles the one nearest to the smooth one."""

    def drive(observations, cars):
        wanted = rule(cars, DEFAULT)
        actions = wanted.actions // 3 * 3  # the rule's brake, keep or accelerate
        for i, car in enumerate(cars[:, EGO]):
            offset = car[Y] - wanted.lanes[i] * DEFAULT.road.lane_width
            smooth = lane_keeping_steering(offset, car[HEADING], car[SPEED], DEFAULT.car.length, 3 * tau, tau)
            actions[i] += 1 + int(np.clip(np.rint(smooth / DEFAULT.ego.steering), -1, 1))
        return PolicyOutput(actions)

    return drive


def plan_costs(y, heading, v, goal, depth):
    """The cost of every steering sequence on each road: arrays (roads,) -> (roads, 3, ..., 3)."""
    plans = np.array(list(itertools.product((-1, 0, 1), repeat=depth)))
    y, heading, v, goal = (part[:, None] + np.zeros(len(plans)) for part in (y, heading, v, goal))
    cost, dt, edges = np.zeros_like(y), DEFAULT.clock.dt, (-2, 10)
    for steer in plans.T:
        slip = np.arctan(0.5 * np.tan(steer * DEFAULT.ego.steering))
        for _ in range(DEFAULT.clock.steps):
            y = y + v * np.sin(heading + slip) * dt
            heading = heading + v * np.sin(slip) / (DEFAULT.car.length / 2) * dt
        cost += (y - goal) ** 2 + HEADING_COST * heading**2 + EDGE_COST * ((y < edges[0]) | (y > edges[1]))
    return cost.reshape(-1, *[3] * depth)


def looks_ahead(depth: int):
    """A driver with the rule's wishes that does the first step of the cheapest steering sequence."""

    def drive(observations, cars):
        wanted, ego = rule(cars, DEFAULT), cars[:, EGO]
        goal = wanted.lanes * DEFAULT.road.lane_width
        costs = plan_costs(ego[:, Y], ego[:, HEADING], ego[:, SPEED], goal, depth)
        first = costs.reshape(len(costs), 3, -1).min(-1).argmin(-1)
        return PolicyOutput(wanted.actions // 3 * 3 + first)

    return drive


def in_short(driver, roads: int = 200) -> list[str]:
    """How a driver does on held-out roads: shares that escape, leave the road, collide."""
    episodes = drive_episodes(driver, held_out_seeds(1, roads))
    kinds = (Accident.ROAD_DEPARTURE, Accident.COLLISION)
    shares = [episodes.success.mean(), *(np.mean(episodes.accident == kind) for kind in kinds)]
    return [f"{share:.1%}" for share in shares]
