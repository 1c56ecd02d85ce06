"""Exercises of the lesson on learning from demonstrations."""

import torch

from bootcourse.course.exercise import MANY_ROWS, exercise
from bootcourse.course.lessons.learning_from_demonstrations import batches

mixed_batch = batches.mixed_batch


def q_cases(rng):
    """Expert far ahead, ahead by less than the margin, behind, level; three actions; 400 behind; then 40 at random."""
    q = torch.zeros(4, 9)
    q[0, 2], q[1, 2], q[2, 2] = 3.0, 0.4, -1.0
    yield q, torch.full((4,), 2)
    for less in (1e-5, 2.0**-23):  # 2 - 2⁻²³ is the float32 before 2
        level = torch.zeros(3, 9)
        level[:, [1, 5]] = torch.tensor([[2.0, 2.0], [2.0, 2.0 - less], [2.0 - less, 2.0]])
        yield level, torch.full((3,), 5)
        yield level + 198, torch.full((3,), 5)
    yield torch.tensor([[-200.0, 200.0, 0.0], [-43.0, -12.0, -60.0], [200.0, -200.0, 199.5]]), torch.tensor([0, 0, 0])
    yield torch.tensor([[0.3, -0.2, 0.1]]), torch.tensor([1])
    yield torch.tensor([[-5.0, -7.0, -6.0], [-5.0, -7.0, -6.0]]), torch.tensor([0, 1])
    for number in range(40):
        size = rng.integers(1, 6)
        yield torch.tensor(rng.normal(0, (1, 40)[number % 4 == 3], (size, 9))), torch.tensor(rng.integers(0, 9, size))
    yield torch.tensor(rng.normal(0, 100, (MANY_ROWS, 9))), torch.tensor(rng.integers(0, 9, MANY_ROWS))


@exercise(
    "J_E(Q) = max_a [Q(s,a) + l(a_E,a)] - Q(s,a_E), Section IV-B",
    minutes=8, difficulty=2, cases=q_cases, slopes=["q"],
    worked=[
        # the expert leads by 0.5: the loss is 0.5. It is behind by 2: 3. It leads by 2: 0.
        ((torch.tensor([[1.5, 1.0], [1.0, 3.0], [3.0, 1.0]]), torch.tensor([0, 0, 0])), torch.tensor([0.5, 3.0, 0.0])),
    ],
    hints=(
        "Add 1 to every action's Q but the expert's. By how much does the best of these exceed the expert's own Q?",
        "`torch.arange(q.shape[-1]) == expert_action.unsqueeze(-1)` is True in the expert's column.",
    ),
    mistakes={
        "(~is_expert) -> 1":
            "Your loss is at least 1: the expert's own action gets no margin, l(a_E, a_E) = 0.",
        "+ (~is_expert) ->":
            "You have no margin: your loss is 0 as soon as the expert's Q equals the largest.",
        "(q + (~is_expert)) -> (q + 1).masked_fill(is_expert, -torch.inf)":
            "Your loss goes below 0 where the expert leads by more than the margin: the maximum runs over *all* "
            "actions, the expert's included.",
        "return q_expert - (q + (~is_expert)).amax(-1)":
            "Your sign is wrong: the loss grows with the expert's lead, so training would reduce the lead.",
        "amax -> sum":
            "You add up the actions. Only the largest counts: take the maximum.",
        "return ((q + (~is_expert)).amax(-1) - q_expert).detach()":
            "Your loss has the right value but no gradient, so it cannot move Q: leave out `.detach()`, `.item()` and "
            "NumPy.",
        "return ((q + (~is_expert)).amax(-1) - q_expert).mean()":
            "You took the mean over the batch. Return one number for each state: the Q-filter comes next.",
    },
)  # fmt: skip
def large_margin_loss(q, expert_action):
    is_expert = torch.arange(q.shape[-1]) == expert_action.unsqueeze(-1)
    q_expert = q.gather(-1, expert_action.unsqueeze(-1)).squeeze(-1)
    return (q + (~is_expert)).amax(-1) - q_expert


@exercise(
    "J_E^Q: on where Q(s,a_E) ≥ max_a Q(s,a), as printed in Section IV-B", minutes=3, difficulty=1, cases=q_cases,
    worked=[
        # ahead, behind, and level with the best
        ((torch.tensor([[1.5, 1.0], [1.0, 3.0], [2.0, 2.0]]), torch.tensor([0, 0, 0])), torch.tensor([1.0, 0.0, 1.0])),
    ],
    hints=(
        "Compare two numbers of each state: the expert's Q and the largest one.",
        "`q.gather(-1, expert_action.unsqueeze(-1)).squeeze(-1)` is the first, `q.amax(-1)` the second.",
    ),
    mistakes={
        "q_expert >= q.amax(-1) -> q_expert > q.scatter(-1, expert_action.unsqueeze(-1), -torch.inf).amax(-1)":
            "Your filter is off where the expert's Q equals the largest. The formula says ≥.",
        "q_expert >= -> q_expert >":
            "Your filter is never on: no Q is larger than the largest. The formula says ≥.",
        "return (q.argmax(-1) == expert_action).to(q.dtype)":
            "Where two actions share the largest Q, `argmax` names the first of them, and your filter is off although "
            "≥ holds: compare the values, not the actions' numbers.",
        "q_expert >= q.amax(-1) -> q_expert >= q.amax(-1) - 1e-3":
            "Your filter is on where the expert's Q is a little below the largest. Compare the numbers as they are.",
        "q_expert >= -> q_expert <":
            "Your filter is on where the paper's is off. That would make more sense, but this exercise asks for "
            "the paper's.",
        "q.amax(-1) -> q.mean(-1)":
            "You compare with the mean of Q. The paper's filter compares with the *largest* Q.",
        "q.amax(-1) -> q.max()":
            "You compare with the largest Q of the whole batch: each state has its own.",
        "return (q_expert >= q.amax(-1)) * large_margin_loss(q, expert_action)":
            "You return the filtered loss. The filter itself is 1 where it lets the loss through, else 0.",
    },
)  # fmt: skip
def paper_q_filter(q, expert_action):
    q_expert = q.gather(-1, expert_action.unsqueeze(-1)).squeeze(-1)
    return (q_expert >= q.amax(-1)).to(q.dtype)


FEWER = (
    "You divide by the number of demonstrations. Here it is the mean over the whole batch, so that the loss fades with "
    "β."
)


def margin_cases(rng):
    """No demonstration, all demonstrations; then 41 at random. Experts lead by about 1, are level, behind.

    A third of the critics have a Q of about 60. The last batch has many rows.
    """
    for number in range(44):
        size = rng.integers(2, 9) if number < 43 else MANY_ROWS
        q_pair = torch.tensor(rng.normal(0, (1, 1, 60)[number % 3], (2, size, 9))).float()
        action = torch.tensor(rng.integers(0, 9, size))
        lead = torch.tensor(rng.choice([2.0, 1.05, 0.95, 0.4, 0.0, -1e-3, -0.02, -1.0], (2, size, 1))).float()
        best = q_pair.amax(-1, keepdim=True) + lead
        q_pair = q_pair.scatter(-1, action.expand(2, -1).unsqueeze(-1), best)
        yield q_pair, action, torch.tensor(rng.random(size) < (0.0, 1.1, 0.6)[min(number, 2)]).float()


@exercise(
    "the mean of J_E with the Q-filter (Equations 17 to 19), both critics",
    minutes=15, difficulty=3, cases=margin_cases, slopes=["q_pair"],
    worked=[
        # critic 1: the expert leads by 0.5, so 0.5 is missing; critic 2: it is behind, so the filter is off
        ((torch.tensor([[[1.5, 1.0], [5.0, 9.0]], [[1.0, 3.0], [5.0, 9.0]]]), torch.tensor([0, 0]),
          torch.tensor([1.0, 0.0])),
         torch.tensor(0.25)),
    ],
    hints=(
        "For one critic: the margin loss of each row, times the filter, times `is_demonstration`. Then the mean.",
        "`is_demonstration` has no gradient, and a comparison has none either: nothing needs to be detached.",
    ),
    mistakes={
        "* is_demonstration ->":
            "Your loss also counts the agent's own rows: there is no expert in them. Multiply by `is_demonstration`.",
        "(q_taken >= q.amax(-1)) * is_demonstration -> is_demonstration":
            "You left out the Q-filter: your loss also counts where the critic prefers another action.",
        "* keep).mean() -> * keep).sum() / is_demonstration.sum().clamp(min=1)": FEWER,
        "* keep).mean() -> * keep).sum() / is_demonstration.sum()": FEWER,
        "* keep).mean() -> * keep).sum() / keep.sum()":
            "You take the mean over the rows where the filter is on. Here it is the mean over the whole batch: the "
            "other rows count as 0.",
        "return total / 2":
            "Your loss is half of the right one: add the two critics' losses, as in the critics' squared errors, and "
            "do not take their mean.",
        "in q_pair -> in q_pair[:1]":
            "You train the first critic only. The second has a loss of its own: add it.",
        "(q_taken >= q.amax(-1)) -> paper_q_filter(q_pair[0], action)":
            "You switch both losses by the first critic's filter. Each critic's loss is switched by its own.",
        "in q_pair -> in q_pair.detach()":
            "Your loss has the right value but no gradient, so it cannot move Q: leave out `.detach()`, `.item()` and "
            "NumPy.",
        "in q_pair -> in q_pair.amin(0, keepdim=True)":
            "You take the smaller of the two critics first. Each critic has its own margin, and its own filter.",
    },
)  # fmt: skip
def margin_loss(q_pair, action, is_demonstration):
    total = 0.0
    for q in q_pair:
        q_taken = q.gather(-1, action.unsqueeze(-1)).squeeze(-1)
        margin = (torch.arange(q.shape[-1]) != action.unsqueeze(-1)).to(q.dtype)
        keep = (q_taken >= q.amax(-1)) * is_demonstration
        total = total + (((q + margin).amax(-1) - q_taken) * keep).mean()
    return total
