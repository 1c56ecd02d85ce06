"""Answers to the exercises of the lesson on the rule controller."""

from tests.answers import equivalent, right_lines, wrong_lines

SPEEDS = "speeds = np.linspace"
equivalent("target_speed", f"{SPEEDS}(v_min, v_max, n)  ->  {SPEEDS}(v_max, v_min, n)", "the same speeds, turned round")

right_lines("""safety_distance
    with numpy: np.maximum(floor, t_safe * np.subtract(v_ego, [v_current, v_new]).max())
    the longer of two: distance = max((v_ego - v_current) * t_safe, (v_ego - v_new) * t_safe)
        if distance < floor:
            return floor
        distance
""")

wrong_lines("""safety_distance
    the floor for equal speeds only: distance = (v_ego - min(v_current, v_new)) * t_safe
        distance if distance > 0 else floor
    the mean of both cars: max(floor, (v_ego - (v_current + v_new) / 2) * t_safe)
""")

right_lines("""target_speed
    by a mask: grid = np.linspace(v_min, v_max, n)
        slow = (grid < v_current) & (grid < v_new)
        np.max(grid, where=slow, initial=v_min)
    counted down: step = (v_max - v_min) / (n - 1)
        for i in reversed(range(n)):
            if v_min + i * step < min(v_current, v_new):
                return v_min + i * step
        v_min
""")

wrong_lines("""target_speed
    equal in the new lane: max([v for v in np.linspace(v_min, v_max, n) if v < v_current and v <= v_new], default=v_min)
    nothing is left: max([v for v in np.linspace(v_min, v_max, n) if v < min(v_current, v_new)], default=np.nan)  # NaN
    the nearest: grid = np.linspace(v_min, v_max, n); grid[np.argmin(abs(grid - min(v_current, v_new, 1e6)))]
""")

right_lines("""room_to_change
    lengths on the other side: behind = (v_rear - v_ego) * t_safe
        int(dx_front > d_s + length) * int(dx_rear > (behind if behind > floor else floor) + length)
    two questions:
        if dx_front - length <= d_s:
            return False
        if dx_rear - length <= floor:
            return False
        dx_rear - length > (v_rear - v_ego) * t_safe
""")

wrong_lines("""room_to_change
    the same distance behind: dx_front - length > d_s and dx_rear - length > d_s
    a slower car behind does not count:
        behind = v_rear <= v_ego or dx_rear - length > max(floor, (v_rear - v_ego) * t_safe)
        dx_front - length > d_s and behind
    both answers: dx_front - length > d_s, dx_rear - length > max(floor, (v_rear - v_ego) * t_safe)  # a number
""")
