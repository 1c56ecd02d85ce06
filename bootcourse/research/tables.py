"""The study's tables, as Markdown: one function each."""

from collections.abc import Sequence

import numpy as np

from bootcourse.methods import display_name
from bootcourse.research.paper import COLUMNS, PRINTED, RATES, ROWS
from bootcourse.research.results import MEASURES, Results
from bootcourse.statistics import ESCAPES, Estimate, bracketed, improvement, interval, iqm, mean, number, rate

FOUND_AND_KEPT = "found, kept"  # the heading of what `found_and_kept` says
HEADINGS = COLUMNS | {"road_departure": "road departures, %", "stoppage": "stops, %"}


def markdown(headings: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table in Markdown, a line for each row."""
    lines = [headings, ["---"] * len(headings), *rows]
    return "\n".join("| " + " | ".join(str(cell).replace("|", "\\|") for cell in line) + " |" for line in lines) + "\n"


def k_of_n(hits: np.ndarray) -> str:
    """ "1 of 10 (0 to 45 %)": how many, and the exact 95 % interval of the rate, if n > 1. hits (n,) bool."""
    share, counted = rate(hits), f"{int(np.sum(hits))} of {len(hits)}"
    return counted if len(hits) < 2 else f"{counted} ({100 * share.low:.0f} to {100 * share.high:.0f}\u00a0%)"


def escaped(results: Results, method: str) -> str:
    """ "7 of 10": how many agents of a method escape."""
    return f"{results.escapers(method)} of {len(results.of(method))}"


def found_and_kept(results: Results, method: str) -> str:
    """ "8, 6 of 10": how many agents of a method found the way out in training, and how many of these kept it."""
    found, kept = results.found_and_kept(method)
    return f"{found.sum()}, {kept.sum()} of {len(found)}"


def score(results: Results, method: str, measure: str, statistic=iqm) -> Estimate:
    """A statistic over agents with its interval, rates in %; of a single driver, the mean of its episodes."""
    agents, scale = results.of(method), 100 if measure in RATES else 1
    if len(agents) > 1:
        numbers = interval(agents.scores(measure), statistic)
    else:
        episodes = agents.episodes(measure)[0]
        numbers = rate(episodes > 0) if measure in RATES else mean(episodes)
    return Estimate(*(scale * each for each in numbers))


def result_table(results: Results, methods: Sequence[str]) -> str:
    """A result table of the paper: its row above ours. Means with deviations as it prints them, then intervals."""
    rows = []
    for method in methods:
        printed = PRINTED.get(method)
        if printed:
            cells = [f"{printed[column].mean:g} ± {printed[column].sd:g}" for column in COLUMNS]
            rows.append([f"**{ROWS[method]}**", "paper: mean ± SD", *cells, "", ""])
        if method not in results.methods:
            rows.append(["", "ours", *["not run"] * len(MEASURES)])
            continue
        agents = results.of(method)
        scale = {measure: 100 if measure in RATES else 1 for measure in MEASURES}
        spread = [(agents.episodes(m).mean() * scale[m], agents.episodes(m).std(ddof=1) * scale[m]) for m in MEASURES]
        label = "" if printed else f"**{display_name(method)}**"
        rows.append([label, "ours: mean ± SD", *(f"{number(a)} ± {number(b)}" for a, b in spread)])
        kind = f"ours: IQM over {len(agents)} agents [95 %]" if len(agents) > 1 else "ours: mean [95 %]"
        rows.append(["", kind, *(bracketed(score(results, method, measure)) for measure in MEASURES)])
    return markdown(["", "", *(HEADINGS[measure] for measure in MEASURES)], rows)


def escape_table(results: Results, trained: Results, bound: np.ndarray | None = None) -> str:
    """How many agents escape, find and keep the way out, and what share of the best known return they reach.

    trained: those of the agents that have training curves.
    """
    rows = []
    for method in results.methods:
        agents = results.of(method)
        success = agents.scores("success")
        cells = [display_name(method), k_of_n(success >= ESCAPES)]
        cells.append(found_and_kept(trained, method) if method in trained.methods else "–")
        returns = agents.scores("returns")
        cells.append(f"{number(returns.min())} to {number(returns.max())}")
        if bound is not None:
            cells.append(bracketed(interval(returns / bound.mean()), 100))
        rows.append(cells)
    escapes = "agents that escape (95 % interval of the rate)"
    headings = ["method", escapes, FOUND_AND_KEPT, "returns of single agents"]
    return markdown([*headings, *(["share of the best known return, % (IQM)"] if bound is not None else [])], rows)


def improvement_rows(results: Results, method: str = "bootstrapped", measure: str = "returns") -> tuple[list, list]:
    """How often a random agent of a method scores above a random agent of each other: (headings, rows)."""
    scores = results.of(method).scores(measure)
    rows = []
    for other in results.methods:
        if other != method and len(results.of(other)) > 1:
            rows.append([display_name(other), bracketed(improvement(scores, results.of(other).scores(measure)), 100)])
    return [f"P({display_name(method)} > ...) on {HEADINGS[measure]}", "% [95 %]"], rows


def sensitivity_table(results: dict[str, Results], measure: str) -> str:
    """One row for each variation, one column for each method: mean over seeds, lowest to highest seed."""
    methods = next(iter(results.values())).methods
    scale = 100 if measure in RATES else 1
    rows = []
    for variation, varied in results.items():
        cells = []
        for method in methods:
            scores = varied.of(method).scores(measure) * scale
            cells.append(f"{number(scores.mean())} ({number(scores.min())} to {number(scores.max())})")
        rows.append([variation, *cells])
    return markdown([HEADINGS[measure], *(display_name(method) for method in methods)], rows)


def measured_table(varied: dict[str, Results]) -> str:
    """Whatever an experiment measured: means over agents, a row for each variation and method."""
    rows, columns = [], {}
    for variation, results in varied.items():
        for method in results.methods:
            agents = results.of(method)
            means = {name: values.mean() for name, values in agents.measured.items()}
            means |= {
                name: agents.episodes(name).mean() for name in ("success", "returns", "accident") if agents.tested
            }
            columns |= dict.fromkeys(means)
            rows.append(([variation, display_name(method), len(agents)], means))
    cells = [[*first, *(number(means[name]) if name in means else "" for name in columns)] for first, means in rows]
    return markdown(["", "method", "agents", *columns], cells)


def variations_table(varied: dict[str, Results]) -> str:
    """Who escapes and what they earn, a row for each variation and method."""
    rows = []
    for variation, results in varied.items():
        for method in results.methods:
            cells = [bracketed(score(results, method, measure)) for measure in ("success", "returns", "collision")]
            rows.append([variation, display_name(method), found_and_kept(results, method), *cells])
    headings = ["changed", "method", FOUND_AND_KEPT]
    return markdown([*headings, *(HEADINGS[m] for m in ("success", "returns", "collision"))], rows)
