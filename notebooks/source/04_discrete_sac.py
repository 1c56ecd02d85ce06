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
# # 4 · Discrete soft actor-critic
#
# **What you will be able to do**
# - work out the soft value of a state, and write the three losses that SAC is made of;
# - train six agents side by side on a pole that has to be balanced, and read their curves;
# - show why a target entropy of {{ SETTINGS.target_entropy }} can only cool an agent with nine
#   actions, and choose a better one.
#
# **Time** 55 minutes, about one of them the machine's. **You need** Python and a little torch;
# states, actions and rewards as in lesson 1.

# %%
import bootcourse as bc
import numpy as np
import torch
from bootcourse.lessons import charts, check, figures, source
from bootcourse.study import checks

# %% [markdown]
# ## Look first
#
# Before the road, a smaller world. A pole stands on a cart. Each fiftieth of a second you push
# the cart to the left or to the right: two actions. Each push pays 1 while the pole stands. It is
# over when the pole leans more than 12 degrees, when the cart leaves its track, or after 500
# pushes. This is **CartPole**, on which nearly everybody tries a learner first.
# <!-- claim: gym.make('CartPole-v1').unwrapped.tau == 1 / 50 -->
# <!-- claim: (lambda env: (env.reset(seed=0), env.step(0))[1][1])(gym.make('CartPole-v1')) == 1 -->
# <!-- claim: math.degrees(gym.make('CartPole-v1').unwrapped.theta_threshold_radians) == 12 -->
# <!-- claim: gym.spec('CartPole-v1').max_episode_steps == 500 -->

# %%
rng = np.random.default_rng(0)


def at_random(observations):
    return rng.integers(2, size=len(observations))


drives = {}
for label, driver in (("at random", at_random), ("rule: push where it falls", checks.balance)):
    rows, returns = checks.collect(driver, checks.cartpole, 1, seed=0)
    drives[f"{label}: {returns[0]:.0f} pushes"] = rows[:, :4].numpy()
title = "One line of code balances the pole; chance does not"
bc.show(figures.cartpole_strip(drives, title))

# %% [markdown]
# > **Predict.** The second driver is one line that somebody wrote. A learner knows nothing of
# > poles: it sees four numbers and is paid 1 or nothing. Give it 16,000 pushes to learn from. How
# > long will it balance then: for about 20 pushes, 200, or all 500?

# %% [markdown]
# ## Round 1: what is a state worth to somebody who likes a choice?
#
# The learner has two parts. An **actor** gives each action a probability, $\pi(a|s)$: its
# **policy**. A **critic** guesses what each action is worth from here on, $Q(s,a)$. Both are small
# neural networks.
#
# *Soft* actor-critic (SAC) adds something: the learner is paid a little for staying undecided.
# How undecided it is, is the **entropy** of its policy, in nats (natural logarithm):
#
# $$ \mathcal{H}(\pi(\cdot|s)) = -\sum_a \pi(a|s) \log \pi(a|s) $$
#
# > **Predict.** What is the entropy of a policy that is sure of one action? Of an even choice
# > between two? Between nine? Can it be negative?

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
# **See.** Between 0 and the logarithm of the number of actions, and **never negative**, since no
# probability is above 1. Remember that. It will decide Round 4.
# <!-- claim: 0 == float(sac.entropy(torch.tensor([1.0]).log())) <
#   float(sac.entropy(torch.full((9,), 1 / 9).log())) < math.log(9) + 1e-6 -->
#
# **Exercise 4.1 (3 min, ●○○).** Write the entropy of each policy in a batch.


# %%
def entropy(log_pi):
    """H(π(·|s)) in nats. log_pi: (batch, actions), log π(a|s). Returns (batch,)."""
    # solution
    return -(log_pi.exp() * log_pi).sum(-1)
    # end solution


check.entropy(entropy)

# %% [markdown]
# The **soft value** of a state is what the actor can expect there: the mean of Q under its own
# policy, plus the entropy, at a price of α for each nat. α is the **temperature**.
#
# $$ V(s) = \sum_a \pi(a|s)\, Q(s,a) + \alpha\, \mathcal{H}(\pi(\cdot|s)) $$
#
# > **Predict.** Two actions, worth 1 and 3. A policy that is sure of the better one, and an even
# > one. At which α are they worth the same? (The entropy of the even one is 0.693.)

# %%
q = torch.tensor([[1.0, 3.0]])
for alpha in (0.1, 1.0, 1.4427, 2.0):
    values = [
        bc.sac.soft_value(torch.tensor([pi]).log(), q, torch.tensor(alpha)).item()
        for pi in ([1e-12, 1.0], [0.5, 0.5])
    ]
    print(f"α = {alpha:6}: sure {values[0]:.2f}, even {values[1]:.2f}")

# %% [markdown]
# **Explain.** The even one gives away 1 in Q and gets 0.693 α for it. The best policy lies between
# the two: a *softmax*, $\pi(a|s) \propto \exp(Q(s,a)/\alpha)$. A high α is nearly even, a low one
# nearly sure. That is what the word temperature is borrowed for.

# %%
temperatures = np.geomspace(0.1, 30, 60)
best = [torch.softmax(q[0] / alpha, 0)[1].item() for alpha in temperatures]
title = "The colder, the surer: the best policy for Q = 1 and Q = 3"
label = "probability of the better action"
bc.show(
    charts.lines(
        temperatures, {"softmax(Q / α)": best}, title, "temperature α", label, logarithmic="x"
    )
)

# %% [markdown]
# **Exercise 4.2 (5 min, ●○○).** Write the soft value.


# %%
def soft_value(log_pi, q, alpha):
    """V(s). log_pi, q: (batch, actions); alpha: a tensor with one number. Returns (batch,)."""
    # solution
    return (log_pi.exp() * (q - alpha * log_pi)).sum(-1)
    # end solution


check.soft_value(soft_value)

# %% [markdown] tags=["instructor"] minutes=10
# Those who know continuous SAC will want to sample an action and use Q − α log π of it. With two
# or nine actions the expectation is a sum of so many terms: nothing is sampled, and the target has
# no noise from the policy. Ask what that noise would have cost (the variance of Q under π).

# %% [markdown]
# ## Round 2: the critic
#
# The critic learns from **transitions**: in state s the learner did a, was paid r, and came to s'.
# What should $Q(s,a)$ have been? The pay, and what the next state is worth, discounted by γ:
#
# $$ y = r + \gamma\, (1 - \text{terminated})\, V(s'), \qquad
# L_\text{critic} = \text{mean of } (Q(s,a) - y)^2 $$
#
# > **Predict.** Two episodes end in the same state. In one the pole fell. In the other the 500
# > pushes were over. γ = 0.99, r = 1, and the critic holds V(s') for 50. What is y in each?

# %%
terminated = torch.tensor([1.0, 0.0])  # it fell; the time was up
print(bc.sac.critic_target(torch.ones(2), terminated, torch.tensor([50.0, 50.0]), 0.99).tolist())

# %% [markdown]
# **Explain.** A pole that fell has no future. A pole that still stands when we stop watching has
# one, we only do not see it. So `terminated` is 1 for the first and 0 for the second. Mix them up,
# and the learner thinks that its best states are its last.
#
# **Exercise 4.3 (5 min, ●○○).** Write the target.


# %%
def critic_target(reward, terminated, next_value, gamma):
    """y. reward, terminated (0 or 1), next_value: (batch,); gamma: float. Returns (batch,)."""
    # solution
    return reward + gamma * (1 - terminated) * next_value
    # end solution


check.critic_target(critic_target)

# %% [markdown]
# Two tricks keep this from running away. There are **two critics**, and V uses the smaller value
# of the two, because a single critic that errs upwards is believed. And V is computed with
# **target networks**, slow copies of the critics that take over a small share τ ("tau") of the new
# weights at each update: nobody can hit a target that runs along.

# %% [markdown]
# ## Round 3: the actor
#
# The actor wants states to be worth much to it, as the critic sees them. Its loss is minus the
# soft value:
#
# $$ L_\text{actor} = -\,\text{mean over } s \text{ of } \sum_a \pi(a|s)\,
# \big(Q(s,a) - \alpha \log \pi(a|s)\big) $$
#
# > **Predict.** There are two ways to make V larger: a better policy, or a rosier Q. What happens
# > if you let the gradient take both?

# %%
learned = {}
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
# **Explain.** With Q held fixed, the actor finds the softmax of Round 1. If Q may move, the actor
# talks the critic into believing that all is well. So Q is **detached**: its value counts, but no
# gradient goes into it.
#
# **Exercise 4.4 (8 min, ●●○).** Write the actor's loss. The check also looks at where its gradient
# goes.


# %%
def actor_loss(log_pi, q, alpha):
    """A scalar tensor. log_pi, q: (batch, actions); alpha: a tensor with one number."""
    # solution
    value = (log_pi.exp() * (q.detach() - alpha * log_pi)).sum(-1)
    return -value.mean()
    # end solution


check.actor_loss(actor_loss)

# %% [markdown]
# ## Round 4: the temperature
#
# Which α is right? Nobody knows beforehand: it depends on how large Q is. So SAC turns α as one
# turns a thermostat. You name a **target entropy** η ("eta"), how undecided the policy should be on
# average. While it is more undecided than that, α falls; while it is less, α rises.
#
# $$ L_\alpha = \alpha\, (\mathcal{H}(\pi) - \eta) $$
#
# **Exercise 4.5 (5 min, ●●○).** Write it. The parameter is log α, so that α stays positive; again
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
most = np.log(9).item()  # nats: nine actions, all as likely
for h in (most, 1.0, 0.1, 0.0):
    log_alpha = torch.tensor(0.01).log().requires_grad_()
    slopes = []
    for eta in (-1.0, 0.3 * most):
        loss = bc.sac.temperature_loss(log_alpha, torch.tensor([h]), torch.tensor(eta))
        slopes.append(torch.autograd.grad(loss, log_alpha)[0].item())
    turns = ["falls" if slope > 0 else "rises" for slope in slopes]
    print(f"H = {h:.2f}: with η = -1 α {turns[0]}, with η = 0.66 α {turns[1]}")

# %% [markdown]
# **Explain.** {{ SETTINGS.target_entropy }} is a rule of thumb for *continuous* actions (minus
# their number). There an entropy can be negative, since a density can be above 1. A policy over a
# list of actions cannot get there: $\mathcal{H} - \eta \ge 1$, always. The thermostat is set to a
# temperature that no room can have. It turns down, and down. How fast? The optimiser, Adam, changes
# log α by up to its learning rate at each update.
# <!-- claim: 0 - SETTINGS.target_entropy == 1 -->

# %%
settings = bc.Settings()
for part in (10, 100):
    updates = np.log(part) / settings.alpha_lr
    print(f"α can be a {'tenth' if part == 10 else 'hundredth'} after {updates:,.0f} updates")

# %% [markdown]
# ## Round 5: train
#
# Six agents learn CartPole side by side, from different random starts, with the losses above. Three
# have η = {{ SETTINGS.target_entropy }}. Three have η = 0.3 log 2, about the entropy of "19 to 1",
# which a policy with two actions can have. Each tries 16,000 pushes.
# <!-- claim: abs(0.3 * math.log(2) - float(sac.entropy(torch.tensor([19 / 20, 1 / 20]).log()))) <
#   0.01 -->
#
# > **Predict.** Draw α over the updates for both kinds. And: which kind will balance better at the
# > end?

# %%
SEEDS, PUSHES = 3, 16_000
changes = {"gamma": 0.99, "tau": 0.05}  # looks 100 pushes ahead; targets that follow faster
target = 0.3 * np.log(2).item()
agents = bc.with_seeds(bc.settings_for("sac", target_entropy=target, **changes), SEEDS)
agents += bc.with_seeds(bc.settings_for("sac", **changes), SEEDS)  # η = -1, the paper's
noted = []


def note(training):
    if training.losses:  # what the last update returned
        noted.append(training.losses)


learner = checks.train(agents, checks.cartpole, PUSHES, progress=True, callback=note)
print(f"{len(noted):,} updates of {len(agents)} agents")

# %%
alpha = torch.stack([each["alpha"] for each in noted[::50]]).T.numpy()
updates = np.arange(len(noted))[::50]
named = {"sac: η = 0.21": alpha[:SEEDS], "η = −1": alpha[SEEDS:]}
title = "With η = −1 the temperature knows one direction"
bc.show(charts.lines(updates, named, title, "update", "temperature α", logarithmic="y"))

# %%
state_entropy = torch.stack([each["entropy"] for each in noted]).T.numpy()
smooth = state_entropy[:, : len(noted) // 50 * 50].reshape(len(agents), -1, 50).mean(-1)
named = {"sac: η = 0.21": smooth[:SEEDS], "η = −1": smooth[SEEDS:]}
title = "The entropy of a policy never reaches −1"
updates = np.arange(smooth.shape[1]) * 50
bc.show(
    charts.lines(
        updates, named, title, "update", "entropy (nats)", marks={"target 0.21": target, "0": 0.0}
    )
)

# %%
results = checks.scores(learner, checks.cartpole, 20)
for i, (agent, score) in enumerate(zip(agents, results, strict=True)):
    eta = f"{agent.target_entropy:5.2f}"
    print(f"η = {eta}, seed {agent.seed}: balances for {score:5.1f} of 500 pushes", end="")
    print(f", α from {noted[0]['alpha'][i]:.4f} to {noted[-1]['alpha'][i]:.4f}")

# %%
best, worst = int(results.argmax()), int(results.argmin())
drives = {}
for i in (worst, best):
    rows, returns = checks.collect(checks.actor_of(learner, i), checks.cartpole, 1, seed=0)
    drives[f"agent {i} (η = {agents[i].target_entropy:.2f}): {returns[0]:.0f} pushes"] = rows[
        :, :4
    ].numpy()
title = "The worst and the best of the six, from the same start"
bc.show(figures.cartpole_strip(drives, title, every=20))

# %% [markdown]
# **See.** Compare with your predictions. The temperature does what the algebra says, in every seed.
# The scores are another matter: look at how far apart the seeds of *one* kind are before you
# conclude anything about the two kinds.
#
# **Explain.** CartPole forgives a cold learner: two actions, and a pay that points the way at every
# push. There is little to explore. On the road there is: nine actions, and a way out that begins
# with a loss. An agent that has become cold before it has seen the way out will not look for it any
# more. And a softmax that has become sure learns slowly: its slope is proportional to π, so an
# action that is hardly ever taken is hardly ever reconsidered. We keep η =
# {{ SETTINGS.target_entropy }} as the default, because it is what the paper says, and always show
# what it does.

# %% [markdown]
# That was all of SAC. On one page, as the library computes it (the dots stand for "of any number of
# agents"; `constraint` is lesson 7's):

# %% tags=["nbval-ignore-output"]
source("bootcourse.learn.sac", "soft_value", "critic_target", "critic_loss", "actor_loss")

# %% tags=["nbval-ignore-output"]
source("bootcourse.learn.sac", "temperature_loss", "min_q")

# %% [markdown]
# These lines, and a loop from reset to update around them, are one short program for one agent:
# `bootcourse/learn/textbook.py`. Open it beside this lesson. Two things in it are still to come:
# the KL (lesson 7) and the demonstrations (lesson 8). `python -m bootcourse.learn.textbook` trains
# it.

# %% [markdown] tags=["instructor"] minutes=10
# How far does it get with more pushes? `python -m bootcourse.study.checks --only sac-cartpole`
# trains for 100,000 and compares with a published figure (some minutes). Let groups try η from 0 to
# 0.69 and collect the scores on the board: a histogram per η, seeds as crosses, teaches more than a
# mean.
# <!-- claim: '100,000' in CHECKS['sac-cartpole'].our_budget -->

# %% [markdown]
# ## What you now know
#
# 1. The soft value is the mean of Q under the policy plus α times its entropy; its best policy is
#    softmax(Q / α).
# 2. The critic follows r + γ (1 − terminated) V(s'); an episode that ran out of time is not over.
# 3. The actor follows minus the soft value, with Q held fixed.
# 4. The temperature is a thermostat for the entropy.
# 5. The entropy of a policy over a list of actions is never negative: with η =
#    {{ SETTINGS.target_entropy }}, α can only fall.
#
# **Three questions to think about**
# - What would η = log 9 do to an agent on the road?
# - The learner is tested with its most probable action, but trains with drawn ones. Where could
#   that matter?
# - V takes the smaller of two critics. What would a learner become that takes the larger?
#
# **Read on**: Haarnoja et al., *Soft Actor-Critic* (arXiv 1801.01290), and its second version with
# the thermostat (arXiv 1812.05905); Christodoulou, *Soft Actor-Critic for Discrete Action Settings*
# (arXiv 1910.07207); Xu et al., *Target Entropy Annealing for Discrete Soft Actor-Critic* (arXiv
# 2112.02852).
