"""Experiments that vary the paper's method: what it leaves open, its choices one by one, and saner numbers."""

from dataclasses import replace

from bootcourse.learn.settings import SETTINGS
from bootcourse.research.plan import Experiment, Variation
from bootcourse.scenario import DEFAULT


def traps(speed: float) -> Variation:
    """Faster traps, m/s."""
    return Variation(scenario=replace(DEFAULT, name=f"traps-{speed}", traps=replace(DEFAULT.traps, speed=speed)))


def traffic(name: str, **changes) -> Variation:
    """The traffic, changed."""
    return Variation(scenario=replace(DEFAULT, name=name, traffic=replace(DEFAULT.traffic, **changes)))


SENSITIVITY = Experiment(  # what the paper leaves open, and three of its choices
    {
        "as it is": Variation(),
        "traps at 10.3 m/s": traps(10.3),
        "traps at 10.6 m/s": traps(10.6),
        "traps at 11 m/s": traps(11.0),
        "no traffic": traffic("no-traffic", cars=0),
        "3 cars": traffic("3-cars", cars=3),
        "12 cars": traffic("12-cars", cars=12),
        "6 cars, twice as close": traffic("close", lead=20.0, headway=20.0),
        "network 32 x 32": Variation({"hidden": (32, 32)}),
        "network 128 x 128": Variation({"hidden": (128, 128)}),
        "1 update for each decision": Variation({"updates": 4}),
        "demonstrations driven by π̃": Variation({"stochastic_demonstrations": True}),
        "target entropy 0.3": Variation({"target_entropy": 0.3}),
        "target entropy 1": Variation({"target_entropy": 1.0}),
        "γ = 0.9": Variation({"gamma": 0.9}),
        "γ = 0.95": Variation({"gamma": 0.95}),
        "γ = 0.99": Variation({"gamma": 0.99}),
        "γ = 0.9, target entropy 0.3": Variation({"gamma": 0.9, "target_entropy": 0.3}),
    },
    seeds=3,
    episodes=1500,
)
HELPED = ("demos", "bootstrapped")
ABLATIONS = Experiment(  # one choice of the method changed
    {
        "KL in the actor only": Variation({"kl_in_target": False}, methods=("soft", "bootstrapped")),
        "β over 300 episodes": Variation({"beta_episodes": 300}, methods=HELPED),
        "β for ever": Variation({"beta_episodes": None}, methods=HELPED),
        "ξ stays at 2": Variation({"xi_fixed": 2.0}, methods=("soft",)),
    },
    seeds=10,
    episodes=2000,
)
# A longer view, a smaller bonus, a larger batch and two updates per decision
SANER = {**SETTINGS["paper"], "gamma": 0.95, "bonus": 0.5, "batch": 128}
LONGER_VIEW = Experiment({"γ = 0.95": Variation(SANER, methods=("bootstrapped",))}, seeds=10, episodes=1500)
