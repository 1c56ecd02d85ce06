"""A model of the road that is learned from drives, the look-ahead in it, and the study of both."""

import numpy as np
import pytest
import torch

import bootcourse as bc
from bootcourse.episodes.lookahead import worth_of_speed
from bootcourse.learn import road_model
from bootcourse.learn.road_model import FORMS, ImaginedAhead, RoadModel, Transitions, imagine, learned_from
from bootcourse.research.experiments import learned_model
from bootcourse.road.observation import V_LON_SCALE
from bootcourse.scenario import DEFAULT, N_ACTIONS

SIZE, HIDDEN = DEFAULT.observation_size, 128


@pytest.fixture(scope="module")
def agent():
    return bc.shipped_agents("bootstrapped")[0]


@pytest.fixture(scope="module")
def drives() -> Transitions:
    return road_model.transitions_of(bc.rule_policy(DEFAULT), range(20))


def blank(members: int = 2) -> RoadModel:
    """Networks whose outputs are 0: nothing changes, nothing is paid, and each decision is an even chance."""
    sizes = (SIZE + N_ACTIONS, HIDDEN, SIZE + 2)
    shapes = [shape for n_in, n_out in zip(sizes, sizes[1:], strict=False) for shape in ((n_in, n_out), (1, n_out))]
    return RoadModel([torch.zeros(members, *shape) for shape in shapes], torch.ones(SIZE))


def test_every_decision_of_the_drives_is_a_row_and_an_accident_ends_a_drive(drives):
    assert len(drives.rewards) == 20 * DEFAULT.clock.decisions and not drives.accidents.any()
    crash = road_model.transitions_of(bc.plan_policy([("accelerate straight", 30)]), [3])
    assert crash.accidents.tolist() == [0] * (len(crash.rewards) - 1) + [1]
    assert torch.equal(crash.states[1:], crash.next_states[:-1])
    assert len(drives.and_also(crash).actions) == len(drives.actions) + len(crash.actions)


def test_a_learned_model_says_more_of_new_drives_than_that_nothing_changes(drives):
    model, new = learned_from(drives, updates=300), road_model.transitions_of(bc.rule_policy(DEFAULT), range(50, 60))
    states, actions = new.states.expand(5, -1, -1), new.actions.expand(5, -1)
    expected, rewards, accidents = model.step(states, actions)
    error, unchanged = (((each - new.next_states) / model.scale).square().mean() for each in (expected, states))
    assert error < 0.7 * unchanged
    assert (rewards.mean(0) - new.rewards).square().mean() < 0.2 * new.rewards.var() and accidents.max() < 0.5
    assert len({float(member[0, 0]) for member in model.layers[0]}) == 5, "each network has weights of its own"
    again = learned_from(drives, updates=300)
    assert all(torch.equal(one, other) for one, other in zip(model.layers, again.layers, strict=True))


def test_an_imagined_drive_adds_rewards_while_it_is_likely_to_go_on_and_then_the_worth_of_its_speed(agent):
    states = torch.zeros(3, SIZE)
    states[:, road_model.V_LON] = torch.tensor([0.5, 1.0, 1.2])
    values, accidents = imagine(blank(), agent, states, torch.tensor([[0, 8]] * 3), horizon=3)
    worth = np.interp(V_LON_SCALE * np.array([0.5, 1.0, 1.2]), *worth_of_speed(DEFAULT))
    assert values.numpy() == pytest.approx(np.tile(worth[:, None] / 8, (2, 1, 2)), rel=1e-5)
    assert accidents.numpy() == pytest.approx(np.full((2, 3, 2), 7 / 8))
    paying = blank()
    paying.layers[-1][:, 0, SIZE] = torch.tensor([1.0, -1.0])  # the reward, by network
    more = imagine(paying, agent, states, torch.tensor([[0, 8]] * 3), horizon=3)[0] - values
    assert more[:, 0, 0].tolist() == pytest.approx([1.75, -1.75]), "1 + 1/2 + 1/4"


@pytest.mark.parametrize(
    ("form", "risk", "expected"),
    [(FORMS[0], 0.0, 1), (FORMS[1], 0.0, 2), (FORMS[2], 0.4, "own"), (FORMS[2], 0.6, 1)],
)
def test_the_three_forms_take_the_best_on_average_the_best_of_the_worst_and_the_agent_s_own(
    form, risk, expected, agent, monkeypatch
):
    values, accidents = torch.zeros(2, 1, 9), torch.full((2, 1, 9), risk)
    values[:, 0, 1], values[:, 0, 2] = torch.tensor([9.0, -1.0]), torch.tensor([3.0, 3.0])  # means 4 and 3
    monkeypatch.setattr(road_model, "imagine", lambda *arguments: (values, accidents))
    seen = np.zeros((1, SIZE), dtype=np.float32)
    own, ahead = int(agent.probabilities(seen).argmax()), ImaginedAhead(agent, blank(), form)
    assert ahead(seen, np.zeros((1, 10, 10))).actions.tolist() == [own if expected == "own" else expected]
    assert ahead.overruled.tolist() == [expected not in ("own", own)]


def test_an_unknown_form_is_one_sentence(agent):
    with pytest.raises(bc.BootcourseError, match="Form 'best' is unknown"):
        ImaginedAhead(agent, blank(), "best")


def test_the_study_learns_anew_in_each_round_from_all_drives_and_its_control_from_as_many(monkeypatch):
    for module, constants in ((learned_model, {"DRIVES": 2, "ROUNDS": 2}), (road_model, {"HIDDEN": (8,)})):
        for name, value in constants.items():
            monkeypatch.setattr(module, name, value)
    monkeypatch.setattr(learned_model, "learned_from", lambda drives, seed: learned_from(drives, seed, updates=2))
    tried = {f"agent {seed}": learned_model.learned_ahead(seed, tests=3) for seed in (1, 0)}
    agents = learned_model.together(tried)
    assert [agent["seed"] for agent in agents.agents] == [0, 1]
    first, second = agents.notes["rows"].T
    assert (first < second).all() and (agents.measured["rows"] > first).all()
    assert learned_model.per_thousand(agents, FORMS[0]).shape == (2, 2)
    assert learned_model.per_thousand(agents, "shield", control=True).shape == (2, 1)
    monkeypatch.setattr(learned_model, "RANDOM", (0.5,))
    tried["random 0.5 agent 1"] = learned_model.learned_ahead(1, tests=3, share=0.5)
    assert len(learned_model.together(tried, 0.5).agents) == 1
    headings, rows = learned_model.rows(tried, {})
    assert len(rows) == 3 * len(FORMS) and {len(row) for row in rows} == {len(headings)}
