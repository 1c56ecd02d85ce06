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
# - write the soft value, the critics' target, and the losses;
# - say where a gradient must stop, and which target entropy a thermostat can reach.
#
# **Time** 48 minutes, 4 of them voluntary (*Further*). **It builds on** Python, a little torch, and
# the Bellman equation of lesson [[values]].

# %%
import bootcourse as bc
import torch
from bootcourse.course import check, compare_predictions, own_code, predict, predicted, progress
from bootcourse.course.lessons.discrete_sac import diagrams, explorable, figures
from bootcourse.course.lessons.values import chain

torch.set_printoptions(precision=3, sci_mode=False)  # if you print a tensor
progress("discrete_sac")

# %% [markdown]
# ## Look first
#
# How can a program learn to drive from rewards alone? One way is *soft actor-critic* (SAC). Here you
# write its parts, and two of them meet the trap of lesson [[values]]. The
# [next lesson](update_and_loop.ipynb) puts them all together.

# %%
bc.show(diagrams.sac_diagram())

# %% [markdown]
# - The **actor** gives each action a probability, π(a|s): its **policy**.
# - Two **critics** estimate what each action is worth, Q(s, a), all later rewards included. Slow
#   copies, the **target critics**, give them targets.
# - The **temperature** α says how much the actor gains by staying undecided.
# - The **replay buffer** keeps a row of each decision: state s, action a, reward r, next state s', and
#   whether the world ended. Each update learns from a **batch** of rows.
#
# *Discrete* means that the actions can be counted: nine on the road.
#
# On the evening route this picture is enough: go on to [the barrier](the_barrier.ipynb).

# %% [markdown] tags=["instructor"] minutes=3
# Follow one row of the buffer through the picture: who made it, and which three parts learn from
# it? Leave the picture on the wall; Round 3 asks which of its arrows carry a gradient.

# %% [markdown]
# ## Round 1: what is a state worth if you are paid for being undecided?
#
# An agent can go left, straight or right. It expects most of straight: {{ max(q) | g }}. Early in a
# training such estimates are poor, so SAC pays for **exploration**, trying other actions, too: α for
# each *nat* by which the agent is undecided. (Nats are explained below.)
#
# > **Predict.** The agent chooses the probabilities that are best for it, pay included. What is the
# > state worth to it now?

# %%
choices = ["less than 1", "1", "more than 1"]
predict("discrete_sac.1", "What is the state worth, with the pay?", choices)

# %% [markdown]
# **Drag** the temperature α. At which end does the agent nearly always go straight, and what does
# it do at the other?

# %%
predicted("discrete_sac.1")
explorable.undecided()

# %% [markdown]
# **Explain.** More than {{ max(q) | g }}. The agent could always go straight, but the pay outweighs
# the loss: as the panel opens, Q gives {{ BY_Q | .2f }} and the pay {{ WORTH - BY_Q | .2f }}, together
# {{ WORTH | .2f }}.

# %% [markdown]
# The policy's **entropy** says how undecided it is, in nats (natural logarithm; 0 · log 0 = 0):
#
# $$ \mathcal{H}(\pi(\cdot|s)) = -\sum_a \pi(a|s) \log \pi(a|s) $$
#
# It lies between 0, sure of one action, and log n, if all n actions are equally likely: it is **never
# negative**.
# <!-- claim: 0 == float(sac.entropy(torch.tensor([1.0]).log())) <
#   float(sac.entropy(torch.full((9,), 1 / 9).log())) < math.log(9) + 1e-6 -->
# $e^{\mathcal{H}}$ is the **effective number of actions** (the paper's Equations 21 and 22).
#
# The **soft value** of a state is the mean of Q under the agent's own policy, plus the pay:
#
# $$ V(s) = \sum_a \pi(a|s)\, Q(s,a) + \alpha\, \mathcal{H}(\pi(\cdot|s)) $$
#
# The policy that makes it largest is the panel's, a *softmax*: $\pi(a|s) \propto
# \exp(Q(s,a)/\alpha)$.
#
# <details><summary>Why a softmax?</summary>
#
# Move a little probability ε from action b to action a. The value changes by
# $\varepsilon\,[(Q_a - \alpha\log\pi_a) - (Q_b - \alpha\log\pi_b)]$. At the best policy no such
# move gains anything, so $Q_a - \alpha\log\pi_a$ is the same number Z for each action, and
# $\log\pi_a = (Q_a - Z)/\alpha$.
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
# Those who know continuous SAC will want to sample an action and use Q − α log π of it. With two
# or nine actions the expectation is a sum of two or nine terms, which we compute exactly. Ask what
# sampling would add to the target (noise, with the variance of Q − α log π under π).

# %% [markdown]
# ## Round 2: what should the critic's estimate have been?
#
# The critic learns from **transitions**, the rows of the buffer. By the Bellman equation of lesson
# [[values]] its estimate of Q(s, a) should have been r + γ max Q(s', a'). SAC puts the soft value of s'
# in place of the largest Q: r + γ V(s').
#
# > **Predict.** In s' the critic expects 1 of going left and 3 of going right. The
# > policy there is even, so its entropy is log 2 = 0.69 nats, and α = 1. Which of the two is higher?

# %%
targets = ["the plain one, with max Q", "the soft one, with V", "both are the same"]
predict("discrete_sac.2", "Which of the two is higher?", targets)

# %% [markdown]
# **Drag** π(right) to where the soft one is highest.

# %%
predicted("discrete_sac.2")
explorable.backup()

# %% [markdown]
# **Explain.** The plain one. The even policy loses 1 in Q, and its entropy pays only 0.69: SAC's critic
# judges the policy that the agent has, not the best action. With the softmax, π(right) =
# {{ SOFTMAX | .2f }}, the soft one is higher.

# %% [markdown]
# $$ \begin{aligned}
# \text{plain:} \quad Q(s, a) &= \mathbb{E}\big[\, r + \gamma \max_{a'} Q(s', a') \big] \\
# \text{soft:} \quad Q(s, a) &= \mathbb{E}\big[\, r + \gamma V(s') \big]
# \end{aligned} $$
#
# The second is the **soft Bellman equation**; $\mathbb{E}$ is the mean over what may follow. The
# entropy in s is not in it, because a is given.
#
# One transition gives one sample of the right side: the target y. Nothing follows if the *world* ends.
# In **CartPole**, the next lesson's world, you push a cart left or right to keep its pole upright;
# each push pays 1. (A rule pushes right where a weighted sum of place, speed, angle and angular speed is
# positive.) After a fall `terminated` is 1, and y is r alone. If only the 500 pushes are over, the pole
# would go on earning: then `terminated` is 0.
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
# V(s') uses the target critics (or *target networks*). Each update moves their weights by a small share τ
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
# The actor looks for a better policy by the critics' estimates. But estimates err.
#
# > **Predict.** Nine actions are all worth 0. Each estimate errs by chance, on its own, and is right on
# > average. Where is the highest of the nine estimates, on average?

# %%
places = ["below 0", "at 0", "above 0"]
predict("discrete_sac.3", "Where is the highest estimate, on average?", places)

# %% [markdown]
# **Drag** the number of actions to nine. Does the smaller of two estimates help?

# %%
predicted("discrete_sac.3")
explorable.overestimated()

# %% [markdown]
# **Explain.** Above 0: one estimate alone is at 0 on average, and the highest of nine is mostly
# higher. An actor prefers what is overestimated. So SAC has **two critics** and takes for each
# action the smaller value, in V(s') and in the actor's loss (*min Q* in the picture). With
# independent errors the highest is then nearer to 0, from two actions on. SAC's two learn from one
# target, so they can share an error.
# <!-- claim: [n for n in range(1, 21) if abs(highest(n)[1]) < highest(n)[0]] == list(range(2, 21)) -->

# %% [markdown]
# Nor may the actor change the estimates. Its loss is minus the soft value:
#
# $$ L_\text{actor} = -\,\text{mean over } s \text{ of } \sum_a \pi(a|s)\,
# \big(Q(s,a) - \alpha \log \pi(a|s)\big) $$
#
# A better policy lowers it. So do higher estimates: with 1 more for each Q it is 1 lower, and the policy
# no better. So Q is **detached** (`q.detach()`): its value counts, and the gradient stops there.
#
# **Exercise (5 min, ●●○).** Write the actor's loss.


# %%
def actor_loss(log_pi, q, alpha):
    """A scalar tensor. log_pi, q: (batch, actions); alpha: a tensor with one number, 0 or more.

    q is the smaller of the two critics' estimates.
    """
    # solution: the exercise's own


check.actor_loss(actor_loss)

# %% [markdown] tags=["instructor"] minutes=4
# Ask what an actor would do that may also raise Q. Then ask which arrows of the picture carry a
# gradient, and where else one must stop (the target of the critics).

# %% [markdown]
# ## Round 4: which temperature is right?
#
# By the plain Bellman equation, leaving the trap of lesson [[values]] is worth {{ 0.8**4 / 0.2 | .2f }},
# and staying once more {{ 0.16 + 0.8 * 0.8**4 / 0.2 | .2f }}. Now two of your parts sweep that chain by
# the soft one, with the policy softmax(Q / α).
# <!-- claim: abs(soft_q(1e-3)[0, 0] - 1.80) < 0.005 > abs(soft_q(1e-3)[0, 1] - 2.05) -->
#
# > **Predict.** With α = 1, how probable is leaving?

# %%
chances = ["about 0.95", "about 0.5", "about 0.05"]
predict("discrete_sac.4", "With α = 1, how probable is leaving the trap?", chances)

# %%
predicted("discrete_sac.4")
value, target = own_code.yours_or_ours("soft_value", "critic_target", doing="Sweeping")
rewards, s_next = torch.tensor(chain.REWARD).flatten(), torch.tensor(chain.NEXT).flatten()


def soft_sweeps(alpha):
    """The chain's Q (5, 2) after 40 sweeps of the soft Bellman equation, γ = 0.8."""
    q = torch.zeros(5, 2, dtype=torch.float64)
    for _ in range(40):
        v = value((q / alpha).log_softmax(-1), q, alpha)
        q = target(rewards, torch.zeros(10), v[s_next], 0.8).reshape(5, 2)
    return q


alphas = torch.logspace(-2, 1, 31, dtype=torch.float64)
leave = [(soft_sweeps(alpha)[0] / alpha).softmax(-1)[1].item() for alpha in alphas]
bc.show(figures.leaving(alphas, leave))

# %% [markdown]
# **Explain.** About 0.5: {{ leave(1) | .2f }}. The softmax divides the lead of leaving by α, so a
# large α makes π nearly even; and then the lead itself shrinks, as such a policy often turns back.
# With α = 0.05 it is {{ leave(0.05) | .2f }}. As α goes to 0 the soft equation becomes the plain
# one, and leaving is worth {{ soft_q(1e-3)[0, 1] | .2f }} again. (The sweeps know the whole chain;
# a learner must first find the way out.)
# <!-- claim: 0.5 < leave(1) < 0.55 and max(abs(leave(a) - 0.5) for a in (2, 3, 5, 7, 10)) < 0.01 -->

# %% [markdown]
# So the right α depends on the Q, which are not known before training. SAC adjusts it like a thermostat,
# by a **target entropy** η ("eta"): while the entropy is above η, α falls; while it is below, α rises.
# The paper sets **η = {{ SETTINGS.target_entropy }}** for its nine actions, and so does our study.
#
# > **Predict.** At first the entropy is near log 9. What does α do then? Remember the entropy's range.

# %%
courses = ["falls, and stops at H = η", "rises for ever", "falls for ever", "moves up and down"]
predict("discrete_sac.5", "What does α do with η = −1?", courses)

# %%
predicted("discrete_sac.5")
explorable.thermostat()

# %% [markdown]
# **Explain.** The entropy is never negative, so it is at least 1 above η = −1. So α falls at each
# update, and SAC pays less and less for exploration. Why then −1? The paper gives no reason.
# <!-- claim: 0 - SETTINGS.target_entropy == 1 -->
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
# 1. The soft value is the mean of Q under the policy plus α times its entropy. Its best policy is
#    softmax(Q / α): on the chain it leaves the trap if α is small.
# 2. The critics are fitted to r + γ (1 − terminated) V(s'), held fixed.
# 3. The highest of many estimates is too high, so the smaller of two critics counts.
# 4. The actor's loss is minus the soft value, with Q held fixed.
# 5. The temperature is a thermostat. It can rest only if η lies between 0 and log n, the entropies of n
#    actions. With η = {{ SETTINGS.target_entropy }} α falls at each update.

# %% [markdown]
# **Three questions to think about**
# - What would η = log 9 do to an agent on the road?
# - The target holds V(s'), an estimate. If it is ten times too high at first, does the error stay?
# - V takes the smaller of two critics. What would happen with the larger?
#
# **Read on**: Haarnoja et al., SAC (arXiv 1801.01290) and its thermostat (arXiv 1812.05905); Fujimoto et
# al., two critics and target critics (TD3, arXiv 1802.09477); Christodoulou, SAC for discrete actions
# (arXiv 1910.07207); Xu et al., its target entropy (arXiv 2112.02852).

# %% [markdown] tags=["instructor"] minutes=4
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
