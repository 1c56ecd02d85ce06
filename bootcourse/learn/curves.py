"""What is noted of each training episode: the curves of the paper's training figures and more."""

from collections.abc import Sequence

import numpy as np

NAMES = (
    "success",  # 1 if the ego ended ahead of trap 1
    "return",  # sum of rewards
    "speed",  # m/s, mean over the episode
    "distance",  # m
    "accident",  # an Accident's number
    "entropy",  # nats, mean of H(π) over the episode
    "alpha",  # at the episode's end
    "xi",  # at the episode's end
    "beta",  # at the episode's end
    "decisions",  # length of the episode
)


class Curves:
    """Every agent's finished episodes: `values[name]` is (agents, episodes), NaN where still to come."""

    def __init__(self, agents: int, roads: int, episodes: int):
        self.agents, self.roads, self.episodes = agents, roads, episodes
        self.values = {name: np.full((agents, episodes), np.nan) for name in NAMES}
        self.finished = np.zeros(agents, dtype=np.int64)  # episodes, also those beyond the last that is noted
        self.unknown = np.full(agents * roads, np.nan)
        self.running = np.zeros((4, agents * roads))  # return, decisions, speed, entropy of the running episodes

    def note(self, rewards, entropies, done, infos, now: dict[str, np.ndarray]) -> None:
        """One decision: rewards, entropies, done (agents x envs,), infos of env.step, now: each (agents,).

        What an environment other than the trap does not report stays NaN.
        """
        ended = infos.get("final_info", infos)
        ended = {name: ended.get(name, self.unknown) for name in ("speed", "is_success", "distance", "accident")}
        self.running += np.stack([rewards, np.ones_like(rewards), ended["speed"], entropies])
        for road in np.flatnonzero(done):
            agent, episode = road // self.roads, self.finished[road // self.roads]
            self.finished[agent] += 1
            total, decisions, speed, entropy = self.running[:, road]
            self.running[:, road] = 0.0
            if episode >= self.episodes:
                continue
            values = {
                "success": ended["is_success"][road],
                "return": total,
                "speed": speed / decisions,
                "distance": ended["distance"][road],
                "accident": ended["accident"][road],
                "entropy": entropy / decisions,
                "decisions": decisions,
            }
            for name, value in values.items():
                self.values[name][agent, episode] = value
            for name, value in now.items():
                self.values[name][agent, episode] = value[agent]

    def recent(self, name: str, window: int = 100) -> np.ndarray:
        """Each agent's mean of its last `window` episodes (NaN before the first), (agents,)."""
        means = np.full(self.agents, np.nan)
        for agent, count in enumerate(np.minimum(self.finished, self.episodes)):
            if count:
                means[agent] = self.values[name][agent, max(0, count - window) : count].mean()
        return means


def by_method(settings: Sequence, curves: dict[str, np.ndarray]) -> dict[str, dict[str, np.ndarray]]:
    """The curves of agents that trained side by side, apart for each method: {method: {name: (seeds, episodes)}}."""
    rows = {s.method: [i for i, other in enumerate(settings) if other.method == s.method] for s in settings}
    return {method: {name: values[its] for name, values in curves.items()} for method, its in rows.items()}
