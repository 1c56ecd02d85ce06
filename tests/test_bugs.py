"""The six bugs: each differs from the right update, in its own way and in no other; the shipped agents read back."""

import numpy as np
import pytest
import torch

from bootcourse.course.lessons import registry
from bootcourse.course.lessons.bug_hunt import bugs
from bootcourse.course.lessons.bug_hunt.bugs import BUGS, LETTERS, PROBES, Hunt, train_bug
from bootcourse.errors import BootcourseError
from bootcourse.learn import bootstrap, sac
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.replay_buffer import Batch
from bootcourse.learn.settings import settings_for, with_seeds

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


@pytest.mark.parametrize(
    ("bug", "changed", "settings"),
    [
        ("no_end", {"terminated": torch.zeros(AGENTS, SIZE)}, {}),
        ("bonus_for_all", {"is_demonstration": torch.ones(AGENTS, SIZE)}, {}),
        ("shifted_labels", {"next_rule_actions": batch().rule_actions}, {}),
        ("shifted_labels", {}, {"xi_fixed": 0.0}),
        ("flipped_kl", {}, {"xi_fixed": 0.0}),
    ],
)
def test_a_bug_is_silent_where_nothing_ends_or_all_demonstrate_or_labels_stay_or_nothing_is_constrained(
    bug, changed, settings
):
    assert changed_parts(bug, batch(**changed), **settings) == set()


def learner_with(bug):
    return BUGS[bug]([settings_for("bootstrapped", hidden=(8,))], 26)


def test_the_flipped_kl_is_the_other_direction():
    log_pi, rule_actions = torch.randn(1, 5, 9).log_softmax(-1), torch.arange(5)[None]
    log_rule = bootstrap.log_stochastic_rule(rule_actions, torch.tensor([0.9]))
    by_torch = torch.nn.functional.kl_div(log_pi, log_rule, reduction="none", log_target=True).sum(-1)
    assert torch.allclose(learner_with("flipped_kl").kl(log_pi, rule_actions), by_torch, atol=1e-5)


def test_the_sampled_value_is_right_on_average_but_its_gradient_is_deaf_to_q():
    logits = torch.zeros(1, 20_000, 9, requires_grad=True)
    log_pi, q, alpha = sac.log_policy(logits), torch.arange(9.0).expand(1, 20_000, 9), torch.tensor([[0.0]])
    sampled, expected = learner_with("sampled").soft_value(log_pi, q, alpha, 0.0), sac.soft_value(log_pi, q, alpha)
    assert abs(float((sampled - expected).detach().mean())) < 0.1
    assert torch.autograd.grad(sampled.sum(), logits, retain_graph=True)[0].abs().max() == 0
    assert torch.autograd.grad(expected.sum(), logits)[0].abs().max() > 0


def test_without_the_stop_gradient_the_loss_is_the_same_and_q_gets_a_slope():
    log_pi, q = torch.randn(1, 4, 9).log_softmax(-1), torch.randn(1, 4, 9, requires_grad=True)
    learner = learner_with("no_stop")
    wrong, right = learner.actor_loss(log_pi, q, 0.0), sac.actor_loss(log_pi, q, learner.alpha)
    assert torch.equal(wrong, right) and not right.requires_grad
    assert torch.autograd.grad(wrong.sum(), q)[0].abs().min() > 0


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


def test_each_bug_leaves_the_healthy_agents_on_the_probe_that_the_lesson_names(hunt):
    letter = {bug: name for name, bug in hunt._bug_of.items()}

    def at(probe, part=slice(-10, None)):
        return {bug: hunt.probe(name, probe)[:, part].mean() for bug, name in letter.items()}

    end, promise, entropy, rarest = at("end"), at("promise"), at("entropy"), at("rarest")
    early, late = at("alike", slice(2, 6)), at("late", slice(2, 6))
    assert min(end, key=end.get) == "no_end" and end["no_end"] < end["none"] - 5
    assert hunt.probe(letter["no_stop"], "promise").max() > 50
    assert promise["bonus_for_all"] > 1.5 * promise["none"]
    assert max(entropy, key=entropy.get) == "sampled" and entropy["sampled"] > 2 * entropy["none"]
    assert rarest["flipped_kl"] > rarest["none"] / 2 and early["flipped_kl"] > early["none"] - 0.03
    assert early["shifted_labels"] < early["none"] - 0.05
    assert late["shifted_labels"] - early["shifted_labels"] > late["none"] - early["none"] + 0.1


def test_a_training_with_a_bug_keeps_what_the_hunt_reads(hunt, monkeypatch):
    monkeypatch.setattr(bugs, "EVERY", 5)
    arrays, ships = train_bug("no_end", updates=10), hunt._results["no_end"]
    names = {f"{part}.{name}" for part in ("curves", "notes", "measured", "weights") for name in getattr(ships, part)}
    assert {name for name in arrays if "." in name} == names and arrays["notes.end"].shape == (2, 3)
