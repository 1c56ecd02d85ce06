"""What ships is current as long as the code behaves as it did: other words change nothing, another sign does."""

import sys
from dataclasses import replace

import numpy as np
import pytest
import torch

from bootcourse.learn import bc, bootstrap, gail, restarts, sac, safe, training
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.replay_buffer import ReplayBuffer
from bootcourse.learn.risk import accident_within, masked
from bootcourse.methods import METHODS
from bootcourse.research import fingerprint as fingerprints
from bootcourse.research import planner
from bootcourse.research.fingerprint import COMPUTED, LEARNED, alike, fingerprint, older
from bootcourse.road import vector_env
from bootcourse.road.constants import constants
from bootcourse.storage.assets import FOLDER, FORMAT, MANIFEST, read_manifest
from bootcourse.storage.sealed import write_sealed


def listing(tmp_path, *files: str):
    """A folder with the shipped manifest, cut down to these files."""
    manifest = read_manifest(FOLDER)
    kept = [entry for entry in manifest["files"] if entry["file"] in files]
    assert len(kept) == len(files)
    names = {name for entry in kept for name in entry["behaviour"]}
    behaviours = {name: known for name, known in manifest["behaviours"].items() if name in names}
    write_sealed(tmp_path / MANIFEST, {"format": FORMAT, "behaviours": behaviours, "files": kept})
    return tmp_path


def weights(method: str) -> str:
    return f"runs/{method}-0/weights.safetensors"


def test_everything_that_ships_is_current():
    assert older(FOLDER) == []


# Changes of words only ----------------------------------------------------------------------------------


def the_same_kl(log_pi, rule_actions, p):
    """Cross-entropy less entropy: the same divergence, rounded differently."""
    log_rule = bootstrap.log_stochastic_rule(rule_actions, p, log_pi.shape[-1])
    return -(log_pi.exp() * log_rule).sum(-1) - sac.entropy(log_pi)


class RenamedLearner(SACLearner):
    """The same learner under another name."""


def the_same_target(reward, terminated, next_value, gamma):
    return torch.where(terminated > 0, reward, reward + gamma * next_value)


def test_code_in_other_words_leaves_everything_current(tmp_path, monkeypatch):
    folder = listing(tmp_path, weights("soft"), weights("bootstrapped"), weights("cql"), "bound-default.npz")
    monkeypatch.setattr(bootstrap, "kl_to_rule", the_same_kl)
    monkeypatch.setattr(sac, "critic_target", the_same_target)
    monkeypatch.setitem(METHODS, "soft", replace(METHODS["soft"], name="another name", learner=RenamedLearner))
    assert older(folder) == []


def test_what_another_processor_rounds_differently_is_alike(monkeypatch):
    learned, original = fingerprint("bootstrapped"), SACLearner.__init__

    def rounded(learner, *args, **more):
        original(learner, *args, **more)
        noise = torch.Generator().manual_seed(0)
        with torch.no_grad():
            for parameter in (*learner.actor, *learner.critics):
                parameter *= 1 + 1e-6 * (2 * torch.rand(parameter.shape, generator=noise) - 1)

    monkeypatch.setattr(SACLearner, "__init__", rounded)
    moved = fingerprint("bootstrapped")
    assert moved != learned and alike("bootstrapped", moved, learned)
    assert np.abs(np.subtract(moved, learned)).max() < LEARNED / 10


# Changes of behaviour -----------------------------------------------------------------------------------


def road_with(**changes):
    """The constants of every scenario, with another reward."""
    return lambda scenario: constants(replace(scenario, reward=replace(scenario.reward, **changes)))


def rule_with(**changes):
    """The same, with another rule."""
    return lambda scenario: constants(replace(scenario, rule=replace(scenario.rule, **changes)))


def negative(function):
    return lambda *args, **more: -function(*args, **more)


def reversed_kl(log_pi, rule_actions, p):
    log_rule = bootstrap.log_stochastic_rule(rule_actions, p, log_pi.shape[-1])
    return (log_rule.exp() * (log_rule - log_pi)).sum(-1)


def the_worst(children, scores, alive, beam, original=planner.select):
    return original(children, -scores, alive, beam)


def fewer_demonstrations(replay, batch, beta, generators, original=ReplayBuffer.sample):
    return original(replay, batch, 0.9 * beta, generators)


RULE = sys.modules["bootcourse.rule"]
PLANTED = {  # what is wrong: (a behaviour, a shipped file that depends on it, where, name, the wrong one)
    "the KL reversed": ("soft", weights("soft"), bootstrap, "kl_to_rule", reversed_kl),
    "the bonus subtracted": (
        "demos", weights("demos"), bootstrap, "augmented_reward",
        lambda reward, is_demonstration, bonus: reward - bonus * is_demonstration,
    ),
    "the margin's sign": (
        "margin", weights("margin"), bootstrap, "large_margin_loss", negative(bootstrap.large_margin_loss)
    ),
    "the margin with the KL without its filter": (
        "margin_soft", weights("margin_soft"), bootstrap, "paper_q_filter",
        lambda q, expert_actions: torch.ones_like(q[..., 0]),
    ),
    "a target without an end": (
        "sac", weights("sac"), sac, "critic_target",
        lambda reward, terminated, next_value, gamma: reward + gamma * next_value,
    ),
    "the temperature's sign": ("sac", weights("sac"), sac, "temperature_loss", negative(sac.temperature_loss)),
    "CQL's sign": ("cql", weights("cql"), sac, "conservative_loss", negative(sac.conservative_loss)),
    "CQL's sign, with an actor": (
        "cql_sac", weights("cql_sac"), sac, "conservative_loss", negative(sac.conservative_loss)
    ),
    "GAIL's reward": (
        "gail", weights("gail"), gail.GAILLearner, "imitation_reward", staticmethod(negative(gail.imitation_reward))
    ),
    "BC's sign": ("bc", weights("bc"), bc, "cloning_loss", negative(bc.cloning_loss)),
    "β that does not fall": (
        "bootstrapped", weights("bootstrapped"), training, "demonstration_share",
        lambda episode, beta_start, beta_episodes: beta_start + 0 * episode,
    ),
    "fewer demonstrations in a batch": (
        "bootstrapped", weights("bootstrapped"), ReplayBuffer, "sample", fewer_demonstrations
    ),
    "greedy exploration": (
        "sac", weights("sac"), training, "sample_actions", lambda policy, uniforms: policy.argmax(-1)
    ),
    "the road's reward": ("road", "readme/trap.gif", vector_env, "constants", road_with(w_y=0.051)),
    "an accident that costs less": ("road", "readme/trap.png", vector_env, "constants", road_with(accident=-9.0)),
    "a rule that keeps another distance": ("rule", "rollouts/rule.npz", RULE, "constants", rule_with(t_safe=2.0)),
    "a rule with other speeds": ("demonstrations", "demonstrations.npz", RULE, "constants", rule_with(v_min=7.0)),
    "a planner that keeps the worst drives": ("planner", "bound-default.npz", planner, "select", the_worst),
}  # fmt: skip


@pytest.mark.parametrize("what", PLANTED)
def test_a_file_of_another_behaviour_is_named_even_if_rounding_could_move_ten_times_as_far(what, tmp_path, monkeypatch):
    name, file, place, attribute, wrong = PLANTED[what]
    folder = listing(tmp_path, file)
    monkeypatch.setattr(fingerprints, "LEARNED", 10 * LEARNED)
    monkeypatch.setattr(fingerprints, "COMPUTED", 10 * COMPUTED)
    monkeypatch.setattr(place, attribute, wrong)
    (sentence,) = older(folder)
    changed = sentence.removeprefix(f"{file} is older than the code's ").split(": ")[0].split(", ")
    assert name in changed


def a_reward_for_accidents(learner, taken):
    return taken.rewards + learner.accident_cost * taken.terminated


def a_price_that_falls(multiplier, rate, budget, step, original=safe.multiplier_step):
    return original(multiplier, budget, rate, step)


SAFE = {  # what is wrong: where, name, the wrong one
    "an accident that pays": (safe.SafeLearner, "rewards", a_reward_for_accidents),
    "λ that falls with accidents": (safe, "multiplier_step", a_price_that_falls),
    "risky actions alone": (safe, "masked", lambda pi, risk, limit: masked(pi, -risk, -limit)),
    "a shield that asks for braking": (safe, "needed_braking", negative(safe.needed_braking)),
    "a critic that looks at the best returns": (safe, "mean_of_the_worst", lambda found, share: found.amax(-1)),
    "the risk of no accident": (safe, "accident_within", lambda *rows: 1 - accident_within(*rows)),
    "no restarts": (restarts, "demonstration_share", lambda episode, share, episodes: 0 * share),
    "restarts just before the accident": (restarts, "FARTHEST", restarts.NEAREST),
}


@pytest.fixture(scope="module")
def safe_ppo():
    return fingerprint("ppo_safe")


@pytest.mark.parametrize("what", SAFE)
def test_the_fingerprint_of_safe_ppo_tells_what_is_off_by_default(what, safe_ppo, monkeypatch):
    place, attribute, wrong = SAFE[what]
    monkeypatch.setattr(fingerprints, "LEARNED", 10 * LEARNED)
    monkeypatch.setattr(place, attribute, wrong)
    assert not alike("ppo_safe", fingerprint("ppo_safe"), safe_ppo)
