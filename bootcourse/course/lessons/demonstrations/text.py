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
# - train clones of a driver, one of them of yourself, and judge them by how they drive;
# - show how an error of a clone leads to the next one;
# - let a clone drive, have the rule label what it meets, and see what that changes.
#
# **Time** 50 minutes; running it takes under one minute. **It builds on** [lesson
# [[the_trap]]](the_trap.ipynb) and [lesson [[the_rule]]](the_rule.ipynb).

# %%
import bootcourse as bc
import numpy as np
import torch
from bootcourse.course import check, compare_predictions, own_code, predict, predicted, progress
from bootcourse.course.lessons.demonstrations import cloning, explorable, figures
from bootcourse.course.lessons.demonstrations.cloning import ACTION, RULE_ACTION
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
# Whose drives would you copy?

# %% [markdown] tags=["instructor"] minutes=3
# Count hands for each of the two and let one of each side give a reason. Do not resolve it.

# %% [markdown]
# ## Round 1: whose clones crash least?
#
# A **demonstration** is somebody's drive, kept as **transitions**, one for each decision: what the
# driver saw, what it did, what it was paid, what it saw next, and whether an accident ended the
# drive there. Begin with your own: drive this road until you get out once. (If you do not, the
# rule's drive stands for yours.)

# %% tags=["nbval-ignore-output"]
ROAD = 10
(world := bc.world(road=ROAD))

# %%
mine = [drive for drive in world.attempts if drive.success and not drive.accident]
whose = "your drives" if mine else "one drive of the rule"
own_rows = demonstration_rows(mine or [driven["the rule"][ROAD]])
print(f"{len(own_rows)} transitions from {whose}")

# %% [markdown]
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
# Now train five clones on each of four data sets: your drives, {{ SETTINGS.demonstration_episodes
# }} drives of the rule, as many of the stochastic rule, and the last once more, with each state
# labelled with the rule's action. Each clone then drives 100 new roads and takes its most probable
# action. The share of its data where that is the label is its **agreement**.
#
# > **Predict.** Clones of which 200 drives have the most accidents?

# %%
KINDS = ["the rule's drives", "the stochastic rule's drives", "its drives, the rule's labels"]
predict("demonstrations.1", "Clones of which 200 drives have the most accidents?", KINDS)

# %%
predicted("demonstrations.1")
torch.set_num_threads(1)  # small matrices are faster on one thread
unsure = bc.stochastic_rule_policy(bc.DEFAULT, np.random.default_rng(0))
by_rule, by_chance = bc.collect(200), bc.collect(200, policy=unsure)
labelled = by_chance.clone()
labelled[:, ACTION] = labelled[:, RULE_ACTION]
data = {whose: own_rows} | dict(zip(KINDS, (by_rule, by_chance, labelled), strict=True))
loss = own_code.yours_or_ours("cloning_loss")
clones = cloning.clones(data, loss)  # 1,500 updates with 64 rows each, trained side by side
measured = {name: cloning.measure(clones[name], rows) for name, rows in data.items()}
bc.show(figures.clones(measured))

# %% [markdown]
# **See.** *Agreement with its own data does not say who drives well.* These data differ: one in ten
# of the stochastic rule's decisions is drawn, and no clone can foresee it. Our clones of one drive
# know it almost by heart, and mostly crash. (Yours may differ.) Of the 200 drives, those without an
# accident make the clones that crash most. (To crash less is not yet to get out.)
# <!-- claim: round(1 / (1 - RULE_P)) == 10 -->
# <!-- claim: all(drive.accident == 0 for drive in rule_drives()) -->
#
# The last data set has the rule's labels, as the second has, and fewer transitions. So here its
# states help. Perhaps by **coverage**: labels beside the narrow path show how to return. Or because
# its drives end early: more of its rows, and so of the updates, show the way out.
#
# All this is after {{ UPDATES | , }} updates. The study's clones, with over 40 times as many, have
# the other order: ten of the rule all escape, crash in {{ 100 * accidents('bc') | .1f }} % of their
# drives (and earn {{ of('bc').scores('returns').mean() | .0f }}, less than the rule's {{
# of('rule').scores('returns').mean() | .0f }}), ten of the stochastic rule in {{ 100 *
# clones_of_the_stochastic_rule().scores('accident').mean() | .1f }} %.
# <!-- claim: of('bc').scores('returns').mean() < of('rule').scores('returns').mean() -->
# <!-- claim: UPDATES == 1500 -->
# <!-- claim: not of('bc').agents[0]['stochastic_demonstrations'] and len(of('bc')) == 10 -->
# <!-- claim: len(clones_of_the_stochastic_rule()) == 10 and updates_of(of('bc')) > 40 * UPDATES and
#   updates_of(clones_of_the_stochastic_rule()) > updates_of(of('bc')) -->
# <!-- claim: of('bc').agents[0]['demonstration_episodes'] == 200 -->

# %% [markdown] tags=["instructor"] minutes=14
# With a class: everybody keeps one drive that gets out, and you pool them. Return to the hands of
# *Look first*. The last data set separates two reasons: the states that it covers and the labels
# that it gives. It is also shorter; a group can cut the rule's drives to the same lengths and train
# again. Then ask what the study's clones do and do not show: all ten of the rule escape (lesson
# [[recorded_drives]]) after a longer training. But the loss does not say when it is long enough.
# <!-- claim: escaped('bc') == len(of('bc')) == 10 -->

# %% [markdown]
# ## Round 2: does one error lead to the next?
#
# An **error** of a clone is a decision unlike its teacher's. In each state of the teacher it has a
# probability ε. In the worst case the first error leads away from these states, and each decision
# after it is an error, too.
#
# > **Predict.** A drive of $T$ decisions becomes twice as long. By what factor does the expected
# > number of errors grow in the worst case, if errors are rare (ε T far below one)?

# %%
predict("demonstrations.2", "By what factor does the worst case grow?", ["less than 2", "2", "4"])

# %% [markdown]
# **Drag** ε down from 20 %. What becomes of the factor?

# %%
predicted("demonstrations.2")
explorable.compounding()

# %% [markdown]
# **See.** *The factor is 4 where errors are rare.* The first error comes at decision $t$ of $T$
# with a probability of at most ε. It and all that follow are $T - t + 1$ errors. Added up over $t$,
# that is at most $\epsilon \, T (T + 1) / 2$, which grows with $T^2$. If errors stay alone, there
# are $\epsilon \, T$ (the dashed line).
#
# Errors that lead to more errors are called **compounding errors** (Ross and Bagnell 2010). Do ours
# compound? Compare the errors of the rule's clones on 20 roads new to them: in the rule's states,
# and in their own. Dashed: the worst case for the errors in the rule's states.

# %%
rule_clones = clones[KINDS[0]]
alone = cloning.alone(rule_clones)  # their own drives on 20 roads, each up to its end
by_the_rule = driven["the rule"][:20]  # on the same roads
bc.show(figures.errors(rule_clones, by_the_rule, alone))
print(cloning.slowness(by_the_rule, alone))

# %% [markdown]
# **See.** *Yes. Clones and roads are the same in both solid lines; what the clones did before makes
# the difference.* It is not the worst case: after half a minute the upper line flattens, as clones
# recover or their drives end. Slowness feeds itself: the rule's drives hardly show a slow car in
# the free lane. There the clones err most of the time, stay slow, and meet such a state again.

# %% [markdown] tags=["instructor"] minutes=7
# Draw both bounds, T and T². Then stop at the slow car. Ask which rows in the data would show how
# to leave such a state, and who could supply them: a driver that errs (Round 1), or a teacher that
# labels the clone's own states (Round 3). An error is not yet an accident: ask how one could test
# which errors lead to the crashes (let the rule drive a part of each drive).

# %% [markdown]
# ## Round 3: what if the rule labels the clone's own states?
#
# What counts is what *your clone* does in the states in which it ends up. So let it drive, ask the
# rule what it would have done there, add these labelled states to the data, and train again:
# **DAgger**, for data aggregation (Ross, Gordon and Bagnell). It needs a teacher that answers in any state: a rule
# controller can, a recorded drive cannot.
#
# > **Predict.** You begin with 20 drives of the rule, and in each of two rounds you add 20 labelled
# > drives of the newest clone. All clones have equally many updates. Where does the last agree with
# > the rule more often than the first?

# %%
choices = ["in the rule's states and its own", "in its own alone", "in the rule's alone", "nowhere"]
predict("demonstrations.3", "Where does the last clone agree more than the first?", choices)

# %% [markdown]
# **Exercise (12 min, ●●○).** Write DAgger. `train(rows)` returns a driver, `drive(driver)` the
# transitions of its drives. Column `ACTION` holds what was done, which a clone copies;
# `RULE_ACTION` holds what the rule would have done.


# %%
def dagger(rows, train, drive, rounds):
    """A list of rounds + 1 drivers, each trained on all transitions so far.

    rows: the rule's transitions, a tensor (n, row). First train on them alone; then, in each round,
    let the newest driver drive, label its transitions with the rule's actions, add them, train.
    """
    # solution: the exercise's own


check.dagger(dagger)


# %%
predicted("demonstrations.3")
take_turns = own_code.yours_or_ours("dagger", doing="Taking turns")
three = cloning.Trainings(loss, seeds=range(3), episodes=20)  # side by side
drivers = take_turns(three.begin(bc.collect(20)), three.train, three.drive, rounds=2)
trainings = [cloning.measure(each, by_rule) for each in zip(*drivers, strict=True)]
bc.show(figures.taught(trainings, measured[KINDS[0]]))
rounds = np.mean(trainings, axis=0)
paid = np.mean([drive.rewards.sum() for drive in driven["the rule"]])
print(f"Return: first {rounds[0, 3]:.0f}, last {rounds[-1, 3]:.0f}; the rule {paid:.0f}")

# %% [markdown]
# **Explain.** *On average our clones come to agree less in the rule's states, and more in their
# own. Their own are those in which they drive, and now they seldom crash.* An error rate ε in a
# clone's own states counts the errors that others led to as well. In T decisions these are ε T
# errors, with no T².
#
# The three last clones learned from 60 drives, with as many updates as the clones of 200, and crash
# far less. But clones of the stochastic rule's states with the rule's labels (Round 1) do, too: that
# the states must be the clone's *own* is not shown. And the study's clones of the rule, trained
# longer, hardly crash either: DAgger can pay where training is short.
#
# A clone's loss does not ask what an action leads to. A learner that does: lesson
# [[learning_from_demonstrations]].

# %% [markdown] tags=["instructor"] minutes=5
# Ask what DAgger costs: here a label is free, with a human teacher each one is work, and somebody
# must let a bad driver drive. Then ask why the method keeps the old rows beside the newest: a clone
# that has learned to return to the path seldom visits the states beside it, and trained on its
# newest rows alone it could forget what to do there.

# %%
crashed = {name: measured[name][:, 2].mean() for name in KINDS}
there, own, *_ = rounds[-1] - rounds[0]
compare_predictions(
    "demonstrations",
    {1: max(crashed, key=crashed.get), 2: "4", 3: choices[(there <= 0) + 2 * (own <= 0)]},
)

# %% [markdown]
# ## What you now know
#
# 1. A clone learns to predict the demonstrator's action. Its agreement with its data does not say
#    how well it drives.
# 2. In this short training, clones of a driver that often errs crash less than clones of the rule;
#    in the study's long one, more.
# <!-- claim: clones_of_the_stochastic_rule().scores('accident').mean() > 10 * accidents('bc') -->
# 3. A clone is trained on the teacher's states and drives in its own, where one error can lead to
#    the next: ours, after {{ UPDATES | , }} updates, stay slow. With many more, ten of ten escape.
# <!-- claim: escaped('bc') == len(of('bc')) == 10 and accidents('bc') < 0.01 -->
# 4. DAgger asks the teacher for labels in the clone's own states.
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
