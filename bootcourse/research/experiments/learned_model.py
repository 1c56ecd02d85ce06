"""Can an agent look ahead without a simulator, in a model of the road that it learned from its own drives?

    bootcourse study learned-model --out DIR

An agent of the paper's method drives, learns a model from its drives (`learn/road_model.py`), and looks ahead in it. In
each further round it learns the model anew, from all drives so far, those with the earlier models included (Ross &
Bagnell 2012, "Agnostic System Identification for Model-Based Reinforcement Learning", arXiv 1203.1007). The control
learns from as many drives, all of them without a look-ahead. The numbers were set by what a core computes in minutes,
and nothing was tuned; every round is tested.
"""

from functools import cache
from itertools import product
from pathlib import Path

import numpy as np

from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.learn.agent import Agent
from bootcourse.learn.road_model import FORMS, ImaginedAhead, Transitions, learned_from, transitions_of
from bootcourse.policies import Policy, PolicyOutput, random_policy
from bootcourse.research.cells import results_of
from bootcourse.research.experiment import Computed, Experiment
from bootcourse.research.experiments.lookahead import NAME as LOOK_AHEAD
from bootcourse.research.experiments.lookahead import Cell, agents_of, measured
from bootcourse.research.jobs import HELD_OUT, Interrupted, orphaned
from bootcourse.research.results import Results, agent_entries, join
from bootcourse.research.tables import markdown

NAME, BASE, AGENTS, ROUNDS = "learned-model", "bootstrapped", 10, 4
DRIVES, BLOCK, BLOCK_OF_CONTROL = 200, 41, 51  # roads of a round; the first held-out blocks that they are from
TESTS = 100  # held-out roads of each test, the first of the look-ahead's
RANDOM = (0.1, 0.3)  # shares of random actions in the drives of the further controls
KEPT = ("roads", "accidents", "returns", "success", "overruled", "decisions")  # see `lookahead.measured`


def cells(seeds: int = AGENTS, tests: int = TESTS) -> dict[str, dict]:
    """One cell for each agent, and one for each share of random actions."""
    alone = {cell_of(seed): {"seed": seed, "tests": tests} for seed in range(seeds)}
    shares = product(RANDOM, range(seeds))
    return alone | {cell_of(seed, share): {"seed": seed, "tests": tests, "share": share} for share, seed in shares}


def cell_of(seed: int, share: float | None = None) -> str:
    """The name of an agent's cell."""
    return f"agent {seed}" if share is None else f"random {share:g} agent {seed}"


def learned_ahead(seed: int, tests: int, share: float | None = None) -> Results:
    """Rounds of learning and driving, of one agent of the paper's method.

    Notes, (1, rounds), named "FORM, MEASURE": `KEPT` of the test drives in each of `FORMS`; and rows, how many
    decisions the model learned from. Measured, (1,): the same of the control, which has one round. With a share of
    random actions: of that control alone.
    """
    agent = agents_of(BASE, AGENTS, Path())[seed]
    if share is not None:
        rng = np.random.default_rng([seed, round(1000 * share)])
        drives = transitions_of(partly_random(agent.as_policy(), share, rng), roads_of_control())
        return _results(agent, _tested(agent, drives, tests))
    driver, drives, rounds = agent.as_policy(), None, []
    for block in range(BLOCK, BLOCK + ROUNDS):
        new = transitions_of(driver, held_out_seeds(block, DRIVES))
        drives = new if drives is None else drives.and_also(new)
        rounds.append(_tested(agent, drives, tests))
        driver = rounds[-1].pop("driver")
    control = _tested(agent, transitions_of(agent.as_policy(), roads_of_control()), tests)
    return _results(agent, control, {name: np.array([[one[name] for one in rounds]]) for name in rounds[0]})


def roads_of_control() -> range:
    """As many roads as in all rounds together."""
    return held_out_seeds(BLOCK_OF_CONTROL, ROUNDS * DRIVES)


def partly_random(policy: Policy, share: float, rng: np.random.Generator) -> Policy:
    """The policy, with a share of its actions drawn again, each of the nine with the same probability."""
    drawn = random_policy(rng)

    def drive(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        own, other = (each(observations, cars).actions for each in (policy, drawn))
        return PolicyOutput(np.where(rng.random(len(own)) < share, other, own))

    return drive


def _results(agent: Agent, control: dict, notes: dict | None = None) -> Results:
    measured = {name: np.array([value]) for name, value in control.items() if name != "driver"}
    return Results(agent_entries([agent.settings]), np.array([-1]), notes=notes or {}, measured=measured)


def _tested(agent: Agent, drives: Transitions, tests: int) -> dict:
    """Learn a model from drives; how the agent then drives in each form, and the driver of the first form."""
    model, found = learned_from(drives, agent.settings.seed), {"rows": len(drives.rewards)}
    for form in FORMS:
        if orphaned():
            raise Interrupted(NAME)
        driven = measured(ImaginedAhead(agent, model, form), held_out_seeds(HELD_OUT, tests))
        found |= {f"{form}, {name}": driven[name] for name in KEPT}
    return found | {"driver": ImaginedAhead(agent, model)}


def together(tried: Computed, share: float | None = None) -> Results:
    """All agents that were computed, by their seed: those with a share of random actions, if one is given."""
    return join([tried[name] for seed in range(len(tried)) if (name := cell_of(seed, share)) in tried])


def per_thousand(agents: Results, form: str, control: bool = False) -> np.ndarray:
    """Accidents in 1,000 drives of each agent after each round, (agents, rounds); (agents, 1) of the control."""
    of = agents.measured if control else agents.notes
    return 1000 * (of[f"{form}, accidents"] / of[f"{form}, roads"]).reshape(len(agents), -1)


@cache
def alone(seeds: int = AGENTS, tests: int = TESTS) -> tuple[float, ...]:
    """Accidents in 1,000 drives of each agent alone, on the roads of the tests."""
    roads = held_out_seeds(HELD_OUT, tests)
    driven = [drive_episodes(agent.as_policy(), roads) for agent in agents_of(BASE, seeds, Path())]
    return tuple(float(1000 * (each.accident > 0).mean()) for each in driven)


def rows(tried: Computed, look_ahead: Computed) -> tuple[list[str], list[list[str]]]:
    """(headings, rows): accidents in 1,000 drives and return, means over the agents, after each round.

    look_ahead: the cells with the exact model, of the same agents.
    """
    lines, agents = [], together(tried)
    for form in ("alone", "rollouts", "shield"):
        if (cell := look_ahead.get(Cell(BASE, form).name)) is not None:
            of, words = cell.measured, form if form == "alone" else f"{form}, in the simulator"
            accidents = f"{1000 * of['accidents'].sum() / of['roads'].sum():.0f}"
            lines.append([words, accidents, f"{of['returns'].mean():.0f}"])
    for control, form in product((False, True), FORMS):
        returns = (agents.measured if control else agents.notes)[f"{form}, returns"].reshape(len(agents), -1)
        of = per_thousand(agents, form, control), returns
        words = [", ".join(f"{mean:.0f}" for mean in each.mean(0)) for each in of]
        lines.append([f"{form}, control" if control else form, *words])
    for share, form in product(RANDOM, FORMS):
        agents = together(tried, share)
        of = per_thousand(agents, form, control=True), agents.measured[f"{form}, returns"]
        lines.append([f"{form}, {share:.0%} of the actions random", *(f"{each.mean():.0f}" for each in of)])
    return ["looking ahead", "accidents in 1,000, after each round", "return, after each round"], lines


def section(computed: dict[str, Computed], folder: Path) -> list[str]:
    """Every form after each round."""
    table = markdown(*rows(computed[NAME], computed[LOOK_AHEAD]))
    return ["### In a model that is learned\n", LEARNED, table]


LEARNED = f"""Agents of the paper's method look ahead in a model that each of them learned from its own drives, of
{DRIVES} roads in each of {ROUNDS} rounds; the controls from {ROUNDS * DRIVES} drives without a look-ahead, with a
share of the actions drawn at random where the row says so. Means over agents, on {TESTS} held-out roads.
"""

EXPERIMENT = Experiment(NAME, cells, results_of(learned_ahead), section=section)
