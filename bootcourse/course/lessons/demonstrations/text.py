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
# # Demonstrations
#
# **What you will be able to do**
# - collect demonstrations in three ways, and look into them before you learn from them;
# - train clones of a driver in seconds, and judge them by how they drive;
# - show how an error of a clone leads to the next one;
# - let a clone drive, have the rule label what it meets, and see what that changes.
#
# **Time** 57 minutes; running it takes about one minute. **It builds on** [lesson
# [[the_trap]]](the_trap.ipynb) and [lesson [[the_rule]]](the_rule.ipynb).

# %%
import bootcourse as bc
import numpy as np
import torch
from bootcourse.course import (
    check,
    compare_predictions,
    own_code,
    predict,
    predicted,
    progress,
    table,
)
from bootcourse.course.lessons.demonstrations import cloning, explorable, figures
from bootcourse.learn.demonstrations import demonstration_rows

progress("demonstrations")

# %% [markdown]
# ## Look first
#
# Two demonstrators drive the same 60 roads. One is the rule, the other the stochastic rule with
# p = {{ RULE_P }}: it draws one decision in ten from the other eight actions. Here is where they
# were in their first 30 seconds.
# <!-- claim: round(1 / (1 - RULE_P)) == 10 -->

# %% tags=["hide-input"]
unsure = bc.stochastic_rule_policy(bc.DEFAULT, np.random.default_rng(0))
driven = {"the rule": bc.record(bc.rule_policy(bc.DEFAULT), range(60), label="rule")}
driven["the stochastic rule"] = bc.record(unsure, range(60), label="stochastic rule")
title = "The rule drives along a narrow path, the stochastic rule strays from it"
bc.show(figures.where_they_were(driven, seconds=30, title=title))

# %% [markdown]
# Whose drives would you copy: the rule's, without an accident, or those of the stochastic rule,
# which often leaves the road?
# <!-- claim: all(drive.accident == 0 for drive in rule_drives()) -->

# %% [markdown] tags=["instructor"] minutes=4
# Count hands for each of the two and let one of each side give a reason. Do not resolve it.

# %% [markdown]
# ## Round 1: what is in a demonstration?
#
# A **demonstration** is somebody's drive, kept as **transitions**. A transition is one decision:
# what the driver saw, what it did, what it was paid, what it saw next, and whether an accident
# ended the drive there (*terminated*; a drive whose 150 s are over was not).
#
# **Exercise (6 min, ●●○).** Turn one drive into transitions.


# %%
def transitions(observations, actions, rewards, accident):
    """One row (s, s', a, r, terminated) for each decision: (T + 1, n), (T,), (T,) -> (T, 2n + 3).

    terminated is 1 where an accident ended the episode there, else 0; accident 0 means none.
    """
    # solution: the exercise's own


check.transitions(transitions)

# %% [markdown]
# The library's rows also hold what the rule would have done. Now collect {{
# SETTINGS.demonstration_episodes }} episodes from each demonstrator, as in the paper.
#
# > **Predict.** The rule gives 200 · 150 = 30,000 transitions. About nine of ten drives of the
# > stochastic rule end in an accident. How many transitions does it give, if the risk is the same
# > in each second?

# %%
choices = ["about 27,000", "about 12,000", "about 3,000"]
predict("demonstrations.1", "How many transitions does the stochastic rule give?", choices)

# %%
# NBVAL_CHECK_OUTPUT
predicted("demonstrations.1")
by_rule = bc.collect(200)
unsure = bc.stochastic_rule_policy(bc.DEFAULT, np.random.default_rng(0))
by_chance = bc.collect(200, policy=unsure)
ACTION, TERMINATED, RULE_ACTION = cloning.ACTION, cloning.TERMINATED, cloning.RULE_ACTION  # columns
rows = []
for name, each in (("the rule", by_rule), ("the stochastic rule", by_chance)):
    other = (each[:, ACTION] != each[:, RULE_ACTION]).float().mean()
    ended = int(each[:, TERMINATED].sum())
    rows.append([name, f"{len(each):,}", ended, f"{100 * other:.0f} %"])
table(["200 episodes of", "transitions", "end in an accident", "not the rule's action"], rows)

# %% [markdown]
# **See.** *A small risk in each second is a large one in a drive.* One drive in ten lasts
# 150 s: (1 − q)¹⁵⁰ = 0.1, so the risk q is {{ 100 * (1 - 0.1 ** (1 / 150)) | .1f }} % a second. The
# mean drive lasts 0.9 / q, about a minute: 200 minutes are 12,000 transitions.
# <!-- claim: 58 < 0.9 / (1 - 0.1 ** (1 / 150)) < 62 -->
#
# The third way: drive the road below yourself, until you get out once. Round 2 clones your drives
# that get out or, if there is none, the rule's.

# %% tags=["nbval-ignore-output"]
ROAD = 10
(world := bc.world(road=ROAD))

# %%
mine = [drive for drive in world.attempts if drive.success and not drive.accident]
whose = "your drives" if mine else "one drive of the rule"
own_rows = demonstration_rows(mine or [driven["the rule"][ROAD]])
print(f"{len(own_rows)} transitions from {whose}")

# %% [markdown] tags=["instructor"] minutes=6
# With a class: everybody keeps one drive that gets out, and you pool them. Human drives differ from
# the rule's in one way that matters in Rounds 2 and 3: people make mistakes and correct them.

# %% [markdown]
# ## Round 2: how well does a clone drive?
#
# **Behaviour cloning** (BC) is supervised learning, without rewards: the input is a state, the
# right answer $a_E$ the action that the demonstrator took there. The loss is the mean of
# $-\log \pi(a_E | s)$.
#
# **Exercise (5 min, ●○○).** Write it, in torch.


# %%
def cloning_loss(log_pi, expert_actions):
    """The loss, one number: log_pi (batch, 9), expert_actions (batch,) whole numbers, tensors."""
    # solution
    chosen = log_pi.gather(-1, expert_actions.unsqueeze(-1))
    return -chosen.mean()
    # end solution


check.cloning_loss(cloning_loss)

# %% [markdown]
# Now train a clone of your drives, and let it drive 100 new roads. It takes its most probable
# action. The share of states in which this is the demonstrated one is its **agreement**; in the
# others it **differs**.

# %%
torch.set_num_threads(1)  # small matrices are faster on one thread
loss = own_code.yours_or_ours("cloning_loss")
your_clone = cloning.clone(own_rows, loss)  # 1,500 updates with 64 rows each
agreement, _, crashes, _ = cloning.measure([your_clone], own_rows)[0]
print(f"The clone of {whose} agrees in {100 * agreement:.0f} % of its data.")
print(f"It has an accident in {100 * crashes:.0f} % of its drives.")

# %% [markdown]
# Our clone of one drive knows it almost by heart, and mostly crashes. (Yours may differ.) Do
# 200 drives help, and whose? Train eight clones on each of three data sets. In the third the
# stochastic rule drives, and each state is labelled with the rule's action.
#
# > **Predict.** Clones of which drives have the most accidents?

# %%
KINDS = ["the rule's drives", "the stochastic rule's drives", "its drives, the rule's labels"]
predict("demonstrations.2", "Clones of which drives have the most accidents?", KINDS)

# %%
predicted("demonstrations.2")
labelled = by_chance.clone()
labelled[:, ACTION] = labelled[:, RULE_ACTION]
data = dict(zip(KINDS, (by_rule, by_chance, labelled), strict=True))
clones = cloning.clones(data, loss)  # the seeds 0 to 7 of each, trained side by side
measured = {name: cloning.measure(clones[name], rows) for name, rows in data.items()}
bc.show(figures.clones(measured))

# %% [markdown]
# **See.** *Agreement does not say who drives well:* the rule's eight clones agree about equally,
# and some crash at least twice as often as others. The stochastic rule's clones crash far less than
# it does. (Is it that they take the likeliest action? Lesson [[recorded_drives]].)
#
# The third data set is labelled by the rule, as the first is, and has other states. So here the
# states help. These drives also end earlier; but four clones of the rule's drives, cut to the same
# lengths, crash far more often than those of the third set. We think it is **coverage**: the
# stochastic rule's drives contain more states, and show how to return to the path.
# <!-- claim: accidents_of_clones_of_cut_drives() > 0.25 -->
#
# All this is after {{ UPDATES | , }} updates. The study's clones, with over 40 times as many, have
# the other order: ten of the rule crash in {{ 100 * accidents('bc') | .1f }} % of their drives, ten
# of the stochastic rule, with more updates still, in {{ 100 *
# clones_of_the_stochastic_rule().scores('accident').mean() | .1f }} %.
# <!-- claim: UPDATES == 1500 -->
# <!-- claim: not of('bc').agents[0]['stochastic_demonstrations'] and len(of('bc')) == 10 -->
# <!-- claim: len(clones_of_the_stochastic_rule()) == 10 and updates_of(of('bc')) > 40 * UPDATES and
#   updates_of(clones_of_the_stochastic_rule()) > updates_of(of('bc')) -->
# <!-- claim: of('bc').agents[0]['demonstration_episodes'] == 200 -->

# %% [markdown] tags=["instructor"] minutes=7
# Return to the hands of *Look first*. The third data set separates two reasons: the states it
# covers and the labels it gives. Let a group repeat the control: cut the rule's drives to the
# lengths of the stochastic rule's, and train again. Then ask what the study's clones do and do not
# show: all ten of the rule escape (lesson [[recorded_drives]]) after a longer training. But the
# loss does not say when the training is long enough.
# <!-- claim: escaped('bc') == len(of('bc')) == 10 -->

# %% [markdown]
# ## Round 3: does one error lead to the next?
#
# In each state of its teacher, a copy decides wrongly with probability ε. **Drag** ε: how small
# must it be, so that half of the drives still follow the teacher after 30 s?

# %%
explorable.compounding()

# %% [markdown]
# How much can this cost over $T$ decisions? In the worst case, each one after the first error is
# wrong.
#
# > **Predict.** A drive becomes twice as long. By what factor can the expected number of wrong
# > decisions grow, if errors are rare (ε T is far below one)?

# %%
predict("demonstrations.3", "By what factor does the worst case grow?", ["less than 2", "2", "4"])

# %% [markdown]
# <details><summary>The answer, in five lines</summary>
#
# Until its first error the clone is in the teacher's states. So the first error comes at decision
# $t$ of $T$ with a probability of at most ε. In the worst case each of the $T - t + 1$ decisions
# from there on is wrong. The expected number of wrong decisions is at most
#
# $$ \sum_{t=1}^{T} \epsilon \, (T - t + 1) = \epsilon \, \frac{T (T + 1)}{2} $$
#
# which grows with $T^2$ as long as it is well below $T$.
#
# </details>


# %%
# NBVAL_CHECK_OUTPUT
predicted("demonstrations.3")


def worst_case(error, decisions):
    """Expected wrong decisions: the t-th is wrong with a probability of at most ε t, and of 1."""
    return sum(min(1, error * t) for t in range(1, decisions + 1))


rows = []
for error in (0.1, 0.01, 0.001):
    short, whole = worst_case(error, 75), worst_case(error, 150)
    rows.append([error, f"{short:.1f}", f"{whole:.1f}", f"{whole / short:.1f}"])
table(["ε", "wrong decisions in 75 s", "in 150 s", "ratio"], rows)

# %% [markdown]
# **See.** The factor is 4 where errors are rare. Where they are frequent, nearly the whole drive is
# wrong anyway.
#
# Errors that lead to more errors are called **compounding errors** (Ross and Bagnell 2010). Do ours
# compound? Compare how often the rule's clones differ from it: in the states of its drives, and in
# those of their own drives, up to their end.

# %%
rule_clones = clones[KINDS[0]]
alone = cloning.alone(rule_clones)  # their own drives on the 60 roads
bc.show(figures.differing(rule_clones, driven["the rule"], alone))
print(cloning.slowness(driven["the rule"], alone))

# %% [markdown]
# **See.** *First they err in the rule's states, too: mostly they steer too early or too late. Then
# one error feeds itself: slowness after the lane change.* The rule accelerates at once, so its
# drives hardly show a slow car in the free lane. The clone keeps its speed, stays slow, and meets
# such states again.
# <!-- claim: early_errors()[0] > 0.3 and early_errors()[1] > 0.8 -->
#
# Which counts more? Let the rule drive the first 15 s, or only the seconds 15 to 40, and the clone
# the rest.

# %%
tests = {
    "nothing": [drive for drive in alone if drive.seed < 20],
    "the first 15 s": cloning.with_the_rule(rule_clones, 0, 15),
    "seconds 15 to 40": cloning.with_the_rule(rule_clones, 15, 40),
}
table(*figures.of_tests(tests))

# %% [markdown]
# **See.** *The first 15 s count more.* If the rule drives them, the clones later differ less, so
# their errors do compound, and they seldom crash. In the third row they are far less slow than in
# the first, and crash almost as often: slowness alone does not explain the crashes. (Trained
# longer, they hardly crash: Round 2.)

# %% [markdown] tags=["instructor"] minutes=6
# Stop at the slow car. Ask which rows in the data would show how to leave such a state, and who
# could supply them: a driver that errs (Round 2), or a teacher that labels the clone's own states
# (Round 4). Then ask what the last row of the table rules out: that the slowness makes most of the
# accidents. Draw both bounds, T and T².

# %% [markdown]
# ## Round 4: what if the rule labels the clone's own states?
#
# The states that count are those in which *your clone* ends up. So let it drive, ask the rule what
# it would have done there, add these labelled states to the data, and train again: **DAgger**, for
# data aggregation (Ross, Gordon and Bagnell). It needs a teacher that answers in any state: a rule
# controller can, a recorded drive cannot.
#
# > **Predict.** You begin with 20 drives of the rule, and in each of three rounds you add 20
# > labelled drives of the newest clone. All clones have equally many updates. Where does the last
# > agree with the rule more often than the first?

# %%
choices = ["in the rule's states and its own", "in its own alone", "in the rule's alone", "nowhere"]
predict("demonstrations.4", "Where does the last clone agree more than the first?", choices)

# %% [markdown]
# **Exercise (12 min, ●●○).** Write DAgger. `train(rows)` returns a driver, `drive(driver)` the
# transitions of its drives, whose column `ACTION` holds what was done, which a clone copies, and
# `RULE_ACTION` what the rule would have done.


# %%
def dagger(rows, train, drive, rounds):
    """A list of rounds + 1 drivers, each trained on all transitions so far.

    rows: the rule's transitions, a tensor (n, row). First train on them alone; then, in each round,
    let the newest driver drive, label its transitions with the rule's actions, add them, train.
    """
    # solution: the exercise's own


check.dagger(dagger)


# %%
predicted("demonstrations.4")
take_turns = own_code.yours_or_ours("dagger", doing="Taking turns")
three = cloning.Trainings(loss, seeds=range(3), episodes=20)  # side by side
drivers = take_turns(three.begin(bc.collect(20)), three.train, three.drive, rounds=3)
trainings = [cloning.compared(each, by_rule) for each in zip(*drivers, strict=True)]
table(*figures.of_trainings(trainings, measured[KINDS[0]]))

# %% [markdown]
# **Explain.** *In our trainings the clone comes to agree less in the rule's states, and more in its
# own.* A probability of at most ε there adds up to at most ε T errors, with no T². (But compare
# rows 1 and 2: which errors are left counts, too.)
#
# The last one learned from 80 drives, with as many updates as the clones of 200, and crashes far
# less. Three trainings do not show that each one works: try `seeds=range(3, 7)`.
#
# The study's clones of the rule, trained longer, hardly crash either: DAgger can pay where training
# is short.
#
# A clone can leave out its teacher's rare slips (Round 2), but its loss does not ask what an action
# leads to. A learner that does: lesson [[learning_from_demonstrations]].

# %% [markdown] tags=["instructor"] minutes=7
# Ask what DAgger costs: here a label is free, with a human teacher each one is work, and somebody
# must let a bad driver drive. Then ask why the method keeps the old rows beside the newest: a clone
# that has learned to return to the path seldom visits the states beside it, and trained on its
# newest rows alone it could forget what to do there.

# %%
crashed = {name: of_each[:, 2].mean() for name, of_each in measured.items()}
rounds = np.mean(trainings, axis=0)
there, own, *_ = rounds[-1] - rounds[0]
compare_predictions(
    "demonstrations",
    {
        1: "about 12,000",
        2: max(crashed, key=crashed.get),
        3: "4",
        4: choices[(there <= 0) + 2 * (own <= 0)],
    },
)

# %% [markdown]
# ## What you now know
#
# 1. A demonstration is a list of transitions. An accident terminates the last one, the end
#    of the time does not.
# 2. A clone's agreement with its data does not say how well it drives.
# 3. A clone is trained on the teacher's states and drives in its own, where one error can lead to
#    the next: ours, after {{ UPDATES | , }} updates, stay slow. With many more, ten of ten escape.
# <!-- claim: escaped('bc') == len(of('bc')) == 10 and accidents('bc') < 0.01 -->
# 4. In this short training, clones of a driver that often errs crash less than clones of the rule;
#    in the study's long one, more.
# <!-- claim: clones_of_the_stochastic_rule().scores('accident').mean() > 10 * accidents('bc') -->
# 5. DAgger asks the teacher for labels in the clone's own states.
#
# **Three questions to think about**
# - The rule reads the true places and speeds of the cars, the clone 26 numbers. Can two different
#   states of the road look the same to the clone, although the rule decides differently in them?
# - The teacher is a person, who watches and says "left now". What becomes hard in DAgger?
# - A demonstrator that crashes at the end of each drive: which of its rows would you keep?
#
# **Read on**: Pomerleau, *ALVINN* (1989), an early clone that drove; Ross, Gordon and Bagnell on
# *DAgger* (arXiv 1011.0686); Laskey et al., *DART* (arXiv 1703.09327), which disturbs the teacher.
# Next: [the soft constraint](soft_constraint.ipynb).

# %% [markdown] tags=["instructor"] minutes=4
# **Model answers.**
#
# - *Two states that look the same?* Yes: the clone sees the four nearest cars within
#   {{ DEFAULT.sight.distance }} m, and the rule reads the place and speed of each of the
#   {{ DEFAULT.vehicles }}. A fifth car in the target lane is invisible to the clone. In such states
#   the best clone gives each action its frequency in the data, and disagrees on the rarer ones.
# <!-- claim: DEFAULT.sight.neighbours == 4 < DEFAULT.vehicles - 1 -->
# - *A person as the teacher?* A person corrects what happens and does not answer a question about a
#   state: labels come late by a reaction time, and without the feedback of one's own steering they
#   get worse. That is why variants let the person take over the wheel for a while.
# - *A demonstrator that crashes?* Keep the rows that lead to good states, drop the last seconds.
#   How many seconds? Go back to a state from which a driver that you trust avoids the accident.
#   That can be tested: start the rule in these states.

# %% [markdown] tags=["instructor"]
# **On the board.** Two trajectories that part after one wrong action, and the shaded region where
# the teacher was.
#
# **To discuss.** Who pays for labels in the real world, and what does that do to DAgger?
