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
# - write six parts of discrete soft actor-critic: the soft value, the critic's target, the losses
#   of critics, actor and temperature, and the replay buffer, and say how the algorithm joins them;
# - train agents with the parts that you wrote, and read their curves;
# - say in which direction a target entropy of {{ SETTINGS.target_entropy }} moves the temperature
#   of an agent with nine actions, and choose another target.
#
# **Time** 100 minutes, about one of them the machine's. You can stop after any round. **You need**
# Python and a little torch; states, actions and rewards as in lesson [[the_trap]].

# %%
import bootcourse as bc
import numpy as np
import torch
from bootcourse.course import charts, check, compare_predictions, own_code, predict, source
from bootcourse.course.lessons.discrete_sac import figures
from bootcourse.plots import diagrams
from bootcourse.research import checks

# %% [markdown]
# ## Look first
#
# Before the road, a smaller world. A pole stands on a cart. Fifty times a second you push the cart
# to the left or to the right: two actions. Each push pays 1 while the pole stands. The episode
# ends when the pole leans more than 12 degrees, when the cart leaves its track, or after 500
# pushes. This is **CartPole**, a common first test for a learner.
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
# > **Predict.** The second driver is one line of code. A learner knows nothing about poles: it
# > sees four numbers and gets a reward of 1 for each push. Three learners get 8,000 pushes each to
# > learn from. For how many pushes will the best of them balance the pole after that?

# %%
predict(
    "discrete_sac.1",
    "Pushes of the best of three learners",
    ["about 20", "about 100", "250 or more"],
)

# %% [markdown]
# The next cell names three numbers that the rounds explain. The **discount** γ ("gamma") says how
# much a later reward counts: with 0.99 a reward 100 pushes ahead still counts
# {{ 0.99 ** 100 | .2f }}. **τ** ("tau") is the share by which slow copies of the networks follow
# them at each update. The **target entropy** says how undecided the learner should stay.

# %%
PUSHES, TARGET = 8_000, 0.3 * np.log(2).item()
changes = {"gamma": 0.99, "tau": 0.05}  # not the paper's: the pole needs a longer view
learners = bc.with_seeds(bc.settings_for("sac", target_entropy=TARGET, **changes), 3)
first = own_code.training(learners, PUSHES, make_env=checks.several(checks.cartpole))
first.run(stop=lambda: first.decisions >= PUSHES * len(learners))
balanced = checks.scores(first.result().agents, checks.cartpole, 20)
print("mean of 20 test episodes:", *(f"{pushes:.0f}" for pushes in balanced), "pushes")

# %%
grid, lasted = np.linspace(0, PUSHES, 200), []
for returns in first.curves.values["return"]:
    returns = returns[np.isfinite(returns)]
    lasted.append(np.interp(grid, returns.cumsum(), returns))  # at the end of each episode
title = "Each learner's training episodes get longer"
label = "pushes of its training so far"
bc.show(charts.lines(grid, {"sac": np.array(lasted)}, title, label, "pushes in an episode"))

# %% [markdown]
# **See.** Compare the first episodes with the last ones, and the three learners with each other.
# (Yours will differ from those of another machine.)
#
# The line *Training with …* names six parts of a learner and says whose they are: so far **ours**.
# In this lesson you write these six. The rest stays ours: how actions are drawn, which of two
# critics counts, how the slow copies move, and the loop. A part that passes its check replaces ours
# from there on, so that the agents at the end of this lesson learn with your code. Your part is
# kept in the folder `answers`, beside the notebooks, for the lessons that build on it.
# <!-- claim: len(parts_of([settings_for('sac')], {})) == 6 -->
# <!-- claim: all(f'check.{part}({part})' in code_of('discrete_sac')
#   for part in parts_of([settings_for('sac')], {})) -->
#
# ## The parts in one picture

# %%
bc.show(diagrams.sac_diagram())

# %% [markdown]
# The **actor** gives each action a probability, $\pi(a|s)$: its **policy**. The **critics**
# estimate what each action is worth from here on, $Q(s,a)$. Both are small neural networks. What
# the actor does goes into a **replay buffer**, and each update learns from a **batch** of it:
# critics, actor and temperature alike. The rounds explain the other boxes one by one.

# %% [markdown]
# ## Round 1: what is a state worth if an undecided policy earns more?
#
# *Soft* actor-critic (SAC) adds a small reward for an undecided policy. The **entropy** of the
# policy says how undecided it is, in nats (natural logarithm):
#
# $$ \mathcal{H}(\pi(\cdot|s)) = -\sum_a \pi(a|s) \log \pi(a|s) $$
#
# > **Predict.** What is the entropy of a policy that is sure of one action? Of an even choice
# > between two? Between nine? Can it be negative?

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
    h = bc.sac.entropy(torch.tensor([pi]).double().log()).item()
    print(f"{words:20} {h:.3f} nats, as many as {np.exp(h):.2f} equally likely actions")

# %% [markdown]
# **See.** The entropy lies between 0 and the logarithm of the number of actions. It is **never
# negative**, since no probability is above 1. Round 4 uses that.
# <!-- claim: 0 == float(sac.entropy(torch.tensor([1.0]).log())) <
#   float(sac.entropy(torch.full((9,), 1 / 9).log())) < math.log(9) + 1e-6 -->
#
# **Exercise (3 min, ●○○).** Write the entropy of each policy in a batch.


# %%
def entropy(log_pi):
    """H(π(·|s)) in nats. log_pi: (batch, actions), log π(a|s). Returns (batch,)."""
    # solution
    return -(log_pi.exp() * log_pi).sum(-1)
    # end solution


check.entropy(entropy)

# %% [markdown]
# The **soft value** of a state is what the actor can expect there: the mean of Q under its own
# policy, plus α for each nat of entropy. α is the **temperature**.
#
# $$ V(s) = \sum_a \pi(a|s)\, Q(s,a) + \alpha\, \mathcal{H}(\pi(\cdot|s)) $$
#
# **Exercise (5 min, ●○○).** Write the soft value.


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
        bc.sac.soft_value(torch.tensor([pi]).log(), q, torch.tensor(alpha)).item()
        for pi in ([1e-12, 1.0], [0.5, 0.5])
    ]
    print(f"α = {alpha:6}: sure {values[0]:.2f}, even {values[1]:.2f}")

# %% [markdown]
# **Explain.** The even policy loses 1 in Q and gets 0.693 α for its entropy. The best policy lies
# between the two: it is a *softmax*, $\pi(a|s) \propto \exp(Q(s,a)/\alpha)$. With a high α this
# policy is nearly even, with a low α it is nearly sure of one action. The name comes from physics:
# there a state of energy E has a probability proportional to $\exp(-E/T)$, with the temperature T
# in the place of α.
#
# <details><summary>Why a softmax?</summary>
#
# Move a little probability ε from action b to action a. The value changes by
# $\varepsilon\,[(Q_a - \alpha\log\pi_a) - (Q_b - \alpha\log\pi_b)]$, since the derivative of
# $-\pi\log\pi$ is $-\log\pi - 1$ and the two ones cancel. If the bracket is not 0, a small move in
# the right direction gains something, so this is not the best policy yet. At the best one the
# brackets are 0: $Q_a - \alpha\log\pi_a$ is the same number Z for each action. Solve for π:
# $\log\pi_a = (Q_a - Z)/\alpha$, a softmax of Q/α. Z is such that the probabilities add up to 1.
#
# </details>

# %% tags=["hide-input"]
temperatures = np.geomspace(0.1, 30, 60)
best = [torch.softmax(q[0] / alpha, 0)[1].item() for alpha in temperatures]
title = "The colder, the surer: the best policy for Q = 1 and Q = 3"
label = "probability of the better action"
bc.show(
    charts.lines(
        temperatures, {"softmax(Q / α)": best}, title, "temperature α", label, logarithmic="x"
    )
)

# %% [markdown] tags=["instructor"] minutes=10
# Those who know continuous SAC will want to sample an action and use Q − α log π of it. With two
# or nine actions the expectation is a sum of two or nine terms, which we compute exactly. Ask what
# sampling would add to the target (noise, with the variance of Q − α log π under π).

# %% [markdown]
# ## Round 2: what should the critic's estimate have been?
#
# The critic learns from **transitions**: in state s the learner took action a, got the reward r,
# and came to the state s'. What should $Q(s,a)$ have been? With the discount γ, a number between 0
# and 1, a reward t steps later counts $\gamma^t$ times as much. Q(s, a) is the mean of everything
# that follows the action, where each later state also earns α times its entropy $\mathcal{H}_t$:
#
# $$ Q(s_0, a_0) = \mathbb{E}\big[\, r_0 + \gamma\,(r_1 + \alpha \mathcal{H}_1)
# + \gamma^2 (r_2 + \alpha \mathcal{H}_2) + \dots \big] $$
#
# Take γ out of all terms but the first. What is left in the bracket is $r_1 + \gamma (r_2 + \alpha
# \mathcal{H}_2) + \dots$, whose mean is $Q(s_1, a_1)$, and $\alpha \mathcal{H}_1$:
#
# $$ Q(s_0, a_0) = \mathbb{E}\big[\, r_0 + \gamma \big( \textstyle\sum_a \pi(a|s_1)\, Q(s_1, a) +
# \alpha \mathcal{H}_1 \big) \big] = \mathbb{E}\big[\, r_0 + \gamma V(s_1) \big] $$
#
# This is the **soft Bellman equation**. The infinite sum is gone: the value of now is tied to the
# value one step later. So one transition is enough to learn from: the *target* is y, and the loss
# is the mean squared distance from it. $y - Q(s,a)$ is the **temporal difference**. To learn an
# estimate from an estimate, as V(s') is one, is called **bootstrapping**. (The paper's title uses
# the word in another sense: to start a learner with a rule's help.)
#
# $$ y = r + \gamma\, (1 - \text{terminated})\, V(s'), \qquad
# L_\text{critic} = \text{mean of } (Q(s,a) - y)^2 $$
#
# > **Predict.** Two episodes end. In one the pole fell. In the other the 500 pushes were over while
# > the pole stood. γ = 0.99, r = 1, and the critic's estimate of V(s') is 50. What is y in each?

# %%
predict(
    "discrete_sac.4",
    "y of the pole that fell, and of the one whose time was up",
    ["1 and 1", "1 and 50.5", "50.5 and 1", "50.5 and 50.5"],
)

# %% [markdown]
# **Exercise (5 min, ●○○).** Write the target.


# %%
def critic_target(reward, terminated, next_value, gamma):
    """y. reward, terminated (0 or 1), next_value: (batch,); gamma: float. Returns (batch,)."""
    # solution
    return reward + gamma * (1 - terminated) * next_value
    # end solution


check.critic_target(critic_target)

# %%
terminated = torch.tensor([1.0, 0.0])  # it fell; the time was up
print(bc.sac.critic_target(torch.ones(2), terminated, torch.tensor([50.0, 50.0]), 0.99).tolist())

# %% [markdown]
# **Explain.** The rewards end when the pole falls. A pole that still stands when the time is up
# would go on earning: the episode was cut off. So `terminated` is 1 for the first and 0 for the
# second. If you set it to 1 for both, the critic is told that the longest episodes end as badly as
# the shortest.

# %% [markdown]
# Two tricks make the estimates steadier. There are **two critics**, and V uses the smaller value
# of the two: the actor prefers actions that a critic overestimates, and the smaller of two
# estimates is too high less often. And V is computed with **target networks**, slow copies of the
# critics that take over a small share τ ("tau") of the new weights at each update. Without them,
# an update that moves a critic towards its target would at once move the target as well.
#
# **Exercise (8 min, ●●○).** Write the loss of both critics: for each of them the mean over the
# batch of $(Q(s,a) - y)^2$, and then the sum of the two. Here a is the action that was taken. The
# target is held fixed, and the check also looks at where the gradient goes.


# %%
def critic_loss(q_pair, action, target):
    """A scalar tensor. q_pair: (2, batch, actions), with gradients; action, target: (batch,)."""
    # solution: the exercise's own


check.critic_loss(critic_loss)

# %% [markdown]
# ## Round 3: what does the actor minimise?
#
# The actor is trained to make the soft value large, as the critics estimate it. Its loss is minus
# the soft value:
#
# $$ L_\text{actor} = -\,\text{mean over } s \text{ of } \sum_a \pi(a|s)\,
# \big(Q(s,a) - \alpha \log \pi(a|s)\big) $$
#
# > **Predict.** There are two ways to make V larger: a better policy, or higher estimates Q. What
# > happens if the gradient may change both?

# %%
predict(
    "discrete_sac.5",
    "If the gradient may change both",
    ["the policy gets better sooner", "both get better", "Q grows and nothing gets better"],
)

# %% [markdown]
# **Exercise (8 min, ●●○).** Write the actor's loss. The check also looks at where its gradient
# goes.


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
        loss = -bc.sac.soft_value(bc.sac.log_policy(logits), held, torch.tensor(1.0)).mean()
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
    pi, worth = logits.softmax(-1)[0].tolist(), q[0].tolist()
    print(f"{words:16} π = {pi[0]:.2f} {pi[1]:.2f}   Q = {worth[0]:.1f} {worth[1]:.1f}")

# %% [markdown]
# **Explain.** With Q held fixed, the actor finds the softmax of Round 1. If Q may move, the loss
# also falls when Q rises, although the actions are worth what they were worth before. So Q is
# **detached** (`q.detach()`): its value counts, and the gradient stops there.

# %% [markdown]
# ## Round 4: which temperature is right?
#
# That depends on how large Q is, which is not known before training. So SAC adjusts α as a
# thermostat adjusts the heating. You choose a **target entropy** η ("eta"), how undecided the
# policy should be on average. While the policy is more undecided than that, α falls; while it is
# less undecided, α rises.
#
# $$ L_\alpha = \alpha\, (\mathcal{H}(\pi) - \eta) $$
#
# **Exercise (5 min, ●●○).** Write it. The parameter is log α, so that α stays positive; again
# the check looks at the gradient.


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
    "discrete_sac.6",
    "With η = −1, α",
    ["falls, and stops at H = η", "rises for ever", "falls for ever", "moves up and down"],
)

# %%
most = np.log(9).item()  # nats: nine actions, all as likely
for h in (most, 1.0, 0.1, 0.0):
    log_alpha = torch.tensor(0.01).log().requires_grad_()
    gradients = []
    for eta in (-1.0, 0.3 * most):
        loss = bc.sac.temperature_loss(log_alpha, torch.tensor([h]), torch.tensor(eta))
        gradients.append(torch.autograd.grad(loss, log_alpha)[0].item())
    turns = ["falls" if gradient > 0 else "rises" for gradient in gradients]
    print(f"H = {h:.2f}: with η = -1 α {turns[0]}, with η = 0.66 α {turns[1]}")

# %% [markdown]
# **Explain.** For *continuous* actions a rule of thumb sets η to minus the dimension of the action:
# −1 for one that is a single number. There an entropy can be negative, since a density can be above
# 1. The entropy of a policy over a list of actions is 0 or more, so $\mathcal{H} - \eta \ge 1$ in
# every state, and α falls at each update. How fast? The optimiser, Adam, changes log α by about its
# learning rate at each update while the gradients stay the same.
# <!-- claim: 0 - SETTINGS.target_entropy == 1 -->
# But they do not stay the same: the gradient of the loss is $\alpha (\mathcal{H} - \eta)$, which
# shrinks as α falls. Adam divides each gradient by an average size of about the last thousand.
# These were larger, so the steps become smaller than the learning rate. With an entropy that stays
# 0, α is a tenth of its start after {{ cooling_updates(0.1) | , }} updates, and a hundredth
# after {{ cooling_updates(0.01) | , }}.
# <!-- claim: cooling_updates(0.1) > 1.5 * math.log(10) / SETTINGS.alpha_lr -->

# %% [markdown]
# ## Round 5: where does a batch come from?
#
# SAC keeps its transitions in a table, the **replay buffer**. Each update learns from rows of this
# table that are drawn **uniformly with replacement**: at each draw each row has the same chance, so
# a row can come twice in a batch. Most rows come from earlier policies. Learning from what
# another policy did is called **off-policy**. It works since the target asks what the *present*
# policy would do in s'. Why a table, and why at random? A row can be used more than once. And
# transitions that follow each other are alike: a batch of them would say little.
#
# > **Predict.** The buffer holds 1,000 rows, and a new row comes in for each batch of 64. In how
# > many batches does a row appear, on average, before it is thrown out?

# %%
predict(
    "discrete_sac.7",
    "Batches in which a row appears",
    ["fewer than 1", "1", "about 16", "64", "1,000"],
)

# %% [markdown]
# **Exercise (20 min, ●●●).** Write the buffer. It keeps the last `size` rows; a row is a tensor.
# When it is full, each new row replaces the oldest one. `sample` draws rows with the generator
# `rng`, uniformly with replacement. Your agents call `add` after each decision and `sample` at each
# update, thousands of times: do not copy the whole table.


# %%
class ReplayBuffer:
    """The last `size` rows."""

    def __init__(self, size):
        """size: the most rows that it holds."""
        # solution: the exercise's own

    def add(self, row):
        """Keep a row, a tensor (n,). A full buffer forgets its oldest row."""
        # solution: the exercise's own

    def sample(self, batch, rng):
        """Rows drawn at random: (batch, n). rng: a NumPy generator."""
        # solution: the exercise's own


check.ReplayBuffer(ReplayBuffer)

# %% [markdown]
# <details><summary>Compare with your prediction</summary>
#
# A row stays for 1,000 batches, and each batch draws 64 of 1,000 rows: it appears about 64 times.
# The size of the buffer cancels. What counts is how many rows are drawn for each new one.
#
# </details>
#
# ## The whole algorithm
#
# Now all parts are there. Which six of them have you written, and what is left?
#
# > **Soft actor-critic for a list of actions**
# >
# > Start with a policy π, two critics Q₁ and Q₂, their copies Q̄₁ and Q̄₂, a temperature α, and an
# > empty buffer. At each decision:
# >
# > 1. Draw the action a from π(·|s), and observe r, s' and whether the episode terminated. Keep the
# >    row (s, a, r, terminated, s') in the buffer.
# > 2. Draw a batch of rows from the buffer, uniformly with replacement.
# > 3. *Target:* y = r + γ (1 − terminated) V(s'), held fixed, where V(s') is the sum over the
# >    actions of π(a'|s') times (the smaller of both Q̄(s', a') − α log π(a'|s')).
# > 4. *Critics:* a gradient step on the mean of (Q₁(s, a) − y)² + (Q₂(s, a) − y)².
# > 5. *Actor:* a gradient step on minus the mean of V(s), with the smaller Q and α held fixed.
# > 6. *Temperature:* a gradient step in log α on α times (mean entropy of π − target entropy).
# > 7. *Copies:* Q̄ becomes (1 − τ) Q̄ + τ Q.
# >
# > Steps 2 to 7 are one **update**; our code computes the losses of 4 to 6 before it takes the
# > first of their steps. How many updates follow each decision is a setting.
#
# ## Round 6: how do the agents with your parts learn?
#
# Now train again, with your parts where they have passed. Six agents learn side by side. Three have
# the paper's η = {{ SETTINGS.target_entropy }}. Three have η = 0.3 log 2, about the entropy of "19
# to 1", which a policy with two actions can have.
# <!-- claim: abs(0.3 * math.log(2) - float(sac.entropy(torch.tensor([19 / 20, 1 / 20]).log()))) <
#   0.01 -->

# %%
agents = learners + bc.with_seeds(bc.settings_for("sac", **changes), 3)  # η = 0.21, and the paper's
noted = []


def note(training):
    if training.losses:  # what the last update returned
        noted.append(training.losses)


training = own_code.training(agents, PUSHES, make_env=checks.several(checks.cartpole))
training.run(callback=note, stop=lambda: training.decisions >= PUSHES * len(agents))
print(f"{len(noted):,} updates of {len(agents)} agents")

# %% tags=["hide-input"]
alpha = torch.stack([each["alpha"] for each in noted[::50]]).T.numpy()
updates = np.arange(len(noted))[::50]
named = {"sac, η = 0.21": alpha[:3], "η = −1": alpha[3:]}
title = "With η = −1 α falls; with η = 0.21 it rises where the entropy is below"
bc.show(charts.lines(updates, named, title, "update", "temperature α", logarithmic="y"))

# %% tags=["hide-input"]
state_entropy = torch.stack([each["entropy"] for each in noted]).T.numpy()
smooth = state_entropy[:, : len(noted) // 50 * 50].reshape(len(agents), -1, 50).mean(-1)
named = {"sac, η = 0.21": smooth[:3], "η = −1": smooth[3:]}
updates, marks = np.arange(smooth.shape[1]) * 50, {"target 0.21": TARGET, "0": 0.0}
title = "At the end, neither kind is at its target"
bc.show(charts.lines(updates, named, title, "update", "entropy (nats)", marks=marks))

# %%
results = checks.scores(training.result().agents, checks.cartpole, 20)
for i, (agent, score) in enumerate(zip(agents, results, strict=True)):
    eta = f"{agent.target_entropy:5.2f}"
    print(f"η = {eta}, seed {agent.seed}: balances for {score:5.1f} of 500 pushes", end="")
    print(f", α from {noted[0]['alpha'][i]:.4f} to {noted[-1]['alpha'][i]:.4f}")

# %% [markdown]
# **See.** With η = {{ SETTINGS.target_entropy }}, α falls from update to update, as Round 4 says it
# must. The scores say less: look at how far apart the seeds of *one* kind are before you conclude
# anything about the two kinds. If the line *Training with …* names your parts, these agents learned
# with your code.
# <!-- claim: 0 - SETTINGS.target_entropy > 0 -->
#
# **Explain.** Look at the agents with η = 0.21 as well. This thermostat has a target that it could
# reach, and in our run it **missed** it: the entropy of these small agents fell below 0.21 early
# and stayed there, while α rose to several times its start. (Compare your own figures.) We explain
# it like this: the policy grows more undecided only when α is no longer small beside the
# differences in Q, and these grow while the agent learns. So a target entropy is a wish. Whether
# the agent follows it has to be looked up in the curves.
#
# The experiment is also too short to show what a low temperature costs. As long as the curves of
# the entropy lie together, the two kinds are undecided to the same degree, whatever their α.
#
# Two things are known about a policy that has become sure. An action with a small probability is
# seldom tried. And the gradient of a softmax is proportional to π, so a small probability changes
# slowly. Is that why plain SAC stays in the trap? That alone does not explain it: on the road,
# {{ len(varied()['target entropy 0.3'].of('sac')) }} plain SAC agents were trained with η = 0.3 and
# {{ len(varied()['target entropy 1'].of('sac')) }} with η = 1, and
# {{ escaped_with('target entropy 0.3', 'sac') + escaped_with('target entropy 1', 'sac') }} of the
# {{ len(varied()['target entropy 0.3'].of('sac')) + len(varied()['target entropy 1'].of('sac')) }}
# escaped. Our default stays at the paper's η = {{ SETTINGS.target_entropy }}.
# <!-- claim: escaped_with('target entropy 0.3', 'sac') + escaped_with('target entropy 1', 'sac')
#   == 0 -->
#
# Does your code make the same update as ours? The next cell compares the losses and the gradients
# on one batch, for each of your parts:

# %%
own_code.compare()

# %% [markdown]
# **Try.** Plant a mistake: copy your `critic_target` into a new cell, leave out `(1 - terminated)`,
# and call `own_code.use(critic_target)`. From then on agents train with it, without a check. Run
# the training and the cell above again. Do the agents still learn? What does the comparison say?
# (`own_code.load()` brings back the part that passed.)

# %% [markdown]
# Here are the losses of SAC as the library computes them. Open them beside yours. The dots in a
# shape stand for any number of agents, which learn side by side; `constraint` belongs to lesson
# [[soft_constraint]].

# %% tags=["nbval-ignore-output"]
source("bootcourse.learn.sac", "soft_value", "critic_target", "critic_loss", "actor_loss")

# %% tags=["nbval-ignore-output"]
source("bootcourse.learn.sac", "temperature_loss", "min_q")

# %% [markdown]
# With a loop around them, these lines are a short program for one agent:
# `bootcourse/learn/textbook.py`. It also has two things that are still to come: the KL (lesson
# [[soft_constraint]]) and the demonstrations (lesson [[learning_from_demonstrations]]).
# `python -m bootcourse.learn.textbook` runs it.

# %% [markdown] tags=["instructor"] minutes=10
# How far does it get with more pushes? `python -m bootcourse.research.checks --only sac-cartpole`
# trains for 100,000 and compares with a published figure (some minutes). Let groups try η from 0 to
# 0.69 and collect the scores on the board: a histogram per η, seeds as crosses, teaches more than a
# mean.
# <!-- claim: '100,000' in CHECKS['sac-cartpole'].our_budget -->

# %% [markdown]
# ## What you now know
#
# 1. The soft value is the mean of Q under the policy plus α times its entropy; its best policy is
#    softmax(Q / α).
# 2. The critics are fitted to r + γ (1 − terminated) V(s'), the right side of the soft Bellman
#    equation, held fixed; an episode that ran out of time is not terminated.
# 3. The actor's loss is minus the soft value, with Q held fixed.
# 4. The temperature is a thermostat for the entropy of the policy. Over a list of actions that
#    entropy is 0 or more, so with η = {{ SETTINGS.target_entropy }} α falls at each update. A
#    target that can be reached may be missed all the same.
# 5. The buffer gives rows of earlier policies, drawn uniformly with replacement: SAC learns
#    off-policy.

# %%
best_of_three = "250 or more" if balanced.max() >= 250 else f"{balanced.max():.0f}"
nothing = "Q grows and nothing gets better"
compare_predictions(
    "discrete_sac",
    {1: best_of_three, 2: 0.0, 3: "1.44", 4: "1 and 50.5", 5: nothing}
    | {6: "falls for ever", 7: "64"},
)

# %% [markdown]
# **Three questions to think about**
# - What would η = log 9 do to an agent on the road?
# - In training the learner draws its actions from its policy; in the test it takes the most
#   probable one. Where could that matter?
# - V takes the smaller of two critics. What would happen with the larger?
#
# **Read on**: Haarnoja et al., *Soft Actor-Critic* (arXiv 1801.01290), and its second version with
# the thermostat (arXiv 1812.05905); Christodoulou, *Soft Actor-Critic for Discrete Action Settings*
# (arXiv 1910.07207); Xu et al., *Target Entropy Annealing for Discrete Soft Actor-Critic* (arXiv
# 2112.02852).

# %% [markdown] tags=["instructor"]
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
