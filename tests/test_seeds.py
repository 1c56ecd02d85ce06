"""Seeds: every place that takes one accepts NumPy's numbers and refuses other values in one sentence."""

import gymnasium as gym
import numpy as np
import pytest

import bootcourse as bc
from bootcourse.episodes.interactive import InteractiveEpisode
from bootcourse.errors import BootcourseError
from bootcourse.learn.training import Training

SHORT = bc.Scenario(clock=bc.DEFAULT.clock.__class__(decisions=3))
PLACES = {
    "the reference road": lambda seed: gym.make("bootcourse:Trap-v0").reset(seed=seed),
    "the compiled roads": lambda seed: gym.make_vec("bootcourse:Trap-v0", num_envs=2).reset(seed=seed),
    "the compiled roads, one by one": lambda seed: gym.make_vec("bootcourse:Trap-v0", num_envs=1).reset(seed=[seed]),
    "record": lambda seed: bc.record(bc.idle_policy, [seed], SHORT),
    "record, without a list": lambda seed: bc.record(bc.idle_policy, seed, SHORT),
    "evaluate": lambda seed: bc.evaluate(bc.idle_policy, 2, SHORT, seed),
    "a drive by hand": lambda seed: InteractiveEpisode(seed),
    "the world": lambda seed: bc.world(seed),
    "settings": lambda seed: bc.settings_for("sac", seed=seed),
    "settings of several agents": lambda seed: bc.with_seeds(bc.settings_for("sac"), 2, seed),
    "a training's roads": lambda seed: Training([bc.settings_for("sac")], 1, first_seed=seed),
}


@pytest.mark.parametrize("place", PLACES)
def test_a_seed_may_be_numpys(place):
    PLACES[place](np.int64(5))


@pytest.mark.parametrize("seed", [-1, 1.5, "5", True, np.bool_(True), None, 2**63], ids=repr)
@pytest.mark.parametrize("place", PLACES)
def test_what_is_no_seed_is_refused_in_one_sentence(place, seed):
    if seed is None and "road" in place:
        return  # a road without a seed is drawn by chance
    with pytest.raises(BootcourseError, match="give a (whole number|list)"):
        PLACES[place](seed)


def test_an_agent_of_numpy_numbers_is_that_of_pythons():
    given = bc.settings_for("sac", seed=np.int64(3), gamma=np.float32(0.5), batch=np.int32(64))
    assert given == bc.settings_for("sac", seed=3, gamma=0.5, batch=64)
    assert {type(value) for value in vars(given).values()} <= {int, float, bool, str, tuple, type(None)}
