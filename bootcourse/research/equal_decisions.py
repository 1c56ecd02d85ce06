"""Later methods beside the paper's, at equal numbers of decisions and after the same search: what both trainings do.

    bootcourse study beyond-search --out DIR && bootcourse study beyond --out DIR

The same for all: γ, the network, the scenario, the teacher and its demonstrations; as many tries in the search, on
seeds and roads that no test uses (`searched`); and the agent's own decisions, without those of the teacher alone that
the demonstrations took. `CHOSEN` is the try of each method that earned most in the search. PPO's agents train up to
the last of `BUDGETS`, of the other methods those of the first job. RLPD makes twice as many updates for a decision as
the others with a replay buffer, with five critics; it is about five times as slow, and all its agents stop at the
second.
"""

import time
from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.learn.settings import Settings, settings_for
from bootcourse.learn.training import Training
from bootcourse.methods import display_name
from bootcourse.research.beyond import at_budget
from bootcourse.research.cells import drives, smaller
from bootcourse.research.jobs import Interrupted, orphaned
from bootcourse.research.results import Results, agent_entries, join
from bootcourse.research.tables import bracketed
from bootcourse.statistics import ESCAPES, interval

GAMMA = 0.97
BUDGETS = (100_000, 200_000, 800_000)  # decisions of each agent, after which it is tested
BOARD = BUDGETS[1]  # every agent makes so many: the tests drive by drive that are kept
SEARCHED = 100_000  # decisions of each agent of the search
SEARCH_SEEDS, FIRST_SEARCH_SEED = 3, 500
SEARCH_ROADS = held_out_seeds(19, 200)
SECONDS = 5  # of one core, for each agent of those side by side
EPISODES = 50_000  # more than any of these trainings drives

# The paper's method has c = 0.5, since c = 2 at this γ would be worth more than any drive, and β that fades in time.
COMMON = {
    "bootstrapped": {"gamma": GAMMA, "batch": 128, "bonus": 0.5, "beta_episodes": 500},
    "jsrl": {},  # the methods' own settings have the same γ and batch
    "ibrl": {},
    "rlpd": {"envs_per_agent": 4, "updates": 2},
    "ppo_cloned": {"gamma": GAMMA, "batch": 512},
    "ppo": {"gamma": GAMMA, "batch": 512},
    "sac": {"gamma": GAMMA, "batch": 128},  # as "ppo", without a teacher: what the teacher adds
}
ENTROPIES = [{"target_entropy": entropy} for entropy in (-1.0, 0.1, 0.3)]
ROUNDS = [{"envs_per_agent": roads} for roads in (32, 64, 128)]  # PPO has no target entropy
TRIES = {method: ROUNDS if method.startswith("ppo") else ENTROPIES for method in COMMON}
CHOSEN = {  # of the tries, by what `beyond-search` measured
    "bootstrapped": 0,
    "jsrl": 2,
    "ibrl": 1,
    "rlpd": 0,
    "ppo_cloned": 0,
    "ppo": 1,
    "sac": 2,
}
UNTIMED = ("sac",)  # trained later, on a slower machine: its seconds are not compared
GROUP = 5  # agents of the test that train side by side, a job each
LAST = {"ppo_cloned": BUDGETS[-1], "ppo": BUDGETS[-1], "rlpd": BUDGETS[1]}  # of the budgets; others: see `last_of`


def tries(method: str) -> list[Settings]:
    """The settings that the search compares."""
    return [settings_for(method, **COMMON[method], **changes) for changes in TRIES[method]]


def last_of(method: str, first: int) -> int:
    """The last budget of the agents of a method whose seeds begin at `first`. 800,000 decisions take long."""
    return LAST.get(method, BUDGETS[1] if first else BUDGETS[-1])


def by_method(computed: dict[str, Results]) -> dict[str, Results]:
    """{method: all its agents}, of the results of `compared` by job."""
    groups: dict[str, list[Results]] = {}
    for results in computed.values():
        groups.setdefault(results.methods[0], []).append(results)
    return {method: joined(groups[method]) for method in COMMON if method in groups}


def trained_and_tested(settings: Sequence[Settings], budgets: Sequence[int], roads: Sequence[int]) -> Results:
    """Train agents side by side, and test each on the roads after each budget of decisions.

    The seconds are those that the processor spent on the training, shared among the agents.
    """
    training, seconds, measured, tested = Training(settings, EPISODES), 0.0, {}, {}
    for budget in budgets:
        started = time.process_time()
        training.run(progress=False, stop=lambda b=budget: training.decisions >= b * len(settings) or orphaned())
        seconds += time.process_time() - started
        if training.decisions < budget * len(settings):
            raise Interrupted(settings[0].method)
        driven = drives(training.result().agents, roads)
        tested = driven if budget <= BOARD else tested
        means = {"returns": driven["returns"], "success": driven["success"], "accident": driven["accident"] > 0}
        measured |= {f"{name}_{budget}": values.mean(axis=1) for name, values in means.items()}
        measured[f"seconds_{budget}"] = np.full(len(settings), seconds / len(settings))
    curves = {name: training.curves.values[name] for name in ("success", "return", "decisions")}
    longest = int(training.curves.finished.max())
    return Results(
        agent_entries(settings),
        np.array([training.stopped.get(i, -1) for i in range(len(settings))]),
        {name: smaller(values) for name, values in tested.items()},
        {name: values[:, :longest].astype(np.float32) for name, values in curves.items()},
        np.full(len(settings), seconds / len(settings)),
        measured=measured,
    )


def joined(parts: Sequence[Results]) -> Results:
    """Parts with curves of different lengths as one, and with different budgets, filled up with NaN."""
    longest = max(part.sizes[1] for part in parts)
    measures = {name for part in parts for name in part.measured}

    def filled(part: Results) -> Results:
        more = ((0, 0), (0, longest - part.sizes[1]))
        curves = {name: np.pad(each, more, constant_values=np.nan) for name, each in part.curves.items()}
        unknown = np.full(len(part), np.nan)
        return replace(part, curves=curves, measured={name: part.measured.get(name, unknown) for name in measures})

    return join([filled(part) for part in parts])


def _words(settings: dict) -> str:
    """ "η = 0.1", or of PPO "32 roads at once"."""
    if settings["method"].startswith("ppo"):
        return f"{settings['envs_per_agent']} roads at once"
    return f"η = {settings['target_entropy']:g}"


def budget_rows(computed: dict[str, Results]) -> tuple[list[str], list[list[str]]]:
    """(headings, rows): what each method reached after each of `BUDGETS`. computed: see `by_method`."""
    headings = ["decisions", "method", "agents that escape", "return [95 %]", "accidents, %", "s of a core"]
    rows = []
    for budget, (method, results) in product(BUDGETS, computed.items()):
        if (returns := at(results, "returns", budget)).size:
            success, accident = (at(results, name, budget) for name in ("success", "accident"))
            seconds = "–" if method in UNTIMED else f"{at(results, 'seconds', budget).mean():.1f}"
            escape = f"{(success >= ESCAPES).sum()} of {len(success)}"
            cells = [escape, bracketed(interval(returns)), f"{100 * accident.mean():.1f}", seconds]
            rows.append([f"{budget:,}", display_name(method), *cells])
    return headings, rows


def seconds_rows(computed: dict[str, Results]) -> tuple[list[str], list[list[str]]]:
    """(headings, rows): what each method earns in training after `SECONDS`. computed: see `by_method`."""
    rows = []
    for method, results in computed.items():
        if method in UNTIMED:
            continue
        each = results.measured[f"seconds_{BUDGETS[0]}"] / BUDGETS[0]  # for a decision
        returns = bracketed(interval(at_budget(results.curves, SECONDS / each)))
        rows.append([display_name(method), f"{SECONDS / each.mean():,.0f}", returns])
    return ["method", f"decisions in {SECONDS} s of a core", "return of the last 50 episodes of training [95 %]"], rows


def at(results: Results, measure: str, budget: int) -> np.ndarray:
    """Returns, success, accident or seconds after so many decisions, of the agents that made so many: (agents,)."""
    values = results.measured.get(f"{measure}_{budget}", np.array([]))
    return values[np.isfinite(values)]


def search_rows(computed: dict[str, Results]) -> tuple[list[str], list[list[str]]]:
    """(headings, rows): each method's tries, with the mean return on `SEARCH_ROADS` over the seeds of the search."""
    rows = []
    for method, results in computed.items():
        means = tried(results)
        cells = [f"{words}: {value:.1f}" for words, value in means.items()]
        rows.append([display_name(method), *cells])
    return ["method", "first setting: return", "second", "third"], rows


def tried(results: Results) -> dict[str, float]:
    """{what was tried: mean return over its seeds}, of the results of `searched`."""
    returns: dict[str, list[float]] = {}
    for agent, value in zip(results.agents, results.tested["returns"].mean(axis=1, dtype=float), strict=True):
        returns.setdefault(_words(agent), []).append(value)
    return {words: float(np.mean(values)) for words, values in returns.items()}
