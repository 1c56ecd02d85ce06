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
# # Exploration
#
# **What you will be able to do**
# - turn a policy's entropy into a number of actions, and say what it does not tell;
# - find out where on the road an agent still tries things, and where it does not get;
# - tell being undecided from seeing new places, and finding a way out from keeping it.
#
# **Time** 60 minutes, the machine computes for less than half a minute of it. **It builds on**
# discrete SAC (lesson [[discrete_sac]]) and the barrier ([[the_barrier]]).

# %%
import bootcourse as bc
import numpy as np
from bootcourse.course import charts, check, compare_predictions, predict, shipped, table
from bootcourse.course.lessons.exploration import exploring
from bootcourse.research.figures import exploration

# %% [markdown]
# ## Look first
#
# Five bootstrapped agents drive the same road. Here is the drive with the least decided moment.
# Move the slider `t`. The first bars are the probabilities that the agent gives to the nine actions
# at that second. How often do you find more than one?

# %% tags=["nbval-ignore-output"]
road = bc.shipped_drive("escape").seed
drives = [
    bc.record(agent.as_policy(with_q=True), [road], label="bootstrapped")[0]
    for agent in bc.shipped_agents("bootstrapped")
]
drive = max(drives, key=lambda drive: exploring.visits([drive]).entropy.max())
bc.panels.policy_panel(drive)

# %%
seen = exploring.visits([drive])
least = int(seen.entropy.argmax())
times = [max(0, least - 1), least, min(least + 1, drive.times[-1])]
bc.show(bc.top_view_over_time(drive, times))
title = f"Least decided {least} s after the start"
bc.show(charts.action_bars({f"at {least} s": seen.policy[least]}, title))
print(f"seconds with two actions above 10 %: {np.sum(np.sort(seen.policy)[:, -2] > 0.1)}", end=" ")
print(f"of {len(seen.policy)}")

# %% [markdown]
# ## Round 1: how many actions?
#
# The **entropy** of a policy in a state says how undecided it is:
#
# $$ \mathcal{H}(\pi(\cdot|s)) = -\sum_a \pi(a|s) \log \pi(a|s) $$
#
# It is 0 when one action has probability 1. Its unit, the *nat*, is hard to picture. But e to the
# power of it is a number of actions: a policy that chooses evenly among k actions has the entropy
# log k, so $e^\mathcal{H} = k$. We call it the **effective number of actions**.
#
# > **Predict.** A policy takes its favourite with probability 0.9, and the other eight evenly with
# > what is left. That is the stochastic rule of lesson [[the_rule]]. How many effective actions is
# > that?

# %%
predict("exploration.1", "Effective actions of the stochastic rule", ["1.1", "1.7", "3"])

# %% [markdown]
# **Exercise (6 min, ●○○).** Write it. A probability may be exactly 0: 0 · log 0 counts as 0.


# %%
def effective_actions(policy):
    """e to the power of the entropy of each row: (batch, 9) probabilities -> (batch,)."""
    # solution: the exercise's own


check.effective_actions(effective_actions)

# %%
# NBVAL_CHECK_OUTPUT
for p in (1 / 9, 0.5, 0.9, 0.99):
    rest = (1 - p) / 8
    nats = -p * np.log(p) - 8 * rest * np.log(rest)
    print(f"favourite {p:.2f}: {nats:.2f} nats, {np.exp(nats):.2f} effective actions")

# %% [markdown]
# **See.** With p = 0.9 the eight unlikely actions together count as less than one action. The
# effective number is easier to picture than nats, and it lies between 1 and {{ N_ACTIONS }}.
# <!-- claim: np.exp(-sum(p * np.log(p) for p in stochastic_rule(np.array(0), 0.9))) - 1 < 1 -->

# %% [markdown] tags=["instructor"] minutes=5
# Let them bet on 1.1, 1.7 or 3 by a show of hands. Those who say 3 count the tail by its actions,
# those who say 1.1 by its probability.

# %% [markdown]
# ## Round 2: how undecided, from the first episode to the last?
#
# > **Predict.** An agent that never leaves the trap, and one that does. Which of them is more
# > undecided at the end of its training? Among how many actions does each still choose?

# %%
choices = ["the one that never leaves", "the one that does", "both are nearly certain"]
predict("exploration.2", "More undecided at the end of training", choices)

# %%
study = bc.shipped_results()
bc.show(exploration(study))

# %%
methods = ("sac", "soft", "demos", "bootstrapped")
spans = ((0, 100), (200, 300), (900, 1000), (-100, None))
rows = []
for method in methods:
    nats = study.of(method).curves["entropy"]
    effective = [f"{np.exp(nats[:, a:b].mean()):.2f}" for a, b in spans]
    rows.append([bc.display_name(method), *effective])
episodes = study.curves["entropy"].shape[1]
table(["effective actions", "first 100", "200-300", "900-1000", f"last 100 of {episodes}"], rows)

# %% [markdown]
# **See.** Read the first two columns. In episodes 200 to 300 plain SAC and demonstrations alone are
# almost decided: {{ undecided('sac', 200, 300) | .1f }} and {{ undecided('demos', 200, 300) | .1f
# }} effective actions. With the soft constraint alone it is still {{ undecided('soft', 200, 300) |
# .1f }}, with both aids {{ undecided('bootstrapped', 200, 300) | .1f }}. At the end all four are
# nearly certain.
# <!-- claim: max(undecided(m, 200, 300) for m in ('sac', 'demos')) < min(undecided(m, 200, 300) for
#   m in ('soft', 'bootstrapped')) -->
# <!-- claim: all(undecided(m, -100, None) < 1.1 for m in ('sac', 'soft', 'demos', 'bootstrapped'))
#   -->
#
# **Explain.** Does the KL reward an agent for being undecided, then? No: it pulls towards the
# stochastic rule, and the stochastic rule has {{ np.exp(-(stochastic_rule(np.array(0), 0.9) *
# np.log(stochastic_rule(np.array(0), 0.9))).sum())
# | .1f }} effective actions. An agent with {{ undecided('soft', 200, 300) | .1f }} has more than
# its teacher, so a pull towards the teacher pulls its entropy *down*. All agents start near nine
# actions and come down; with the KL they come down later. A likely reason is that the KL
# contradicts the critic. With the weight ξ in the loss, differences between Q-values are divided by
# α + ξ = {{ 1 + SETTINGS.xi_multiplier }} α instead of α, so they decide the action less. No run
# here tests this.
# <!-- claim: undecided('soft', 200, 300) > 2 * np.exp(-(stochastic_rule(np.array(0), 0.9) *
#   np.log(stochastic_rule(np.array(0), 0.9))).sum()) -->
# <!-- claim: all(np.exp(of(m).curves['entropy'][:, :25].mean(1)).min() > 8 for m in ('sac', 'soft',
#   'demos', 'bootstrapped')) -->
#
# Why do all of them end nearly certain? The **temperature** α is what a nat of entropy earns. SAC
# adjusts α to hold the entropy at a target η, and the paper's target is {{ SETTINGS.target_entropy
# }}. That formula is for continuous actions. With nine actions the entropy is at least 0, and so
# above {{ SETTINGS.target_entropy }} in each state. Each update therefore lowers α (lesson
# [[discrete_sac]]). Here it is in the shipped agents:
# <!-- claim: SETTINGS.target_entropy < 0 -->

# %%
curves = {
    method: np.array([run.curves["alpha"] for run in shipped.shipped_runs(method)])
    for method in methods
}
fall = {method: alphas[:, 999] / alphas[:, 0] for method, alphas in curves.items()}
every = slice(0, None, 20)
named = {method: np.median(alphas, axis=0)[every] for method, alphas in curves.items()}
title = "In each of the four methods, α falls towards 0"
x = np.arange(curves["sac"].shape[1])[every]
bc.show(charts.lines(x, named, title, "training episode", "α, median agent", logarithmic="y"))
for method in methods:
    least, most = fall[method].min(), fall[method].max()
    name = bc.display_name(method)
    print(f"{name:22} α after 1000 episodes: {least:.0e} to {most:.0e} of its start")

# %% [markdown]
# (α falls with the *updates*. An agent whose episodes end at once makes few of them, and its α
# falls late.) With α this small the loss hardly rewards entropy any more. What an agent still tries
# after that, it tries by chance and not for a reward. So in this setting the learner has little
# time to look for a way out by itself.

# %% [markdown]
# ## Round 3: where does an agent still try things?
#
# A mean over a drive hides where the entropy lies. So five agents of each method drive on 24
# held-out roads, *after training*, with their most probable action. At each second we note how far
# the car is ahead of trap 1 and how undecided the policy is.
# <!-- claim: len(shipped_runs('sac')) == 5 -->

# %%
roads = list(bc.held_out_seeds(3, 24))
agents = {
    f"{bc.display_name(m)}, seed {a.settings.seed}": a
    for m in methods
    for a in bc.shipped_agents(m)
}
driven = {label: exploring.visits(bc.record(a.as_policy(), roads)) for label, a in agents.items()}
print(f"{sum(len(v.place) for v in driven.values())} decisions of {len(agents)} agents")

# %% [markdown]
# > **Predict.** Where will an agent that escapes be least decided: behind the traps, beside them,
# > or on the free road? And where will an agent of plain SAC get to in these drives?

# %%
choices_3 = ["behind the traps", "beside them", "on the free road"]
predict("exploration.3", "Where are escaping agents least decided, on average?", choices_3)

# %% [markdown]
# **Exercise (8 min, ●●○).** You get the entropy of some decisions, and where on the road each
# was made. Which share of the whole entropy was spent in each stretch? A stretch begins at its edge
# and ends before the next one. Decisions outside the stretches count in the whole.


# %%
def where_explored(place, entropy, edges):
    """Share of all entropy in each bin: place (n,) m, entropy (n,) nats, edges (k + 1,) -> (k,)."""
    # solution: the exercise's own


check.where_explored(where_explored)

# %% [markdown]
# Each field of the map has two pieces of information. Its colour says how many effective actions
# the agent has there, on average. Its digits say in which lanes it was there: 0 is the leftmost, 2
# the lane of the start. An empty field means that the agent did not get there in these 24 drives.

# %% tags=["hide-input"]
edges = np.array([-80, -40, -25, -15, -5, 5, 20, 60, 200, 1000])
actions = {k: exploring.mean_in_bins(v, np.exp(v.entropy), edges) for k, v in driven.items()}
furthest = {k: v.place.max() for k, v in driven.items()}
passed = sum(far > 0 for far in furthest.values())
title = f"After training, {passed} of {len(agents)} agents get ahead in these drives"
lanes = {label: exploring.lanes_in_bins(v, edges) for label, v in driven.items()}
low, high = (f(list(actions.values())) for f in (np.nanmin, np.nanmax))
words = f"colour: effective actions, {low:.2f} (white) to {high:.2f}; digits: lanes"
bc.show(exploring.map_of_places(actions, lanes, edges, title, words))

# %% tags=["hide-input"]
rows = []
for method in methods:
    mine = [v for label, v in driven.items() if label.startswith(bc.display_name(method) + ",")]
    spent, total = np.zeros(3), 0.0
    for v in mine:
        bins = [-np.inf, -5, 5, np.inf]
        spent += np.histogram(v.place, bins=bins, weights=v.entropy)[0]
        total += len(v.place)
    shares = [f"{100 * s:.0f} %" for s in spent / spent.sum()]
    rows.append([bc.display_name(method), f"{np.exp(spent.sum() / total):.2f}", *shares])
headings = ["", "effective actions, overall", "entropy spent behind", "beside trap 1", "ahead"]
table(headings, rows)

# %% [markdown]
# **See.** Most fields are close to one effective action: after training these agents hardly try
# anything where they drive. The digits separate the agents better: compare the rows of those that
# get ahead with the rows of those that stay behind, which are empty ahead of trap 1. The entropy at
# the places that an agent reaches says nothing about the places that it does not reach.
#
# > **Predict.** Ten of the twenty agents do not escape after training. How many of these ten
# > ended an episode ahead of trap 1 at some time in their training?
# <!-- claim: sum((of(m).scores('success')[:5] < ESCAPES).sum() for m in ('sac', 'soft', 'demos',
#   'bootstrapped')) == 10 -->

# %%
predict(
    "exploration.4", "How many of them had been ahead?", ["none", "1 to 3", "4 to 7", "8 or more"]
)

# %% [markdown]
# **Exercise (15 min, ●●●).** An agent that found the way out and lost it has *forgotten*.
# Measure that in the training curves, over windows of `window` episodes in a row. For each agent:
# the share of successes in its best window, the share in its last window, and the episode that ends
# the last window with a share of at least one half (0 without such a window). Episodes are counted
# from 1.


# %%
def forgetting(success, window):
    """Best share, last share, end of the last good one: (agents, episodes) 0/1 -> (agents, 3)."""
    # solution: the exercise's own


check.forgetting(forgetting)

# %% tags=["hide-input"]
rows = []
for method in methods:
    tested = study.of(method).scores("success")
    for seed, run in enumerate(shipped.shipped_runs(method)):
        ahead = np.flatnonzero(run.curves["success"])
        when = f"{ahead[0] + 1} to {ahead[-1] + 1}" if len(ahead) else ""
        best = bc.statistics.rolling_means(run.curves["success"][None], 100)[1].max()
        label = f"{bc.display_name(method)}, seed {seed}"
        rows.append([label, len(ahead), when, f"{100 * best:.0f}", f"{100 * tested[seed]:.0f}"])
headings = ["", f"of {episodes} episodes end ahead", "between episodes"]
table([*headings, "best 100 in a row, %", "after training, % of all held-out roads"], rows)

# %% [markdown]
# **See.** {{ sum((ended_ahead(m) > 0).sum() for m in ('sac', 'soft', 'demos', 'bootstrapped')) }}
# of the 20 agents ended training episodes ahead of trap 1. After training {{
# sum((of(m).scores('success')[:5] >= ESCAPES).sum() for m in ('sac', 'soft', 'demos',
# 'bootstrapped')) }} escape: they get ahead on at least {{ 100 * ESCAPES | g }} % of the held-out
# roads. So nine of the ten others had been ahead. Look at demonstrations alone: four of the five
# ended {{ np.sort(ended_ahead('demos'))[1] | .0f }} to {{ np.sort(ended_ahead('demos'))[-1] | .0f
# }} episodes ahead, three of them at least 99 of a hundred in a row, and after training none of the
# five gets ahead on one of the {{ roads() | , }} held-out roads. These four found the way out and
# *forgot* it. The trapped agents of plain SAC had less to forget: three of the four were ahead {{
# np.sort(ended_ahead('sac'))[1] | .0f }} to {{ np.sort(ended_ahead('sac'))[3] | .0f }} times, the
# fourth not once.
# <!-- claim: sum((ended_ahead(m) > 0).sum() for m in ('sac', 'soft', 'demos', 'bootstrapped')) ==
#   19 and (ended_ahead('sac') == 0).sum() == 1 -->
# <!-- claim: sum((of(m).scores('success')[:5] >= ESCAPES).sum() for m in ('sac', 'soft', 'demos',
#   'bootstrapped')) == 10 -->
# <!-- claim: (ended_ahead('demos') > 100).sum() == 4 and of('demos').scores('success').max() == 0
#   and sum(np.convolve(curve, np.ones(100), 'valid').max() >= 99 for curve in
#   of('demos').curves['success'][:5]) == 3 -->
# <!-- claim: np.sort(ended_ahead('sac'))[3] < 20 and (of('sac').scores('success')[:5] >=
#   ESCAPES).sum() == 1 and of('sac').scores('success')[ended_ahead('sac').argmax()] >= ESCAPES -->
#
# A map of drives after training does not show this. Why did they not keep it? Lesson [[ablation]],
# round 5, shows when four of the ten agents with demonstrations alone lose it: as the
# demonstrations run out. And round 6 shows agents that keep it: with two updates for each decision
# instead of a quarter, and demonstrations by the stochastic rule, all ten do.
# <!-- claim: escapers(clocks()['2', 'π̃'], 'demos') == len(clocks()['2', 'π̃'].of('demos')) == 10
#   -->

# %% [markdown] tags=["instructor"] minutes=7
# Stop at the map and ask what it does not show before they see the table: these are drives after
# training, and a colour is a mean over lanes and drives. The training curves record whether an
# episode ended ahead, but not the places in between. How would they find these out? (Train with
# `Training.run` and a callback, as in lesson [[soft_constraint]], that calls `visits` on a few
# drives now and then.)

# %% [markdown]
# ## Round 4: undecided drivers and the places they see
#
# > **Predict.** Two drivers, 24 roads each. One picks each action at random: log 9 nats, as much
# > entropy as there can be. The other is the rule: 0 nats. Which one sees more of the road?

# %%
predict(
    "exploration.5",
    "Who sees more of the road?",
    ["the random driver", "the rule", "about the same"],
)

# %% [markdown]
# **Exercise (7 min, ●●○).** Cut the road around trap 1 into cells: a stretch between two
# edges, in one lane. In which share of the cells did a driver make a decision?


# %%
def coverage(place, lane, edges, lanes):
    """Share of cells visited at least once. place (n,) m, lane (n,) 0..lanes-1, edges (k + 1,)."""
    # solution: the exercise's own


check.coverage(coverage)

# %%
cells = np.arange(-60, 101, 10)
others = {
    "random driver": bc.random_policy(np.random.default_rng(0)),
    "rule controller": bc.rule_policy(bc.DEFAULT),
}
rows = []
for label, driver in others.items():
    drives = bc.record(driver, roads)
    v, seconds = exploring.visits(drives), np.mean([len(drive.actions) for drive in drives])
    entropy = np.log(9) if label == "random driver" else 0.0
    share = 100 * exploring.cells_seen(v, cells)
    rows.append([label, f"{entropy:.2f}", f"{seconds:.0f} s", f"{share:.0f} %"])
for method in methods:
    mine = [v for label, v in driven.items() if label.startswith(bc.display_name(method) + ",")]
    nats, seconds = np.mean([v.entropy.mean() for v in mine]), np.mean([len(v.place) for v in mine])
    share = 100 * np.mean([exploring.cells_seen(v, cells) for v in mine])
    lasts = f"{seconds / len(roads):.0f} s"
    rows.append([bc.display_name(method), f"{nats:.2f}", lasts, f"{share:.0f} %"])
table(["", "entropy, nats", "a drive lasts", "cells seen, of one driver"], rows)

# %% [markdown]
# **Explain.** Entropy is noise on single decisions. In these drives the random driver crashes
# within seconds, so it does not get far. A driver without noise can see many places if its plan
# leads there, as the rule's does. To get to a new place, a driver has to make several right
# decisions in a row, and independent noise seldom does. A demonstration or a rule adds *other
# places*, without more randomness.

# %% [markdown]
# ## Round 5: does a trapped agent still try?
#
# > **Predict.** A trapped agent drives 150 s and draws each action from its policy, as it does in
# > training. What is the chance that it does anything but its favourite action, even once?

# %%
choices = ["under 5 %", "about half", "over 95 %", "it differs widely between agents"]
predict("exploration.6", "A trapped agent tries something else with a chance", choices)

# %% [markdown]
# **Exercise (5 min, ●●○).** The chance that in a drive at least one action that is drawn is
# not the likeliest one. You get the policy at each second of a drive with the likeliest actions:
# until it tries something else, the agent drives like that.


# %%
def ever_tries(policy):
    """The chance of at least one action other than the likeliest: (seconds, 9) -> a number."""
    # solution: the exercise's own


check.ever_tries(ever_tries)

# %%
rows = []
for method in methods:
    for agent in bc.shipped_agents(method):
        drive = bc.record(agent.as_policy(), roads[:1])[0]
        sure = drive.policy.max(axis=-1)
        tries = f"{np.sum(1 - sure):.1f} of {len(sure)}"
        ending = "ahead" if drive.success else "behind"
        label = f"{bc.display_name(method)}, seed {agent.settings.seed}"
        rows.append(
            [label, ending, f"{100 * exploring.chance_of_another(drive.policy):.0f} %", tries]
        )
headings = ["one drive", "ends", "another action at all", "other actions expected"]
table(headings, rows)

# %% [markdown]
# **See.** The agents differ widely. The last two columns do not tell you who ends ahead: look for
# an agent that tries and stays behind, and for one that hardly tries and ends ahead. One different
# action is not a plan: the next action, usually the favourite again, leads back.
#
# **Explain.** Why does more training not free a trapped agent? A tempting answer: its policy is its
# source of data, and data from the trap give no reason to leave it. For an agent that tries nothing
# this is likely. But it is not the whole story: nine of these ten agents had data of drives that
# ended ahead, five of them of more than a hundred, and after training they still stay behind on
# some or all roads. Looking for new places is of use to an agent that has not found the way out. An
# agent that has found it needs values that stay right when the data change.
# <!-- claim: sum(((ended_ahead(m) > 100) & (of(m).scores('success')[:5] < ESCAPES)).sum() for m in
#   ('sac', 'soft', 'demos', 'bootstrapped')) == 5 -->

# %% [markdown]
# ## What you now know
#
# 1. e to the power of the entropy is a number of actions, from 1 to {{ N_ACTIONS }}.
# 2. Target entropy {{ SETTINGS.target_entropy }} cannot be reached with nine actions: the median
#    agent's temperature falls to almost 0 in all four methods.
# <!-- claim: all(np.median([run.curves['alpha'][-1] for run in shipped_runs(m)]) < 1e-6 for m in
#   ('sac', 'soft', 'demos', 'bootstrapped')) -->
# 3. Entropy at the places that an agent reaches says nothing about the places that it does not
#    reach: look at the places, too.
# 4. In 24 drives a random driver sees less of the road than the rule does, which has a plan.
# 5. {{ sum((ended_ahead(m) > 0).sum() for m in ('sac', 'soft', 'demos', 'bootstrapped')) }} of 20
#    agents ended training episodes ahead of trap 1, and {{ sum((of(m).scores('success')[:5] >=
#    ESCAPES).sum() for m in ('sac', 'soft', 'demos', 'bootstrapped')) }} escape after training:
#    finding a way out is one problem, keeping it is another.
#
# **Three questions to think about**
# - The paper reads a higher entropy as better exploration. Which measure of this lesson would you
#   print beside it?
# - With a target entropy of 0.3 nats, how many effective actions would an agent keep, and what
#   would that do at 15 m/s on the free road?
# - Could an agent be paid for cells that it has not seen? What would it do in this traffic?

# %%
ends, least_decided = [-np.inf, -5, 5, np.inf], dict.fromkeys(choices_3, 0.0)
for v in driven.values():
    if v.place.max() > 5:  # it escapes in some of these drives
        for i, where in enumerate(choices_3):
            there = (v.place >= ends[i]) & (v.place < ends[i + 1])
            least_decided[where] += v.entropy[there].mean() if there.any() else 0.0
was_ahead = [run.curves["success"].any() for m in methods for run in shipped.shipped_runs(m)]
trapped = [study.of(m).scores("success")[:5] < bc.statistics.ESCAPES for m in methods]
compare_predictions(
    "exploration",
    {
        1: "1.7",
        2: "both are nearly certain",
        3: max(least_decided, key=least_decided.get),
        4: f"{np.sum(np.array(was_ahead) & np.concatenate(trapped))} of {np.sum(trapped)}",
        5: "the rule",
        6: "it differs widely between agents",
    },
)

# %% [markdown] tags=["instructor"] minutes=3
# Answers to the three questions. (1) Coverage of cells, or how often training episodes end ahead:
# the entropy says how a policy chooses, and not where it gets. (2) e to the power of 0.3, so about
# 1.35 actions. At 15 m/s on the free road one second of steering moves the car more than a metre,
# so now and then a drawn action costs the lane; with the most probable action it need not show. (3)
# Yes: with counts, or a bonus for the surprise of a model. Here the places near other cars are new
# on each road, so a bonus for surprise would hardly run out, and it would pay for risky places.

# %% [markdown]
# **Read on**: what a reachable target does in [lesson [[discrete_sac]]](discrete_sac.ipynb), and a
# way out that comes from somebody else in [lesson
# [[learning_from_demonstrations]]](learning_from_demonstrations.ipynb). Christodoulou, *Soft
# Actor-Critic for Discrete Action Settings* (arXiv 1910.07207); Ecoffet et al., *First return, then
# explore* (arXiv 2004.12919).
