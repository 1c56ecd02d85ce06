"""What other people's loops and spawned workers do with our objects: copy and pickle them."""

import copy
import pickle

import gymnasium as gym
import numpy as np
import pytest

from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.episodes.lookahead import lookahead, lookahead_shield
from bootcourse.episodes.models import MODELS
from bootcourse.learn.settings import settings_for
from bootcourse.learn.teachers import course_rule, teacher_policy
from bootcourse.learn.training import Training
from bootcourse.policies import plan_policy, random_policy, rule_policy, stochastic_rule_policy
from bootcourse.road.trap_env import TrapEnv
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT

WRONG = MODELS["worst case of three wrong models"]
HOW = {"deepcopy": copy.deepcopy, "pickle": lambda thing: pickle.loads(pickle.dumps(thing))}


def my_rule(cars, scenario):
    return 7


def trained(method: str):
    return Training([settings_for(method, hidden=(8,), buffer_size=500)], 1).run(progress=False)


POLICIES = {
    "an agent's": lambda: trained("bootstrapped").agents[0].as_policy(np.random.default_rng(0), with_q=True),
    "one that drives with its teacher": lambda: trained("ibrl").agents[0].as_policy(),
    "the rule's": lambda: rule_policy(DEFAULT),
    "the stochastic rule's": lambda: stochastic_rule_policy(DEFAULT, np.random.default_rng(0)),
    "the random one": lambda: random_policy(np.random.default_rng(0)),
    "a plan": lambda: plan_policy(["keep left", "accelerate straight"]),
    "the course's teacher": lambda: teacher_policy(course_rule),
    "a teacher": lambda: teacher_policy(my_rule),
    "the look-ahead": lambda: lookahead(rule_policy(DEFAULT), 2),
    "the shield with wrong models": lambda: lookahead_shield(rule_policy(DEFAULT), 2, models=WRONG),
}


@pytest.mark.parametrize("how", HOW)
@pytest.mark.parametrize("policy", POLICIES)
def test_a_copied_policy_drives_as_the_first(policy, how):
    first = POLICIES[policy]()
    copied = HOW[how](first)
    np.testing.assert_array_equal(*(drive_episodes(each, range(3)).returns for each in (first, copied)))


@pytest.mark.parametrize("how", HOW)
@pytest.mark.parametrize("make", [TrapEnv, lambda **more: gym.make("bootcourse:Trap-v0", **more)], ids=["class", "id"])
def test_an_environment_that_has_drawn_a_picture_is_copied_without_its_window_and_draws_again(make, how):
    env = make(render_mode="rgb_array")
    env.reset(seed=3)
    before = env.render()
    copied = HOW[how](env)
    assert (copied.render() == before).all()
    for _ in range(3):
        ours, theirs = env.step(5), copied.step(5)
        assert (ours[0] == theirs[0]).all() and ours[1:4] == theirs[1:4]
    assert (env.render() == copied.render()).all()
    env.close()
    copied.close()


@pytest.mark.parametrize("how", HOW)
def test_many_roads_and_a_training_go_on_from_their_copies(how):
    env = TrapVectorEnv(3)
    env.reset(seed=0)
    env.step(np.array([4, 5, 6]))
    again = HOW[how](env)
    np.testing.assert_array_equal(*(each.step(np.array([1, 2, 3]))[0] for each in (env, again)))
    training = Training([settings_for("soft", hidden=(8,), buffer_size=500, learning_starts=16)], 2, teacher=my_rule)
    training.run(progress=False, updates=3)
    results = [each.run(progress=False) for each in (training, HOW[how](training))]
    np.testing.assert_array_equal(*(HOW[how](result).curves["return"] for result in results))
