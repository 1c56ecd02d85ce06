"""To drag in this lesson: a true rate above an exact interval, the counts of two methods, intervals of few seeds."""

from functools import lru_cache

import numpy as np
import scipy

from bootcourse.colours import INK, QUIET
from bootcourse.course.shipped import shipped_results
from bootcourse.methods import style
from bootcourse.panels.explorable import CHART, WIDTH, Explorable
from bootcourse.panels.number import Number, whole_number
from bootcourse.plots.svg import Drawing, SvgAxes, drawing, over, rect, text, ticks
from bootcourse.statistics import rate, significant

SHARE, MOST = 0.8, 60  # of the trained agents so many escape; at most so many are trained
PLAIN = "#B8BEC6"  # of what does not count
STUDIES, DRAWS = 100, 2000  # that are shown, and of each study's bootstrap
RARE = 2.5  # %: so rare is what was seen, or more extreme, at the ends of an interval
NUMBERED = 20  # with at most so many agents the bars have room for their percentages
DRAWN = 10.0  # %: up to here the two curves over the true rate are drawn
RESOLUTION = 400  # studies are drawn for each that is shown


def blue_part(true: np.ndarray | float, k: int, n: int) -> np.ndarray:
    """How often k or more of n escape, in %, at a true rate (%) of up to k / n; above it, how often k or fewer do."""
    or_more = scipy.stats.binom.sf(k - 1, n, np.divide(true, 100))
    return 100 * np.where(np.less_equal(true, 100 * k / n), or_more, scipy.stats.binom.cdf(k, n, np.divide(true, 100)))


def certainty() -> Explorable:
    """How many agents escape at a true rate, above how rare so many are at each, while rate and agents move."""
    colour, everywhere = style("soft").colour, np.linspace(0, 100, 2001)

    def draw(true: float, agents: float) -> Drawing:
        n, k = int(agents), round(SHARE * agents)
        chances, more = scipy.stats.binom.pmf(np.arange(n + 1), n, true / 100), true <= 100 * k / n
        counted = np.arange(n + 1) >= k if more else np.arange(n + 1) <= k
        blue, curve = float(blue_part(true, k, n)), blue_part(everywhere, k, n)
        _, low, high = (100 * part for part in rate(np.arange(n) < k))
        or_so = f"{k} or {'more' if more else 'fewer'}"
        says = f"If {true:g} % escape in truth, {or_so} of {n} escape in "
        says += f"{blue:.1f} % of all studies."
        counts = SvgAxes(52, 66, 690, 110, (-0.6, n + 0.6), (0.0, 1.15 * chances.max()))
        for count, (chance, inside) in enumerate(zip(chances, counted, strict=True)):
            sides = [count - 0.4, count + 0.4, count + 0.4, count - 0.4]
            counts.fill(sides, [0, 0, chance, chance], colour if inside else PLAIN)
            if chance >= 0.0005 and n <= NUMBERED:
                x, y = counts.at(count, chance)
                shade = colour if inside else QUIET
                counts.parts.append(text(x, y - 3, f"{100 * chance:.1f}", "middle", shade, 11, bold=inside))
        for count in ticks(0, n, 10):
            counts.parts.append(text(counts.at(count, 0)[0], 191, f"{count:g}", "middle", QUIET, 10.5))
        below = SvgAxes(52, 232, 690, 120, (0.0, 100.0), (0.0, DRAWN))
        below.scale(f"% of studies (cut at {DRAWN:g}); shaded: both over {RARE:g} %", 4)
        below.fill([low, high, high, low], [0, 0, DRAWN, DRAWN], colour, 0.15)
        below.line([0, 100], [RARE, RARE], INK, 1, "--")
        below.line(everywhere, np.where(curve <= DRAWN, curve, np.nan), colour, 2)
        below.line([true, true], [0, DRAWN], QUIET, 0.8, "--")
        for end, words in ((low - 3, f"{k} or more"), (high - 4, f"{k} or fewer")):  # left of the rise, of the fall
            below.parts.append(over(text(*below.at(end, 6), words, "end", colour, 11, bold=True)))
        below.dot(true, blue, INK)
        for tick in ticks(0, 100, 10):
            below.parts.append(text(below.at(tick, 0)[0], 367, f"{tick:g}", "middle", QUIET, 10.5))
        words = [
            text(4, 20, says, size=14, bold=True),
            text(52, 54, f"% of studies in which so many of {n} escape (blue: {or_so})", bold=True),
            text(397, 384, "true rate (%); the dot: yours", "middle", QUIET, 11),
        ]
        alt = f"{says} At true rates of {low:.0f} to {high:.0f} % both {k} or more and {k} or fewer come in over "
        alt += f"{RARE:g} % of studies."
        return drawing(WIDTH, 390, [*words, *counts.parts, *below.parts], alt)

    numbers = {
        "true": Number("true rate", 50, 0, 100, 0.5, "So many of a hundred agents would escape in truth.", "%"),
        "agents": Number("agents", 10, 5, MOST, 5, f"So many were trained, and {100 * SHARE:.0f} % of them escape.",
                         check=whole_number("agents", 5, MOST)),
    }  # fmt: skip
    return Explorable("Which true rates are believable?", draw, **numbers)


def disc(x: float, y: float, radius: float, colour: str = "") -> str:
    """A disc of that colour; without one, an empty circle."""
    look = f'fill="{colour or "#FFFFFF"}" stroke="{colour or QUIET}"'
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius:.1f}" {look}/>'


def studies() -> Explorable:
    """All pairs of counts of two methods, each a disc as large as its chance, filled where Fisher's test sees it."""
    colour, most = style("bootstrapped").colour, 30

    def draw(agents: float, first: float, second: float) -> Drawing:
        n, shown = int(agents), significant(int(agents))
        k, j = (scipy.stats.binom.pmf(np.arange(n + 1), n, true / 100) for true in (first, second))
        chances = np.outer(k, j)
        found = round(100 * chances[shown].sum())
        says = f"{n} agents of each: {found} of 100 studies tell {first:g} from {second:g} %."
        board = SvgAxes(52, 62, 232, 232, (-0.5, n + 0.5), (-0.5, n + 0.5))
        for y, x in np.argwhere(shown):
            board.fill([x - 0.5, x + 0.5, x + 0.5, x - 0.5], [y - 0.5, y - 0.5, y + 0.5, y + 0.5], colour, 0.18)
        for y, x in np.argwhere(chances > 1e-4):
            board.parts.append(disc(*board.at(x, y), 36 * chances[y, x] ** 0.5, colour if shown[y, x] else ""))
        for count in ticks(0, n, 5):
            board.parts.append(text(46, board.at(0, count)[1] + 3.5, f"{count:g}", "end", QUIET, 10.5))
            board.parts.append(text(board.at(count, 0)[0], 308, f"{count:g}", "middle", QUIET, 10.5))
        words = [
            text(4, 20, says, size=14, bold=True),
            text(4, 50, f"agents of the first method that escape ({first:g} % in truth)", bold=True),
            text(52, 325, f"agents of the second method that escape ({second:g} % in truth)", bold=True),
            text(346, 120, "A disc is a possible study; its area says how often it comes."),
            disc(354, 150, 8, colour),
            text(370, 154, f"{found} of 100: the test finds the difference", bold=True),
            disc(354, 182, 8),
            text(370, 186, f"{100 - found} of 100: the test misses it", bold=True),
            rect(346, 206, 16, 16, colour, 'opacity="0.18"'),
            text(370, 218, "the counts that the test tells apart, either way (p < 0.05)"),
        ]
        return drawing(WIDTH, 332, [*board.parts, *words], says)

    numbers = {
        "agents": Number("agents", 10, 2, most, 1, "So many of each method were trained.",
                         check=whole_number("agents", 2, most)),
        "first": Number("first", 80, 0, 100, 5, "So many of a hundred agents of the first method would escape.", "%"),
        "second": Number("second", 30, 0, 100, 5, "So many of a hundred of the second would.", "%"),
    }  # fmt: skip
    return Explorable("Which studies find the difference?", draw, **numbers)


@lru_cache
def drawn(seeds: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Studies of so many of our agents: the interval of the mean, low and high; whether it contains the mean of all.

    Of many studies in the order of their means each 400th is taken, so that these stand for all.
    """
    returns, rng = shipped_results().of("bootstrapped").scores("returns"), np.random.default_rng(1)
    groups = returns[rng.integers(len(returns), size=(STUDIES * RESOLUTION, seeds))]
    groups = groups[np.argsort(groups.mean(axis=1))][RESOLUTION // 2 :: RESOLUTION]
    times = rng.multinomial(seeds, [1 / seeds] * seeds, DRAWS)  # how often each agent is drawn
    low, high = np.quantile(groups @ times.T / seeds, [0.025, 0.975], axis=1)
    return low, high, (low <= returns.mean()) & (returns.mean() <= high)


def holding(seeds: int) -> int:
    """Of 100 such intervals so many contain the mean."""
    return int(drawn(seeds)[2].sum())


def intervals() -> Explorable:
    """The intervals of a hundred studies of few seeds, drawn from our ten, and which contain the mean of the ten."""
    returns = shipped_results().of("bootstrapped").scores("returns")
    mean, colour = float(returns.mean()), style("bootstrapped").colour

    def draw(seeds: float) -> Drawing:
        low, high, holds = drawn(int(seeds))
        says = f"{seeds:g} seeds: {holds.sum()} of {STUDIES} intervals contain the mean of all, {mean:.0f}."
        chart = SvgAxes(*CHART, (0.0, STUDIES), (-20.0, 140.0))
        chart.scale("95 % bootstrap interval of the mean return (orange: misses; line: the mean of all)", 4)
        for place, (bottom, top, inside) in enumerate(zip(low, high, holds, strict=True)):
            ends = [bottom - 0.8, top + 0.8]  # an interval without length is seen, too
            chart.line([place + 0.5] * 2, ends, PLAIN if inside else colour, 2.4)
        chart.line([0, STUDIES], [mean, mean], INK, 1.2)
        under = text(397, 276, f"{STUDIES} studies, in the order of their means", "middle", QUIET, 11)
        return drawing(WIDTH, 300, [text(4, 20, says, size=14, bold=True), *chart.parts, under], says)

    seeds = Number("seeds", 3, 2, 10, 1, "So many agents are drawn for each study.", check=whole_number("seeds", 2, 10))
    return Explorable("What if all agents were like our ten?", draw, seeds=seeds)
