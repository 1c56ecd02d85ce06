"""Where one drives: on the trap, whose true state a teacher sees, or in another environment, which shows observations.

Everything that depends on the difference asks here; `place_of` finds it out.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from bootcourse.road.state import EGO, SPEED, X, Y
from bootcourse.scenario import DEFAULT, Scenario

TRAP_ID = "Trap-v0"  # the id of the course's environment


@dataclass(frozen=True)
class Place:
    """The trap with one of its scenarios, or another environment."""

    scenario: Scenario | None = DEFAULT  # None off the trap
    name: str = TRAP_ID  # under which gymnasium knows the environment; its class where it is not registered

    @property
    def is_trap(self) -> bool:
        """Is it the trap, so that the true state of its cars is known and the course's rule can drive?"""
        return self.scenario is not None

    @property
    def told(self) -> tuple:
        """What a rule is given beside the state."""
        return (self.scenario,) if self.is_trap else ()

    def seconds(self, decisions: np.ndarray) -> np.ndarray:
        """How long so many decisions take; off the trap a second each."""
        return decisions / (self.scenario or DEFAULT).clock.decision_rate

    def state(self, env: Any, observations: np.ndarray) -> np.ndarray:
        """What a teacher sees now: the cars (roads, vehicles, 10), which the environment will change; observations."""
        return env.cars if self.is_trap else observations

    def state_reached(self, env: Any, reached: np.ndarray, infos: dict) -> np.ndarray:
        """What a teacher saw after a step, where autoreset has restarted: the old episode's last state.

        reached: see `driving.reached_observations`. infos: as returned by `step`.
        """
        if not self.is_trap:
            return reached
        if "final_obs" not in infos:
            return env.cars
        return np.where(infos["_final_obs"][:, None, None], env.final_cars, env.cars)

    def in_words(self, state: np.ndarray) -> str:
        """What a teacher saw of one road."""
        if not self.is_trap:
            return f"for the observation {np.array2string(state, precision=3)}"
        return f"with the ego at x = {state[EGO, X]:.1f} m, y = {state[EGO, Y]:.1f} m, {state[EGO, SPEED]:.1f} m/s"


def place_of(env: Any) -> Place:
    """Where an environment is. One that has `cars` is the trap, or a road that was made from it."""
    if hasattr(env, "cars"):
        return Place(env.scenario)
    one = env.unwrapped.envs[0] if hasattr(env.unwrapped, "envs") else env
    return Place(None, one.spec.id if one.spec else type(one.unwrapped).__name__)
