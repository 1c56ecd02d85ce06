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
# - derive what a critic should have estimated: the soft Bellman equation;
# - write the soft value and the losses of critics, actor and temperature;
# - say where a gradient must stop, and which target entropy a thermostat can reach.
#
# **Time** 54 minutes. **It builds on** Python, a little torch, and the states, actions and rewards
# of lesson [[the_trap]]. The next lesson, [](update_and_loop.ipynb), makes an agent of these parts.

# %%
import bootcourse as bc
import numpy as np
import torch
from bootcourse.course import (
    charts,
    check,
    compare_predictions,
    predict,
    predicted,
    progress,
    table,
)
from bootcourse.course.lessons.discrete_sac import diagrams, explorable, figures
from bootcourse.learn import sac
from bootcourse.research.experiments import checks

progress("discrete_sac")

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
    "rule: one weighted sum": bc.teacher_policy(checks.balance, None, 2),
}
drives = {}
for label, driver in drivers.items():
    rows, pushes = checks.data(driver, checks.cartpole, 1, seed=0)
    drives[f"{label}: {pushes:.0f} pushes"] = rows[:, :4].numpy()
title = "One weighted sum balances the pole; chance does not"
bc.show(figures.cartpole_strip(drives, title))

# %% [markdown]
# The rule pushes to the right where 0.1 · place + 0.3 · speed + 0.1 · angle + 0.3 · angular speed
# is positive. (The angle counts in tenths of a radian.) How does a program that starts at random
# learn to push as well as that rule, from rewards alone?
# <!-- claim: checks.CARTPOLE_SCALES == (1.0, 1.0, 0.1, 1.0) -->
# <!-- claim: pushes((0.1, 0.3, 0.1, 0.3)) == 500 -->

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
# - The **temperature** α says how much the actor gains by staying undecided.
# - The **replay buffer** keeps what happened, a row for each decision. Each update learns from a
#   **batch** of rows: critics, actor and temperature alike.
#
# SAC was made for *continuous* actions, such as any angle of the wheel: there its actor draws
# actions, and means over actions are estimated from those. *Discrete* means that the actions can be
# counted: two here, nine on the road. So a network gives π and Q of every action at once, and a
# mean over actions is an exact sum.
#
# On the evening route this picture is enough: go on to [the barrier](the_barrier.ipynb).

# %% [markdown] tags=["instructor"] minutes=3
# Follow one row of the buffer through the picture: who made it, and which three parts learn from
# it? Leave the picture on the wall; Round 3 asks which of its arrows carry a gradient.

# %% [markdown]
# ## Round 1: what is a state worth when entropy is rewarded?
#
# **Drag** the temperature α. (The title counts with the formulas below.) Going straight is worth
# most here: at which end does the agent nearly always go straight, and what does it do at the other
# end?

# %%
explorable.undecided()

# %% [markdown]
# Early estimates of Q are poor, so an agent that takes only what it now thinks best may not find
# out that something else is better. To go on trying other actions is **exploration**, and SAC adds
# a small reward for it: an undecided policy earns more. The policy's **entropy** says how undecided
# it is, in nats (natural logarithm):
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
for words, pi in (
    ("sure of one of two", [1 - 1e-9, 1e-9]),
    ("two, 19 to 1", [0.95, 0.05]),
    ("two, 3 to 1", [0.75, 0.25]),
    ("two, even", [0.5, 0.5]),
    ("nine, even", [1 / 9] * 9),
):
    h = sac.entropy(torch.tensor([pi]).double().log()).item()
    rows.append([words, f"{h:.3f}", f"{np.exp(h):.2f}"])
table(["policy", "entropy (nats)", "as undecided as this many equally likely actions"], rows)

# %% [markdown]
# **See.** The entropy lies between 0 and the logarithm of the number of actions. It is **never
# negative**, since no probability is above 1.
# <!-- claim: 0 == float(sac.entropy(torch.tensor([1.0]).log())) <
#   float(sac.entropy(torch.full((9,), 1 / 9).log())) < math.log(9) + 1e-6 -->
#
# The **soft value** of a state is what the agent expects from there on: the mean of Q under its own
# policy, plus α for each nat of entropy.
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
predict("discrete_sac.2", "At which α are both worth the same?", ["0.5", "0.693", "1", "1.44", "2"])

# %%
predicted("discrete_sac.2")
q, alphas, values = torch.tensor([[1.0, 3.0]]), np.linspace(0, 3, 31), {}
for words, pi in (("the sure policy", [1e-12, 1.0]), ("the even policy", [0.5, 0.5])):
    log_pi = torch.tensor([pi]).log()
    values[words] = [sac.soft_value(log_pi, q, torch.tensor(alpha)).item() for alpha in alphas]
values["the best policy"] = [(a * torch.logsumexp(q / a, -1)).item() if a else 3.0 for a in alphas]
title = f"Above α = {1 / np.log(2):.2f} the even policy beats the sure one; the best beats both"
bc.show(charts.lines(alphas, values, title, "temperature α", "soft value V"))

# %% [markdown]
# **Explain.** The even policy loses 1 in Q and gets 0.693 α for its entropy: both have the same V
# at α = 1 / 0.693 = {{ 1 / math.log(2) | .2f }}. The best policy lies between the two: it is a
# *softmax*, $\pi(a|s) \propto \exp(Q(s,a)/\alpha)$. With a high α this policy is nearly even, with
# a low α it is nearly sure of one action. So with α > 0 the best policy of SAC is not the one that
# earns most: it gives up some Q for entropy.
#
# <details><summary>Why a softmax?</summary>
#
# Move a little probability ε from action b to action a. The value changes by
# $\varepsilon\,[(Q_a - \alpha\log\pi_a) - (Q_b - \alpha\log\pi_b)]$. At the best policy no such
# move gains anything, so $Q_a - \alpha\log\pi_a$ is the same number Z for each action, and
# $\log\pi_a = (Q_a - Z)/\alpha$. Put into V, the mean of Z under π, this gives the best soft value:
# $V = Z = \alpha \log \sum_a \exp(Q_a / \alpha)$, a *soft maximum* of Q.
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
# mean of all that follows the action if the agent goes on with its policy π, where each later state
# also earns α times its entropy:
#
# $$ Q(s_0, a_0) = \mathbb{E}\big[\, r_0 + \gamma\,(r_1 + \alpha \mathcal{H}_1) +
# \gamma^2 (r_2 + \alpha \mathcal{H}_2) + \dots \big] $$
#
# $\mathbb{E}$ is the mean over what may follow. The sum has no $\mathcal{H}_0$, because $a_0$ is
# given. Every term after the first has a factor γ; take it out. The bracket then holds $\alpha
# \mathcal{H}_1$ and a sum of the same form that starts in $s_1$. The mean of that sum is $Q(s_1,
# a_1)$. Since $a_1$ is drawn from π, average $Q(s_1, a_1)$ over π:
#
# $$ Q(s_0, a_0) = \mathbb{E}\big[\, r_0 + \gamma \big( \textstyle\sum_a \pi(a|s_1)\, Q(s_1, a) +
# \alpha \mathcal{H}_1 \big) \big] = \mathbb{E}\big[\, r_0 + \gamma V(s_1) \big] $$
#
# This is the **soft Bellman equation**. Where lesson [[values]] takes the best action, it takes the
# mean under π, plus the entropy; one transition gives one sample of its right side. That side,
# computed with the present estimates, is the **target** y, and the loss is the mean squared
# distance from it. $y - Q(s,a)$ is the **temporal difference**. Learning an estimate from an
# estimate is called **bootstrapping**. The paper's title means another thing: to start with a
# rule's help.
#
# > **Predict.** r = 1, γ = 0.9, α = 0.5, and in s' an even policy over two actions with Q = 4 and
# > Q = 6. What is the target y = r + γ V(s')?

# %%
predict("discrete_sac.3", "What is the target y?", unit="")

# %%
predicted("discrete_sac.3")
v = sac.soft_value(torch.tensor([[0.5, 0.5]]).log(), torch.tensor([[4.0, 6.0]]), torch.tensor(0.5))
y = (1 + 0.9 * v).item()
print(f"V(s') = 5 + 0.5 · {np.log(2):.3f} = {v.item():.2f}, so y = 1 + 0.9 · V(s') = {y:.2f}")

# %% [markdown]
# ### Where nothing follows
#
# One factor is missing. `terminated` is 1 if the *world* ends here, so that nothing could be earned
# from s' on, whatever the agent did; otherwise it is 0. The whole target and the loss:
#
# $$ y = r + \gamma\, (1 - \text{terminated})\, V(s'), \qquad
# L_\text{critic} = \text{mean of } (Q(s,a) - y)^2 $$
#
# > **Predict.** In one episode the pole fell. In another it still stood after 500 pushes.
# > γ = 0.99, r = 1, and the critic's estimate of V(s') is 50. What is y for each last transition?

# %%
predict(
    "discrete_sac.4",
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
predicted("discrete_sac.4")
terminated = torch.tensor([1.0, 0.0])  # it fell; the time was up
print(sac.critic_target(torch.ones(2), terminated, torch.tensor([50.0, 50.0]), 0.99).tolist())

# %% [markdown]
# **Explain.** A fallen pole earns nothing more. A pole that still stands would go on earning; only
# our clock stopped it, and the four numbers that the critic sees do not hold the clock. With
# `terminated` = 1 the same push in the same upright state would have to be worth 50.5 in the middle
# of an episode and 1 at its end.

# %% [markdown]
# Two tricks keep the estimates in check. V uses the smaller value of **two critics**, because the
# actor prefers actions that a critic overestimates. And V is computed with **target networks**,
# slow copies of the critics. They take over a small share τ ("tau") of the new weights at each
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
# and what follows is asked of the present policy). This is why the replay buffer may hold old rows.

# %% [markdown]
# ## Round 3: what does the actor minimise?
#
# The critics say what the present policy is worth (*policy evaluation*). The actor looks for a
# better policy, given these values (*policy improvement*): it makes the soft value large. At each
# update SAC makes one small step of both. The actor's loss is minus the soft value:
#
# $$ L_\text{actor} = -\,\text{mean over } s \text{ of } \sum_a \pi(a|s)\,
# \big(Q(s,a) - \alpha \log \pi(a|s)\big) $$
#
# Two things make V larger: a better policy, or higher estimates Q. Which may the gradient change?
# Below, a policy is a softmax of one number for each action, its *logits*.
#
# **Exercise (5 min, ●●○).** Write the actor's loss.


# %%
def actor_loss(log_pi, q, alpha):
    """A scalar tensor. log_pi, q: (batch, actions); alpha: a tensor with one number, 0 or more.

    q is the smaller of the two critics' estimates.
    """
    # solution: the exercise's own


check.actor_loss(actor_loss)

# %%
rows = []
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
    rows.append([words, *(f"{number:.2f}" for number in pi + worth)])
table(["after 200 steps", "π(a₁)", "π(a₂)", "Q(a₁)", "Q(a₂)"], rows)

# %% [markdown]
# **Explain.** With Q held fixed, the actor finds the softmax of Round 1 (of Q = 1 and 3 at α = 1:
# {{ 1 / (1 + math.exp(2)) | .2f }} and {{ 1 / (1 + math.exp(-2)) | .2f }}). If Q may move, the loss
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
# A gradient step lowers the loss: where $\mathcal{H} > \eta$ by a smaller α, where $\mathcal{H} <
# \eta$ by a larger one.
#
# **Exercise (4 min, ●●○).** Write it. $\mathcal{H}(\pi)$ is the mean over the batch. The parameter
# is log α, so that α stays positive.


# %%
def temperature_loss(log_alpha, state_entropy, target_entropy):
    """A scalar tensor. log_alpha, target_entropy: one number; state_entropy: (batch,), in nats."""
    # solution
    return log_alpha.exp() * (state_entropy.detach().mean() - target_entropy)
    # end solution


check.temperature_loss(temperature_loss)

# %% [markdown]
# The paper sets **η = {{ SETTINGS.target_entropy }}**, in a table, for its nine actions; the agents
# of our study have it, too.
#
# > **Predict.** Remember the range of the entropy. In which direction does this thermostat turn,
# > and when does it stop?

# %%
predict(
    "discrete_sac.5",
    "What does α do with η = −1?",
    ["falls, and stops at H = η", "rises for ever", "falls for ever", "moves up and down"],
)

# %%
predicted("discrete_sac.5")
most, rows = np.log(9).item(), []  # nats: nine actions, all as likely
for h in (most, 1.0, 0.1, 0.0):
    log_alpha = torch.tensor(0.01).log().requires_grad_()
    gradients = []
    for eta in (-1.0, 0.3 * most):
        loss = sac.temperature_loss(log_alpha, torch.tensor([h]), torch.tensor(eta))
        gradients.append(torch.autograd.grad(loss, log_alpha)[0].item())
    rows.append([f"{h:.2f}", *("falls" if gradient > 0 else "rises" for gradient in gradients)])
table(["entropy H", "α with η = −1", "α with η = 0.66"], rows)

# %% [markdown]
# **Explain.** With η = −1 the thermostat turns in one direction only: the entropy of a policy over
# a list of actions is 0 or more, so $\mathcal{H} - \eta$ is at least 1 in every state, and α falls
# at each update. As α falls, the best policy softmax(Q / α) becomes sure of one action: entropy
# pays less and less. The second η of the cell, 0.66, is three tenths of the largest entropy: there
# α turns, as a thermostat should.
#
# Why then −1? The paper gives no reason. Perhaps it comes from a rule of thumb for *continuous*
# actions, which gives −1 for an action that is a single number. There an entropy can be negative.
# <!-- claim: 0 - SETTINGS.target_entropy == 1 -->

# %% [markdown] tags=["instructor"] minutes=5
# The answer to discuss is "falls, and stops at η", as a thermostat in a room does. Ask which
# entropy would have to be reached. It helps to write the range, 0 to log 9, on the board before
# anybody answers.

# %%
compare_predictions(
    "discrete_sac", {1: 0.0, 2: "1.44", 3: round(y, 2), 4: "1 and 50.5", 5: "falls for ever"}
)

# %% [markdown]
# ## What you now know
#
# 1. The soft value is the mean of Q under the policy plus α times its entropy; its best policy is
#    softmax(Q / α).
# 2. The critics are fitted to r + γ (1 − terminated) V(s'), held fixed; an episode that ran out of
#    time is not terminated.
# 3. V(s') comes from the smaller of two critics, because an actor picks what is overestimated, and
#    from their slow copies, so that the target hardly moves with each step.
# 4. The actor's loss is minus the soft value, with Q held fixed.
# 5. The temperature is a thermostat for the entropy, which over a list of actions is 0 or more:
#    with η = {{ SETTINGS.target_entropy }} α falls at each update.

# %% [markdown]
# **Three questions to think about**
# - What would η = log 9 do to an agent on the road?
# - The target holds V(s'), which the critics estimate. Suppose that it is ten times too high at
#   first. Does the error stay?
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
