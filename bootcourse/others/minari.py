"""Demonstrations to and from Minari, the data format of offline reinforcement learning that gymnasium's authors keep.

    dataset = to_minari(bc.demonstrate(200), "trap/rule-v0")  # in Minari's folder, see MINARI_DATASETS_PATH
    dataset.recover_environment()  # the road with its scenario
    bc.Training(settings, demonstrations=from_minari(minari.load_dataset("trap/rule-v0")))

Minari is no part of the kit: `pip install minari h5py`.
"""

from collections.abc import Callable

import gymnasium as gym
import minari
import numpy as np
from minari.data_collector import EpisodeBuffer

from bootcourse.errors import BootcourseError
from bootcourse.learn.demonstrations import Demonstrations
from bootcourse.scenario import DEFAULT, Scenario

RULE_ACTION = "rule_action"  # the info that holds μ(s)


def to_minari(
    given: Demonstrations,
    dataset_id: str,
    scenario: Scenario | None = DEFAULT,
    make_env: Callable[[], gym.Env] | None = None,
    driver: str = "rule controller",
    **more,
) -> minari.MinariDataset:
    """Write drives as a Minari dataset; the teacher's actions μ(s) are its info "rule_action".

    scenario: that of the drives, which `recover_environment` brings back. make_env: makes another single environment,
    if they are not of the trap. driver: the dataset's `algorithm_name`. more: for `create_dataset_from_buffers`, such
    as author=. Raises BootcourseError if there is such a dataset already.
    """
    if dataset_id in minari.list_local_datasets():
        raise BootcourseError(f"There is a dataset '{dataset_id}' already: choose another name, such as its next -v.")
    env = gym.make("bootcourse:FastTrap-v0", scenario=scenario) if make_env is None else make_env()
    buffers = []
    for i, drive in enumerate(given.drives):
        last = drive.stop - 1
        mu = np.append(given.rule_actions[drive], given.next_rule_actions[last])
        buffers.append(
            EpisodeBuffer(
                id=i,
                seed=given.seeds[i] if given.seeds else None,
                observations=np.append(given.observations[drive], given.next_observations[last : last + 1], axis=0),
                actions=given.actions[drive],
                rewards=given.rewards[drive],
                terminations=given.terminated[drive],
                truncations=given.truncated[drive],
                infos={RULE_ACTION: mu},
            )
        )
    return minari.create_dataset_from_buffers(dataset_id, buffers, env, algorithm_name=driver, **more)


def from_minari(dataset: minari.MinariDataset) -> Demonstrations:
    """The drives of a dataset with vector observations and discrete actions; μ is 0 where it has no "rule_action".

    Raises BootcourseError for other spaces, and for an episode without an end.
    """
    seen, actions = dataset.observation_space, dataset.action_space
    if not (isinstance(seen, gym.spaces.Box) and len(seen.shape) == 1 and isinstance(actions, gym.spaces.Discrete)):
        raise BootcourseError(f"{dataset.id} has {seen} and {actions}: this library learns vectors and Discrete.")
    parts, seeds = [], []
    for episode in dataset.iterate_episodes():
        mu = np.zeros(len(episode.observations), dtype=np.int64)
        if episode.infos and RULE_ACTION in episode.infos:
            mu = np.asarray(episode.infos[RULE_ACTION], dtype=np.int64)
        parts.append(
            (
                episode.observations[:-1], episode.actions, episode.rewards, episode.observations[1:],
                episode.terminations, episode.truncations, mu[:-1], mu[1:],
            )
        )  # fmt: skip
    metadata = dataset.storage.get_episode_metadata(dataset.episode_indices)
    seeds = [one.get("seed") for one in metadata]
    known = () if any(seed is None for seed in seeds) else tuple(int(seed) for seed in seeds)
    return Demonstrations(*(np.concatenate(column) for column in zip(*parts, strict=True)), seeds=known)
