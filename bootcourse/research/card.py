"""The model card of the agents that ship, with the numbers of the shipped study."""

from bootcourse.research.results import KINDS, Results
from bootcourse.research.tables import HEADINGS, bracketed, k_of_n, markdown, score
from bootcourse.statistics import ESCAPES


def model_card(results: Results, runs: int) -> str:
    """The card as markdown. results: of the default scenario; runs: the seeds of each method whose weights ship."""
    rows = []
    for method in results.methods:
        mine = results.of(method)
        accidents = [f"{100 * mine.episodes(kind).mean():.1f}" for kind in KINDS]
        escape = k_of_n(mine.scores("success") >= ESCAPES)
        rows.append([method, escape, bracketed(score(results, method, "returns")), *accidents])
    return CARD.format(
        table=markdown(["method", "agents that escape", *(HEADINGS[name] for name in ("returns", *KINDS))], rows),
        tests=results.sizes[0],
        escapes=f"{100 * ESCAPES:g}",
        hidden=" x ".join(map(str, results.agents[0]["hidden"])),
        runs=runs,
    )


CARD = """# Model card

**What they are.** The agents in `runs/`: a folder for each of the first {runs} seeds of each method, trained on the
default scenario of this course by `bootcourse study`. Each is an actor and two critics with hidden layers of
{hidden} neurons; it reads 26 numbers and chooses one of 9 actions, once a second. The weights are those at the
end of training: none was selected.

**What they are for.** Lessons: to be driven, replayed, compared and taken apart. **What they are not for:**
anything on a road. They have seen one straight road, one kind of trap and eight other cars that are models
themselves, and some of them crash often.

**How well they drive.** {tests} held-out episodes each, by their most probable action. An agent escapes if at least
{escapes} % of them end ahead of trap 1. Returns are interquartile means over agents with a 95 % interval. Accident
rates are means over the agents' episodes: an interquartile mean would leave out the agents that crash most.

{table}
**Data.** Their own driving in simulation, and for some methods 200 simulated episodes of a rule
controller. No person and no real car is in it.

**Known faults.** Success counts a crash after overtaking, as the paper does: read it beside the accidents.
"""
