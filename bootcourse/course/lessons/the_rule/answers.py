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
    at most 60 m: min(60.0, max(floor, (v_ego - min(v_current, v_new)) * t_safe))
    the mean of both cars: max(floor, (v_ego - (v_current + v_new) / 2) * t_safe)
""")

right_lines("""target_speed
    by a mask: grid = np.linspace(v_min, v_max, n)
        slow = (grid < v_current) & (grid < v_new)
        np.max(grid, where=slow, initial=v_min)
    searched: grid = np.linspace(v_min, v_max, n)
        grid[max(np.searchsorted(grid, min(v_current, v_new)) - 1, 0)]
    a generator: grid = (v_min + i * (v_max - v_min) / (n - 1) for i in range(n))
        max((v for v in grid if v < v_current and v < v_new), default=v_min)
    counted down: step = (v_max - v_min) / (n - 1)
        for i in reversed(range(n)):
            if v_min + i * step < min(v_current, v_new):
                return v_min + i * step
        v_min
""")

wrong_lines("""target_speed
    equal in the new lane: max([v for v in np.linspace(v_min, v_max, n) if v < v_current and v <= v_new], default=v_min)
    nothing is left: max([v for v in np.linspace(v_min, v_max, n) if v < min(v_current, v_new)], default=np.nan)  # NaN
    at least 2 cm/s slower: limit = min(v_current, v_new) - 0.02
        max([v for v in np.linspace(v_min, v_max, n) if v < limit], default=v_min)
    almost as fast: limit = min(v_current, v_new) + 5e-4
        max([v for v in np.linspace(v_min, v_max, n) if v < limit - 4e-4], default=v_min)
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
    what is too much is positive: ahead, behind = dx_front - length - d_s, dx_rear - length - floor
        min(ahead, behind, behind + floor - t_safe * (v_rear - v_ego)) > 0
    arrays of no axis: behind = np.maximum(floor, np.subtract(v_rear, v_ego) * t_safe)
        np.array(dx_front - length > d_s) & np.array(dx_rear - length > behind)
""")

wrong_lines("""room_to_change
    the same distance behind: dx_front - length > d_s and dx_rear - length > d_s
    a slower car behind does not count:
        behind = v_rear <= v_ego or dx_rear - length > max(floor, (v_rear - v_ego) * t_safe)
        dx_front - length > d_s and behind
    a centimetre more ahead: solution(dx_front, dx_rear, length, d_s + 0.01, v_ego, v_rear, t_safe, floor)
    a centimetre less behind: solution(dx_front, dx_rear + 0.01, length, d_s, v_ego, v_rear, t_safe, floor)
    both answers: dx_front - length > d_s, dx_rear - length > max(floor, (v_rear - v_ego) * t_safe)  # a number
""")
