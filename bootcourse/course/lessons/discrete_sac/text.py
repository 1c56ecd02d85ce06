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
# - write the parts of soft actor-critic, and say where a gradient must stop;
# - say what the temperature does to a learner in the trap.
#
# **Time** 47 minutes, 4 of them voluntary (the last exercise). **It builds on** a little torch and lesson [[values]].

# %%
import math

import bootcourse as bc
import torch
from bootcourse.course import check, compare_predictions, own_code, predict, predicted, progress
from bootcourse.course.lessons.discrete_sac import diagrams, explorable, figures, own_parts

progress("discrete_sac")

# %% [markdown]
# ## Look first
#
# In lesson [[values]] many learners stayed in the trap, and more random decisions helped. *Soft actor-critic*
# (SAC) pays an agent for being undecided, so that it tries more. **Does that lead out of the trap?**

# %%
bc.show(diagrams.four_parts())

# %% [markdown]
# - The **actor** gives each of a few (*discrete*) actions a probability, π(a|s): its **policy**.
# - The **critics** estimate Q(s, a), what each action is worth.
# - The **replay buffer** keeps a row for each decision: s, a, reward r, next state s', and whether the world ended. An
#   update learns from a **batch** of rows.

# %% [markdown] tags=["instructor"] minutes=3
# Follow one row of the buffer through the picture: who made it, and who learns from it? Two parts are still
# missing; the whole picture stands before the summary.

# %% [markdown]
# ## Round 1: what is a state worth if indecision is paid?
#
# An agent estimates that going straight is worth {{ q[1] | g }}, left {{ q[0] | g }} and right {{ q[2] | g }}. Early
# estimates are poor, so it should **explore**. SAC pays it α times its **entropy**, a measure of indecision: 0 if
# it is sure of one action, otherwise more. α is the **temperature**.
#
# > **Predict.** The agent chooses the probabilities that make the mean of Q plus the pay largest: the state's worth.

# %%
choices = ["less than 1", "1", "more than 1"]
predict("discrete_sac.1", "What is the state worth?", choices)

# %% [markdown]
# **Drag** α. What happens to the state's worth?

# %%
predicted("discrete_sac.1")
explorable.undecided()

# %% [markdown]
# **Explain.** More than 1, and it rises with α. Begin with a policy that is sure of straight, and move 1 % to left: the
# mean of Q falls by {{ 0.01 * (q[1] - q[0]) | .3f }}, and the entropy rises by {{ doubt() | .3f }}, which pays
# {{ ALPHA * doubt() | .3f }} at α = {{ ALPHA }}. Go on until a move gains nothing: that is the panel's policy.
# <!-- claim: max(q) == q[1] == 1 < WORTH -->
# <!-- claim: all(1 + alpha * math.log(np.exp((q - 1) / alpha).sum()) > 1 for alpha in ALPHAS) -->
# <!-- claim: all(-alpha * d * math.log(d) >= 0.1 * d for alpha in ALPHAS for d in [math.exp(-0.1 / alpha - 1)]) -->

# %% [markdown]
# The entropy of a policy is, in *nats* (natural logarithm):
#
# $$ \mathcal{H}(\pi(\cdot|s)) = -\sum_a \pi(a|s) \log \pi(a|s) $$
#
# It is **never negative**, and at most log n, with n equally likely actions.
# <!-- claim: 0 == float(sac.entropy(torch.tensor([1.0]).log())) <
#   float(sac.entropy(torch.full((9,), 1 / 9).log())) < math.log(9) + 1e-6 -->
#
# The **soft value** of a state is the mean of Q under the agent's own policy, plus the pay:
#
# $$ V(s) = \sum_a \pi(a|s)\, Q(s,a) + \alpha\, \mathcal{H}(\pi(\cdot|s)) $$
#
# It is largest with the panel's policy, a *softmax*: $\pi(a|s) \propto \exp(Q(s,a)/\alpha)$.
# <!-- claim: np.ptp(q - ALPHA * np.log(pi)) < 1e-9 and abs((q - ALPHA * np.log(pi))[0] - WORTH) < 1e-9 -->
#
# <details><summary>Why a softmax?</summary>
#
# Move a little probability ε from action b to action a. V changes by
# $\varepsilon\,[(Q_a - \alpha\log\pi_a) - (Q_b - \alpha\log\pi_b)]$. With the best policy no such move gains
# anything: $Q_a - \alpha\log\pi_a$ is the same number Z for each action, and $\log\pi_a = (Q_a - Z)/\alpha$.
#
# </details>
#
# **Exercise (4 min, ●○○).** Write the soft value.


# %%
def soft_value(log_pi, q, alpha):
    """V(s). log_pi, q: (batch, actions); alpha: a tensor with one number. Returns (batch,)."""
    # solution
    return (log_pi.exp() * (q - alpha * log_pi)).sum(-1)
    # end solution


check.soft_value(soft_value)

# %% [markdown] tags=["instructor"] minutes=4
# Those who know continuous SAC will want to sample an action and use Q − α log π of it. With two or nine
# actions the expectation is a sum of two or nine terms, which we compute exactly. Ask what sampling would add
# to the target (noise, with the variance of Q − α log π under π).

# %% [markdown]
# ## Round 2: what is the critic's target?
#
# For each **transition**, a row of the buffer, the critic moves Q(s, a) towards a target. In lesson [[values]]
# this was r + γ max Q(s', a'), the *plain* target. SAC's *soft* target is r + γ V(s').
#
# > **Predict.** In s' Q(left) = 1 and Q(right) = 3. The policy is even: its entropy is log 2 = 0.69 nats. With r = 1,
# > γ = 0.9 and α = 1.

# %%
targets = ["plain, with max Q", "soft, with V", "the same"]
predict("discrete_sac.2", "Which target is higher?", targets)

# %% [markdown]
# **Drag** π(right) to where the soft target is highest.

# %%
predicted("discrete_sac.2")
explorable.backup()

# %% [markdown]
# **Explain.** The plain one. The policy's mean Q is 1 less than the best action's, and its entropy pays only 0.69.
# **SAC's critic judges the policy that the agent has, not the best action.**

# %% [markdown]
# $$ Q(s, a) = \mathbb{E}\big[\, r + \gamma V(s') \big] $$
#
# This is the **soft Bellman equation**; $\mathbb{E}$ is the mean over what may follow.
#
# If the *world* ends, as by an accident, nothing follows: `terminated` is 1. If only the time is up, the car would
# go on earning: `terminated` is 0. The target y, from one transition:
#
# $$ y = r + \gamma\, (1 - \text{terminated})\, V(s') $$
#
# **Exercise (4 min, ●○○).** Write the target.


# %%
def critic_target(reward, terminated, next_value, gamma):
    """y. reward, terminated (0 or 1), next_value: (batch,); gamma: float. Returns (batch,)."""
    # solution
    return reward + gamma * (1 - terminated) * next_value
    # end solution


check.critic_target(critic_target)

# %% [markdown]
# SAC computes V(s') with a slow copy of each critic, its *target critic* (*target network*): each update moves the
# copy's weights a small share τ ("tau") of the way. A step towards the target then hardly moves the target.
#
# **Exercise (6 min, ●●○).** Write the loss of both critics: for each the mean over the batch of
# $(Q(s,a) - y)^2$, then the sum of the two. Here a is the action taken. No gradient may run through y, or the loss
# would also fall by moving y towards Q(s, a), which teaches nothing about the road.


# %%
def critic_loss(q_pair, action, target):
    """A scalar tensor. q_pair: (2, batch, actions), with gradients; action, target: (batch,)."""
    # solution: the exercise's own


check.critic_loss(critic_loss)

# %% [markdown] tags=["instructor"] minutes=5
# Write a sum of three terms on the board, r₀ + γ (r₁ + α H₁) + γ² (r₂ + α H₂), take out γ, and let them say
# which part is V(s'). Then ask what would change if the row came from an older policy (nothing: a is given,
# and what follows is asked of the present policy). This is why the replay buffer may hold old rows.

# %% [markdown]
# ## Round 3: how far may the actor trust the critics?
#
# > **Predict.** Nine actions are all worth 0. A critic's estimate of each errs by chance, independently of the others,
# > and is right on average.

# %%
places = ["below 0", "at 0", "above 0"]
predict("discrete_sac.3", "Where is the highest of the nine estimates, on average?", places)

# %% [markdown]
# **Drag** the number of actions. Does the smaller of two estimates help?

# %%
predicted("discrete_sac.3")
explorable.overestimated()

# %% [markdown]
# **Explain.** Above 0. **The optimist's error**: among many uncertain guesses the highest is, on average, too high.
# Ask each time: *who guesses, and who picks?* Here a critic guesses, and the actor picks: it makes the highest
# estimates most probable, so V(s') is too high, too.
#
# SAC takes the smaller estimate of **two critics** for each action, in V(s') and in the actor's loss. If the two err
# independently, the highest of nine is then {{ highest(9)[1] | .2f }}, not {{ highest(9)[0] | .2f }}.
# <!-- claim: too_high() > 0.5 > 0.1 > abs(too_high(2)) and abs(highest(9)[1]) < highest(9)[0] -->

# %% [markdown]
# The actor's loss is minus the soft value. So α acts in two places, here and in the critics' target.
#
# $$ L_\text{actor} = -\,\text{mean over } s \text{ of } \sum_a \pi(a|s)\,
# \big(Q(s,a) - \alpha \log \pi(a|s)\big) $$
#
# A better policy lowers this loss. A higher Q does, too, but makes no action better. So Q is **detached**
# (`q.detach()`): no gradient runs into it.
#
# **Exercise (5 min, ●●○).** Write the actor's loss.


# %%
def actor_loss(log_pi, q, alpha):
    """A scalar tensor. log_pi, q: (batch, actions); alpha: a tensor with one number, 0 or more.

    q is the smaller of the two critics' estimates.
    """
    # solution: the exercise's own


check.actor_loss(actor_loss)

# %% [markdown]
# Where does Q(straight) end without `detach`?

# %%
value, loss = own_code.yours_or_ours("soft_value", "actor_loss", doing="Descending")
bare = own_parts.descended(lambda log_pi, q, alpha: -value(log_pi, q, alpha).mean())
figures.descents({"Q detached": own_parts.descended(loss), "Q not detached": bare})

# %% [markdown]
# **See.** With Q detached, π ends at the softmax of Round 1. Without `detach` Q(straight) rises by almost 1 a step.
# <!-- claim: 90 < wished() < 100 -->

# %% [markdown] tags=["instructor"] minutes=4
# Ask what an actor would do that may also raise Q. (With continuous actions it needs the gradient through Q
# to the action; there only the critics' weights are held.) Then ask where else a gradient must stop (the
# target of the critics).

# %% [markdown]
# ## Round 4: does the pay lead out of the trap?
#
# For each α {{ LEARNERS }} learners walk the chain of lesson [[values]], 1,000 decisions each. Q is 0 at first. They
# draw actions from softmax(Q / α) and move Q(s, a) 0.3 of the way to the soft target, with γ = {{ GAMMA }}.
#
# After a first decision to stay, a learner stays again with probability {{ stays(0.01) | .2f }} if α = 0.01, and
# {{ stays(10) | .2f }} if α = 10. By the right plain Q leaving is worth {{ soft_q(1e-3)[0, 1] | .2f }}, staying
# once before it 0.16 + 0.8 · {{ soft_q(1e-3)[0, 1] | .2f }} = {{ soft_q(1e-3)[0, 0] | .2f }}. The softmax makes
# π(leave) / π(stay) = exp(0.25 / α).
# <!-- claim: abs(0.25 - soft_q(1e-3)[0] @ [-1, 1]) < 0.005 -->
#
# > **Predict.** *Sure of leaving* the trap means with a probability above {{ SURE }}. At α = 0.01 and 0.1 fewer than a
# > third reach the free road.
# <!-- claim: constant().found[:2].mean(axis=1).max() < 1 / 3 -->

# %%
kinds = ["0.01", "0.1 or 0.2", "1 or 10", "none of these"]
predict("discrete_sac.4", "With which constant α do more than half end sure of leaving?", kinds)

# %%
predicted("discrete_sac.4")
value, target = own_code.yours_or_ours("soft_value", "critic_target", doing="Walking")
constant = torch.tensor([0.01, 0.1, 0.2, 1, 10], dtype=torch.float64)  # a column for each kind
walked = own_parts.walked(value, target, constant.expand(1000, -1))
bc.show(figures.constant_alpha(constant.tolist(), walked))

# %% [markdown]
# **Explain.** None of these. **α does two jobs.** It decides how much a learner *tries*: with α = 0.01 few find the
# free road. And it decides how surely it *takes* the way: with α = 1 or 10 nearly all find it, but stay undecided. At
# α = 0.2 the right soft Q make π(leave) {{ leave(0.2) | .2f }}, less than {{ SURE }}: the Q of the
# {{ sure_at(soft, 0.2) }} sure ones have not settled.
# <!-- claim: leave(0.2) < SURE and sure(constant()).max() < LEARNERS / 8 -->
# <!-- claim: constant().leaves[:2].max() < 1 - SURE and constant().found[0].mean() < 0.15 -->
# <!-- claim: constant().found[1].mean() < 0.35 and leave(0.1) > SURE -->
# <!-- claim: constant().found[6:].mean(axis=1).min() > 0.95 and sure(constant())[6:].max() == 0 and
#   (constant().leaves[6:] > 1 - SURE).all() -->

# %% [markdown]
# Does the pay in the critics' target help? The learners still act by softmax(Q / α). Only the pay in their target's
# V(s') changes. It is α H, as in SAC; or α (H − log 2), the same less a constant, so that an even policy gets 0; or
# none.

# %%
values = {  # V(s') with this pay
    "α H": value,
    "α (H − log 2)": own_parts.less_log_2(value),
    "none": own_parts.unpaid,
}
steady = torch.full((1000, 1), 0.2, dtype=torch.float64)
ends = {pay: own_parts.walked(of, target, steady) for pay, of in values.items()}
figures.found_by_pay(ends)

# %% [markdown]
# **See.** No. Without the constant α log 2, an even policy's pay, nearly all find the free road; without any pay most.
# <!-- claim: found(less, 0.2) > 0.95 * LEARNERS > found(unpaid, 0.2) > 0.8 * LEARNERS > 0.6 * LEARNERS >
#   found(soft, 0.2) -->
#
# Now α falls from `start` to 0.01.

# %%
start, decisions, first_q = 10, 1000, 0.0  # try a start of 1; 10 with 3000 decisions; first_q = 35
falling = torch.logspace(math.log10(start), -2, decisions, dtype=torch.float64)[:, None]
ends = {pay: own_parts.walked(of, target, falling, first_q=first_q) for pay, of in values.items()}
bc.show(figures.falling_alpha(start, ends))

# %% [markdown]
# **Explain.** If α starts at 10, about half end sure of leaving with α H. Without an even policy's pay all do. From 1
# they are {{ '{}, {} and {}'.format(*sure_from(1)) }}.
# <!-- claim: sure_from(1)[0] < 0.4 * sure_from(1)[1] -->
# <!-- claim: 0.4 < min(sure(falling())[0], *others()) / LEARNERS and
#   max(sure(falling())[0], *others()) / LEARNERS < 0.6 -->
# <!-- claim: sure(falling(value=unpaid))[0] == sure(falling(value=less))[0] == LEARNERS > 2 * sure(falling())[0] -->
#
# That pay is the same in every state. Why does it favour the trap? Q begins at 0, and has far to climb: at α = 10 the
# pay alone is worth 10 · 0.69 / (1 − 0.8) = {{ 10 * math.log(2) / (1 - GAMMA) | .0f }}, seven times the chain's
# ceiling. (The pay lifts the ceiling to (r_max + α log n) / (1 − γ).) Where a learner has been often, Q has climbed;
# where seldom, not yet. After 100 decisions:
# <!-- claim: 6.5 < 10 * math.log(2) / (1 - GAMMA) / 5 < 7.5 -->
#
# | mean of 300, Q of both actions | trap | 1 | 2 | 3 | free road |
# | --- | --- | --- | --- | --- | --- |
# | decisions there, with α H | {{ row(begun().decided, 0) }} |
# | Q, with α H | {{ row(begun().q) }} |
# | Q, with α (H − log 2) | {{ row(begun(less).q) }} |
#
# <!-- claim: (early(begun().decided).argsort() == early(begun().q).argsort()).all() -->
# <!-- claim: early(begun(less).q).argmax() == 4 > 0 == early(begun(less).decided).argmax() -->
# <!-- claim: most_visited(begun()) > 0.75 > 0.3 > most_visited(begun(less)) -->
#
# With α H the order of the Q is the order of the visits. **Entropy in the policy makes a learner curious. The pay
# α H in the target, while Q still climbs to it, pays a learner for being where it already is.**
#
# What does the pay cost? We change the start of Q, or the time, still with α H:
#
# | α falls from 10 | find the free road | end sure of leaving |
# | --- | --- | --- |
# | as above | {{ falling().found.sum() }} | {{ sure(falling())[0] }} |
# | all Q 35 at first | {{ falling(first_q=35.0).found.sum() }} | {{ sure(falling(first_q=35.0))[0] }} |
# | 3,000 decisions | {{ falling(decisions=3000).found.sum() }} | {{ sure(falling(decisions=3000))[0] }} |
# | 10,000 decisions | {{ falling(decisions=10_000).found.sum() }} | {{ sure(falling(decisions=10_000))[0] }} |
#
# Without the climb from 0 all find the free road, but about half do not end sure of leaving. With more time all do: on
# this chain the pay costs time, and does not close the way.
# <!-- claim: falling(first_q=35.0).found.all() and sure(falling(first_q=35.0))[0] < 0.6 * LEARNERS and
#   sure(falling(first_q=35.0))[0] > 0.4 * LEARNERS -->
# <!-- claim: sure(falling(decisions=10_000))[0] == LEARNERS > sure(falling(decisions=3000))[0] > 0.8 * LEARNERS -->
#
# On the road the paper begins with α = {{ SETTINGS.alpha_init }}. There the pay is worth at most
# {{ SETTINGS.alpha_init }} · log 9 / (1 − 0.8) = {{ SETTINGS.alpha_init * math.log(9) / (1 - GAMMA) | .2f }}, staying
# {{ discounted(idle(), GAMMA) | .2f }}. So the chain does not show that the pay holds the road's agents.
# <!-- claim: SETTINGS.alpha_init * math.log(9) / (1 - GAMMA) < 0.2 * discounted(idle(), GAMMA) -->

# %% [markdown] tags=["instructor"] minutes=2
# D of lesson [[values]] drove at random, too, but its target held the max, so its Q put leaving above
# staying. On the chain, ask why π changes most where α is about as large as Q(0, 1) − Q(0, 0) = 0.25: by the softmax
# a learner with the right Q is sure of leaving at α = 0.1, and nearly even at α = 1.
# <!-- claim: leave(0.1) > 0.9 and leave(1) < 0.55 -->

# %% [markdown]
# ## Round 5: who sets α?
#
# SAC adjusts α like a thermostat, by a **target entropy** η ("eta"): while the policy's entropy is above η, α
# falls; while it is below, α rises. The paper sets **η = {{ SETTINGS.target_entropy }}** for nine actions.
#
# > **Predict.** At first the entropy is near log 9.

# %%
courses = ["falls, and stops at H = η", "rises for ever", "falls for ever", "moves up and down"]
predict("discrete_sac.5", "What does α do with η = −1?", courses)

# %% [markdown]
# **Drag** η. For which η does α come to rest?

# %%
predicted("discrete_sac.5")
explorable.thermostat()

# %% [markdown]
# **Explain.** α falls for ever: the entropy is never negative, so always above η = −1. So the paper's thermostat is a
# **clock**: α falls at each update, whatever the agent does. The pull of lesson [[soft_constraint]] hangs on it, too.
# The paper gives no reason for −1. With *continuous* actions, whose entropy can be negative, a usual η is minus their
# number of dimensions.
# <!-- claim: SETTINGS.target_entropy < 0 -->

# %% [markdown] tags=["instructor"] minutes=2
# The answer to discuss is "falls, and stops at η", as a thermostat in a room does. Ask which entropy would
# have to be reached. It helps to write the range, 0 to log 9, on the board before anybody answers. They
# may object that an entropy can be negative: that of continuous actions can.

# %%
compare_predictions(
    "discrete_sac",
    {1: choices[2], 2: targets[0], 3: places[2], 4: kinds[3], 5: courses[2]},
)

# %% [markdown]
# ## What you now know
#
# This is all of SAC:

# %%
bc.show(diagrams.sac_diagram())

# %% [markdown]
# 1. The soft value is the policy's mean Q plus α times its entropy.
# 2. The critics learn what the agent's own policy is worth. The actor raises that, with Q detached.
# 3. *The optimist's error*: the highest of many uncertain guesses is too high.
# 4. On the chain an α that is high first and low later finds the way out and takes it. If α falls quickly, a large pay
#    in the target favours the trap.
# 5. With η below 0 the thermostat is a *clock*: α only falls.

# %% [markdown]
# **Three questions to think about**
# - What would η = log 9 do to an agent on the road?
# - If two critics err alike, what does the smaller estimate help?
# - What could a higher first α cost on the road?
#
# <details><summary>Answers</summary>
#
# - While the policy is not even, H < η and α rises: the reward counts less and less beside the pay.
# - The more alike, the less. Of two equal estimates the smaller is as high as either.
# - Accidents: they end the drive, so more trying need not reach further.
#
# </details>
#
# **Read on**: Haarnoja et al., [SAC](https://arxiv.org/abs/1812.05905). Fujimoto et al.,
# [two critics](https://arxiv.org/abs/1802.09477). Christodoulou, [discrete SAC](https://arxiv.org/abs/1910.07207).
#
# You have the parts. Put together, with one wrong column, they [learn to fall](update_and_loop.ipynb).

# %% [markdown]
# ## Further: the thermostat's loss
#
# The thermostat as a loss:
#
# $$ L_\alpha = \alpha\, (\mathcal{H}(\pi) - \eta) $$
#
# **Exercise (4 min, ●●○).** Write the loss. $\mathcal{H}(\pi)$ is the mean over the batch, held fixed. The
# parameter is log α, which keeps α positive.


# %%
def temperature_loss(log_alpha, state_entropy, target_entropy):
    """A scalar tensor. log_alpha, target_entropy: one number; state_entropy: (batch,), in nats."""
    # solution
    return log_alpha.exp() * (state_entropy.detach().mean() - target_entropy)
    # end solution


check.temperature_loss(temperature_loss)

# %% [markdown] tags=["instructor"] minutes=4
# **On the board.** Q(s, a) = r + γ V(s'), with V written out below it; a dashed line through each place where
# no gradient passes.
#
# **To discuss.** The target is an estimate, too. Why does it help at all to learn an estimate from an
# estimate?
