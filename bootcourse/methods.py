"""The registry of methods: settings, learner, name and style of each.

To add a method, write its learner (one file: see learn/learner.py for what may be overridden; settings of its own stand
there, too) and one entry in this file. Or, for a method of your own:

    with own_method("mine", Method("my method", Style("#117733"), {"xi_multiplier": 0.0}, MyLearner)):

Training, files, evaluation, figures and the training panel then include it.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pkgutil import resolve_name
from types import MappingProxyType
from typing import Any

from bootcourse.colours import OTHER, Style
from bootcourse.errors import require

SAC = "bootcourse.learn.learner:SACLearner"
SETTINGS = "bootcourse.learn.settings:Settings"


@dataclass(frozen=True)
class Method:
    """One method of the registry. Classes are given as "module:class" and imported when they are needed: torch is slow.

    A method that is `taught` asks the teacher while it trains, apart from demonstrations and the KL of weight ξ.
    """

    name: str  # in text and figures
    style: Style  # in figures
    settings: dict = field(default_factory=dict)  # those that differ from `bootstrapped`, whose values are the defaults
    learner: str | type = SAC
    kind: str | type = SETTINGS  # the class of its settings
    on_policy: bool = False  # learns from its own last decisions alone
    episodes: int = 1000  # of training of each agent, by default
    taught: bool = False

    def learner_class(self) -> type:
        """The learner's class."""
        return _imported(self.learner)

    def settings_class(self) -> type:
        """The class of the settings."""
        return _imported(self.kind)


def _imported(place: str | type) -> type:
    return place if isinstance(place, type) else resolve_name(place)


# The baselines learn from demonstrations without the soft constraint and the bonus. Their share of demonstrations is
# constant: 1 for offline methods, 0.5 for GAIL, whose discriminator compares the two halves of a batch, and for DAgger.
_BASELINE = {"xi_multiplier": 0.0, "bonus": 0.0, "beta_episodes": None}

# Methods that the paper does not train, with a replay buffer and a teacher. Their γ (§) is above the paper's 0.8.
_LATER = {"gamma": 0.97, "xi_multiplier": 0.0, "bonus": 0.0, "batch": 128}

# PPO drives a few hundred roads at once and looks further ahead. Its first update comes
# after 32 decisions on all 512 roads, when it has driven more than 1,000 episodes. All numbers are our choice §.
_PPO = {
    "gamma": 0.99,
    "xi_multiplier": 0.0,
    "beta_start": 0.0,
    "bonus": 0.0,
    "envs_per_agent": 512,
    "batch": 2048,
    "actor_lr": 7e-4,
    "critic_lr": 7e-4,
    "buffer_size": 2048,
}
_ON_POLICY: dict[str, Any] = {"kind": "bootcourse.learn.ppo:PPOSettings", "on_policy": True, "episodes": 20_000}

_METHODS = {
    "sac": Method("plain SAC", Style("#0072B2"), {"xi_multiplier": 0.0, "beta_start": 0.0}),
    "soft": Method("soft constraint only", Style("#56B4E9", "--"), {"beta_start": 0.0}),
    "demos": Method("demonstrations only", Style("#E69F00", "--"), {"xi_multiplier": 0.0}),
    "bootstrapped": Method("bootstrapped SAC", Style("#D55E00", width=2.5)),  # the paper's method, drawn last
    "margin": Method("large margin", Style("#CC79A7", ":"), {"xi_multiplier": 0.0, "bonus": 0.0, "margin": 1.0}),
    "margin_soft": Method("large margin and KL", Style("#CC79A7", "-."), {"bonus": 0.0, "margin": 1.0}),
    "bc": Method(
        "behaviour cloning",
        Style("#332288", marker="o"),
        _BASELINE | {"beta_start": 1.0},
        "bootcourse.learn.bc:BCLearner",
    ),
    "cql": Method(
        "CQL",
        Style("#999933", marker="s"),
        _BASELINE | {"beta_start": 1.0, "cql_weight": 1.0},
        "bootcourse.learn.cql:CQLLearner",
    ),
    "cql_sac": Method(  # CQL's conservative term added to SAC's critics
        "CQL with an actor", Style("#5C5C1F", "--", marker="s"), _BASELINE | {"beta_start": 1.0, "cql_weight": 1.0}
    ),
    "gail": Method(
        "GAIL",
        Style("#882255", marker="^"),
        _BASELINE | {"beta_start": 0.5, "batch": 128},
        "bootcourse.learn.gail:GAILLearner",
        kind="bootcourse.learn.gail:GAILSettings",
    ),
    "ppo": Method("PPO", Style("#44AA99", ":"), _PPO, "bootcourse.learn.ppo:PPOLearner", **_ON_POLICY),
    "ppo_cloned": Method(
        "PPO after cloning",
        Style("#1F7A6D", width=2.0),
        _PPO | {"cloning_updates": 400, "stochastic_demonstrations": True},
        "bootcourse.learn.ppo:PPOLearner",
        **_ON_POLICY,
    ),
    "dagger": Method(
        "DAgger",
        Style("#332288", "--", marker="o"),
        _BASELINE | {"beta_start": 0.5},
        "bootcourse.learn.bc:DAggerLearner",
        taught=True,
    ),
    "jsrl": Method(
        "jump-start RL",
        Style("#661A66", marker="v"),
        _LATER | {"beta_start": 0.0, "target_entropy": 0.3},  # keeps α up while h shrinks
        "bootcourse.learn.jsrl:JSRLLearner",
        kind="bootcourse.learn.jsrl:JSRLSettings",
        taught=True,
    ),
    "rlpd": Method(
        "RLPD",
        Style("#C76BB8", "--", marker="D"),
        _LATER | {"beta_start": 0.5, "beta_episodes": None, "envs_per_agent": 2, "updates": 4},
        "bootcourse.learn.rlpd:RLPDLearner",
        kind="bootcourse.learn.rlpd:RLPDSettings",
    ),
    "ibrl": Method(
        "IBRL", Style("#AA4499", "-.", marker="P"), _LATER, "bootcourse.learn.ibrl:IBRLLearner", taught=True
    ),
}
METHODS = MappingProxyType(_METHODS)  # by name; nobody changes it but `own_method`
ABLATION = ("sac", "soft", "demos", "bootstrapped", "margin", "margin_soft")  # the paper's method and its parts
BASELINES = ("bc", "cql", "cql_sac", "gail")
AFTER = tuple(method for method in METHODS if method not in ABLATION + BASELINES)  # the paper trains none of them
DRIVERS = {  # name and style of the drivers that are not trained
    "rule": ("rule controller", Style("#009E73", width=1.0)),
    "planner": ("planner", Style("#000000", (0, (8, 4)))),
    "idle": ("idle driver", OTHER),
    "random": ("random driver", OTHER),
}


def method_of(learner: type, like: Method | None = None) -> Method:
    """The method of a learner of your own, whose name is that of its class.

    like: the method whose settings it starts from. A class may have settings of its own, its `settings_class`.
    """
    started = like or Method("", OTHER)
    own = getattr(learner, "settings_class", None) or started.kind
    return replace(started, name=learner.__name__, style=OTHER, learner=learner, kind=own)


@contextmanager
def own_method(name: str, method: Method) -> Iterator[str]:
    """A method of your own, which is one of `METHODS` within the block. Raises BootcourseError for a name in use."""
    require(name not in METHODS, f"A method is called '{name}' already: give yours another name.")
    _METHODS[name] = method
    try:
        yield name
    finally:
        del _METHODS[name]


def display_name(label: str) -> str:
    """The name of a drive or a method in text and figures: "sac, seed 3" -> "plain SAC, seed 3"."""
    first, comma, rest = label.partition(",")
    key = driver_of(label)
    name = METHODS[key].name if key in METHODS else DRIVERS.get(key, (first.strip(),))[0]
    return name + comma + rest


def driver_of(label: str) -> str:
    """The name of who drives, at the beginning of a drive's label: "sac, seed 3" -> "sac"."""
    return label.partition(",")[0].strip().lower()


def style(label: str) -> Style:
    """The style of a method, or of a drive whose label begins with a method's name ("sac, seed 3")."""
    key = _first_word(label)
    return METHODS[key].style if key in METHODS else DRIVERS.get(key, ("", OTHER))[1]


def has_style(label: str) -> bool:
    """Whether a label begins with the name of a method or of a driver, and so has a style of its own."""
    return _first_word(label) in METHODS | DRIVERS


def _first_word(label: str) -> str:
    return next(iter(label.lower().replace(",", " ").replace(":", " ").split()), "")
