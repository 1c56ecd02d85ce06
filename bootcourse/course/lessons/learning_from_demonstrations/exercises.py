"""Exercises of the lesson on learning from demonstrations."""

import torch

from bootcourse.course.exercise import Exercise, Mistake
from bootcourse.course.lessons.learning_from_demonstrations import batches
from bootcourse.learn import bootstrap

mixed_batch = batches.mixed_batch


def q_cases(rng):
    """Expert far ahead, ahead by less than the margin, behind, level; in float32, too; then 40 at random."""
    q = torch.zeros(4, 9).double()
    q[0, 2], q[1, 2], q[2, 2] = 3.0, 0.4, -1.0
    yield q, torch.full((4,), 2)
    yield q.float(), torch.full((4,), 2)
    level = torch.zeros(3, 9)
    level[:, [1, 5]] = torch.tensor([[2.0, 2.0], [2.0, 2.0 - 1e-3], [2.0 - 1e-3, 2.0]])
    yield level, torch.full((3,), 5)
    yield torch.tensor([[0.3, -0.2, 0.1]]), torch.tensor([1])
    yield torch.tensor([[-5.0, -7.0, -6.0], [-5.0, -7.0, -6.0]]), torch.tensor([0, 1])
    for _ in range(40):
        size = rng.integers(1, 6)
        yield torch.tensor(rng.normal(0, 1, (size, 9))), torch.tensor(rng.integers(0, 9, size))


def taken(q, expert_action):
    return q.gather(-1, expert_action.unsqueeze(-1)).squeeze(-1)


def others(q, expert_action):
    """q, with -∞ for the expert's action."""
    return q.scatter(-1, expert_action.unsqueeze(-1), -torch.inf)


large_margin_loss = Exercise(
    "large_margin_loss(q, expert_action)", solution=bootstrap.large_margin_loss, cases=q_cases, slopes=("q",),
    worked=(
        # the expert leads by 0.5: the loss is 0.5. It is behind by 2: 3. It leads by 2: 0.
        ((torch.tensor([[1.5, 1.0], [1.0, 3.0], [3.0, 1.0]]), torch.tensor([0, 0, 0])), torch.tensor([0.5, 3.0, 0.0])),
    ),
    mistakes=(
        Mistake(lambda q, expert: (q + 1).amax(-1) - taken(q, expert),
            "Your loss is at least 1: the expert's own action gets no margin, l(a_E, a_E) = 0.",
            "The margin is a constant in the formula."),
        Mistake(lambda q, expert: q.amax(-1) - taken(q, expert),
            "You have no margin: your loss is 0 as soon as the expert's Q equals the largest.",
            "It is enough that the expert's action is greedy. (A little noise can undo that.)"),
        Mistake(lambda q, expert: others(q, expert).amax(-1) + 1 - taken(q, expert),
            "Your loss goes below 0 where the expert leads by more than the margin: the maximum runs over *all* "
            "actions, the expert's included.",
            "The maximum is over the other actions."),
        Mistake(lambda q, expert: -bootstrap.large_margin_loss(q, expert),
            "Your sign is wrong: the loss grows with the expert's lead, so training would reduce the lead.",
            "The expert's value comes first, since it is the one that should be large."),
        Mistake(lambda q, expert: (q + 1 - torch.nn.functional.one_hot(expert, q.shape[-1])).sum(-1) - taken(q, expert),
            "You add up the actions. Only the largest counts: take the maximum.",
            "All wrong actions should be punished."),
        Mistake(lambda q, expert: bootstrap.large_margin_loss(q.detach(), expert),
            "Your loss has the right value but no gradient, so it cannot move Q: leave out `.detach()`, `.item()` and "
            "NumPy.",
            "A loss is a number that is only measured."),
        Mistake(lambda q, expert: bootstrap.large_margin_loss(q, expert).mean(),
            "You took the mean over the batch. Return one number for each state: the Q-filter comes next.",
            "A loss is a scalar."),
    ),
    hints=(
        "Add 1 to every action's Q but the expert's. By how much does the best of these exceed the expert's own Q?",
        "`torch.arange(q.shape[-1]) == expert_action.unsqueeze(-1)` is True in the expert's column.",
        "`(q + (~is_expert)).amax(-1) - q.gather(-1, expert_action.unsqueeze(-1)).squeeze(-1)`",
    ),
    minutes=8, difficulty=2, equation="J_E(Q) = max_a [Q(s,a) + l(a_E,a)] - Q(s,a_E), Section IV-B",
)  # fmt: skip

paper_q_filter = Exercise(
    "paper_q_filter(q, expert_action)", solution=bootstrap.paper_q_filter, cases=q_cases,
    worked=(
        # ahead, behind, and level with the best
        ((torch.tensor([[1.5, 1.0], [1.0, 3.0], [2.0, 2.0]]), torch.tensor([0, 0, 0])), torch.tensor([1.0, 0.0, 1.0])),
    ),
    mistakes=(
        Mistake(lambda q, expert: (taken(q, expert) > others(q, expert).amax(-1)).double(),
            "Your filter is off where the expert's Q equals the largest. The formula says ≥.",
            "At least as good means better."),
        Mistake(lambda q, expert: (q.argmax(-1) == expert).double(),
            "Where two actions share the largest Q, `argmax` names the first of them, and your filter is off although "
            "≥ holds: compare the values, not the actions' numbers.",
            "The greedy action is unique."),
        Mistake(lambda q, expert: (taken(q, expert) < q.amax(-1)).double(),
            "Your filter is on where the printed one is off. That would make more sense, but this exercise asks for "
            "the printed one.",
            "A loss is needed where the expert is *not* greedy yet."),
        Mistake(lambda q, expert: (taken(q, expert) >= q.mean(-1)).double(),
            "You compare with the mean of Q. The printed filter compares with the *largest* Q.",
            "The expert is compared with the state's value, which is an average."),
        Mistake(lambda q, expert: (taken(q, expert) >= q.max()).double(),
            "You compare with the largest Q of the whole batch: each state has its own.",
            "`q.max()` works along the rows."),
        Mistake(lambda q, expert: (taken(q, expert) >= q.amax(-1)).double() * bootstrap.large_margin_loss(q, expert),
            "You return the filtered loss. The filter itself is 1 where it lets the loss through, else 0.",
            "The equation is about the filtered loss."),
    ),
    hints=(
        "Compare two numbers of each state: the expert's Q and the largest one.",
        "`q.gather(-1, expert_action.unsqueeze(-1)).squeeze(-1)` is the first, `q.amax(-1)` the second.",
        "`(q_expert >= q.amax(-1)).to(q.dtype)`",
    ),
    minutes=3, difficulty=1, equation="J_E^Q: on where Q(s,a_E) ≥ max_a Q(s,a), as printed in Section IV-B",
)  # fmt: skip


def filter_cases(rng):
    """An expert a little above and below π's value, above the mean but below π's value, the opposite; in both dtypes.

    First, exactly equal: all Q are 1, with probabilities that add up to 1 without rounding. Last, 40 at random.
    """
    yield torch.ones(1, 2).double(), torch.tensor([0]), torch.full((1, 2), 0.5).double().log()
    even = torch.full((2, 3), 1 / 3).log()
    greedy = torch.tensor([[0.02, 0.08, 0.9]]).log()
    for dtype in (torch.float32, torch.float64):
        yield torch.tensor([[1.0, 1.01, 1.0], [1.0, 0.99, 1.0]], dtype=dtype), torch.tensor([1, 1]), even.to(dtype)
        yield torch.tensor([[1.0, 5.0, 6.0]], dtype=dtype), torch.tensor([1]), greedy.to(dtype)
        yield torch.tensor([[9.0, 5.0, 1.0]], dtype=dtype), torch.tensor([1]), greedy.to(dtype)
        yield torch.tensor([[-3.0, -1.0, -2.0]], dtype=dtype), torch.tensor([1]), greedy.to(dtype)
    for _ in range(40):
        size = rng.integers(1, 6)
        log_pi = torch.tensor(rng.normal(0, 2, (size, 9))).log_softmax(-1)
        yield torch.tensor(rng.normal(0, 1, (size, 9))), torch.tensor(rng.integers(0, 9, size)), log_pi


q_filter = Exercise(
    "q_filter(q, expert_action, log_pi)", solution=bootstrap.q_filter, cases=filter_cases,
    worked=(
        # π is worth 0.25 · 1 + 0.75 · 3 = 2.5, the expert's action 1; π is worth 1.5, the expert's action 3
        ((torch.tensor([[1.0, 3.0], [1.0, 3.0]]), torch.tensor([0, 1]),
          torch.tensor([[0.25, 0.75], [0.75, 0.25]]).log()),
         torch.tensor([0.0, 1.0])),
    ),
    mistakes=(
        Mistake(lambda q, expert, log_pi: bootstrap.paper_q_filter(q, expert),
            "This is the printed filter again: it compares with the largest Q, not with the mean of Q under π.",
            "Both filters ask whether the expert is at least as good."),
        Mistake(lambda q, expert, log_pi: (taken(q, expert) >= (log_pi.exp() * q).sum(-1)).double(),
            "Your filter is on where the expert is exactly as good as the policy, for instance where all Q are equal. "
            "The condition is >.",
            "At least as good means better."),
        Mistake(lambda q, expert, log_pi: (taken(q, expert) > q.mean(-1)).double(),
            "You give all actions the same weight. The policy's value is the mean of Q under *its* probabilities.",
            "The value of a state is the mean of its Q."),
        Mistake(lambda q, expert, log_pi: (taken(q, expert) < (log_pi.exp() * q).sum(-1)).double(),
            "Your filter is on where the policy is already better than the expert. It has to be on where the expert is "
            "better.",
            "The filter removes the demonstrations that are good."),
        Mistake(lambda q, expert, log_pi: (taken(q, expert) > taken(q, log_pi.argmax(-1))).double(),
            "You compare with the likeliest action's Q. The policy draws its action: take the mean under π.",
            "The policy takes its most probable action."),
        Mistake(lambda q, expert, log_pi: (taken(q, expert) > (log_pi * q).sum(-1)).double(),
            "You weigh Q with log π. The probabilities are `log_pi.exp()`.",
            "`log_pi` holds probabilities."),
    ),
    hints=(
        "What is the policy's own value in this state?",
        "The sum over actions of π Q. The filter is on where the expert's Q is above it.",
        "`(q_expert > (log_pi.exp() * q).sum(-1)).to(q.dtype)`",
    ),
    minutes=5, difficulty=2, equation="on where Q(s,a_E) > Σ_a π(a|s) Q(s,a); Nair et al., arXiv 1709.10089",
)  # fmt: skip


def margin_loss_solution(q_pair, action, is_demonstration):
    total = 0.0
    for q in q_pair:
        q_taken = q.gather(-1, action.unsqueeze(-1)).squeeze(-1)
        margin = (torch.arange(q.shape[-1]) != action.unsqueeze(-1)).to(q.dtype)
        keep = (q_taken >= q.amax(-1)) * is_demonstration
        total = total + (((q + margin).amax(-1) - q_taken) * keep).mean()
    return total


def margin_cases(rng):
    """No demonstration, all demonstrations, float32; then 40 at random. Experts lead by about 1, are level, behind."""
    for number in range(43):
        size = rng.integers(2, 9)
        q_pair, action = torch.tensor(rng.normal(0, 1, (2, size, 9))), torch.tensor(rng.integers(0, 9, size))
        lead = torch.tensor(rng.choice([2.0, 1.05, 0.95, 0.4, 0.0, -0.02, -1.0], (2, size, 1)))
        best = q_pair.amax(-1, keepdim=True) + lead
        q_pair = q_pair.scatter(-1, action.expand(2, -1).unsqueeze(-1), best)
        theirs = torch.tensor(rng.random(size) < (0.0, 1.1, 0.6)[min(number, 2)]).to(q_pair.dtype)
        yield (q_pair.float(), action, theirs.float()) if number == 2 else (q_pair, action, theirs)


def margins(q_pair, action, filtered=True):
    """The (filtered) margin losses of both critics, one by one: (2, batch)."""
    each = torch.stack([bootstrap.large_margin_loss(q, action) for q in q_pair])
    return each * torch.stack([bootstrap.paper_q_filter(q, action) for q in q_pair]) if filtered else each


margin_loss = Exercise(
    "margin_loss(q_pair, action, is_demonstration)",
    solution=margin_loss_solution, cases=margin_cases, slopes=("q_pair",),
    worked=(
        # critic 1: the expert leads by 0.5, so 0.5 is missing; critic 2: it is behind, so the filter is off
        ((torch.tensor([[[1.5, 1.0], [5.0, 9.0]], [[1.0, 3.0], [5.0, 9.0]]]), torch.tensor([0, 0]),
          torch.tensor([1.0, 0.0])),
         torch.tensor(0.25)),
    ),
    mistakes=(
        Mistake(lambda q_pair, action, theirs: margins(q_pair, action).mean(-1).sum(),
            "Your loss also counts the agent's own rows: there is no expert in them. Multiply by `is_demonstration`.",
            "Every action in the buffer is an expert's."),
        Mistake(lambda q_pair, action, theirs: (margins(q_pair, action, False) * theirs).mean(-1).sum(),
            "You left out the Q-filter: your loss also counts where the critic prefers another action.",
            "The filter is an option."),
        Mistake(lambda q_pair, action, theirs: (margins(q_pair, action) * theirs).sum() / theirs.sum().clamp(min=1),
            "You divide by the number of demonstrations. Here it is the mean over the whole batch, so that the loss "
            "fades with β.",
            "A mean is over what counts."),
        Mistake(lambda q_pair, action, theirs: (margins(q_pair, action) * theirs).mean(),
            "You took the mean over the two critics, too: add their losses, as in the critics' squared errors.",
            "`.mean()` does everything at once."),
        Mistake(lambda q_pair, action, theirs: (margins(q_pair, action)[0] * theirs).mean(),
            "You train the first critic only. The second has a loss of its own: add it.",
            "The second critic is a copy."),
        Mistake(lambda q_pair, action, theirs:
            (margins(q_pair, action, False) * bootstrap.paper_q_filter(q_pair[0], action) * theirs).mean(-1).sum(),
            "You switch both losses by the first critic's filter. Each critic's loss is switched by its own.",
            "A filter belongs to the state."),
        Mistake(lambda q_pair, action, theirs: (margins(q_pair.detach(), action) * theirs).mean(-1).sum(),
            "Your loss has the right value but no gradient, so it cannot move Q: leave out `.detach()`, `.item()` and "
            "NumPy.",
            "Detaching is always safe. (The filter needs no gradient, and has none.)"),
        Mistake(lambda q_pair, action, theirs: (margins(q_pair.amin(0, keepdim=True), action) * theirs).mean(-1).sum(),
            "You take the smaller of the two critics first. Each critic has its own margin, and its own filter.",
            "Twin critics act as one, their minimum."),
    ),
    hints=(
        "For one critic: the margin loss of each row, times the filter, times `is_demonstration`. Then the mean.",
        "`is_demonstration` has no gradient, and a comparison has none either: nothing needs to be detached.",
        "`for q in q_pair: total = total + (loss * (q_taken >= q.amax(-1)) * is_demonstration).mean()`",
    ),
    minutes=15, difficulty=3, equation="the mean of J_E with the Q-filter (Equations 17 to 19), both critics",
)  # fmt: skip
