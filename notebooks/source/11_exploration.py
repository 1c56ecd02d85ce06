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
# # 11 · Exploration
#
# **What you will be able to do**
# - turn a policy's entropy into a number of actions, and say what it does not tell;
# - find out where on the road an agent still tries things, and where it never was;
# - tell apart being undecided and seeing new places, which is what exploration is for.
#
# **Time** 45 minutes, under half of one the machine's. **It builds on** discrete SAC (lesson 4) and
# the barrier (5).

# %%
import bootcourse as bc
import numpy as np
from bootcourse.lessons import charts, check, exploring, shipped, table
from bootcourse.study.figures import exploration

# %% [markdown]
# ## Look first
#
# Agents that were trained with help, all on the same road: here is the one that is least decided
# somewhere on its way. Move the slider `t`. The first bars are the probabilities that the agent
# gives to the nine actions at that second. How often do you find more than one?

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
# It is 0 when one action has all the probability. Its unit, the *nat*, tells nobody much. But e to
# the power of it is a number of actions: a policy that chooses evenly among k actions has the
# entropy log k, so $e^\mathcal{H} = k$. We call it the **effective number of actions**.
#
# > **Predict.** A policy takes its favourite with probability 0.9, and the other eight evenly with
# > what is left. That is the stochastic rule of lesson 3. How many effective actions is that: 1.1,
# > 1.7 or 3?
#
# **Exercise 11.1 (6 min, ●○○).** Write it. A probability may be exactly 0: 0 · log 0 counts as 0.


# %%
def effective_actions(policy):
    """e to the power of the entropy of each row: (batch, 9) probabilities -> (batch,)."""
    # solution
    safe = np.where(policy > 0, policy, 1.0)
    return np.exp(-np.sum(policy * np.log(safe), axis=-1))
    # end solution


check.effective_actions(effective_actions)

# %%
# NBVAL_CHECK_OUTPUT
for p in (1 / 9, 0.5, 0.9, 0.99):
    rest = (1 - p) / 8
    nats = -p * np.log(p) - 8 * rest * np.log(rest)
    print(f"favourite {p:.2f}: {nats:.2f} nats, {np.exp(nats):.2f} effective actions")

# %% [markdown]
# **See.** Eight unlikely actions add up to less than one. The number is a way of speaking, and a
# good one: it has a unit that you can picture, and it lies between 1 and {{ N_ACTIONS }}.
# <!-- claim: np.exp(-sum(p * np.log(p) for p in stochastic_rule(np.array(0), 0.9))) - 1 < 1 -->

# %% [markdown] tags=["instructor"] minutes=5
# Let them bet on 1.1, 1.7 or 3 by a show of hands. Those who say 3 count the tail by its actions,
# those who say 1.1 by its probability.

# %% [markdown]
# ## Round 2: over a training
#
# > **Predict.** An agent that never leaves the trap, and one that does. Which of them is more
# > undecided at the end of its training? Among how many actions does each still choose?

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
table(["effective actions", "first 100", "200-300", "900-1000", f"last of {episodes}"], rows)

# %% [markdown]
# **See.** Read the first two columns. Plain SAC has made up its mind early; whoever has the soft
# constraint stays undecided for longer, since the KL charges it for being surer than the rule
# (whose stochastic form gives every action some probability). In the end all are nearly certain.
# <!-- claim: max(undecided(m, 200, 300) for m in ('sac', 'demos')) < min(undecided(m, 200, 300) for
#   m in ('soft', 'bootstrapped')) -->
# <!-- claim: all(undecided(m, -100, None) < 1.1 for m in ('sac', 'soft', 'demos', 'bootstrapped'))
#   -->
#
# **Explain.** Why all of them? Because of the **temperature** α, the price of a nat. SAC is to hold
# the entropy at a target η by turning α, and the paper's target is {{ SETTINGS.target_entropy }}.
# That formula is for continuous actions. With nine actions the entropy is never below 0, let alone
# at {{ SETTINGS.target_entropy }}, so α is always found to be too high, and falls (lesson 4). Here
# it is in the shipped agents:

# %%
curves = {
    method: np.array([run.curves["alpha"] for run in shipped.shipped_runs(method)])
    for method in methods
}
fall = {method: alphas[:, 999] / alphas[:, 0] for method, alphas in curves.items()}
every = slice(0, None, 20)
named = {method: np.median(alphas, axis=0)[every] for method, alphas in curves.items()}
last = max(values[-1] for values in named.values())
title = f"Whatever the method, the median agent's price of entropy ends under {10 * last:.0e}"
x = np.arange(curves["sac"].shape[1])[every]
bc.show(charts.lines(x, named, title, "training episode", "α, median agent", logarithmic="y"))
for method in methods:
    least, most = fall[method].min(), fall[method].max()
    name = bc.display_name(method)
    print(f"{name:22} α after 1000 episodes: {least:.0e} to {most:.0e} of its start")

# %% [markdown]
# (α falls with every *update*. An agent whose episodes end at once makes few of them, and its α
# falls late.) At such a price entropy buys nothing, and what is left of it is an accident of how
# the networks got there. So in this paper's setting no agent explores on purpose for long. If it is
# to see something new, it has to be early, or somebody has to show it.

# %% [markdown]
# ## Round 3: where?
#
# A mean over a drive hides where the entropy lies. Twenty-four held-out roads, five agents of each
# method, driven by their most probable action: at each second we note how far the car is ahead of
# trap 1 and how undecided it is.
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
# > or on the free road? And where has an agent of plain SAC been at all?
#
# **Exercise 11.2 (8 min, ●●○).** Of all the entropy of some decisions, which share was spent in
# each stretch of road? A stretch begins at its edge and ends before the next one; what lies outside
# all of them belongs to the total and to no stretch.


# %%
def where_explored(place, entropy, edges):
    """Share of all entropy in each bin: place (n,) m, entropy (n,) nats, edges (k + 1,) -> (k,)."""
    # solution
    column = np.digitize(place, edges) - 1
    inside = (column >= 0) & (column < len(edges) - 1)
    spent = np.bincount(column[inside], weights=entropy[inside], minlength=len(edges) - 1)
    return spent / entropy.sum()
    # end solution


check.where_explored(where_explored)

# %% [markdown]
# The map shows means: how many effective actions each agent has in a stretch, when it is there.

# %%
edges = np.array([-80, -40, -25, -15, -5, 5, 20, 60, 200, 1000])
actions = {k: exploring.mean_in_bins(v, np.exp(v.entropy), edges) for k, v in driven.items()}
furthest = {k: v.place.max() for k, v in driven.items()}
passed = sum(far > 0 for far in furthest.values())
title = f"Of {len(agents)} agents, {passed} have ever been ahead of trap 1"
bc.show(exploring.map_of_places(actions, edges, title, "effective actions"))

# %%
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
# **See.** Two things at once. The fields are nearly all close to 1: a trained agent hardly tries
# anything, wherever it is. And the empty fields are the message: an agent that is trapped is not
# *undecided* at the way out, it is never there. No setting of its entropy at the places that it
# visits says anything about those.

# %% [markdown] tags=["instructor"] minutes=7
# Ask for what the map cannot show: these are drives after training. Where the agents were in their
# first hundred episodes is not recorded. How would they find out? (Train with `Training.run` and a
# callback that calls `visits` on a few drives now and then, as lesson 7 does.)

# %% [markdown]
# ## Round 4: undecided is not far-travelled
#
# > **Predict.** Two drivers, 24 roads each. One picks each action at random: log 9 nats, as much
# > entropy as there can be. The other is the rule: 0 nats. Which one sees more of the road?
#
# **Exercise 11.3 (7 min, ●●○).** Cut the road around trap 1 into cells: a stretch between two
# edges, times a lane. Which share of the cells did a driver make a decision in?


# %%
def coverage(place, lane, edges, lanes):
    """Share of cells visited at least once. place (n,) m, lane (n,) 0..lanes-1, edges (k + 1,)."""
    # solution
    column = np.digitize(place, edges) - 1
    inside = (column >= 0) & (column < len(edges) - 1)
    cells = np.unique(column[inside] * lanes + lane[inside])
    return len(cells) / ((len(edges) - 1) * lanes)
    # end solution


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
# **Explain.** Entropy is noise on single decisions. On this road noise ends in a crash within
# seconds: there is no time to get far. A driver that never hesitates can get around, if its plan is
# one that leads somewhere; if not, it sees next to nothing, and sees that again and again. To see a
# new place takes several right decisions in a row, and independent noise does not make plans. That
# is what a demonstration or a rule adds: not more randomness, but *other places*.

# %% [markdown]
# ## Round 5: will it ever try?
#
# > **Predict.** A trapped agent drives 150 s and draws each action from its policy, as it does in
# > training. What is the chance that it does anything but its favourite action, even once?
#
# **Exercise 11.4 (5 min, ●●○).** The chance that in a drive at least one action that is drawn is
# not the likeliest one. The policy is given at each second of the drive.


# %%
def ever_tries(policy):
    """The chance of at least one action other than the likeliest: (seconds, 9) -> a number."""
    # solution
    return 1 - np.prod(policy.max(axis=-1))
    # end solution


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
        rows.append([label, ending, f"{100 * (1 - np.prod(sure)):.0f} %", tries])
table(["one drive", "ends", "tries at all", "tries expected"], rows)

# %% [markdown]
# **See.** The agents differ widely, and the last two columns have little to do with who is ahead.
# An agent that tries something at every tenth second, one try at a time, comes back to where it
# was; an agent that never tries cannot be taught anything new by its own driving, good or bad.
#
# **Explain.** Here is why more training does not free a trapped agent: its policy is its only
# source of data, and its data hold no reason to change its policy. Help has to come before α is
# spent, or from outside.

# %% [markdown]
# ## What you now know
#
# 1. e to the power of the entropy is a number of actions, from 1 to {{ N_ACTIONS }}.
# 2. Target entropy {{ SETTINGS.target_entropy }} cannot be reached with nine actions; the
#    temperature falls until entropy has no price, in all four methods.
# <!-- claim: all(np.median([run.curves['alpha'][-1] for run in shipped_runs(m)]) < 1e-6 for m in
#   ('sac', 'soft', 'demos', 'bootstrapped')) -->
# 3. Where an agent never is, its entropy says nothing; look at the places first.
# 4. Noise on single decisions covers little of this road; plans cover more, and a rule has one.
# 5. A policy that is certain makes data that keep it so.
#
# **Three questions to think about**
# - The paper reads a higher entropy as better exploration. Which measure of this lesson would you
#   print beside it?
# - With a target entropy of 0.3 nats, how many effective actions would an agent keep, and what
#   would that do at 15 m/s on the free road?
# - Could an agent be paid for cells that it has not seen? What would it do in this traffic?
#
# **Read on**: what a reachable target does in [lesson 4](04_discrete_sac.ipynb), and a way out that
# comes from somebody else in [lesson 8](08_learning_from_demonstrations.ipynb). Christodoulou,
# *Soft Actor-Critic for Discrete Action Settings* (arXiv 1910.07207); Ecoffet et al., *First
# return, then explore* (arXiv 2004.12919).
