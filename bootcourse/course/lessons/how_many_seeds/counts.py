"""Computed for the lesson: groups of an ablation, comparisons in which nothing was changed, the course's sentences."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from bootcourse.course.shipped import shipped_experiment, shipped_results
from bootcourse.research.results import Results
from bootcourse.statistics import Estimate, all_resamples, bracketed, difference, fisher, holm, iqm, lost

ABLATION = ["success, %", "IQM", "the agents, sorted"]
RESAMPLES = 10_000
STUDIES, RESOLUTION = 100, 400  # comparisons that are shown; so many are drawn for each
FIVE = 5  # agents of a group where nothing was changed


def ablation(success: dict[str, np.ndarray], interval_of: Callable) -> tuple[list[list[str]], str]:
    """The rows below `ABLATION` of two groups of agents (success 0 to 1), and their difference as a sentence.

    interval_of: the exercise `difference_interval`, the student's or ours.
    """
    groups = {name: 100 * np.sort(group) for name, group in success.items()}
    rows = [[name, f"{iqm(each):.0f}", ", ".join(f"{one:.0f}" for one in each)] for name, each in groups.items()]
    effect = effect_of(success, interval_of)
    says = "leaves out 0" if leaves_out_0(effect) else "contains 0"
    return rows, f"Changed less unchanged: {with_ends(effect)} points. The interval {says}."


def with_ends(effect: Estimate) -> str:
    """ "-4 [-12, 3]"; with a decimal if an end rounds to 0, so that one reads whether 0 is inside: "28 [0.2, 85.2]"."""
    value, low, high = effect
    if 0 in (round(low), round(high)) and high - low >= 10:
        return f"{value:.0f} [{low:.1f}, {high:.1f}]"
    return bracketed(effect)


def effect_of(success: Mapping[str, np.ndarray], interval_of: Callable) -> Estimate:
    """Changed less unchanged, in points: of two groups, the unchanged first."""
    unchanged, changed = (100 * np.sort(group) for group in success.values())
    rng = np.random.default_rng(0)
    draws = [rng.integers(len(each), size=(RESAMPLES, len(each))) for each in (changed, unchanged)]
    return Estimate(*map(float, interval_of(changed, unchanged, *draws)))


def leaves_out_0(effect: Estimate) -> bool:
    return not effect.low <= 0 <= effect.high


def exact_difference(x: np.ndarray, y: np.ndarray) -> Estimate:
    """`statistics.difference` of two small groups, (n,) each, from all their resamples instead of random ones."""
    rows, chances = all_resamples(*[1] * len(x))
    resampled = np.subtract.outer(iqm(x[rows]), iqm(y[rows])).ravel()
    order = np.argsort(resampled)
    upward = np.outer(chances, chances).ravel()[order]
    below, above = (np.searchsorted(np.cumsum(each), 0.025) for each in (upward, upward[::-1]))
    return Estimate(float(iqm(x) - iqm(y)), *map(float, resampled[order[[below, -1 - above]]]))


def drawn_twice(scores: np.ndarray) -> list[Estimate]:
    """Five of the scores less five others, both drawn with replacement: comparisons, the lowest difference first.

    Of many comparisons in the order of their differences each 400th is taken, so that these stand for all.
    """
    groups = scores[np.random.default_rng(1).integers(len(scores), size=(STUDIES * RESOLUTION, 2, FIVE))]
    apart = iqm(groups[:, 0]) - iqm(groups[:, 1])
    return [exact_difference(x, y) for x, y in groups[np.argsort(apart)][RESOLUTION // 2 :: RESOLUTION]]


def of_new_agents(new: Mapping[str, Results], agents: int) -> Estimate:
    """Success (%) of the first so many agents of the experiment `new_agents`: changed less unchanged."""
    changed, unchanged = (100 * new[group].measured["success"][:agents] for group in ("changed", "as it is"))
    return difference(changed, unchanged)


SENTENCES = ["sentence", "how many agents", "p", "p after Holm"]


def compared() -> dict[str, tuple[int, int, int]]:
    """Sentences of the course about two groups of agents: {sentence: (of the first, of the second, of how many)}.

    Groups of twenty are the study's ten and ten others, or those of the lesson on the barrier.
    """
    study, others, changed = shipped_results(), shipped_experiment("stress"), shipped_experiment("ablations")
    easier = {kind: agents.escapers("sac") for kind, agents in shipped_experiment("easier").items()}
    fading = [study.of("soft"), others["soft"]]
    weak, floor = ([changed[kind].of("soft"), others[f"soft, {kind}"]] for kind in ("ξ stays at 0.1", "ξ falls to 0.1"))
    both = [study.of("bootstrapped"), others["bootstrapped"]]

    def escape(groups: Sequence[Results]) -> int:
        return sum(agents.escapers(agents.methods[0]) for agents in groups)

    def lose(groups: Sequence[Results]) -> int:
        return sum(int(lost(agents.curves["success"]).sum()) for agents in groups)

    cheap, free = easier["mid-lane, and accidents cost 1"], easier["a later start, mid-lane"]
    return {
        "1. With both aids more agents escape than without aids": (escape(both[:1]), study.escapers("sac"), 10),
        "2. With a free lane, cheap accidents let more agents escape": (cheap, free, 20),
        "3. A free lane alone lets more agents escape": (free, easier["as it is"], 20),
        "4. With a floor under ξ more agents escape": (escape(floor), escape(fading), 20),
        "5. With a floor under ξ fewer agents lose the way out": (lose(floor), lose(fading), 20),
        "6. With a pull that is weak throughout, fewer escape than with the floor": (escape(weak), escape(floor), 20),
        "7. Beside the pull, demonstrations let more agents escape": (escape(both), escape(fading), 20),
    }


def p_values() -> list[float]:
    """Fisher's two-sided p of each sentence."""
    return [fisher(*counted) for counted in compared().values()]


def sentences() -> list[list[str]]:
    """The rows below `SENTENCES`."""
    shown = [[f"{each:.2g}" if each >= 0.0001 else "< 0.0001" for each in p] for p in (p_values(), holm(p_values()))]
    rows = zip(compared().items(), *shown, strict=True)
    return [[said, f"{k} and {j} of {n}", *p] for (said, (k, j, n)), *p in rows]
