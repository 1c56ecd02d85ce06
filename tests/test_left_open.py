"""What the paper leaves open: each gap is whole, its code exists, and its arithmetic is right."""

import math
import re
from typing import NamedTuple

import numpy as np
import pytest

from bootcourse import rule
from bootcourse.course.shipped import shipped_experiment, shipped_results
from bootcourse.learn.settings import Settings
from bootcourse.methods import METHODS
from bootcourse.research.experiments.clocks import choices
from bootcourse.research.paper import EPISODES, PRINTED, earned_at
from bootcourse.road.formulas import bicycle_step, steering_reward, weighted_reward
from bootcourse.scenario import CALIBRATED, DEFAULT
from bootcourse.statistics import ESCAPES, rate
from tools.course.numbering import ROOT
from tools.course.paper_map import items
from tools.course.problems import exists

KINDS = ("Misprint", "Silence", "Reading", "Result")
PARTS = ("In the paper.", "What follows.", "In the kit.", "Taught in")


class Gap(NamedTuple):
    """One gap in the paper, and what the kit does about it."""

    target: str  # "open-clock"
    kind: str
    title: str
    parts: dict[str, str]  # by the names in `PARTS`, with single spaces


def gaps() -> list[Gap]:
    """All gaps, in the order of the page."""
    page, listed = (ROOT / "book/left_open.md").read_text(encoding="utf-8"), []
    pattern = r"^(?:\(([\w-]+)\)=\n)?### (?:(\w+): )?(.+)\n((?:(?!##|\([\w-]+\)=).*\n?)*)"
    for *names, body in re.findall(pattern, page, re.M):
        pieces = re.split(r"^\*\*([^*]+)\*\*", body, flags=re.M)
        parts = {name: " ".join(text.split()) for name, text in zip(pieces[1::2], pieces[2::2], strict=True)}
        listed.append(Gap(*names, parts))
    return listed


GAPS = {gap.target: gap for gap in gaps()}


@pytest.mark.parametrize("gap", gaps(), ids=lambda gap: gap.title)
def test_a_gap_says_what_is_printed_what_follows_what_the_kit_does_and_where(gap):
    assert gap.target.startswith("open-") and gap.kind in KINDS
    assert tuple(gap.parts) == PARTS and all(gap.parts.values())
    code = re.findall(r"`(bootcourse[\w.]+)`", gap.parts["In the kit."])
    assert code and all(exists(name) for name in code) and re.search(r"\[\[\w+\]\]", gap.parts["Taught in"])
    assert len(GAPS) == len(gaps()), "no gap is twice"


def test_the_counts_of_agents_that_escape_are_those_of_the_shipped_study():
    def escaping(results, *methods):
        return [int((results.of(m).scores("success") >= ESCAPES).sum()) for m in methods]

    clocks, both = shipped_experiment("clocks"), ("sac", "soft", "demos", "bootstrapped")
    actor_only = shipped_experiment("ablations")["KL in the actor only"]
    assert escaping(shipped_results(), "soft", "demos") == [8, 0] and escaping(actor_only, "soft") == [9]
    assert escaping(choices(clocks)["2", "π̃"], *both) == [0, 5, 10, 10]  # the settings' comment has all four
    assert "8 of 10 with the KL in both losses, 9 of 10" in GAPS["open-kl-target"].parts["What follows."]
    assert "5 of 10 and 10 of 10" in GAPS["open-network"].parts["What follows."]


def test_every_gap_that_belongs_to_something_numbered_is_on_the_paper_map():
    alone = {"open-trap-speed", "open-gains", "open-tracker", "open-follower", "open-w-kl", "open-symbols", "open-text"}
    assert {item["see"] for item in items() if "see" in item} == set(GAPS) - alone


# The arithmetic -------------------------------------------------------------------------------------

S, R, GAMMA = Settings(), DEFAULT.rule, Settings().gamma
GRID = (R.v_min, R.v_max, R.n)
CLOSING = (8.25 - 10.0) * R.t_safe  # m, at the rule's speed behind the traps
ASTRAY = math.log(8 / (1 - S.rule_p))  # nats: the price of an action that is not the rule's


def after_full_steering(v: float = 15.0) -> tuple[float, float]:
    """How far to the side (m), and how much turned (rad), after one decision."""
    x = y = heading = 0.0
    for _ in range(DEFAULT.clock.steps):
        x, y, heading, v = bicycle_step(
            x, y, heading, v, 0.0, DEFAULT.ego.steering, DEFAULT.car.length, DEFAULT.clock.dt
        )
    return y, heading


def settled_gap(v: float) -> float:
    """The gap (m) at which a traffic car follows one at its own speed."""
    t = DEFAULT.traffic
    return (t.s0 + t.time_gap * v) / math.sqrt(1 - (v / t.desired_speed) ** t.delta)


def deviation(hits: int, episodes: int) -> float:
    """Of a rate, in %."""
    return 100 * float(np.std([1] * hits + [0] * (episodes - hits), ddof=1))


WORKED = {
    "open-clock": {
        "0.15625": earned_at(10, 1),
        "23.4375": earned_at(10),
        "46.875": 2 * earned_at(10),
        "23.06": PRINTED["cql"]["returns"].mean,
        "150": DEFAULT.clock.decisions,
        "0.5": DEFAULT.clock.dt,
    },
    "open-start": {"14.80": DEFAULT.traps.d1[0], "4.06": DEFAULT.traps.d2[0], "5": DEFAULT.car.length},
    "open-trap-speed": {
        "26.70": earned_at(10.87),
        "26.77": PRINTED["soft"]["returns"].mean,
        "10.9": CALIBRATED.traps.speed,
        "10.5": rule.target_speed(10.9, 10.9, *GRID),
        "8.25": rule.target_speed(10.0, 10.0, *GRID),
    },
    "open-traffic": {
        "19.5": settled_gap(6),
        "40": DEFAULT.traffic.lead,
        "20": DEFAULT.traffic.headway * DEFAULT.traffic.spacing[0],
        "60": DEFAULT.traffic.headway * DEFAULT.traffic.spacing[1],
        "11": DEFAULT.traffic.speed[0],
    },
    "open-mobil": {"2": DEFAULT.traffic.safe_braking},
    "open-gains": {"−1.5": 1 - 0.5 / 0.2, "0.17": 1 - DEFAULT.clock.dt / DEFAULT.traffic.tau_heading},
    "open-observation": {"200": DEFAULT.sight.distance, "26": DEFAULT.observation_size},
    "open-accident": {
        "133.5": PRINTED["sac"]["distance"].mean / PRINTED["sac"]["speed"].mean,
        "1": DEFAULT.ego.min_speed,
    },
    "open-lane-change": {"−2.625": CLOSING, "7": 12 - DEFAULT.car.length, "3": R.floor},
    "open-loop": {"1.5": R.t_safe, "6": rule.target_speed(6.0, 6.0, *GRID), "15": rule.target_speed(99.0, 99.0, *GRID)},
    "open-tracker": {
        "1.18": after_full_steering()[0],
        "10.8": math.degrees(after_full_steering()[1]),
        "2.8": 15 * math.sin(after_full_steering()[1]),
        "27": 3**3,
    },
    "open-target-entropy": {
        "2.197": math.log(9),
        "2,303": math.log(10) / S.alpha_lr,
        "4,605": math.log(100) / S.alpha_lr,
        "0.02": S.xi_multiplier * S.alpha_init / 100,
        "37,500": S.beta_episodes * DEFAULT.clock.decisions / S.envs_per_agent * S.updates,
    },
    "open-w-kl": {"2": S.xi_multiplier * S.alpha_init},
    "open-kl-target": {
        "8.76": 2 * ASTRAY,
        "43.8": 2 * ASTRAY / (1 - GAMMA),
        "0.78": earned_at(10, 1) / (1 - GAMMA),
    },
    "open-demonstrations": {"15": 150 * (1 - S.rule_p), "7": 1e-6 / S.rule_p**150, "200": S.demonstration_episodes},
    "open-margin": {
        "0.97": earned_at(15, 1),
        "4.84": earned_at(15, 1) / (1 - GAMMA),
        "1": METHODS["margin"].settings["margin"],
    },
    "open-network": {"64": S.hidden[0], "0.005": S.tau, "256": S.learning_starts},
    "open-rates": {
        "22.36": deviation(1, EPISODES),
        "83": 100 * rate(np.ones(EPISODES, bool)).low,
        "17": 100 * rate(np.zeros(EPISODES, bool)).high,
    },
    "open-rows": {
        "29.10": earned_at(11.51),
        "24.70": PRINTED["rule"]["returns"].mean,
        "4.40": earned_at(11.51) - PRINTED["rule"]["returns"].mean,
        "4.69": earned_at(11.51) - earned_at(11.51, centred=False),
        "0.29": -150 * weighted_reward(0.0, 0.0, steering_reward(DEFAULT.ego.steering), 1.5, 0.05, 0.05),
        "0.025": earned_at(8, 1) - earned_at(7, 1),
        "0.09375": 7 * 0.025 - earned_at(7, 1),
    },
    "open-text": {
        f"{PRINTED[method][column].mean:.2f}": PRINTED[method][column].mean
        for method, column in (
            ("soft", "returns"), ("soft", "distance"), ("sac", "returns"), ("sac", "distance"), ("cql", "returns"),
            ("gail", "returns"),
        )
    },
}  # fmt: skip


@pytest.mark.parametrize("target", WORKED)
def test_the_arithmetic_of_a_gap_is_right(target):
    text = " ".join(GAPS[target].parts.values())
    for printed, computed in WORKED[target].items():
        assert re.search(rf"(?<![\d.,]){re.escape(printed)}(?![\d]|[.,]\d)", text), f"{printed} is not printed"
        number = printed.replace(",", "").replace("−", "-")
        decimals = len(number.partition(".")[2])
        assert round(computed, decimals) == float(number), f"{printed} is {computed}"


def test_no_number_of_episodes_gives_a_rate_of_5_with_the_printed_deviation():
    fives = [(hits, n) for n in range(2, 500) for hits in range(n + 1) if round(100 * hits / n) == 5]
    assert fives and max(deviation(*each) for each in fives) < 25 < PRINTED["demos"]["collision"].sd
