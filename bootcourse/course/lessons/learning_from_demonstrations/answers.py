"""Answers to the exercises of the lesson on learning from demonstrations."""

import torch

from bootcourse.learn.replay_buffer import REWARD
from tests.answers import equivalent, right, right_lines, wrong, wrong_lines

PLACES = "rng.integers(len(demonstrations), size=n)"
TORCH_PLACES = f"demonstrations[torch.from_numpy({PLACES})]"
equivalent("mixed_batch", f"{TORCH_PLACES}  ->  demonstrations[{PLACES}]", "either library's numbers index a tensor")
equivalent("large_margin_loss", "q.shape[-1]  ->  q.detach().shape[-1]", "only its shape")


@right("mixed_batch")
def with_choice(own, demonstrations, size, beta, bonus, rng):
    n = int(round(beta * size))
    theirs = demonstrations[rng.choice(len(demonstrations), n)].clone()
    theirs[:, REWARD] = theirs[:, REWARD] + bonus
    marks = torch.cat([torch.ones(n), torch.zeros(size - n)])
    return torch.cat([theirs, own.sample(size - n, rng)]), marks


right_lines("""mixed_batch
    own rows first: marks = torch.zeros(size)
        rows = own.sample(size, rng).clone()
        for i in range(size - round(beta * size), size):
            rows[i] = demonstrations[int(rng.integers(len(demonstrations)))]
            rows[i, REWARD] += bonus
            marks[i] = 1
        rows, marks
""")


def drawn(own, demonstrations, size, bonus, rng, places):
    """A batch with the demonstrations at these places."""
    theirs = demonstrations[places].clone()
    theirs[:, REWARD] += bonus
    rows = torch.cat([theirs, own.sample(size - len(places), rng)])
    return rows, (torch.arange(size) < len(places)).float()


right_lines("""mixed_batch
    sorted draws: places = np.sort(rng.integers(len(demonstrations), size=round(beta * size)))
        drawn(own, demonstrations, size, bonus, rng, places)
    one by one: m = len(demonstrations)
        drawn(own, demonstrations, size, bonus, rng, [int(m * rng.random()) for _ in range(round(beta * size))])
    shuffled: rows, marks = with_choice(own, demonstrations, size, beta, bonus, rng); order = rng.permutation(size)
        rows[order], marks[order].bool()
""")


@wrong("mixed_batch", "changes its argument `demonstrations`")
def paid_in_the_table(own, demonstrations, size, beta, bonus, rng):
    demonstrations[:, REWARD] += bonus  # again at each call
    return with_choice(own, demonstrations, size, beta, 0.0, rng)


wrong_lines("""mixed_batch
    bonus of the course: with_choice(own, demonstrations, size, beta, 2.0, rng)
    a generator of its own: with_choice(own, demonstrations, size, beta, bonus, np.random.default_rng(0))  # anew
    the bonus as a mark: rows, marks = with_choice(own, demonstrations, size, beta, bonus, rng)
        rows, bonus * marks  # else 0
    in double precision: rows, marks = with_choice(own, demonstrations, size, beta, bonus, rng)
        rows.double(), marks  # in float64
    without rng: with_choice(own, demonstrations, size, beta, bonus, np.random.default_rng())
    one demonstration for all: rows, marks = with_choice(own, demonstrations, size, beta, bonus, rng)
        n = int(marks.sum())
        rows[:n] = rows[: min(n, 1)]
        rows, marks  # depend on each other
    one draw for a batch: drawn(own, demonstrations, size, bonus, rng, rng.integers(len(demonstrations), size=1)
        .repeat(round(beta * size)))  # depend on each other
    without replacement: n = round(beta * size); places = rng.choice(len(demonstrations), n, replace=False)
        drawn(own, demonstrations, size, bonus, rng, places)  # a row may come twice
    in steps: n = round(beta * size); first, step = rng.integers(len(demonstrations), size=2)
        drawn(own, demonstrations, size, bonus, rng, (first + step * np.arange(n)) % len(demonstrations))  # depend
    each row twice: n = round(beta * size); places = rng.integers(len(demonstrations), size=n)
        drawn(own, demonstrations, size, bonus, rng, np.repeat(places, 2)[:n])  # depend on each other
    with neighbours: n = round(beta * size); places = np.repeat(rng.integers(len(demonstrations), size=n), 2)[:n]
        drawn(own, demonstrations, size, bonus, rng, (places + np.arange(n) % 2) % len(demonstrations))  # depend
    bonus for gains: rows, marks = with_choice(own, demonstrations, size, beta, 0.0, rng)
        rows[:, REWARD] += bonus * marks * (rows[:, REWARD] >= 0)
        rows, marks  # also where its reward is 0 or negative
    a capped reward: rows, marks = with_choice(own, demonstrations, size, beta, bonus, rng)
        rows[:, REWARD] = rows[:, REWARD].clamp(max=10)
        rows, marks  # depends on the reward
    bonus in two columns: rows, marks = with_choice(own, demonstrations, size, beta, bonus, rng)
        rows[:, REWARD + 1] += bonus * marks
        rows, marks  # the other columns stay
    one own row for all: n = round(beta * size)
        rows, marks = drawn(own, demonstrations, n, bonus, rng, rng.integers(len(demonstrations), size=n))
        own_rows = own.sample(1, rng).expand(size - n, -1)
        torch.cat([rows, own_rows]), torch.cat([marks, torch.zeros(size - n)])  # one row again and again
    the last demonstration left out: with_choice(own, demonstrations[:-1], size, beta, bonus, rng)
        # more often than others
    a coin for each row: marks = torch.from_numpy(rng.random(size) < beta)
        n = int(marks.sum())
        theirs = demonstrations[rng.integers(len(demonstrations), size=n)]
        theirs[:, REWARD] += bonus
        rows = torch.empty(size, theirs.shape[1])
        rows[marks], rows[~marks] = theirs, own.sample(size - n, rng)
        rows, marks.float()
""")


@wrong("mixed_batch", "the rows and their marks")
def without_marks(*arguments):
    return with_choice(*arguments)[0]


def of_expert(q, expert_action):
    return q[torch.arange(len(q)), expert_action]


@right("large_margin_loss")
def with_one_hot(q, expert_action):
    margin = 1 - torch.nn.functional.one_hot(expert_action, q.shape[-1])
    return (q + margin).max(dim=-1).values - of_expert(q, expert_action)


right_lines("""large_margin_loss
    rivals and relu: rivals = q.scatter(-1, expert_action[:, None], float("-inf")).amax(-1)
        torch.relu(rivals + 1 - of_expert(q, expert_action))
""")

wrong_lines("""large_margin_loss
    cross entropy: torch.nn.functional.cross_entropy(q, expert_action, reduction="none")
    clamped: solution(q, expert_action).clamp(max=50)
    a softer maximum: margin = 1 - torch.nn.functional.one_hot(expert_action, q.shape[-1])
        torch.logsumexp(50 * (q + margin), -1) / 50 - of_expert(q, expert_action)
""")
