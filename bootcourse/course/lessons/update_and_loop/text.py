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
# **Time** 58 minutes; the machine computes for about one of them. **It builds on** lesson
# [[discrete_sac]] and its losses.

# %%
import bootcourse as bc
import gymnasium as gym
import numpy as np
import torch
from bootcourse.course import (
    charts,
    check,
    compare_predictions,
    own_code,
    predict,
    predicted,
    progress,
    table,
)
from bootcourse.course.lessons.discrete_sac import figures
from bootcourse.course.lessons.update_and_loop import by_hand, explorable, left_out
from bootcourse.learn import sac
from bootcourse.research.experiments import checks

progress("update_and_loop")

# %% [markdown]
# ## Look first
#
# The pole of lesson [[discrete_sac]] once more: it sees four numbers, each push pays 1, and an
# episode ends after a fall or after 500 pushes. In the picture's upper row drives an agent that has
# learned nothing yet, by its most probable push; in the lower one the rule of lesson
# [[discrete_sac]], a weighted sum.

# %%
beginner = by_hand.SAC(seed=0)
drivers = {
    "untrained": beginner.as_policy(),
    "rule: one weighted sum": bc.teacher_policy(checks.balance, None, 2),
}
drives = {}
for label, driver in drivers.items():
    rows, pushes = checks.data(driver, checks.cartpole, 1, seed=0)
    drives[f"{label}: {pushes:.0f} pushes"] = rows[:, :4].numpy()
bc.show(figures.cartpole_strip(drives, "An untrained agent lets the pole fall at once"))
entropy = sac.entropy(beginner.log_pi(torch.zeros(1, 4))).item()  # the pole stands upright
print(f"Entropy of the untrained policy: {entropy:.3f} of at most {np.log(2):.3f} nats")

# %% [markdown]
# > **Predict.** Your learner will know nothing about poles. It trains until it has solved this one,
# > and is tested every 2,000 pushes. Does each test last at least as long as the one before?

# %%
choices = [
    "yes, each",
    "it gets better, but with falls in between",
    "it stays near 20, and then jumps at once",
]
predict("update_and_loop.1", "Does each test last at least as long as the one before?", choices)

# %% [markdown]
# ## Round 1: where does a batch come from?
#
# SAC keeps its transitions in a table, the **replay buffer**. Each update learns from rows that are
# drawn **uniformly with replacement**: at each draw each row has the same chance. They are drawn at
# random because successive transitions resemble each other, so a batch of neighbours would say the
# same thing many times. Most rows come from earlier policies. So SAC learns **off-policy**, as
# Q-learning does (lesson [[values]]): the target asks what the *present* policy would do in s'.
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
# does a critic expect of the last push before a fall if its target knows the end, and what if it
# does not?

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
# >    y = r + γ (1 − terminated) V(s'), held fixed. — `soft_value`, `critic_target`
# > 4. **Critics.** L = mean (Q₁(s, a) − y)² + mean (Q₂(s, a) − y)². — `critic_loss`
# > 5. **Actor.** L = −mean Σₐ π(a|s) (minₖ Qₖ(s, a) − α log π(a|s)), with Q and α held fixed.
# >    — `actor_loss`
# > 6. **Temperature.** L = α (mean H(π(·|s)) − η), with H held fixed. — `temperature_loss`
# > 7. **Steps.** Compute the three losses, then make a gradient step for each.
# > 8. **Copies.** Q̄ₖ becomes Q̄ₖ + τ (Qₖ − Q̄ₖ), weight by weight.
#
# `by_hand.SAC()` is one agent for the pole. It holds:
#
# | name | what it is |
# |---|---|
# | `log_pi(states)` | log π, (batch, 2) |
# | `q(states)`, `slow_q(states)` | Q and Q̄ of both critics, (2, batch, 2) |
# | `log_alpha`, `gamma`, `tau`, `target_entropy` | log α, γ, τ and η |
# | `optimisers` | three: of the critics, the actor and log α |
# | `critics.parameters()`, `copies.parameters()` | the weights of step 8, to be changed in place |
#
# The five functions are those of lesson [[discrete_sac]]: yours, as far as they passed there; the
# rest is ours.
#
# | | arguments |
# |---|---|
# | `soft_value(log_pi, q, alpha)` | q: the smaller of both critics, (batch, 2) |
# | `critic_target(reward, terminated, next_value, gamma)` | each (batch,) |
# | `critic_loss(q_pair, action, target)` | q_pair: both critics, (2, batch, 2) |
# | `actor_loss(log_pi, q, alpha)` | q: the smaller one |
# | `temperature_loss(log_alpha, state_entropy, target_entropy)` | state_entropy: (batch,) |

# %%
own_code.load()
soft_value, critic_target, critic_loss, actor_loss, temperature_loss = own_code.yours_or_ours(
    "soft_value", "critic_target", "critic_loss", "actor_loss", "temperature_loss"
)

# %% [markdown]
# **Exercise (20 min, ●●●).** Write steps 3 to 8, with these functions and `sac.entropy(log_pi)`.
# You can check early: while something is missing, the message names networks that differ from ours.


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
#   time is up. Reset after either end.
# - `agent.draw(state, rng)` draws an action, `by_hand.row(s, a, r, terminated, s')` makes a row.
# - `by_hand.batch_of(buffer.sample(256, rng))` is a batch for `update`.
# - A call begins with a reset, and makes no update in its first 256 pushes, whatever the buffer
#   holds; from then on one after every fourth push. (Below, a call is 2,000 pushes.)


# %%
def train(agent, env, buffer, update, pushes, rng):
    """Train the agent for that many pushes; returns nothing. update(agent, batch); rng: NumPy's."""
    # solution: the exercise's own


check.train(train)

# %% [markdown]
# Now your agent learns, with your parts as far as they have passed; the rest is ours. When has it
# *solved* the pole? Gymnasium's mark for this environment is a mean of {{
# gym.spec('CartPole-v1').reward_threshold | .0f }} of at most {{
# gym.spec('CartPole-v1').max_episode_steps }} pushes. We ask for it in 20 episodes of the training
# in a row, whose pushes are drawn, and stop there.

# %%
predicted("update_and_loop.1")
BLOCK, MOST, SEED = 2_000, 60_000, 0  # pushes; another seed is another agent
loop, step, buffer = own_code.yours_or_ours("train", "update", "ReplayBuffer")
agent, step, rng = by_hand.SAC(seed=SEED), by_hand.Watched(step), np.random.default_rng(SEED)
env, kept = gym.wrappers.RecordEpisodeStatistics(checks.cartpole()), buffer(50_000)
tests, last = [by_hand.balanced(agent)], 0.0
while last < 475 and len(tests) * BLOCK <= MOST:
    loop(agent, env, kept, step, BLOCK, rng)
    tests.append(by_hand.balanced(agent))
    last = np.mean(list(env.return_queue)[-20:])
pushes, falls = np.arange(len(tests)) * BLOCK, int((np.diff(tests) < 0).sum())
title = f"From {tests[0]:.0f} pushes to {tests[-1]:.0f}; {falls} tests are worse than before"
x_label, y_label = "pushes in training", "pushes balanced, mean of 10 episodes"
looks = [bc.colours.OTHER._replace(marker="o")]
bc.show(charts.lines(pushes, {"your agent": np.array(tests)}, title, x_label, y_label, looks=looks))
solved = f"solved after {pushes[-1]:,} pushes" if last >= 475 else f"not solved in {pushes[-1]:,}"
new = by_hand.balanced(agent, episodes=20)
print(f"{solved}: {last:.0f} in training's last 20 episodes, {new:.0f} in 20 new ones")

# %% [markdown]
# **See.** (Yours will differ from another machine's.) This untrained agent lets the pole fall
# sooner than a random driver does: its most probable push is nearly always the same one. (The mark
# asks for 20 episodes of training, with drawn pushes: 10,000 pushes at 500 each, and any fall
# delays it.) Does a test fall below the one before? A network that changes for one state changes
# for others, too, so an update can make a policy worse. Train again with `SEED = 1`: one agent is
# one sample.
#
# Did the thermostat work? Lesson [[discrete_sac]] computed its direction only. Here its target is
# η = 0.3 log 2 = {{ 0.3 * math.log(2) | .2f }}, which a policy over two actions can reach:

# %%
kept = len(step.alpha) // 100 * 100  # each point is the mean of 100 updates
entropy, alpha = (np.reshape(x[:kept], (-1, 100)).mean(1) for x in (step.entropy, step.alpha))
updates, target = np.arange(100, kept + 1, 100), agent.target_entropy
title = f"The entropy ends at {entropy[-1]:.2f} nats; its target is {target:.2f}"
noted, level = {"entropy H": entropy, "α": alpha}, {"target η": target}
bc.show(
    charts.lines(updates, noted, title, "updates", "H (nats) and α (logarithmic)", "y", marks=level)
)

# %% [markdown]
# **See.** While the entropy is below its target, α rises, and at first nothing follows: α is still
# small beside the differences in Q, and the best policy is softmax(Q / α). Once it is large enough,
# the policy becomes less certain; where the entropy passes the target, α falls again. Has your H
# settled at the target? With the paper's η = −1, α would fall from the first update to the last.
#
# Is the update made of your parts the same as the library's, which trains many agents at once?

# %%
own_code.compare()

# %% [markdown]
# **See.** The line names your parts. Losses and their gradients are compared with the library's on
# the same batches (rounding makes relative differences of about a millionth; above a thousandth it
# is a mistake). Your buffer, update and loop go through their checks again.

# %% [markdown] tags=["instructor"] minutes=6
# Let those who have finished exchange their `update` with a neighbour and find the lines in which
# they differ. "Why is `terminated` in the row and `truncated` not?" is the question to ask before
# anybody runs the loop.

# %% [markdown]
# ## Round 3: what can be left out?
#
# Five kinds of agents, three seeds each, in smaller trainings than yours: 4,000 pushes, batches of
# 64 rows, and the smaller learning rates of the road. The first kind is whole. The others leave out
# one part: the entropy (α = 0), the second critic, the slow copies (the target comes from the
# critics themselves), or the factor (1 − terminated).
#
# > **Predict.** Without which of the four do the agents balance the pole worst, on average?

# %%
predict("update_and_loop.2", "Without which part is the mean lowest?", list(left_out.KINDS[1:]))

# %%
predicted("update_and_loop.2")
SEEDS, TARGET = 3, 0.3 * np.log(2).item()
settings = bc.settings_for("sac", gamma=0.99, tau=0.05, target_entropy=TARGET)
grid = left_out.training(settings, SEEDS, pushes=4_000)
starts = np.stack([checks.cartpole().reset(seed=seed)[0] for seed in range(50)])
values, marks = [], (1_000, 2_000, 3_000, 4_000)
for pushes in marks:
    grid.run(progress=False, stop=lambda most=pushes: grid.decisions >= most * grid.learner.agents)
    q = [grid.agent(i).q_values(starts).mean() for i in range(grid.learner.agents)]
    values.append(np.reshape(q, (-1, SEEDS)).mean(1)[[0, -1]])
scores = checks.scores(grid.result().agents, checks.cartpole, 10).reshape(-1, SEEDS)
rows = []
for kind, each in zip(left_out.KINDS, scores, strict=True):
    rows.append([kind, *(f"{score:.0f}" for score in (*each, each.mean()))])
headings = ["without", *(f"seed {seed}" for seed in range(SEEDS)), "mean"]
table(headings, rows, "Pushes, of at most 500.")

# %% [markdown]
# **Explain.** Without (1 − terminated) the agents hardly balance the pole: in our run each of the
# three is below all others, so three seeds suffice to see it. Compare the other rows with the
# spread of their own seeds: three agents and 4,000 pushes show neither that the other parts help
# nor that they are useless. Lesson [[how_many_seeds]] shows how many agents such a question needs.
#
# What went wrong? Without (1 − terminated) each row says "1 now, and then the value of the next
# state"; no row says that a fall ends the rewards. The one constant that fits all rows is Q = 1 /
# (1 − γ) = {{ 1 / (1 - 0.99) | .0f }} for both actions (and a little for the entropy), which tells
# no action from the other. Does the critic find it?

# %%
named = dict(
    zip(("the whole agent", "without (1 − terminated)"), np.transpose(values), strict=True)
)
title = "Without (1 − terminated) the critic's estimates do not stop at 1 / (1 − γ)"
words = "Q, mean of 3 agents and 50 start states (logarithmic)"
limit = {"1 / (1 − γ) = 100": 100.0}
looks = [bc.colours.STRANGERS[k]._replace(marker="os"[k]) for k in range(2)]
x_label = "pushes in training"
bc.show(charts.lines(marks, named, title, x_label, words, "y", marks=limit, looks=looks))

# %% [markdown]
# **See.** The estimates pass {{ 1 / (1 - 0.99) | .0f }} and go on: the critic **diverges**, and the
# program runs without an error. (After 8,000 pushes each of three such agents of ours was above
# 10,000.) Where does the surplus come from? A state in which the pole has fallen is in the buffer
# as s' only, never as s. Its value enters targets, but no row corrects it: the network makes it up.
# If that is the cause, rows that start in a fallen state should help. Give each fallen state such
# rows, which lead back to it and pay 1, as if it went on for ever; as a control, give as many to
# the upright state. (α is held, so that entropy cannot raise Q. The learning rates are Round 2's,
# larger than those above.)

# %%
rows = []
for words, also in (("none", ""), ("fallen states", "fallen"), ("the upright state", "upright")):
    rows.append([words])
    for seed in range(SEEDS):
        agent = by_hand.SAC(seed, rates=(3e-3, 2e-3, 0))  # α stays at 0.01
        kept, rng = by_hand.WithoutEnds(buffer(50_000), also), np.random.default_rng(seed)
        loop(agent, checks.cartpole(), kept, step.update, 2_000, rng)  # pushes
        with torch.no_grad():
            q = agent.q(torch.from_numpy(starts)).mean()
        rows[-1].append(f"{q:,.0f}")
headings = ["additional rows of", *(f"seed {seed}" for seed in range(SEEDS))]
table(headings, rows, "Q after 2,000 pushes. In all rows terminated = 0.")

# %% [markdown]
# **Explain.** With each seed the rows of fallen states keep the estimate low, and as many of
# another state do not: they were what was missing. If nothing ends, it belongs near {{ 1 / (1 -
# 0.99) | .0f }}. Does it come nearer? Try 30,000 pushes; then let α move, too: Q contains what
# entropy pays. All these agents use a network, learn estimates from estimates, and do so on rows of
# older policies. Sutton and Barto, chapter 11, call these three the *deadly triad*: with them a
# critic *can* diverge, and need not. A target that reads values which no row corrects comes back in
# lesson [[recorded_drives]].

# %% [markdown] tags=["instructor"] minutes=8
# Let groups predict the whole order, not only the first place. A belief to name: "the second critic
# is the trick that makes it work". On the pole three seeds do not show that. Who tries 30,000 pushes
# sees Q come near 100 while α is held, and go above it where α moves: entropy counts in Q, too.

# %%
worst = left_out.KINDS[1 + scores[1:].mean(1).argmin()]
course = choices[2 if max(tests[:-1]) < 100 else min(falls, 1)]
compare_predictions("update_and_loop", {1: course, 2: worst})

# %% [markdown]
# ## What you now know
#
# 1. The buffer gives rows of earlier policies: SAC learns off-policy.
# 2. An update makes one step for the critics, the actor and the temperature, and then moves the
#    copies of the critics a little.
# 3. `terminated` tells the critic where the rewards end. A time limit is no such end, so the row of
#    a pole that still stands holds 0.
# 4. Without (1 − terminated) the targets read values of fallen states, which no row corrects. The
#    critics diverged, and no error said so. Look at Q while an agent learns: above r / (1 − γ) and
#    what entropy pays it cannot be right.
# 5. Three agents, trained so briefly, do not show that a part is useless.

# %% [markdown]
# **Three questions to think about**
# - In training the learner draws its actions from its policy; in the test it takes the most
#   probable one. Where could that matter?
# - A buffer of 50,000 rows keeps all that this agent did. What would a buffer of 500 rows change?
# - The loop makes one update after every fourth push. What could four updates after each push do,
#   for better and for worse?
#
# **Read on**: Mnih et al., *Human-level control through deep reinforcement learning* (Nature,
# 2015), on replay buffers and slow copies; Sutton and Barto, *Reinforcement Learning*, chapter 11,
# on what can diverge; the same algorithm on one page, for the road: `python -m
# bootcourse.learn.textbook`.

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
