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
# - compute what an action is worth, by the Bellman equation;
# - write Q-learning, which finds these values from decisions;
# - say why a learner can stay in a trap although leaving is worth more.
#
# **Time** 55 minutes. **It builds on** lesson [[the_trap]].

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
)
from bootcourse.course.lessons.values import chain, diagrams, explorable

progress("values")

# %% [markdown]
# ## Look first
#
# Here is the trap as a **chain** of five states, with a quick, safe way out. The arrows are the two actions: 1 is
# *going on* (in the trap: *leaving*), 0 *turning back* (in the trap: *staying*). Staying pays little in the trap and
# much on the free road. The way between pays nothing, and there action 0 leads back to the trap.
# <!-- claim: chain.REWARD.tolist() == [[0.16, 0], [0, 0], [0, 0], [0, 0], [1, 1]] and
#   chain.NEXT.tolist() == [[0, 1], [0, 2], [0, 3], [0, 4], [4, 4]] and chain.EPISODE == 20 -->
#
# **Drag** γ, and then what the trap pays. When is staying worth more?

# %%
explorable.worths()

# %% [markdown] tags=["instructor"] minutes=4
# Draw the chain on the board and keep it there. Let two people walk it aloud, one who stays and one who goes,
# and add up what they get.

# %% [markdown]
# ## Round 1: the discounted return
#
# The **discounted return** is what lesson [[the_trap]] calls the worth of a drive, as a formula:
#
# $$ G = r_0 + \gamma\, r_1 + \gamma^2\, r_2 + \dots $$
#
# **Exercise (4 min, ●○○).** Write it, for a list of rewards that ends.


# %%
def discounted_return(rewards, gamma):
    """The discounted return, a float: rewards (decisions,), the first at once; gamma in [0, 1]."""
    # solution
    return float(np.sum(gamma ** np.arange(len(rewards)) * np.asarray(rewards)))
    # end solution


check.discounted_return(discounted_return)

# %% [markdown]
# Staying is worth $0.16 + 0.16\,\gamma + 0.16\,\gamma^2 + \dots = 0.16 / (1 - \gamma)$. Leaving pays nothing
# for four decisions, and then 1 at each: it is worth $\gamma^4 / (1 - \gamma)$. So leaving is worth more
# where $\gamma^4 > 0.16$: above γ = {{ 0.16 ** 0.25 | .2f }}.
#
# > **Predict.** The way out gets one state longer. Use pen and paper.

# %%
predict("values.1", "With one more state, from which γ on is leaving worth more?", unit="")

# %%
predicted("values.1")
worth = own_code.yours_or_ours("discounted_return", doing="Adding up")
gammas = np.linspace(0.5, 0.9, 401)
better = [g for g in gammas if worth([0.0] * 5 + [1.0] * 495, g) > worth([0.16] * 500, g)]
print(f"γ = {min(better):.2f}")

# %% [markdown] tags=["instructor"] minutes=2
# Ask what γ means in seconds: at 0.8 a reward in ten decisions counts {{ 0.8**10 | .2f }}. Nothing in the
# trap of lesson [[the_trap]] forces this γ; it is a choice about how far to look.

# %% [markdown]
# ## Round 2: a value from the next value
#
# A **state** says all that matters for what comes next: on the chain its number. A problem with such states is a
# *Markov decision process* (MDP).
#
# The **value** of action a in state s, **Q(s, a)**, is the discounted return if you take a once and then act as well
# as possible. It is the reward of a, plus γ times the larger Q of the next state, s'. This is the **Bellman equation**:
#
# $$ Q(s, a) = r(s, a) + \gamma \max_{a'} Q(s', a') $$
#
# Begin with Q = 0 everywhere. One **sweep** computes the right side for all ten pairs (s, a) at once; the next begins
# with the new Q.
#
# > **Predict.** Each sweep looks one decision farther ahead. From the trap the free road pays at the fifth decision, so
# > after four sweeps its reward has not reached Q(0, 1).

# %%
choices = ["0", "above 0, but less than Q(0, 0)", "more than Q(0, 0)"]
predict("values.2", "After four sweeps, what is Q(0, 1)?", choices)

# %% [markdown]
# **Exercise (8 min, ●●○).** Write one sweep. `chain.REWARD[s, a]` and `chain.NEXT[s, a]`, arrays (5, 2), hold
# the chain's rewards and next states.


# %%
def bellman_sweep(q, gamma):
    """The right side of the equation for all pairs at once: q (5, 2) -> (5, 2)."""
    # solution
    return chain.REWARD + gamma * q.max(axis=1)[chain.NEXT]
    # end solution


check.bellman_sweep(bellman_sweep)

# %%
predicted("values.2")
sweep, found = own_code.yours_or_ours("bellman_sweep", doing="Sweeping"), [np.zeros((5, 2))]
for _ in range(40):
    found.append(np.array(sweep(found[-1], 0.8)))
bc.show(diagrams.sweeps(found))

# %% [markdown]
# **Explain.** Q(0, 1) is above 0: after one decision away you can turn back and be paid in the trap. It is less than
# Q(0, 0), which is {{ sweeps(4, 0.8)[0, 0] | .2f }} by then.
# <!-- claim: 0 < sweeps(4, 0.8)[0, 1] < 0.2 < 0.4 < sweeps(4, 0.8)[0, 0] and 0.4 < sweeps(5, 0.8)[0, 1] -->
# <!-- claim: (np.abs(sweeps(40, 0.8)[:, 1] - 5 * 0.8 ** np.arange(4, -1, -1)) < 0.005).all() -->
#
# No Q can be above r_max / (1 − γ), here 1 / (1 − 0.8) = 5: the most that a decision pays, for ever. This is the
# **ceiling**. A learner that promises more is surely wrong: the cheapest test in this course. (Lesson
# [[discrete_sac]] pays for more than rewards, and lifts the ceiling.)
# <!-- claim: chain.REWARD.max() == 1 and 4.99 < sweeps(99, 0.8).max() <= 5 -->

# %% [markdown] tags=["instructor"] minutes=4
# Do two sweeps on the board with γ = 1/2. Each sweep multiplies the largest distance from the true values by
# γ or less. Ask why: two maxima differ by no more than their numbers do, and γ times that is left. Ask why
# "at once" matters: with new values in the same sweep the result comes sooner, but it is another algorithm.
# <!-- claim: np.abs(sweeps(11, 0.8) - sweeps(300, 0.8)).max()
#   <= 0.8 * np.abs(sweeps(10, 0.8) - sweeps(300, 0.8)).max() + 1e-9 -->

# %% [markdown]
# ## Round 3: learning from one decision
#
# A sweep needs all rewards and next states. On the road a learner sees one of each, after each decision. The **temporal
# difference** says how much better this went than expected:
#
# $$ \delta = r + \gamma \max_{a'} Q(s', a') - Q(s, a) $$
#
# The part before the minus is the **target**. **Q-learning** moves Q(s, a) a part of the way to it,
# $Q(s, a) \leftarrow Q(s, a) + \text{step} \cdot \delta$. The **step** (*learning rate*) is 0.3 here.
#
# **Exercise (4 min, ●○○).** Write δ for one decision, from the table `q`.


# %%
def temporal_difference(q, s, a, reward, s_next, gamma):
    """How much better it went than Q(s, a) says, a float: q (5, 2); s, a, s_next whole numbers."""
    # solution
    return reward + gamma * q[s_next].max() - q[s, a]
    # end solution


check.temporal_difference(temporal_difference)

# %% [markdown]
# > **Predict.** Q is 0 everywhere. A learner walks out: it takes action 1 once in each state from 0 to 4, and
# > learns from each decision right after it.

# %%
choices = ["in all five", "in 3 and 4", "in 4 alone", "in 0 alone"]
predict("values.3", "After one walk out, in which states is Q(s, 1) above 0?", choices)

# %%
predicted("values.3")
difference = own_code.yours_or_ours("temporal_difference", doing="Walking")


def walked(q, states):
    q = q.copy()
    for s in states:  # action 1 in each
        q[s, 1] += 0.3 * difference(q, s, 1, chain.REWARD[s, 1], chain.NEXT[s, 1], 0.8)
    return q


walks = [np.zeros((5, 2))]
for _ in range(5):
    walks.append(walked(walks[-1], range(5)))
bc.show(diagrams.walks(walks[1:], walked(walks[0], reversed(range(5)))))

# %% [markdown]
# **Explain.** On the first walk the learner learns in the states 0 to 3 before the free road has paid, so only the
# value in state 4 rises. Each later walk carries it one state back. Learned backwards (last row), one walk leaves a
# first trace in the trap, {{ backwards() | .3f }}: each next state already has a value.
# <!-- claim: walked(1) == [False] * 4 + [True] and all(walked(1, backwards=True)) -->
# <!-- claim: not walked(4)[0] and walked(5)[0] -->

# %% [markdown] tags=["instructor"] minutes=3
# Let them say in one sentence what is different from Round 2: one pair instead of ten, what was seen instead
# of a map, a part of the way instead of all of it.

# %% [markdown]
# ## Round 4: what gets a learner across?
#
# The learner is **ε-greedy** ("epsilon"): with probability 1 − ε it takes the action with the larger Q, and action 0
# if both are equal. Otherwise it **explores**: it draws an action at random.
#
# Thirty learners of each kind make 1,000 decisions, in walks of 20. A learner has *learned to leave* if in the end
# Q(0, 1) > Q(0, 0).
#
# - *A*: ε = 0.1 and the paper's γ = {{ SETTINGS.gamma }}; *B*: as A, with γ = 0.95;
# - *C* and *D*: as A, with ε = 0.5 and with ε = 1;
# - *E*: as A, with a demonstration of the way out, replayed after each decision.
#
# > **Predict.** Before it has seen the free road, a learner's greedy action is nearly always 0. It must draw action 1
# > four times in a row, each time with probability ε / 2. Nearly all of C's thirty get there, by chance in
# > {{ by_chance(0.5) | .1f }} of their 50 walks. Remember how many walks out the value needed in
# > Round 3.
# <!-- claim: all(greedy_zero(explore) > 0.99 for explore in (0.1, 0.5, 1.0)) -->
# <!-- claim: 27 < free_road_seen(0.5, 0.8) < 30 -->

# %%
choices = ["none", "about a third", "about two thirds", "all"]
predict("values.4", "How many of C's thirty learn to leave?", choices)

# %% [markdown]
# **Exercise (20 min, ●●●).** Write this learner.
#
# - A demonstration changes Q, but does not move the learner.
# - `for t, chance in enumerate(chances):` loops; where `t % 20 == 0` a walk starts, in state 0. Its last decision, too,
#   learns from the state that it leads to.


# %%
def learn_chain(chances, gamma, step, taught):
    """Q (5, 2) after len(chances) decisions, from zeros.

    chances: for each decision -1 (act greedily, action 0 if both Q are equal), or the action to
    take, 0 or 1. taught: pairs (s, a) of a demonstrator, replayed in this order after each of
    your own decisions; they pay chain.REWARD[s, a].
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
# **Explain.** By chance only about one learner of A or B in {{ round(1 / by_chance(0.1), -1) | .0f }} would reach the
# free road in its 50 walks. None of the thirty of each does.
#
# On the way out you lose the trap's pay, and only the end pays: this is a **barrier**.
# <!-- claim: leaving(0.1, 0.8) == leaving(0.1, 0.95) == 0 and 0.8**4 > 2 * 0.16 -->
# <!-- claim: free_road_seen(0.1, 0.8) == free_road_seen(0.1, 0.95) == 0 -->
#
# More exploration helps, and so does a demonstration: Q-learning can learn from decisions that the learner did not
# make. It is **off-policy**.
# <!-- claim: leaving(0.1, 0.8, chain.WAY_OUT) == leaving(1.0, 0.8) == 30 -->
#
# But arriving is not enough: {{ free_road_seen(0.5, 0.8) }} of C's learners arrived, and only {{ leaving(0.5, 0.8) }}
# learned to leave. With
# 2,000 decisions {{ leave_later(2000) }} do: the way is slow, not locked. Here are one that did not,
# *blocked*, and one that did:
# <!-- claim: 9 < leaving(0.5, 0.8) < 12 -->

# %%
bc.show(diagrams.two_learners([chain.over_walks(0.5, 0.8, seed, learn) for seed in (16, 1)]))

# %% [markdown]
# **Explain.** A decision learns only from the *larger* Q of the state that it leads to. Where that is the Q of going on
# (orange), the free road's value passes to the state before. Where it is turning back (white), it goes no farther.
#
# Both learners have turned back in state 3, but at different times:
#
# | Q in state 3 | going on, after two arrivals | turning back, then | going on, in the end |
# | --- | --- | --- | --- |
# | blocked | {{ state_3(16, 1) | .2f }} | {{ state_3(16, 0) | .2f }} | {{ walks(16)[-1][3, 1] | .2f }} |
# | opened | {{ state_3(1, 1) | .2f }} | {{ state_3(1, 0) | .0f }} | {{ walks(1)[-1][3, 1] | .2f }} |
#
# The blocked one had turned back there before, the opened one not yet. When it first did, going on had already won.
# <!-- claim: state_3(16, 0) > state_3(16, 1) > 0 and state_3(1, 1) > state_3(1, 0) == 0 -->
# <!-- claim: all(q[3, 1] > q[3, 0] for q in walks(1)[goes_on_for_good()[0]:]) -->
# <!-- claim: 0.2 < walks(1)[goes_on_for_good()[0]][3, 1] < walks(16)[-1][3, 1] < 0.3 -->
# <!-- claim: len(chain.arrivals(walks(16))) == 2 and walks(16)[chain.arrivals(walks(16))[0] - 1][3, 0] > 0 ==
#   walks(1)[goes_on_for_good()[0]][3, 0] and (chain.arrivals(walks(1)) <= goes_on_for_good()[0]).sum() == 2 -->
# <!-- claim: chain.leaves(chain.over_walks(0.5, 0.8, 1)[-1]) -->
# <!-- claim: chain.has_been_free(chain.over_walks(0.5, 0.8, 16)[-1]) and
#   not chain.leaves(chain.over_walks(0.5, 0.8, 16)[-1]) -->
# <!-- claim: goes_on_for_good() == sorted(goes_on_for_good()) -->
#
# How often must a learner arrive? 300 learners as in C:
# <!-- claim: np.allclose(chain.many(0.5, 0.8, 3)[-1], chain.learned(0.5, 0.8, walks=3)) -->

# %%
step, gamma = 0.3, 0.8  # try a step of 0.1 and of 1; then 0.3 again, with γ = 0.95
found = chain.many(explore=0.5, gamma=gamma, learners=300, step=step)
bc.show(diagrams.after_arrivals(found, step, gamma))

# %% [markdown]
# **Explain.** Leaving wins for most only after about ten arrivals, and most learners never get so far:
# {{ often(4) }} of 300 arrive four times.
# <!-- claim: often(4) < 150 -->
#
# With a step of 0.1 {{ leave_c(step=0.1) or 'none' }} of the 300 learn to leave; with a step of 1, which moves Q all
# the way, {{ leave_c(step=1.0) }} do. On the chain an action always has the same outcome. On the road it has not: there
# a step of 1 would keep only the last outcome, and a small one takes a mean.
#
# Would a longer view help? With γ = 0.95 the free road is worth 20, and the trap only 3.2. Yet
# {{ leave_c(0.95) }} of 300 learn to leave, not {{ leave_c() }}. **A longer view first enlarges what you know
# already**: the trap's worth. After three arrivals turning back in state 3 is worth {{ thrice(0.95)[0] | .2f }}, not
# {{ thrice(0.8)[0] | .2f }}. Going on wins there for {{ thrice(0.95)[1] | .0% }} of the learners, not
# {{ thrice(0.8)[1] | .0% }}, and they arrive {{ mean_arrivals(0.95) | .0f }} times, not {{ mean_arrivals(0.8) | .0f }}.
# <!-- claim: abs(1 / (1 - 0.95) - 20) < 1e-9 and abs(trap_worth(0.95) - 3.2) < 0.1 -->
# <!-- claim: leave_c(0.95) < leave_c() / 2 and
#   sum(map(chain.has_been_free, as_c(0.95)[-1])) == sum(map(chain.has_been_free, as_c()[-1])) > 250 -->
# <!-- claim: turns_back(0.95)[0] > 2 * turns_back(0.95)[1] and abs(turns_back(0.8)[0] - turns_back(0.8)[1]) < 0.05 -->
#
# | staying pays | γ = 0.8 | γ = 0.95 |
# | --- | --- | --- |
# | 0.16 | {{ leave_c() }} | {{ leave_c(0.95) }} |
# | 0.04 | {{ leave_c(0.8, 0.04) }} | {{ leave_c(0.95, 0.04) }} |
# | 0 | {{ leave_c(0.8, 0.0) }} | {{ leave_c(0.95, 0.0) }} |
#
# Without the trap's pay the longer view costs nothing.
# <!-- claim: leave_c(0.8, 0.0) == leave_c(0.95, 0.0) > leave_c(0.8, 0.04) > leave_c(0.95, 0.04) -->

# %% [markdown] tags=["instructor"] minutes=4
# What happens at the last decision separates two ideas that lesson [[update_and_loop]] needs: an accident
# *terminates* (nothing follows), the end of the time *truncates* (we stop looking).

# %%
compare_predictions(
    "values",
    {
        1: round(0.16**0.2, 2),
        2: "above 0, but less than Q(0, 0)",
        3: "in 4 alone",
        4: "about a third",
    },
)

# %% [markdown]
# ## What you now know
#
# 1. The Bellman equation: an action is worth its reward plus γ times the larger Q of the next state.
# 2. Q-learning moves Q(s, a) by a part of the temporal difference.
# 3. Learned forwards, a walk carries a value one state back.
# 4. A longer view helped neither: at ε = 0.1 no learner arrives; at ε = 0.5 it first enlarges what is known already,
#    the trap's worth.
#
# **Four gates** stand between the trap and a fast drive. They are a way to sort what one sees, not a law.
#
# - **Try**: an attempt leaves the trap. A to E pass.
# - **See**: one reaches the free road. A, B and one of C stop here.
#   <!-- claim: free_road_seen(0.5, 0.8) == 29 -->
# - **Carry**: the value walks back to the trap: in each state on the way going on must be worth more than turning back.
#   {{ free_road_seen(0.5, 0.8) - leaving(0.5, 0.8) }} of C stop here in 1,000 decisions; D and E pass.
# - **Keep**: when the help ends, the way out must be worth more than staying, in the learner's own count. On the chain
#   it is. On the road the rule's way is not: this is lesson [[the_trap]]'s riddle.
#
# **Three questions to think about**
# - If staying in the trap paid nothing, would more learners of A learn to leave? And of C?
# - What would A's learners do if all Q were 5 at first?
# - Your car sees 26 numbers. What replaces the chain's table of ten values?
#
# <details><summary>Answers</summary>
#
# - Of A none: four in a row stay as rare. Of C {{ unpaid_leave(0.5) }}, not {{ leaving(0.5, 0.8) }}: turning back is
#   worth nothing at first, and leaving has no pay to beat.
#   <!-- claim: unpaid_leave(0.1) == 0 and unpaid_leave(0.5) > 1.5 * leaving(0.5, 0.8) -->
# - All thirty learn to leave. Before the free road a Q of 5 falls when its action is taken, so the learner turns to
#   the other action.
#   <!-- claim: all(chain.leaves(walks(seed, 0.1, 5.0)[-1]) for seed in range(30)) -->
# - A network. It answers for states that it has not seen, so an error in one state spreads to others.
#
# </details>
#
# **Read on**: Sutton and Barto, *Reinforcement Learning*, chapters 3, 4 and 6.
#
# C's and D's learners got out by random actions, but these drive badly. [SAC](discrete_sac.ipynb) pays for them, and
# lets go. Does that lead out?

# %% [markdown] tags=["instructor"] minutes=2
# **On the board.** Five boxes in a row, the two ends with what they pay; under each box what it is worth,
# filled in from the right.
#
# **To discuss.** Where in your own work does a reward come long after the decision that earned it?
