"""Can an agent look ahead without a simulator, in a model of the road that it learned from its own drives?

    bootcourse study learned-model --out DIR

An agent of the paper's method drives, learns a model from its drives (`learn/road_model.py`), and looks ahead in it. In
each further round it learns the model anew, from all drives so far, those with the earlier models included (Ross &
Bagnell 2012, "Agnostic System Identification for Model-Based Reinforcement Learning", arXiv 1203.1007). The control
learns from as many drives, all of them without a look-ahead. The numbers were set by what a core computes in minutes,
and nothing was tuned; every round is tested.
"""

from itertools import product
from pathlib import Path

import numpy as np

from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.learn.agent import Agent
from bootcourse.learn.road_model import FORMS, ImaginedAhead, Transitions, learned_from, transitions_of
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
KEPT = ("roads", "accidents", "returns", "success", "overruled", "decisions")  # see `lookahead.measured`


def cells(seeds: int = AGENTS, tests: int = TESTS) -> dict[str, dict]:
    """One cell for each agent."""
    return {f"agent {seed}": {"seed": seed, "tests": tests} for seed in range(seeds)}


def learned_ahead(seed: int, tests: int) -> Results:
    """Rounds of learning and driving, of one agent of the paper's method.

    Notes, (1, rounds), named "FORM, MEASURE": `KEPT` of the test drives in each of `FORMS`; and rows, how many
    decisions the model learned from. Measured, (1,): the same of the control, which has one round.
    """
    agent = agents_of(BASE, AGENTS, Path())[seed]
    driver, drives, rounds = agent.as_policy(), None, []
    for block in range(BLOCK, BLOCK + ROUNDS):
        new = transitions_of(driver, held_out_seeds(block, DRIVES))
        drives = new if drives is None else drives.and_also(new)
        rounds.append(_tested(agent, drives, tests))
        driver = rounds[-1].pop("driver")
    alone = transitions_of(agent.as_policy(), held_out_seeds(BLOCK_OF_CONTROL, ROUNDS * DRIVES))
    control = _tested(agent, alone, tests)
    notes = {name: np.array([[one[name] for one in rounds]]) for name in rounds[0]}
    of_control = {name: np.array([control[name]]) for name in rounds[0]}
    return Results(agent_entries([agent.settings]), np.array([-1]), notes=notes, measured=of_control)


def _tested(agent: Agent, drives: Transitions, tests: int) -> dict:
    """Learn a model from drives; how the agent then drives in each form, and the driver of the first form."""
    model, found = learned_from(drives, agent.settings.seed), {"rows": len(drives.rewards)}
    for form in FORMS:
        if orphaned():
            raise Interrupted(NAME)
        driven = measured(ImaginedAhead(agent, model, form), held_out_seeds(HELD_OUT, tests))
        found |= {f"{form}, {name}": driven[name] for name in KEPT}
    return found | {"driver": ImaginedAhead(agent, model)}


def together(tried: Computed) -> Results:
    """All agents that were computed, by their seed."""
    return join([tried[name] for name in sorted(tried, key=lambda name: int(name.split()[-1]))])


def per_thousand(agents: Results, form: str, control: bool = False) -> np.ndarray:
    """Accidents in 1,000 drives of each agent after each round, (agents, rounds); (agents, 1) of the control."""
    of = agents.measured if control else agents.notes
    return 1000 * (of[f"{form}, accidents"] / of[f"{form}, roads"]).reshape(len(agents), -1)


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
    return ["looking ahead", "accidents in 1,000, after each round", "return, after each round"], lines


def section(computed: dict[str, Computed], folder: Path) -> list[str]:
    """Every form after each round."""
    table = markdown(*rows(computed[NAME], computed[LOOK_AHEAD]))
    return ["### In a model that is learned\n", LEARNED, table]


LEARNED = f"""Agents of the paper's method look ahead in a model that each of them learned from its own drives, of
{DRIVES} roads in each of {ROUNDS} rounds; the control from {ROUNDS * DRIVES} drives without a look-ahead. Means over
agents, on {TESTS} held-out roads.
"""

EXPERIMENT = Experiment(NAME, cells, results_of(learned_ahead), section=section)
