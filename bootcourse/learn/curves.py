"""Training curves: the numbers that are recorded of each training episode."""

from collections.abc import Sequence

import numpy as np

from bootcourse.episodes.infos import known_success, reported

NAMES = (
    "success",  # 1 if the ego ended ahead of trap 1
    "return",  # sum of rewards
    "speed",  # m/s, mean over the episode
    "distance",  # m
    "accident",  # the number of an `Accident`
    "entropy",  # nats, mean of H(π) over the episode
    "alpha",  # α at the episode's end; 0 for a method without it, as ξ
    "xi",  # ξ at the episode's end
    "beta",  # β at the episode's end
    "decisions",  # length of the episode
)


class Curves:
    """The finished episodes of all agents: `values[name]` is (agents, episodes), NaN for episodes to come."""

    def __init__(self, agents: int, roads: int, episodes: int):
        self.agents, self.roads, self.episodes = agents, roads, episodes
        self.values = {name: np.full((agents, episodes), np.nan) for name in NAMES}
        self.finished = np.zeros(agents, dtype=np.int64)  # episodes, including those after the last that is recorded
        self.success_is_known = False  # found out again where a training is resumed
        self.running = np.zeros((4, agents * roads))  # return, decisions, speed, entropy of the running episodes

    def note(self, rewards, entropies, done, infos, now: dict[str, np.ndarray]) -> None:
        """Record a decision: rewards, entropies, done (agents x envs,), env.step's infos, now {name: (agents,)}.

        Values that an environment other than the trap does not report are NaN: see `episodes/infos.py`.
        """
        names = ("speed", "is_success", "distance", "accident")
        said = {name: reported(name, infos, len(rewards)) for name in names}
        self.running += np.stack([rewards, np.ones_like(rewards), said["speed"], entropies])
        for road in np.flatnonzero(done):
            agent, episode = road // self.roads, self.finished[road // self.roads]
            total, decisions, speed, entropy = self.running[:, road]
            self.running[:, road] = 0.0
            self.finished[agent] += 1
            if episode >= self.episodes:
                continue
            values = {
                "success": said["is_success"][road],
                "return": total,
                "speed": speed / decisions,
                "distance": said["distance"][road],
                "accident": said["accident"][road],
                "entropy": entropy / decisions,
                "decisions": decisions,
                **{name: each[agent] for name, each in now.items()},
            }
            for name, value in values.items():
                self.values[name][agent, episode] = value
        if done.any() and not (self.success_is_known and np.isfinite(said["is_success"][done]).all()):
            over = np.isfinite(self.values["decisions"])
            self.values["success"][over] = known_success(self.values["success"][over])
            self.success_is_known = bool(np.isfinite(self.values["success"][over]).any())

    def recent(self, name: str, window: int = 100) -> np.ndarray:
        """The mean of each agent's last `window` episodes, (agents,); NaN before the first episode."""
        means = np.full(self.agents, np.nan)
        for agent, count in enumerate(np.minimum(self.finished, self.episodes)):
            if count:
                means[agent] = self.values[name][agent, max(0, count - window) : count].mean()
        return means


def by_label(labels: Sequence[str], curves: dict[str, np.ndarray]) -> dict[str, dict[str, np.ndarray]]:
    """The curves {name: (agents, episodes)} split by the agents' labels: {label: {name: (seeds, episodes)}}."""
    rows = {label: [i for i, other in enumerate(labels) if other == label] for label in labels}
    return {label: {name: values[seeds] for name, values in curves.items()} for label, seeds in rows.items()}
