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
# - tell six silent bugs apart by curves and probes, beside a healthy agent;
# - write a probe of one part of a learner;
# - test a learner's labels and its target without training.
#
# **Time** 40 minutes; running it takes under one minute. **It builds on** the losses of lesson
# [[discrete_sac]], the update of lesson [[update_and_loop]], the soft constraint ([[soft_constraint]]) and
# learning from demonstrations ([[learning_from_demonstrations]]).

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
from bootcourse.course.lessons.bug_hunt import bugs, figures

hunt = bugs.Hunt()
progress("bug_hunt")

# %% [markdown]
# ## Look first
#
# Seven versions of the paper's method were trained for {{ bugs.UPDATES | , }} updates, with two seeds each. One is
# healthy. Each of the others, A to F, has one **silent bug**: a wrong line that raises nothing and prints nothing.
# <!-- claim: len(bugs.LEARNERS) == 7 and bugs.SEEDS == 2 -->
#
# The healthy agent and another drive on the same road. Watch when each reaches the left lane, and how fast it drives
# there. Which has the bug?

# %% tags=["nbval-ignore-output"]
bc.recording(figures.two_drives(hunt), height=360)

# %% [markdown] tags=["instructor"] minutes=1
# Let them vote which of the two has the bug, and say why. Do not tell.

# %% [markdown]
# ## Round 1: which agents would you suspect?
#
# The return in training, without the bonus:

# %%
bc.show(figures.returns(hunt))

# %% [markdown]
# **See.** *A curve can look right although the code is wrong.* A, C and D end about where the healthy agent ends.
# B and F look ill. E earns far *more*. **The second driver above is E:** it reaches the left lane after
# {{ in_left_lane('E')[0] }} s, the healthy one after {{ in_left_lane('healthy')[0] }} s. There it drives
# {{ in_left_lane('E')[1] | .0f }} m/s (median), its teacher, the rule, {{ in_left_lane('rule')[1] | .0f }} m/s.
# <!-- claim: in_left_lane('E')[0] > 2 * max(in_left_lane('rule')[0], in_left_lane('healthy')[0]) -->
# <!-- claim: in_left_lane('E')[1] > in_left_lane('rule')[1] + 2 -->
#
# *Do crashes tell?* On {{ len(figures.ROADS) }} new roads (first seeds, likeliest actions) D, whose curve looks right,
# crashes on {{ 100 * driven('D') | .0f }} %, the healthy agent on {{ 100 * driven('healthy') | .0f }} %, and A, which
# has a bug, on {{ 100 * driven('A') | .0f }} %. So few crashes are no proof of right code.
# <!-- claim: driven('A') < driven('healthy') and more_crashes('A') < 0.01 -->
# <!-- claim: min(late('E', 'accident')) > 0 -->
# <!-- claim: driven('D') > 2.5 * driven('healthy') > 0 and more_crashes('D') < 0.005 -->
# <!-- claim: late('healthy', 'accident') == [0, 0] and
#   max(h for n in 'ABCDF' for h in
#   hunt().at_the_end('return')[n]) < min(hunt().at_the_end('return')['E']) -->
# <!-- claim: all(0.9 < ends(name) < 1.1 for name in 'ACD') and ends('E') > 1.5 -->
# <!-- claim: max(ends('B'), ends('F')) < 0.1 -->
#
# The six bugs, each in a line that you know:
#
# | bug | where | right | with the bug | known from |
# |---|---|---|---|---|
# | `no_end` | target | `gamma * (1 - end) * next_value` | `gamma * next_value` | the pole ([[update_and_loop]]) |
# | `bonus_for_all` | target | `bonus * demo` | `bonus` | the leash ([[learning_from_demonstrations]]) |
# | `no_stop` | actor's loss | `q.detach()` | `q`: the loss trains the critic, too | `detach` ([[discrete_sac]]) |
# | `sampled` | both | Σ π (Q − α log π) | Q − α log π of one drawn action | soft value ([[discrete_sac]]) |
# | `flipped_kl` | both | Σ π (log π − log rule) | Σ rule (log rule − log π) | KL ([[soft_constraint]]) |
# | `shifted_labels` | actor's loss | `kl(s, rule(s))` | `kl(s, rule(s_next))` | labels ([[demonstrations]]) |
#
# <!-- claim: settings_for('bootstrapped').kl_in_target -->

# %% [markdown] tags=["instructor"] minutes=2
# Ask which agent they would have published. Then let each say of one bug what it could do to a curve.

# %% [markdown]
# ## Round 2: what is an accident worth?
#
# A **probe** asks one part of a learner a question. Where an accident ends the episode, the right Q is the reward,
# {{ DEFAULT.reward.accident }}.
#
# > **Predict.** A row of the agent's own ends in an accident. Which two of the six bugs change its target?

# %%
pairs = [
    "no_end and bonus_for_all",
    "no_end and flipped_kl",
    "flipped_kl and sampled",
    "bonus_for_all and no_stop",
]
predict("bug_hunt.1", "Which two change the target at an accident?", pairs)

# %%
predicted("bug_hunt.1")
for bug in bugs.LEARNERS:
    y = bugs.target_of(bug)(reward=-10, demo=0, bonus=2, end=1, next_value=5, gamma=0.8)
    print(f"{bug:14} target {float(y):+.0f}")

# %% [markdown]
# > **Predict.** The next value was 5 here. With another next value, which of the two bugs can pull the target
# > *below* {{ DEFAULT.reward.accident }}?

# %%
predict("bug_hunt.2", "Which pulls it below −10?", ["no_end", "bonus_for_all", "both", "neither"])

# %% [markdown]
# **Exercise (6 min, ●●○).** Write the probe: the mean of Q(s, a) − r over the rows where an accident ended
# the drive. A right critic answers 0.


# %%
def end_error(q, actions, rewards, terminated):
    """Mean Q(s, a) - r of rows with terminated 1; 0 if none. q: (batch, 9); others: (batch,)."""
    # solution
    taken = q[np.arange(len(actions)), actions]
    ended = terminated > 0
    if not ended.any():
        return 0.0
    return (taken[ended] - rewards[ended]).mean()
    # end solution


check.end_error(end_error)

# %%
predicted("bug_hunt.2")
drives = bc.record(bc.stochastic_rule_policy(bc.DEFAULT, np.random.default_rng(1)), range(50))
seen = bugs.transitions(drives)
probe = own_code.yours_or_ours("end_error", doing="Asking")
for name in hunt.names:
    q = hunt.agent(name).q_values(seen.states)
    print(f"{name:8} {probe(q, seen.actions, seen.rewards, seen.terminated):+6.1f}")

# %%
bc.show(figures.accidents(hunt))

# %% [markdown]
# **See.** With `no_end` the target is −10 + 0.8 · next value: below −10 as soon as the next value is below 0.
# `bonus_for_all` adds 2 to the target of each row of the agent's own.
#
# The numbers are your probe's answers at the stochastic rule's accidents, which are no agent's own. There the healthy
# critic misses by {{ asked('healthy') | .0f }}, and A, which has a bug, is nearest to 0. The lines show Q itself at
# each agent's own accidents: even there the healthy critic ends near {{ line_end('healthy') | .0f }}. *So 0 is not the
# measure. The healthy twin is*: which agents end *far* from the grey lines?
# <!-- claim: min('ABCDEF', key=lambda name: abs(asked(name))) == 'A' and abs(asked('A')) < abs(asked('healthy')) -->
# <!-- claim: asked('D') < -10 < 0 < asked('healthy') -->
# <!-- claim: (hunt().probe('healthy', 'end')[:, hunt().updates >= 1000] > DEFAULT.reward.accident + 1).all() -->

# %% [markdown] tags=["instructor"] minutes=2
# Let them write the targets of `no_end` and `bonus_for_all` for a car that has just crashed, and say for each
# whether it is above or below −10.

# %% [markdown]
# ## Round 3: how much does the critic promise?
#
# In each state a critic *promises* a value, Σ π Q. We take its mean over states that the *rule* came to.
#
# > **Predict.** The road pays at most about 1 a second, and γ = {{ SETTINGS.gamma }}. What is the
# > most that a critic may promise if it adds the bonus c = {{ SETTINGS.bonus | .0f }} in *every*
# > second? Leave entropy and KL aside.

# %%
predict("bug_hunt.3", "The most that such a critic may promise?", unit="")

# %%
predicted("bug_hunt.3")
bc.show(figures.promises(hunt))

# %% [markdown]
# **Explain.** This is the **ceiling** of lesson [[values]], r_max / (1 − γ). Here it is
# {{ 1 / (1 - SETTINGS.gamma) | .0f }}, and with a bonus in every second
# {{ (1 + SETTINGS.bonus) / (1 - SETTINGS.gamma) | .0f }}. (The grey line may lie between: the
# demonstrations got the bonus.)
#
# Two agents promise far more. One stays below the upper ceiling, the other rises above it. Which bugs can they have?
# <!-- claim: promised('E').min() > 2 * promised('healthy').max() and
#   all(peaks(n).max() < 7 for n in ('healthy', *'ABCD')) -->
# <!-- claim: peaks('E').max() < figures.most() and peaks('F').min() > 3 * figures.most() -->

# %% [markdown] tags=["instructor"] minutes=1
# Ask which of the two probes one should watch during training: Q at accidents, or the promise. A wrong
# promise shows without an accident.

# %% [markdown]
# ## Round 4: which actions does the policy drop?
#
# The KL pulls the policy towards the stochastic rule, which gives each action a little probability. How probable
# is the policy's **rarest** action, in the states of Round 3?
#
# > **Predict.** Round 1's table has both KLs. Let the probability π of one action go to 0: what does each KL
# > charge for it? So how does the rarest action's probability fall with `flipped_kl`?

# %%
predict("bug_hunt.4", "Beside the healthy one, it falls ...", ["faster", "as fast", "more slowly"])

# %%
predicted("bug_hunt.4")
bc.show(figures.rarest(hunt))

# %% [markdown]
# **Explain.** The right KL weighs each action by π, so an action that the policy hardly takes costs hardly
# anything. The flipped KL weighs it by the rule's probability, and grows without bound as π goes to 0.
#
# *Two* agents' rarest action stays far likelier to the end. Which other bug can do that? A test without training: nine
# actions are equally likely, and one is worth 5 more. How strongly does the actor's loss pull it up?
# <!-- claim: {n for n in 'ABCDEF' if hunt().probe(n, 'rarest')[:, -1].min() > -20} == {'A', 'B'}
#   and (hunt().probe('healthy', 'rarest')[:, -1] < -30).all() -->

# %%
for bug in bugs.LEARNERS:
    print(f"{bug:14} {bugs.pull(bug):+.2f}")

# %% [markdown]
# **See.** The right loss pulls the better action up. In `sampled` no π multiplies Q, and no gradient passes through a
# draw among nine: so Q moves its policy {{ 'not at all' if abs(bugs.pull('sampled')) < 0.005 else 'a little' }}. What
# is left, on average, is the pull towards the stochastic rule, and the noise of the draws.
# <!-- claim: abs(bugs.pull('sampled')) < 0.005 and all(abs(bugs.pull(bug) - bugs.pull('none')) < 1e-6
#   for bug in bugs.LEARNERS if bug != 'sampled') and bugs.pull('none') > 0.3 -->

# %% [markdown] tags=["instructor"] minutes=1
# Ask for the limit of both divergences as one probability of π goes to zero, before anybody looks at the
# picture.

# %% [markdown]
# ## The verdict
#
# **How does one hunt?** *Take one suspect, and ask what it must do in a place where few others do it.* `no_end` must
# show where drives end, `bonus_for_all` in the promise, `flipped_kl` where π is almost 0. So a probe is the prediction
# of one suspect. A fourth, `shifted_labels`, teaches the rule's *next* action, so the policy should act a second too
# early. Compare the whole lines:

# %%
bc.show(figures.likeliest(hunt))

# %% [markdown]
# Where the lines of the other four pictures end:

# %%
bc.show(figures.line_ends(hunt))

# %% [markdown]
# **Exercise (8 min, ●●○).** Name the bug of each agent. *Far* means: a dot outside the light grey. Look at whole lines,
# too: some bugs show only early, or at a peak.


# %%
def diagnose(agent):
    """The bug of an agent, "A" to "F", by its name in Round 1's table."""
    # solution: the exercise's own


check.diagnose(diagnose)

# %% [markdown]
# <details><summary>After your verdict: what decides</summary>
#
# | agent | return | Q at own accidents | promise | rarest action | now, not next | bug |
# |---|---|---|---|---|---|---|
# | A | = | = | = | ↑ | = | `flipped_kl` |
# | B | ↓ | = | ↓ | ↑ | = | `sampled` |
# | C | = | = | = | = | ↓ early | `shifted_labels` |
# | D | = | ↓ | = | = | = | `no_end` |
# | E | ↑ | ↑ | ↑ | = | ↓ | `bonus_for_all` |
# | F | ↓ | ↑ | ↑ peak: {{ peaks('F').max() | .0f }}, {{ peaks('F').min() | .0f }} | = | ↓ | `no_stop` |
#
# - **B**: Q does not move the policy (Round 4), so it earns little.
# - **D** adds γ times the value of the state after the crash. No row begins there, so no data correct this *guess*. It
#   feeds itself, as in lesson [[update_and_loop]], but downwards: after the stochastic rule's crashes D gives the state
#   {{ after_the_end('D') | .0f }} and the crash {{ DEFAULT.reward.accident + asked('D') | .0f }}. (The healthy critic
#   gives that state {{ after_the_end('healthy') | .0f }}, and does not use it.)
# - **E**: with a bonus for every row the leash holds nobody near the rule.
# - **F**: the actor's loss, not the target, raises the Q of what the policy likes.
#
# </details>
# <!-- claim: (lambda e, h: e.max() < h.min())(*(figures.last(hunt(), 'alike')[n] for n in ('E', 'healthy'))) -->
# <!-- claim: alike('E', 3000, 5000) > 0.65 > 0.5 > alike('E', 7000, 7500) -->
# <!-- claim: after_the_end('D') < -18 and abs(after_the_end('D') - asked('D') - DEFAULT.reward.accident) < 3 -->
# <!-- claim: (lambda end, grey: all(end(n).max() < grey - 0.1 for n in 'EF') and
#   all(end(n).min() > grey - 0.1 for n in 'ABCD'))(lambda n: now_not_next(n)[:, -figures.LAST:].mean(axis=1),
#   now_not_next('healthy')[:, -figures.LAST:].mean(axis=1).min()) -->
# <!-- claim: (lambda grey, far: ''.join('=↑↓'[1 if v.max() > h.max() + d else 2 if v.min() < h.min() - d else 0]
#   for n in 'ABCDEF' for (v, h), d in zip([(g[n], g['healthy']) for g in grey], far)))([hunt().at_the_end('return'),
#   *(figures.last(hunt(), p) for p in ('end', 'promise', 'rarest'))], figures.FAR) ==
#   '===↑' '↓=↓↑' '====' '=↓==' '↑↑↑=' '↓↑↑=' -->
# <!-- claim: all(b[:, -1].max() < 1.5 and b.max(axis=1).min() > 4 and a[:, -1].min() > 5 for a, b in
#   [[hunt().probe(n, 'promise') for n in 'AB']]) -->
# <!-- claim: (lambda end: min(end(n).min() for n in 'EF') > end('healthy').max() + 1.5 and all(
#   end('healthy').min() - 1 < value < end('healthy').max() + 1 for n in 'ABC' for value in end(n)))(
#   lambda n: hunt().probe(n, 'end')[:, -1]) -->
# <!-- claim: (lambda end: max(end(n).max() for n in 'CDEF') < end('healthy').max() + 5 and min(
#   end(n).min() for n in 'AB') > end('healthy').max() + 15)(lambda n: figures.last(hunt(), 'rarest')[n]) -->
# <!-- claim: (lambda c, h: (c.max(axis=0) < h.min(axis=0)).all())(*(now_not_next(n)[:,
#   (hunt().updates >= 1000) & (hunt().updates <= 5000)] for n in ('C', 'healthy'))) -->
# <!-- claim: (hunt().probe('D', 'end')[:, -1] < DEFAULT.reward.accident).all() and
#   all((hunt().probe(n, 'end')[:, -1] > DEFAULT.reward.accident).all() for n in 'ABCEF') -->

# %% [markdown] tags=["instructor"] minutes=2
# The order that works: F (promise leaves the axes), E (promise too high, the *best* return), D (accidents), B
# and A (rarest action; B has the low return), C (the fourth probe, early). Let each group defend its verdict with
# a single picture, and then think of a test for C before they go on.

# %% [markdown]
# ## Two tests, no training, no healthy twin
#
# **The labels.** A learner's label is right where it equals the rule's answer in the *same* second. Which bug must fail
# this test?
#
# **The target.** The healthy line is
#
# ```python
# target = reward + bonus * demo + gamma * (1 - end) * next_value
# ```
#
# **Exercise (15 min, ●●●).** Write the test of a target; you may call the function, not read it. `bonus` and `gamma`
# are floats, the rest arrays (batch,) of your choice; `demo` and `end` hold 1 or 0. Four transitions are enough.


# %%
def unmasks(target):
    """True if target(reward, demo, bonus, end, next_value, gamma) is wrong, False if right."""
    # solution: the exercise's own


check.unmasks(unmasks)

# %% [markdown]
# Test the target of the seven untrained learners, and their labels in the stochastic rule's drives:

# %%
test = own_code.yours_or_ours("unmasks", doing="Testing")
print(f"{'bug':14} labels right  target")
for bug in bugs.LEARNERS:
    right = np.concatenate([bugs.labels(bug, drive) == drive.rule_actions for drive in drives])
    print(f"{bug:14} {right.mean():12.0%}  {'WRONG' if test(bugs.target_of(bug)) else 'right'}")

# %% [markdown]
# **See.** *Before any training, two tests find three of the six bugs.* `no_stop` is in the actor's loss. Of
# `flipped_kl` and `sampled` the target's part is inside `next_value`, which your test makes up.
# <!-- claim: all(agree(bug).all() == (bug != 'shifted_labels') for bug in bugs.LEARNERS) -->
# <!-- claim: 0.28 < agree('shifted_labels').mean() < 0.42 -->
# <!-- claim: found() == {'no_end', 'bonus_for_all'} -->

# %% [markdown] tags=["instructor"] minutes=1
# Ask which of the six their own programs test for today, and in which drive the test of the labels would miss
# its bug: one in which the rule's answer stays the same. `sampled`, too, acts inside `next_value`; keep that
# for the second question below.

# %%
limit = round(figures.most(), 1)
compare_predictions(
    "bug_hunt", {1: "no_end and bonus_for_all", 2: "no_end", 3: limit, 4: "more slowly"}
)

# %% [markdown]
# ## What you now know
#
# 1. *A curve shows a symptom.* Three of six agents with a bug end about where the healthy one does.
# 2. *A probe asks one part one question*, and clears only what it asks: at the end C's bug shows in none of our four.
# 3. *The order of work.* Before training, test labels and target: this finds three of the six bugs. Then watch the
#    promise against the ceiling, with room for the bonus. Then compare with a twin: even the healthy Q is off at ends.
#
# **Three questions to think about**
# - From now on you may watch one probe in each training. Which one, and at what value should it warn you?
# - Three of the bugs pass both tests. What would you test for each, without training?
# - A bug raises the return of your method in a paper's table. How would a reader find out?
#
# <details><summary>Answers</summary>
#
# - *One probe?* The promise: it needs no accidents. With the bonus even the healthy one passes 5, with a peak of
#   {{ peaks('healthy').max() | .0f }}, so warn at 7: this finds E and F, and no other.
#   <!-- claim: all((peaks(n) > 7).all() == (n in 'EF') and (peaks(n) > 7).any() == (n in 'EF') for n in
#   ('healthy', *'ABCDEF')) -->
# - *Three tests?* `no_stop`: the actor's loss gives the critics no gradient. `sampled`: twice on one batch, the loss is
#   the same number. `flipped_kl`: the KL of two distributions equals a sum by hand.
# - *A table?* Hardly. If the authors publish their code, a reader can test its single functions.
#
# </details>

# %% [markdown] tags=["instructor"] minutes=1
# Take the second question in class before anybody opens the answers: each group writes the test of one bug.

# %% [markdown]
# **Read on**: Henderson et al., *Deep Reinforcement Learning that Matters* (arXiv 1709.06560); Engstrom et
# al., *Implementation Matters in Deep Policy Gradients* (arXiv 2005.12729).
#
# Your learner is sound. Now for the other half: what makes a good teacher? That is lesson [your
# teacher](your_teacher.ipynb).

# %% [markdown] tags=["instructor"]
# **On the board.** A table: six agents as rows, probes as columns, a cross where a probe is off.
#
# **To discuss.** How long would each of these bugs have lived in your last project?
