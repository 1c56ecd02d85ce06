"""The paper's method on other problems (problems.py): the methods that are compared, and the hypotheses about them.

A cell of the experiment `elsewhere` is a problem, a teacher and a method; its seeds train side by side. Methods without
a teacher have one cell for each problem. γ, episodes and the copies driven at once are the same for all methods but PPO
of a problem; SAC, soft, demonstrations and both have the library's target entropy -1, and SAC also a usable one, 0.3
log |A|. β and, with α, ξ fade: β over the first two thirds of the episodes. An agent has *found* the way if a window of
20 training episodes succeeds in more than half; `kept` of the files says that the last window does.
"""

import math

from bootcourse.learn.settings import Settings, settings_for
from bootcourse.research.problems import Problem

WINDOW = 20  # training episodes in a row
NOBODY = "none"  # the teacher of a method without one
USABLE = "0.3 log |A|"
ALONE = {"SAC": ("sac", {}), f"SAC, η = {USABLE}": ("sac", {"target_entropy": USABLE}), "PPO": ("ppo", {})}
TAUGHT = {
    "cloning": ("bc", {}),
    "soft": ("soft", {}),
    "demonstrations": ("demos", {}),
    "both": ("bootstrapped", {}),
    "both, c = 0": ("bootstrapped", {"bonus": 0.0}),
    "PPO after cloning": ("ppo_cloned", {}),
}
METHODS = ALONE | TAUGHT
BONUSES = {  # on DoorKey alone: from which bonus c on does it mislead?
    **{f"both, c = {c:g}": ("bootstrapped", {"bonus": c}) for c in (0.03, 0.1, 0.3, 1.0)},
    "demonstrations, c = 0": ("demos", {"bonus": 0.0}),
}
WITHOUT_LOOPS = "both, without loops"  # on DoorKey: demonstrations are the random teacher's drives to the goal
HYPOTHESES = {  # written before any cell was run with more than two seeds; elsewhere_claims.py compares them
    "H1": "The bonus helps only where c a step is small beside the reward of success. On DoorKey (c = 2, the goal pays "
    "at most 1) both with c = 0 succeeds more often than both, with the random teacher too; on MountainCar (-1 a step) "
    "it does not matter.",
    "H2": "Cloning averages random errors away where they do not repeat (chain, MountainCar, Acrobot): with the random "
    "teacher a clone earns more than the teacher. It copies systematic errors: there it earns no more than the "
    "teacher.",
    "H3": "With the systematic teacher soft and both earn more than cloning, because ξ fades and the reward corrects "
    "the error.",
    "H4": "The longer the horizon without reward (MountainCar, Acrobot, chain; not CartPole), the more a teacher is "
    "worth: SAC with either target entropy succeeds in less than 10 % on MountainCar, and on CartPole the usable one "
    "needs no help.",
    "H5": "Soft beats demonstrations alone on every problem with the random teacher: it asks in the states that the "
    "agent reaches, and demonstrations say nothing there.",
    "H6": "PPO after cloning is at least as good as cloning on every problem, with every teacher.",
}
PPO = {"envs_per_agent": 16, "horizon": 64, "batch": 256, "actor_lr": 1e-3, "critic_lr": 1e-3}


def settings_of(problem: Problem, name: str) -> Settings:
    """The settings of one of `METHODS` or `BONUSES`, or `WITHOUT_LOOPS`, on a problem."""
    method, changes = (METHODS | BONUSES | {WITHOUT_LOOPS: METHODS["both"]})[name]
    changes = {"gamma": problem.gamma, "demonstration_episodes": 50} | changes
    if changes.get("target_entropy") == USABLE:
        changes["target_entropy"] = 0.3 * math.log(problem.actions)
    if method.startswith("ppo"):
        changes |= PPO
    elif method in ("demos", "bootstrapped"):
        changes["beta_episodes"] = 2 * problem.episodes // 3
    return settings_for(method, **changes)
