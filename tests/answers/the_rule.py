"""Answers to the exercises of the lesson on the rule controller."""

from bootcourse import rule
from tests.answers import equivalent, right, right_lines, wrong_lines

SPEEDS = "speeds = np.linspace"
equivalent("target_speed", f"{SPEEDS}(v_min, v_max, n)  ->  {SPEEDS}(v_max, v_min, n)", "the same speeds, turned round")

for _name in ("target_speed", "safety_distance"):
    right(_name)(getattr(rule, _name))

right_lines("""safety_distance
    with numpy: np.maximum(floor, t_safe * np.subtract(v_ego, [v_current, v_new]).max())
    for each car: max([floor] + [t_safe * (v_ego - v) for v in (v_current, v_new)])
    the longer of two: distance = max((v_ego - v_current) * t_safe, (v_ego - v_new) * t_safe)
        if distance < floor:
            return floor
        distance
""")

wrong_lines("""safety_distance
    how far they drift apart: drift = (v_ego - min(v_current, v_new)) * t_safe
        drift if drift > floor else max(floor, -drift)  # absolute value
    the scenario's numbers: max(3.0, (v_ego - min(v_current, v_new)) * 1.5)
    the floor for equal speeds only: distance = (v_ego - min(v_current, v_new)) * t_safe
        distance if distance > 0 else floor
    the mean of both cars: max(floor, (v_ego - (v_current + v_new) / 2) * t_safe)
    the own lane: max(floor, (v_ego - v_current) * t_safe)
    the whole way: max(floor, v_ego * t_safe)
    without the time: max(floor, v_ego - min(v_current, v_new))
    the floor above: min(floor, (v_ego - min(v_current, v_new)) * t_safe)
    zero for the floor: max(0.0, (v_ego - min(v_current, v_new)) * t_safe)
""")

right_lines("""target_speed
    by a mask: grid = np.linspace(v_min, v_max, n)
        slow = (grid < v_current) & (grid < v_new)
        np.max(grid, where=slow, initial=v_min)
    by searching the sorted grid: grid = torch.linspace(v_min, v_max, n, dtype=torch.float64)
        place = torch.searchsorted(grid, torch.tensor(min(v_current, v_new), dtype=torch.float64)).item()
        grid[max(place - 1, 0)]
    counted down: step = (v_max - v_min) / (n - 1)
        for i in reversed(range(n)):
            if v_min + i * step < min(v_current, v_new):
                return v_min + i * step
        v_min
""")

wrong_lines("""target_speed
    slower than the new car: max([v for v in np.linspace(v_min, v_max, n) if v < v_new], default=v_min)  # new lane only
    equal in the new lane: max([v for v in np.linspace(v_min, v_max, n) if v < v_current and v <= v_new], default=v_min)
    five speeds: max([v for v in np.linspace(v_min, v_max, 5) if v < min(v_current, v_new)], default=v_min)
    without the fastest: max([v for v in np.linspace(v_min, v_max, n)[:-1] if v < min(v_current, v_new)], default=v_min)
    its number: int(np.sum(np.linspace(v_min, v_max, n) < min(v_current, v_new)))
    equal is allowed: max([v for v in np.linspace(v_min, v_max, n) if v <= min(v_current, v_new)], default=v_min)
        # has to be *slower*
    own lane: max([v for v in np.linspace(v_min, v_max, n) if v < v_current], default=v_min)  # own lane only
    than the faster: max([v for v in np.linspace(v_min, v_max, n) if v < max(v_current, v_new)], default=v_min)
        # slower than *both*
    the slowest: min([v for v in np.linspace(v_min, v_max, n) if v < min(v_current, v_new)], default=v_min)
        # the slowest of the speeds
    n steps: grid = [v_min + i / n * (v_max - v_min) for i in range(n)]
        max([v for v in grid if v < min(v_current, v_new)], default=v_min)  # n - 1 steps
    nothing is left: max([v for v in np.linspace(v_min, v_max, n) if v < min(v_current, v_new)], default=np.nan)  # NaN
    without a default: max([v for v in np.linspace(v_min, v_max, n) if v < min(v_current, v_new)])  # raises an error
    the nearest: grid = np.linspace(v_min, v_max, n); grid[np.argmin(abs(grid - min(v_current, v_new, 1e6)))]
""")

right_lines("""room_to_change
    lengths on the other side: behind = (v_rear - v_ego) * t_safe
        int(dx_front > d_s + length) * int(dx_rear > (behind if behind > floor else floor) + length)
    by the shorter margin: behind = max(floor, (v_rear - v_ego) * t_safe)
        min(dx_front - d_s, dx_rear - behind) > length
    two questions:
        if dx_front - length <= d_s:
            return False
        if dx_rear - length <= floor:
            return False
        dx_rear - length > (v_rear - v_ego) * t_safe
""")

wrong_lines("""room_to_change
    our own numbers: dx_front - 5 > d_s and dx_rear - 5 > max(3.0, (v_rear - v_ego) * 1.5)
    the same distance behind: dx_front - length > d_s and dx_rear - length > d_s
    half a length: half = length / 2
        dx_front - half > d_s and dx_rear - half > max(floor, (v_rear - v_ego) * t_safe)  # half a length
    the floor and the closing distance:
        dx_front - length > d_s and dx_rear - length > floor + max(0.0, (v_rear - v_ego) * t_safe)
    a slower car behind does not count:
        behind = v_rear <= v_ego or dx_rear - length > max(floor, (v_rear - v_ego) * t_safe)
        dx_front - length > d_s and behind
    a length ahead only: dx_front - length > d_s and dx_rear > max(floor, (v_rear - v_ego) * t_safe)
    always: True
    both answers: dx_front - length > d_s, dx_rear - length > max(floor, (v_rear - v_ego) * t_safe)  # a number
""")
