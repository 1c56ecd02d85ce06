"""The sweep on the book's front page: plain HTML, SVG and script with its data filled in, no kernel and no network."""

import json
from pathlib import Path

import numpy as np

from bootcourse.course.shipped import shipped_experiment, shipped_results
from bootcourse.learn.settings import settings_for
from bootcourse.methods import DRIVERS, style
from bootcourse.research.report import rule_results
from bootcourse.scenario import DEFAULT


def sweep_data() -> dict:
    """Every setting of p, ξ and c that was run, and what each of its agents did."""
    settings, paper = list(shipped_experiment("sweep").values()), settings_for("bootstrapped")
    places = [[each.agents[0][name] for name in ("rule_p", "xi_multiplier", "bonus")] for each in settings]
    rule = rule_results(DEFAULT, shipped_results().sizes[0])
    returns = np.concatenate([each.scores("returns") for each in settings])
    p, xi, c = (sorted(set(values)) for values in zip(*places, strict=True))
    return {
        "p": p,
        "xi": xi,
        "c": c,
        "paper": {"p": paper.rule_p, "xi": paper.xi_multiplier, "c": paper.bonus},
        "settings": [
            {
                **dict(zip(("p", "xi", "c"), place, strict=True)),
                "success": _rounded(each.scores("success"), 3),
                "returns": _rounded(each.scores("returns"), 1),
                "accidents": _rounded(each.scores("accident"), 3),
            }
            for place, each in zip(places, settings, strict=True)
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
