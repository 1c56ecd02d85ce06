"""The six bugs: each differs from the right update, in its own way and in no other; the shipped agents read back."""

import numpy as np
import pytest
import torch

from bootcourse.course.lessons import registry
from bootcourse.course.lessons.bug_hunt import bugs
from bootcourse.course.lessons.bug_hunt.bugs import BUGS, LETTERS, PROBES, Hunt
from bootcourse.episodes.record import record
from bootcourse.errors import BootcourseError
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.replay_buffer import Batch
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.policies import stochastic_rule_policy
from bootcourse.scenario import DEFAULT

AGENTS, SIZE = 2, 16


def batch(**changed) -> Batch:
    """A batch in which everything occurs: ends, demonstrations, labels that differ from one second to the next."""
    draw = torch.Generator().manual_seed(1)
    states, next_states = (torch.randn(AGENTS, SIZE, 26, generator=draw) for _ in range(2))
    actions, rule_actions = (torch.randint(0, 9, (AGENTS, SIZE), generator=draw) for _ in range(2))
    half = (torch.arange(SIZE) % 2).float().expand(AGENTS, -1)
    everything = Batch(states, next_states, actions, torch.rand(AGENTS, SIZE, generator=draw), half, rule_actions,
                       (rule_actions + 1) % 9, (torch.arange(SIZE) < 8).float().expand(AGENTS, -1))  # fmt: skip
    return everything._replace(**changed)


def after(kind: type[SACLearner], given: Batch, **settings) -> dict[str, torch.Tensor]:
    """Actor and critics after one update."""
    learner = kind(with_seeds(settings_for("bootstrapped", hidden=(8,), alpha_init=0.1, **settings), AGENTS), 26)
    learner.update(given)
    networks = {"actor": learner.actor, "critics": learner.critics}
    return {part: torch.cat([p.detach().flatten() for p in layers]) for part, layers in networks.items()}


def changed_parts(bug: str, given: Batch, **settings) -> set[str]:
    right, wrong = after(SACLearner, given, **settings), after(BUGS[bug], given, **settings)
    return {part for part in right if not torch.equal(right[part], wrong[part])}


@pytest.mark.parametrize(
    ("bug", "parts"),
    {"flipped_kl": {"actor", "critics"}, "no_end": {"critics"}, "sampled": {"actor", "critics"}, "no_stop": {"critics"},
     "bonus_for_all": {"critics"}, "shifted_labels": {"actor"}}.items(),
)  # fmt: skip
def test_a_bug_changes_its_part_of_the_update_and_raises_nothing(bug, parts):
    assert changed_parts(bug, batch()) == parts


@pytest.mark.parametrize("bug", bugs.LEARNERS)
def test_labels_are_the_rule_s_before_the_step_unless_they_are_shifted(bug):
    drive = record(stochastic_rule_policy(DEFAULT, np.random.default_rng(1)), [10])[0]
    labels, right = bugs.labels(bug, drive), drive.rule_actions
    shifted = bug == "shifted_labels"
    assert len(labels) == len(right) and (labels == right).all() != shifted
    assert (labels[:-1] == right[1:]).all() == shifted


@pytest.mark.parametrize("bug", bugs.LEARNERS)
def test_the_target_of_a_learner_is_the_printed_one_unless_the_bug_is_in_that_line(bug):
    rng = np.random.default_rng(2)
    reward, value = rng.normal(size=(2, 40))
    demo, end = rng.integers(0, 2, (2, 40))
    y = reward + 1.7 * demo + 0.6 * (1 - end) * value
    error = np.abs(bugs.target_of(bug)(reward, demo, 1.7, end, value, 0.6) - y)
    wrong = {"no_end": end > 0, "bonus_for_all": demo == 0}.get(bug, np.zeros(40, dtype=bool))
    assert ((error > 1e-9) == wrong).all()
    assert bugs.target_of("none")(reward=1, demo=1, bonus=3, end=0, next_value=4, gamma=0.5) == 6  # one transition


def test_the_transitions_of_drives_stand_one_after_another_and_hold_their_accidents():
    drives = record(stochastic_rule_policy(DEFAULT, np.random.default_rng(1)), range(3))
    seen = bugs.transitions(drives)
    assert (seen.rule_actions == np.concatenate([drive.rule_actions for drive in drives])).all()
    assert (seen.rewards[seen.terminated > 0] == DEFAULT.reward.accident).all() and seen.terminated.any()


# What ships ------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def hunt():
    return Hunt()


def test_what_ships_has_curves_probes_and_an_agent_for_every_name(hunt):
    assert hunt.names == ("healthy", *LETTERS) and hunt.updates[-1] == bugs.UPDATES
    for name in hunt.names:
        assert hunt.curve(name, "success").shape[0] == 2 and np.nanmax(hunt.curve(name, "accident")) <= 3
        assert all(hunt.probe(name, probe).shape == (2, len(hunt.updates)) for probe in PROBES)
        assert np.allclose(hunt.agent(name).probabilities(np.zeros((3, 26))).sum(-1), 1)
    with pytest.raises(BootcourseError, match="choose from healthy, A, B"):
        hunt.curve("G", "success")


def test_the_verdict_that_passes_is_the_shuffle_s(hunt):
    solution = registry()["diagnose"].solution
    assert {letter: solution(letter) for letter in LETTERS} == {k: v for k, v in hunt._bug_of.items() if v in BUGS}
