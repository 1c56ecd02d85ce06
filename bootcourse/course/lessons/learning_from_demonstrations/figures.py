"""What the lesson on demonstrations draws: two agents that learn, and returns with the bonus."""

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import INK
from bootcourse.course.lessons.learning_from_demonstrations import measures
from bootcourse.course.live_curves import LiveWayOut
from bootcourse.learn.training import Training
from bootcourse.methods import style
from bootcourse.plots.figure import TEXT, axes_at, finish, new_figure, plain_axes
from bootcourse.research.report import rule_results
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import rolling_means

WINDOW, LAST, ROADS = 50, 600, 1000  # episodes of a mean; until which episode they are drawn; roads of the rule
NO_BONUS = "#332288"


class LiveDemonstrations(LiveWayOut):
    """Two agents while they learn, the first with demonstrations; below, when those that trained found the way out.

    All have the soft constraint; twenty of each kind have trained: the study's ten, and the ten others. Between the two
    kinds stand those with demonstrations and no bonus.
    """

    def __init__(self):
        helped, alone = (style(method).colour for method in ("bootstrapped", "soft"))
        rows = {"demonstrations, c = 2": helped, "demonstrations, c = 0": NO_BONUS, "no demonstrations": alone}
        trained = {name: (colour, measures.found(measures.kinds()[name][0])) for name, colour in rows.items()}
        super().__init__({"with demonstrations": helped, "without": alone}, trained, "one of twenty agents")

    def draw(self, training: Training) -> Figure:
        """The title says what the dots show: the two lines end at different episodes."""
        figure, found = super().draw(training), [episodes for _, episodes in self.trained.values()]
        if found[0].max() >= found[-1].min():
            return figure
        return finish(figure, "With demonstrations and c = 2 all twenty find the way out earlier", figure.alt)


def returns(groups: dict[str, Results]) -> Figure:
    """The mean return of groups of ten agents in their first episodes, and below how often they succeed."""
    title = f"Up to episode {LAST} the bonus holds the return down and the success up"
    figure, rule, said = new_figure(4.6), rule_results(DEFAULT, ROADS).scores("returns").mean(), []
    above, below = axes_at(figure, 0.6, 0.75, 5.2, 1.8), axes_at(figure, 0.6, 2.95, 5.2, 1.1)
    plain_axes(above, f"return, no bonus counted: mean of ten agents and {WINDOW} episodes")
    plain_axes(below, "success, % of these episodes")
    for name, agents in groups.items():
        colour = style("bootstrapped").colour if agents.agents[0]["bonus"] else NO_BONUS
        for ax, curve, unit in ((above, "return", 1), (below, "success", 100)):
            at, mean = rolling_means(agents.curves[curve], WINDOW, points=agents.curves[curve].shape[1] // 20)
            ax.plot(at, unit * mean.mean(axis=0), color=colour, linewidth=2.2)
            said.append(f"{curve}, {name}: {unit * np.interp(450, at, mean.mean(axis=0)):.0f}")
            if ax is above:
                end = np.interp(LAST, at, mean.mean(axis=0))
                above.text(LAST + 8, end, name, va="center", fontsize=TEXT, color=colour)
    above.axhline(rule, color=style("rule").colour, linewidth=1, linestyle=(0, (2, 2)))
    above.text(4, rule + 2, f"the rule: {rule:.0f}", fontsize=TEXT, color=style("rule").colour, va="bottom")
    for ax in (above, below):
        ax.set(xlim=(0, LAST), xticks=range(0, LAST + 1, 100))
    above.set(ylim=(-20, 130))
    above.tick_params(labelbottom=False)
    below.set(ylim=(0, 104), yticks=(0, 50, 100))
    below.set_xlabel("training episode", fontsize=TEXT, color=INK)
    return finish(figure, title, f"Near episode 450: {'; '.join(said)}. The rule's return: {rule:.0f}.")
