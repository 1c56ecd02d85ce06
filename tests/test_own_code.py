"""A student's own code: it is kept, found again, trains the agent, and is compared with the library's."""

import linecache

import pytest
import torch

from bootcourse.course import check, own_code
from bootcourse.course.lessons import registry
from bootcourse.course.own_learner import LATER, own_learner
from bootcourse.errors import BootcourseError
from bootcourse.learn.learner import learner_for
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from tests.answers import in_this_process

PARTS = [name for name in own_code.PARTS if name in registry()]


@pytest.fixture(autouse=True)
def nobody_wrote_anything(monkeypatch, tmp_path):
    monkeypatch.setattr(own_code, "_own", {})
    in_this_process(monkeypatch)  # in this process: faster, and no answer here does harm
    monkeypatch.chdir(tmp_path)


def cell(text: str) -> dict:
    """Run a notebook's cell, and return what it defines."""
    name, space = f"cell {hash(text)}", {"__name__": "__main__"}
    linecache.cache[name] = len(text), None, text.splitlines(keepends=True), name
    exec(compile(text, name, "exec"), space)
    return space


RIGHT = """\
import torch
import torch as t
from math import exp
ONE = 1

def alive(terminated):
    return ONE - terminated

def critic_target(reward, terminated, next_value, gamma):
    return reward + gamma * alive(terminated) * next_value * t.ones(()) * exp(0)
"""


def solutions(*left_out: str) -> dict:
    return {name: registry()[name].solution for name in PARTS if name not in left_out}


BUFFER = """\
import torch

class ReplayBuffer:
    def __init__(self, size):
        self.rows = []

    def add(self, row):
        self.rows = [*self.rows[-9:], row]

    def sample(self, batch, rng):
        return torch.stack([self.rows[i] for i in rng.integers(len(self.rows), size=batch)])
"""


# Kept and found again -------------------------------------------------------------------------------


def test_an_answer_that_passes_is_kept_with_all_that_it_uses_and_found_again_in_another_notebook(tmp_path, capsys):
    verdict = check.critic_target(cell(RIGHT)["critic_target"])
    assert "kept in answers/critic_target.py" in verdict.footer and verdict.passed
    own_code._own.clear()
    own_code.load()
    assert "your critic_target" in capsys.readouterr().out
    ends = torch.tensor([1.0, 0.0])
    assert own_code._own["critic_target"](torch.ones(2), ends, torch.ones(2), 0.5).tolist() == [1, 1.5]
    assert [path.name for path in (tmp_path / "answers").iterdir()] == ["critic_target.py"]


def test_an_answer_that_does_not_pass_and_the_library_s_own_are_not_kept(tmp_path):
    check.critic_target(cell(RIGHT.replace("ONE = 1", "ONE = 2"))["critic_target"])
    check.critic_target(registry()["critic_target"].solution)
    check.strict()
    try:
        check.critic_target(cell(RIGHT)["critic_target"])
    finally:
        check.strict(False)
    assert not own_code._own and not (tmp_path / "answers").exists()


def test_later_cells_use_an_answer_that_is_no_part_of_an_agent(tmp_path, capsys):
    text = "def bearable_risk(stay, escape, crash):\n    return min(1, max(0, (escape - stay) / (escape - crash)))\n"
    answer = cell(text)["bearable_risk"]
    assert own_code.yours_or_ours("bearable_risk") is registry()["bearable_risk"].solution
    assert check.bearable_risk(answer).passed
    assert own_code.yours_or_ours("bearable_risk", doing="Judging") is answer
    assert capsys.readouterr().out.splitlines() == [
        "Training with our bearable_risk.",
        "Judging with your bearable_risk.",
    ]
    assert not (tmp_path / "answers").exists()


def test_an_answer_that_uses_what_no_file_holds_trains_in_its_notebook_alone(tmp_path):
    text = RIGHT.replace("ONE = 1", "ONE = torch.ones(())")
    assert "uses `ONE`, which a file cannot hold" in check.critic_target(cell(text)["critic_target"]).footer
    assert "critic_target" in own_code._own and not (tmp_path / "answers").exists()


def test_no_file_and_no_part_is_said(capsys):
    own_code.load()
    assert capsys.readouterr().out == f"{own_code.NONE}\n" and own_code.compare().sentence == own_code.NONE
    with pytest.raises(BootcourseError, match="did you mean 'critic_target'"):
        own_code.use(cell("def critic_targets(): pass")["critic_targets"])


# It trains ------------------------------------------------------------------------------------------


def test_a_part_of_one_s_own_replaces_the_library_s_and_a_line_says_so(capsys):
    own_code.use(cell(RIGHT)["critic_target"])
    training = own_code.training(with_seeds(settings_for("sac", learning_starts=16, batch=16, hidden=(8,)), 2))
    called = []
    training.learner.own["critic_target"] = lambda *given: (
        called.append(given) or registry()["critic_target"].solution(*given)
    )
    training.run(progress=False, stop=lambda: training.updates >= 2)
    assert len(called) == 4 and called[0][0].shape == (16,)
    assert "our soft_value, your critic_target, our critic_loss" in capsys.readouterr().out


def test_a_buffer_in_float64_is_refused_by_the_comparison_and_by_the_training():
    own_code.use(cell(BUFFER.replace("])\n", "]).double()\n"))["ReplayBuffer"])
    assert "float32" in str(own_code.compare())
    training = own_code.training([settings_for("sac", learning_starts=16, batch=16, hidden=(8,))])
    with pytest.raises(BootcourseError, match="^Your `ReplayBuffer` gives rows in float64: training needs float32"):
        training.run(progress=False, stop=lambda: training.updates >= 2)


@pytest.mark.parametrize("method", ["sac", "soft", "margin_soft", "cql", "gail", "ibrl"])
@pytest.mark.parametrize("left_out", [(), tuple(LATER)], ids=["with the later parts", "without"])
def test_the_solutions_make_the_library_s_update(method, left_out):
    agents, batch = with_seeds(settings_for(method, hidden=(8,), alpha_init=0.3), 2), own_code.batch_with_everything(2)
    library, own = learner_for(agents, 26), own_learner(solutions(*left_out), agents, 26, 9)
    for _ in range(3):
        library.update(batch)
        own.update(batch)
    for right, mine in zip(library.actor + library.critics, own.actor + own.critics, strict=True):
        assert torch.allclose(right, mine, atol=1e-5)


def test_the_solutions_make_the_library_s_update_of_ppo_and_begin_as_the_clone():
    small = {"hidden": (8,), "envs_per_agent": 4, "horizon": 8, "batch": 16, "epochs": 1, "buffer_size": 16}
    small |= {"demonstration_episodes": 2, "cloning_updates": 5}
    settings = with_seeds(settings_for("ppo_cloned", **small), 2)
    own_code._own.update(solutions())
    mine, library = own_code.training(settings), Training(settings)
    assert mine.learner.own.keys() == {"advantages", "clipped_loss"}
    for training in (mine, library):
        training.run(progress=False, stop=lambda training=training: training.updates >= 2)
    for ours, theirs in zip(mine.learner.actor, library.learner.actor, strict=True):
        assert torch.allclose(ours, theirs, atol=1e-6)


# It is compared -------------------------------------------------------------------------------------


def test_the_solutions_make_the_same_update():
    own_code._own.update(solutions())
    verdict = own_code.compare()
    assert verdict.passed and all(f"your `{name}`" in verdict.sentence for name in PARTS), verdict


BUGS = {
    "the entropy's sign": "def soft_value(log_pi, q, alpha): return (log_pi.exp() * (q + alpha * log_pi)).sum(-1)",
    "no stop-gradient": """def actor_loss(log_pi, q, alpha):
        return -(log_pi.exp() * (q - alpha * log_pi)).sum(-1).mean()""",
    "the larger critic": """def constrained_target(r, ended, log_pi, q, kl, alpha, xi, gamma):
        return r + gamma * (1 - ended) * ((log_pi.exp() * (q.amax(0) - alpha * log_pi)).sum(-1) - xi * kl)""",
    "the bonus's sign": """def mixed_batch(own, theirs, size, beta, bonus, rng):
        n = round(beta * size)
        rows = torch.cat([theirs[rng.integers(len(theirs), size=n)], own.sample(size - n, rng)])
        rows[:n, -4] -= bonus
        return rows, (torch.arange(size) < n).float()""",
    "a buffer that never forgets": BUFFER.replace("self.rows[-9:]", "self.rows"),
}  # fmt: skip


@pytest.mark.parametrize("text", BUGS.values(), ids=BUGS)
def test_with_a_planted_bug_the_comparison_names_the_part_that_differs(text):
    defined = cell(f"import torch\n\n{text}")
    name = next(name for name in PARTS if name in defined)
    own_code._own.update(solutions())
    own_code.use(defined[name])
    verdict = own_code.compare()
    assert verdict.kind == "wrong" and verdict.sentence == f"Something is wrong with your `{name}`.", verdict
    assert verdict.details[0].startswith(name)


CAPS = {  # right at the start of a training, and wrong later
    "a target kept within 20": """def critic_target(r, ended, v, gamma):
        return (r + gamma * (1 - ended) * v).clamp(-20, 20)""",
    "values kept within 100": """def soft_value(log_pi, q, alpha):
        return (log_pi.exp() * (q.clamp(-100, 100) - alpha * log_pi)).sum(-1)""",
    "errors kept within 20": """def critic_loss(q_pair, a, target):
        errors = q_pair.gather(-1, a.expand(2, -1)[..., None])[..., 0] - target.detach()
        return errors.clamp(-20, 20).square().mean(-1).sum()""",
    "a temperature of at least a thousandth": """def temperature_loss(log_alpha, entropy, target):
        return log_alpha.exp().clamp(min=1e-3) * (entropy.detach().mean() - target)""",
    "a temperature of at most 2": """def actor_loss(log_pi, q, alpha):
        return -(log_pi.exp() * (q.detach() - alpha.clamp(max=2) * log_pi)).sum(-1).mean()""",
    "a KL of at most 6 nats": """def soft_constraint(log_pi, a, p):
        log_rule = torch.full_like(log_pi, float(torch.tensor((1 - p) / 8).log()))
        log_rule = log_rule.scatter(-1, a[:, None], float(torch.tensor(p).log()))
        return (log_pi.exp() * (log_pi - log_rule)).sum(-1).clamp(max=6)""",
    "a probability that is lost": """def soft_constraint(log_pi, a, p):
        log_rule = torch.full_like(log_pi, float(torch.tensor((1 - p) / 8).log()))
        log_rule = log_rule.scatter(-1, a[:, None], float(torch.tensor(p).log()))
        return (log_pi.exp() * (log_pi.exp().log() - log_rule)).sum(-1)""",
}  # fmt: skip


@pytest.mark.parametrize("text", CAPS.values(), ids=CAPS)
def test_the_comparison_finds_what_is_wrong_only_with_the_magnitudes_of_a_training(text):
    defined = cell(f"import torch\n\n{text}")
    name = next(name for name in PARTS if name in defined)
    own_code.use(defined[name])
    verdict = own_code.compare()
    assert verdict.kind == "wrong" and "at the start" not in verdict.details[0], verdict
