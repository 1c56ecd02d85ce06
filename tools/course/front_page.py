"""The sweep on the book's front page: plain HTML, SVG and script with its data filled in, no kernel and no network."""

import json
from pathlib import Path

import numpy as np

from bootcourse.course.shipped import shipped_results
from bootcourse.learn.settings import settings_for
from bootcourse.methods import DRIVERS, style
from bootcourse.research.report import rule_results
from bootcourse.research.sweep import load_sweep, nearest_setting, settings_run
from bootcourse.scenario import DEFAULT


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


def _rounded(values: np.ndarray, digits: int) -> list:
    return np.round(values.astype(np.float64), digits).tolist()


def fill(folder: Path) -> None:
    """Fill in the data of the sweep's HTML in a folder."""
    path = folder / "sweep.html"
    text = json.dumps(sweep_data(), separators=(",", ":")).replace("<", "\\u003c")
    path.write_text(path.read_text(encoding="utf-8").replace("{{ data }}", text), encoding="utf-8")
