"""Restarts before accidents: a share of an agent's training episodes begins where one of its accidents is near.

Tavakoli et al. (arXiv 1811.11298) restart in states of the agent's past, Marji and Licato (2021) some steps before a
failure. Here each accident leaves one state in its agent's pool, from 5 to 40 decisions before. The cars and the number
of decisions are all of it, because the road is deterministic. What is learned from other starts is not what the start
asks for, so the share falls to 0.

Restarted episodes are not in the curves, do not count as episodes of the training, and are no part of the accident
rate J_C. `Curves` says where their decisions are counted.
"""

from collections.abc import Sequence

import numpy as np

from bootcourse.learn.bootstrap import demonstration_share
from bootcourse.learn.curves import Curves
from bootcourse.learn.settings import Settings
from bootcourse.road.vector_env import TrapVectorEnv

NEAREST, FARTHEST = 5, 40  # § decisions between a restart's state and the accident
POOL = 100  # § accidents of each agent that are kept, the last ones


class Restarts:
    """The last states of the running episodes, and each agent's pool of states before accidents.

    settings: one for each agent; env: their roads, just reset.
    """

    def __init__(self, settings: Sequence[Settings], env: TrapVectorEnv):
        roads, agents, cars = np.arange(env.num_envs), len(settings), env.cars.shape[1:]
        self.roads, self.agent_of = roads, roads // (env.num_envs // agents)
        self.share = np.array([s.restart_share for s in settings])
        self.episodes = np.array([s.restart_episodes or np.inf for s in settings])
        self.past = np.zeros((len(roads), FARTHEST, *cars))  # state k of an episode is past[road, k % FARTHEST]
        self.kept = np.zeros(len(roads), dtype=np.int64)  # states of each running episode so far
        self.accidents = np.zeros(agents, dtype=np.int64)  # accidents so far that left a state
        self.pool = np.zeros((agents, POOL, *cars))
        self.decisions = np.full((agents, POOL), -1)  # before each state of the pool; -1: none there yet
        self._keep(env.cars)

    def arrays(self) -> dict[str, np.ndarray]:
        """What a checkpoint keeps."""
        return {name: getattr(self, name) for name in ("past", "kept", "accidents", "pool", "decisions")}

    def begin(
        self,
        env: TrapVectorEnv,
        curves: Curves,
        done: np.ndarray,
        terminated: np.ndarray,
        generators: Sequence[np.random.Generator],
    ) -> bool:
        """After a decision: take a state before each accident, and move some roads that begin anew to such states.

        done, terminated: (envs,) bool; generators: one for each agent. Returns whether any road was moved.

        An accident of a restarted episode leaves no state: those that nothing avoids would soon fill the pool.
        """
        share = demonstration_share(curves.finished, self.share, self.episodes)  # falls linearly, as β does
        takes = terminated & ~curves.restarted & (self.kept >= NEAREST)
        curves.restarted[done] = False
        for road in np.flatnonzero(done & (share > 0)[self.agent_of]):
            agent, generator = self.agent_of[road], generators[self.agent_of[road]]
            if takes[road]:
                self._take(agent, road, generator)
            filled = np.flatnonzero(self.decisions[agent] >= 0)
            if len(filled) and generator.random() < share[agent]:
                chosen = filled[generator.integers(len(filled))]
                env.cars[road], env.decisions[road] = self.pool[agent, chosen], self.decisions[agent, chosen]
                curves.restarted[road] = True
        self.kept[done] = 0
        self._keep(env.cars)
        return bool(curves.restarted[done].any())

    def _take(self, agent: int, road: int, generator: np.random.Generator) -> None:
        state = self.kept[road] - generator.integers(NEAREST, min(FARTHEST, self.kept[road]) + 1)
        slot = self.accidents[agent] % POOL
        self.pool[agent, slot], self.decisions[agent, slot] = self.past[road, state % FARTHEST], state
        self.accidents[agent] += 1

    def _keep(self, cars: np.ndarray) -> None:
        self.past[self.roads, self.kept % FARTHEST] = cars
        self.kept += 1
