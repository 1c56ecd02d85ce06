"""The harness of the independent checks. The checks themselves: `python -m bootcourse.research.checks`."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from bootcourse.learn.learner import learner_for
from bootcourse.learn.replay_buffer import decode_transitions
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.research import checks


def test_the_demonstrator_balances_every_pole_to_the_end():
    _, returns = checks.collect(checks.balance, checks.cartpole, 10)
    assert (returns == 500).all()


def test_collected_rows_are_whole_episodes_with_their_true_last_states():
    rows, returns = checks.collect(lambda states: np.ones(len(states), dtype=np.int64), checks.cartpole, 5)
    batch = decode_transitions(rows, 4, torch.zeros(len(rows)))
    assert len(rows) == returns.sum() and batch.terminated.sum() == 5
    fallen = batch.next_states[batch.terminated == 1]
    assert (
        fallen[:, 2].abs() * checks.CARTPOLE_SCALES[2] > 12 * 2 * np.pi / 360
    ).all()  # where it fell, not where it started anew


def test_running_out_of_time_is_not_a_termination():
    rows, _ = checks.collect(checks.balance, checks.cartpole, 2)
    assert not decode_transitions(rows, 4, torch.zeros(len(rows))).terminated.any()


def test_the_cartpole_of_fixed_length_pays_only_while_the_pole_is_up_and_never_ends_early():
    falls = lambda states: np.ones(len(states), dtype=np.int64)  # noqa: E731
    rows, returns = checks.collect(falls, checks.fixed_cartpole, 3)
    assert len(rows) == 3 * 500 and (returns < 100).all()
    assert (checks.collect(checks.balance, checks.fixed_cartpole, 3)[1] == 500).all()


def test_the_rule_s_part_is_inert_without_a_rule():
    """Whatever stands where the rule's actions would, sac learns the same."""
    rows, _ = checks.collect(checks.balance, checks.cartpole, 1)
    batch = decode_transitions(rows[None, :64], 4, torch.zeros(1, 64))
    first, second = (learner_for([settings_for("sac")], 4, 2) for _ in range(2))
    first.update(batch)
    second.update(batch._replace(rule_actions=1 - batch.rule_actions, next_rule_actions=1 - batch.next_rule_actions))
    assert all(
        torch.equal(a, b) for a, b in zip(first.actor + first.critics, second.actor + second.critics, strict=True)
    )


def test_training_is_the_same_each_time_and_for_each_seed_alone():
    def trained(settings):
        return checks.train(settings, checks.cartpole, 400)

    settings = with_seeds(settings_for("sac", learning_starts=64), 2)
    together, again, alone = trained(settings), trained(settings), trained(settings[1:])
    assert all(torch.equal(a, b) for a, b in zip(together.actor, again.actor, strict=True))
    for both, one in zip(together.actor, alone.actor, strict=True):
        torch.testing.assert_close(both[1:], one, rtol=1e-3, atol=1e-5)


def test_cloning_the_demonstrator_balances_the_pole():
    """The whole harness in seconds: behaviour cloning from 5 demonstrations."""
    rows, _ = checks.collect(checks.balance, checks.cartpole, 5)
    learner = checks.train([settings_for("bc", envs_per_agent=1, learning_starts=0)], checks.cartpole, 1500, rows)
    assert checks.scores(learner, checks.cartpole, 10).mean() > 450


def test_a_loss_with_the_wrong_sign_misses_the_figure(monkeypatch):
    """What the checks are for."""
    from bootcourse.learn import bc

    loss = bc.cloning_loss
    monkeypatch.setattr(bc, "cloning_loss", lambda log_pi, actions: -loss(log_pi, actions))
    rows, _ = checks.collect(checks.balance, checks.cartpole, 5)
    learner = checks.train([settings_for("bc", envs_per_agent=1, learning_starts=0)], checks.cartpole, 300, rows)
    assert checks.scores(learner, checks.cartpole, 10).mean() < 50


def test_the_table_says_which_figure_was_missed(monkeypatch, tmp_path, capsys):
    good, bad = (lambda seeds, progress: checks.Outcome(np.full(seeds, 499.0)) for _ in range(2))
    bad = lambda seeds, progress: checks.Outcome(np.full(seeds, 20.0), "a note")  # noqa: E731
    for name, measure in (("gail-cartpole", good), ("cql-cartpole", bad)):
        monkeypatch.setitem(checks.CHECKS, name, replace(checks.CHECKS[name], measure=measure))
    out = tmp_path / "table.md"
    assert checks.main(["--only", "gail-cartpole", "cql-cartpole", "--seeds", "2", "--out", str(out)]) == 1
    text = capsys.readouterr().out
    assert out.read_text() == checks.PAGE + text.rstrip("\n") + "\n"
    assert "| yes |" in text and "| **no** |" in text and "a note" in text
    assert checks.main(["--only", "gail-cartpole", "--seeds", "2"]) == 0


def test_a_mistyped_check_is_refused_before_anything_runs(capsys):
    assert checks.main(["--only", "sac-acrobat"]) == 2
    assert "did you mean 'sac-acrobot'" in capsys.readouterr().err


def test_every_check_names_its_figure_budget_and_source():
    for check in checks.CHECKS.values():
        assert np.isfinite(check.published) and check.their_budget and "](https://" in check.source


@pytest.mark.parametrize(("published", "scores", "verdict"), [(500, 496, True), (500, 494, False), (-92.6, -93, True)])
def test_a_hundredth_below_the_figure_still_counts_as_reached(published, scores, verdict):
    check = replace(checks.CHECKS["gail-cartpole"], published=published)
    assert checks.reached(checks.Outcome(np.array([scores])), check) is verdict
