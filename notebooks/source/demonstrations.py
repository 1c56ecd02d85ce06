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
# - collect demonstrations in three ways, and say what is in them before you learn from them;
# - train clones of a driver in seconds, and judge them by how they drive instead of by their loss;
# - explain why a clone that agrees with its teacher most of the time can still leave the road;
# - let a clone drive, have the rule label what it meets, and see what that changes.
#
# **Time** 65 minutes, under a minute of it the machine's. **It builds on** [lesson
# [[the_trap]]](the_trap.ipynb) and [lesson [[the_rule]]](the_rule.ipynb).

# %%
import bootcourse as bc
import numpy as np
import torch
from bootcourse.course import charts, check, compare_predictions, predict, source, table
from bootcourse.course.lessons.demonstrations import cloning, figures
from bootcourse.learn import demonstrations, replay_buffer

# %% [markdown]
# ## Look first
#
# Here is where two demonstrators were in their first 30 seconds, on the same 60 roads. One is
# the rule. The other is the stochastic rule with p = {{ RULE_P }}: one decision in ten is drawn
# from the other eight actions.
# <!-- claim: round(1 / (1 - RULE_P)) == 10 -->

# %%
unsure = bc.stochastic_rule_policy(bc.DEFAULT, np.random.default_rng(0))
driven = {"the rule": bc.record(bc.rule_policy(bc.DEFAULT), range(60), label="rule")}
driven["the stochastic rule"] = bc.record(unsure, range(60), label="stochastic rule")
title = "The rule drives along a narrow path, the stochastic rule strays from it"
bc.show(figures.where_they_were(driven, seconds=30, title=title))

# %% [markdown]
# > **Predict.** You learn to drive by watching one of these two. Which one do you choose: the rule,
# > which has no accident in these drives, or the stochastic rule, which often leaves the road?

# %%
predict(
    "demonstrations.1", "From whose drives do you learn?", ["the rule's", "the stochastic rule's"]
)

# %% [markdown]
# Round 5 answers it.
# <!-- claim: all(drive.accident == 0 for drive in rule_drives()) -->

# %% [markdown]
# ## Round 1: what does a demonstration consist of?
#
# A **demonstration** is somebody's drive, kept as **transitions**. A transition is one decision:
# what the driver saw, what it did, what it was paid, what it saw next, and whether an accident
# ended the drive there (*terminated*). A drive has one observation more than it has actions.
#
# > **Predict.** One drive ends after 150 s because the time is up. Another ends after 20 s in a
# > collision. In which of the two does the last transition count as terminated?

# %%
predict(
    "demonstrations.2", "Whose last transition is terminated?", ["the first", "the second", "both"]
)

# %% [markdown]
# **Exercise (6 min, ●●○).** Turn one drive into transitions.


# %%
def transitions(observations, actions, rewards, accident):
    """One row (s, s', a, r, terminated) for each decision: (T + 1, n), (T,), (T,) -> (T, 2n + 3).

    terminated is 1 where an accident ended the episode there, else 0; accident 0 means none.
    """
    # solution: the exercise's own


check.transitions(transitions)

# %% [markdown]
# The library's rows hold two more numbers: what the rule would have done in s and in s′. Now
# collect {{ SETTINGS.demonstration_episodes }} episodes from each demonstrator, as many as the
# paper has. (Its text lets the stochastic rule drive them.)
#
# > **Predict.** 200 episodes of at most 150 decisions. How many transitions does the rule give,
# > and how many the stochastic rule?

# %%
predict("demonstrations.3", "Transitions of the rule", unit="transitions")

# %%
# NBVAL_CHECK_OUTPUT
by_rule = bc.collect(200)
unsure = bc.stochastic_rule_policy(bc.DEFAULT, np.random.default_rng(0))
by_chance = bc.collect(200, policy=unsure)
rows = []
for name, each in (("the rule", by_rule), ("the stochastic rule", by_chance)):
    batch = replay_buffer.decode_transitions(each, cloning.SIZE, torch.zeros(len(each)))
    rows.append([name, f"{len(each):,}", int(batch.terminated.sum())])
table(["200 episodes of", "transitions", "end in an accident"], rows)

# %% [markdown]
# The third way is to drive yourself. Drive, press **Keep as demonstration**, and the next cell
# finds your drive. If you keep nothing, the cell takes the rule's actions on this road instead.

# %% tags=["nbval-ignore-output"]
ROAD = 10
(panel := bc.panels.drive_panel(seed=ROAD))

# %%
stand_in = bc.plan_policy(bc.policies.in_words(driven["the rule"][ROAD].actions))
mine = panel.demonstrations or bc.record(stand_in, [ROAD], label="you")
own_rows = demonstrations.demonstration_rows(mine)
print(f"drives: {len(mine)}, transitions: {len(own_rows)}, of {own_rows.shape[1]} numbers each")
print(f"the last one: return {mine[-1].rewards.sum():.1f}, success {mine[-1].success}")

# %% [markdown] tags=["instructor"] minutes=6
# With a class: everybody keeps one drive that escapes, and you pool them. Human drives differ from
# the rule's in one way that matters in Round 5: people make mistakes and correct them.

# %% [markdown]
# ## Round 2: what is in the demonstrations?
#
# > **Predict.** What share of the rule's decisions is "keep straight"?

# %%
predict("demonstrations.4", "Share of 'keep straight'", unit="%")

# %%
batch = replay_buffer.decode_transitions(by_rule, cloning.SIZE, torch.zeros(len(by_rule)))
shares = np.bincount(batch.actions.numpy(), minlength=9) / len(by_rule)
most = int(shares.argmax())
title = f"{100 * shares[most]:.0f} % of the rule's decisions are '{bc.ACTION_NAMES[most]}'"
bc.show(charts.action_bars({"rule": shares}, title, "share of the decisions"))
# %% [markdown]
# **See.** Each of the nine actions occurs. The rule needs {{ way_out()[0] | .0f }} s to get from
# behind the traps into the free lane, and {{ way_out()[1] | .0f }} s to be ahead of trap 1 (medians
# of the 60 drives in the figure at the top). So the way to the free lane is {{ 100 * way_out()[0] /
# 150 | .0f }} % of a demonstration, and that is its weight in a loss that averages over the
# decisions.
#
# What is a demonstration worth, and from which second on? The paper's learners discount: a reward
# $t$ seconds later counts $\gamma^t$, with γ = {{ SETTINGS.gamma }}. From second t on a drive is
# worth its **return to go**: the reward now, and γ times what the next second is worth.
#
# $$ G_t = r_t + \gamma\, G_{t+1} $$
#
# **Exercise (5 min, ●○○).** Write it for each second of a drive. Where do you have to begin?


# %%
def return_to_go(rewards, gamma):
    """G_t of each second; the last one is the last reward. (T,), gamma in [0, 1] -> (T,)."""
    # solution: the exercise's own


check.return_to_go(return_to_go)

# %%
# NBVAL_CHECK_OUTPUT
idle = bc.record(bc.idle_policy, [ROAD])[0]
rows = []
for gamma in (1.0, 0.99, 0.95, 0.9, 0.8):
    weights = gamma ** np.arange(150)
    rows.append([gamma, *(f"{weights @ d.rewards:.2f}" for d in (idle, driven["the rule"][ROAD]))])
lead = driven["the rule"][ROAD].rewards - idle.rewards  # of each second; then γ = 0.8, from t on
behind = [t for t in range(150) if weights[: 150 - t] @ lead[t:] < 0]
below = f"γ = 0.8: from second {behind[-1] + 1} on, the rule's drive is worth more to the end."
table(["γ", "doing nothing", "the rule"], rows, below=below)

# %% [markdown]
# **Explain.** A learner with γ = {{ SETTINGS.gamma }} looks about five seconds ahead (1 / (1 − γ) =
# {{ 1 / (1 - SETTINGS.gamma) | .0f }}), and in its first five seconds the rule brakes. In
# discounted reward this escape is worth less at its start than doing nothing: of the two, a learner
# that goes by the reward prefers doing nothing. Lesson [[learning_from_demonstrations]] pays a
# bonus for the demonstrated actions. Here we leave the reward out and copy the actions.
# <!-- claim: round(1 / (1 - SETTINGS.gamma)) == 5 -->
# <!-- claim: by_rule().states[10, EGO, SPEED] < by_rule().states[0, EGO, SPEED] -->

# %% [markdown]
# ## Round 3: how well does a clone drive?
#
# **Behaviour cloning** (BC) is supervised learning: the input is a state, the right answer is the
# action that the demonstrator took there. The loss is the mean of $-\log \pi(a_E | s)$, with $a_E$
# the demonstrated action.
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
# Now train four clones side by side with that loss, on the rule's drives. Each is the network of
# the learners in this course: {{ DEFAULT.observation_size }} numbers in, nine probabilities out.

# %% tags=["nbval-ignore-output"]
source("bootcourse.course.lessons.demonstrations.cloning", "clone")

# %%
torch.set_num_threads(1)  # small matrices are faster on one thread
rule_clones = cloning.clone(by_rule)

# %% [markdown]
# How often is the clone's most probable action the demonstrated one?
#
# **Exercise (3 min, ●○○).** Compute that share over a set of states.


# %%
def agreement(pi, actions):
    """A share, a number: probabilities (n, actions), demonstrated actions (n,), NumPy arrays."""
    # solution: the exercise's own


check.agreement(agreement)

# %% [markdown]
# > **Predict.** A clone agrees with the rule in four of five states. In what share of 200 new
# > episodes does it escape? In what share does it have an accident? (The rule escapes on all
# > {{ roads() | , }} held-out roads of the study and has no accident there.)
# <!-- claim: of('rule').scores('success').min() == 1 and accidents('rule') == 0 -->

# %%
predict("demonstrations.5", "Drives of such a clone that end in an accident", unit="%")


# %%
def shown(measured):
    """A table of what was measured: {name: (agreement, success, accidents)}."""
    rows = [
        [name, *(f"{100 * share:.0f} %" for share in three)] for name, three in measured.items()
    ]
    return table(["", "agreement", "escapes", "has an accident"], rows)


measured = {"clones of the rule": cloning.measure(rule_clones, by_rule)}
shown({f"clone, seed {i}": three for i, three in enumerate(measured["clones of the rule"])})

# %% [markdown]
# **See.** The four clones have the same data, the same loss, and different seeds. Your numbers will
# differ from another machine's. Compare the columns: by how much do the agreements of the four
# differ, and by how much do their accidents? Can you tell from its agreement how well a clone
# drives?

# %% [markdown] tags=["instructor"] minutes=6
# Somebody will say "train longer". They are right: the ten clones of the study were trained far
# longer, and all of them escape (lesson [[imitation]]). The point stands: a clone is trained on the
# rule's states and drives in its own, and the loss does not say when the training is long enough.
# <!-- claim: len(of('bc')) == 10 -->
# <!-- claim: escaped('bc') == len(of('bc')) -->

# %% [markdown]
# ## Round 4: what follows an error?
#
# A clone errs with probability ε at a decision as long as it is in the demonstrator's states. How
# much can that cost over a whole drive?
#
# > **Predict.** A drive becomes twice as long. By what factor can the expected number of wrong
# > decisions grow, in the worst case?

# %%
predict("demonstrations.6", "The worst case grows by a factor of", ["less than 2", "2", "4"])

# %% [markdown]
# <details><summary>The answer, in five lines</summary>
#
# Until its first error the clone is in the demonstrator's states. So the first error comes at
# decision $t$ of $T$ with a probability of at most ε, whatever $t$ is. In the worst case the clone
# does not know what to do from there on, and each of the remaining $T - t + 1$ decisions is wrong.
# The expected number of wrong decisions is at most
#
# $$ \sum_{t=1}^{T} \epsilon \, (T - t + 1) = \epsilon \, \frac{T (T + 1)}{2} $$
#
# which grows with $T^2$: about four times as much for twice the length. A driver that is back in
# the demonstrator's states within $k$ decisions makes at most $k$ wrong ones for each error,
# together $\epsilon k T$. With ε = 0.01, T = 150 and k = 5 the two bounds are {{ 0.01 * 150 * 151 /
# 2 | .0f }} and {{ 0.01 * 5 * 150 | .1f }} wrong decisions.
#
# </details>
#
# Errors that lead to more errors are called **compounding errors**. First a driver that knows how
# to come back: the rule itself, which errs with probability ε at each decision. In which share of
# 200 drives has it had an accident after T seconds?

# %%
# NBVAL_CHECK_OUTPUT
rows, times = [], (37, 75, 150)
for error in (0.003, 0.01, 0.03):
    errs = bc.stochastic_rule_policy(bc.DEFAULT, np.random.default_rng(0), 1 - error)
    drives = bc.drive_episodes(errs, bc.held_out_seeds(2, 200))
    ended = np.where(drives.accident > 0, drives.distance / drives.speed, np.inf)
    rows.append([error, *(f"{100 * np.mean(ended <= seconds):.0f} %" for seconds in times)])
table(["ε", *(f"T = {seconds} s" for seconds in times)], rows, below="Share with an accident.")

# %% [markdown]
# **See.** Twice the time, or three times the ε, gives about two to three times as many accidents:
# with this driver they grow with ε T, and not with T². It is back on its path a few seconds after
# an error, if it survives. What a clone does *after* an error is the question.
# <!-- claim: 1.5 < erring(0.01, 150) / erring(0.01, 75) < 3 -->
#
# > **Predict.** Take the distance from what a driver sees to the nearest observation in the
# > demonstrations. For the rule on other roads it is small. How does it change for a clone, from
# > second to second?

# %%
predict(
    "demonstrations.7",
    "A clone's distance from the demonstrations over 30 s",
    ["small throughout", "large from the start", "small, then large"],
)


# %%
def strangeness(driver, seconds, roads=40):
    """Median distance from what a driver sees, or saw last, to the nearest demonstrated state."""
    drives, known = bc.record(driver, range(roads)), by_rule[:, : bc.DEFAULT.observation_size]
    found = []
    for t in seconds:
        seen = np.array([d.observations[min(t, len(d.actions))] for d in drives])
        found.append(float(torch.cdist(torch.from_numpy(seen), known).min(1).values.median()))
    return found


seconds = range(31)
curves = {"rule itself": strangeness(bc.rule_policy(bc.DEFAULT), seconds)}
for agent in rule_clones:
    curves[f"BC clone, seed {agent.settings.seed}"] = strangeness(agent.as_policy(), seconds)
title = "How far from the demonstrations the rule and its four clones drive"
away = "distance to the nearest demonstrated state (scaled numbers of the observation)"
bc.show(charts.lines(seconds, curves, title, "time (s)", away))

# %% [markdown]
# Where does the clone err? Measure its agreement with the rule on what the *rule* sees at some
# second, and on what the *clone* sees then.

# %%
times, rows = [0, 1, 2, 3, 5, 7, 10, 30], []
for agent in rule_clones:
    own, on_rule, on_own = bc.record(agent.as_policy(), range(40)), [], []
    for t in times:
        seen = np.array([d.observations[t] for d in driven["the rule"]])
        right = np.array([d.actions[t] for d in driven["the rule"]])
        on_rule.append(np.mean(agent.probabilities(seen).argmax(1) == right))
        still = [d for d in own if len(d.actions) > t]
        on_own.append(np.mean([d.actions[t] == d.rule_actions[t] for d in still]))
    for states, agreed in (("the rule's", on_rule), ("its own", on_own)):
        rows.append([agent.settings.seed, states, *(f"{100 * share:.0f}" for share in agreed)])
table(["seed", "agreement, %, in states of", *(f"{t} s" for t in times)], rows)

# %% [markdown]
# **Explain.** Read the two rows of a clone from left to right. We describe our own runs; yours will
# differ.
#
# - **At 2 s** the clone has done the same as the rule so far, with few exceptions, so it is in the
#   rule's states. It agrees on few roads nevertheless: this is an error in the *demonstrator's*
#   states. The decision is a close one. On {{ 100 * rule_keeps_left(2) | .0f }} % of the 60 roads
#   the rule begins its lane change here, on most others one second later, and these clones choose
#   the earlier second too often.
# <!-- claim: 0.1 < rule_keeps_left(2) < 0.5 and rule_keeps_left(3) > 0.9 -->
# - **At 5 s** these clones agree with the rule on hardly any road, in their own states. But two of
#   the four are still close to demonstrated states there (the figure). A second later these two are
#   further away, and agree more often again. So distance alone does not tell where a clone errs.
# - **In the worst case** an error brings a clone to states that nobody demonstrated, it errs more
#   often there, and the errors compound (Ross and Bagnell 2010). The bound of this round allows
#   that. Our table does not show that it happens here, and the study speaks against it: its ten
#   clones learned from drives of the rule alone, too, with many more updates, and have an accident
#   in {{ 100 * accidents('bc') | .1f }} % of their drives. A smaller error was enough: at 5 s the
#   five that ship agree with the rule on {{ 100 * agreement_at_5().min() | .0f }} to
#   {{ 100 * agreement_at_5().max() | .0f }} % of 40 roads, in their own states.
# <!-- claim: accidents('bc') < 0.01 and not of('bc').agents[0]['stochastic_demonstrations'] and
#   len(agreement_at_5()) == 5 and agreement_at_5().min() > 0.5 -->
# - **And yet these clones escape in most of their drives.** Agreement counts each difference as an
#   error, also one that does little harm, such as keeping the speed where the rule accelerates. A
#   clone of the study agrees with the rule, after 3 s on its own states, on {{ 100 *
#   clone_agrees(3, 3) | .0f }} % of 40 roads, and it escapes on {{ 100 *
#   of('bc').scores('success')[3] | .0f }} % of the {{ roads() | , }} held-out roads.
# <!-- claim: clone_agrees(3, 3) < 0.5 and of('bc').scores('success')[3] > 0.95 -->
#
# So test a clone by driving. A learner that drives while it learns is trained on its own states; a
# clone is not.

# %% [markdown]
# ## Round 5: whose drives teach more?
#
# The stochastic rule often leaves the rule's path, and its next decisions *correct* that: its data
# show what to do beside the path. But one of its actions in ten is not the rule's. A third data set
# avoids this: the stochastic rule drives, and each state is labelled with the rule's action.
# <!-- claim: round(1 / (1 - RULE_P)) == 10 -->
#
# > **Predict.** Which clones have the fewest accidents?

# %%
KINDS = ["clones of the rule", "of the stochastic rule", "its drives, rule's labels"]
predict("demonstrations.8", "Fewest accidents", KINDS)

# %%
ACTION, RULE_ACTION = cloning.ACTION, cloning.RULE_ACTION  # columns
labelled = by_chance.clone()
labelled[:, ACTION] = labelled[:, RULE_ACTION]
measured[KINDS[1]] = cloning.measure(cloning.clone(by_chance), by_chance)
measured[KINDS[2]] = cloning.measure(cloning.clone(labelled), labelled)
title = "Agreement with the data and driving: a dot for each clone"
bc.show(figures.clones(measured, title))

# %%
shown({f"{name} (mean of 4)": values.mean(axis=0) for name, values in measured.items()})

# %% [markdown]
# **Explain.** The stochastic rule gave less than half as many rows, and most of its drives end in
# an accident. In our runs its clones escaped more often and had fewer accidents than the clones of
# the rule, while they agreed less with their data. (Yours will differ.) A likely reason: these data
# **cover** more states, and they show how to return to the path. The method DART disturbs the
# teacher on purpose.
#
# How much coverage matters depends on the number of updates. The ten clones of the study learned
# from drives of the rule alone, with far more updates: {{ escaped('bc') }} of 10 escape, and they
# have an accident in {{ 100 * accidents('bc') | .1f }} % of their drives on {{ roads() | , }}
# held-out roads. Try `cloning.clone(by_rule, updates=12_000)`, about half a minute, and measure it.
# <!-- claim: len(of('bc')) == 10 and escaped('bc') == 10 and accidents('bc') < 0.01 -->
#
# ## Round 6: what if the rule labels the clone's own states?
#
# The stochastic rule strays from the path at random. The states that count are those in which *your
# clone* ends up. So let the clone drive, ask the rule in each of the clone's states what it would
# have done there, add these labelled states to the data, and train again. Repeat this for some
# rounds. The method is called **DAgger**, for data aggregation (Ross, Gordon and Bagnell). It needs
# a teacher that answers in any state, as a rule controller does. A recorded drive does not.
#
# > **Predict.** You begin with 20 drives of the rule instead of 200. In each of three rounds the
# > newest clone drives 20 episodes, and the rule labels them. Compared with the clones of 200
# > drives, does the last clone have more accidents or fewer? And does it agree with the rule's 20
# > drives more or less than the first clone does?

# %%
predict(
    "demonstrations.9",
    "The last clone, compared with the clones of 200 drives",
    ["more accidents", "about as many", "fewer accidents"],
)

# %% [markdown]
# **Exercise (20 min, ●●●).** Write DAgger. `train(rows)` returns a driver, `drive(driver)`
# returns the transitions of its drives. In a transition, column `ACTION` holds what was done, which
# a clone copies, and column `RULE_ACTION` what the rule would have done.


# %%
def dagger(rows, train, drive, rounds):
    """A list of rounds + 1 drivers, each trained on all transitions so far.

    rows: the rule's transitions, a tensor (n, row). First train on them alone; then, in each round,
    let the newest driver drive, label its transitions with the rule's actions, add them, train.
    """
    # solution: the exercise's own


check.dagger(dagger)


# %%
def one_clone(rows):
    """One clone, trained from the beginning with 1,500 updates."""
    return cloning.clone(rows, seeds=1)[0]


few = bc.collect(20)
drivers = cloning.dagger(few, one_clone, cloning.own_drives(20), rounds=3)
rounds = cloning.measure(drivers, few)
shown({f"after {20 * i} drives of its own": three for i, three in enumerate(rounds)})

# %% [markdown]
# **Explain.** The first column is the agreement on the rule's 20 drives. It can fall while the
# clone drives better, since the same network now has to be right in other states, too. Compare the
# last row with the clones of 200 drives in Round 3. They had more labels and as many updates. What
# differs is *where* the labels are. But this is one training, with one seed. In the experiment
# `teachers` the rule labelled {{ taught_by_dagger().sizes[1] }} drives of each of ten agents, after
# 200 drives of its own. {{ taught_by_dagger().escapers('dagger') }} of these escape. Half of them
# have an accident in {{ 100 * np.median(taught_by_dagger().scores('accident')) | .0f }} % of their
# drives or fewer, and one in {{ 100 * taught_by_dagger().scores('accident').max() | .0f }} %. So
# repeat it before you trust it: `cloning.clone(rows, seeds=1, first=1)` takes another seed.
# <!-- claim: len(taught_by_dagger()) == 10 and taught_by_dagger().agents[0][
#   'demonstration_episodes'] == 200 and (taught_by_dagger().scores('accident') > 0.1).sum() == 1
#   -->
#
# The reward does not enter the cloning loss, with or without DAgger: the loss asks a clone to be
# like its teacher, and not to be better. An agent that is to drive better than the rule has to
# learn from what its actions lead to, with the demonstrations as a start: lesson
# [[learning_from_demonstrations]].

# %% [markdown] tags=["instructor"] minutes=8
# Ask what DAgger costs: here a label is free, with a human teacher each one is work, and somebody
# must let a bad driver drive. Then ask why the method keeps the old rows beside the newest: a clone
# that has learned to return to the path seldom visits the states beside it, and trained on its
# newest rows alone it could forget what to do there.

# %% [markdown]
# ## What you now know
#
# 1. A demonstration is a list of transitions. An accident terminates the last one, the end
#    of the time does not.
# 2. Look into the data first: the way to the free lane takes {{ way_out()[0] | .0f }} of 150 s.
# 3. With γ = 0.8 the rule's escape on road 10 is worth *less* at its start than doing nothing.
# <!-- claim: discounted(by_rule(), 0.8) < discounted(idle(), 0.8) -->
# 4. A clone is trained on the teacher's states and drives in its own, so its errors can compound.
#    On this road more updates, and so fewer errors, were enough for ten clones of ten.
# <!-- claim: escaped('bc') == 10 and accidents('bc') < 0.01 -->
# 5. With few updates, the states that the data cover can matter more than how well the demonstrator
#    drove. With many updates, the study's ten clones of the rule itself escape.
# <!-- claim: escaped('bc') == len(of('bc')) == 10 -->
# 6. DAgger asks the teacher for labels in the clone's own states.
#
# **Three questions to think about**
# - The rule reads the true places and speeds of the cars, the clone 26 numbers. Can two different
#   states of the road look the same to the clone, although the rule decides differently in them?
# - The teacher is a person, who watches and says "left now". What becomes hard in DAgger?
# - A demonstrator that crashes at the end of each drive: which of its rows would you keep?
#
# **Read on**: Pomerleau, *ALVINN* (1989), an early clone that drove; Ross, Gordon and Bagnell on
# *DAgger* (arXiv 1011.0686); Laskey et al., *DART* (arXiv 1703.09327). Next: [the soft
# constraint](soft_constraint.ipynb).

# %%
crashed = {name: round(100 * values[:, 2].mean()) for name, values in measured.items()}
compare_predictions(
    "demonstrations",
    {
        1: f"accidents: {crashed[KINDS[0]]} % and {crashed[KINDS[1]]} %, in this order",
        2: "the second",
        3: len(by_rule),
        4: round(100 * shares[4], 1),
        5: crashed[KINDS[0]],
        6: "4",
        7: "small, then large",
        8: min(crashed, key=crashed.get),
        9: f"accidents: {100 * rounds[-1, 2]:.0f} % against {crashed[KINDS[0]]} %",
    },
)

# %% [markdown] tags=["instructor"] minutes=6
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
