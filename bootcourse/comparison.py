"""Some trainings side by side, in any environment: their curves, and a table of what the trained agents reach.

settings = bc.settings_for("soft", gamma=0.99)
bc.compare({"soft": settings, "a clone of my rule": bc.settings_for("bc")}, make_env=my_env, teacher=my_rule)
"""

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace

import numpy as np
from gymnasium.vector import VectorEnv
from matplotlib.figure import Figure

from bootcourse.episodes.evaluate import Episodes, drive_episodes, held_out_seeds
from bootcourse.errors import BootcourseError, check_known, whole
from bootcourse.learn.settings import Settings, with_seeds
from bootcourse.learn.training import Result, Training
from bootcourse.markup import html
from bootcourse.plots.training_curves import training_curves
from bootcourse.statistics import bracketed, interval
from bootcourse.terminal import printable

Entry = Settings | Callable[[int], Training]
MOST_EPISODES = 50_000  # whose curves are kept where decisions are counted


@dataclass(frozen=True, repr=False)
class Comparison:
    """What some trainings reached. As the last line of a cell it shows its table; `bc.show(it.figure())` the curves."""

    results: dict[str, Result]
    tested: dict[str, list[Episodes]]  # of each agent, with its most probable actions
    decisions: int | None = None  # that each agent was to make in training; None: episodes were counted

    def scores(self, name: str, measure: str = "returns") -> np.ndarray:
        """Each agent's mean over its test episodes, (seeds,). measure: a field of `Episodes`.

        Raises BootcourseError for an unknown name or measure.
        """
        check_known("Training", name, self.tested)
        check_known("Measure", measure, [field.name for field in fields(Episodes)])
        return np.array([getattr(episodes, measure).mean() for episodes in self.tested[name]])

    def rows(self) -> list[tuple[str, ...]]:
        """The table: a heading and a row for each training, with 95 % intervals over its seeds."""
        table = [("", "agents", "success, % [95 %]", "return [95 %]", "decisions of an agent", "seconds")]
        for name, result in self.results.items():
            finished = np.nansum(result.curves["decisions"], axis=1).mean()
            decisions = finished if self.decisions is None or result.interrupted else self.decisions
            success, returns = 100 * self.scores(name, "success"), self.scores(name)
            scores = ["–" if np.isnan(each).any() else bracketed(interval(each)) for each in (success, returns)]
            cells = str(len(result.agents)), *scores, f"{decisions:,.0f}", f"{result.seconds:.0f}"
            table.append((name + ", interrupted" * result.interrupted, *cells))
        return table

    def figure(self, title: str = "") -> Figure:
        """The training curves: success, where the environment reports it, and return."""
        curves = {name: result.curves for name, result in self.results.items()}
        reported = all(np.isfinite(each["success"]).any() for each in curves.values())
        return training_curves(curves, title, measures=("success", "return") if reported else ("return",))

    def __repr__(self) -> str:
        widths = [max(map(len, column)) for column in zip(*self.rows(), strict=True)]
        return printable("\n".join("  ".join(map(str.ljust, row, widths)).rstrip() for row in self.rows()))

    def _repr_html_(self) -> str:
        cells = [[html('<td style="padding: 0.2em 0.8em">{}</td>', cell) for cell in row] for row in self.rows()]
        head, *rows = map("".join, cells)
        return f"<table><thead><tr>{head}</tr></thead>" + "".join(f"<tr>{row}</tr>" for row in rows) + "</table>"


def compare(
    entries: Mapping[str, Entry],
    seeds: int = 5,
    episodes: int = 1000,
    tests: int = 100,
    decisions: int | None = None,
    make_env: Callable[[int], VectorEnv] | None = None,
    progress: bool = True,
    **training,
) -> Comparison:
    """Train each entry with the same number of seeds, and test its agents in the same episodes.

    entries: by name, settings, or a function of the number of seeds that returns a `Training` of your own. A name that
    begins with a method's has its colour, any other one of its own. episodes: of training. tests: episodes that test an
    agent. decisions: that each agent makes in training, in place of `episodes`; episodes of different length give
    methods unequal practice. make_env and training: further arguments of `Training`, such as teacher.
    An interrupt ends the comparison: the agents in training are tested as they are, and a warning says what is missing.
    Raises BootcourseError if there are no entries, if an entry is neither, and if the first training is interrupted
    before its first update.
    """
    if not entries or not isinstance(entries, Mapping):
        raise BootcourseError(f'There is nothing to compare in {entries!r:.80}: give {{"mine": settings}}.')
    if decisions is not None:
        episodes = min(whole(decisions, "decisions", low=1), MOST_EPISODES)
    results, tested, unit = {}, {}, "episodes" if decisions is None else "decisions"
    for name, entry in entries.items():
        if isinstance(entry, Settings):
            one = Training(with_seeds(entry, seeds), episodes, make_env=make_env, **training)
        else:
            one = entry(seeds) if callable(entry) else None
        if not isinstance(one, Training):
            raise BootcourseError(f"'{name}' is {entry!r:.80}: give settings, or a function seeds -> Training.")
        result, held_out = _run(one, progress, decisions), held_out_seeds(1, tests)
        if one.updates:
            policies = [agent.as_policy() for agent in result.agents]
            results[name] = result
            tested[name] = [drive_episodes(drive, held_out, one.scenario, make_env=one.make_env) for drive in policies]
        if result.interrupted:
            missing = [f"'{other}'" for other in entries if other not in results]
            driven = int(np.minimum(one.curves.finished, one.episodes).min())
            rest = f" There is no row for {', '.join(missing)}." if missing else ""
            warnings.warn(f"'{name}' was interrupted after {driven} of {one.episodes} episodes.{rest}", stacklevel=2)
            break
        if not one.updates:
            raise BootcourseError(f"'{name}' made no update in {decisions or one.episodes} {unit}: give more {unit}.")
    if not tested:
        raise BootcourseError("The first training was interrupted before its first update: nothing can be compared.")
    return Comparison(results, tested, decisions)


def _run(training: Training, progress: bool, decisions: int | None) -> Result:
    """Its result after so many decisions of each agent, which is no interrupted one; or after its episodes."""

    def spent() -> bool:
        return decisions is not None and training.decisions >= decisions * training.n_agents

    result = training.run(progress, stop=spent)
    return replace(result, interrupted=result.interrupted and not spent())
