"""The picture of a training as it happens."""

from types import SimpleNamespace

import numpy as np

from bootcourse.course.live_curves import LiveWayOut
from bootcourse.statistics import IN_A_ROW


def test_a_line_counts_which_of_the_last_fifty_episodes_ended_ahead_and_a_dot_is_where_an_agent_found_the_way_out():
    success = np.random.default_rng(0).integers(0, 2, (2, 200)).astype(float)
    curves = SimpleNamespace(finished=np.array([120, 70]), values={"success": success})
    looks = {"alone": "#000000", "helped": "#0000FF"}
    trained = {"alone": ("#000000", np.array([110.0, 130.0])), "helped": ("#0000FF", np.array([250.0]))}
    picture = LiveWayOut(looks, trained, "one of three agents")
    above, below = (figure := picture.draw(SimpleNamespace(curves=curves, episodes=200))).axes
    lines = [line for line in above.get_lines() if len(line.get_xdata()) > 2]
    for line, each, finished, name in zip(lines, success, curves.finished, looks, strict=True):
        counted = [each[max(0, last - IN_A_ROW + 1) : last + 1].sum() for last in range(finished)]
        np.testing.assert_array_equal(line.get_ydata(), counted)
        assert f"{counted[-1]:.0f} {name}" in figure.get_suptitle() + figure.texts[0].get_text()
    drawn = np.concatenate([np.asarray(dots.get_offsets()) for dots in below.collections if len(dots.get_offsets())])
    assert sorted(drawn[:, 0]) == [110, 130, 250]
