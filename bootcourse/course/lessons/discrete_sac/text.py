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
# **Time** 48 minutes, 4 of them voluntary (*Further*). **It builds on** Python, a little torch, and
# the Bellman equation of lesson [[values]].

# %%
import bootcourse as bc
import torch
from bootcourse.course import check, compare_predictions, own_code, predict, predicted, progress
from bootcourse.course.lessons.discrete_sac import diagrams, explorable, figures, own_parts

progress("discrete_sac")

# %% [markdown]
# ## Look first
#
# In lesson [[values]] a learner stayed in the trap: it tried too little. *Soft actor-critic* (SAC) pays
# an agent for trying. **Does that lead out of the trap?** You write SAC's parts, and in Round 4 two
# of them answer. The [next lesson](update_and_loop.ipynb) puts all together.

# %%
bc.show(diagrams.sac_diagram())

# %% [markdown]
# - The **actor** gives each action a probability, π(a|s): its **policy**.
# - Two **critics** estimate what each action is worth, Q(s, a), all later rewards included. Slow
#   copies, the **target critics**, give them targets.
# - The **temperature** α says how much the actor gains by staying undecided.
# - The **replay buffer** keeps a row of each decision: state s, action a, reward r, next state s', and
#   whether the world ended. An update learns from a **batch** of rows.
#
# *Discrete*: the actions can be counted, nine on the road.
#
# On the evening route this picture is enough: go on to [the barrier](the_barrier.ipynb).

# %% [markdown] tags=["instructor"] minutes=3
# Follow one row of the buffer through the picture: who made it, and which three parts learn from
# it? Leave the picture on the wall; Round 3 asks which of its arrows carry a gradient.

# %% [markdown]
# ## Round 1: what is a state worth if indecision is paid?
#
# An agent can go left, straight or right. It expects most of straight: {{ max(q) | g }}. Early in a
# training such estimates are poor, so SAC pays for **exploration**: α times how undecided the agent is.
#
# > **Predict.** The agent chooses the probabilities that are best for it, pay included. What is the
# > state worth to it now?

# %%
choices = ["less than 1", "1", "more than 1"]
predict("discrete_sac.1", "What is the state worth?", choices)

# %% [markdown]
# **Drag** the temperature α. At which end does the agent nearly always go straight?

# %%
predicted("discrete_sac.1")
explorable.undecided()

# %% [markdown]
# **Explain.** More than {{ max(q) | g }}. The agent could always go straight, but the pay outweighs
# the loss: as the panel opens, Q gives {{ BY_Q | .2f }} and the pay {{ WORTH - BY_Q | .2f }}, together
# {{ WORTH | .2f }}.

# %% [markdown]
# The policy's **entropy** says how undecided it is, in *nats* (natural logarithm; 0 · log 0 = 0):
#
# $$ \mathcal{H}(\pi(\cdot|s)) = -\sum_a \pi(a|s) \log \pi(a|s) $$
#
# It lies between 0, sure of one action, and log n, if all n actions are equally likely: it is **never
# negative**.
# <!-- claim: 0 == float(sac.entropy(torch.tensor([1.0]).log())) <
#   float(sac.entropy(torch.full((9,), 1 / 9).log())) < math.log(9) + 1e-6 -->
# $e^{\mathcal{H}}$ is the **effective number of actions** (Equations 21 and 22).
#
# The **soft value** of a state is the mean of Q under the agent's own policy, plus the pay:
#
# $$ V(s) = \sum_a \pi(a|s)\, Q(s,a) + \alpha\, \mathcal{H}(\pi(\cdot|s)) $$
#
# The policy that makes it largest is the panel's, a *softmax*: $\pi(a|s) \propto
# \exp(Q(s,a)/\alpha)$. Then $Q - \alpha \log \pi$ is the same for all actions.
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
# Those who know continuous SAC will want to sample an action and use Q − α log π of it. With two
# or nine actions the expectation is a sum of two or nine terms, which we compute exactly. Ask what
# sampling would add to the target (noise, with the variance of Q − α log π under π).

# %% [markdown]
# ## Round 2: what should the critic's estimate have been?
#
# The critic learns from **transitions**, the rows of the buffer. By the Bellman equation of lesson
# [[values]] Q(s, a) should have been r + γ max Q(s', a'). SAC puts the soft value of s' in place of the
# largest Q: r + γ V(s').
#
# > **Predict.** In s' the critic expects 1 of going left and 3 of going right. The policy there is even:
# > its entropy is log 2 = 0.69 nats. With α = 1, which target is higher?

# %%
targets = ["plain, with max Q", "soft, with V", "the same"]
predict("discrete_sac.2", "Which target is higher?", targets)

# %% [markdown]
# **Drag** π(right) to where the soft one is highest.

# %%
predicted("discrete_sac.2")
explorable.backup()

# %% [markdown]
# **Explain.** The plain one. The even policy loses 1 in Q, and its entropy pays only 0.69. **SAC's critic
# judges the policy that the agent has, not the best action.** With the softmax, π(right) =
# {{ SOFTMAX | .2f }}, the soft one is higher.

# %% [markdown]
# $$ Q(s, a) = \mathbb{E}\big[\, r + \gamma V(s') \big] $$
#
# This is the **soft Bellman equation**; $\mathbb{E}$ is the mean over what may follow. One transition
# gives one sample of the right side: the target y.
#
# Nothing follows if the *world* ends. In **CartPole**, the next lesson's world, each push pays 1 until
# a pole falls: then `terminated` is 1, and y is r alone. If only the 500 pushes are over, it is
# 0: the pole would go on earning.
# <!-- claim: (lambda env: (env.reset(seed=0), [env.step(0)[1:3] for _ in range(11)])[1])(
#   gym.make('CartPole-v1')) == 10 * [(1, False)] + [(1, True)] -->
# <!-- claim: gym.spec('CartPole-v1').max_episode_steps == 500 -->
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
# V(s') uses the target critics (*target networks*). Each update moves their weights by a small share τ
# ("tau") towards the critics', so y hardly moves.
#
# **Exercise (6 min, ●●○).** Write the loss of both critics: for each the mean over the batch of
# $(Q(s,a) - y)^2$, then the sum of the two. Here a is the action taken. Hold y fixed, or the loss
# could fall by moving y, not Q.


# %%
def critic_loss(q_pair, action, target):
    """A scalar tensor. q_pair: (2, batch, actions), with gradients; action, target: (batch,)."""
    # solution: the exercise's own


check.critic_loss(critic_loss)

# %% [markdown] tags=["instructor"] minutes=6
# Write a sum of three terms on the board, r₀ + γ (r₁ + α H₁) + γ² (r₂ + α H₂), take out γ, and let
# them say which part is V(s'). Then ask what would change if the row came from an older policy
# (nothing: a is given, and what follows is asked of the present policy). This is why the replay
# buffer may hold old rows.

# %% [markdown]
# ## Round 3: how far may the actor trust the critics?
#
# The actor improves by the critics' estimates. But estimates err.
#
# > **Predict.** Nine actions are all worth 0. Each estimate errs by chance, on its own, and is right on
# > average. Where is the highest of the nine, on average?

# %%
places = ["below 0", "at 0", "above 0"]
predict("discrete_sac.3", "Where is the highest estimate?", places)

# %% [markdown]
# **Drag** the number of actions to nine. Does the smaller of two estimates help?

# %%
predicted("discrete_sac.3")
explorable.overestimated()

# %% [markdown]
# **Explain.** Above 0: at {{ highest(9)[0] | .2f }}, if the standard deviation is 1. One estimate alone is at
# 0 on average, and the highest of nine is mostly higher.
#
# So SAC has **two critics** and takes for each action the smaller value, in V(s') and in the actor's
# loss. With independent errors this is nearer to 0, from two actions on:
# {{ highest(9)[1] | .2f }} for nine. SAC's two learn from one target, so they can share an error.
# <!-- claim: [n for n in range(1, 21) if abs(highest(n)[1]) < highest(n)[0]] == list(range(2, 21)) -->

# %% [markdown]
# Nor may the actor change the estimates. Its loss is minus the soft value:
#
# $$ L_\text{actor} = -\,\text{mean over } s \text{ of } \sum_a \pi(a|s)\,
# \big(Q(s,a) - \alpha \log \pi(a|s)\big) $$
#
# A better policy lowers it. So does a higher Q, and no action gets better by that. So Q is **detached**
# (`q.detach()`): its value counts, and the gradient stops.
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
# Descend your loss with the Q of Round 1; then minus your soft value, the same number without the stop.
# Where does Q(straight) go?

# %%
value, loss = own_code.yours_or_ours("soft_value", "actor_loss", doing="Descending")
bare = own_parts.descended(lambda log_pi, q, alpha: -value(log_pi, q, alpha).mean())
figures.descents({"your loss": own_parts.descended(loss), "Q not detached": bare})

# %% [markdown]
# **See.** Your loss finds the softmax of Round 1. Without the stop straight "improves" from
# {{ max(q) | g }} to {{ wished() | .0f }}, in the estimate alone.

# %% [markdown] tags=["instructor"] minutes=4
# Ask what an actor would do that may also raise Q. Then ask which arrows of the picture carry a
# gradient, and where else one must stop (the target of the critics).

# %% [markdown]
# ## Round 4: does the pay lead out of the trap?
#
# Thirty learners walk the chain of lesson [[values]] for 1,000 decisions. Each draws its action from
# softmax(Q / α), and moves Q(s, a) by 0.3 of the way to its soft target.
#
# It must *find* the free road, and then *take* the way: by the plain Bellman equation leaving is worth
# {{ 0.8**4 / 0.2 | .2f }}, and staying once more {{ 0.16 + 0.8 * 0.8**4 / 0.2 | .2f }}.
# <!-- claim: abs(soft_q(1e-3)[0, 0] - 1.80) < 0.005 > abs(soft_q(1e-3)[0, 1] - 2.05) -->
#
# > **Predict.** At the best constant α from 0.01 to 10, how probable is leaving in the end, on average?

# %%
chances = ["0.95", "0.5", "0.05"]
predict("discrete_sac.4", "About how probable is leaving?", chances)

# %%
predicted("discrete_sac.4")
value, target = own_code.yours_or_ours("soft_value", "critic_target", doing="Walking")
alphas = torch.logspace(-2, 1, 13, dtype=torch.float64)
walked = own_parts.walked(value, target, alphas.expand(1000, -1))
knows = own_parts.would_leave(value, target, alphas)
bc.show(figures.two_jobs(alphas, knows, walked))

# %% [markdown]
# **Explain.** About 0.5: {{ constant().leaves.mean(1).max() | .2f }}, at α = 10, as before it
# learned. **α does two jobs**: it decides how much a learner tries, and how surely it takes what is
# better.
# <!-- claim: ALPHAS[constant().leaves.mean(1).argmax()] == ALPHAS[-1] -->
#
# With α = 0.01 {{ found(0.01) }} of thirty were on the free road, with α = 1 {{ found(1) }}. But there even
# an agent with the map (sweeps of the soft equation) leaves with probability {{ leave(1) | .2f }}: the softmax
# divides the lead of leaving by α, and the critic judges a policy that often turns back (Round 2).
# <!-- claim: 0.5 < leave(1) < 0.55 and max(abs(leave(a) - 0.5) for a in (2, 3, 5, 7, 10)) < 0.01 -->
#
# At no constant α do more than {{ sure()["constant"] }} of thirty leave with a probability above {{
# SURE }} (at α = 10: {{ "none" if not (constant().leaves[-1] > SURE).any() else "some" }}). If α
# falls from 10 to 0.01 on the way, {{ sure()["from 10"] }} do (on average {{ falling().mean(1)[0] |
# .2f }}); from 1, {{ sure()["from 1"] }} ({{ falling().mean(1)[1] | .2f }}).
# <!-- claim: 15 > sure()["from 10"] > sure()["from 1"] > sure()["constant"] -->

# %% [markdown]
# So an α that falls can make the choice sure. How large it must begin depends on the Q, not known
# beforehand. SAC adjusts α like a thermostat, by a **target entropy** η ("eta"): while the entropy
# is above η, α falls; below, it rises. The paper and our study set **η = {{ SETTINGS.target_entropy
# }}** for nine actions.
#
# > **Predict.** At first the entropy is near log 9. What does α do?

# %%
courses = ["falls, and stops at H = η", "rises for ever", "falls for ever", "moves up and down"]
predict("discrete_sac.5", "What does α do with η = −1?", courses)

# %%
predicted("discrete_sac.5")
explorable.thermostat()

# %% [markdown]
# **Explain.** The entropy is never negative, so at least 1 above η = −1, and α falls at each
# update. The paper gives no reason for −1. Nor is a reachable η enough on the road: with 0.3 and
# with 1 {{ 'none' if not reachable().any() else reachable().sum() }} of three agents each escapes.
# <!-- claim: 0 - SETTINGS.target_entropy == 1 -->
#
# On the road α begins at {{ SETTINGS.alpha_init }}: the pay is at most
# {{ SETTINGS.alpha_init * math.log(9) | .3f }} a decision. Our {{ len(trained()[0]) }} trained SAC agents lost half
# of their entropy within {{ max(decided()[0]) }} of {{ trained()[0].shape[1] | , }} drives, before α had lost more than
# {{ math.ceil(100 * (1 - min(decided()[1]) / SETTINGS.alpha_init)) }} %.
#
# **Drag** η: where does α come to rest, and where does it rise for ever?

# %% [markdown]
# Gradient steps on this loss move α that way:
#
# $$ L_\alpha = \alpha\, (\mathcal{H}(\pi) - \eta) $$
#
# **Exercise (4 min, ●●○).** *Further:* write it. $\mathcal{H}(\pi)$ is the mean over the batch, held
# fixed. The parameter is log α, so that α stays positive.


# %%
def temperature_loss(log_alpha, state_entropy, target_entropy):
    """A scalar tensor. log_alpha, target_entropy: one number; state_entropy: (batch,), in nats."""
    # solution
    return log_alpha.exp() * (state_entropy.detach().mean() - target_entropy)
    # end solution


check.temperature_loss(temperature_loss)

# %% [markdown] tags=["instructor"] minutes=4
# On the chain, ask why π changes most where α is about as large as the lead of leaving, 0.25. (From α = 3
# on it is just below 0.5: a nearly even policy mostly falls back to the trap before the free road.)
# <!-- claim: leave(0.1) > 0.9 and leave(1) < 0.55 and all(0.49 < leave(a) < 0.5 for a in (3, 5, 10)) -->
#
# The answer to discuss is "falls, and stops at η", as a thermostat in a room does. Ask which
# entropy would have to be reached. It helps to write the range, 0 to log 9, on the board before
# anybody answers.

# %%
compare_predictions(
    "discrete_sac",
    {1: choices[2], 2: targets[0], 3: places[2], 4: chances[1], 5: courses[2]},
)

# %% [markdown]
# ## What you now know
#
# 1. The soft value is the policy's mean Q plus α times its entropy; softmax(Q / α) makes it largest.
# 2. The critics are fitted to r + γ (1 − terminated) V(s'), held fixed.
# 3. The highest of many estimates is too high, so the smaller of two critics counts.
# 4. The actor's loss is minus the soft value, with Q held fixed.
# 5. On the chain the pay leads few out: with a small α few find the way, with a large one leaving is as
#    likely as not. A thermostat can rest only with η between 0 and log n.

# %% [markdown]
# **Three questions to think about**
# - What would η = log 9 do to an agent on the road?
# - The target holds V(s'), an estimate. If it is ten times too high at first, does the error stay?
# - Would you let α begin higher on the road? What could it cost?
#
# **Read on**: Haarnoja et al., SAC (arXiv 1801.01290) and its thermostat (arXiv 1812.05905); Fujimoto et
# al., two critics and target critics (TD3, arXiv 1802.09477); Christodoulou, SAC for discrete actions
# (arXiv 1910.07207); Xu et al., its target entropy (arXiv 2112.02852).

# %% [markdown] tags=["instructor"] minutes=4
# *Answers to the three questions.* **η = log 9** is the largest entropy of nine actions. While the
# policy is not even, H < η and α rises, until entropy outweighs the differences in Q and the agent
# drives almost at random. **Ten times too high:** with exact values for each state the error
# shrinks by γ at each step from target to estimate, since y holds γ V(s'); rewards set the rest.
# With a network and old rows this is not certain: the next lesson shows a case. **A higher start:** on
# the chain it finds the free road. On the road an even choice of nine actions also has accidents, which
# end the drive, so more trying need not reach further; lesson [[the_barrier]] measures what trying costs.

# %% [markdown] tags=["instructor"]
# **On the board.** Q(s, a) = r + γ V(s'), with V written out below it; a dashed line through each
# place where no gradient passes.
#
# **To discuss.** The target is an estimate, too. Why does it help at all to learn an estimate from
# an estimate?
