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
# # The bug hunt
#
# **What you will be able to do**
# - find a silent bug in a learner from curves, drives and probes, without reading its code;
# - write a probe: ask one part of a learner something whose right answer you know;
# - test a target in a millisecond, without training.
#
# **Time** 55 minutes; running it takes under one minute. **It builds on** the losses of lesson
# [[discrete_sac]], the update of lesson [[update_and_loop]], the soft constraint
# ([[soft_constraint]]) and learning from demonstrations ([[learning_from_demonstrations]]).

# %%
import bootcourse as bc
import numpy as np
from bootcourse.course import (
    charts,
    check,
    compare_predictions,
    predict,
    predicted,
    progress,
    shipped,
    table,
)
from bootcourse.course.lessons.bug_hunt import bugs, tables

hunt = bugs.Hunt()
progress("bug_hunt")

# %% [markdown]
# ## Look first
#
# Seven agents had a short training with the paper's method: {{ bugs.UPDATES | , }} updates, two
# seeds each. One agent is healthy. Each of the others, A to F, has one **silent bug**: a line that
# is wrong, raises nothing and prints nothing. Press play.
# <!-- claim: len(bugs.LEARNERS) == 7 and bugs.SEEDS == 2 -->

# %% tags=["nbval-ignore-output"]
named = {"healthy": hunt.agent("healthy"), "agent E, with a bug": hunt.agent("E")}
drives = [bc.record(agent.as_policy(), [10], label=name)[0] for name, agent in named.items()]
bc.recording([shipped.beginning(drive, 50) for drive in drives], height=360)

# %% tags=["hide-input"]
rows = [[d.label, bc.words.outcome(d), f"{d.rewards.sum():.0f}"] for d in drives]
table(["in 150 s", "in the end", "return"], rows)

# %% [markdown]
# Both leave the trap, and the agent with a bug earns more. How do you find a bug that the return
# hides? These are the six:
# <!-- claim: (lambda h: record(h.agent('E').as_policy(), [ROAD])[0].rewards.sum() >
#   record(h.agent('healthy').as_policy(), [ROAD])[0].rewards.sum())(hunt()) -->
#
# - `flipped_kl`: the KL divergence is taken the other way round;
# - `no_end`: (1 − terminated) is missing in the critic's target;
# - `sampled`: one drawn action stands for the expectation over all nine;
# - `no_stop`: the stop-gradient on Q is missing in the actor's loss;
# - `bonus_for_all`: the bonus c is paid for the agent's own driving as well;
# - `shifted_labels`: the rule was asked after the step: each label is the next second's.
#
# > **Predict.** With how many of them does an agent still *succeed*: end ahead of trap 1 in more
# > than 75 % of its last 30 training episodes, with both seeds? Ask of each: does Q still rank the
# > actions? Does the actor still learn from Q?

# %%
choices = ["none", "one or two", "three or four", "five", "all six"]
predict("bug_hunt.1", "With how many of the bugs does an agent still succeed?", choices)

# %% [markdown] tags=["instructor"] minutes=2
# Collect the names on the board. If somebody names all six, ask why. Come back to the list at the
# end of Round 1, and again after the verdict.

# %% [markdown]
# ## Round 1: what do the curves show?
#
# An agent that crashes early drives more episodes in as many updates, so the axis is logarithmic.

# %%
predicted("bug_hunt.1")
episode, share = "training episode (logarithmic)", "success in the last 30 episodes (%)"
curves = {name: (x, 100 * each) for name, (x, each) in hunt.curves("success").items()}
title = tables.TITLES["success"]
bc.show(charts.many(curves, title, episode, share, reference="healthy", x_scale="log"))

# %% [markdown]
# **See.** *A curve can look right although the code is wrong.* A, C and D end like the healthy agent.
# <!-- claim: {n for n in 'ABCDEF' if hunt().at_the_end('success')[n].mean() >=
#   hunt().at_the_end('success')['healthy'].mean()} == set('ACD') -->
# <!-- claim: {n for n in 'ABCDEF' if (hunt().at_the_end('success')[n] > 0.75).all()} ==
#   set('ACDE') -->
#
# The first seed of each now drives 200 new roads twice: by its most probable action, and by drawn
# ones, as in training.

# %%
table(tables.DRIVEN, tables.driven(hunt))

# %% [markdown]
# **See.** E earns the most, with more accidents than the healthy agent. B succeeds nearly always
# with its most probable action, and in less than half of the drives with drawn ones. F crashes,
# mostly when it is ahead. This is one seed of each, so small differences mean little.
# <!-- claim: driven('E').returns.mean() > max(driven(n).returns.mean() for n in hunt().names if n
#   != 'E') and (driven('E').accident > 0).mean() > (driven('healthy').accident > 0).mean() -->
# <!-- claim: driven('B').success.mean() > 0.9 and driven('B', True).success.mean() < 0.5 -->
# <!-- claim: (driven('F').accident > 0).all() and driven('F').success.mean() > 0.5 -->
#
# B and F look ill, but no curve names a bug.

# %% [markdown] tags=["instructor"] minutes=2
# Fill in the board's table: what did each predict, and which curve could be any of the six? Ask
# which agent they would have published.

# %% [markdown]
# ## Round 2: what is an accident worth?
#
# A **probe** asks one part of a learner something whose right answer is known. We know the right Q
# where an accident ends the episode: the target there is the reward, {{ DEFAULT.reward.accident }}.
#
# > **Predict.** Two of the six bugs change the target there. Which one pulls Q *below*
# > {{ DEFAULT.reward.accident }}?

# %%
names = list(bugs.BUGS)
predict("bug_hunt.2", "Which bug pulls Q below −10 at accidents?", names)

# %% [markdown]
# **Exercise (6 min, ●●○).** Write the probe: by how much is Q above r, on average, where an
# accident ended the drive?


# %%
def end_error(q, actions, rewards, terminated):
    """Mean of Q(s, a) - r over rows with terminated 1, or 0. q: (batch, 9); others: (batch,)."""
    # solution: the exercise's own


check.end_error(end_error)

# %% [markdown]
# Every {{ bugs.EVERY }} updates each agent was asked for Q at its own accidents:
# <!-- claim: set(np.diff(hunt().updates)) == {bugs.EVERY} -->

# %% tags=["hide-input"]
predicted("bug_hunt.2")
title = tables.TITLES["end"]
asked = "Q where an accident followed (dotted: −10)"
bc.show(charts.many(hunt.probes("end"), title, "updates", asked, "healthy", level=-10))

# %% [markdown]
# **See.** Even the healthy critics miss the right {{ DEFAULT.reward.accident }}. So compare with an
# agent you trust, here the healthy one: which leaves the grey lines, and in which direction?
# <!-- claim: (hunt().probe('healthy', 'end')[:, -1] > DEFAULT.reward.accident + 1).all() -->

# %% [markdown] tags=["instructor"] minutes=2
# Let them write the targets of `no_end` and `bonus_for_all` for a car that has just crashed, and
# say for each whether it is above or below −10.

# %% [markdown]
# ## Round 3: how much does the critic promise?
#
# The value that a critic gives to a state is what it *promises*: here, in seconds that the *rule*
# drove.
#
# > **Predict.** The road pays at most about 1 a second, and γ = {{ SETTINGS.gamma }}. What is the
# > most that a correct critic may promise if it counts the road's rewards alone, without a bonus?

# %%
predict("bug_hunt.3", "What is the most that such a critic may promise?", unit="")

# %%
predicted("bug_hunt.3")
most, title = tables.most(), tables.TITLES["promise"]
asked = f"promise Σ π Q, cut off at 20 (dotted: {most:.0f})"
probes, limits = hunt.probes("promise"), (-2, 20)
bc.show(charts.many(probes, title, "updates", asked, "healthy", limits=limits, level=most))

# %% [markdown]
# **Explain.** For the road's rewards alone the limit is 1 / (1 − γ) = {{ 1 / (1 - SETTINGS.gamma) |
# .0f }}. These critics also count entropy, KL and the demonstrations' bonus, so 5 does not bind
# them: compare with healthy. With the bonus c = {{ SETTINGS.bonus | .0f }} in *every* second the
# limit is {{ (1 + SETTINGS.bonus) / (1 - SETTINGS.gamma) | .0f }}. One agent's promise rises slowly
# past 10; in another panel both seeds leave the axes for a time.
# <!-- claim: {n for n in 'ABCDEF' if hunt().probe(n, 'promise').max() > 10} == {'E', 'F'} and
#   (hunt().probe('F', 'promise').max(axis=1) > 20).all() and (hunt().probe('F', 'promise')[:, -1] <
#   20).all() -->

# %% [markdown] tags=["instructor"] minutes=2
# Ask which of the two probes one should watch during training: Q at accidents, or the promise. A
# wrong promise shows without an accident.

# %% [markdown]
# ## Round 4: what has the actor learned from the rule?
#
# The last two probes look at the policy in the same seconds. How often is its most probable action
# what the rule does now, or what the rule does *one second later*? The table is from early in the
# training, after 500 to 1,250 updates.

# %%
table(tables.AGREEMENT, tables.agreement(hunt))

# %% [markdown]
# **See.** F seldom agrees with either. One of the others agrees with the rule's next action nearly
# as often as with its present one.
# <!-- claim: early('F') < early('C') < min(early(n) for n in ('A', 'B', 'D', 'E', 'healthy')) and
#   early('C', 'late') / early('C') > 0.85 > 0.75 > max(early(n, 'late') / early(n) for n in ('A',
#   'B', 'D', 'E', 'healthy')) -->
#
# The other probe is the probability of the policy's **rarest** action.
#
# > **Predict.** The right KL charges the policy for going where the rule would not. The flipped KL
# > charges it for *not* going where the rule might, and the stochastic rule gives each action a
# > little probability. What does the policy then do to an action that the rule seldom takes?

# %%
choices = ["it drops it as fast", "it drops it more slowly", "it keeps it as likely as at first"]
predict("bug_hunt.4", "What does the policy do to such an action, with the flipped KL?", choices)

# %% tags=["hide-input"]
predicted("bug_hunt.4")
title = tables.TITLES["rarest"]
asked = "log of the rarest action's probability"
bc.show(charts.many(hunt.probes("rarest"), title, "updates", asked, "healthy"))

# %% [markdown]
# **Explain.** With the right KL it costs little to drop an action. The flipped KL grows without
# bound when the probability of an action goes to zero, so the policy drops each more slowly. *Two*
# agents keep their rarest action far likelier than the healthy one. In one of the two the actor does
# not learn from Q: see Round 1.
# <!-- claim: {n for n in 'ABCDEF' if hunt().probe(n, 'rarest')[:, -1].min() > -20} == {'A', 'B'}
#   and (hunt().probe('healthy', 'rarest')[:, -1] < -30).all() -->

# %% [markdown] tags=["instructor"] minutes=2
# Ask for the limit of both divergences as one probability of π goes to zero, before anybody looks
# at the picture.

# %% [markdown]
# ### The verdict
#
# **Exercise (15 min, ●●●).** Name the bug of each agent. The check judges the six together. Find a
# picture or a table that decides each.


# %%
def diagnose(agent):
    """The bug of an agent, "A" to "F": flipped_kl, no_end, sampled, no_stop, bonus_for_all, ..."""
    # solution: the exercise's own


check.diagnose(diagnose)

# %% [markdown]
# <details><summary>After your verdict: which test finds which bug</summary>
#
# | agent | bug | where it shows | the repair |
# | --- | --- | --- | --- |
# | A | `flipped_kl` | rarest action far likelier, drawn actions drive well | Σ π (log π − log π̃) |
# | B | `sampled` | rarest action far likelier, drawn actions often fail | the expectation |
# | C | `shifted_labels` | agreement: later nearly as often as now | ask before the step |
# | D | `no_end` | Q at accidents far below the grey lines | (1 − terminated) |
# | E | `bonus_for_all` | promise past 10, highest return | bonus for demonstrations alone |
# | F | `no_stop` | promise leaves the axes for a time | `q.detach()` |
#
# - **B**: no gradient passes through a draw among nine actions: the KL alone teaches the actor,
#   towards the stochastic rule.
# - **C**: only the pull is shifted; the demonstrations still show the action of now.
# - **D** adds the value of a car that has just crashed. It is negative here, so Q is below −10. (In
#   lesson [[update_and_loop]] it was positive, and the pole fell.)
# - **E**: with a bonus for all, demonstrations have no advantage. E does what the slow rule does in
#   {{ 100 * as_the_rule('E') | .0f }} % of its seconds, the healthy agent in {{ 100 *
#   as_the_rule('healthy') | .0f }} %. Is that why E earns more? This is not tested.
# - **F**: the actor's loss changes the critic, and raises the Q of what the policy likes.
#
# </details>
# <!-- claim: abs(driven('A', True).success.mean() - driven('healthy', True).success.mean()) < 0.05
#   -->
# <!-- claim: (hunt().probe('D', 'end')[:, -1] < DEFAULT.reward.accident).all() and
#   all((hunt().probe(n, 'end')[:, -1] > DEFAULT.reward.accident).all() for n in 'ABCEF') -->

# %% [markdown] tags=["instructor"] minutes=2
# The order that works: F (promise leaves the scale for a time), B (fails when drawn), D
# (accidents), E (promise too high, the *best* return), C (nearly as often later as now), A (what is
# left: the rarest action). Let each group defend its verdict with a single picture.

# %% [markdown]
# ## A test without training
#
# Two of the six bugs are in this line:
#
# ```python
# target = reward + bonus + gamma * next_value
# ```
#
# The bonus belongs to demonstrations alone, and after an accident there is no next value. Both
# agents succeed all the same. A test finds both bugs in a millisecond: give the function a few
# transitions whose right target you have worked out by hand.
#
# **Exercise (20 min, ●●●).** Write that test. You are given a function
# `target(reward, demo, bonus, end, next_value, gamma)`, of which you do not see the code: bonus
# and gamma are floats, the rest arrays of shape (batch,); demo and end hold 1 or 0. Say whether it
# is wrong. The check gives your test three right functions and twelve wrong ones.
# <!-- claim: (lambda e: len(e.TARGETS) - len(e.RIGHT_TARGETS) == 12 and len(e.RIGHT_TARGETS) ==
#   3)(__import__('bootcourse.course.lessons.bug_hunt.target_probe', fromlist=['x'])) -->


# %%
def unmasks(target):
    """True if target(reward, demo, bonus, end, next_value, gamma) is wrong, False if right."""
    # solution: the exercise's own


check.unmasks(unmasks)

# %% [markdown] tags=["instructor"] minutes=1
# Ask which of the six their own programs test for today.

# %%
at_the_end = hunt.at_the_end("success")
fine = sum(np.all(at_the_end[name] > 0.75) for name in "ABCDEF")
compare_predictions(
    "bug_hunt",
    {
        1: f"three or four: {fine} of six",
        2: "no_end",
        3: round(most, 1),
        4: "it drops it more slowly",
    },
)

# %% [markdown]
# ## What you now know
#
# 1. A curve can look right although the code is wrong: four of six agents with a bug succeed; one
#    earns far more.
# 2. A probe asks one part of a learner something whose right answer is known. Compare with an agent
#    you trust. A probe that looks right clears only what it asks.
# 3. Ask the critic what an accident is worth, and how much it promises. Without a bonus a promise
#    far above {{ 1 / (1 - SETTINGS.gamma) | .0f }} is wrong here.
# 4. Ask the actor whether it does what the rule does *now*, and which actions it drops. Let it
#    drive by drawn actions, too.
# 5. A test with a few cases worked out by hand can find a wrong target without training.
#
# **Three questions to think about**
# - You may run one probe during your trainings from now on. Which, and at what value does it warn?
# - Two bugs at once: which pair could hide each other in the pictures above?
# - A bug raises the return of your method in a paper's table. How would a reader find out?

# %% [markdown] tags=["instructor"] minutes=1
# Answers to the three questions. (1) The promise: it costs one pass through the networks, needs
# neither accidents nor a teacher, and its bound is known, the largest reward of a second divided by
# 1 − γ, here 5 (7 with room for the bonus). (2) For example `no_end` and `bonus_for_all`: at
# accidents one pulls Q down and the other up. Ask for more pairs that move the same probe in
# opposite directions. (3) From the printed text hardly; from the code, if it ships, with tests of
# single functions; or when somebody else's program of the same method earns less.

# %% [markdown]
# **Read on**: Henderson et al., *Deep Reinforcement Learning that Matters* (arXiv 1709.06560);
# Engstrom et al., *Implementation Matters in Deep Policy Gradients* (arXiv 2005.12729). Next: [your
# teacher](your_teacher.ipynb).

# %% [markdown] tags=["instructor"]
# **On the board.** A table: six agents as rows, probes as columns, a cross where a probe is off.
#
# **To discuss.** How long would each of these bugs have lived in your last project?
