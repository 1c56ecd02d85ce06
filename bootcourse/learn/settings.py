"""Every setting of a learner, with its source.

† printed in the paper (Table "RL hyper-parameters", Section IV); ‡ inferred from the paper, with the reason; § our
choice.
"""

import math
import sys
from dataclasses import dataclass, field, fields, replace

import numpy as np

from bootcourse.errors import BootcourseError, check_known, did_you_mean, whole
from bootcourse.methods import METHODS
from bootcourse.scenario import check_p

MAX_SEED = 8_000_000  # the roads of a larger training seed would be those of the demonstrations (see training.py)


def shared(default):
    """A field that must be equal for all agents that train side by side."""
    return field(default=default, metadata={"shared": True})


@dataclass(frozen=True)
class Settings:
    """One agent's settings. The defaults are the paper's method; use `settings_for` for other methods.

    Raises BootcourseError for a value that is out of range or contradicts the method.
    """

    method: str = "bootstrapped"
    seed: int = 0
    gamma: float = 0.8  # † discount factor γ
    target_entropy: float = -1.0  # nats † η; a categorical policy's entropy is never negative
    alpha_init: float = 0.01  # † initial entropy coefficient α
    xi_multiplier: float = 200.0  # † ξ = 200 α; 0 switches the soft constraint off
    xi_fixed: float = -1.0  # § a constant ξ, if 0 or more
    kl_in_target: bool = True  # ‡ the paper's KL is part of the return, so it is in the critic's target too
    rule_p: float = 0.9  # † p of the stochastic rule π̃
    beta_start: float = 0.6  # † initial share of demonstrations in a batch; 0: no demonstrations
    beta_episodes: int = 1000  # † episodes until that share is 0
    bonus: float = 2.0  # † c, added to a demonstration's reward
    margin: float = 0.0  # weight of the large-margin loss; 0 switches it off
    paper_q_filter: bool = True  # † the printed Q-filter; False: the usual one
    cql_weight: float = 0.0  # § weight of CQL's conservative term; 0 switches it off
    # The same for all agents that train side by side:
    hidden: tuple = shared((64, 64))  # § neurons in each hidden layer
    actor_lr: float = shared(5e-4)  # † α_a
    critic_lr: float = shared(1e-3)  # † α_c
    alpha_lr: float = shared(1e-3)  # †
    batch: int = shared(64)  # † N
    buffer_size: int = shared(50_000)  # † D, transitions
    tau: float = shared(0.005)  # § the target critics' step towards the critics at each update (Polyak averaging)
    envs_per_agent: int = shared(4)  # § roads that each agent drives at the same time
    updates: int = shared(1)  # § updates after each decision on these roads
    learning_starts: int = shared(256)  # § decisions before the first update
    demonstration_episodes: int = shared(200)  # † episodes
    stochastic_demonstrations: bool = shared(False)  # ‡ of π̃, as printed, some would fail (demonstrations.py)
    discriminator_lr: float = shared(3e-4)  # § learning rate of GAIL's discriminator
    gradient_penalty: float = shared(1.0)  # § weight of that discriminator's gradient penalty

    def __post_init__(self):
        for name, value in vars(self).items():
            if isinstance(value, np.generic):  # a number of NumPy's
                object.__setattr__(self, name, value.item())
        check_known("Method", self.method, METHODS)
        check_p(self.rule_p, "rule_p")
        _check_range(self, 0.0, 1.0, "gamma", "beta_start", "tau")
        _check_range(self, 0.0, math.inf, "xi_multiplier", "margin", "actor_lr", "critic_lr", "alpha_lr")
        _check_range(self, 0.0, math.inf, "cql_weight", "discriminator_lr", "gradient_penalty")
        _check_range(self, 1e-12, math.inf, "alpha_init")
        _check_range(self, -math.inf, math.inf, "target_entropy", "bonus", "xi_fixed")
        _check_range(self, 1, math.inf, "beta_episodes", "batch", "envs_per_agent", "updates", whole=True)
        _check_range(self, 1, math.inf, "demonstration_episodes", whole=True)
        _check_range(self, 0, math.inf, "learning_starts", whole=True)
        _check_range(self, 0, MAX_SEED, "seed", whole=True)
        _check_range(self, max(self.batch, self.envs_per_agent), math.inf, "buffer_size", whole=True)
        for name in ("kl_in_target", "paper_q_filter", "stochastic_demonstrations"):
            if not isinstance(getattr(self, name), bool):
                raise BootcourseError(f"{name} = {getattr(self, name)!r}: give True or False.")
        sizes = self.hidden if isinstance(self.hidden, (tuple, list)) else ()
        if not sizes or any(not isinstance(size, int) or size < 1 for size in sizes):
            raise BootcourseError(f"hidden = {self.hidden!r}: give the layers' sizes, such as (64, 64).")
        object.__setattr__(self, "hidden", tuple(sizes))
        self._check_label()

    def _check_label(self) -> None:
        """Check that no ingredient is switched on that the method is defined by leaving out."""
        lacks = {name for name, value in METHODS[self.method].settings.items() if value == 0}
        lacks |= {"xi_fixed"} if "xi_multiplier" in lacks else set()
        for name in sorted(lacks):
            if getattr(self, name) > 0:
                raise BootcourseError(
                    f"{name} = {getattr(self, name)!r}, but method '{self.method}' is defined by doing without: "
                    f"write settings_for('{self.method}'), or choose a method that has it."
                )

    @property
    def needs_demonstrations(self) -> bool:
        """Whether the agent's batches contain demonstrations."""
        return self.beta_start > 0

    @property
    def asks_teacher(self) -> bool:
        """Whether the agent uses the teacher's actions in the states that it reaches itself, or in its batches."""
        return self.xi_multiplier > 0 or self.xi_fixed > 0 or METHODS[self.method].taught

    @property
    def restarts(self) -> bool:
        """Whether some of the agent's training episodes begin before an accident."""
        return False

    @property
    def n_critics(self) -> int:
        """How many critics the agent has."""
        return 2


@dataclass(frozen=True)
class PPOSettings(Settings):
    """The settings of PPO, which shares γ, the network and the roads with the other methods. All are our choice §."""

    horizon: int = shared(32)  # decisions on every road between two rounds of updates
    epochs: int = shared(4)  # passes over these decisions
    clip: float = shared(0.2)  # ε: how far the ratio of new to old probabilities counts
    gae_lambda: float = shared(0.95)  # λ of the advantages
    entropy_weight: float = shared(0.01)  # of the entropy bonus
    anneal_decisions: int = shared(0)  # of each agent, until both learning rates have fallen to 0; 0: they stay
    cloning_updates: int = shared(0)  # before the first drive: clone the teacher; 0 for PPO alone
    label_smoothing: float = shared(0.1)  # of the cloned actions
    kl_weight: float = shared(0.0)  # λ of the KL to π̃ at first (kickstarting, arXiv 1803.03835); 0: no KL
    kl_episodes: int = shared(0)  # episodes until λ is 0; 0: λ falls as the success rises (kickstart.py)

    def __post_init__(self):
        super().__post_init__()
        _check_range(self, 1, math.inf, "horizon", "epochs", whole=True)
        _check_range(self, 0, math.inf, "cloning_updates", "kl_episodes", "anneal_decisions", whole=True)
        _check_range(self, 0.0, 1.0, "clip", "gae_lambda", "label_smoothing")
        _check_range(self, 0.0, math.inf, "entropy_weight", "kl_weight")

    @property
    def needs_demonstrations(self) -> bool:
        """Whether the agent begins as a clone of the teacher."""
        return self.cloning_updates > 0

    @property
    def value_outputs(self) -> int:
        """How many numbers the value network gives for a state."""
        return 1


@dataclass(frozen=True)
class SafeSettings(PPOSettings):
    """The settings of PPO for which accidents cost more. All are our choice §; each is off by default."""

    accident_cost: float = 0.0  # taken off the reward of an accident, beside the road's -10, while the agent learns
    accident_budget: float = 0.002  # d: the share of training episodes that may end in an accident
    multiplier_step: float = 0.0  # K_I: how fast λ follows J_C - d, in reward per round of updates; 0: no λ
    risk_limit: float = 1.0  # ε: actions of a larger predicted risk are not taken while driving; 1: no mask
    risk_decisions: int = shared(10)  # k: the risk is that of an accident within so many decisions
    shield: bool = shared(False)  # that of shield.py: written by hand, for comparison
    restart_share: float = 0.0  # of the training episodes, at first: they begin before an accident (restarts.py)
    restart_episodes: int = 0  # until that share is 0; 0: it stays
    value_quantiles: int = shared(1)  # N: of the returns from a state (quantiles.py); 1: their mean alone
    worst_share: float = shared(1.0)  # V(s) is the mean of so many of the quantiles, from the lowest on; 1: of all

    def __post_init__(self):
        super().__post_init__()
        _check_range(self, 0.0, math.inf, "accident_cost", "multiplier_step")
        _check_range(self, 0.0, 1.0, "accident_budget", "risk_limit")
        _check_range(self, 0.0, 0.9, "restart_share")  # with 1 no episode would be an ordinary one again
        _check_range(self, 0, math.inf, "restart_episodes", whole=True)
        _check_range(self, 1, math.inf, "value_quantiles", whole=True)
        _check_range(self, 1e-12, 1.0, "worst_share")
        _check_range(self, 1, self.horizon, "risk_decisions", whole=True)
        if not isinstance(self.shield, bool):
            raise BootcourseError(f"shield = {self.shield!r}: give True or False.")

    @property
    def restarts(self) -> bool:
        """Whether some of the agent's training episodes begin before an accident."""
        return self.restart_share > 0

    @property
    def value_outputs(self) -> int:
        """How many quantiles the value network gives for a state."""
        return self.value_quantiles


@dataclass(frozen=True)
class JSRLSettings(Settings):
    """The settings of jump-start RL."""

    guide_decisions: int = shared(60)  # § h at first: the rule is ahead of trap 1 after a median of 58 s
    stages: int = shared(10)  # § in how many equal steps h shrinks to 0
    window: int = shared(20)  # § episodes in the moving average of returns
    tolerance: float = shared(0.05)  # § β: how far this average may lie below the best so far, as a share of the best

    def __post_init__(self):
        super().__post_init__()
        _check_range(self, 0, math.inf, "guide_decisions", whole=True)
        _check_range(self, 1, math.inf, "stages", "window", whole=True)
        _check_range(self, 0.0, math.inf, "tolerance")


@dataclass(frozen=True)
class RLPDSettings(Settings):
    """The settings of RLPD, whose authors have 10 critics and make 20 updates for each decision."""

    critics: int = shared(5)  # § in the ensemble
    target_critics: int = shared(2)  # ‡ of them, drawn for each update, smallest value in the target; the authors' code

    def __post_init__(self):
        super().__post_init__()
        _check_range(self, 1, math.inf, "critics", whole=True)
        _check_range(self, 1, self.critics, "target_critics", whole=True)

    @property
    def n_critics(self) -> int:
        """How many critics the agent has."""
        return self.critics


@dataclass(frozen=True)
class PEXSettings(Settings):
    """The settings of policy expansion."""

    choice_temperature: float = 0.1  # § of the softmax over the values of the rule's action and the agent's own

    def __post_init__(self):
        super().__post_init__()
        _check_range(self, 1e-12, math.inf, "choice_temperature")


KINDS = {kind.__name__: kind for kind in (Settings, PPOSettings, SafeSettings, JSRLSettings, RLPDSettings, PEXSettings)}


def settings_class(method: str) -> type[Settings]:
    """The class of a method's settings; `Settings`, which refuses it, for an unknown method."""
    return KINDS[METHODS[method].kind] if method in METHODS else Settings


def shared_fields(kind: type[Settings]) -> tuple[str, ...]:
    """The settings that must be equal for all agents that train side by side."""
    return tuple(f.name for f in fields(kind) if f.metadata.get("shared"))


def _check_range(settings: Settings, low: float, high: float, *names: str, whole: bool = False) -> None:
    for name in names:
        value = getattr(settings, name)
        is_number = isinstance(value, int if whole else (int, float)) and not isinstance(value, bool)
        if not is_number or not abs(value) <= sys.float_info.max or not low <= value <= high:
            limits = [f"of {low:g} or more"] * (low > -math.inf) + [f"at most {high:,.12g}"] * (high < math.inf)
            wanted = " ".join(["whole number" if whole else "finite number", ", ".join(limits)]).strip()
            raise BootcourseError(f"{name} = {value!r}: give a {wanted}.")


# Named settings. The defaults are quick: a quarter of an update for each decision. Those of "paper" make eight times as
# many updates, on one road per agent. The paper prints neither number. With these the order of its Table 4 comes out:
# of ten agents each, 0 (SAC), 5 (soft), 10 (demos) and 10 (bootstrapped) escape (`bootcourse study clocks`).
SETTINGS = {
    "quick": {},
    "paper": {"envs_per_agent": 1, "updates": 2, "stochastic_demonstrations": True},  # §
}


def settings_for(method: str, setting: str = "quick", **changes) -> Settings:
    """The settings of a method, with changes: settings_for("sac", gamma=0.9).

    setting: a name of `SETTINGS`, "quick" or "paper". Raises BootcourseError for an unknown name or an invalid value.
    """
    check_known("Method", method, METHODS)
    check_known("Setting", setting, SETTINGS)
    kind = settings_class(method)
    if setting != "quick" and METHODS[method].on_policy:
        raise BootcourseError(f"Method '{method}' has no setting '{setting}': leave it out.")
    known = [f.name for f in fields(kind)]
    for name in changes:
        if name not in known:
            if owners := [f"'{other}'" for other in METHODS if name in {f.name for f in fields(settings_class(other))}]:
                has = "has it" if len(owners) == 1 else "have it"
                raise BootcourseError(f"Method '{method}' has no {name}: {', '.join(owners)} {has}.")
            raise BootcourseError(f"Setting {did_you_mean(name, known)}.")
    return kind(method=method, **(METHODS[method].settings | SETTINGS[setting] | changes))


FORMER_NAMES = {  # field names in files of earlier versions -> present names
    "p": "rule_p",
    "roads": "envs_per_agent",
    "warm_up": "learning_starts",
    "capacity": "buffer_size",
    "conservative": "cql_weight",
    "demonstrations": "demonstration_episodes",
}


def stored_settings(stored: dict) -> Settings:
    """The settings in a file {name: value}. Raises BootcourseError for an invalid value or an unknown name."""
    present = {FORMER_NAMES.get(name, name): value for name, value in stored.items()}
    kind = settings_class(present.get("method", ""))
    if unknown := sorted(present.keys() - {f.name for f in fields(kind)}):
        raise BootcourseError(f"Settings have no {', '.join(unknown):.80}: another version wrote them.")
    return kind(**present)


def with_seeds(settings: Settings, seeds: int, first: int = 0) -> list[Settings]:
    """The same settings with the seeds first, first + 1, ...: one for each agent of a `Training`."""
    first, seeds = whole(first, "first seed", MAX_SEED), whole(seeds, "seeds", MAX_SEED)
    return [replace(settings, seed=seed) for seed in range(first, first + seeds)]
