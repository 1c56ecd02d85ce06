"""The formulas of the road, against numbers worked out by hand."""

import math
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from highway_env.utils import are_polygons_intersecting
from highway_env.vehicle.kinematics import Vehicle

from bootcourse.road import compiled
from bootcourse.road.compiled import PACKAGE, cache_folder, sources
from bootcourse.road.formulas import (
    bicycle_step,
    centring_reward,
    desired_gap,
    idm_acceleration,
    lane_keeping_steering,
    mobil_incentive,
    nearest_lane,
    overlap,
    speed_reward,
    steering_reward,
    weighted_reward,
)

A_MAX, B, S0, TIME_GAP, DESIRED, DELTA = 0.5, 0.5, 10.0, 1.5, 12.5, 4.0  # the table's traffic
LENGTH, WIDTH = 5.0, 2.0


def idm(v, gap, dv=0.0, delta=DELTA):
    return idm_acceleration(v, DESIRED, gap, desired_gap(v, dv, S0, TIME_GAP, A_MAX, B), A_MAX, delta)


# IDM


@pytest.mark.parametrize(
    ("v", "gap", "dv", "acceleration"),
    [
        (0.0, math.inf, 0.0, 0.5),  # from a standstill on a free road: a_max
        (12.5, math.inf, 0.0, 0.0),  # at the desired speed on a free road: nothing
        (10.0, math.inf, 0.0, 0.2952),  # 0.5 (1 - 0.4096)
        (10.0, 25.0, 0.0, -0.2048),  # 0.5 (1 - 0.4096 - 1)
        (10.0, 50.0, 0.0, 0.1702),  # 0.5 (1 - 0.4096 - 0.25)
        (10.0, 45.0, 2.0, -0.2048),  # s* = 45
        (15.0, math.inf, 0.0, -0.5368),  # 0.5 (1 - 1.2^4)
        (-1.0, math.inf, 0.0, 0.5),  # backwards counts as standing
        (10.0, 25 / math.sqrt(0.5904), 0.0, 0.0),  # at equilibrium, 32.536 m
    ],
)
def test_idm_acceleration_worked_by_hand(v, gap, dv, acceleration):
    assert idm(v, gap, dv) == pytest.approx(acceleration, abs=1e-12)


def test_the_gap_that_idm_wants_grows_with_the_speed_and_with_closing_in_and_the_exponent_is_any():
    assert desired_gap(10.0, 0.0, S0, TIME_GAP, A_MAX, B) == 10 + 1.5 * 10
    assert desired_gap(10.0, 2.0, S0, TIME_GAP, A_MAX, B) == pytest.approx(25 + 10 * 2 / (2 * 0.5))
    assert idm(10.0, math.inf, delta=3.7) == pytest.approx(0.5 * (1 - 0.8**3.7))


def test_mobil_weighs_the_others_by_politeness():
    assert mobil_incentive(0.78125, -1.375, 0.1, 0.5) == pytest.approx(0.78125 + 0.5 * (-1.375 + 0.1))
    assert mobil_incentive(0.78125, -1.375, 0.1, 0.0) == 0.78125


# Steering and the bicycle model


def test_lane_keeping_worked_by_hand_for_a_car_one_metre_to_the_right():
    lateral_speed = -1 / 1.8
    heading = math.asin(lateral_speed / 10)
    slip = math.asin(2.5 / 10 * heading / 0.6)
    expected = math.atan(2 * math.tan(slip))
    assert expected < 0 == lane_keeping_steering(0.0, 0.0, 10.0, LENGTH, 1.8, 0.6)
    assert lane_keeping_steering(1.0, 0.0, 10.0, LENGTH, 1.8, 0.6) == pytest.approx(expected, rel=1e-12)
    assert lane_keeping_steering(-1.0, 0.0, 10.0, LENGTH, 1.8, 0.6) == pytest.approx(-expected, rel=1e-12)


def test_one_decision_of_full_steering_at_15_metres_a_second_moves_the_car_1_4_metres_sideways():
    assert bicycle_step(1.0, 4.0, 0.0, 10.0, 1.0, 0.0, LENGTH, 0.5) == (6.0, 4.0, 0.0, 10.5)
    state = (0.0, 0.0, 0.0, 15.0)
    for _ in range(2):
        state = bicycle_step(*state, 0.0, math.pi / 50, LENGTH, 0.5)
    assert state[1] == pytest.approx(1.4, abs=0.5)
    slip = math.atan(0.5 * math.tan(math.pi / 50))
    heading = 15 * math.sin(slip) / 2.5 * 0.5
    assert state[1] == pytest.approx(15 * 0.5 * (math.sin(slip) + math.sin(heading + slip)))


@pytest.mark.parametrize(("y", "lane"), [(-9.0, 0), (0.0, 0), (1.99, 0), (2.0, 0), (2.01, 1), (6.5, 2), (40.0, 2)])
def test_the_nearest_lane_is_the_left_one_on_the_line_and_the_outer_one_beyond_the_edge(y, lane):
    assert nearest_lane(y, 0.0, 3, 4.0) == lane


# Reward


@pytest.mark.parametrize(
    ("v", "r_v"),
    [(0.0, 0.0), (5.0, 0.0), (10.0, 2 / 15), (12.5, 0.2), (13.75, 0.6), (15.0, 1.0), (16.0, math.exp(-1))],
)
def test_the_speed_reward_at_the_papers_corners(v, r_v):
    assert speed_reward(v) == pytest.approx(r_v, abs=1e-15)
    assert v == 16.0 or speed_reward(v + 1e-9) == pytest.approx(r_v, abs=1e-8), "it has no jumps"


def test_the_centring_and_steering_rewards():
    assert centring_reward(0.0) == 1.0
    assert centring_reward(1.0) == centring_reward(-1.0) == pytest.approx(math.exp(-1.5))
    assert steering_reward(0.0) == 0.0
    assert weighted_reward(speed_reward(10.0), 1.0, 0.0, 1.5, 0.05, 0.05) == pytest.approx(0.15625)  # idle in the trap
    assert steering_reward(math.pi / 50) == steering_reward(-math.pi / 50) == pytest.approx(-math.sin(math.pi / 50))


# Overlap


@pytest.mark.parametrize(
    ("dx", "dy", "heading_a", "heading_b", "touch"),
    [
        (0.0, 1.99, 0.0, 0.0, True),  # side by side, 2 m wide each
        (5.01, 0.0, 0.0, 0.0, False),  # nose to tail, 5 m long each
        (3.49, 0.0, 0.0, math.pi / 2, True),  # across the road: 2.5 + 1
        (3.51, 0.0, 0.0, math.pi / 2, False),
        (4.91, 0.0, 0.0, math.pi / 4, True),  # across the rotated car: √2 (1 + (2.5 + 1) / √2) = 4.914
        (4.92, 0.0, 0.0, math.pi / 4, False),
        (3.5, 3.5, math.pi / 4, math.pi / 4, True),  # nose to tail on the diagonal: 4.95 < 5
        (1.5, -1.5, math.pi / 4, math.pi / 4, False),  # side by side on the diagonal: 2.12 > 2
    ],
)
def test_the_overlap_of_rotated_cars_worked_by_hand(dx, dy, heading_a, heading_b, touch):
    a, b = (10.0, 4.0, heading_a), (10.0 + dx, 4.0 + dy, heading_b)
    assert overlap(*a, *b, LENGTH, WIDTH) is touch
    assert overlap(*b, *a, LENGTH, WIDTH) is touch


def test_the_overlap_is_highway_envs_own_polygon_test():
    rng = np.random.default_rng(1)
    touching = 0
    for _ in range(1500):
        (dx, dy), (heading_a, heading_b) = rng.uniform(-5.5, 5.5, 2), rng.uniform(-math.pi, math.pi, 2)
        cars = Vehicle(None, np.zeros(2), heading_a), Vehicle(None, np.array([dx, dy]), heading_b)
        expected = are_polygons_intersecting(cars[0].polygon(), cars[1].polygon(), np.zeros(2), np.zeros(2))[0]
        assert overlap(0.0, 0.0, heading_a, dx, dy, heading_b, LENGTH, WIDTH) == expected
        touching += expected
    assert 300 < touching < 1200, "the comparison must see both answers often"


def test_a_changed_formula_anywhere_in_the_package_is_compiled_again(tmp_path):
    for folder in ("road", "plots"):
        (tmp_path / folder).mkdir()
    files = {
        "road/state.py": "X = 0\n",
        "own_rule.py": "\n@compiled\ndef f(x): return x\n",
        "plots/ink.py": "INK = 0\n",
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    folders = [cache_folder(sources(tmp_path), [tmp_path])]
    for name, text in files.items():
        (tmp_path / name).write_text(text.replace("0", "1").replace("return x", "return -x"))
        folders.append(cache_folder(sources(tmp_path), [tmp_path]))
    assert len(set(folders[:3])) == 3, "a change of the road, or of a compiled function elsewhere, was not noticed"
    assert folders[3] == folders[2], "a drawing's colour had the road compiled again"


def one_more(x):
    return x + 1


def test_a_damaged_file_of_compiled_code_is_compiled_again_and_kept(tmp_path, monkeypatch):
    def hits() -> int:
        """Call the function as a new process would; how many of its versions were found compiled."""
        function = compiled.compiled(one_more)
        assert function(1) == 2
        return sum(function.stats.cache_hits.values())

    monkeypatch.setattr(compiled, "CACHE_FOLDER", tmp_path)
    assert (hits(), hits()) == (0, 1)
    for kind in ("*.nbi", "*.nbc"):
        (file,) = tmp_path.rglob(kind)
        whole = file.read_bytes()
        for damaged in (b"", whole[: len(whole) // 2], bytes(len(whole))):  # as a power cut leaves it
            file.write_bytes(damaged)
            assert (hits(), hits()) == (0, 1), kind


def test_code_that_a_full_disk_cannot_keep_runs_all_the_same(tmp_path, monkeypatch, capsys):
    def full(*arguments):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(compiled, "CACHE_FOLDER", tmp_path)
    monkeypatch.setattr("numba.core.caching.IndexDataCacheFile.save", full)
    assert compiled.compiled(one_more)(1) == 2
    assert "is not kept in" in capsys.readouterr().err


WITHOUT_A_PLACE = """
import os
from pathlib import Path
from bootcourse import doctor
from bootcourse.road.compiled import CACHE_FOLDER
from bootcourse.road.formulas import wrap_to_pi
assert wrap_to_pi(0.5) == 0.5
(finding,) = doctor.cache()
print(finding.level, finding.remedy)
assert list(CACHE_FOLDER.rglob("*.nbc")) and CACHE_FOLDER.parent == Path(os.environ["NUMBA_CACHE_DIR"])
print(oct(CACHE_FOLDER.parent.stat().st_mode)[-3:], CACHE_FOLDER.parent)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="the user's cache is named by XDG_CACHE_HOME")
def test_where_nothing_can_be_kept_the_road_compiles_for_this_process_alone(tmp_path):
    shutil.copytree(PACKAGE, tmp_path / "bootcourse", ignore=shutil.ignore_patterns("__pycache__"))
    in_the_way = tmp_path / "bootcourse" / "__pycache__"
    in_the_way.write_text("a file, where a folder should be")  # stops the superuser too
    home = {"PYTHONPATH": str(tmp_path), "XDG_CACHE_HOME": str(in_the_way), "HOME": str(in_the_way)}
    environment = os.environ | home | {"PYTHONDONTWRITEBYTECODE": "1", "TMPDIR": str(tmp_path)}
    environment.pop("NUMBA_CACHE_DIR", None)
    program = [sys.executable, "-c", WITHOUT_A_PLACE]
    done = subprocess.run(program, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stderr.startswith("Every start compiles the road again") and done.stderr.count("\n") == 1
    assert done.stdout.startswith("note Make one of them writable, or set NUMBA_CACHE_DIR")
    mode, folder = done.stdout.splitlines()[1].split(" ", 1)
    assert mode == "700" and not Path(folder).exists()


def test_every_file_with_a_compiled_function_is_among_those_that_decide():
    compiled = {
        path
        for path in Path(PACKAGE).rglob("*.py")
        if "road.compiled import compiled" in path.read_text(encoding="utf-8")
    }
    assert compiled and compiled <= set(sources(PACKAGE))
