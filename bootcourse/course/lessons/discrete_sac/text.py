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
# - say what the soft Bellman equation changes in the plain one;
# - write the soft value and the losses of critics, actor and temperature;
# - say where a gradient must stop, and which target entropy a thermostat can reach.
#
# **Time** 52 minutes. **It builds on** Python, a little torch, and the Bellman equation of lesson
# [[values]].

# %%
import bootcourse as bc
import numpy as np
import torch
from bootcourse.course import check, compare_predictions, predict, predicted, progress, table
from bootcourse.course.lessons.discrete_sac import diagrams, examples, explorable, figures
from bootcourse.learn import sac
from bootcourse.research.experiments import checks

progress("discrete_sac")

# %% [markdown]
# ## Look first
#
# Before the road, a smaller world: a pole stands on a cart. Fifty times a second you push the cart
# to the left or to the right. Each push pays 1, the last, too. The episode ends when the pole
# leans more than 12 degrees, when the cart leaves its track, or after 500 pushes. This is
# **CartPole**.
# <!-- claim: gym.make('CartPole-v1').unwrapped.tau == 1 / 50 -->
# <!-- claim: (lambda env: (env.reset(seed=0), [env.step(0)[1:3] for _ in range(11)])[1])(
#   gym.make('CartPole-v1')) == 10 * [(1, False)] + [(1, True)] -->
# <!-- claim: math.degrees(gym.make('CartPole-v1').unwrapped.theta_threshold_radians) == 12 -->
# <!-- claim: gym.spec('CartPole-v1').max_episode_steps == 500 -->

# %%
drivers = {
    "at random": bc.random_policy(np.random.default_rng(0), 2),  # of two actions
    "rule: one weighted sum": bc.teacher_policy(checks.balance, None, 2),
}
drives = {}
for label, driver in drivers.items():
    rows, pushes = checks.data(driver, checks.cartpole, 1, seed=0)
    drives[f"{label}: {pushes:.0f} pushes"] = rows[:, :4].numpy()
title = "One weighted sum balances this pole; chance does not"
bc.show(figures.cartpole_strip(drives, title))

# %% [markdown]
# The rule pushes to the right where a weighted sum of place, speed, angle and angular speed is
# positive. How can a program that starts at random learn this from rewards alone? Here you write its
# parts; the [next lesson](update_and_loop.ipynb) puts them together.

# %% [markdown]
# ## The parts in one picture

# %%
bc.show(diagrams.sac_diagram())

# %% [markdown]
# *Soft actor-critic* (SAC) has four parts:
#
# - The **actor** gives each action a probability, π(a|s): its **policy**.
# - Two **critics** estimate what each action is worth, Q(s, a), all later rewards included. The
#   smaller estimate counts.
# - The **temperature** α says how much the actor gains by staying undecided.
# - The **replay buffer** keeps what happened, a row for each decision. Each update learns from a
#   **batch** of rows.
#
# *Discrete* means that the actions can be counted: two here, nine on the road. So a network gives π
# and Q of every action at once, and a mean over actions needs no draw.
#
# On the evening route this picture is enough: go on to [the barrier](the_barrier.ipynb).

# %% [markdown] tags=["instructor"] minutes=3
# Follow one row of the buffer through the picture: who made it, and which three parts learn from
# it? Leave the picture on the wall; Round 3 asks which of its arrows carry a gradient.

# %% [markdown]
# ## Round 1: what is a state worth when entropy is rewarded?
#
# An agent can go left, straight or right. **Drag** the temperature α. At which end does it nearly
# always go straight, its best action, and what does it do at the other? How can the state be
# worth {{ WORTH | .2f }} at first, when its best action is worth {{ max(q) | g }}? (Nats are
# explained below.)

# %%
explorable.undecided()

# %% [markdown]
# Early estimates of Q are poor, so SAC pays a little for **exploration**: trying other actions, too.
# The policy's **entropy** says how undecided it is, in nats (natural logarithm):
#
# $$ \mathcal{H}(\pi(\cdot|s)) = -\sum_a \pi(a|s) \log \pi(a|s) $$
#
# An action that is never taken adds nothing (0 · log 0 = 0).
#
# > **Predict.** What is the smallest entropy that a policy can have? Can it be negative?

# %%
predict("discrete_sac.1", "What is the smallest entropy that a policy can have?", unit="nats")

# %%
predicted("discrete_sac.1")
rows = []
for words, pi in examples.POLICIES.items():
    h = sac.entropy(torch.tensor([pi]).log()).item()
    rows.append([words, f"{h:.3f}", f"{np.exp(h):.2f}"])
table(["policy", "entropy (nats)", "as undecided as this many equally likely actions"], rows)

# %% [markdown]
# **See.** The entropy lies between 0 and the logarithm of the number of actions. It is **never
# negative**, since no probability is above 1.
# <!-- claim: 0 == float(sac.entropy(torch.tensor([1.0]).log())) <
#   float(sac.entropy(torch.full((9,), 1 / 9).log())) < math.log(9) + 1e-6 -->
#
# The last column, $e^{\mathcal{H}}$, is the **effective number of actions** (the paper's Equations
# 21 and 22).
#
# What is a state worth? The **soft value** is the mean of Q under the agent's own policy, plus α for
# each nat of entropy.
#
# $$ V(s) = \sum_a \pi(a|s)\, Q(s,a) + \alpha\, \mathcal{H}(\pi(\cdot|s)) $$
#
# Of the panel's {{ WORTH | .2f }}, Q alone gives {{ BY_Q | .2f }}; the entropy pays the rest.
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
predict("discrete_sac.2", "At which α are both worth the same?", ["0.5", "0.693", "1", "1.44", "2"])

# %%
predicted("discrete_sac.2")
bc.show(figures.against_temperature([1.0, 3.0]))

# %% [markdown]
# **Explain.** The even policy loses 1 in Q and gets 0.693 α for its entropy: both have the same V
# at α = 1 / 0.693 = {{ 1 / math.log(2) | .2f }}. The best policy for an α is a
# *softmax*, $\pi(a|s) \propto \exp(Q(s,a)/\alpha)$: with a high α nearly even, with a low α nearly
# sure of one action.
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
# and came to s'. Lesson [[values]] answers with the Bellman equation:
#
# $$ Q(s, a) = r + \gamma \max_{a'} Q(s', a') $$
#
# In SAC the critic judges the policy π, not the best one, so the mean of Q under π takes the place of
# the largest Q. And s' pays α for each nat of entropy. Together they are its soft value:
#
# $$ Q(s, a) = \mathbb{E}\big[\, r + \gamma \big( \textstyle\sum_{a'} \pi(a'|s')\, Q(s', a') +
# \alpha \mathcal{H}(\pi(\cdot|s')) \big) \big] = \mathbb{E}\big[\, r + \gamma V(s') \big] $$
#
# This is the **soft Bellman equation**. $\mathbb{E}$ is the mean over what may follow. The entropy
# in s is not in it, because a is given.
#
# One transition gives one sample of the right side. Computed with the present estimates, it is the
# target y.

# %% [markdown]
# ### Where nothing follows
#
# One factor is missing. `terminated` is 1 if the *world* ends here, so that nothing could be earned
# from s' on; otherwise it is 0. The whole target and the critic's loss:
#
# $$ y = r + \gamma\, (1 - \text{terminated})\, V(s'), \qquad
# L_\text{critic} = \text{mean of } (Q(s,a) - y)^2 $$
#
# > **Predict.** In one episode the pole fell. In another it still stood after 500 pushes.
# > γ = 0.99, r = 1, and the critic's estimate of V(s') is 50. What is y for each last transition?

# %%
predict(
    "discrete_sac.3",
    "What is y of the pole that fell, and of the one whose time was up?",
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
predicted("discrete_sac.3")
terminated = torch.tensor([1.0, 0.0])  # it fell; the time was up
print(sac.critic_target(torch.ones(2), terminated, torch.tensor([50.0, 50.0]), 0.99).tolist())

# %% [markdown]
# **Explain.** A fallen pole earns nothing more. A pole that still stands would go on earning; only
# our clock stopped it, and the four numbers that the critic sees do not hold the clock.

# %% [markdown]
# ### Two critics
#
# Suppose that all actions are worth 0, and that each estimate errs by chance, on its own. **Drag**
# the number of actions to nine. How high is the highest estimate with one critic? And with the smaller of
# two?

# %%
explorable.overestimated()

# %% [markdown]
# The actor prefers what a critic overestimates, so V takes for each action the smaller value of
# **two critics**, which can be too low. And it uses **target critics** (or *target networks*), slow
# copies of both. They take over a small share τ ("tau") of the new weights at each update, so the
# target hardly moves while a critic steps towards it.
#
# **Exercise (6 min, ●●○).** Write the loss of both critics: for each the mean over the batch of
# $(Q(s,a) - y)^2$, then the sum of the two. Here a is the action that was taken. The target is held
# fixed, or the loss could fall by moving y, not Q: the check looks at gradients, too.


# %%
def critic_loss(q_pair, action, target):
    """A scalar tensor. q_pair: (2, batch, actions), with gradients; action, target: (batch,)."""
    # solution: the exercise's own


check.critic_loss(critic_loss)

# %% [markdown] tags=["instructor"] minutes=7
# Write a sum of three terms on the board, r₀ + γ (r₁ + α H₁) + γ² (r₂ + α H₂), take out γ, and let
# them say which part is V(s'). Then ask what would change if the row came from an older policy
# (nothing: a is given, and what follows is asked of the present policy). This is why the replay
# buffer may hold old rows.

# %% [markdown]
# ## Round 3: what does the actor minimise?
#
# The critics say what the present policy is worth (*policy evaluation*). The actor looks for a
# better policy, given these values (*policy improvement*). At each update SAC makes one small step of
# both. The actor's loss is minus the soft value:
#
# $$ L_\text{actor} = -\,\text{mean over } s \text{ of } \sum_a \pi(a|s)\,
# \big(Q(s,a) - \alpha \log \pi(a|s)\big) $$
#
# Two things make V larger: a better policy, or higher estimates Q. Which may the gradient change?
#
# > **Predict.** Two actions have Q = 1 and Q = 3; α = 1. Two policies, each a softmax of two numbers
# > (*logits*), are even at first. An optimiser lowers the loss: for one it moves the logits alone,
# > for the other Q, too. Which policy is worth more afterwards, by Q = 1 and 3?

# %%
choices = ["the one with Q held fixed", "the one whose Q moved, too", "both the same"]
predict("discrete_sac.4", "Which policy is worth more, by Q = 1 and 3?", choices)

# %% [markdown]
# **Exercise (5 min, ●●○).** Write the actor's loss.


# %%
def actor_loss(log_pi, q, alpha):
    """A scalar tensor. log_pi, q: (batch, actions); alpha: a tensor with one number, 0 or more.

    q is the smaller of the two critics' estimates.
    """
    # solution: the exercise's own


check.actor_loss(actor_loss)

# %%
predicted("discrete_sac.4")
rows = [
    ["Q held fixed", *examples.trained(lambda q: q.detach())],
    ["Q may move, too", *examples.trained(lambda q: q)],
]
table(["after 200 steps", "π(a₂)", "Q(a₁)", "Q(a₂)", "V by these Q", "V by Q = 1 and 3"], rows)

# %% [markdown]
# **Explain.** An actor that may move Q marks its own work (no critic's loss pulls Q back here): it
# raises Q, and its policy is worth less than the other by Q = 1 and 3. With Q held fixed, the actor
# finds the best policy of Round 1, with π(a₂) = e³ / (e + e³) = {{ SOFTMAX | .2f }}. So Q is **detached**
# (`q.detach()`): its value counts, and the gradient stops there.

# %% [markdown] tags=["instructor"] minutes=4
# Let them say, before the cell is run, what an actor would do that may also raise Q. Then ask which
# arrows of the picture carry a gradient, and where else one must stop (the target of the critics).

# %% [markdown]
# ## Round 4: which temperature is right?
#
# That depends on how far apart the actions' Q are, which is not known before training. So SAC adjusts
# α as a thermostat adjusts the heating, by a **target entropy** η ("eta"):
#
# $$ L_\alpha = \alpha\, (\mathcal{H}(\pi) - \eta) $$
#
# A gradient step lowers this loss: while the entropy is above η, α falls; while it is below, α
# rises.
#
# **Exercise (4 min, ●●○).** Write it. $\mathcal{H}(\pi)$ is the mean over the batch, held fixed.
# The parameter is log α, so that α stays positive.


# %%
def temperature_loss(log_alpha, state_entropy, target_entropy):
    """A scalar tensor. log_alpha, target_entropy: one number; state_entropy: (batch,), in nats."""
    # solution
    return log_alpha.exp() * (state_entropy.detach().mean() - target_entropy)
    # end solution


check.temperature_loss(temperature_loss)

# %% [markdown]
# The paper sets **η = {{ SETTINGS.target_entropy }}** for its nine actions, and so does our study.
#
# > **Predict.** At first the entropy is near log 9. What does α do from then on? Remember the range of
# > the entropy.

# %%
predict(
    "discrete_sac.5",
    "What does α do with η = −1?",
    ["falls, and stops at H = η", "rises for ever", "falls for ever", "moves up and down"],
)

# %%
predicted("discrete_sac.5")
explorable.thermostat()

# %% [markdown]
# **Explain.** The entropy over a list of actions is 0 or more, so it is at least 1 above η = −1 in
# every state. The thermostat turns in one direction only: α falls at each update, and SAC pays less
# and less for exploration. **Drag** η: where does α come to rest, and where does it rise for ever?
#
# Why then −1? The paper gives no reason. For *continuous* actions, whose entropy can be negative, a
# rule of thumb is minus the number of their dimensions; but the car has two, so it would give −2.
# <!-- claim: 0 - SETTINGS.target_entropy == 1 -->

# %% [markdown] tags=["instructor"] minutes=5
# The answer to discuss is "falls, and stops at η", as a thermostat in a room does. Ask which
# entropy would have to be reached. It helps to write the range, 0 to log 9, on the board before
# anybody answers.

# %%
compare_predictions(
    "discrete_sac",
    {1: 0.0, 2: "1.44", 3: "1 and 50.5", 4: choices[0], 5: "falls for ever"},
)

# %% [markdown]
# ## What you now know
#
# 1. The soft value is the mean of Q under the policy plus α times its entropy; its best policy is
#    softmax(Q / α).
# 2. The critics are fitted to r + γ (1 − terminated) V(s'), held fixed; an episode that ran out of
#    time is not terminated.
# 3. V(s') takes for each action the smaller value of the two target critics.
# 4. The actor's loss is minus the soft value, with Q held fixed.
# 5. The temperature is a thermostat for the entropy of n actions. It can come to rest only if η lies
#    between 0 and log n. With η = {{ SETTINGS.target_entropy }} α falls at each update.

# %% [markdown]
# **Three questions to think about**
# - What would η = log 9 do to an agent on the road?
# - The target holds V(s'), which the critics estimate. Suppose that it is ten times too high at
#   first. Does the error stay?
# - V takes the smaller of two critics. What would happen with the larger?
#
# **Read on**: Haarnoja et al., *Soft Actor-Critic* (arXiv 1801.01290), and with the thermostat
# (arXiv 1812.05905); Fujimoto et al. on two critics and target critics (TD3, arXiv 1802.09477);
# Christodoulou, *Soft Actor-Critic for Discrete Action Settings* (arXiv 1910.07207); Xu et al. on
# the target entropy of discrete SAC (arXiv 2112.02852).

# %% [markdown] tags=["instructor"] minutes=5
# *Answers to the three questions.* **η = log 9** is the largest entropy of nine actions. While the
# policy is not even, H < η and α rises, until entropy outweighs the differences in Q and the agent
# drives almost at random. **Ten times too high:** with exact values for each state the error
# shrinks by γ at each step from target to estimate, since y holds γ V(s'); rewards set the rest.
# With a network and old rows this is not certain: the next lesson shows a case. **The larger of
# two:** the actor looks for actions that one critic overestimates, the target then
# contains that error, and the estimates drive each other up (overestimation; Fujimoto et al., arXiv
# 1802.09477). The smaller one errs in the other direction, which feeds back less, since the actor
# takes underestimated actions less often.

# %% [markdown] tags=["instructor"]
# **On the board.** Q(s, a) = r + γ V(s'), with V written out below it; a dashed line through each
# place where no gradient passes.
#
# **To discuss.** The target is an estimate, too. Why does it help at all to learn an estimate from
# an estimate?
