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
# # Discrete soft actor-critic
#
# **What you will be able to do**
# - derive what a critic should have estimated, and write the losses of critics, actor and
#   temperature;
# - write how a batch is drawn, the update and the loop around it, and train your agent with them;
# - recognise a critic that diverges, and say what three seeds can show.
#
# **Time** 107 minutes; the machine computes for about one of them. There are two sittings: the
# losses (to Round 4, 49 minutes) and the program (Rounds 5 to 7, 58 minutes). **You need** Python
# and a little torch; states, actions and rewards as in lesson [[the_trap]].

# %%
import bootcourse as bc
import numpy as np
import torch
from bootcourse.course import check, compare_predictions, own_code, predict, table
from bootcourse.course.lessons.discrete_sac import by_hand, diagrams, figures, left_out
from bootcourse.learn import sac
from bootcourse.research import checks

# %% [markdown]
# ## Look first
#
# Before the road, a smaller world. A pole stands on a cart. Fifty times a second you push the cart
# to the left or to the right: two actions. Each push pays 1 while the pole stands. The episode
# ends when the pole leans more than 12 degrees, when the cart leaves its track, or after 500
# pushes. This is **CartPole**.
# <!-- claim: gym.make('CartPole-v1').unwrapped.tau == 1 / 50 -->
# <!-- claim: (lambda env: (env.reset(seed=0), env.step(0))[1][1])(gym.make('CartPole-v1')) == 1 -->
# <!-- claim: math.degrees(gym.make('CartPole-v1').unwrapped.theta_threshold_radians) == 12 -->
# <!-- claim: gym.spec('CartPole-v1').max_episode_steps == 500 -->

# %%
drivers = {
    "at random": bc.random_policy(np.random.default_rng(0), 2),  # two actions
    "rule: push where it falls": bc.teacher_policy(checks.balance, None, 2),
}
drives = {}
for label, driver in drivers.items():
    rows, pushes = checks.data(driver, checks.cartpole, 1, seed=0)
    drives[f"{label}: {pushes:.0f} pushes"] = rows[:, :4].numpy()
title = "One line of code balances the pole; chance does not"
bc.show(figures.cartpole_strip(drives, title))

# %% [markdown]
# > **Predict.** Your learner will know nothing about poles: it sees four numbers and gets a reward
# > of 1 for each push. After 8,000 pushes, for how many will it balance the pole?

# %%
choices = ["about 20", "about 100", "about 250", "nearly 500"]
predict("discrete_sac.1", "For how many pushes, after 8,000 to learn from?", choices)

# %% [markdown]
# ## The parts in one picture

# %%
bc.show(diagrams.sac_diagram())

# %% [markdown]
# *Soft actor-critic* (SAC) has four parts:
#
# - The **actor** gives each action a probability, π(a|s): its **policy**. It is a small network.
# - Two **critics** estimate what each action is worth from here on, Q(s, a), all later rewards
#   included. The smaller estimate of the two counts.
# - The **temperature** α says how much it counts that the actor stays undecided.
# - The **replay buffer** keeps what happened, a row for each decision. Each update learns from a
#   **batch** of rows: critics, actor and temperature alike.
#
# On the evening route this picture is enough: go on to [the barrier](the_barrier.ipynb).

# %% [markdown] tags=["instructor"] minutes=3
# Follow one row of the buffer through the picture: who made it, and which three parts learn from
# it? Leave the picture on the wall; Round 3 asks which of its arrows carry a gradient.

# %% [markdown]
# ## Round 1: what is a state worth if an undecided policy earns more?
#
# Suppose that you know Q(s, a), what each action is worth (Round 2 says how it is learned). SAC
# adds a small reward for an undecided policy, so that the actor goes on trying actions which it
# does not yet think the best: this is **exploration**. The policy's **entropy** says how undecided
# it is, in nats (natural logarithm):
#
# $$ \mathcal{H}(\pi(\cdot|s)) = -\sum_a \pi(a|s) \log \pi(a|s) $$
#
# > **Predict.** What is the entropy of a policy that is sure of one action? Can it be negative?

# %%
predict("discrete_sac.2", "The smallest entropy that a policy can have, in nats", unit="nats")

# %%
for words, pi in (
    ("sure of one of two", [1 - 1e-9, 1e-9]),
    ("two, 19 to 1", [0.95, 0.05]),
    ("two, 3 to 1", [0.75, 0.25]),
    ("two, even", [0.5, 0.5]),
    ("nine, even", [1 / 9] * 9),
):
    h = sac.entropy(torch.tensor([pi]).double().log()).item()
    print(f"{words:20} {h:.3f} nats, as many as {np.exp(h):.2f} equally likely actions")

# %% [markdown]
# **See.** The entropy lies between 0 and the logarithm of the number of actions. It is **never
# negative**, since no probability is above 1.
# <!-- claim: 0 == float(sac.entropy(torch.tensor([1.0]).log())) <
#   float(sac.entropy(torch.full((9,), 1 / 9).log())) < math.log(9) + 1e-6 -->
#
# The **soft value** of a state is what the actor can expect there: the mean of Q under its own
# policy, plus α for each nat of entropy. α is the **temperature**.
#
# $$ V(s) = \sum_a \pi(a|s)\, Q(s,a) + \alpha\, \mathcal{H}(\pi(\cdot|s)) $$
#
# **Exercise (4 min, ●○○).** Write the soft value.


# %%
def soft_value(log_pi, q, alpha):
    """V(s). log_pi, q: (batch, actions); alpha: a tensor with one number. Returns (batch,)."""
    # solution
    return (log_pi.exp() * (q - alpha * log_pi)).sum(-1)
    # end solution


check.soft_value(soft_value)

# %% [markdown]
# > **Predict.** Two actions have Q = 1 and Q = 3. One policy is sure of the better action, another
# > is even. At which α have both the same V? (The entropy of the even one is 0.693.)

# %%
predict(
    "discrete_sac.3", "The α at which both are worth the same", ["0.5", "0.693", "1", "1.44", "2"]
)

# %%
q = torch.tensor([[1.0, 3.0]])
for alpha in (0.1, 1.0, 1.4427, 2.0):
    values = [
        sac.soft_value(torch.tensor([pi]).log(), q, torch.tensor(alpha)).item()
        for pi in ([1e-12, 1.0], [0.5, 0.5])
    ]
    print(f"α = {alpha:6}: sure {values[0]:.2f}, even {values[1]:.2f}")

# %% [markdown]
# **Explain.** The even policy loses 1 in Q and gets 0.693 α for its entropy. The best policy lies
# between the two: it is a *softmax*, $\pi(a|s) \propto \exp(Q(s,a)/\alpha)$. With a high α this
# policy is nearly even, with a low α it is nearly sure of one action.
#
# <details><summary>Why a softmax?</summary>
#
# Move a little probability ε from action b to action a. The value changes by
# $\varepsilon\,[(Q_a - \alpha\log\pi_a) - (Q_b - \alpha\log\pi_b)]$. At the best policy no such
# move gains anything, so $Q_a - \alpha\log\pi_a$ is the same number Z for each action, and
# $\log\pi_a = (Q_a - Z)/\alpha$.
#
# </details>

# %% [markdown] tags=["instructor"] minutes=5
# Those who know continuous SAC will want to sample an action and use Q − α log π of it. With two
# or nine actions the expectation is a sum of two or nine terms, which we compute exactly. Ask what
# sampling would add to the target (noise, with the variance of Q − α log π under π).

# %% [markdown]
# ## Round 2: what should the critic's estimate have been?
#
# The critic learns from **transitions**: in state s the learner took action a, got the reward r,
# and came to s'. What should $Q(s,a)$ have been? The **discount** γ, a number between 0 and 1, says
# how much later rewards count: one t steps later counts $\gamma^t$ times as much. Q(s, a) is the
# mean of all that follows the action, where each later state also earns α times its entropy:
#
# $$ Q(s_0, a_0) = \mathbb{E}\big[\, r_0 + \gamma\,(r_1 + \alpha \mathcal{H}_1) +
# \gamma^2 (r_2 + \alpha \mathcal{H}_2) + \dots \big] $$
#
# ($\mathcal{H}_0$ is not in it, because $a_0$ is given.) Take γ out of all terms but the first.
# What is left is $\alpha \mathcal{H}_1$ and a sum that begins at $s_1$, whose mean is $Q(s_1,
# a_1)$; and $a_1$ is drawn from π, so take the mean over it:
#
# $$ Q(s_0, a_0) = \mathbb{E}\big[\, r_0 + \gamma \big( \textstyle\sum_a \pi(a|s_1)\, Q(s_1, a) +
# \alpha \mathcal{H}_1 \big) \big] = \mathbb{E}\big[\, r_0 + \gamma V(s_1) \big] $$
#
# This is the **soft Bellman equation**: one transition is enough to learn from. Its right side,
# computed with the present estimates, is the **target** y, and the loss is the mean squared
# distance from it. $y - Q(s,a)$ is the **temporal difference**. To learn an estimate from an
# estimate is called **bootstrapping**. (The paper's title means another thing: to start with a
# rule's help.)
#
# $$ y = r + \gamma\, (1 - \text{terminated})\, V(s'), \qquad
# L_\text{critic} = \text{mean of } (Q(s,a) - y)^2 $$
#
# > **Predict.** In one episode the pole fell. In another the 500 pushes were over while it stood.
# > γ = 0.99, r = 1, and the critic's estimate of V(s') is 50. What is y in each?

# %%
predict(
    "discrete_sac.4",
    "y of the pole that fell, and of the one whose time was up",
    ["1 and 1", "1 and 50.5", "50.5 and 1", "50.5 and 50.5"],
)

# %% [markdown]
# **Exercise (4 min, ●○○).** Write the target.


# %%
def critic_target(reward, terminated, next_value, gamma):
    """y. reward, terminated (0 or 1), next_value: (batch,); gamma: float. Returns (batch,)."""
    # solution
    return reward + gamma * (1 - terminated) * next_value
    # end solution


check.critic_target(critic_target)

# %%
terminated = torch.tensor([1.0, 0.0])  # it fell; the time was up
print(sac.critic_target(torch.ones(2), terminated, torch.tensor([50.0, 50.0]), 0.99).tolist())

# %% [markdown]
# **Explain.** The rewards end when the pole falls. A pole that still stands when the time is up
# would go on earning: the episode was cut off. So `terminated` is 1 for the first, 0 for the
# second.

# %% [markdown]
# Two tricks make the estimates steadier. V uses the smaller value of **two critics**, because the
# actor prefers actions that a critic overestimates. And V is computed with **target networks**,
# slow copies of the critics that take over a small share τ ("tau") of the new weights at each
# update, so that a step towards the target hardly moves the target.
#
# **Exercise (6 min, ●●○).** Write the loss of both critics: for each of them the mean over the
# batch of $(Q(s,a) - y)^2$, and then the sum of the two. Here a is the action that was taken. The
# target is held fixed, and the check also looks at where the gradient goes.


# %%
def critic_loss(q_pair, action, target):
    """A scalar tensor. q_pair: (2, batch, actions), with gradients; action, target: (batch,)."""
    # solution: the exercise's own


check.critic_loss(critic_loss)

# %% [markdown] tags=["instructor"] minutes=9
# Derive the Bellman equation on the board from the sum of three terms, and let them say which one
# is V(s'). Then ask what would change if the row came from an older policy (nothing: a is given,
# and what follows is asked of the present policy). This is why the buffer of Round 5 may hold it.

# %% [markdown]
# ## Round 3: what does the actor minimise?
#
# The actor is trained to make the soft value large, as the critics estimate it. Its loss is minus
# the soft value:
#
# $$ L_\text{actor} = -\,\text{mean over } s \text{ of } \sum_a \pi(a|s)\,
# \big(Q(s,a) - \alpha \log \pi(a|s)\big) $$
#
# Two things make V larger: a better policy, or higher estimates Q. Which may the gradient change?
#
# **Exercise (5 min, ●●○).** Write the actor's loss.


# %%
def actor_loss(log_pi, q, alpha):
    """A scalar tensor. log_pi, q: (batch, actions); alpha: a tensor with one number."""
    # solution: the exercise's own


check.actor_loss(actor_loss)

# %%
for words, keeps_q in (("Q held fixed", True), ("Q may move, too", False)):
    logits, q = torch.zeros(1, 2, requires_grad=True), torch.tensor([[1.0, 3.0]]).requires_grad_()
    optimiser = torch.optim.Adam([logits, q], lr=0.05)
    for _ in range(200):
        held = q.detach() if keeps_q else q
        loss = -sac.soft_value(sac.log_policy(logits), held, torch.tensor(1.0)).mean()
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
    pi, worth = logits.softmax(-1)[0].tolist(), q[0].tolist()
    print(f"{words:16} π = {pi[0]:.2f} {pi[1]:.2f}   Q = {worth[0]:.1f} {worth[1]:.1f}")

# %% [markdown]
# **Explain.** With Q held fixed, the actor finds the softmax of Round 1. If Q may move, the loss
# also falls when Q rises, although the actions are worth what they were worth before. So Q is
# **detached** (`q.detach()`): its value counts, and the gradient stops there.

# %% [markdown] tags=["instructor"] minutes=4
# Let them say, before the cell is run, what an actor would do that may also raise Q. Then ask which
# arrows of the picture carry a gradient, and where else one must stop (the target of the critics).

# %% [markdown]
# ## Round 4: which temperature is right?
#
# That depends on how large Q is, which is not known before training. So SAC adjusts α as a
# thermostat adjusts the heating: while the entropy is above a **target entropy** η ("eta"), α
# falls; while it is below, α rises.
#
# $$ L_\alpha = \alpha\, (\mathcal{H}(\pi) - \eta) $$
#
# **Exercise (4 min, ●●○).** Write it. The parameter is log α, so that α stays positive. (Some
# programs write log α in place of the first α: then the gradient does not get smaller as α falls.)


# %%
def temperature_loss(log_alpha, state_entropy, target_entropy):
    """A scalar tensor. log_alpha, target_entropy: one number; state_entropy: (batch,), in nats."""
    # solution
    return log_alpha.exp() * (state_entropy.detach().mean() - target_entropy)
    # end solution


check.temperature_loss(temperature_loss)

# %% [markdown]
# The paper sets **η = {{ SETTINGS.target_entropy }}**, in a table, for its nine actions.
#
# > **Predict.** Remember the range of the entropy. In which direction does this thermostat turn,
# > and when does it stop?

# %%
predict(
    "discrete_sac.5",
    "With η = −1, α",
    ["falls, and stops at H = η", "rises for ever", "falls for ever", "moves up and down"],
)

# %%
most = np.log(9).item()  # nats: nine actions, all as likely
for h in (most, 1.0, 0.1, 0.0):
    log_alpha = torch.tensor(0.01).log().requires_grad_()
    gradients = []
    for eta in (-1.0, 0.3 * most):
        loss = sac.temperature_loss(log_alpha, torch.tensor([h]), torch.tensor(eta))
        gradients.append(torch.autograd.grad(loss, log_alpha)[0].item())
    turns = ["falls" if gradient > 0 else "rises" for gradient in gradients]
    print(f"H = {h:.2f}: with η = -1 α {turns[0]}, with η = 0.66 α {turns[1]}")

# %% [markdown]
# **Explain.** For *continuous* actions a rule of thumb sets η to minus the dimension of the action:
# −1 for one that is a single number. There an entropy can be negative, since a density can be
# larger than one. The entropy of a policy over a list of actions is 0 or more, so with this η the
# difference $\mathcal{H} - \eta$ is at least 1 in every state, and α falls at each update. As α
# falls, the best policy softmax(Q / α) becomes sure of one action: the agent explores less and
# less. How fast, lesson [[soft_constraint]] measures. The second η of the cell, 0.66, is three
# tenths of the largest entropy: there α turns, as a thermostat should.
# <!-- claim: 0 - SETTINGS.target_entropy == 1 -->
#
# **The first sitting ends here.** In the second one run the cells above again, and go on below.

# %% [markdown] tags=["instructor"] minutes=5
# Most say "falls, and stops at η", as a thermostat in a room does. Ask which entropy would have to
# be reached. It helps to write the range, 0 to log 9, on the board before anybody answers.

# %% [markdown]
# ## Round 5: where does a batch come from?
#
# SAC keeps its transitions in a table, the **replay buffer**. Each update learns from rows that are
# drawn **uniformly with replacement**: at each draw each row has the same chance. At random,
# because transitions that follow each other are alike. Most rows come from earlier policies.
# Learning from what another policy did is called **off-policy**; it is possible because the target
# asks what the *present* policy would do in s'.
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
# ## Round 6: the whole algorithm
#
# > **Soft actor-critic for a list of actions**
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
# **Exercise (20 min, ●●●).** Write steps 3 to 8, with the functions that you have written above
# (`check.solution("soft_value")` shows ours) and `sac.entropy(log_pi)`.


# %%
def update(agent, batch):
    """One update; returns nothing. agent: a by_hand.SAC; batch: a by_hand.Batch of 64 rows, with
    states, next_states (64, 4), actions, rewards, terminated (64,)."""
    # solution: the exercise's own


check.update(update)

# %% [markdown]
# **Exercise (12 min, ●●●).** Write the loop around it. `env` is gymnasium's: `reset()` returns a
# state and more, `step(action)` returns s', r, terminated, truncated and more.
# `agent.draw(state, rng)` draws an action, `by_hand.row(s, a, r, terminated,
# s')` makes a row, `by_hand.batch_of(rows)` makes a batch of 64 rows from the buffer. After the
# first 256 pushes, make one update after every fourth push.


# %%
def train(agent, env, buffer, update, pushes, rng):
    """Train the agent for that many pushes; returns nothing. update(agent, batch); rng: NumPy's."""
    # solution: the exercise's own


check.train(train)

# %% [markdown]
# Now your agent learns, with your parts as far as they have passed; the rest is ours.

# %%
PUSHES = 8_000
loop, step, buffer = map(own_code.yours_or_ours, ("train", "update", "ReplayBuffer"))
agent, untrained = by_hand.SAC(seed=0), by_hand.balanced(by_hand.SAC(seed=0))
loop(agent, checks.cartpole(), buffer(50_000), step, PUSHES, np.random.default_rng(0))
balanced = by_hand.balanced(agent)
print(f"Before: {untrained:.0f} pushes. After {PUSHES:,}: {balanced:.0f} of 500.")

# %% [markdown]
# **See.** (Yours will differ from another machine's.) An untrained agent falls sooner than chance,
# since its most probable push is nearly always the same one. Train again with `seed=1` before you
# judge: one agent is one sample. Is the update made of your parts the same as the library's, which
# trains many agents at once?

# %%
own_code.compare()

# %% [markdown] tags=["instructor"] minutes=6
# Let those who have finished exchange their `update` with a neighbour and find the lines in which
# they differ. "Why is `terminated` in the row and `truncated` not?" is the question to ask before
# anybody runs the loop.

# %% [markdown]
# ## Round 7: what can be left out?
#
# Five kinds of agents, three seeds each, with 4,000 pushes, half of what yours had. The first kind
# is whole. The others leave out one part: the entropy (α = 0), the second critic, the slow copies
# (the target comes from the critics themselves), or the factor (1 − terminated).
#
# > **Predict.** Without which of the four do the agents balance the pole worst, on average?

# %%
predict("discrete_sac.6", "Without which part is the mean lowest?", list(left_out.KINDS[1:]))

# %%
SEEDS, TARGET = 3, 0.3 * np.log(2).item()
settings = bc.settings_for("sac", gamma=0.99, tau=0.05, target_entropy=TARGET)
grid = left_out.training(settings, SEEDS, pushes=4_000)
starts = np.stack([checks.cartpole().reset(seed=seed)[0] for seed in range(50)])
values = []
for pushes in (1_000, 2_000, 3_000, 4_000):
    grid.run(progress=False, stop=lambda most=pushes: grid.decisions >= most * grid.learner.agents)
    q = [grid.agent(i).q_values(starts).mean() for i in range(grid.learner.agents)]
    means = np.reshape(q, (-1, SEEDS)).mean(1)
    values.append([f"{pushes:,}", f"{means[0]:.0f}", f"{means[-1]:.0f}"])
scores = checks.scores(grid.result().agents, checks.cartpole, 10).reshape(-1, SEEDS)
rows = []
for kind, each in zip(left_out.KINDS, scores, strict=True):
    rows.append([kind, *(f"{score:.0f}" for score in each)])
table(["without", *(f"seed {seed}" for seed in range(SEEDS))], rows, "Pushes, of at most 500.")

# %% [markdown]
# **Explain.** One row stands out: without (1 − terminated) the agents hardly balance the pole. In
# the others the seeds of a row differ as much as the rows do. So three agents, trained this
# shortly, do not show that a part is useless, nor that it helps: lesson [[how_many_seeds]] works
# out how many would.
#
# What went wrong? Without (1 − terminated) each row says "1 now, and then the value of the next
# state"; no row says that a fall ends the rewards. The one constant that fits all rows is
# Q = 1 / (1 − γ) = {{ 1 / (1 - 0.99) | .0f }} for both actions (plus the entropy's share), which
# tells no action from the other. Does the critic find it?

# %%
table(["pushes", "Q, whole", "Q, without (1 − terminated)"], values, "Means of 50 start states.")

# %% [markdown]
# **See.** It passes {{ 1 / (1 - 0.99) | .0f }} and goes on: the critic **diverges**. It learns
# estimates from estimates, with a network, on rows of older policies; these three together can
# diverge (Sutton and Barto, chapter 11: the *deadly triad*). The program runs without an error, so
# print the values of Q while an agent learns.

# %% [markdown] tags=["instructor"] minutes=8
# Let groups predict the whole order, not only the first place. A belief to name: "the second critic
# is the trick that makes it work". On the pole three seeds do not show that.

# %% [markdown]
# ## What you now know
#
# 1. The soft value is the mean of Q under the policy plus α times its entropy; its best policy is
#    softmax(Q / α).
# 2. The critics are fitted to r + γ (1 − terminated) V(s'), held fixed; an episode that ran out of
#    time is not terminated.
# 3. The actor's loss is minus the soft value, with Q held fixed.
# 4. The temperature is a thermostat for the entropy, which over a list of actions is 0 or more:
#    with η = {{ SETTINGS.target_entropy }} α falls at each update.
# 5. The buffer gives rows of earlier policies: SAC learns off-policy.

# %%
worst = left_out.KINDS[1 + scores[1:].mean(1).argmin()]
compare_predictions(
    "discrete_sac",
    {1: f"{balanced:.0f}", 2: 0.0, 3: "1.44", 4: "1 and 50.5"} | {5: "falls for ever", 6: worst},
)

# %% [markdown]
# **Three questions to think about**
# - What would η = log 9 do to an agent on the road?
# - In training the learner draws its actions from its policy; in the test it takes the most
#   probable one. Where could that matter?
# - V takes the smaller of two critics. What would happen with the larger?
#
# **Read on**: Haarnoja et al., *Soft Actor-Critic* (arXiv 1801.01290), and its second version with
# the thermostat (arXiv 1812.05905); Fujimoto et al., *Addressing Function Approximation Error in
# Actor-Critic Methods* (TD3, arXiv 1802.09477), on two critics and slow copies; Christodoulou,
# *Soft Actor-Critic for Discrete Action Settings* (arXiv 1910.07207); Xu et al., *Target Entropy
# Annealing for Discrete Soft Actor-Critic* (arXiv 2112.02852).

# %% [markdown] tags=["instructor"] minutes=5
# *Answers to the three questions.* **η = log 9** is the largest entropy of nine actions. While the
# policy is not even, H < η and α rises, until entropy outweighs the differences in Q and the agent
# drives almost at random. **Drawing or not:** in training unlikely actions still occur, the more
# often the higher the entropy is. A swerve of one second can end a drive that the most probable
# actions would have survived, so scores in training can be lower than in the test. It can also be
# the other way round: where a policy is even between two actions, the test repeats one of them.
# **The larger of two:** the actor looks for actions that one critic overestimates, the target then
# contains that error, and the estimates drive each other up (overestimation; Fujimoto et al., arXiv
# 1802.09477). The smaller one errs in the other direction, which feeds back less, since the actor
# takes underestimated actions less often.
