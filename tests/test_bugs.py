"""The six bugs: each differs from the right update, in its own way and in no other; the shipped agents read back."""

import json

import numpy as np
import pytest
import torch

from bootcourse.course.lessons import registry
from bootcourse.course.lessons.bug_hunt import bugs
from bootcourse.course.lessons.bug_hunt.bugs import BUGS, COMMAND, FILE, LEARNERS, LETTERS, PROBES, Hunt
from bootcourse.errors import BootcourseError
from bootcourse.files import sha256, write_arrays
from bootcourse.learn import bootstrap, sac
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.replay_buffer import Batch
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.research.ship import Shipment, add_kept
from bootcourse.storage.assets import FOLDER

AGENTS, SIZE = 2, 16


def batch(**changed) -> Batch:
    """A batch in which everything occurs: ends, demonstrations, labels that differ from one second to the next."""
    draw = torch.Generator().manual_seed(1)
    states, next_states = (torch.randn(AGENTS, SIZE, 26, generator=draw) for _ in range(2))
    actions, rule_actions = (torch.randint(0, 9, (AGENTS, SIZE), generator=draw) for _ in range(2))
    half = (torch.arange(SIZE) % 2).float().expand(AGENTS, -1)
    made = Batch(states, next_states, actions, torch.rand(AGENTS, SIZE, generator=draw), half, rule_actions,
                 (rule_actions + 1) % 9, (torch.arange(SIZE) < 8).float().expand(AGENTS, -1))  # fmt: skip
    return made._replace(**changed)


def after(kind: type[SACLearner], given: Batch, **settings) -> dict[str, torch.Tensor]:
    """Actor and critics after one update."""
    learner = kind(with_seeds(settings_for("bootstrapped", hidden=(8,), alpha_init=0.1, **settings), AGENTS), 26)
    learner.update(given)
    return {"actor": torch.cat([p.detach().flatten() for p in learner.actor]),
            "critics": torch.cat([p.detach().flatten() for p in learner.critics])}  # fmt: skip


def differs(bug: str, given: Batch, **settings) -> dict[str, bool]:
    right, wrong = after(SACLearner, given, **settings), after(BUGS[bug], given, **settings)
    return {part: not torch.equal(right[part], wrong[part]) for part in right}


@pytest.mark.parametrize("bug", BUGS)
def test_a_bug_changes_the_update_and_raises_nothing(bug):
    assert any(differs(bug, batch()).values())


@pytest.mark.parametrize(
    "bug, harmless",
    {
        "no_end": {"terminated": torch.zeros(AGENTS, SIZE)},
        "bonus_for_all": {"is_demonstration": torch.ones(AGENTS, SIZE)},
        "shifted_labels": {"next_rule_actions": batch().rule_actions},
    }.items(),
)
def test_a_bug_in_the_batch_is_silent_where_nothing_ends_or_all_demonstrate_or_labels_stay(bug, harmless):
    assert not any(differs(bug, batch(**harmless)).values())


def test_without_a_constraint_neither_the_kl_nor_its_labels_matter():
    for bug in ("flipped_kl", "shifted_labels"):
        assert not any(differs(bug, batch(), xi_fixed=0.0).values())


def test_a_missing_end_a_bonus_for_all_and_a_missing_stop_change_the_critics_alone():
    for bug in ("no_end", "bonus_for_all", "no_stop"):
        assert differs(bug, batch()) == {"actor": False, "critics": True}, bug


def test_shifted_labels_change_the_actor_alone():
    assert differs("shifted_labels", batch()) == {"actor": True, "critics": False}


def learner_with(bug, **changes):
    return BUGS[bug]([settings_for("bootstrapped", hidden=(8,), **changes)], 26)


def test_the_flipped_kl_is_the_other_direction():
    log_pi, rule_actions = torch.randn(1, 5, 9).log_softmax(-1), torch.arange(5)[None]
    log_rule = bootstrap.log_stochastic_rule(rule_actions, torch.tensor([0.9]))
    by_torch = torch.nn.functional.kl_div(log_pi, log_rule, reduction="none", log_target=True).sum(-1)
    assert torch.allclose(learner_with("flipped_kl").kl(log_pi, rule_actions), by_torch, atol=1e-5)


def test_the_sampled_value_is_right_on_average_but_its_gradient_is_deaf_to_q():
    logits = torch.zeros(1, 20_000, 9, requires_grad=True)
    log_pi, q, alpha = sac.log_policy(logits), torch.arange(9.0).expand(1, 20_000, 9), torch.tensor([[0.0]])
    sampled = learner_with("sampled").soft_value(log_pi, q, alpha, 0.0)
    expected = sac.soft_value(log_pi, q, alpha)
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


def test_what_ships_is_small_complete_and_says_how_it_was_made():
    hunt = Hunt()
    assert FILE.stat().st_size < 1_500_000 and hunt.names == ("healthy", *LETTERS)
    assert hunt.provenance["command"] == COMMAND and hunt.provenance["updates"] == 10_000
    for name in hunt.names:
        assert hunt.curve(name, "success").shape[0] == 2 and np.nanmax(hunt.curve(name, "accident")) <= 3
        for probe in PROBES:
            assert hunt.probe(name, probe).shape == (2, len(hunt.updates))
        assert np.allclose(hunt.agent(name).probabilities(np.zeros((3, 26))).sum(-1), 1)


def test_the_verdict_that_passes_is_the_shuffle_s():
    solution, hunt = registry()["diagnose"].solution, Hunt()
    assert {letter: solution(letter) for letter in LETTERS} == {k: v for k, v in hunt._bug_of.items() if v in BUGS}


def test_each_bug_leaves_the_healthy_agents_on_the_probe_that_the_lesson_names():
    hunt = Hunt()
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


def test_a_file_that_is_missing_or_another_is_named_with_the_remedy(tmp_path):
    with pytest.raises(BootcourseError, match="is not there"):
        Hunt(tmp_path / "none.npz")
    write_arrays(tmp_path / "other.npz", {"a": np.zeros(3), "provenance": np.array(json.dumps({}))})
    with pytest.raises(BootcourseError, match="python -m bootcourse.course.lessons.bug_hunt.bugs"):
        Hunt(tmp_path / "other.npz")
    with pytest.raises(BootcourseError, match="choose from healthy, A, B"):
        Hunt().curve("G", "success")


def test_the_command_makes_such_a_file(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(bugs, "LEARNERS", {"none": SACLearner, "no_end": LEARNERS["no_end"]})
    monkeypatch.setattr(bugs, "EVERY", 5)
    assert bugs.main(["--out", str(tmp_path / "hunt.npz"), "--updates", "10"]) == 0
    with np.load(tmp_path / "hunt.npz") as file:
        assert file["no_end/probes"].shape[1:] == (2, len(PROBES)) and "none/actor-0" in file.files
    assert "training with no_end" in capsys.readouterr().out
    assert FILE.parent == FOLDER


def test_it_is_kept_and_listed_when_the_assets_are_built(tmp_path):
    new = tmp_path / "new"
    new.mkdir()
    shipment = Shipment(None, tmp_path / "nothing", new, False)
    add_kept(shipment, FOLDER)
    entry = shipment.entries["bug_hunt.npz"]
    assert entry["sha256"] == sha256(FILE) == sha256(new / "bug_hunt.npz") and entry["command"] == COMMAND
    assert list(entry["behaviour"]) == ["road", "rule", "bootstrapped"]
    add_kept(Shipment(None, tmp_path / "nothing", tmp_path / "other", False), tmp_path / "nothing")
