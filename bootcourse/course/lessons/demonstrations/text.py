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
# - train clones of drivers, and judge them by how they drive;
# - find where a clone fails, and which rows help;
# - let a clone drive, and have the rule label what it meets.
#
# **Time** 48 minutes; running it takes under one minute. **It builds on** lessons [[the_trap]],
# [[discrete_sac]] and [[the_rule]].

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
    shipped,
    table,
)
from bootcourse.course.lessons.demonstrations import cloning, figures
from bootcourse.course.lessons.demonstrations.cloning import ACTION, RULE_ACTION
from bootcourse.learn.demonstrations import demonstration_rows

progress("demonstrations")

# %% [markdown]
# ## Look first
#
# Drive this road until you get out once without an accident: you will train clones of your drive.

# %% tags=["nbval-ignore-output"]
ROAD = 10
(world := bc.world(road=ROAD))

# %% [markdown]
# Two others drive 60 roads: the rule, and the **stochastic rule**, which takes the rule's action with
# probability p = {{ RULE_P }} and otherwise one of the other eight.

# %% tags=["hide-input"]
unsure = bc.stochastic_rule_policy(bc.DEFAULT, np.random.default_rng(0))
driven = {"the rule": bc.record(bc.rule_policy(bc.DEFAULT), range(60), label="rule")}
driven["the stochastic rule"] = bc.record(unsure, range(60), label="stochastic rule")
title = "The rule drives along a narrow path, the stochastic rule strays from it"
bc.show(figures.where_they_were(driven, seconds=30, title=title))

# %% [markdown] tags=["instructor"] minutes=3
# Ask whose drives they would copy. Count hands for each of the two and let one of each side give a reason. Do
# not resolve it.

# %% [markdown]
# ## Round 1: whose clones crash least?
#
# A **demonstration** is somebody's drive, kept as transitions.

# %%
mine = [drive for drive in world.attempts if drive.success and not drive.accident]
whose = "your drives" if mine else "one drive of the rule"
own_rows = demonstration_rows(mine or [driven["the rule"][ROAD]])
print(f"{len(own_rows)} transitions from {whose}")

# %% [markdown]
# **Behaviour cloning** (BC) is supervised learning, without rewards: the input is a state s, the right answer
# $a_E$ is the demonstrator's action. The loss is the mean of $-\log \pi(a_E | s)$.
#
# **Exercise (5 min, ●○○).** Write this loss in torch.


# %%
def cloning_loss(log_pi, expert_actions):
    """The loss, one number: log_pi (batch, 9), expert_actions (batch,) whole numbers, tensors."""
    # solution
    chosen = log_pi.gather(-1, expert_actions.unsqueeze(-1))
    return -chosen.mean()
    # end solution


check.cloning_loss(cloning_loss)

# %% [markdown]
# Train five clones on each of three data sets: your drives, {{ SETTINGS.demonstration_episodes }} drives of
# the rule ({{ len(rows()['the rule']) | , }} rows), and as many drives of the stochastic rule
# ({{ len(rows()['the stochastic rule']) | , }} rows: most drives end early). Each clone has
# {{ UPDATES | , }} updates, a short training, then drives 100 new roads. We count how often it
# **agrees**: with the demonstrator in its data, and with the rule in the seconds of its own drives.
#
# > **Predict.** A clone takes its most probable action. Which have more accidents, clones of the rule or
# > clones of the stochastic rule?
# <!-- claim: UPDATES == 1500 -->

# %%
KINDS = ["the rule's drives", "the stochastic rule's drives"]
same = "about equally many"
predict("demonstrations.1", "Which clones have more accidents?", [*KINDS, same])

# %%
predicted("demonstrations.1")
torch.set_num_threads(1)  # small matrices are faster on one thread
unsure = bc.stochastic_rule_policy(bc.DEFAULT, np.random.default_rng(0))
by_rule, by_chance = bc.collect(200), bc.collect(200, policy=unsure)
data = {whose: own_rows, KINDS[0]: by_rule, KINDS[1]: by_chance}
loss = own_code.yours_or_ours("cloning_loss")
clones = cloning.clones(data, loss)  # 1,500 updates with 64 rows each
measured = {name: cloning.measure(clones[name], rows) for name, rows in data.items()}
bc.show(figures.clones(measured))
out = [[name, cloning.get_out(clones[name])] for name in KINDS]
table(["clones of", "drives that get out"], out)

# %% [markdown]
# **See.** *High agreement with its data does not make a clone safe.* Clones of one drive know it almost by heart,
# and mostly crash. The stochastic rule's crash less than the rule's, and get out more often, although they agree
# less with their data, and with the rule.
# <!-- claim: of('bc').agents[0]['demonstration_episodes'] == 200 -->
# <!-- claim: others_crash("the stochastic rule's drives").mean() < others_crash("the rule's drives").mean() / 3 -->
# <!-- claim: all(others_agree("the stochastic rule's drives", where) < others_agree("the rule's drives", where)
#   for where in ('agrees', 'own')) -->
# <!-- claim: len(others_crash("the rule's drives")) == len(others_crash("the stochastic rule's drives")) == 15 -->

# %% [markdown] tags=["instructor"] minutes=9
# With a class: everybody keeps one drive that gets out, and you pool them. Return to the hands of *Look
# first*. A group can cut the rule's drives to the lengths of the stochastic rule's (`bc.demonstrate` keeps
# them drive by drive) and train twenty clones of each, as we did. Do not say yet that a longer training turns
# the order (Round 3). After it all ten of the study's clones of the rule escape (lesson [[recorded_drives]]).
# But the loss does not say when a training is long enough.
# <!-- claim: escaped('bc') == len(of('bc')) == 10 -->

# %% [markdown]
# ## Round 2: which errors end a drive?
#
# A decision unlike the rule's counts as an **error** of a clone. The rule's five clones now drive the first
# picture's 60 roads.
#
# > **Predict.** What is the most frequent accident of the rule's clones?

# %%
ends_by = ["it stops on the road", "it hits another car", "it leaves the road"]
predict("demonstrations.2", "What is the most frequent accident of the rule's clones?", ends_by)

# %%
predicted("demonstrations.2")
alone = cloning.alone(clones[KINDS[0]])
print(cloning.accidents(alone), cloning.never_beyond(alone, by_rule), sep="\n")
bc.show(figures.off_the_road(alone, by_rule))

# %% [markdown]
# **See.** *A clone is examined in its teacher's states, and lives in its own.* In the rule's states these clones
# err in about one second of five (Round 1), in their own in more than half. Most cars that leave the road were left
# of the green band before, where the rule never is. The others (the last line counts them) move left faster than
# the rule ever does at that place.
#
# **Explain.** An error leads to a state that the teacher never showed. There the next error is likelier, and leads
# farther away: **compounding errors**. But the stochastic rule's clones err more often, and crash less. What do they
# know that the rule's do not?
# <!-- claim: others_agree("the rule's drives", 'own') < 0.45 -->

# %% [markdown] tags=["instructor"] minutes=7
# Let a clone err in its teacher's states with a probability of at most ε per second (Ross and Bagnell 2010).
# Draw both bounds on the errors in T decisions, ε T and ε T (T + 1) / 2: the first error comes at decision t
# with a probability of at most ε, and T − t + 1 errors follow from it; add up over t. Our clones disagree
# with a fifth of their data: with such an ε the bound allows an error in nearly every second. Then ask what
# the rule would do at the edge and where the clone could have learned it. In drives without an accident clones
# err left of the band, too: a picture of accidents alone makes every error look deadly.

# %% [markdown]
# ## Round 3: which rows help?
#
# Left of the green band lie {{ beyond_the_band() }} of the stochastic rule's rows, and none of the rule's. To
# the rule's rows we add as many of the stochastic rule's, labelled with the rule's action, each five times:
#
# - **beyond the band**: left of it;
# - **at the band's rim**: in it, at least 1 m left;
# - **anywhere else**: in it or right of it.
#
# > **Predict.** Which kinds prevent more than half of the accidents?

# %%
kinds = ["all three", "the rim's and those beyond", "only those beyond", "none"]
predict("demonstrations.3", "Which kinds prevent more than half of the accidents?", kinds)

# %%
predicted("demonstrations.3")
copies = 5  # of each added row
labelled = by_chance.clone()
labelled[:, ACTION] = labelled[:, RULE_ACTION]
more = cloning.rows_to_add(by_rule, labelled)
named = {f"+ {len(rows)} {name}": rows for name, rows in more.items()}
fed = {name: cloning.with_added(by_rule, rows, copies) for name, rows in named.items()}
fed = cloning.clones(fed, loss)
fed_crash = {name: cloning.measure(fed[name], by_rule[::10]) for name in fed}
long = bc.shipped_agents("bc")  # the study's first five: the rule's drives, a longer training
longer = {"rule's, 67,000 updates": cloning.measure(long, by_rule[::10])}
bc.show(figures.added(measured, fed_crash, longer))

# %% [markdown]
# **See.** *It matters which rows.* {{ beyond_the_band() }} rows from beyond the band or from its rim, added to
# {{ len(rows()['the rule']) | , }}, prevent more than half of the accidents; as many from elsewhere do not (fifteen
# others: {{ 100 * others_crash('others').mean() | .0f }} %, without them
# {{ 100 * others_crash("the rule's drives").mean() | .0f }} %).
# <!-- claim: others_crash('from the edge').mean() < 0.2 * others_crash("the rule's drives").mean() -->
# <!-- claim: others_crash('near the edge').mean() < 0.4 * others_crash("the rule's drives").mean() -->
# <!-- claim: others_crash('others').mean() > 0.75 * others_crash("the rule's drives").mean() -->
#
# In the drives on the 60 roads:

# %%
three_kinds = {name: clones[name] for name in KINDS} | dict.fromkeys(longer, long)
steer = [
    [name, *cloning.steering(cloning.alone(each), by_rule)] for name, each in three_kinds.items()
]
table(["clones of", *cloning.STEER], steer)

# %% [markdown]
# **Explain.** *Not every error is dangerous.* The stochastic rule's clones mostly miss the rule's *speed*. Left of
# the band they steer as the rule does more often than the rule's clones do, and they are there less often.
#
# The rule never drives left of its band, so none of its rows shows the way back from there. The stochastic rule
# strays, and then acts well, nine times in ten: some of its rows show it.
#
# There are two cures, then. *Teach the way back*: a few rows from where clones get lost, drawn often enough (try
# `copies = 1`). *Or never get lost*: the clones of the last row, with {{ updates_of(of('bc')) / UPDATES | .0f }}
# times as many updates, follow the rule so closely that they seldom leave the band.
#
# *A longer training turns the order round.* The last row's clones hardly crash; the stochastic rule's, with
# {{ int(round(updates_of(by_chance()), -3)) | , }} updates, crash in
# {{ 100 * by_chance().scores('accident').mean() | .0f }} %. Is it the dice, a tenth of their labels? *The test*:
# the same states with the rule's labels, three clones each, 134,000 updates. With the dice each of the three had
# accidents, with the rule's labels none had one.
# <!-- claim: len(bc_shipped()) == 5 and long_beyond() < 0.1 -->
# <!-- claim: round(updates_of(of('bc')), -3) == 67_000 -->
# <!-- claim: not of('bc').agents[0]['stochastic_demonstrations'] and len(of('bc')) == 10 -->
# <!-- claim: by_chance().agents[0]['stochastic_demonstrations'] and len(by_chance()) == 10 and
#   round(updates_of(by_chance()) / updates_of(of('bc')), 1) == 2 -->
# <!-- claim: by_chance().agents[0]['demonstration_episodes'] == of('bc').agents[0]['demonstration_episodes'] -->
# <!-- claim: of('bc').scores('accident').max() < by_chance().scores('accident').min() -->

# %% [markdown] tags=["instructor"] minutes=3
# The rule's drives have places near the edge, too, but with other headings. Five clones of each are few, and
# yours will differ; the fifteen others ship (`bootcourse study clones`). A group can repeat the test in ten minutes:
# set `cloning.UPDATES = 134_000`, and train clones of `by_chance` and of `labelled`.

# %% [markdown]
# ## Round 4: what if the rule labels the clone's own states?
#
# If you do not know which rows help, let your clone drive, ask the rule what it would have done in these states, add
# the labelled states to the data, and train again. This is **DAgger** ("data aggregation"). It needs a teacher that
# answers in any state.
#
# > **Predict.** Begin with 20 drives of the rule, and in each of two rounds add 20 labelled drives of the newest clone.
# > Where does the last clone agree with the rule more often than the first did: in the rule's states, or in its own?

# %%
own_only, rule_only = "only in its own states", "only in the rule's states"
choices = ["in the rule's states and its own", own_only, rule_only, "in neither"]
predict("demonstrations.4", "Where does the last clone agree more than the first?", choices)

# %% [markdown]
# **Exercise (12 min, ●●○).** Write DAgger. `train(rows)` returns a driver, `drive(driver)` the transitions of
# its drives. Column `ACTION` of a transition holds what was done, and this is what a clone copies. Column
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
predicted("demonstrations.4")
take_turns = own_code.yours_or_ours("dagger", doing="Taking turns")
three = cloning.Trainings(loss, seeds=range(3), episodes=20)
drivers = take_turns(three.begin(bc.collect(20)), three.train, three.drive, rounds=2)
trainings = [cloning.measure(each, by_rule[::10]) for each in zip(*drivers, strict=True)]
sixty = shipped.shipped_experiment("clones")["60 drives"].notes["accidents"]  # fifteen clones
bc.show(figures.taught(trainings, sixty))

# %% [markdown]
# **See.** *The clones come to agree less in the rule's states, more in their own, and seldom crash.* More drives
# alone do not do this (dashed: 60 drives of the rule).
# <!-- claim: len(others_crash('DAgger')) == len(others_crash('60 drives')) == 15 -->
# <!-- claim: others_crash('DAgger').mean() < others_crash('60 drives').mean() / 3 -->
# <!-- claim: others_agree('DAgger', 'agrees') < others_agree('DAgger', 'agrees', 0) and
#   others_agree('DAgger', 'own') > others_agree('DAgger', 'own', 0) -->

# %% [markdown] tags=["instructor"] minutes=5
# Ask what DAgger costs: here a label is free, with a human teacher each one is work, and somebody must let a
# bad driver drive. Then ask why the method keeps the old rows beside the newest: a clone that has learned to
# return to the path seldom visits the states beside it, and trained on its newest rows alone it could forget
# what to do there. A group can give each training the drives of another training's clones: in ten trainings
# of ours these helped as much as its own.

# %%
crashed = {name: measured[name][:, 2].mean() for name in KINDS}
there, own, *_ = np.mean(trainings, axis=0)[-1] - np.mean(trainings, axis=0)[0]
compare_predictions(
    "demonstrations",
    {
        1: same if abs(np.diff([*crashed.values()])) < 0.05 else max(crashed, key=crashed.get),
        2: ends_by[2],
        3: kinds[1],
        4: choices[(there <= 0) + 2 * (own <= 0)],
    },
)

# %% [markdown]
# ## What you now know
#
# 1. A clone learns to predict the teacher's action in its teacher's states. Judge it by how it drives in its own.
# 2. Two cures: teach the way back, or train long on clean labels. A long training on random labels does harm.
# 3. DAgger adds rows from the clone's own states: the clone drives, the teacher labels.
#
# **Three questions to think about**
# - Why do the rule's clones leave the road on the left far more often than on the right (Round 2)?
# - The teacher is a person, who watches and says "left now". What becomes hard in DAgger?
# - A demonstrator crashes at the end of each drive. Which of its rows would you keep?
#
# <details><summary>Answers</summary>
#
# - The rule passes in the left lane, near the road's edge; on the right there is room to come back.
# - Labels come late, after the state has changed. Some variants let the person take over.
# - Those before the last state from which a trusted driver avoids the accident.
#
# </details>
#
# **Read on**: Pomerleau, *ALVINN* (1989); Ross et al., *DAgger* (arXiv 1011.0686); Laskey et al., *DART* (arXiv
# 1703.09327).
#
# The stochastic rule crashes in {{ 100 * stochastic_crashes() | .0f }} % of its drives, its clones in
# {{ 100 * others_crash("the stochastic rule's drives").mean() | .0f }} %: a clone takes the most probable action,
# and so leaves the dice out. But what its teacher never does, no row shows it, and the rule never drives fast. The
# next two lessons want more: to be led by the rule first, and to outdo it later. [](soft_constraint.ipynb).

# %% [markdown] tags=["instructor"] minutes=4
# **On the board.** Two trajectories that part after one wrong action, and the shaded region where the teacher
# was.
#
# **To discuss.** Who pays for labels in the real world, and what does that do to DAgger?
