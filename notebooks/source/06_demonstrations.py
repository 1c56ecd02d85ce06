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
# # 6 · Demonstrations
#
# **What you will be able to do**
# - collect demonstrations in three ways, and say what is in them before you learn from them;
# - train clones of a driver in seconds, and judge them by how they drive instead of by their loss;
# - explain why a clone that agrees with its teacher most of the time can still leave the road, and
#   what helps.
#
# **Time** 55 minutes, under a minute of it the machine's. **It builds on**
# [lesson 1](01_the_trap.ipynb) and [lesson 3](03_the_rule.ipynb).

# %%
import bootcourse as bc
import numpy as np
import torch
from bootcourse.learn import demonstrations, replay_buffer
from bootcourse.lessons import charts, check, figures, source

# %% [markdown]
# ## Look first
#
# Here is where two demonstrators have been in their first 30 seconds, on the same 60 roads. One is
# the rule. The other is the stochastic rule with p = {{ RULE_P }}: one decision in ten is drawn
# from the other eight actions.
# <!-- claim: round(1 / (1 - RULE_P)) == 10 -->

# %%
unsure = bc.stochastic_rule_policy(bc.DEFAULT, np.random.default_rng(0))
driven = {"the rule": bc.record(bc.rule_policy(bc.DEFAULT), range(60), label="rule")}
driven["the stochastic rule"] = bc.record(unsure, range(60), label="stochastic rule")
title = "The rule drives along a narrow path, the unsure rule strays from it"
bc.show(figures.where_they_were(driven, seconds=30, title=title))

# %% [markdown]
# > **Predict.** You learn to drive from one of these two by watching alone. Which one do you
# > choose: the rule, which has no accident in these drives, or the stochastic rule, which often
# > leaves the road?
# <!-- claim: all(drive.accident == 0 for drive in rule_drives()) -->
#
# Write it down. Round 5 answers it.

# %% [markdown]
# ## Round 1: collect them
#
# A **demonstration** is somebody's drive, kept as **transitions**. A transition is one decision:
# what the driver saw, what it did, what it was paid, what it saw next, and whether an accident
# ended the drive there. A drive has one observation more than it has actions.
#
# > **Predict.** One drive ends after 150 s because the time is up. Another ends after 20 s in a
# > collision. In which of the two does the last transition count as terminated?
#
# **Exercise 6.1 (6 min, ●●○).** Turn one drive into transitions.


# %%
def transitions(observations, actions, rewards, accident):
    """One row (s, s', a, r, terminated) for each decision: (T + 1, n), (T,), (T,) -> (T, 2n + 3).

    terminated is 1 where an accident ended the episode there, else 0; accident 0 means none.
    """
    # solution
    terminated = np.zeros(len(actions))
    terminated[-1] = accident > 0
    return np.column_stack([observations[:-1], observations[1:], actions, rewards, terminated])
    # end solution


check.transitions(transitions)

# %% [markdown]
# The library's rows hold two more numbers: what the rule would have done in s and in s′. Now
# collect {{ SETTINGS.demonstration_episodes }} episodes from each demonstrator, as the paper does.
#
# > **Predict.** 200 episodes of at most 150 decisions. How many transitions does the rule give,
# > and how many the stochastic rule?

# %%
# NBVAL_CHECK_OUTPUT
by_rule = bc.collect(200)
by_chance = bc.collect(200, policy=bc.stochastic_rule_policy(bc.DEFAULT, np.random.default_rng(0)))
for name, rows in (("rule", by_rule), ("stochastic rule", by_chance)):
    batch = replay_buffer.decode_transitions(
        rows, bc.DEFAULT.observation_size, torch.zeros(len(rows))
    )
    ended = int(batch.terminated.sum())
    print(f"{name:16} {len(rows):6,} transitions, {ended:3} of 200 episodes end in an accident")

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
# the rule's in one way that matters in round 5: people make mistakes and correct them.

# %% [markdown]
# ## Round 2: what is in them?
#
# > **Predict.** What share of the rule's decisions is "keep straight"?

# %%
batch = replay_buffer.decode_transitions(
    by_rule, bc.DEFAULT.observation_size, torch.zeros(len(by_rule))
)
shares = np.bincount(batch.actions.numpy(), minlength=9) / len(by_rule)
most = int(shares.argmax())
title = f"{shares[most]:.0%} of the rule's decisions are '{bc.ACTION_NAMES[most]}'"
bc.show(charts.action_bars({"rule": shares}, title, "share of the decisions"))
cars = [d.states[::2] for d in driven["the rule"]]  # each second's
free = np.median([np.argmax(c[:, bc.state.EGO, bc.state.LANE] == 0) for c in cars])
x = bc.state.X
ahead = np.median([np.argmax(c[:, bc.state.EGO, x] > c[:, bc.state.TRAP_1, x]) for c in cars])
print(f"the rule is in the free lane after {free:.0f} s, {free / 150:.0%} of a demonstration,")
print(f"and ahead of trap 1 after {ahead:.0f} s, {ahead / 150:.0%} of it (medians of 60 roads)")

# %% [markdown]
# **See.** All nine actions occur. The rule needs {{ way_out()[0] | .0f }} s to get out from between
# the traps into the free lane, and {{ way_out()[1] | .0f }} s to be ahead of trap 1 (medians of
# these 60 drives). Those first seconds are {{ 100 * way_out()[0] / 150 | .0f }} % of a
# demonstration, and a loss that averages over all decisions gives them as little weight.
#
# What is a demonstration worth, and from which second on? The paper's learners discount: a reward
# $t$ seconds later counts $\gamma^t$, with γ = {{ SETTINGS.gamma }}. From second t on a drive is
# worth its **return to go**: the reward now, and γ times what the next second is worth.
#
# $$ G_t = r_t + \gamma\, G_{t+1} $$
#
# **Exercise 6.2 (5 min, ●○○).** Write it for every second of a drive. Where do you have to begin?


# %%
def return_to_go(rewards, gamma):
    """G_t of each second, the last one's is its reward: rewards (T,), gamma in [0, 1] -> (T,)."""
    # solution
    togo = np.array(rewards, dtype=float)
    for t in range(len(togo) - 2, -1, -1):
        togo[t] += gamma * togo[t + 1]
    return togo
    # end solution


check.return_to_go(return_to_go)

# %% [markdown]
# > **Predict.** Over 150 s the rule earns far more than doing nothing. Which is worth more at the
# > *start*, when γ = 0.8?

# %%
# NBVAL_CHECK_OUTPUT
idle = bc.record(bc.idle_policy, [ROAD])[0]
for gamma in (1.0, 0.99, 0.95, 0.9, 0.8):
    weights = gamma ** np.arange(150)
    nothing, escape = (weights @ d.rewards for d in (idle, driven["the rule"][ROAD]))
    print(f"γ = {gamma:4}: doing nothing {nothing:6.2f}, the rule {escape:6.2f}")

lead = driven["the rule"][ROAD].rewards - idle.rewards  # of each second; then γ = 0.8, from t on
behind = [t for t in range(150) if weights[: 150 - t] @ lead[t:] < 0]
print(f"γ = 0.8: from second {behind[-1] + 1} on, the rule's drive is worth more to the end")

# %% [markdown]
# **Explain.** A learner with γ = {{ SETTINGS.gamma }} looks about five seconds ahead, and in its
# first five seconds the rule brakes. Judged by the discounted reward, this escape is worth less at
# its start than doing nothing. So such a learner has no reason to copy it. Lesson 8 pays a bonus
# for the demonstrated actions. Here we leave the reward out and copy the actions.
# <!-- claim: round(1 / (1 - SETTINGS.gamma)) == 5 -->
# <!-- claim: by_rule().states[10, EGO, SPEED] < by_rule().states[0, EGO, SPEED] -->

# %% [markdown]
# ## Round 3: clone it
#
# **Behaviour cloning** (BC) is supervised learning: the input is a state, the right answer is the
# action that the demonstrator took there. The loss is the mean of $-\log \pi(a_E | s)$, with $a_E$
# the demonstrated action.
#
# **Exercise 6.3 (5 min, ●○○).** Write it, in torch.


# %%
def cloning_loss(log_pi, expert_actions):
    """The loss, one number: log_pi (batch, 9), expert_actions (batch,) whole numbers, tensors."""
    # solution
    chosen = log_pi.gather(-1, expert_actions.unsqueeze(-1))
    return -chosen.mean()
    # end solution


check.cloning_loss(cloning_loss)

# %% [markdown]
# Four clones of each data set, side by side: the same network as every learner in this course,
# {{ DEFAULT.observation_size }} numbers in, nine probabilities out.


# %%
def clone(rows, updates=1500, seeds=4):
    """Clones of what is in the rows, one for each seed."""
    settings = bc.with_seeds(bc.settings_for("bc"), seeds)
    cloner = bc.learner_for(settings, bc.DEFAULT.observation_size)
    replay = bc.ReplayBuffer(seeds, 64, bc.DEFAULT.observation_size, rows)
    generators = [np.random.default_rng(each.seed) for each in settings]
    for _ in range(updates):
        cloner.update(replay.sample(64, np.ones(seeds), generators))  # 64 rows, all demonstrations
    weights = [[layer.detach()[i : i + 1] for layer in cloner.actor] for i in range(seeds)]
    return [bc.Agent(s, actor, [], alpha=0.0) for s, actor in zip(settings, weights, strict=True)]


torch.set_num_threads(1)  # small matrices are faster on one thread
rule_clones = clone(by_rule)

# %% [markdown]
# How often is the clone's most probable action the demonstrated one?
#
# **Exercise 6.4 (3 min, ●○○).** Compute that share over a set of states.


# %%
def agreement(pi, actions):
    """A share, a number: probabilities (n, actions), demonstrated actions (n,), NumPy arrays."""
    # solution
    return np.mean(pi.argmax(axis=1) == actions)
    # end solution


check.agreement(agreement)

# %% [markdown]
# > **Predict.** A clone agrees with the rule in four of five states. In what share of 200 new
# > episodes does it escape? In what share does it have an accident? (The rule escapes on all
# > {{ roads() | , }} held-out roads of the study and has no accident there.)
# <!-- claim: of('rule').scores('success').min() == 1 and accidents('rule') == 0 -->


# %%
def measure(agents, rows, roads=200):
    """Each clone's agreement with its data, successes, accidents on held-out roads: (clones, 3)."""
    size, found = bc.DEFAULT.observation_size, []
    batch = replay_buffer.decode_transitions(rows, size, torch.zeros(len(rows)))
    for agent in agents:
        agrees = agent.probabilities(batch.states.numpy()).argmax(1) == batch.actions.numpy()
        e = bc.drive_episodes(agent.as_policy(), bc.held_out_seeds(6, roads))
        found.append((agrees.mean(), e.success.mean(), (e.accident > 0).mean()))
    return np.array(found)


measured = {"clones of the rule": measure(rule_clones, by_rule)}
for agrees, success, accident in measured["clones of the rule"]:
    print(f"agrees {agrees:.0%}, escapes {success:.0%}, has an accident {accident:.0%}")

# %% [markdown]
# **See.** The four clones have the same data and the same loss; only the seed differs. Their
# agreement differs by a few per cent, their escapes and accidents by far more (your numbers will
# differ a little). So the agreement does not tell how well a clone drives.

# %% [markdown] tags=["instructor"] minutes=6
# Somebody will say "train longer". They are right: the ten clones of the study were trained far
# longer, and all of them escape (lesson 10). The point stands: a clone is trained on the rule's
# states and drives in its own, and the loss does not say when the training is long enough.
# <!-- claim: len(of('bc')) == 10 -->
# <!-- claim: escaped('bc') == len(of('bc')) -->

# %% [markdown]
# ## Round 4: why it is not enough
#
# Suppose that each decision is wrong with probability ε, independently of the others. Then the
# probability that a drive has an error somewhere grows with its length.
#
# **Exercise 6.5 (3 min, ●○○).** How likely is at least one wrong decision?


# %%
def any_error(error_rate, decisions):
    """The probability of one wrong decision or more, error_rate in [0, 1] for each of them."""
    # solution
    return 1 - (1 - error_rate) ** decisions
    # end solution


check.any_error(any_error)

# %%
# NBVAL_CHECK_OUTPUT
for error_rate in (0.2, 0.01, 0.001):
    somewhere = 1 - (1 - error_rate) ** 150
    print(f"ε = {error_rate}: an error in 150 decisions with probability {somewhere:.2f}")

# %% [markdown]
# **Explain.** Even at one error in a hundred, most drives have one. What matters is what comes
# *after* it.
# <!-- claim: 1 - (1 - 1 / 100) ** 150 > 0.5 -->
#
# > **Predict.** Take the distance from where a driver is to the nearest state in the
# > demonstrations. For the rule on other roads it is small. How does it change for a clone, from
# > second to second?


# %%
def strangeness(driver, seconds, roads=40):
    """Median distance from what a driver sees (at last) to the nearest demonstrated state."""
    drives, known = bc.record(driver, range(roads)), by_rule[:, : bc.DEFAULT.observation_size]
    found = []
    for t in seconds:
        seen = np.array([d.observations[min(t, len(d.actions))] for d in drives])
        found.append(float(torch.cdist(torch.from_numpy(seen), known).min(1).values.median()))
    return found


seconds = range(31)
curves = {"rule itself": strangeness(bc.rule_policy(bc.DEFAULT), seconds)}
for agent in rule_clones[:2]:
    curves[f"BC clone, seed {agent.settings.seed}"] = strangeness(agent.as_policy(), seconds)
title = "The clones leave the states that the demonstrations cover"
away = "distance to the nearest demonstrated state (scaled numbers of the observation)"
bc.show(charts.lines(seconds, curves, title, "time (s)", away))

# %% [markdown]
# Does the clone err on the rule's own states, or because it meets other states? Measure both: its
# agreement with the rule on what the *rule* sees at some second, and on what the *clone* sees then.

# %%
times = [0, 1, 2, 3, 5, 10, 30]
print("agreement with the rule at", times, "s")
for agent in rule_clones:
    own, quiz, exam = bc.record(agent.as_policy(), range(40)), [], []
    for t in times:
        seen = np.array([d.observations[t] for d in driven["the rule"]])
        right = np.array([d.actions[t] for d in driven["the rule"]])
        quiz.append(np.mean(agent.probabilities(seen).argmax(1) == right))
        exam.append(np.mean([d.actions[t] == d.rule_actions[t] for d in own if len(d.actions) > t]))
    print(f"seed {agent.settings.seed}: on the rule's states {np.round(quiz, 2)}")
    print(f"        on its own states    {np.round(exam, 2)}")

# %% [markdown]
# **Explain.** Read the two rows from left to right.
#
# - **At 2 s** the clone has done the same as the rule so far, with few exceptions, so it is in the
#   rule's states. It agrees on few roads nevertheless: this is an error on the demonstrator's *own*
#   states. The decision is a close one. On {{ 100 * rule_keeps_left(2) | .0f }} % of the 60 roads
#   the rule begins its lane change here, on most others one second later, and these clones choose
#   the earlier second too often.
# <!-- claim: 0.1 < rule_keeps_left(2) < 0.5 and rule_keeps_left(3) > 0.9 -->
# - **From 5 s on** the rows part: the clone agrees with the rule far less often on its own states
#   than on the rule's. Its states are now far from the demonstrated ones, as the figure shows. An
#   error brings a clone to such states, it errs more often there, and that brings it further away.
#   This is **compounding error**: with an error rate ε on the demonstrator's states, the cost over
#   $T$ steps can grow with $\epsilon T^2$ instead of $\epsilon T$ (Ross and Bagnell 2010).
# - **And yet these clones escape in most of their drives.** Agreement counts each difference as an
#   error, also one that does little harm, such as keeping the speed where the rule accelerates. A
#   clone of the study agrees with the rule, after 3 s on its own states, on
#   {{ 100 * clone_agrees(3, 3) | .0f }} % of 40 roads, and it escapes on
#   {{ 100 * of('bc').scores('success')[3] | .0f }} % of the {{ roads() | , }} held-out roads.
# <!-- claim: clone_agrees(3, 3) < 0.5 and of('bc').scores('success')[3] > 0.95 -->
#
# So test a clone by driving. A learner that drives while it learns is trained on its own states; a
# clone is not.

# %% [markdown]
# ## Round 5: worse drives, better demonstrations
#
# The stochastic rule often leaves the rule's path, and its next decisions *correct* that: its data
# show what to do beside the path. But one of its actions in ten is not the rule's. A third data set
# avoids this: the stochastic rule drives, and each state is labelled with the rule's action.
# <!-- claim: round(1 / (1 - RULE_P)) == 10 -->
#
# > **Predict.** Which clones drive best? Which agree best with their data?

# %%
ACTION = 2 * bc.DEFAULT.observation_size  # columns
RULE_ACTION = ACTION + 3
labelled = by_chance.clone()
labelled[:, ACTION] = labelled[:, RULE_ACTION]
measured["of the stochastic rule"] = measure(clone(by_chance), by_chance)
measured["its drives, rule's labels"] = measure(clone(labelled), labelled)
title = "Agreement with the data says little about how a clone drives"
bc.show(figures.clones(measured, title))

# %%
for name, values in measured.items():
    agrees, success, accident = 100 * values.mean(0)
    size = {"clones of the rule": by_rule}.get(name, by_chance)
    print(f"{name:26} {len(size):6,} rows: {agrees:3.0f} % agree, {success:3.0f} % escape, "
          f"{accident:3.0f} % have an accident")  # fmt: skip

# %% [markdown]
# **Explain.** The stochastic rule gave less than half as many rows, and most of its drives end
# beside the road. With these 1,500 updates its clones escape more often and have fewer accidents
# than the clones of the rule. We think so because its data **cover** more states: they show how to
# return to the path. To disturb the teacher on purpose is known as DART; to let the pupil drive and
# the teacher label is known as DAgger.
#
# How much coverage matters depends on the budget. The ten clones of the study learned from drives
# of the rule alone, with far more updates: {{ escaped('bc') }} of 10 escape, and they have an
# accident in {{ 100 * accidents('bc') | .1f }} % of their drives on {{ roads() | , }} held-out
# roads. Try `clone(by_rule, updates=12_000)`, about half a minute, and measure it.
# <!-- claim: len(of('bc')) == 10 and escaped('bc') == 10 and accidents('bc') < 0.01 -->
#
# The cloning loss contains no reward: it asks a clone to be like its teacher, not to be better. An
# agent that is to drive better than the rule has to learn from what its actions lead to, with the
# demonstrations as a start: lesson 8.

# %%
source("bootcourse.learn.demonstrations", "collect")

# %% [markdown]
# ## What you now know
#
# 1. A demonstration is a list of transitions; where time ran out, nothing has ended.
# 2. Look into the data first: the way to the free lane takes {{ way_out()[0] | .0f }} of 150 s.
# 3. With γ = 0.8 the rule's escape on road 10 is worth *less* at its start than doing nothing.
# <!-- claim: discounted(by_rule(), 0.8) < discounted(idle(), 0.8) -->
# 4. A clone is trained on the teacher's states and drives in its own, so its errors can compound.
# 5. With few updates, the states that the data cover can matter more than how well they were
#    driven; a longer training closes most of the gap.
#
# **Three questions to think about**
# - The rule reads the true state of all cars, the clone 26 numbers. Can two different states of
#   the road look the same to the clone, although the rule decides differently in them?
# - You may ask the rule for 1,000 labels, on states of your choice. Which ones?
# - A demonstrator that crashes at the end of each drive: which of its rows would you keep?
#
# **Read on**: Pomerleau, *ALVINN* (1989), the first clone that drove; Ross, Gordon and Bagnell,
# *A Reduction of Imitation Learning and Structured Prediction to No-Regret Online Learning*
# (arXiv 1011.0686), which is DAgger; Laskey et al., *DART* (arXiv 1703.09327). Next:
# [the soft constraint](07_soft_constraint.ipynb).
