"""Exercises of the lesson on SAC's update and loop, which are made of the losses of the lesson before."""

import numpy as np
import torch

from bootcourse.course.exercise import exercise
from bootcourse.course.lessons.discrete_sac import exercises as losses
from bootcourse.course.lessons.update_and_loop import by_hand, recorded, replay_buffer
from bootcourse.learn import sac

ReplayBuffer = replay_buffer.ReplayBuffer
soft_value, critic_target = losses.soft_value.solution, losses.critic_target.solution
critic_loss, actor_loss = losses.critic_loss.solution, losses.actor_loss.solution
temperature_loss, LOG_2, OF_NOTHING = losses.temperature_loss.solution, losses.LOG_2, losses.OF_NOTHING


def update_cases(rng):
    """One update and several, of a few agents, and in training's extremes: see `by_hand.after_updates`."""
    yield from (("drawn", times, seed) for times in (1, 2, 4) for seed in range(3))
    kinds = ("sure", "large", "huge", "one", "wide", "other", "cold")
    yield from ((kind, 1, seed) for kind in kinds for seed in range(2))


NETWORKS = ("the policy", "the critics", "the copies", "log α")


def of_the_update(cases, answers):
    """A sentence on an update that changes a network in another way."""
    for case, answer in zip(cases, answers, strict=True):
        right = by_hand.after_updates(update.solution, *case)
        pairs = zip(NETWORKS, (part.data for part in answer), right, strict=True)
        wrong = [name for name, mine, ours in pairs if not np.allclose(mine, ours, rtol=1e-4, atol=1e-6)]
        if "the critics" in wrong:
            wrong = [name for name in wrong if name != "the copies"]  # which follow the critics
        if wrong:
            after = "your first update" if case[1] == 1 else f"{case[1]} updates of yours"
            verb = "differs" if wrong in (["the policy"], ["log α"]) else "differ"
            return f"After {after} {' and '.join(wrong)} {verb} from ours: look there first."
    return "Your update differs from ours."


@exercise(
    "one update of SAC: target, three losses, three steps, copies; Section III-C",
    minutes=20, difficulty=3, cases=update_cases, run=by_hand.after_updates, explain=of_the_update,
    worked=[
        # all networks 0, y = 1: both biases rise by 0.1 · 2, the copies by τ of that; α H pulls log α down
        (("zeros", 1, 0), (np.full((1, 2), -LOG_2), np.array([[[0.2, 0]], [[0.2, 0]]]),
                           np.array([[[0.02, 0]], [[0.02, 0]]]), np.array([-LOG_2 * (1 + 0.1 * 0.5 * 0.7)]))),
    ],
    hints=(
        "First the target, inside `with torch.no_grad():`, from `agent.log_pi(batch.next_states)` and the smaller of "
        "`agent.slow_q(batch.next_states)`. Then the three losses, then the three steps, then the copies.",
        "A step is `optimiser.zero_grad()`, `loss.backward()`, `optimiser.step()`; `agent.optimisers` are those of the "
        "critics, the actor and log α. α itself is `agent.log_alpha.exp().detach()`. The copies' weights: inside "
        "`with torch.no_grad():`, for each pair of parameters `slow += agent.tau * (now - slow)`.",
    ),
    mistakes={
        "batch.terminated -> 0 * batch.terminated":
            "Your target counts a future after the pole has fallen: hand `batch.terminated` to your target.",
        "agent.slow_q -> agent.q":
            "Your target comes from the critics themselves. It comes from their slow copies, `agent.slow_q`.",
        "agent.slow_q(batch.next_states).amin(0) -> agent.slow_q(batch.next_states)[0]":
            "Your target uses one of the two copies. The smaller of their two values counts: `.amin(0)`.",
        "q_pair.amin(0) -> q_pair[0]":
            "Your actor follows the first critic alone. The smaller of the two values counts: `.amin(0)`.",
        "next_q, alpha -> next_q, 0 * alpha":
            "The value in your target has no entropy: hand α to your soft value.",
        "slow += agent.tau * (now - slow) -> slow = slow + agent.tau * (now - slow)":
            "Your copies stay where they began. Step 8 changes their weights in place, with `slow += ...` or "
            "`slow.copy_(...)`; `slow = ...` would only give the name to a new tensor.",
        "agent.tau * (now - slow) -> (1 - agent.tau) * (now - slow)":
            "Your copies take over nearly all of the new weights. Their share is τ, and 1 - τ of the old ones stays.",
        "optimiser.zero_grad() ->":
            "Your gradients add up from update to update: call `zero_grad()` before each `backward()`.",
        ("losses = ( -> first = critic_loss(q_pair, batch.actions, target); agent.optimisers[0].zero_grad(); "
         "first.backward(); agent.optimisers[0].step(); q_pair = agent.q(batch.states); losses = (0 * q_pair.sum() +",
         "agent.optimisers, losses -> agent.optimisers[1:], losses[1:]"):
            "Your actor learns from critics that have already made their step. That works, too, but the box asks for "
            "all three losses before the first step.",
        "soft_value(agent.log_pi(batch.next_states), -> soft_value(agent.log_pi(batch.next_states).exp().log(),":
            f"Your critics are no longer numbers after an update with a policy that is sure of an action: {OF_NOTHING}",
        "actor_loss(log_pi, -> actor_loss(log_pi.exp().log(),":
            f"Your policy is no longer a number after an update in which it was sure of an action: {OF_NOTHING}",
        ("actor_loss(log_pi, -> actor_loss(log_pi.exp().log(),",
         "sac.entropy(log_pi) -> sac.entropy(log_pi.exp().log())"):
            f"Your policy and α are no longer numbers after an update with a policy that is sure: {OF_NOTHING}",
    },
)  # fmt: skip
def update(agent, batch):
    alpha = agent.log_alpha.exp().detach()
    with torch.no_grad():
        next_q = agent.slow_q(batch.next_states).amin(0)
        next_value = soft_value(agent.log_pi(batch.next_states), next_q, alpha)
        target = critic_target(batch.rewards, batch.terminated, next_value, agent.gamma)
    log_pi, q_pair = agent.log_pi(batch.states), agent.q(batch.states)
    losses = (
        critic_loss(q_pair, batch.actions, target),
        actor_loss(log_pi, q_pair.amin(0), alpha),
        temperature_loss(agent.log_alpha, sac.entropy(log_pi), agent.target_entropy),
    )
    for optimiser, loss in zip(agent.optimisers, losses, strict=True):
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
    with torch.no_grad():
        for slow, now in zip(agent.copies.parameters(), agent.critics.parameters(), strict=True):
            slow += agent.tau * (now - slow)


def loop_cases(rng):
    """No end, falls, timeouts, both at once, an end in the last push; short and long; then 5 at random."""
    yield from ((5, (), ()), (6, (2,), ()), (6, (), (2,)), (300, (9, 40), (100,)), (420, (), (200, 399)))
    yield from ((6, (2,), (2,)), (6, (5,), ()), (258, (), (257,)), (700, (30, 31, 500), ()))
    for _ in range(5):
        ends = rng.permutation(250)[:6].tolist()
        yield int(rng.integers(255, 340)), tuple(ends[:3]), tuple(ends[3:])


def of_the_loop(cases, answers):
    """The sentence on a loop's first departure from the box."""
    return next(str(answer) for answer in answers if str(answer))


@exercise(
    "SAC's loop: decide, step, keep, update; Section III-C",
    minutes=12, difficulty=3, cases=loop_cases, run=recorded.departure, explain=of_the_loop,
    worked=[((2, (0,), ()), ""), ((300, (9,), (40,)), "")],  # no departure from the box
    hints=(
        "For each push: `agent.draw(state, rng)`, `env.step(action)`, `buffer.add(by_hand.row(...))`; then the next "
        "state is the state.",
        "After a fall *or* a timeout: `state, _ = env.reset()`. The row of a timeout has terminated = 0 all the same.",
    ),
    mistakes={
        "reward, terminated, next_state -> reward, terminated or truncated, next_state": recorded.OUT_OF_TIME,
        "state = next_state ->": recorded.STANDS_STILL,
        "if terminated or truncated -> if terminated": recorded.GOES_ON.format("timeout"),
        "if terminated or truncated -> if truncated": recorded.GOES_ON.format("fall"),
        "state, _ = env.reset() -> state, _ = env.reset(seed=0)": recorded.SAME_START,
        "state, _ = env.reset() -> env.reset()": recorded.OLD_STATE,
        "push >= 256 and ->": recorded.EARLY,
        "and push % 4 == 0 ->":
            "Your loop makes about four times as many updates as asked for: here it is one after each fourth push.",
        "(state, action, reward -> (next_state, action, reward": recorded.TURNED,
        "256, rng -> 1, rng": recorded.BAD_BATCH,
    },
)  # fmt: skip
def train(agent, env, buffer, update, pushes, rng):
    state, _ = env.reset(seed=0)
    for push in range(pushes):
        action = agent.draw(state, rng)
        next_state, reward, terminated, truncated, _ = env.step(action)
        buffer.add(by_hand.row(state, action, reward, terminated, next_state))
        state = next_state
        if terminated or truncated:
            state, _ = env.reset()
        if push >= 256 and push % 4 == 0:
            update(agent, by_hand.batch_of(buffer.sample(256, rng)))
