"""The two things to do on the book's front page, without a kernel: explore the sweep, watch a trained agent decide.

Each is one HTML file of book/front with its data filled in: plain HTML, SVG and script, no network.
"""

import json
from pathlib import Path

import numpy as np

from bootcourse.colours import TRAFFIC, TRAP
from bootcourse.course.shipped import shipped_drive, shipped_results
from bootcourse.learn.settings import settings_for
from bootcourse.methods import DRIVERS, style
from bootcourse.research.report import rule_results
from bootcourse.research.sweep import load_sweep, nearest_setting, settings_run
from bootcourse.road.state import EGO, HEADING, SPEED, TRAP_1, TRAP_2, X, Y
from bootcourse.scenario import ACTION_NAMES, DEFAULT

PACE = 6  # s of the drive in a second


def sweep_data() -> dict:
    """Every setting of p, ξ and c that was run, and what each of its agents did."""
    sweep, paper = load_sweep(), settings_for("bootstrapped")
    settings = [nearest_setting(sweep, *setting) for setting in settings_run(sweep)]
    rule = rule_results(DEFAULT, shipped_results().sizes[0])
    returns = sweep.scores("returns")
    return {
        "p": sorted({each.p for each in settings}),
        "xi": sorted({each.xi_multiplier for each in settings}),
        "c": sorted({each.c for each in settings}),
        "paper": {"p": paper.rule_p, "xi": paper.xi_multiplier, "c": paper.bonus},
        "settings": [
            {
                "p": each.p,
                "xi": each.xi_multiplier,
                "c": each.c,
                "success": _rounded(each.results.scores("success"), 3),
                "returns": _rounded(each.results.scores("returns"), 1),
                "accidents": _rounded(each.results.scores("accident"), 3),
            }
            for each in settings
        ],
        "low": 10 * int(np.floor(returns.min() / 10)),
        "high": 10 * int(np.ceil(returns.max() / 10)),
        "rule": round(float(rule.scores("returns")[0]), 1),
        "rule_colour": DRIVERS["rule"][1].colour,
        "colour": style("bootstrapped").colour,
    }


def drive_data() -> dict:
    """The escape that ships: the cars at every simulation step, the policy and the rule at every decision."""
    drive = shipped_drive("escape")
    scenario, cars = drive.scenario, drive.states[:, :, [X, Y, HEADING]]
    colours = [TRAFFIC] * scenario.vehicles
    colours[TRAP_1] = colours[TRAP_2] = TRAP
    colours[EGO] = style(drive.label).colour
    return {
        "states": _rounded(cars, 2),
        "speeds": _rounded(drive.states[:, EGO, SPEED], 1),
        "policy": _rounded(drive.policy, 3),
        "rule": drive.rule_actions.tolist(),
        "actions": list(ACTION_NAMES),
        "colours": colours,
        "colour": colours[EGO],
        "steps": scenario.clock.steps,
        "dt": scenario.clock.dt,
        "pace": PACE,
        "lanes": scenario.road.lanes,
        "lane": scenario.road.lane_width,
        "length": scenario.car.length,
        "width": scenario.car.width,
    }


def _rounded(values: np.ndarray, digits: int) -> list:
    return np.round(values.astype(np.float64), digits).tolist()


def fill(folder: Path) -> None:
    """Fill in the data of both files in a folder."""
    for name, data in (("sweep", sweep_data()), ("drive", drive_data())):
        path = folder / f"{name}.html"
        text = json.dumps(data, separators=(",", ":")).replace("<", "\\u003c")
        path.write_text(path.read_text(encoding="utf-8").replace("{{ data }}", text), encoding="utf-8")
