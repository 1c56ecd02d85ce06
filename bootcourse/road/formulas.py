"""The road's formulas: one compiled scalar function each, also callable from Python with plain numbers.

The traffic's formulas follow highway-env (`IDMVehicle`, `ControlledVehicle`, `Vehicle`); tests compare the two.
Units: metres, seconds, radians.
"""

import math

from bootcourse.road.compiled import compiled

EPSILON = 1e-2  # highway-env keeps divisors this far from zero
MAX_STEERING = math.pi / 3  # rad, highway-env's limit of the front wheels' angle


@compiled
def clip(value, low, high):
    """The value limited to [low, high]."""
    return min(max(value, low), high)


@compiled
def not_zero(value):
    """The value if |value| > 0.01, otherwise ±0.01: a safe divisor, as in highway-env."""
    if abs(value) > EPSILON:
        return value
    return EPSILON if value >= 0 else -EPSILON


@compiled
def wrap_to_pi(angle):
    """The same angle in [-π, π)."""
    if -math.pi <= angle < math.pi:
        return angle  # skips the modulo, which costs as much as the rest of the lane controller
    return (angle + math.pi) % (2 * math.pi) - math.pi


@compiled
def power(base, exponent):
    """base ** exponent; the IDM's usual exponent 4 is computed by squaring, which is many times faster."""
    return (base * base) ** 2 if exponent == 4.0 else base**exponent


@compiled
def desired_gap(v, dv, s0, time_gap, a_max, b):
    """s* of the IDM (Equation 4): the desired gap (m) at speed v with closing speed dv (m/s).

    s* = s0 + T v + v Δv / (2 √(a_max b))
    """
    return s0 + v * time_gap + v * dv / (2 * math.sqrt(a_max * b))


@compiled
def idm_acceleration(v, v_desired, gap, s_star, a_max, delta):
    """The Intelligent Driver Model (Equation 3): acceleration (m/s²) at speed v behind a car `gap` metres ahead.

    a = a_max [1 - (v / v_desired)^δ - (s* / s)²]. An infinite gap means that no car is ahead.
    """
    acceleration = a_max * (1 - power(max(v, 0.0) / abs(not_zero(v_desired)), delta))
    if gap < math.inf:
        acceleration -= a_max * (s_star / not_zero(gap)) ** 2
    return acceleration


@compiled
def mobil_incentive(own_gain, new_follower_gain, old_follower_gain, politeness):
    """MOBIL (Equation 5): the incentive of a lane change (m/s²), Δa_ego + p (Δa_rear + Δa_front).

    The gains of the new and the old follower are weighted by the politeness p. A car changes lane if the incentive
    is at least a_threshold.
    """
    return own_gain + politeness * (new_follower_gain + old_follower_gain)


@compiled
def lane_keeping_steering(offset, heading, v, length, tau_lateral, tau_heading):
    """Steering angle (rad) that brings a car back to its lane's centre, as in highway-env's `ControlledVehicle`.

    offset: metres to the right of the centre. tau_lateral, tau_heading: time constants in seconds. The heading alone
    is unstable if dt / tau_heading > 2: 0.5 s / 0.2 s = 2.5 (highway-env's default at 2 Hz); ours is 0.5 s / 0.6 s.
    """
    if offset == 0.0 and heading == 0.0:
        return 0.0
    lateral_speed = -(1 / tau_lateral) * offset
    heading_wanted = clip(math.asin(clip(lateral_speed / not_zero(v), -1.0, 1.0)), -math.pi / 4, math.pi / 4)
    heading_rate = (1 / tau_heading) * wrap_to_pi(heading_wanted - heading)
    slip = math.asin(clip(length / 2 / not_zero(v) * heading_rate, -1.0, 1.0))
    return clip(math.atan(2 * math.tan(slip)), -MAX_STEERING, MAX_STEERING)


@compiled
def direction(heading):
    """(cos, sin) of a heading (rad); both are known without computing for cars that drive straight, which most do."""
    if heading == 0.0:
        return 1.0, 0.0
    return math.cos(heading), math.sin(heading)


@compiled
def bicycle_step(x, y, heading, v, acceleration, steering, length, dt):
    """One Euler step of highway-env's bicycle model; returns the next (x, y, heading, v).

    slip β = arctan(½ tan θ);  ẋ = v cos(ψ + β);  ẏ = v sin(ψ + β);  ψ̇ = v sin β / (length / 2)
    """
    if steering == 0.0 and heading == 0.0:  # most cars drive straight: no sines needed
        return x + v * dt, y, heading, v + acceleration * dt
    slip = math.atan(0.5 * math.tan(steering)) if steering != 0.0 else 0.0
    course = heading + slip
    x += v * math.cos(course) * dt
    y += v * math.sin(course) * dt
    heading += v * math.sin(slip) / (length / 2) * dt
    return x, y, heading, v + acceleration * dt


@compiled
def nearest_lane(y, heading, lanes, lane_width):
    """The number of the lane whose centre is nearest to y (m); on the line between two lanes, the left one."""
    best, best_distance = 0, math.inf
    angle = abs(wrap_to_pi(heading))
    for lane in range(lanes):
        distance = abs(y - lane * lane_width) + angle  # highway-env adds the angle: the rounding must be the same
        if distance < best_distance:
            best, best_distance = lane, distance
    return best


@compiled
def _separated(dx, dy, cos_a, sin_a, cos_b, sin_b, length, width):
    """Whether one of rectangle a's two axes separates it from rectangle b, whose centre is (dx, dy) away."""
    along, across = dx * cos_a + dy * sin_a, -dx * sin_a + dy * cos_a
    cos_ab = abs(cos_a * cos_b + sin_a * sin_b)
    sin_ab = abs(cos_a * sin_b - sin_a * cos_b)
    reach_along = (length + length * cos_ab + width * sin_ab) / 2
    reach_across = (width + length * sin_ab + width * cos_ab) / 2
    return abs(along) > reach_along or abs(across) > reach_across


@compiled
def overlap(x_a, y_a, heading_a, x_b, y_b, heading_b, length, width):
    """Whether two equal rectangles touch, by the separating axis theorem; (x, y) are their centres."""
    dx, dy = x_b - x_a, y_b - y_a
    if dx * dx + dy * dy > length * length + width * width:
        return False
    cos_a, sin_a, cos_b, sin_b = math.cos(heading_a), math.sin(heading_a), math.cos(heading_b), math.sin(heading_b)
    return not (
        _separated(dx, dy, cos_a, sin_a, cos_b, sin_b, length, width)
        or _separated(dx, dy, cos_b, sin_b, cos_a, sin_a, length, width)
    )


@compiled
def speed_reward(v_lon):
    """r_v (Equation 10), v_lon in m/s: 0 up to 5, 0.2 at 12.5, 1 at 15, linear between; above 15 it falls to 0."""
    if v_lon > 15:
        return math.exp(-((v_lon - 15) ** 2))
    if v_lon > 12.5:
        return 8 / 25 * v_lon - 19 / 5
    if v_lon > 5:
        return 2 / 75 * v_lon - 2 / 15
    return 0.0


@compiled
def centring_reward(offset):
    """r_y (Equation 11) = exp(-1.5 d_e²), d_e in metres from the lane's centre."""
    return math.exp(-1.5 * offset**2)


@compiled
def steering_reward(theta):
    """r_θ (Equation 12) = -|sin θ|, θ in radians."""
    return -abs(math.sin(theta))


@compiled
def weighted_reward(r_v, r_y, r_theta, w_v, w_y, w_theta):
    """The reward of a decision without an accident (Equation 9): the weighted mean of r_v, r_y and r_θ."""
    return (w_v * r_v + w_y * r_y + w_theta * r_theta) / (w_v + w_y + w_theta)
