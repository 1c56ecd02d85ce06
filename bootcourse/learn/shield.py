"""A shield written by hand, for comparison with what is learned: may this action be taken at this distance?

It assumes that every other car keeps its lane and its speed, and asks how hard the ego would have to brake after each
action, and whether it can stay on the road. Shalev-Shwartz et al. (arXiv 1708.06374) give such safe distances for cars
that may brake; here nobody else does. It knows what no learner is told: the cars' size, the lanes, how the ego moves.
"""

import math

import torch
from torch import Tensor

from bootcourse.road.observation import DV_SCALE, DX_SCALE, V_LAT_SCALE, V_LON_SCALE, Y_SCALE
from bootcourse.scenario import DEFAULT, N_ACTIONS

MARGIN = 1.0  # m § beyond the cars' length, and
SIDE = 0.3  # m § beyond their width


def needed_braking(states: Tensor) -> Tensor:
    """How hard the ego must brake after each action, in m/s²: (..., observation) -> (..., 9).

    Each action lasts one second; then the ego steers back. A car is in the way if that path comes within its width. The
    number is infinite if the path hits a car beside the ego, or leaves the road.
    """
    car, ego, road = DEFAULT.car, DEFAULT.ego, DEFAULT.road
    action = torch.arange(N_ACTIONS)
    acceleration, steering = (action // 3 - 1) * ego.acceleration, (action % 3 - 1) * ego.steering  # (9,)
    v, v_lat = states[..., 3, None] * V_LON_SCALE, states[..., 4, None] * V_LAT_SCALE  # (..., 1)
    turn = (v**2 * math.tan(ego.steering) / car.length).clamp(min=1e-6)  # (..., 1) m/s²; of a standing car 0
    sideways = v_lat + turn * torch.sign(steering)  # (..., 9) m/s after the action
    after = (v_lat + sideways) / 2  # (..., 9) m to the right after one second, and
    later = after + sideways * (sideways.abs() / turn).clamp(min=1) / 2  # after steering back
    left, right = torch.minimum(after, later).clamp(max=0), torch.maximum(after, later).clamp(min=0)
    y = states[..., 2, None] * Y_SCALE
    off = (y + left < -road.lane_width / 2) | (y + right > (road.lanes - 0.5) * road.lane_width)  # (..., 9)

    cars = states[..., 6 : DEFAULT.sight.numbers].unflatten(-1, (-1, 5))[..., None, :, :]  # (..., 1, cars, 5)
    presence, dx, dy, dv, dv_lat = cars.unbind(-1)
    dx, dy, dv = dx * DX_SCALE, dy * Y_SCALE, dv * DV_SCALE  # (..., 1, cars)
    near = car.width + SIDE
    in_the_way = (presence > 0) & (dy > left[..., None] - near) & (dy < right[..., None] + near)
    gap = dx + dv - acceleration[:, None] / 2 - car.length - MARGIN  # (..., 9, cars) m after one second
    closing = (acceleration[:, None] - dv).clamp(min=0)  # m/s
    braking = torch.where(gap > 0, closing**2 / (2 * gap.clamp(min=1e-6)), math.inf)
    ahead = dx + dv / 2 > -car.length - MARGIN  # the others see the ego
    return torch.where(off, math.inf, torch.where(in_the_way & ahead, braking, 0.0).amax(-1))
