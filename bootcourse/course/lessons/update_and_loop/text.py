# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # The update and the loop
#
# **What you will be able to do**
# - write how a batch is drawn, an update of SAC and the loop around it, and train your own agent;
# - say why a fall counts as terminated, and the end of the time does not;
# - recognise a critic that diverges, and say what three seeds can show.
#
# **Time** 56 minutes; the machine computes for about one of them. **It builds on** lesson
# [[discrete_sac]] and its losses.

# %%
import bootcourse as bc
import numpy as np
import torch
from bootcourse.course import (
    check,
    compare_predictions,
    own_code,
    predict,
    predicted,
    progress,
)
from bootcourse.course.lessons.update_and_loop import by_hand, explorable, figures, left_out
from bootcourse.learn import sac
from bootcourse.research.experiments import checks

progress("update_and_loop")

# %% [markdown]
# ## Look first
#
# The pole of lesson [[discrete_sac]]: each push pays 1, and an episode ends after a fall or after
# 500 pushes. Above, an agent that has learned nothing yet takes its most probable pushes; below,
# that lesson's rule drives.

# %%
beginner = by_hand.SAC(seed=0)
bc.show(figures.before_training(beginner))
entropy = sac.entropy(beginner.log_pi(torch.zeros(1, 4))).item()  # the pole stands upright
print(f"Its policy is almost even: {entropy:.3f} of at most {np.log(2):.3f} nats of entropy")

# %% [markdown]
# > **Predict.** Your learner trains until it has solved the pole, and is tested every 2,000 pushes on
# > the same ten starts. Does each test last at least as long as the one before?

# %%
choices = [
    "yes, each",
    "it gets better, but with setbacks",
    "it stays below 100, and then jumps at once",
]
predict("update_and_loop.1", "Does each test last at least as long as the one before?", choices)

# %% [markdown]
# ## Round 1: where does a batch come from?
#
# SAC keeps its transitions in a table, the **replay buffer**. Each update learns from a **batch**,
# rows that are drawn **uniformly with replacement**: at each draw each row has the same chance.
# A batch of neighbours, which resemble each other, would say the same thing many times. Most rows
# come from earlier policies: SAC learns **off-policy**, as Q-learning does (lesson [[values]]). That
# is allowed: a row says what the *world* did, whoever acted, and the target asks what the *present*
# policy would do in s'.
#
# **Exercise (4 min, ●○○).** The buffer below keeps the last `size` rows; a row is a tensor. When it
# is full, each new row replaces the oldest one. Write `sample`, which draws rows with the generator
# `rng`. Training calls it thousands of times: do not copy the whole table.


# %%
class ReplayBuffer:
    """The last `size` rows."""

    def __init__(self, size):
        """size: the most rows that it holds."""
        self.size, self.rows, self.next = size, [], 0

    def add(self, row):
        """Keep a row, a tensor (n,). A full buffer forgets its oldest row."""
        if len(self.rows) < self.size:
            self.rows.append(row)
        else:
            self.rows[self.next] = row
        self.next = (self.next + 1) % self.size

    def sample(self, batch, rng):
        """Rows drawn at random: (batch, n). rng: a NumPy generator."""
        # solution: the exercise's own


check.ReplayBuffer(ReplayBuffer)

# %% [markdown] tags=["instructor"] minutes=3
# To stack the whole list at each draw gives the right rows and makes the training slow: the check
# says so. Ask what `add` would have to do if it kept the rows in the order of their age.

# %% [markdown]
# ## Round 2: the whole algorithm
#
# A row says whether the *world* ended there, as when the pole fell: *terminated*. When only the
# time is up, the pole still stands and rewards would go on, so the row says no. **Drag** γ. What
# does a critic expect of the last push before a fall if the row marks it as terminated, and if not?

# %%
explorable.the_end()

# %% [markdown]
# > **Soft actor-critic for a list of actions** (after each dash: the function that does it)
# >
# > *Start* with a policy π, two critics Q₁, Q₂, slow copies Q̄₁, Q̄₂, α, and an empty buffer.
# >
# > *At each decision:*
# >
# > 1. **Act.** Draw a from π(·|s), observe r, s' and whether the episode terminated; keep the row
# >    (s, a, r, terminated, s'). — `train`, `add`
# >
# > *At each update:*
# >
# > 2. **Batch.** Draw rows, uniformly with replacement. — `sample`
# > 3. **Target.** V(s') = Σₐ π(a|s') (minₖ Q̄ₖ(s', a) − α log π(a|s')), and
# >    y = r + γ (1 − terminated) V(s'), held fixed. — `soft_value(log_pi, q, alpha)`,
# >    `critic_target(reward, terminated, next_value, gamma)`
# > 4. **Critics.** L = mean (Q₁(s, a) − y)² + mean (Q₂(s, a) − y)².
# >    — `critic_loss(q_pair, action, target)`
# > 5. **Actor.** L = −mean Σₐ π(a|s) (minₖ Qₖ(s, a) − α log π(a|s)), with Q and α held fixed.
# >    — `actor_loss(log_pi, q, alpha)`
# > 6. **Temperature.** L = α (mean H(π(·|s)) − η), with H held fixed.
# >    — `temperature_loss(log_alpha, state_entropy, target_entropy)`
# > 7. **Steps.** Compute the three losses, then make a gradient step for each.
# > 8. **Copies.** Q̄ₖ becomes Q̄ₖ + τ (Qₖ − Q̄ₖ), weight by weight.
#
# The five functions of steps 3 to 6 are those of lesson [[discrete_sac]]: yours, as far as they
# passed there. In them `q` is the smaller of both critics, (batch, 2), and `q_pair` holds both, (2,
# batch, 2), as `agent.q(states)` gives them.
#
# `by_hand.SAC()` is one agent for the pole. It holds:
#
# | name | what it is |
# |---|---|
# | `log_pi(states)` | log π, (batch, 2) |
# | `q(states)`, `slow_q(states)` | Q and Q̄ of both critics, (2, batch, 2) |
# | `log_alpha`, `gamma`, `tau`, `target_entropy` | log α (first α = {{
# by_hand.SAC().log_alpha.exp().item() | .2g }}), γ, τ and η |
# | `optimisers` | three: of the critics, the actor and log α |
# | `critics.parameters()`, `copies.parameters()` | the weights of step 8, to be changed in place |

# %%
own_code.load()
soft_value, critic_target, critic_loss, actor_loss, temperature_loss = own_code.yours_or_ours(
    "soft_value", "critic_target", "critic_loss", "actor_loss", "temperature_loss"
)

# %% [markdown]
# **Exercise (20 min, ●●●).** Write steps 3 to 8, with these functions and `sac.entropy(log_pi)`.
# You can check early: the message names networks that still differ from ours.


# %%
def update(agent, batch):
    """One update; returns nothing. agent: a by_hand.SAC; batch: a by_hand.Batch of n rows, with
    states, next_states (n, 4), actions, rewards, terminated (n,)."""
    # solution: the exercise's own


check.update(update)

# %% [markdown]
# **Exercise (12 min, ●●●).** Write the loop around it: steps 1 and 2, and the call of `update`.
#
# - `env` is gymnasium's: `state, info = env.reset()`, and
#   `next_state, reward, terminated, truncated, info = env.step(action)`. *Truncated* says that the
#   time is up. Reset after either.
# - `agent.draw(state, rng)` draws an action, `by_hand.row(s, a, r, terminated, s')` makes a row.
# - `by_hand.batch_of(buffer.sample(256, rng))` is a batch for `update`.
# - A call begins with a reset, and makes no update in its first 256 pushes, whatever the buffer
#   holds; from then on one after every fourth push.


# %%
def train(agent, env, buffer, update, pushes, rng):
    """Train the agent for that many pushes; returns nothing. update(agent, batch); rng: NumPy's."""
    # solution: the exercise's own


check.train(train)

# %% [markdown]
# Now your agent learns, with your parts where they have passed. Gymnasium's mark for a *solved* pole
# is a mean of {{ gym.spec('CartPole-v1').reward_threshold | .0f }} of at most {{
# gym.spec('CartPole-v1').max_episode_steps }} pushes. Training stops when two tests in a row reach
# it. A test is ten episodes, by the most probable push.

# %%
predicted("update_and_loop.1")
SEED, BLOCK = 0, 2_000  # another seed is another agent
loop, step, buffer = own_code.yours_or_ours("train", "update", "ReplayBuffer")
agent, kept, rng = by_hand.SAC(SEED), buffer(50_000), np.random.default_rng(SEED)
env, tests = checks.cartpole(), [by_hand.balanced(agent)]
while min(tests[-2:]) < 475 and len(tests) <= 30:
    loop(agent, env, kept, step, BLOCK, rng)
    tests.append(by_hand.balanced(agent))
bc.show(figures.tests_in_training(tests, BLOCK))
print(f"Then it balances for {by_hand.balanced(agent, 100):.0f} pushes, a mean of 100 episodes.")

# %% [markdown]
# **See.** A network that changes for one state changes for others, too, so an update can make a policy
# worse. Train again with `SEED = 1`: one agent is one sample.
#
# Do your parts make the library's update?

# %%
own_code.compare()

# %% [markdown] tags=["instructor"] minutes=5
# Let those who have finished exchange their `update` with a neighbour and find the lines in which
# they differ. "Why is `terminated` in the row and `truncated` not?" is the question to ask before
# anybody runs the loop.

# %% [markdown]
# ## Round 3: what can be left out?
#
# Five kinds of agents, three seeds each, in smaller trainings than yours. The first is whole. The
# others leave out one part: the entropy (α = 0), the second critic, the slow copies (the target
# comes from the critics themselves), or the factor (1 − terminated).
#
# > **Predict.** Without which of the four do the agents balance the pole worst, on average?

# %%
predict("update_and_loop.2", "Without which part is the mean lowest?", list(left_out.KINDS[1:]))

# %%
predicted("update_and_loop.2")
scores = left_out.scores(seeds=3, pushes=2_500)
bc.show(figures.without_a_part(scores))

# %% [markdown]
# **Explain.** Here each agent without (1 − terminated) is below all others: by luck some kind would
# take the three lowest places once in {{ math.comb(15, 3) // 5 }} times. The other kinds overlap:
# they show neither that those parts help nor that they are useless (lesson [[how_many_seeds]]).

# %% [markdown] tags=["instructor"] minutes=4
# Let groups predict the whole order, not only the first place. A belief to name: "the second critic
# is the trick that makes it work". On the pole three seeds do not show that.

# %% [markdown]
# ## Round 4: why does the pole fall at once?
#
# Those agents balance for about as few pushes as the untrained one: have they learned nothing, or to
# let the pole fall? With your parts two agents learn from rows in which no fall is marked, and two
# from marked ones (α stays as it began, τ is 0.15). Each is tested also with *drawn* pushes.

# %%
unmarked, marked = (left_out.learn(loop, step, buffer, ends=ends) for ends in (False, True))
critics, controls = {"no fall is marked": unmarked}, {"each fall is marked": marked}
figures.until_the_fall(critics | controls)

# %% [markdown]
# **See.** With drawn pushes, agents without marks fall sooner than untrained: they are now sure of
# wrong pushes, and an actor learns from its critics alone. All their rows say "1 now, and then the
# value of the next state": entropy apart, one constant fits all,
# Q = 1 / (1 − γ) = {{ 1 / (1 - 0.99) | .0f }}.
#
# > **Predict.** What do their critics expect of a fallen pole, compared with a standing one?

# %%
fallen = ["less", "about the same", "more"]
predict("update_and_loop.3", "Of a fallen pole, compared with a standing one, they expect", fallen)

# %%
predicted("update_and_loop.3")
bc.show(figures.along_falls(controls | critics))

# %% [markdown]
# **See.** Where falls are marked, these critics expect less towards the fall, like the curve that you
# dragged.
#
# A fallen state is in the buffer as s' only, never as s. Its value enters targets, but no row
# corrects it: the network makes it up. If that is a cause, rows that start there should help. So at
# each fall two more go into the buffer, one for each push: from the fallen state back to it, paying
# 1, so the right Q is 100, too. Control agents get as many of the upright state. Do they balance?

# %%
more = {"and rows of fallen states": "fallen", "and rows of the upright state": "upright"}
critics |= {words: left_out.learn(loop, step, buffer, also) for words, also in more.items()}
bc.show(figures.estimates(critics))
figures.in_the_end(controls | critics)

# %% [markdown]
# **Explain.** Without rows of fallen states the estimates pass {{ 1 / (1 - 0.99) | .0f }} and still
# rise when the run ends: as far as we look, the critic **diverges**. Rows of the upright state do
# not help: here, with τ = 0.15, the missing rows are a cause. But rows of fallen states say that a
# fall pays on, and the pole falls, too. One kind balances: its rows say where the rewards end.
#
# A network, estimates learned from estimates, and rows of older policies: with these three, the
# *deadly triad* of Sutton and Barto, a critic *can* diverge, and need not. Your agent above has all
# three.

# %% [markdown] tags=["instructor"] minutes=3
# The copies of these agents follow faster than yours (τ = 0.15 in place of 0.1), to save
# time. If somebody asks where the estimates with rows of fallen states end: `left_out.learn(loop,
# step, buffer, "fallen", pushes=30_000, tau=0.1)` comes near 100. With `tau=0.5` they diverge, too.

# %%
worst = left_out.KINDS[1 + scores[1:].mean(1).argmin()]
course = choices[2 if max(tests[:-2]) < 100 else int(min(np.diff(tests)) < 0)]
expected = left_out.along_falls(unmarked.agents).mean(0)
compared = fallen[int(np.digitize(expected[-1] / expected[0], [0.9, 1.1]))]
compare_predictions("update_and_loop", {1: course, 2: worst, 3: compared})

# %% [markdown]
# ## What you now know
#
# 1. The buffer gives rows of earlier policies: SAC learns off-policy.
# 2. An update makes one step for the critics, the actor and the temperature. Then the critics'
#    copies follow a little.
# 3. `terminated` tells the critic where the rewards end. A time limit is no such end.
# 4. Without (1 − terminated) the targets read values of fallen states, which no row corrects. The
#    agents let the pole fall, and no error said so. Look at Q while an agent learns: above (r + α
#    log 2) / (1 − γ), with the largest r, it cannot be right.
# 5. Three agents, trained so briefly, do not show that a part is useless.

# %% [markdown]
# **Three questions to think about**
# - In training the learner draws its actions from its policy; in the test it takes the most
#   probable one. Where could that matter?
# - A buffer of 50,000 rows keeps all that this agent did. What would a buffer of 500 rows change?
# - The loop makes one update after every fourth push. What could four updates after each push do?
#
# **Read on**: Mnih et al., *Human-level control through deep reinforcement learning* (Nature,
# 2015), on buffers and slow copies; Sutton and Barto, *Reinforcement Learning*, chapter 11,
# on what can diverge. The same algorithm for the road: `python -m bootcourse.learn.textbook`.

# %% [markdown] tags=["instructor"] minutes=5
# *Answers to the three questions.* **Drawing or not:** in training unlikely actions still occur,
# the more often the higher the entropy is. A swerve of one second can end a drive that the most
# probable actions would have survived, so scores in training can be lower than in the test. It can
# also be the other way round: where a policy is even between two actions, the test repeats one of
# them. **500 rows:** the batch then comes from the last few episodes, which are alike, so each
# update fits what the present policy meets and forgets earlier states, falls among them. **More
# updates:** the critics fit the rows sooner, so fewer pushes may do; but they fit the errors of few
# rows, too, and the machine computes sixteen times as long.

# %% [markdown] tags=["instructor"]
# **On the board.** Four boxes: memory, critics, actor, temperature; an arrow for each quantity that
# one takes from another.
#
# **To discuss.** Which of the four boxes could you leave out and still have a learner?
