"""What the parts of the lesson on discrete SAC do there: an actor that steps down its loss, learners on the chain."""

import numpy as np
import pytest
import torch

from bootcourse.course.lessons.discrete_sac import own_parts
from bootcourse.course.lessons.discrete_sac.explorable import ALPHA, START
from bootcourse.course.lessons.values import chain
from bootcourse.learn import sac

ALPHAS = torch.tensor([[0.05, 1.0]], dtype=torch.float64).expand(100, -1)


def test_learners_of_many_temperatures_in_one_batch_learn_what_each_learns_alone():
    both = own_parts.walked(sac.soft_value, sac.critic_target, ALPHAS)
    drawn = np.random.default_rng(0).random((len(ALPHAS), own_parts.LEARNERS))
    for kind, alpha in enumerate(ALPHAS[0].tolist()):
        for learner in (0, 7):
            q, s, seen = np.zeros((chain.STATES, 2)), 0, set()
            for t in range(len(ALPHAS)):
                s = 0 if t % chain.EPISODE == 0 else s
                seen.add(s)
                a = int(drawn[t, learner] < 1 / (1 + np.exp((q[s, 0] - q[s, 1]) / alpha)))
                s_next = chain.NEXT[s, a]
                soft = alpha * np.logaddexp(*(q[s_next] / alpha))  # the softmax's soft value
                q[s, a] += 0.3 * (chain.REWARD[s, a] + 0.8 * soft - q[s, a])
                s = s_next
            leaves = 1 / (1 + np.exp((q[0, 0] - q[0, 1]) / alpha))
            assert both.leaves[kind, learner] == pytest.approx(leaves)
            assert both.found[kind, learner] == (4 in seen)


def test_an_actor_finds_the_softmax_and_without_a_stop_it_raises_q_instead():
    stopped = own_parts.descended(sac.actor_loss)
    best = torch.tensor(START).div(ALPHA).softmax(-1).numpy()
    assert stopped.pi == pytest.approx(best, abs=0.01) and stopped.q == pytest.approx(START)
    bare = own_parts.descended(lambda log_pi, q, alpha: -sac.soft_value(log_pi, q, alpha).mean())
    assert bare.q[1] > 10 and bare.loss < stopped.loss
