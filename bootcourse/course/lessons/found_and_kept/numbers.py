"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache
from typing import NamedTuple

import numpy as np
from scipy import stats

from bootcourse.course.lessons.found_and_kept import counts
from bootcourse.course.lessons.found_and_kept.exercises import forgetting as forgetting
from bootcourse.course.lessons.found_and_kept.explorable import EPISODES, Fading
from bootcourse.course.lessons.found_and_kept.figures import half_found
from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.research.experiments import clocks as study_clocks
from bootcourse.research.results import Results, join
from bootcourse.rule import stochastic_rule
from bootcourse.statistics import HAD as HAD
from bootcourse.statistics import IN_A_ROW as WINDOW
from bootcourse.statistics import LOST, lost
from tools.course.known import clocks, fisher, in_training, of, others, shipped_experiment, shipped_results

LATE = 900  # an episode: a tenth of β is left
FADES, FALLS, HELD = tuple(counts.KINDS)[-3:]
KINDS_WITH, KINDS_WITHOUT = tuple(counts.KINDS)[:2], tuple(counts.KINDS)[2:4]  # the bonus
SHORTER = study_clocks.TRAINED  # training episodes of the agents of rounds 4 and 5


def undecided(method: str, first: int, last: int | None) -> float:
    """The mean effective number of actions of a method's agents in some of their training episodes."""
    return float(np.exp(of(method).curves["entropy"][:, first:last].mean()))


def rule_actions() -> float:
    """The effective number of actions of the stochastic rule."""
    return float(np.exp(stats.entropy(stochastic_rule(np.array(0), 0.9))))


def ablations() -> dict[str, Results]:
    """The ten agents of each method with one choice of the method changed, by what was changed."""
    return shipped_experiment("ablations")


class Counted(NamedTuple):
    """How many agents found the way out, how many of these kept it, and of how many."""

    found: int
    kept: int
    n: int


def of_all() -> Results:
    """The study's agents, every method's."""
    return shipped_results()


def way(results: Results, method: str) -> Counted:
    """Of a method's agents, see `Results.found_and_kept`."""
    found, kept = results.found_and_kept(method)
    return Counted(int(found.sum()), int(kept.sum()), len(found))


def over_updates(driver: str) -> Counted:
    """The agents with demonstrations alone of one driver, over all numbers of updates."""
    each = [way(clocks()[updates, driver], "demos") for updates in study_clocks.UPDATES]
    return Counted(*(sum(column) for column in zip(*each, strict=True)))


def losers() -> np.ndarray:
    """Which of the study's agents with both aids lose the way out at least once, (agents,)."""
    return lost(of("bootstrapped").curves["success"])


def kept_until_late(method: str) -> bool:
    """Does each agent of a method have the way out in each window from its first good one to episode 900?"""
    windows = np.lib.stride_tricks.sliding_window_view(of(method).curves["success"], WINDOW, axis=1)
    return all(bool(row[int(row.argmax()) : LATE - WINDOW + 1].all()) for row in windows.mean(axis=-1) > 0.5)


def kind(name: str) -> list[Results]:
    """The agents of one of the table's kinds: the study's, and the ten others where they were trained."""
    return counts.groups(name, of_all(), ablations(), shipped_experiment("stress"))


def losing(name: str, bar: int = LOST) -> str:
    """ "2 of 20": how many agents of a kind lose the way out at least once."""
    return _of([lost(each.curves["success"], bar) for each in kind(name)])


def early(*names: str, bar: int = LOST) -> str:
    """The same before episode 900, of several kinds together."""
    return _of([lost(each.curves["success"][:, :LATE], bar) for name in names for each in kind(name)])


def finding(name: str) -> str:
    """How many agents of a kind find the way out."""
    return _of([each.found_and_kept(counts.KINDS[name][0])[0] for each in kind(name)])


def keeping(name: str) -> str:
    """How many agents of a kind keep it."""
    return _of([each.found_and_kept(counts.KINDS[name][0])[1] for each in kind(name)])


def _of(hits: list[np.ndarray]) -> str:
    return f"{sum(int(each.sum()) for each in hits)} of {sum(map(len, hits))}"


def mean_of(results: Results, method: str, measure: str) -> float:
    """The mean of a measure over all agents of a method."""
    return float(results.of(method).scores(measure).mean())


def of_both(updates: str, last: int | None = None) -> list[tuple[np.ndarray, np.ndarray]]:
    """The agents with both aids and so many updates, of each driver: who loses the way out, by an episode or by the
    end, and who keeps it."""
    each = [clocks()[updates, driver].of("bootstrapped") for driver in ("μ", "π̃")]
    return [(lost(r.curves["success"][:, :last]), r.found_and_kept("bootstrapped")[1]) for r in each]


def both(what: str) -> str:
    """ "19 of 20 | 8 of 15 | ...": how many agents with both aids have "lost" or "kept" it, by the updates."""
    place = ("lost", "kept").index(what)
    return " | ".join(_of([pair[place] for pair in of_both(updates)]) for updates in study_clocks.UPDATES)


def both_early(updates: str) -> list[int]:
    """How many of them lose it before episode 900: with the driver μ, and with π̃."""
    return [int(each.sum()) for each, _ in of_both(updates, LATE)]


def soft_kept_of(updates: str) -> int:
    """How many agents of the soft constraint alone keep the way out with so many updates."""
    return way(clocks()[updates, "π̃"], "soft").kept


def of_others() -> Results:
    """The ten others of the four methods."""
    return join([others(method) for method in study_clocks.VARIED])


def small_cells() -> list[int]:
    """How often a table of single agents reads as the paper's, in %, of choices with fewer than ten agents."""
    small = [r for r in clocks().values() if len(r.of("demos")) < 10]
    return sorted(round(100 * study_clocks.pattern(r).value) for r in small)


def factors() -> str:
    """ "1.00 × 0.40 = 0.40": the chances that a row reads as the paper's, with two updates and π̃, and their product."""
    agents = clocks()["2", "π̃"]
    each = [study_clocks.as_printed(agents.of(m).scores("success"), m).mean() for m in study_clocks.VARIED]
    return f"{' × '.join(f'{chance:.2f}' for chance in each)} = {np.prod(each):.2f}"


def fades_by(updates: float) -> int:
    """By which episode ξ has lost 99 % in the panel to drag, with so many updates for each decision."""
    return int(EPISODES[np.argmax(Fading().left(updates) < 0.01)])


def found_after(updates: str, method: str) -> int:
    """The episode by which half of the agents with so many updates for a decision have found the way out."""
    return half_found(clocks()[updates, "π̃"].of(method))


def xi_left(updates: str) -> float:
    """Which part of ξ is left then with the soft constraint alone, the median over agents."""
    xi = clocks()[updates, "π̃"].of("soft").curves["xi"]
    return float(np.median(xi[:, found_after(updates, "soft") - 1] / xi[:, 0]))


def of_the_agent_shown() -> Rollout:
    """The first drive of the lesson: of an agent with demonstrations alone, after its training."""
    best = int(in_training("demos", 700, 900).argmax())
    return record(shipped_agents("demos")[best].as_policy(), [10])[0]


def keeping_p(method: str) -> float:
    """Fisher's p: of the agents that found the way out, do more keep it if β never ends than if it ends at 1,000?"""
    ends, stays = way(of_all(), method), way(ablations()["β for ever"], method)
    return float(stats.fisher_exact([[each.kept, each.found - each.kept] for each in (ends, stays)]).pvalue)


def kept_of(method: str, stays: bool) -> str:
    """ "6 of 7": of the agents that found the way out, how many keep it if β never ends, or ends at 1,000."""
    counted = way(ablations()["β for ever"] if stays else of_all(), method)
    return f"{counted.kept} of {counted.found}"


def keepers(results: Results, method: str, measure: str) -> float:
    """The mean of a measure over the agents of a method that keep the way out."""
    return float(results.of(method).scores(measure)[results.found_and_kept(method)[1]].mean())


def stratified_p(pairs: list[tuple[Counted, Counted]]) -> float:
    """The exact p of a difference in keeping between the first and the second group, compared within each pair.

    Given how many agents won in each pair, those of the first group have a hypergeometric distribution; their sum
    over the pairs has the convolution. As in Fisher's test, p adds up what is at most as probable as what happened.
    """
    chances, won = np.ones(1), 0
    for first, second in pairs:
        both, won = first.kept + second.kept, won + first.kept
        own = stats.hypergeom(first.n + second.n, both, first.n).pmf(np.arange(first.n + 1))
        chances = np.convolve(chances, own)
    return float(chances[chances <= chances[won] * (1 + 1e-9)].sum())


def losing_p(first: str, second: str) -> float:
    """Fisher's p: of the agents that found the way out, do as many of both kinds lose it at least once?"""
    pairs = [[int(part.split(" of ")[0]) for part in (losing(name), finding(name))] for name in (first, second)]
    return float(stats.fisher_exact([[few, found - few] for few, found in pairs]).pvalue)


def both_p() -> float:
    """A quarter of an update against two, with both aids, for each driver: who loses the way out."""
    few, many = (
        [Counted(len(each), int(each.sum()), len(each)) for each, _ in of_both(updates)] for updates in ("1/4", "2")
    )
    return stratified_p(list(zip(few, many, strict=True)))


def driver_p() -> float:
    """μ against π̃, with demonstrations alone, at each number of updates."""
    pairs = [tuple(way(clocks()[updates, d], "demos") for d in ("μ", "π̃")) for updates in study_clocks.UPDATES]
    return stratified_p(pairs)


def updates_p() -> float:
    """A quarter of an update against two, with demonstrations alone, for each driver."""
    pairs = [tuple(way(clocks()[updates, d], "demos") for updates in ("1/4", "2")) for d in ("μ", "π̃")]
    return stratified_p(pairs)


def trend_p() -> float:
    """The two-sided p of a trend: of the soft agents, do fewer keep the way out with each doubling of the updates?

    By 100,000 permutations of which agents keep it; the statistic is the covariance with the logarithm of the updates.
    """
    groups = [clocks()[of].found_and_kept("soft")[1] for of in (("1/4", "π̃"), ("1", "π̃"), ("2", "π̃"), ("4", "π̃"))]
    kept = np.concatenate(groups).astype(float)
    doublings = np.repeat([-2.0, 0.0, 1.0, 2.0], [len(each) for each in groups])
    doublings -= doublings.mean()
    drawn = np.random.default_rng(0).permuted(np.tile(kept, (100_000, 1)), axis=1) @ doublings
    return float(np.mean(np.abs(drawn) >= abs(kept @ doublings) - 1e-9))


@cache
def p_values() -> dict[str, float]:
    """Every p value that the lesson prints."""
    return {
        "keeping": keeping_p("demos"),
        "losing, both": losing_p(KINDS_WITH[0], KINDS_WITH[1]),
        "losing, soft": losing_p(FADES, FALLS),
        "both, updates": both_p(),
        "trend": trend_p(),
        "driver": driver_p(),
        "updates": updates_p(),
        "choices": fisher(*(way(clocks()[cell], "demos").kept for cell in (("1/4", "μ"), ("2", "π̃")))),
    }


def holm() -> dict[str, float]:
    """The same, corrected for their number (Holm 1979)."""
    corrected, least = {}, 0.0
    for tried, (name, p) in enumerate(sorted(p_values().items(), key=lambda item: item[1])):
        corrected[name] = least = max(least, min(1.0, (len(p_values()) - tried) * p))
    return corrected


def comparison(name: str) -> str:
    """A row of the lesson's table, without its first cell: how many agents of two groups, and p after Holm."""
    kept = {
        "keeping": f"{kept_of('demos', True)} against {kept_of('demos', False)} keep it",
        "losing, both": f"{losing(KINDS_WITH[0])} against {losing(KINDS_WITH[1])} lose it",
        "losing, soft": f"{losing(FADES)} against {losing(FALLS)} lose it",
        "both, updates": "{} against {} lose it".format(*both("lost").split(" | ")[::2]),
        "trend": f"{soft_kept()} keep it",
        "updates": f"{of_updates('1/4')} against {of_updates('2')} keep it",
        "driver": f"{of_driver('μ')} against {of_driver('π̃')} keep it",
        "choices": kept_against((clocks()["1/4", "μ"], "demos"), (clocks()["2", "π̃"], "demos")) + " keep it",
    }
    return f"{kept[name]}|{_short(holm()[name])}"


def soft_kept() -> str:
    """How many agents of the soft constraint alone keep the way out, by the updates for a decision."""
    each = [way(clocks()[updates, "π̃"], "soft") for updates in study_clocks.UPDATES]
    return ", ".join(f"{counted.kept} of {counted.n}" for counted in each)


def of_updates(updates: str) -> str:
    """ "8 of 20": of the agents with demonstrations alone and so many updates, of both drivers, how many keep it."""
    each = [way(clocks()[updates, driver], "demos") for driver in ("μ", "π̃")]
    return f"{sum(counted.kept for counted in each)} of {sum(counted.n for counted in each)}"


def of_driver(driver: str) -> str:
    """The same of one driver, over all numbers of updates."""
    return f"{over_updates(driver).kept} of {over_updates(driver).n}"


def _short(p: float) -> str:
    return f"{p:.2f}" if p >= 0.1 else f"{p:.3f}" if p >= 0.001 else "< 0.001"


def kept_against(first: tuple[Results, str], second: tuple[Results, str]) -> str:
    """ "2 of 10 against 10 of 10": how many agents of two groups keep the way out."""
    return " against ".join(f"{way(*group).kept} of {way(*group).n}" for group in (first, second))
