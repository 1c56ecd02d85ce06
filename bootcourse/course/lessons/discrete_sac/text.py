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
# - write the soft value, the critics' target, and the losses, and say where a gradient must stop;
# - say what the temperature does to a learner in the trap, and which target entropy can be reached.
#
# **Time** 48 minutes, 4 of them voluntary (*Further*). **It builds on** Python, a little torch, and the
# Bellman equation of lesson [[values]].

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
# (SAC) pays an agent for being undecided, so that it tries more. **Does that lead out of the trap?** You
# write SAC's parts, and the [next lesson](update_and_loop.ipynb) puts them together.

# %%
bc.show(diagrams.four_parts())

# %% [markdown]
# - The **actor** gives each of a few (*discrete*) actions a probability, π(a|s): its **policy**.
# - The **critics** estimate Q(s, a), what each action is worth.
# - The **replay buffer** keeps one row for each decision: state s, action a, reward r, next state s', and
#   whether the world ended. An update learns from a **batch** of rows.

# %% [markdown] tags=["instructor"] minutes=3
# Follow one row of the buffer through the picture: who made it, and who learns from it? Two parts are still
# missing; the whole picture stands before the summary.

# %% [markdown]
# ## Round 1: what is a state worth if indecision is paid?
#
# An agent can go left, straight or right. By its estimates going straight is worth {{ q[1] | g }}, left
# {{ q[0] | g }} and right {{ q[2] | g }}. Early estimates are poor, so the agent should **explore**. SAC pays
# it α times its **entropy**, which says how undecided it is: 0 if it is sure of one action, otherwise more. α is
# called the **temperature**.
#
# > **Predict.** The agent chooses the probabilities that make the mean of Q plus the pay as large as possible. The
# > state is worth that largest sum: how much?

# %%
choices = ["less than 1", "1", "more than 1"]
predict("discrete_sac.1", "What is the state worth?", choices)

# %% [markdown]
# **Drag** α. What happens to the state's worth?

# %%
predicted("discrete_sac.1")
explorable.undecided()

# %% [markdown]
# **Explain.** More than 1, for every α above 0. To be sure of *straight* gives 1. To mix in a little of *left*
# costs little Q, and this first bit of indecision pays more than it costs. At α = {{ ALPHA | g }} the best
# policy is worth {{ BY_Q | .2f }} + {{ ALPHA | g }} · {{ (WORTH - BY_Q) / ALPHA | .2f }} = {{ WORTH | .2f }}.
# <!-- claim: max(q) == q[1] == 1 < WORTH -->
# <!-- claim: all(1 + alpha * math.log(np.exp((q - 1) / alpha).sum()) > 1 for alpha in ALPHAS) -->

# %% [markdown]
# The entropy of a policy is, in *nats* (natural logarithm):
#
# $$ \mathcal{H}(\pi(\cdot|s)) = -\sum_a \pi(a|s) \log \pi(a|s) $$
#
# It is **never negative**, and at most log n, where all n actions are equally likely.
# <!-- claim: 0 == float(sac.entropy(torch.tensor([1.0]).log())) <
#   float(sac.entropy(torch.full((9,), 1 / 9).log())) < math.log(9) + 1e-6 -->
#
# The **soft value** of a state is the mean of Q under the agent's own policy, plus the pay:
#
# $$ V(s) = \sum_a \pi(a|s)\, Q(s,a) + \alpha\, \mathcal{H}(\pi(\cdot|s)) $$
#
# Which policy makes it largest? At the best one nothing is gained by moving probability from one action to
# another: the slope of Q(a) π(a) − α π(a) log π(a) in π(a), Q(a) − α log π(a) − α, is the same for each. So
# Q(a) − α log π(a) is also the same for each, and its mean under π is V. Then π is the panel's policy, a *softmax*:
# $\pi(a|s) \propto \exp(Q(s,a)/\alpha)$.
# <!-- claim: np.ptp(q - ALPHA * np.log(pi)) < 1e-9 and abs((q - ALPHA * np.log(pi))[0] - WORTH) < 1e-9 -->
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
# The critic learns from **transitions**, the rows of the buffer: it moves its estimate Q(s, a) towards a
# target. By the Bellman equation of lesson [[values]] this is r + γ max Q(s', a'), the *plain* target. In
# SAC's *soft* target, r + γ V(s'), the soft value of s' replaces the largest Q.
#
# > **Predict.** In s' Q(left) = 1 and Q(right) = 3. The policy there is even: its entropy is log 2 = 0.69 nats.
# > With r = 1, γ = 0.9 and α = 1, which target is higher?

# %%
targets = ["plain, with max Q", "soft, with V", "the same"]
predict("discrete_sac.2", "Which target is higher?", targets)

# %% [markdown]
# **Drag** π(right) to where the soft target is highest.

# %%
predicted("discrete_sac.2")
explorable.backup()

# %% [markdown]
# **Explain.** The plain one. The even policy's mean Q is 1 less than the best action's, and its entropy pays
# only 0.69. **SAC's critic judges the policy that the agent has, not the best action.**

# %% [markdown]
# $$ Q(s, a) = \mathbb{E}\big[\, r + \gamma V(s') \big] $$
#
# This is the **soft Bellman equation**; $\mathbb{E}$ is the mean over what may follow.
#
# If the *world* ends, `terminated` is 1: nothing follows. On the road an accident ends it. If only the
# {{ DEFAULT.clock.decisions / DEFAULT.clock.decision_rate }} s are up, `terminated` is 0, because the car
# would go on earning. The target y, from one transition:
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
# If y came from the critics themselves, each update would also move the goal that it steps towards. So SAC keeps a
# slow copy of each critic, its *target critic* (*target network*), and computes V(s') with the copies: each update
# moves their weights a small share τ ("tau") of the way to the critics' weights.
#
# **Exercise (6 min, ●●○).** Write the loss of both critics: for each the mean over the batch of
# $(Q(s,a) - y)^2$, then the sum of the two. Here a is the action taken. Hold y fixed: no gradient may run
# through it.


# %%
def critic_loss(q_pair, action, target):
    """A scalar tensor. q_pair: (2, batch, actions), with gradients; action, target: (batch,)."""
    # solution: the exercise's own


check.critic_loss(critic_loss)

# %% [markdown] tags=["instructor"] minutes=6
# Write a sum of three terms on the board, r₀ + γ (r₁ + α H₁) + γ² (r₂ + α H₂), take out γ, and let them say
# which part is V(s'). Then ask what would change if the row came from an older policy (nothing: a is given,
# and what follows is asked of the present policy). This is why the replay buffer may hold old rows.

# %% [markdown]
# ## Round 3: how far may the actor trust the critics?
#
# The actor learns from the critics' estimates, and these err.
#
# > **Predict.** Nine actions are all worth 0. Each estimate errs by chance, independently of the others, and is right
# > on average. Where is the highest of the nine estimates, on average?

# %%
places = ["below 0", "at 0", "above 0"]
predict("discrete_sac.3", "Where is the highest estimate?", places)

# %% [markdown]
# **Drag** the number of actions. Does the smaller of two estimates help?

# %%
predicted("discrete_sac.3")
explorable.overestimated()

# %% [markdown]
# **Explain.** Above 0. The actor makes the highest estimates most probable, so V(s') is too high, too.
#
# With nine actions the highest of the smaller estimates is nearer to 0; with one or two actions it is *below*
# 0, so the cure can be too strong. SAC has **two critics** all the same, and takes the smaller estimate for
# each action, in V(s') and in the actor's loss: an estimate that is too high spreads through the targets.
# <!-- claim: too_high() > 0.5 > 0.1 > abs(too_high(2)) and abs(highest(9)[1]) < highest(9)[0] -->
# <!-- claim: highest(1)[1] < 0 and highest(2)[1] < 0 < highest(3)[1] -->

# %% [markdown]
# The actor's loss is minus the soft value:
#
# $$ L_\text{actor} = -\,\text{mean over } s \text{ of } \sum_a \pi(a|s)\,
# \big(Q(s,a) - \alpha \log \pi(a|s)\big) $$
#
# A better policy lowers this loss. So would a higher Q, but that makes no action better. Therefore Q is
# **detached** (`q.detach()`): no gradient runs into it, and only the policy moves.
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
# Now take 100 gradient steps down your actor's loss, and 100 down the same loss without `detach`: these move Q, too.
# Does Q(straight) then stay at 1, rise to about 2, or rise without end?

# %%
value, loss = own_code.yours_or_ours("soft_value", "actor_loss", doing="Descending")
bare = own_parts.descended(lambda log_pi, q, alpha: -value(log_pi, q, alpha).mean())
figures.descents({"your loss": own_parts.descended(loss), "Q not detached": bare})

# %% [markdown]
# **See.** Your loss finds the softmax of Round 1. Without `detach` Q(straight) rises by almost 1 a step, without
# end, although it is no better than before: the loss's slope in it is −π(straight). Where each part has its own
# optimiser, Q would not move at once, but these gradients would add to the critics' next step unless cleared.
# <!-- claim: 90 < wished() < 100 -->

# %% [markdown] tags=["instructor"] minutes=4
# Ask what an actor would do that may also raise Q. (With continuous actions it needs the gradient through Q
# to the action; there only the critics' weights are held.) Then ask where else a gradient must stop (the
# target of the critics).

# %% [markdown]
# ## Round 4: does the pay lead out of the trap?
#
# {{ LEARNERS }} learners for each α walk the chain of lesson [[values]], 1,000 decisions each. They draw
# actions from softmax(Q / α), and move Q(s, a) 0.3 of the way to the soft target. This is *soft Q-learning*.
# As there, γ = {{ GAMMA }}, Q is 0 at first, and a walk has {{ chain.EPISODE }} decisions.
#
# A learner must *find* the free road, and then *take* the way to it.
#
# > **Predict.** Keep α as it is from the first decision to the last. With which α do more than half end *sure of
# > leaving* the trap (π above {{ SURE }})?

# %%
kinds = ["0.01", "0.3 or 1", "10", "none of these"]
predict("discrete_sac.4", "With which constant α do more than half end sure of leaving?", kinds)

# %% [markdown]
# The last rows let α fall from `start` to 0.01. Try other starts: 100, 1, 0.3.

# %%
predicted("discrete_sac.4")
value, target = own_code.yours_or_ours("soft_value", "critic_target", doing="Walking")
constant = torch.tensor([0.01, 0.3, 1, 10], dtype=torch.float64)
start = 10  # where the falling α begins: try others
falling = torch.logspace(math.log10(start), -2, 1000, dtype=torch.float64)[:, None]
alphas = torch.cat([constant.expand(1000, -1), falling], 1)  # a column for each kind of learner
walked = own_parts.walked(value, target, alphas)
unpaid = own_parts.walked(own_parts.unpaid, target, falling)  # V without the pay
less = own_parts.walked(own_parts.less_paid(value), target, falling)  # the pay α (H − log 2)
bc.show(figures.two_jobs(constant.tolist(), start, walked, unpaid, less))

# %% [markdown]
# **Explain.** None of these. **α does two jobs.** It decides how much a learner *tries*: with α = 0.01 few find the
# free road, and all end sure of *staying*. And it decides how surely a learner *takes* the way out: from α = 0.3 on
# most find the free road, but nearly all stay undecided. With α falling from 10 about half find it and end sure of
# leaving; over 4,000 decisions {{ sure(falling(4000))[0] }} of {{ LEARNERS }} do.
# <!-- claim: sure(constant()).max() < LEARNERS / 8 and 0.4 < min(sure(falling())[0], *others()) / LEARNERS and
#   max(sure(falling())[0], *others()) / LEARNERS < 0.6 -->
# <!-- claim: constant().leaves[0].max() < 1 - SURE and abs(constant().leaves[-1] - 0.5).max() < 0.04 -->
# <!-- claim: constant().found[5:].mean(axis=1).min() > 0.6 and sure(constant())[5:].max() < LEARNERS / 15 and
#   (constant().leaves[5:] > 1 - SURE).all() -->
# <!-- claim: sure(constant(4000)).max() < sure(falling(4000))[0] / 2 -->
#
# **Why not all?** An undecided learner is paid in every state, and the pay is in the target. So from Q = 0 **Q
# grows where the learner is**, and at first that is the trap: {{ begun().decided[..., 0].mean() | .0f }} of the
# first hundred decisions, against {{ begun().decided[..., 4].mean() | .0f }} on the free road. Then staying's Q
# is {{ begun().q[..., 0, 0].mean() | .0f }}, and the free road's only {{ begun().q[..., 4, :].mean() | .0f }}. By then
# α is 5, and right would be {{ soft_q(5)[0, 0] | .0f }} for staying and {{ soft_q(5)[4].mean() | .0f }} for the free
# road, whose Q has come only a third of the way.
# <!-- claim: 0.75 < begun().q[..., 0, 0].mean() / soft_q(5)[0, 0] < 0.9 and
#   0.3 < begun().q[..., 4, :].mean() / soft_q(5)[4].mean() < 0.4 -->
#
# The last two rows test this. With no pay in the target all leave. With the pay α (H − log 2), which is 0 for an even
# policy, all leave, too: each decision pays α log 2 less, so at a given α the same policy is best, and only the growth
# is gone. But α must begin high enough: with that pay {{ sure(falling(value=LESS, start=1))[0] }} leave if it falls
# from 1, and {{ sure(falling(value=LESS, start=0.3))[0] }} if it falls from 0.3.
# <!-- claim: sure(falling(value=LESS, start=0.3))[0] < LEARNERS / 3 < LEARNERS * 0.75 <
#   sure(falling(value=LESS, start=1))[0] < LEARNERS -->
# <!-- claim: begun().decided[..., 0].mean() > 3 * begun().decided[..., 4].mean() -->
# <!-- claim: abs(10 * 0.001 ** (99 / 999) - 5) < 0.1 and begun().q[..., 4, :].mean() < soft_q(5)[4].min() / 2 -->
# <!-- claim: begun().q[begun().found, 0, 0].mean() > begun().q[begun().found, 4].max(axis=-1).mean() -->
# <!-- claim: begun(unpaid).q[..., 0, 0].mean() < begun(unpaid).q[..., 4, :].mean() / 5 -->
# <!-- claim: sure(falling(value=unpaid))[0] == sure(falling(value=LESS))[0] == LEARNERS > 2 * sure(falling())[0] -->
# <!-- claim: np.ptp(soft_q(5) - soft_q(5, LESS)) < 1e-6 and
#   begun(LESS).q[..., 0, 0].mean() < begun(LESS).q[..., 4, :].mean() / 5 -->
#
# **Does the pay lead out of the trap, then?** Only in part: it makes a learner try, but it also makes the
# trap look good. On our road one of ten agents of plain SAC escapes. Lesson [[the_barrier]] asks why.
# <!-- claim: len(of('sac')) == 10 and escaped('sac') == 1 -->

# %% [markdown] tags=["instructor"] minutes=2
# D of lesson [[values]] drove at random, too, but its target held the max, so its Q put leaving above
# staying. On the chain, ask why π changes most where α is about as large as Q(0, 1) − Q(0, 0) = 0.25. (From α =
# 3 on it is just below 0.5: a nearly even policy mostly falls back to the trap before the free road.)
# <!-- claim: abs(0.25 - soft_q(1e-3)[0] @ [-1, 1]) < 0.005 -->
# <!-- claim: leave(0.1) > 0.9 and leave(1) < 0.55 and all(0.49 < leave(a) < 0.5 for a in (3, 5, 10)) -->

# %% [markdown]
# ## Round 5: who sets α?
#
# SAC adjusts α like a thermostat, by a **target entropy** η ("eta"): while the policy's entropy is above η, α
# falls, and while it is below, α rises. The paper and our study set **η = {{ SETTINGS.target_entropy }}** for
# nine actions.
#
# > **Predict.** At first the entropy is near log 9. What does α do?

# %%
courses = ["falls, and stops at H = η", "rises for ever", "falls for ever", "moves up and down"]
predict("discrete_sac.5", "What does α do with η = −1?", courses)

# %% [markdown]
# **Drag** η. Here α begins at 1, and each update moves it by 2 %. For which η does α come to rest?

# %%
predicted("discrete_sac.5")
explorable.thermostat()

# %% [markdown]
# **Explain.** α falls for ever, because the entropy is never negative and so always above η = −1. α can come
# to rest if η is between 0 and log 9 = {{ math.log(9) | .3f }}.
# <!-- claim: SETTINGS.target_entropy < 0 -->

# %% [markdown] tags=["instructor"] minutes=2
# The answer to discuss is "falls, and stops at η", as a thermostat in a room does. Ask which entropy would
# have to be reached. It helps to write the range, 0 to log 9, on the board before anybody answers. The paper
# gives no reason for −1; with continuous actions, whose entropy can be negative, such targets are usual.

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
# 1. The soft value is the policy's mean Q plus α times its entropy; softmax(Q / α) makes it largest.
# 2. The critics are fitted to r + γ (1 − terminated) V(s'), held fixed.
# 3. The highest of many estimates is too high, so SAC uses the smaller of two critics.
# 4. The actor's loss is minus the soft value, with Q held fixed.
# 5. On the chain an α that falls from 10 leads about half out in 1,000 decisions, and all if the pay cannot lift Q. A
#    thermostat can rest if η is between 0 and log n.

# %% [markdown]
# **Three questions to think about**
# - What would η = log 9 do to an agent on the road?
# - What could lower the critics' loss if y were not held fixed?
# - On the road α begins at {{ SETTINGS.alpha_init }}. What could a higher start cost?
#
# **Read on**: Haarnoja et al., SAC (arXiv 1801.01290) and its thermostat (arXiv 1812.05905); Fujimoto et al.,
# the smaller of two critics (TD3, arXiv 1802.09477); Christodoulou, SAC for discrete actions (arXiv
# 1910.07207); Xu et al., its target entropy (arXiv 2112.02852).

# %% [markdown]
# ## Further: the thermostat's loss
#
# A gradient step down this loss lowers α while H is above η, and raises it while H is below:
#
# $$ L_\alpha = \alpha\, (\mathcal{H}(\pi) - \eta) $$
#
# **Exercise (4 min, ●●○).** Write the loss. $\mathcal{H}(\pi)$ is the mean over the batch, held fixed. The
# parameter is log α, so that α stays positive.


# %%
def temperature_loss(log_alpha, state_entropy, target_entropy):
    """A scalar tensor. log_alpha, target_entropy: one number; state_entropy: (batch,), in nats."""
    # solution
    return log_alpha.exp() * (state_entropy.detach().mean() - target_entropy)
    # end solution


check.temperature_loss(temperature_loss)

# %% [markdown] tags=["instructor"] minutes=4
# *Answers to the three questions.* **η = log 9** is the largest entropy of nine actions. While the policy is
# not even, H < η and α rises, until entropy outweighs the differences in Q and the agent drives almost at
# random. **y not held fixed:** V(s') could move towards Q(s, a). That lowers the loss, but the next state
# would then be judged by what came before it, not by what follows. **A higher start:** on the chain it finds
# the free road. On the road an even choice of nine actions also has accidents, which end the drive, so more
# trying need not reach further; lesson [[the_barrier]] measures what trying costs.

# %% [markdown] tags=["instructor"]
# **On the board.** Q(s, a) = r + γ V(s'), with V written out below it; a dashed line through each place where
# no gradient passes.
#
# **To discuss.** The target is an estimate, too. Why does it help at all to learn an estimate from an
# estimate?
