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
            "You took the mean over the batch. Return one number for each state.",
    },
)  # fmt: skip
def large_margin_loss(q, expert_action):
    is_expert = torch.arange(q.shape[-1]) == expert_action.unsqueeze(-1)
    q_expert = q.gather(-1, expert_action.unsqueeze(-1)).squeeze(-1)
    return (q + (~is_expert)).amax(-1) - q_expert
