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
# # Values
#
# **What you will be able to do**
# - say what a state and an action are worth, and compute it by the Bellman equation;
# - write a learner that finds these values from its own decisions: Q-learning;
# - say why such a learner can stay in a trap although leaving is worth more.
#
# **Time** 55 minutes; the machine computes for seconds. **It builds on** lesson [[the_trap]].

# %%
import bootcourse as bc
import numpy as np
from bootcourse.course import (
    check,
    compare_predictions,
    own_code,
    predict,
    predicted,
    progress,
    table,
)
from bootcourse.course.lessons.values import chain, diagrams, explorable

progress("values")

# %% [markdown]
# ## Look first
#
# Here is the trap with everything left out but the detour: a **chain** of five states. You start in
# the trap, state 0. Each arrow is an action, 0 or 1. As on the road of lesson [[the_trap]], staying
# pays a little in the trap and much on the free road. The way from one to the other pays nothing.
# <!-- claim: chain.REWARD.tolist() == [[0.16, 0], [0, 0], [0, 0], [0, 0], [1, 1]] and
#   chain.NEXT.tolist() == [[0, 1], [0, 2], [0, 3], [0, 4], [4, 4]] and chain.EPISODE == 20 -->

# %%
bc.show(diagrams.five_states())

# %% [markdown]
# One walker goes to the trap and stays, the other goes on to the free road. A reward that comes t
# decisions later counts γᵗ as much; here γ ("gamma") is 0.8. **Drag** what the trap pays. How much
# must it pay to be worth staying in? And to be worth going back to from state 2?

# %%
explorable.worths()

# %% [markdown] tags=["instructor"] minutes=4
# Draw the chain on the board and keep it there. Let two people walk it aloud, one who stays and one
# who goes, and add up what they get.

# %% [markdown]
# ## Round 1: the return
#
# The **discounted return** is the sum of all rewards from now on, each times γ to the power of its
# delay, in decisions:
#
# $$ G = r_0 + \gamma\, r_1 + \gamma^2\, r_2 + \dots $$
#
# **Exercise (4 min, ●○○).** Write it.


# %%
def discounted_return(rewards, gamma):
    """The return, a float: rewards (decisions,), the first one at once; gamma from 0 to 1."""
    # solution
    return float(np.sum(gamma ** np.arange(len(rewards)) * np.asarray(rewards)))
    # end solution


check.discounted_return(discounted_return)

# %% [markdown]
# Staying is worth $0.16 + 0.16\,\gamma + 0.16\,\gamma^2 + \dots$, a geometric series, which is
# $0.16 / (1 - \gamma)$. Leaving pays nothing for four decisions, and then 1 at each.
#
# > **Predict.** Leaving is worth $\gamma^4 / (1 - \gamma)$. From which γ on is that more?

# %%
predict("values.1", "From which γ on does leaving the chain's trap pay?", unit="")

# %% tags=["hide-input"]
predicted("values.1")
worth, rows = own_code.yours_or_ours("discounted_return", doing="Adding up"), []
for gamma in (0.5, 0.63, 0.64, 0.8, 0.95):
    stays, leaves = worth([0.16] * 500, gamma), worth([0.0] * 4 + [1.0] * 496, gamma)
    rows.append([gamma, f"{stays:.2f}", f"{leaves:.2f}", "leave" if leaves > stays else "stay"])
table(["γ", "to stay is worth", "to leave is worth", "better"], rows, "Sums of 500 decisions.")

# %% [markdown]
# **Explain.** Leaving pays where $\gamma^4 > 0.16$: from γ = {{ 0.16**0.25 | .4f }} on. The paper's
# γ is {{ SETTINGS.gamma }}; with it leaving is worth {{ 0.8**4 / 0.16 | .1f }} times as much as
# staying.
# <!-- claim: 0.8**4 > 2.5 * 0.16 and 0.63**4 < 0.16 < 0.64**4 -->

# %% [markdown] tags=["instructor"] minutes=3
# Ask what γ means in seconds: at 0.8 a reward in ten decisions counts {{ 0.8**10 | .2f }}. Nothing
# in the trap of lesson [[the_trap]] forces this γ; it is a choice about how far to look.

# %% [markdown]
# ## Round 2: a value from the next value
#
# The **value** of action a in state s, **Q(s, a)**, is the return if you take a once and then act
# as well as possible. Q is the reward, plus γ times what the next state s' is worth. A state is worth
# as much as the better of its actions. This is the **Bellman equation**:
#
# $$ Q(s, a) = r(s, a) + \gamma \max_{a'} Q(s', a') $$
#
# (Where chance decides what comes next, it takes the mean over the next states.)
# It says what Q *is*, not how to find it. So begin with Q = 0 everywhere and compute the right side
# for all ten pairs (s, a) at once: this is one **sweep**, and gives a new Q. Sweep again with that.
#
# > **Predict.** After which sweep does Q(0, 1), the value of leaving the trap, first contain a part
# > of the free road's reward?

# %%
choices = ["1", "2", "4", "5"]
predict("values.2", "After which sweep does Q(0, 1) know of the free road?", choices)

# %% [markdown]
# **Exercise (8 min, ●●○).** Write one sweep. `chain.REWARD[s, a]` and `chain.NEXT[s, a]`, arrays
# (5, 2), hold the rewards and next states of the picture above.


# %%
def bellman_sweep(q, gamma):
    """The right side of the equation for all pairs at once: q (5, 2) -> (5, 2)."""
    # solution
    return chain.REWARD + gamma * q.max(axis=1)[chain.NEXT]
    # end solution


check.bellman_sweep(bellman_sweep)

# %%
predicted("values.2")
sweep, q = own_code.yours_or_ours("bellman_sweep", doing="Sweeping"), np.zeros((5, 2))
found = [q]
for _ in range(30):
    found.append(q := sweep(q, 0.8))
bc.show(diagrams.in_the_trap(found))

# %% [markdown]
# **Explain.** The first sweep finds the rewards alone, so only the two ends are worth something.
# Each further sweep carries the free road's value one state back, and the fifth reaches the trap.
# (Before that, Q(0, 1) contains only the trap's rewards.) Each sweep shrinks the largest error to γ
# times its size or less, so the numbers settle: on {{ sweeps(200, 0.8)[0, 0] | .2f }} for staying
# and {{ sweeps(200, 0.8)[0, 1] | .2f }} for leaving.
# <!-- claim: sweeps(4, 0.8)[0, 1] < 0.2 < 0.4 < sweeps(5, 0.8)[0, 1] -->
# <!-- claim: abs(sweeps(200, 0.8)[0, 1] - 0.8**4 / 0.2) < 1e-9 -->
#
# Why is staying not worth 0.80, as in Round 1? Q(0, 0) means staying *once*, and then leaving.
# <!-- claim: abs(sweeps(200, 0.8)[0, 0] - (0.16 + 0.8 * 0.8**4 / 0.2)) < 1e-9 -->

# %% [markdown] tags=["instructor"] minutes=4
# Do two sweeps on the board with γ = 1/2. Ask why "at once" matters: with new values in the
# same sweep the result comes sooner, but it is another algorithm.

# %% [markdown]
# ## Round 3: learning from one decision
#
# A sweep needs the whole map. A learner on the road has no map: it makes a decision, and sees a
# reward and a next state. How much better than expected this went is the **temporal difference**:
#
# $$ \delta = r + \gamma \max_{a'} Q(s', a') - Q(s, a) $$
#
# The part before the minus is the **target**. **Q-learning** moves Q(s, a) a part of the way to its
# target. That part is the **step**, also called *learning rate*; here it is 0.3:
# $Q(s, a) \leftarrow Q(s, a) + \text{step} \cdot \delta$.
#
# The target contains the learner's own estimate of the next state. Textbooks call this
# **bootstrapping**; *bootstrapped SAC* has its name from the rule's help.
#
# **Exercise (4 min, ●○○).** Write the difference.


# %%
def temporal_difference(q, s, a, reward, s_next, gamma):
    """How much better it went than Q(s, a) says, a float: q (5, 2); s, a, s_next whole numbers."""
    # solution
    return reward + gamma * q[s_next].max() - q[s, a]
    # end solution


check.temporal_difference(temporal_difference)

# %% [markdown]
# > **Predict.** Q is 0 everywhere, except Q(1, 1) = 0.1. The learner leaves the trap, from state 0
# > to 1, and gets no reward. With γ = 0.8 and a step of 0.3, what is Q(0, 1) now?

# %%
predict("values.3", "What is Q(0, 1) after the decision?", unit="")

# %%
predicted("values.3")
difference, q = own_code.yours_or_ours("temporal_difference", doing="Learning"), np.zeros((5, 2))
q[1, 1] = 0.1
delta = difference(q, 0, 1, 0.0, 1, 0.8)
print(f"Q(0, 1) = 0 + 0.3 · {delta:.2f} = {0.3 * delta:.3f}")

# %% [markdown]
# **Explain.** Nothing was paid, and Q(0, 1) still rises, because the next state is known to be
# worth something. It rises by only 0.3 of 0.8 · 0.1. So each passage moves a part of a value one
# state back: the free road's value needs several passages to reach the trap.

# %% [markdown] tags=["instructor"] minutes=3
# Let them say in one sentence what is different from Round 2: one pair instead of ten, what was
# seen instead of a map, a part of the way instead of all of it.

# %% [markdown]
# ## Round 4: what gets a learner across?
#
# Which decisions does the learner make while it learns? Here it is **ε-greedy** ("epsilon"): with
# probability 1 − ε it takes the action with the larger Q, else it **explores**: it draws one at
# random.
#
# **Exercise (20 min, ●●●).** Write this learner. The random decisions have been drawn beforehand
# (`chances`). After each decision of its own it replays a demonstration (`taught`): it learns from
# each pair (s, a), with the chain's reward and next state, and stays where it is. Every 20
# decisions the time is up, and the walk starts again in state 0. Does that change the target of the
# last decision?


# %%
def learn_chain(chances, gamma, step, taught):
    """Q (5, 2) after len(chances) decisions, from zeros.

    chances: at each decision -1 for the greedy action (of two equal ones action 0), or the action
    that is tried. taught: pairs (s, a) of a demonstrator, replayed in this order after each of your
    own decisions; they pay chain.REWARD[s, a].
    """
    # solution
    q, s = np.zeros((chain.STATES, 2)), 0
    for t, chance in enumerate(chances):
        if t % chain.EPISODE == 0:
            s = 0
        a = int(q[s].argmax()) if chance < 0 else chance
        for state, action in [(s, a), *taught]:
            target = chain.REWARD[state, action] + gamma * q[chain.NEXT[state, action]].max()
            q[state, action] += step * (target - q[state, action])
        s = chain.NEXT[s, a]
    return q
    # end solution


check.learn_chain(learn_chain)

# %% [markdown]
# The end of the time changes no target: the chain goes on.
#
# Thirty learners of each kind make 1,000 decisions, 50 episodes, with a step of 0.3. A learner has
# learned to leave if in the end Q(0, 1) > Q(0, 0).
#
# - *A*: ε = 0.1 and γ = 0.8;
# - *B*: as A, with γ = 0.95;
# - *C* and *D*: as A, with ε = 0.5 and with ε = 1;
# - *E*: as A, with a demonstration of the way out, replayed after each decision.
#
# > **Predict.** In which of the five kinds do more than half of the thirty learn to leave? (Of two
# > equal actions the learner takes 0. Where the greedy action leads back, getting through takes
# > four random decisions in a row, each right with probability ε / 2.)

# %%
predict("values.4", "In which kinds do more than half learn to leave? Letters, as in: A, C")

# %%
predicted("values.4")
kinds = {
    "A: ε = 0.1, γ = 0.8": (0.1, 0.8),
    "B: A, but γ = 0.95": (0.1, 0.95),
    "C: A, but ε = 0.5": (0.5, 0.8),
    "D: A, but ε = 1": (1.0, 0.8),
    "E: A, with replays": (0.1, 0.8, chain.WAY_OUT),
}
learn = own_code.yours_or_ours("learn_chain", doing="Walking")
found = {kind: chain.learned(*how, learn=learn) for kind, how in kinds.items()}
bc.show(diagrams.who_leaves(found))

# %% [markdown]
# **Explain.** In A none learns to leave, although leaving is worth {{ 0.8**4 / 0.16 | .1f }} times as
# much. In states 1 to 3 of all thirty the greedy action leads back: that way is known to pay, or
# both values are still 0. This is a **barrier**. A longer view alone does not help (B): none of the
# thirty has been on the free road, so its value is not known.
# <!-- claim: leaving(0.1, 0.8) == leaving(0.1, 0.95) == 0 and 0.8**4 > 2 * 0.16 -->
# <!-- claim: not any(q[:4].argmax(axis=1).any() for q in chain.learned(0.1, 0.8)) -->
# <!-- claim: free_road_seen(0.1, 0.8) == free_road_seen(0.1, 0.95) == 0 -->
#
# More exploration helps here (C, D), but to have been on the free road is not enough: {{
# free_road_seen(0.5, 0.8) }} of C were, and {{ leaving(0.5, 0.8) }} learn to leave. On the road a
# random decision can cost an accident.
# <!-- claim: 0 < leaving(0.5, 0.8) < free_road_seen(0.5, 0.8) and leaving(1.0, 0.8) == 30 -->
#
# With one demonstration, *replayed* after each decision, all thirty learn to leave (E): each replay
# moves its values one state back. Small choices matter, too, and more updates alone do not help:
# <!-- claim: leaving(0.1, 0.8, chain.WAY_OUT) == 30 -->
#
# | as A, but | learn to leave, of 30 |
# |---|---|
# | of two equal actions one is drawn | {{ with_ties("random") }} |
# | of two equal actions 1 is taken, which leads on | {{ with_ties("1") }} |
# | as many updates as in E, of its own decisions | {{ own_decisions(6) }} |
# | the demonstration is replayed once, at the start | {{ replayed(1) }} |
# | replayed five times, at the start | {{ replayed(5) }} |
# | replayed once *backwards*, at the start | {{ replayed(1, backwards=True) }} |
# <!-- claim: own_decisions(6) == 0 and len(chain.WAY_OUT) == 5 -->
# <!-- claim: with_ties("random") == 0 and with_ties("1") > 20 and replayed(1) < replayed(5) and
#   replayed(1, backwards=True) > 20 -->
#
# Backwards, one pass carries the free road's value all the way. Q-learning can learn from decisions
# that it did not make: it is **off-policy**, and so is the learner of the next lessons.

# %% [markdown] tags=["instructor"] minutes=3
# The question about the last decision separates two ideas that lesson [[update_and_loop]] needs: an
# accident *terminates* (nothing follows), the end of the time *truncates* (we stop looking). Ask in
# which order the demonstration should be replayed so that one pass is enough (backwards, with step
# 1).

# %%
compare_predictions(
    "values",
    {1: round(0.16**0.25, 2), 2: "5", 3: 0.024, 4: "D and E"},
)

# %% [markdown]
# ## What you now know
#
# 1. The discounted return is the sum of the rewards from now on, each × γ to the power of its
#    delay.
# 2. The Bellman equation says what a value is; sweeps of it find it.
# 3. A temporal difference says how much better one decision went than expected. Q-learning moves
#    Q(s, a) by a part of it, and needs no map.
# 4. Each update moves a part of a value one state back, from a decision made or shown.
# 5. On the chain none of A's thirty learners gets past the barrier. More random decisions help, and
#    so does a replayed demonstration.
#
# **Three questions to think about**
# - If the chain's Q begins at 5 (*optimistic initial values*), {{ optimistic(0.1, 5) }} of thirty
#   leave with A's ε and γ. Why, and what would it cost on the road?
# - A replayed demonstration teaches all thirty to leave. What could be different on the road?
# - The chain has ten numbers. Your car sees 26 numbers. What replaces the table?
#
# **Read on**: [](discrete_sac.ipynb), with networks in place of the table. Sutton and Barto,
# *Reinforcement Learning*, chapters 3, 4 and 6.

# %% [markdown] tags=["instructor"] minutes=2
# **Model answers.**
#
# - *Optimistic values.* Even with ε = 0 {{ optimistic(0, 5) }} of thirty leave: an action that has
#   not been tried looks best, so it is tried, until its value has fallen to what it pays. On the
#   road each such trial can cost an accident, and networks generalise: a value that falls in one
#   state falls in others, too.
# - *On the road.* The rule's drives show a slow way, which on road 10 is worth less than staying at
#   γ = 0.8 (lesson [[the_trap]]), states are 26 numbers and rarely come twice, and networks carry
#   an error from one state to the next.
# - *The table.* A function with fewer numbers than states: a network. It answers for states that it
#   has not seen, which is its use and its danger.

# %% [markdown] tags=["instructor"]
# **On the board.** Five boxes in a row, the two ends with what they pay; under each box what it is
# worth, filled in from the right.
#
# **To discuss.** Where in your own work does a reward come long after the decision that earned it?
