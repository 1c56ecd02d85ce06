"""Which help lasts: ξ = 200 α, which fades with updates, or β, which fades with episodes?

    bootcourse study clocks --out DIR

The paper reports one trained agent per method. `pattern` is the probability that such a table comes out as the
paper's Table 4 if the agents are drawn from ours.
"""

from pathlib import Path

import numpy as np

from bootcourse.methods import display_name
from bootcourse.research.cells import SHIPPED_CURVES, TESTS, VARIED, train_and_test, trained
from bootcourse.research.experiment import Computed, Experiment
from bootcourse.research.paper import EPISODES, PRINTED
from bootcourse.research.results import Results, join
from bootcourse.research.tables import found_and_kept, markdown
from bootcourse.statistics import Estimate

DRIVERS = {"μ": False, "π̃": True}  # of the demonstrations: are they drawn from the stochastic rule?
# Each updates-per-decision setting of the experiment `clocks`. The paper prints neither updates nor roads.
UPDATES = {"1/4": {}, "1": {"envs_per_agent": 1}, "2": {"envs_per_agent": 1, "updates": 2},
           "4": {"envs_per_agent": 1, "updates": 4}}  # fmt: skip
DRAWS = 100_000


TRAINED = 1200  # episodes of each agent


def cells(seeds: int = 10, episodes: int = TRAINED, tests: int = TESTS) -> dict[str, dict]:
    """Both clocks, and who drives the demonstrations."""
    variations = {}
    for updates, changes in UPDATES.items():
        alone = trained(seeds, episodes, tests, ("sac", "soft"), **changes)
        variations[f"{updates} updates, no demonstrations"] = alone
        for driver, stochastic in DRIVERS.items():
            of_driver = changes | {"stochastic_demonstrations": stochastic}
            helped = trained(seeds, episodes, tests, ("demos", "bootstrapped"), **of_driver)
            variations[f"{updates} updates, demonstrations by {driver}"] = helped
    return variations


def choices(varied: Computed) -> dict[tuple[str, str], Results]:
    """The four methods' agents of every choice that was computed: {(updates per decision, driver): results}."""
    of = {}
    for updates in UPDATES:
        alone = varied.get(f"{updates} updates, no demonstrations")
        for driver in DRIVERS:
            helped = varied.get(f"{updates} updates, demonstrations by {driver}")
            if alone is not None and helped is not None:
                of[updates, driver] = join([alone, helped])
    return of


def as_printed(success: np.ndarray, method: str) -> np.ndarray:
    """The probability that 20 test episodes of an agent all end as the paper's row says: success rates (agents,)."""
    return success**EPISODES if PRINTED[method]["success"].mean == 100 else (1 - success) ** EPISODES


def pattern(results: Results, seed: int = 0) -> Estimate:
    """The probability that one agent per method, tested on 20 episodes, gives the paper's four success rates.

    Each row's probability is a mean over agents, their product the value. The interval: each row's probability has a
    beta distribution with Jeffreys' prior (Brown, Cai & DasGupta 2001), which stays positive where no agent fits.
    """
    rng, product, value = np.random.default_rng(seed), np.ones(DRAWS), 1.0
    for method in VARIED:
        fits = as_printed(results.of(method).scores("success"), method)
        value *= float(fits.mean())
        product *= rng.beta(fits.sum() + 0.5, (1 - fits).sum() + 0.5, DRAWS)
    low, high = np.percentile(product, [2.5, 97.5])
    return Estimate(value, float(low), float(high))


def pattern_rows(varied: Computed) -> tuple[list[str], list[list[str]]]:
    """(headings, rows): who finds and keeps the way out, and how often a table of single agents reads as printed."""
    rows = []
    for (updates, driver), results in choices(varied).items():
        counts = [found_and_kept(results, method) for method in VARIED]
        probability, low, high = (f"{100 * part:.0f}" for part in pattern(results))
        rows.append([updates, driver, *counts, f"{probability} [{low}, {high}]"])
    return ["updates per decision", "demonstrations by", *map(display_name, VARIED), "as the paper, % [95 %]"], rows


def section(computed: dict[str, Computed], folder: Path) -> list[str]:
    """Who finds and keeps the way out with each choice."""
    return ["## Two clocks\n", CLOCKS, markdown(*pattern_rows(computed["clocks"]))]


CLOCKS = """ξ = 200 α fades with the updates, β with the episodes. The paper does not print how many updates follow a
decision; its text says that π̃ drove the demonstrations. Each row is one choice of both, with one road per agent (four
where a decision has 1/4 of an update). The methods' columns: found, kept. The last column is the probability that a
table with *one* trained agent per method and 20 test episodes each reads as the paper's: successes 0, 0, 20 and 20.
Its interval is over training seeds (Jeffreys).
"""

EXPERIMENT = Experiment("clocks", cells, train_and_test, SHIPPED_CURVES, section)
