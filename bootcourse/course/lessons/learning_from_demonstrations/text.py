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
# # Learning from demonstrations
#
# **What you will be able to do**
# - mix the rule's drives into a learner's batches, pay them a bonus, and let their share fall to 0;
# - find the smallest bonus c that makes the rule's drive worth more than staying behind, and see
#   what c = {{ SETTINGS.bonus }} does to a critic and an agent;
# - write the large-margin loss with the printed Q-filter, and say when the filter is on;
# - say what demonstrations bring, and train the paper's whole method in your own code.
#
# **Time** 75 minutes. **It builds on** the demonstrations of lesson [[demonstrations]], and on the
# parts of lessons [[discrete_sac]], [[update_and_loop]] and [[soft_constraint]].

# %%
import inspect

import bootcourse as bc
import numpy as np
import torch
from bootcourse.course import (
    charts,
    check,
    compare_predictions,
    own_code,
    predict,
    predicted,
    progress,
    shipped,
    table,
)
from bootcourse.course.lessons.learning_from_demonstrations import figures, measures
from bootcourse.panels.bonus import bonus_numbers
from bootcourse.statistics import rolling_means

progress("learning_from_demonstrations")

# %% [markdown]
# ## Look first
#
# At γ = {{ SETTINGS.gamma }} the rule's drive is worth less at its start than staying:

# %% tags=["hide-input"]
roads = range(20)
by_rule = bc.record(bc.rule_policy(bc.DEFAULT), roads, label="rule")
stays = bc.record(bc.idle_policy, roads, label="idle")
each = bonus_numbers(by_rule[10], stays[10], bc.settings_for("bootstrapped"))
named = {"rule": each.plain[:60], "idle, stays behind": each.trapped[:60]}
title = "At first the rule's drive is worth less than staying behind, later more"
label = "discounted return from this second on"
bc.show(charts.lines(np.arange(60), named, title, "second of the drive", label))

# %% [markdown]
# So pay the learner a **bonus** c for each second that is demonstrated, on top of the reward.
# <!-- claim: discounted(by_rule(), SETTINGS.gamma) < discounted(idle(), SETTINGS.gamma) -->

# %% [markdown] tags=["instructor"] minutes=3
# Ask what the two lines of the figure would look like with γ = 1, and why a learner cannot wait for
# their crossing.

# %% [markdown]
# ## Round 1: how do demonstrations get into a batch?
#
# For each update a learner draws a batch of {{ SETTINGS.batch }} rows from its replay buffer. Now
# there is a second table, with the rule's drives in it.

# %%
demonstrations = bc.collect(200)
print(f"{len(demonstrations):,} transitions of 200 drives of the rule")

# %% [markdown]
# A share β ("beta") of each batch comes from the second table. It starts at {{ SETTINGS.beta_start
# }} and falls in a straight line to 0 over {{ SETTINGS.beta_episodes | , }} episodes.
# <!-- claim: demonstration_share(1000, 0.6, 1000) == 0 -->

# %%
rows = []
for episode in (0, 250, 500, 999, 2000):
    beta = bc.bootstrap.demonstration_share(episode, 0.6, 1000)
    rows.append([f"{episode:,}", f"{beta:.3f}", round(64 * beta)])
table(["episode", "β", "of 64 rows are the rule's"], rows)

# %% [markdown]
# > **Predict.** Leave the soft constraint out for now. The actor's loss of lesson [[discrete_sac]]
# > has no term for the action of a row. How can the rule's *actions* in these rows change the
# > policy?

# %%
choices = ["not at all: a term is missing", "through the critics' Q", "through the temperature α"]
predict("learning_from_demonstrations.1", "How can the rule's actions change the policy?", choices)

# %%
predicted("learning_from_demonstrations.1")
for loss in (bc.sac.critic_loss, bc.sac.actor_loss, bc.sac.temperature_loss):
    print(f"{loss.__name__} reads {', '.join(inspect.signature(loss).parameters)}")

# %% [markdown]
# **Explain.** Through the critics' Q: only their loss reads a row's action (`q_taken`) and reward
# (`target`). An action that they value more becomes more probable.

# %% [markdown] tags=["instructor"] minutes=3
# Draw a batch as a row of 64 boxes. Shade the rule's after 0, 500 and 1,000 episodes.

# %% [markdown]
# ## Round 2: how large must the bonus be?
#
# If the critics give the rule's actions a low value, the actor learns to avoid them. So the paper
# pays a bonus (Equation 20):
#
# $$ r'(s, a_E) = r(s, a_E) + c, \qquad c = {{ SETTINGS.bonus }} $$
#
# $a_E$ is the demonstrated action (E for *expert*, here the rule).
#
# **Exercise (20 min, ●●●).** Write the mixed batch. `round(beta * size)` rows are drawn from the
# table of demonstrations, each row with the same chance; the others come from your own replay
# buffer, `own.sample(n, rng)`. Raise each demonstration's reward by the bonus. Return the rows, and
# a mark for each: 1 for a demonstration, else 0. Do not change the table: later batches use it
# again.

# %%
REWARD = -4  # the column of a row that holds the reward


def mixed_batch(own, demonstrations, size, beta, bonus, rng):
    """(rows (size, n), marks (size,)), tensors. rng: a NumPy generator.

    demonstrations: a tensor (m, n), a row is (s, s', a, r, terminated, μ(s), μ(s')).
    """
    # solution: the exercise's own


check.mixed_batch(mixed_batch)

# %% [markdown]
# > **Predict.** How large must c be for the rule's drive to be worth more than staying, in each
# > second, on each of 20 roads?

# %%
predict(
    "learning_from_demonstrations.2",
    "From about which bonus c on is the rule's drive worth more?",
    ["0.005", "0.05", "0.5", "5"],
)

# %%
predicted("learning_from_demonstrations.2")
rows = []
for gamma in (0.8, 0.9, 0.95):
    settings = bc.settings_for("bootstrapped", gamma=gamma)
    seen = [bonus_numbers(d, i, settings) for d, i in zip(by_rule, stays, strict=True)]
    better = sum(each.plain[0] > each.trapped[0] for each in seen)
    needed = max(each.crossing.max() for each in seen)
    rows.append([gamma, f"{better} of {len(seen)}", f"{needed:.3f}"])
headings = ["γ", "roads where the drive is worth more", "smallest c for all roads and seconds"]
table(headings, rows)

# %% [markdown]
# **See.** At γ = {{ SETTINGS.gamma }} a bonus of 0.06 a second is enough on each of the 20 roads.
# <!-- claim: all(discounted(by_rule(road), 0.8) < discounted(idle(road), 0.8)
#   for road in range(20)) -->
#
# > **Predict.** The paper takes c = 2. If each second from now on is demonstrated, by how much
# > does that raise the discounted return?

# %%
predict(
    "learning_from_demonstrations.3",
    "By how much does c = 2 in each second raise the discounted return?",
    ["2", "4", "10", "300"],
)

# %%
predicted("learning_from_demonstrations.3")
rows = []
for c in (0.0, 0.05, 0.5, 2.0):
    each = bonus_numbers(by_rule[10], stays[10], bc.settings_for("bootstrapped", bonus=c))
    values = (each.augmented[0], each.trapped[0], c * each.weight[0])
    rows.append([c, *(f"{value:.2f}" for value in values)])
table(["c", "the rule's drive", "staying", "the bonus adds c / (1 − γ)"], rows)

# %% [markdown]
# **Drag** c, and read the lower picture: in which seconds does the rule's drive need a bonus?

# %%
bc.panels.bonus_panel()

# %% [markdown]
# **Explain.** c = {{ SETTINGS.bonus }} is more than thirty times what the rule's drive needs. Paid
# in each second, it adds c / (1 − γ) = {{ SETTINGS.bonus / (1 - SETTINGS.gamma) | .0f }}, as much
# as an accident costs.
# <!-- claim: SETTINGS.bonus > 30 * 0.06 -->
# <!-- claim: round(SETTINGS.bonus / (1 - SETTINGS.gamma)) == 10 -->
# <!-- claim: math.isclose(SETTINGS.bonus / (1 - SETTINGS.gamma), -DEFAULT.reward.accident) -->

# %% [markdown] tags=["instructor"] minutes=6
# SQIL (Reddy et al.) pays 1 for demonstrations, 0 for everything else, and does not use the road's
# reward. Ask how much of its argument applies here: with c = 2 and rewards below 1, most of it. A
# good question is what a bonus on *all* rows would do: it pays for each second without an accident.
# <!-- claim: SETTINGS.bonus == 2 and max(map(second_pays, np.arange(0, 25, 0.1))) < 1 -->

# %% [markdown]
# **Slide.** Train with demonstrations and KL. When the success is near 100 %, at about episode 300,
# set c to 0. Which curves move?

# %%
bc.panels.train_panel("bootstrapped", seeds=2, episodes=600)

# %% [markdown]
# **See.** In our runs the return rose sooner than with c = 2, and for a while fewer drives
# succeeded. Keep your guess why: Round 6.

# %% [markdown]
# ## Round 3: what does c = 2 do to a critic?
#
# Train four learners with demonstrations alone, β fixed at {{ SETTINGS.beta_start }}: two with c =
# {{ SETTINGS.bonus }}, two with c = 0. Ask their critics about the *way out*, the first 20 seconds
# of the rule's drives: by how much does the demonstrated action lead the mean of the eight others,
# and the best of them?
# <!-- claim: settings_for('demos').xi_multiplier == 0 and settings_for('demos').xi_fixed is None
#   -->
#
# > **Predict.** By how much does c = 2 raise the lead over the mean? If another action is taken
# > once and the drive then goes on as the rule's, how many bonuses does it miss?

# %%
predict(
    "learning_from_demonstrations.4",
    "By how much does c = 2 raise the lead over the others' mean?",
    ["by about five bonuses, 10", "by about one bonus, 2", "hardly"],
)

# %% tags=["hide-input"]
way = np.concatenate([drive.observations[:20] for drive in by_rule])
rule_did = torch.from_numpy(np.concatenate([drive.rule_actions[:20] for drive in by_rule]))
learners = bc.with_seeds(bc.settings_for("demos", beta_episodes=None), 2)
learners += bc.with_seeds(bc.settings_for("demos", beta_episodes=None, bonus=0.0), 2)

# %%
predicted("learning_from_demonstrations.4")
training = bc.Training(learners, episodes=20_000, learner="compiled")  # the same, faster
result = training.run(updates=8000)
rows, leads = [], []
for agent in result.agents:
    seen = measures.opinion(agent.q_values(way), rule_did.numpy())
    words = f"c = {agent.settings.bonus:g}, seed {agent.settings.seed}"
    rows.append([words, *(f"{each:.2f}" for each in seen[:3]), f"{seen.first:.0f}"])
    leads.append(seen.lead)
raised = np.subtract(leads[:2], leads[2:])
headings = ["the demonstrated action", "its mean Q", "lead over the others' mean"]
headings += ["lead over the best other", "comes first, % of states"]
table(headings, rows)

# %% [markdown]
# **See.** The bonus raises the Q of all actions: another action gains, too, if it leads to states
# in which the rule's action is paid. In our six pairs of learners, two of them here, the lead over
# the others' mean grew by half a bonus to a little more than one, the lead over the best other by
# at most half of one. And that lead decides which action comes first.

# %% [markdown] tags=["instructor"] minutes=4
# Ask for the control that is missing: a bonus on *all* rows, which changes every value and no
# preference. And ask what β = 0.6 for ever would do to a trained agent (lesson [[found_and_kept]]).
# Long after β has reached 0, little or nothing of the bonus is left in the critics of five shipped
# `demos` agents: the mean Q of the demonstrated actions on the way out is at most {{
# demonstrated_q('demos').max() | .1f }}, with plain SAC {{ demonstrated_q('sac').max() | .1f }}.
# <!-- claim: len(demonstrated_q('demos')) == len(demonstrated_q('sac')) == 5 -->
# <!-- claim: demonstrated_q('demos').max() < 2 -->

# %% [markdown]
# ## Round 4: what does a margin change?
#
# *In place of the bonus* the paper also tries a loss: in each demonstrated state, the Q of the
# demonstrated action should lead the Q of each other action by a **margin** of at least {{
# settings_for('margin').margin | .0f }}.
#
# $$ J_E(Q) = \max_a \big[ Q(s,a) + l(a_E, a) \big] - Q(s,a_E), \qquad
# l = 0 \text{ for } a_E, \text{ else } 1 $$
#
# Three actions have Q = 3, 2.4 and 0. What is the loss if the first was demonstrated, and what if
# the third was?

# %%
for shown in (0, 2):
    loss, gradient = figures.margin_example([3.0, 2.4, 0.0], shown)
    print(f"action {shown} was demonstrated: loss {loss:.1f}, gradient in Q {gradient}")

# %% [markdown]
# The loss is 0 once the demonstrated action leads by the whole margin. Until then it pushes that
# action's Q up and the Q of its *best rival* down.
# <!-- claim: bool(bootstrap.large_margin_loss(torch.tensor([[3.0, 2.0, 0.0]]), torch.tensor([0]))
#   == 0) -->
#
# **Exercise (8 min, ●●○).** Write the loss of each state.


# %%
def large_margin_loss(q, expert_action):
    """J_E, margin 1. q: (batch, actions); expert_action: (batch,) int64. Returns (batch,), ≥ 0."""
    # solution
    is_expert = torch.arange(q.shape[-1]) == expert_action.unsqueeze(-1)
    q_expert = q.gather(-1, expert_action.unsqueeze(-1)).squeeze(-1)
    return (q + (~is_expert)).amax(-1) - q_expert
    # end solution


check.large_margin_loss(large_margin_loss)

# %% [markdown] tags=["instructor"] minutes=3
# Three bars for Q on the board, the margin on top of two of them. Let the class say for each of the
# three actions as the expert's which bar is pushed, and in which direction.

# %% [markdown]
# ## Round 5: when is the margin loss off?
#
# A **Q-filter** switches the margin loss off in states where the critic gives another action a
# higher value: there the rule may be wrong. The paper's condition for *on* is
#
# $$ Q(s,a_E) \ge \max_a Q(s,a). $$
#
# **Exercise (3 min, ●○○).** Write the filter as it is printed.


# %%
def paper_q_filter(q, expert_action):
    """1 where the loss counts, else 0, (batch,). q: (batch, actions); expert_action: (batch,)."""
    # solution
    q_expert = q.gather(-1, expert_action.unsqueeze(-1)).squeeze(-1)
    return (q_expert >= q.amax(-1)).to(q.dtype)
    # end solution


check.paper_q_filter(paper_q_filter)

# %% tags=["hide-input"]
q = [0.2, 1.1, 0.3, 0.6, 0.9, 0.4, 0.5, 1.4, 0.1]
bc.show(figures.margin_bars(q, bc.ACTION_NAMES.index("brake straight")))

# %% [markdown]
# An action's Q is at most the largest Q, so ≥ means =. The printed filter is on only where the
# demonstrated action comes first already. There the loss can raise its lead over the best rival up
# to the margin, and nothing else.
# <!-- claim: bootstrap.paper_q_filter(torch.tensor([[1, 2, 3]] * 3), torch.arange(3)).tolist()
#   == [0, 0, 1] -->
# <!-- claim: settings_for('margin').paper_q_filter and settings_for('margin_soft').paper_q_filter
#   -->
#
# **Exercise (15 min, ●●●).** Put the margin into the critics' loss: for each of the two critics the
# margin loss (margin 1) of the demonstrated rows, switched by the printed filter of the *same*
# critic. Take the mean over the whole batch, other rows count as 0, and add the two critics' means:
# mean and sum are our choice. The filter is a switch: no gradient goes through it.


# %%
def margin_loss(q_pair, action, is_demonstration):
    """A scalar tensor. q_pair: (2, batch, actions); action, is_demonstration (1 or 0): (batch,)."""
    # solution: the exercise's own


check.margin_loss(margin_loss)

# %% [markdown]
# How often is the printed filter on along the way out? Train two learners with the margin, and two
# without it as a control, all with the soft constraint and demonstrations without a bonus.
#
# > **Predict.** Before the first update nine values are random: the demonstrated action comes
# > first in about a ninth of the states, on average over many networks (in one it may be 0 or
# > 20 %). In {{ 100 * straight() | .0f }} % of these states the rule keeps straight. Early in a
# > training one action often comes first nearly everywhere: what does the margin loss do if it is
# > that one? In which share of the states is the filter on after 250 updates, with the margin?

# %%
predict(
    "learning_from_demonstrations.5",
    "In how many of these states is the filter on after 250 updates?",
    ["under 8 %", "8 to 20 %", "over 20 %"],
)

# %% tags=["hide-input"]
switched_on = {}  # {update: in which states the filter is on, for each of the four learners}


def ask(training):
    """Every 10 updates: in which of these states the filter is on, (4, states) of 0 or 1."""
    if training.updates % 10 or training.updates in switched_on:
        return
    values = [torch.from_numpy(training.agent(i).q_values(way)) for i in range(4)]
    on = [bc.bootstrap.paper_q_filter(q, rule_did).numpy() for q in values]
    switched_on[training.updates] = np.array(on)


# %%
predicted("learning_from_demonstrations.5")
control = bc.with_seeds(bc.settings_for("bootstrapped", bonus=0.0), 2)
four = bc.with_seeds(bc.settings_for("margin_soft"), 2) + control
training = bc.Training(four, episodes=20_000, learner="compiled")
training.run(callback=ask, updates=1001)
states_on = np.array(list(switched_on.values()))  # (times, 4, states)
shares = 100 * states_on.mean(2).T  # (4, times)
on = shares[:2, list(switched_on).index(250)].mean()
title = "With the margin loss the filter stays on once it is on; without the loss it comes and goes"
named, label = {"without it": shares[2:], "margin": shares[:2]}, "states with the filter on (%)"
looks = [charts.Style("#5F6B77"), charts.Style("#CC79A7")]
bc.show(charts.lines(list(switched_on), named, title, "update", label, looks=looks))

# %% tags=["hide-input"]
rows = []
for name, pair in (("with the margin", slice(0, 2)), ("without it", slice(2, 4))):
    before, after = states_on[:-1, pair], states_on[1:, pair]
    kept, turned = after[before == 1].mean(), after[before == 0].mean()
    rows.append([name, f"{100 * kept:.0f} %", f"{100 * turned:.0f} %"])
table(["ten updates later the filter is on", "where it was on", "where it was off"], rows)

# %% tags=["hide-input"]
straight = rule_did.numpy() == bc.ACTION_NAMES.index("keep straight")
then = states_on[list(switched_on).index(250)]
rows = []
for words, part in {"keeps straight": straight, "does something else": ~straight}.items():
    rows.append([words, *(f"{100 * each[:, part].mean():.0f} %" for each in (then[:2], then[2:]))])
table(["after 250 updates, where the rule", "on, with the margin", "without it"], rows)

# %% [markdown]
# **Explain.** Where the filter is off, the loss is 0, and the critics' targets have to turn it on.
# Where it is on, the loss raises the lead over the best rival, and the filter *stays* on. Without
# the loss another action soon comes first again. In our run "keep straight" came first in most
# states near update 70; where it was also the demonstrated action, the loss held it. (In the first
# table compare the columns *where it was on* alone: the states that are off differ in kind.)

# %% [markdown] tags=["instructor"] minutes=4
# `settings_for("margin")` and `settings_for("margin", paper_q_filter=False)` train the two filters.
# Let the class guess the success of both, then let two groups find out. (The usual one, of Nair
# et al., compares with the mean Q of the policy's own actions.) No agent of the study uses it.

# %% [markdown]
# ## Round 6: what do demonstrations bring?
#
# The study's ten agents of each kind were tested after {{ of('soft').sizes[1] | , }} episodes, ten
# others (other seeds, another implementation) after {{ others('soft').sizes[1] | , }}. All agents
# in the question have the soft constraint. β is 0 from episode {{ SETTINGS.beta_episodes | , }} on.
#
# > **Predict.** Is the way out found sooner with demonstrations than without? Do more agents escape
# > in the end?

# %%
choices = ["sooner, and more escape", "sooner, but no more escape"]
choices += ["no sooner, but more escape", "neither"]
predict("learning_from_demonstrations.6", "What do demonstrations bring?", choices)

# %%
predicted("learning_from_demonstrations.6")
study = bc.shipped_results()
changed, others = (shipped.shipped_experiment(name) for name in ("ablations", "stress"))
kinds = measures.kinds(study, changed, others)
below = "The study's ten agents · the ten others. Found: more than half of 50 episodes succeed."
table(measures.HEADINGS, measures.found_and_escaped(kinds), below)

# %% [markdown]
# **See.** *With demonstrations an agent needs about {{ round(np.median(found('none')) -
# np.median(found('c = 2')), -1) | .0f }} episodes fewer of its own* (the rule's 200 drives come
# first); the bonus saves some {{ round(np.median(found('c = 0')) - np.median(found('c = 2')), -1) |
# .0f }} of them. In the end no more agents escape: with c = 2, with c = 0 and without
# demonstrations it is {{ in_all('none') }} each. Without the soft constraint few do, with this one
# update for four decisions.
#
# Is it the demonstrations alone that save time? Lesson [[soft_constraint]] has a control: without
# the KL in the target, agents with *no* demonstrations need {{ actor_only().min() }} to {{
# actor_only().max() }} episodes, hardly more.
# <!-- claim: in_all('c = 2') == in_all('c = 0') == in_all('none') == '16 of 20' -->
# <!-- claim: max(found('c = 2').max(), found('margin').max()) < found('none').min() and
#   (found('c = 0') < found('none').min()).sum() >= 19 -->
# <!-- claim: np.median(found('none')) - np.median(found('c = 0')) > 3 *
#   (np.median(found('c = 0')) - np.median(found('c = 2'))) > 0 -->
# <!-- claim: sum(map(escape_freely, ('c = 2', 'c = 0', 'margin', 'none'))) < 10 -->
#
# What does the bonus change, then?

# %% tags=["hide-input"]
returns = {}
for words in ("demonstrations, c = 2", "demonstrations, c = 0", "no demonstrations"):
    at, each = rolling_means(kinds[words][0][0].curves["return"][:, :1000], 50)
    returns[words] = each.mean(axis=0)
title = "With c = 2 the return stays near the rule's for longest, and falls as β runs out"
looks = [charts.Style("#D55E00"), charts.Style("#332288", "--"), charts.Style("#56B4E9", ":")]
rule = bc.evaluate(bc.rule_policy(bc.DEFAULT), 200, seed=8).returns.value
words = "training episode", "mean return of ten agents"
bc.show(charts.lines(at, returns, title, *words, marks={"rule": rule}, looks=looks))

# %% [markdown]
# **See.** *The bonus holds an agent to the rule's slow driving.* In episodes 550 to 600 each of the
# ten with c = 0 earns more than each of the ten with c = 2. It holds the way out while
# it is paid: in episodes 400 to 600 those with c = 2 succeed in {{ 100 * training('c = 2',
# 'success', 400, 600).mean() | .0f }} % of the drives, those with c = 0 in {{ 100 * training('c =
# 0', 'success', 400, 600).mean() | .0f }} %. Then β runs out: in episodes 1,000 to 1,100 it is {{
# 100 * training('c = 2', 'success', 1000, 1100).mean() | .0f }} and {{ 100 * training('c = 0',
# 'success', 1000, 1100).mean() | .0f }} %. Lesson [[found_and_kept]] asks why.
# <!-- claim: len(of('bootstrapped')) == 10 and escaped('bootstrapped') == 7 -->
# <!-- claim: training('c = 0', 'return', 550, 600).min() > training('c = 2', 'return', 550,
#   600).max() -->
# <!-- claim: abs(training('c = 2', 'return', 300, 550).mean() -
#   of('rule').scores('returns').mean()) < 5 -->

# %% [markdown]
# ## Round 7: the whole method, in your code
#
# > **SAC with a rule's help.** Take the algorithm of lesson [[update_and_loop]] and change six
# > lines:
# >
# > 1. *Before the first decision:* the rule drives {{ SETTINGS.demonstration_episodes }} episodes.
# >    Their rows are the demonstrations (Section IV-B; there the stochastic rule drives).
# > 2. *Batch:* a share β of the rows are demonstrations. β falls from {{ SETTINGS.beta_start }} to
# >    0 over {{ SETTINGS.beta_episodes | , }} episodes (Section IV-B).
# > 3. *Bonus:* in demonstrated rows r becomes r + c, with c = {{ SETTINGS.bonus | g }} (Equation
# >    20).
# > 4. *Target:* subtract ξ D_KL(π ‖ π̃), in **s'**, from V(s') (Equations 15 and 16).
# > 5. *Actor:* add the mean of ξ D_KL(π ‖ π̃), in **s**, to the loss (Equation 15).
# > 6. *Fading:* at each update ξ is {{ SETTINGS.xi_multiplier | g }} α (Section IV-A).
# >
# > *In place of 3:* the margin loss of the demonstrated rows, where the printed filter is on, is
# > added to the critics' loss (Equations 17 to 19).
#
# Lines 2 and 3 are your `mixed_batch`, line 4 is `constrained_target`, line 5 `constrained_loss`.
# The next cell runs the files in the folder `answers`, which hold your parts.

# %%
own_code.load()

# %%
own_code.compare()

# %% [markdown]
# If a part differs, mend it in its lesson, and run these two cells again. Then train four agents
# with the KL: two with the bonus, one with the margin, one without demonstrations.
#
# > **Predict.** 2,700 updates are about 260 episodes. Which of the four escape by then?

# %%
predict(
    "learning_from_demonstrations.7",
    "Which of the four escape, after 2,700 updates?",
    ["none", "only agents with demonstrations", "only the one without", "agents of both kinds"],
)

# %%
predicted("learning_from_demonstrations.7")
four = bc.with_seeds(bc.settings_for("bootstrapped"), 2)
four += [bc.settings_for("margin_soft"), bc.settings_for("soft")]
whole = own_code.training(four, episodes=20_000)
result = whole.run(updates=2700)
rows, ahead = [], []
named = [(f"{a.settings.method}, seed {a.settings.seed}", a.as_policy()) for a in result.agents]
for words, driver in [*named, ("rule", bc.rule_policy(bc.DEFAULT))]:
    r = bc.evaluate(driver, 200, seed=8)
    accidents = r.collision.value + r.road_departure.value + r.stoppage.value
    numbers = (100 * r.success.value, r.returns.value, 100 * accidents)
    rows.append([bc.display_name(words), *(f"{number:.1f}" for number in numbers)])
    ahead.append(r.success.value >= bc.statistics.ESCAPES)
table(["", "success, %", "return", "accidents, %"], rows)

# %%
yours = bc.record(result.agents[0].as_policy(), [10], label="bootstrapped, here")[0]
ours = bc.record(
    bc.shipped_agents("bootstrapped")[0].as_policy(), [10], label="bootstrapped, study"
)
drives = [shipped.beginning(drive, 60) for drive in (yours, *ours)]
bc.recording(drives, height=480, details=True)

# %% [markdown]
# **See.** In our run the three agents with demonstrations earned about as much as the rule or less.
# So early that is not the bonus's doing: the study's ten with c = 0 earn {{ training('c = 0',
# 'return', 250, 300).mean() | .0f }} in episodes 250 to 300, those with c = 2 {{ training('c = 2',
# 'return', 250, 300).mean() | .0f }}. The lower replay shows an agent of the study, after {{
# of('bootstrapped').sizes[1] | , }} episodes. Those of its ten that escape earn {{
# of('bootstrapped').scores('returns')[of('bootstrapped').scores('success') >= ESCAPES].min() | .0f
# }} or more.

# %% [markdown] tags=["instructor"] minutes=4
# Put the box on the wall. While the agents train, let somebody name for each of its six lines what
# happens if it is left out; some of these are experiments of the study (lesson [[found_and_kept]]).

# %%
which = {(0, 0): "none", (1, 0): "only agents with demonstrations"}
which |= {(0, 1): "only the one without", (1, 1): "agents of both kinds"}
escape = f"{which[any(ahead[:3]), ahead[3]]}: {sum(ahead[:4])} of the four"
filter_on = "under 8 %" if on < 8 else ("8 to 20 %" if on < 20 else "over 20 %")
compare_predictions(
    "learning_from_demonstrations",
    {1: "through the critics' Q", 2: "0.05", 3: "10"}
    | {4: f"by about one bonus, 2: {raised[0]:.1f} and {raised[1]:.1f}"}
    | {5: f"{filter_on}: {on:.0f} % on average", 6: "sooner, but no more escape", 7: escape},
)

# %% [markdown]
# ## What you now know
#
# 1. β is the demonstrations' share of each batch; it falls in a straight line to 0.
# 2. A bonus of 0.06 makes the rule's drive worth more than staying behind at γ = 0.8, on the 20
#    roads of Round 2.
# 3. c = {{ SETTINGS.bonus }} raises a demonstrated drive's discounted return by c / (1 − γ) = {{
#    SETTINGS.bonus / (1 - SETTINGS.gamma) | .0f }}; in our six pairs the lead over the best other
#    action grew by less than 1.
# 4. With the KL an agent with demonstrations finds the way out after fewer drives of its own; the
#    bonus saves few of them. In the end no more agents escape: {{ in_all('none') }} each way. While
#    β is large, the bonus holds an agent to the rule's slow driving.
# 5. The printed Q-filter lets the margin loss act only where the demonstrated action comes first
#    already; there the loss keeps it first. That is not enough: without the soft constraint, with
#    one update for four decisions, none of ten agents escapes with it.
# <!-- claim: escaped('margin') == 0 and len(of('margin')) == 10 -->
# <!-- claim: bootstrap.paper_q_filter(torch.tensor([[1, 2, 3]] * 3), torch.arange(3)).tolist()
#   == [0, 0, 1] -->

# %% [markdown]
# **Three questions to think about**
# - Which c would you choose for γ = 0.95, and by which argument?
# - Where would you pay the bonus, so that it does not slow the agent?
# - What would you plot to see when a critic has unlearned the bonus?
#
# **Read on**: [the next lesson](how_many_seeds.ipynb) asks what counts of ten agents are worth.
# Hester et al., *Deep Q-learning from Demonstrations* (arXiv 1704.03732), for margins;
# Nair et al. (arXiv 1709.10089), for the Q-filter; Reddy et al., *SQIL* (arXiv 1905.11108), for the
# bonus; Ball et al. (arXiv 2302.02948), for half a batch of offline data without any of them.

# %% [markdown] tags=["instructor"] minutes=2
# *Answers to the three questions.* **c for γ = 0.95:** the rule's drive has to be worth more than
# staying behind, at each second; the first output of Round 2 has the smallest such c for γ = 0.95.
# A little more than that is enough. And c / (1 − γ) should stay below what an accident costs, or a
# demonstrated drive that crashes may be worth more than one without bonus and accident: with γ =
# 0.95, c below 0.5. **Where to pay:** on the free road the rule keeps its moderate speed and is
# paid c for it, so the critic values the rule's speed above a higher one by up to c / (1 − γ), more
# than a higher speed can earn there. A bonus for the way out alone (until trap 1 is passed) would
# not have this effect. **When it is unlearned:** the mean Q of the demonstrated actions on the way
# out, as in Round 3, against the updates, with a line where β reaches 0; beside it the discounted
# return that these drives really earn. Where the two meet, it is unlearned.
# <!-- claim: 0.5 / (1 - 0.95) <= -DEFAULT.reward.accident + 1e-9 -->

# %% [markdown] tags=["instructor"]
# **On the board.** One batch of 64 as a row of boxes, the demonstrated ones shaded, and how many are
# shaded after 0, 500 and 1,000 episodes.
#
# **To discuss.** The bonus pays for *who* acted, not for what happened. Where else do rewards do
# that?
