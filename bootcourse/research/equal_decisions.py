"""Later methods beside the paper's, at equal numbers of decisions and after the same search: the experiment `beyond`.

    bootcourse study beyond-search --out DIR && bootcourse study beyond --out DIR

The same for all: γ, the network, the scenario, the teacher and its demonstrations; as many tries in the search, on
seeds and roads that no test uses (`searched`); and the agent's own decisions, without those of the teacher alone that
the demonstrations took. `CHOSEN` is the try of each method that earned most in the search. RLPD makes twice as many
updates for a decision as the others with a replay buffer, with five critics; it is much slower and has fewer seeds
and decisions.
"""

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.learn.agent import Agent
from bootcourse.learn.settings import Settings, settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.methods import display_name
from bootcourse.research.beyond import at_budget
from bootcourse.research.jobs import HELD_OUT, Interrupted, orphaned, smaller
from bootcourse.research.plan import SEEDS, TESTS, LessonExperiment, chosen
from bootcourse.research.results import Results, agent_entries, as_arrays, join
from bootcourse.research.tables import bracketed
from bootcourse.statistics import ESCAPES, interval

GAMMA = 0.97
BUDGETS = (50_000, 100_000)  # decisions of each agent, after which it is tested
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
}
GROUP = 5  # agents of the test that train side by side, a job each
FEWER = {"rlpd": 5}  # agents in the test, of what is slow
SHORTER = {"rlpd": BUDGETS[:1]}  # its budgets, too
LESS_SEARCHED = {"rlpd": {"seeds": 2, "decisions": 50_000}}
LONGER = {"ppo_cloned": 400_000, "ppo": 400_000}  # its decisions are cheap: some more of them, for equal seconds


def tries(method: str) -> list[Settings]:
    """The settings that the search compares."""
    return [settings_for(method, **COMMON[method], **changes) for changes in TRIES[method]]


def budgets_of(method: str) -> tuple[int, ...]:
    """The decisions after which agents of a method are tested."""
    return SHORTER.get(method, BUDGETS)


def searched(method: str) -> dict[str, np.ndarray]:
    """Every try with a few seeds, tested on `SEARCH_ROADS`: the arrays of a file of results. Raises Interrupted."""
    how = {"seeds": SEARCH_SEEDS, "decisions": SEARCHED} | LESS_SEARCHED.get(method, {})
    agents = [with_seeds(one, how["seeds"], FIRST_SEARCH_SEED) for one in tries(method)]
    groups = agents if method.startswith("ppo") else [sum(agents, [])]  # what differs in η alone trains side by side
    return as_arrays(_joined([trained_and_tested(group, [how["decisions"]], SEARCH_ROADS) for group in groups]))


def compared(method: str, first: int) -> dict[str, np.ndarray]:
    """The chosen try with `GROUP` seeds from `first` on, tested at each budget: the arrays of a file of results.

    `tested` is at the last budget, `measured` has the means at each: returns_100000, success_100000 ... Raises
    Interrupted.
    """
    settings = with_seeds(tries(method)[CHOSEN[method]], GROUP, first)
    roads, longer = held_out_seeds(HELD_OUT, TESTS), [LONGER[method]] if method in LONGER else []
    return as_arrays(trained_and_tested(settings, budgets_of(method), roads, longer))


def by_method(computed: dict[str, Results]) -> dict[str, Results]:
    """{method: all its agents}, of the results of `compared` by job."""
    groups: dict[str, list[Results]] = {}
    for results in computed.values():
        groups.setdefault(results.methods[0], []).append(results)
    return {method: _joined(groups[method]) for method in COMMON if method in groups}


def trained_and_tested(
    settings: Sequence[Settings], budgets: Sequence[int], roads: Sequence[int], longer: Sequence[int] = ()
) -> Results:
    """Train agents side by side, and test each on the roads after each budget of decisions.

    longer: a budget after which the training ends, without a test. The seconds are those that the processor spent on
    the training, shared among the agents.
    """
    training, seconds, measured, tested = Training(settings, EPISODES), 0.0, {}, {}
    for budget in (*budgets, *longer):
        started = time.process_time()
        training.run(progress=False, stop=lambda b=budget: training.decisions >= b * len(settings) or orphaned())
        seconds += time.process_time() - started
        if training.decisions < budget * len(settings):
            raise Interrupted(settings[0].method)
        if budget in budgets:
            result = training.result()
            tested = _tested(result.agents, roads)
            means = {"returns": tested["returns"], "success": tested["success"], "accident": tested["accident"] > 0}
            measured |= {f"{name}_{budget}": values.mean(axis=1) for name, values in means.items()}
            measured[f"seconds_{budget}"] = np.full(len(settings), seconds / len(settings))
    curves = {name: training.curves.values[name] for name in ("success", "return", "decisions")}
    driven = int(training.curves.finished.max())
    return Results(
        agent_entries(settings),
        np.array([training.stopped.get(i, -1) for i in range(len(settings))]),
        {name: smaller(values) for name, values in tested.items()},
        {name: values[:, :driven].astype(np.float32) for name, values in curves.items()},
        np.full(len(settings), seconds / len(settings)),
        measured=measured,
    )


def _tested(agents: Sequence[Agent], roads: Sequence[int]) -> dict[str, np.ndarray]:
    """The fields of `Episodes`, each (agents, roads)."""
    each = [drive_episodes(agent.as_policy(), roads) for agent in agents]
    return {name: np.stack([getattr(one, name) for one in each]) for name in vars(each[0])}


def _joined(parts: Sequence[Results]) -> Results:
    """Parts with curves of different lengths as one, filled up with NaN."""
    longest = max(part.sizes[1] for part in parts)

    def filled(values: np.ndarray) -> np.ndarray:
        return np.pad(values, ((0, 0), (0, longest - values.shape[1])), constant_values=np.nan)

    return join([replace(part, curves={name: filled(each) for name, each in part.curves.items()}) for part in parts])


@dataclass(frozen=True)
class Comparison(LessonExperiment):
    """The jobs of the comparison: {"METHOD-FIRST": the arguments of `compared`}."""

    def only(self, words: str) -> "Comparison":
        """The jobs that are named by their folder or by their method; "" for all."""
        names = {name: {name, arguments["method"]} for name, arguments in self.variations.items()}
        return Comparison(self.function, chosen(self.variations, names, words))


SEARCH = LessonExperiment(f"{__name__}:searched", {method: {"method": method} for method in COMMON})
EXPERIMENT = Comparison(
    f"{__name__}:compared",
    {
        f"{method}-{first}": {"method": method, "first": first}
        for first in range(0, SEEDS, GROUP)
        for method in COMMON
        if first < FEWER.get(method, SEEDS)
    },
)


def _words(settings: dict) -> str:
    """ "η = 0.1", or of PPO "32 roads at once"."""
    if settings["method"].startswith("ppo"):
        return f"{settings['envs_per_agent']} roads at once"
    return f"η = {settings['target_entropy']:g}"


def budget_rows(computed: dict[str, Results]) -> tuple[list[str], list[list[str]]]:
    """(headings, rows): what each method reached after each of `BUDGETS`, and after the same seconds.

    computed: {method: its agents}, see `by_method`.
    """
    headings = ["method", "chosen", "agents"]
    for budget in BUDGETS:
        headings += [
            f"{budget // 1000},000 decisions: agents that escape",
            "return [95 %]",
            "accidents, %",
            "s of a core",
        ]
    headings.append(f"return in training after {SECONDS} s of a core")
    rows = []
    for method, results in computed.items():
        row = [display_name(method), _words(results.agents[0]), str(len(results))]
        row += [cell for budget in BUDGETS for cell in _cells(results, budget)]
        last = budgets_of(method)[-1]
        there = at_budget(results.curves, SECONDS * last / results.measured[f"seconds_{last}"])
        rows.append([*row, bracketed(interval(there)) if np.isfinite(there).all() else "–"])
    return headings, rows


def _cells(results: Results, budget: int) -> list[str]:
    measured = results.measured
    if f"returns_{budget}" not in measured:
        return ["–"] * 4
    success, returns, accident = (measured[f"{name}_{budget}"] for name in ("success", "returns", "accident"))
    seconds = measured[f"seconds_{budget}"].mean()
    escape = f"{(success >= ESCAPES).sum()} of {len(results)}"
    return [escape, bracketed(interval(returns)), f"{100 * accident.mean():.1f}", f"{seconds:.1f}"]


def search_rows(computed: dict[str, Results]) -> tuple[list[str], list[list[str]]]:
    """(headings, rows): each method's tries, with the mean return on `SEARCH_ROADS` over the seeds of the search."""
    rows = []
    for method, results in computed.items():
        means = tried(results)
        cells = [f"{words}: {value:.1f}" for words, value in means.items()]
        seeds, decisions = len(results) // len(means), LESS_SEARCHED.get(method, {}).get("decisions", SEARCHED)
        rows.append([display_name(method), *cells, str(seeds), f"{decisions:,}"])
    return ["method", "first try: return", "second", "third", "seeds of each", "decisions"], rows


def tried(results: Results) -> dict[str, float]:
    """{what was tried: mean return over its seeds}, of the results of `searched`."""
    returns: dict[str, list[float]] = {}
    for agent, value in zip(results.agents, results.tested["returns"].mean(axis=1, dtype=float), strict=True):
        returns.setdefault(_words(agent), []).append(value)
    return {words: float(np.mean(values)) for words, values in returns.items()}
