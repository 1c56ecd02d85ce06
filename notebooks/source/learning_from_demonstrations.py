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
# - mix a teacher's drives into a learner's batches, pay them a bonus, and let their share fall to
#   0;
# - find the smallest bonus c with which the demonstrated way out is worth more than staying behind,
#   and see what c = {{ SETTINGS.bonus }} does to a critic;
# - write the large-margin loss and two Q-filters, and say when each of them is off;
# - train the paper's whole method, made of the parts that you wrote, and watch it escape.
#
# **Time** 70 minutes, about one of them the machine's. **You need** the critic's target of lesson
# [[discrete_sac]], the demonstrations of lesson [[demonstrations]], and for the last round the
# parts of lessons [[discrete_sac]] and [[soft_constraint]].

# %%
import bootcourse as bc
import numpy as np
import torch
from bootcourse.course import (
    charts,
    check,
    compare_predictions,
    own_code,
    predict,
    shipped,
    source,
    table,
)
from bootcourse.course.lessons.the_barrier import figures
from bootcourse.panels.bonus_numbers import bonus_numbers

# %% [markdown]
# ## Look first
#
# A **demonstration** is a drive of somebody else, here the rule's, that a learner may learn from. A
# learner could be paid a **bonus** c for each second of it, on top of the reward.
#
# > **Predict.** At the start of the drive and with γ = {{ SETTINGS.gamma }}, which is worth more:
# > the rule's way out, or staying behind trap 1 to the end? How large must c be for the rule's way
# > to be worth more: 0 (it already is), 0.05, 0.5 or 5?

# %%
predict(
    "learning_from_demonstrations.1",
    "The smallest bonus c with which the way out is worth more",
    ["0", "0.05", "0.5", "5"],
)

# %% [markdown]
# The thick line shows, for each second of the rule's drive, the discounted return from there on if
# each second is paid c. The dashed line is the same without a bonus, the thin one with β c in place
# of c (Round 1 explains β). The line in another colour is a drive that stays behind trap 1 to the
# end. Move c, and set it to 0.

# %%
bc.panels.bonus_panel()

# %% [markdown]
# The last round trains with the parts that you wrote in lessons [[discrete_sac]] and
# [[soft_constraint]]. The next cell looks for them: it runs the files in the folder `answers`,
# which hold your own code. No other cell of this lesson does that.
# <!-- claim: len(re.findall('\nown_code.load()', code_of('learning_from_demonstrations'))) == 1
#   -->

# %%
own_code.load()

# %% [markdown]
# ## Round 1: how do demonstrations get into a batch?
#
# A learner keeps what it drove in its replay buffer: a long table, one row for each decision, with
# the state, the action, the reward and the next state. For each update it draws a batch of
# {{ SETTINGS.batch }} rows (lesson [[discrete_sac]]). Now there is a second table, with the rule's
# drives in it.

# %%
demonstrations = bc.collect(200)
print(f"{len(demonstrations):,} transitions of 200 drives of the rule")

# %% [markdown]
# A share β ("beta") of each batch comes from the second table. It starts at
# {{ SETTINGS.beta_start }} and falls in a straight line to 0 over {{ SETTINGS.beta_episodes | , }}
# episodes. From then on the learner's batches hold its own drives alone.
# <!-- claim: demonstration_share(1000, 0.6, 1000) == 0 -->
#
# > **Predict.** How many of the 64 rows are the rule's after 500 episodes? After 2,000?

# %%
predict(
    "learning_from_demonstrations.2",
    "Rows of the rule's after 500 episodes",
    ["10", "19", "32", "38"],
)

# %%
for episode in (0, 250, 500, 999, 2000):
    beta = bc.bootstrap.demonstration_share(episode, 0.6, 1000)
    print(f"episode {episode:4}: β = {beta:.3f}, {round(64 * beta):2} of 64 rows are the rule's")
bc.show(figures.fading(bc.settings_for("bootstrapped")))

# %% [markdown]
# **Explain.** These rows do not push the actor towards the rule's actions. They teach the critic
# what the rule's actions led to. If the critic then gives these actions a low value, the actor
# learns to avoid them. Round 2 computes which value they have.

# %% [markdown]
# ## Round 2: how large must the bonus be?
#
# The paper raises that value. Each demonstrated action is paid a bonus:
#
# $$ r'(s, a_E) = r(s, a_E) + c, \qquad c = {{ SETTINGS.bonus }} $$
#
# ($a_E$ is the demonstrator's action. The paper calls the demonstrator an *expert*, so E.)
#
# **Exercise (20 min, ●●●).** Write the mixed batch. `round(beta * size)` rows are drawn from
# the table of demonstrations, with the same chance for each row; the others come from your own
# replay buffer, `own.sample(n, rng)`. Each demonstration's reward, in the column `REWARD`, is
# raised by the bonus. Return the rows, and a mark for each: 1 if it is a demonstration, else 0. The
# same table is used again for the next batch, and for ten thousand batches after that.

# %%
REWARD = -4  # the column of a row that holds the reward


def mixed_batch(own, demonstrations, size, beta, bonus, rng):
    """(rows (size, n), marks (size,)). demonstrations: (m, n); rng: a NumPy generator."""
    # solution: the exercise's own


check.mixed_batch(mixed_batch)

# %% [markdown]
# How large must c be? On 20 roads:

# %%
roads = range(20)
by_rule = bc.record(bc.rule_policy(bc.DEFAULT), roads, label="rule")
stays = bc.record(bc.idle_policy, roads, label="idle")
for gamma in (0.8, 0.9, 0.95):
    settings = bc.settings_for("bootstrapped", gamma=gamma)
    seen = [bonus_numbers(d, i, settings) for d, i in zip(by_rule, stays, strict=True)]
    better = sum(each.plain[0] > each.trapped[0] for each in seen)
    needed = max(each.crossing.max() for each in seen)
    words = f"γ = {gamma}: the rule's way is worth more on {better:2} of {len(seen)} roads"
    print(f"{words}; a bonus of {needed:.3f} makes it so on all, at every second")

# %% [markdown]
# **See.** A learner with γ = {{ SETTINGS.gamma }} looks about five seconds ahead. In these seconds
# the rule brakes and earns less than a driver that does nothing. So the rule's discounted return is
# *lower* than that of doing nothing, on each of the 20 roads. A bonus of 0.06 would change that.
# <!-- claim: all(discounted(by_rule(road), 0.8) < discounted(idle(road), 0.8)
#   for road in range(20)) -->
# <!-- claim: round(1 / (1 - SETTINGS.gamma)) == 5 -->
#
# > **Predict.** The paper takes c = 2. If each second from now on is demonstrated, by how much
# > does that raise the discounted return? Compare with the −10 of an accident.

# %%
predict(
    "learning_from_demonstrations.3",
    "c = 2 in each second raises the discounted return by",
    ["2", "4", "10", "300"],
)

# %%
drive, idle = by_rule[10], stays[10]
for c in (0.0, 0.05, 0.5, 2.0):
    each = bonus_numbers(drive, idle, bc.settings_for("bootstrapped", bonus=c))
    values = f"the rule's way {each.augmented[0]:5.2f}, staying {each.trapped[0]:.2f}"
    print(f"c = {c:4}: {values}; the bonus adds {c * each.weight[0]:5.2f} = c / (1 - γ)")

# %% tags=["hide-input"]
each = bonus_numbers(drive, idle, bc.settings_for("bootstrapped", bonus=0.05))
named = {
    "rule, c = 0.05": each.augmented[:60],
    "rule, no bonus": each.plain[:60],
    "idle, stays behind": each.trapped[:60],
}
title = "The discounted return from each second on, with and without a bonus"
bc.show(charts.lines(np.arange(60), named, title, "second of the drive", "discounted return"))

# %% [markdown]
# **Explain.** If each second from now on is demonstrated, c = {{ SETTINGS.bonus }} adds {{
# SETTINGS.bonus / (1 - SETTINGS.gamma) | .0f }} to the return: as much as an accident costs. The
# rule's own rewards differ by tenths, so the bonus decides which action looks best. The critic's
# values need not rise by that much: its target takes the next state's value under the learner's
# *own* policy, and in the learner's own rows the same actions are paid no bonus. Round 5 measures
# how high they get. When β is 0, no row of a batch is paid the bonus, and the critic has to unlearn
# what the bonus added.
# <!-- claim: round(SETTINGS.bonus / (1 - SETTINGS.gamma)) == 10 -->
# <!-- claim: math.isclose(SETTINGS.bonus / (1 - SETTINGS.gamma), -DEFAULT.reward.accident) -->
# <!-- claim: demonstration_share(1000, 0.6, 1000) == 0 -->

# %% [markdown] tags=["instructor"] minutes=11
# SQIL (Reddy et al.) pays 1 for demonstrations, 0 for everything else, and does not use the road's
# reward. Ask how much of its argument applies here: with c = 2 and rewards below 1, most of it. A
# good question is what a bonus on *all* rows would do: it pays for each second without an accident.
# <!-- claim: SETTINGS.bonus == 2 and max(map(second_pays, np.arange(0, 25, 0.1))) < 1 -->

# %% [markdown]
# ## Round 3: what does a margin change?
#
# There is another way to make a critic prefer the expert's action: a loss. In each demonstrated
# state, the Q of the expert's action should be larger than the Q of each other action by a
# **margin** of at least {{ settings_for('margin').margin | .0f }}.
#
# $$ J_E(Q) = \max_a \big[ Q(s,a) + l(a_E, a) \big] - Q(s,a_E), \qquad
# l = 0 \text{ for } a_E, \text{ else } 1 $$
#
# > **Predict.** Three actions with Q = 3, 2.4 and 0. The expert took the first. What is the loss?
# > And if it took the third? Which Q does the gradient move then, and in which direction?

# %%
predict(
    "learning_from_demonstrations.4",
    "The loss if the expert took the third",
    ["1", "2.4", "3", "4"],
)

# %%
for expert in (0, 2):
    q = torch.tensor([[3.0, 2.4, 0.0]], requires_grad=True)
    loss = bc.bootstrap.large_margin_loss(q, torch.tensor([expert]))
    slope = torch.autograd.grad(loss.sum(), q)[0][0].tolist()
    print(f"expert took {expert}: loss {loss.item():.1f}, gradient in Q {slope}")

# %% [markdown]
# **Explain.** The loss is 0 once the expert's action leads by the whole margin. Until then it
# pushes the Q of the expert's action up and the Q of its *best rival* down, and has no gradient in
# the others. It fixes how far one action leads the others, not how much a state is worth.
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

# %% [markdown]
# ## Round 4: when is the margin loss off?
#
# The rule's action is not the best one in each state. A **Q-filter** switches the margin loss off
# in states where the critic gives another action a higher value. The paper's condition for *on* is
#
# $$ Q(s,a_E) \ge \max_a Q(s,a). $$
#
# > **Predict.** The expert's action has the second largest Q of nine. Is the loss on or off? In
# > which states is it on at all, and what is left for it to do there?

# %%
predict(
    "learning_from_demonstrations.5",
    "For the second largest Q of nine the loss is",
    ["on", "off", "on in half of the states"],
)

# %% [markdown]
# **Exercise (3 min, ●○○).** Write the filter as it is printed.


# %%
def paper_q_filter(q, expert_action):
    """1 where the loss counts, else 0, (batch,). q: (batch, actions); expert_action: (batch,)."""
    # solution
    q_expert = q.gather(-1, expert_action.unsqueeze(-1)).squeeze(-1)
    return (q_expert >= q.amax(-1)).to(q.dtype)
    # end solution


check.paper_q_filter(paper_q_filter)

# %% [markdown]
# An action's Q is at most the largest Q, so ≥ means = here. The printed filter is on only where the
# expert's action has the largest Q already. All that the loss can do there is raise a lead that is
# smaller than the margin. The usual filter (Nair et al.) compares with the value
# of the *policy*, $\sum_a \pi(a|s) Q(s,a)$: it is on where the expert's action has a higher Q than
# the policy has on average.
# <!-- claim: bootstrap.paper_q_filter(torch.tensor([[1, 2, 3]] * 3), torch.arange(3)).tolist()
#   == [0, 0, 1] -->
#
# **Exercise (5 min, ●●○).** Write the usual one.


# %%
def q_filter(q, expert_action, log_pi):
    """1 where the loss counts, else 0, (batch,). q, log_pi: (batch, actions)."""
    # solution
    q_expert = q.gather(-1, expert_action.unsqueeze(-1)).squeeze(-1)
    return (q_expert > (log_pi.exp() * q).sum(-1)).to(q.dtype)
    # end solution


check.q_filter(q_filter)

# %% [markdown]
# **Exercise (15 min, ●●●).** Put the margin into the critics' loss, as the paper prints it: for
# each of the two critics the margin loss (margin 1) of the rows that are demonstrations, switched
# by the printed filter of the *same* critic. The mean runs over the whole batch, other rows count
# as 0, and the two critics' means are added. The filter is a switch: the gradient must not go
# through it.


# %%
def margin_loss(q_pair, action, is_demonstration):
    """A scalar tensor. q_pair: (2, batch, actions); action, is_demonstration (1 or 0): (batch,)."""
    # solution: the exercise's own


check.margin_loss(margin_loss)

# %%
q = [0.2, 1.1, 0.3, 0.6, 0.9, 0.4, 0.5, 1.4, 0.1]
expert = bc.ACTION_NAMES.index("brake straight")
margin = [value + (action != expert) for action, value in enumerate(q)]
qs, who, even = torch.tensor([q]), torch.tensor([expert]), torch.full((1, 9), 1 / 9).log()
print(f"J_E = {bc.bootstrap.large_margin_loss(qs, who).item():.2f}", end="; ")
print(f"printed filter {bc.bootstrap.paper_q_filter(qs, who).item():.0f}", end=", ")
print(f"usual filter for an even policy {bc.bootstrap.q_filter(qs, who, even).item():.0f}")
title = "The expert brakes, with the second largest Q of nine"
bc.show(charts.action_bars({"Q": q, "Q + l": margin}, title, "value"))

# %% [markdown]
# How often are the filters on? Train three learners with the margin and the soft constraint. Ask
# their critics before the first update, and as they learn, about the first 20 seconds of the rule's
# drives: the way out.

# %%
way = np.concatenate([drive.observations[:20] for drive in by_rule])
rule_did = torch.from_numpy(np.concatenate([drive.rule_actions[:20] for drive in by_rule]))
ASKED, switched_on = (0, 250, 500, 1000, 2000), {}


def ask(training):
    """The share of the way out in which each filter is on, for each of the three learners."""
    if training.updates not in ASKED or training.updates in switched_on:
        return
    shares = []
    for i in range(3):
        agent = training.agent(i)
        q = torch.from_numpy(agent.q_values(way))
        log_pi = torch.from_numpy(agent.probabilities(way)).log()
        filters = (
            bc.bootstrap.paper_q_filter(q, rule_did),
            bc.bootstrap.q_filter(q, rule_did, log_pi),
        )
        shares.append([100 * each.mean().item() for each in filters])
    switched_on[training.updates] = np.array(shares).T


# %%
training = bc.Training(bc.with_seeds(bc.settings_for("margin_soft"), 3), episodes=20_000)
training.run(callback=ask, updates=ASKED[-1] + 1)
rows = [
    [f"{update:,}", *(", ".join(f"{each:.0f}" for each in kind) for kind in both)]
    for update, both in switched_on.items()
]
table(["after updates", "printed filter on, % (three seeds)", "usual filter on, %"], rows)

# %% [markdown]
# **Explain.** (Yours will differ.) Before the first update the printed filter is on in those few
# states in which the random initial weights happen to give the expert's action the largest Q. It
# does not stay like that: read down its column. As the critic learns what the rule's actions lead
# to, the filter is on more often, and the margin loss has more to say. So how often it is on before
# training does not tell how much the margin teaches.
#
# In our study neither method works on its own: none of the ten agents
# with the margin and none of the ten with the bonus escapes, that is, ends ahead of trap 1 on at
# least {{ 100 * ESCAPES | .0f }} % of the {{ roads() | , }} held-out roads, after training.
# Together with the soft constraint, {{ escaped('margin_soft') }} of ten escape with the margin,
# with the same printed filter, and {{ escaped('bootstrapped') }} of ten with the bonus. The soft
# constraint alone reaches {{ escaped('soft') }} of ten. With ten agents each, {{
# escaped('bootstrapped') }} and 10 cannot be told apart.
# <!-- claim: {len(of(m)) for m in ('margin', 'demos', 'margin_soft', 'bootstrapped', 'soft')}
#   == {10} -->
# <!-- claim: escaped('margin') == 0 and escaped('demos') == 0 and escaped('margin_soft') == 10 -->
# <!-- claim: stats.fisher_exact([[escaped('bootstrapped'), 10 - escaped('bootstrapped')], [10,
#   0]]).pvalue > 0.05 -->
# <!-- claim: settings_for('margin_soft').paper_q_filter -->
#
# "On its own" holds for this study, which makes a quarter of an update for each decision (lesson
# [[found_and_kept]]).

# %% [markdown] tags=["instructor"] minutes=8
# `settings_for("margin")` and `settings_for("margin", paper_q_filter=False)` train the two. Let the
# class guess the success of both, then let two groups find out. (In the study, none of the ten
# `margin` agents escapes and all ten `margin_soft` agents do. Both use the printed filter. No agent
# of the study uses the usual one.)
# <!-- claim: escaped('margin') == 0 and settings_for('margin').paper_q_filter -->
# <!-- claim: escaped('margin_soft') == len(of('margin_soft')) == 10 -->
# <!-- claim: settings_for('margin_soft').paper_q_filter -->

# %% [markdown]
# ## Round 5: what does c = 2 do to a critic?
#
# Four learners with demonstrations, side by side: two with c = {{ SETTINGS.bonus }}, two with c =
# 0. They learn without the soft constraint. After each 200 updates we read from their critics, in
# the first 20 seconds of the rule's drives, the mean Q of the demonstrated action and of the best
# of the other eight.
# <!-- claim: settings_for('demos').xi_multiplier == 0 and settings_for('demos').xi_fixed is None
#   -->
#
# > **Predict.** With c = 2, how far will the demonstrated action lead its best rival: by about 10,
# > by about 2, or by less than 1? Which of the four learners escape?

# %%
predict(
    "learning_from_demonstrations.6",
    "With c = 2 the demonstrated action leads its best rival by",
    ["10", "2", "less than 1"],
)

# %%
UPDATES, EVERY = 5000, 200
agents = bc.with_seeds(bc.settings_for("demos"), 2)
agents += bc.with_seeds(bc.settings_for("demos", bonus=0.0), 2)
places = rule_did.numpy()[:, None]
noted = {"update": [], "expert": [], "rival": [], "others": []}


def note(training):
    """Every 200 updates: mean Q of what the rule did, of the best other action, of all others."""
    if training.updates % EVERY or training.updates in noted["update"]:
        return
    values = {"update": training.updates, "expert": [], "rival": [], "others": []}
    for i in range(len(agents)):
        q = training.agent(i).q_values(way)
        values["expert"].append(np.take_along_axis(q, places, 1).mean())
        values["others"].append((q.sum(1).mean() - values["expert"][-1]) / 8)
        np.put_along_axis(q, places, -np.inf, 1)
        values["rival"].append(q.max(1).mean())
    for name, value in values.items():
        noted[name].append(value)


# %%
training = bc.Training(agents, episodes=20_000)
result = training.run(callback=note, updates=UPDATES + 1)
print(f"{result.seconds:.0f} s; episodes of each: {training.curves.finished.tolist()}")

# %%
expert, rival, others = (np.array(noted[name]).T for name in ("expert", "rival", "others"))
named = {"demonstrated, c = 2": expert[:2], "best rival, c = 2": rival[:2]}
named |= {"demonstrated, c = 0": expert[2:]}
looks = [charts.Style("#E69F00"), charts.Style("#1F2933", "--"), charts.Style("#5F6B77", ":")]
title, label = "What two bonuses do to the critics", "mean Q(s,a) on the way out"
bc.show(charts.lines(noted["update"], named, title, "update", label, looks=looks))

# %%
rows = []
for i, agent in enumerate(result.agents):
    r = bc.evaluate(agent.as_policy(), 200, seed=8)
    accidents = r.collision.value + r.road_departure.value + r.stoppage.value
    numbers = [f"{each:.2f}" for each in (expert[i, -1], rival[i, -1], others[i, -1])]
    numbers += [f"{100 * r.success.value:.1f}", f"{r.returns.value:.1f}", f"{100 * accidents:.1f}"]
    words = f"c = {agent.settings.bonus:g}, seed {agent.settings.seed}"
    rows.append([words, *numbers, f"{training.beta[i]:.2f}"])
headings = ["", "Q demonstrated", "best rival", "mean of the other eight"]
table([*headings, "success, %", "return", "accidents, %", "β"], rows)

# %% [markdown]
# **Explain.** (Yours will differ.) Compare the first two columns, and compare the first one with
# {{ SETTINGS.bonus / (1 - SETTINGS.gamma) | .0f }}. In our runs with c = {{ SETTINGS.bonus }} the
# demonstrated action ended less than 1 above its best rival or below it. But the best of eight
# uncertain values is often one that is too high by luck, also with c = 0. So look at the third
# column, the mean of the other eight, and compare c = {{ SETTINGS.bonus }} with its control, c = 0:
# the difference between these two leads is what the bonus adds. It is a fraction of
# {{ SETTINGS.bonus / (1 - SETTINGS.gamma) | .0f }}.
#
# Read success and accidents together. A drive is a success if the car is ahead of trap 1 when the
# episode ends, also if an accident ends it there. So an agent can be ahead on nearly all roads and
# crash on all of them: it has found the way out, and it does not drive well.
#
# Does the raised value last? In the study, five `demos` agents with c = {{ SETTINGS.bonus }} ship
# with their critics. After training, long after β has reached 0, the mean Q of the rule's actions
# on the way out lies between {{ demonstrated_q().min() | .1f }} and
# {{ demonstrated_q().max() | .1f }} for these agents: little or nothing of the bonus is left.
# <!-- claim: len(demonstrated_q()) == 5 and demonstrated_q().max() < 2 -->
#
# The paper's method has a second ingredient, the soft constraint of lesson [[soft_constraint]]: it
# keeps the actor near actions that the demonstrations hold. The offline learner of lesson
# [[offline_learning]] instead lowers the critic's values of the other actions.

# %% tags=["nbval-ignore-output"]
source("bootcourse.learn.bootstrap", "augmented_reward", "large_margin_loss", "q_filter")

# %% [markdown]
# You have now seen the parts of `bootcourse/learn/textbook.py`. Its loop, from reset to update, has
# β and the demonstrations in its last five lines.

# %% tags=["nbval-ignore-output"]
source("bootcourse.learn.textbook", "train")

# %% [markdown]
# ## Round 6: does the whole method escape, in your code?
#
# The paper's method is SAC (lesson [[discrete_sac]]), with the KL in the actor's loss and in the
# critics' target (lesson [[soft_constraint]]), and with mixed batches and a bonus (this lesson);
# the margin is its alternative to the bonus. If you did the exercises of these three lessons, you
# have written each of these parts. First: do they make the same update as ours? One part at a time
# is put into our learner, and the losses and gradients on one batch are compared. The buffer and
# the mixed batch, which draw at random, go through their checks again.

# %%
own_code.compare()

# %% [markdown]
# If something differs, the cell names the part. Mend it in its lesson, and run `own_code.load()`
# here again. Then train three agents, two with the bonus and one with the margin, each with the KL.
#
# > **Predict.** Of plain SAC's ten agents in the study {{ escaped('sac') }} escapes. How many of
# > these three end ahead of trap 1 on most of 200 roads, after 2,500 updates?

# %%
predict(
    "learning_from_demonstrations.7",
    "Agents of the three that end ahead on most of 200 roads",
    ["0", "1", "2", "3"],
)

# %%
agents = bc.with_seeds(bc.settings_for("bootstrapped"), 2) + [bc.settings_for("margin_soft")]
whole = own_code.training(agents, episodes=20_000)
result = whole.run(updates=2500)
rows, escaping = [], []
for agent in result.agents:
    r = bc.evaluate(agent.as_policy(), 200, seed=8)
    accidents = r.collision.value + r.road_departure.value + r.stoppage.value
    words = bc.display_name(f"{agent.settings.method}, seed {agent.settings.seed}")
    numbers = (100 * r.success.value, r.returns.value, 100 * accidents)
    rows.append([words, *(f"{number:.1f}" for number in numbers)])
    escaping.append(r.success.value > 0.5)
table(["", "success, %", "return", "accidents, %"], rows)

# %%
yours = bc.record(result.agents[0].as_policy(), [10], label="bootstrapped, trained here")[0]
ours = bc.record(
    bc.shipped_agents("bootstrapped")[0].as_policy(), [10], label="bootstrapped, shipped"
)
bc.recording([shipped.beginning(drive, 60) for drive in (yours, *ours)], height=480)

# %% [markdown]
# **See.** The line above the table says whose code these agents learned with. In the replay, the
# first of them is on the left. On the right is an agent of our study, which had many times as many
# updates. Both drives are on the same road. (Yours will differ.)
#
# **Try.** Plant a mistake in one part: copy it into a new cell, change a sign, and call
# `own_code.use` with it. Which part does the comparison name? How long would you have needed to
# find it from the curves? Lesson [[bug_hunt]] hunts such mistakes.

# %% [markdown]
# ## What you now know
#
# 1. β is the demonstrations' share of each batch; it falls in a straight line to 0.
# 2. At γ = 0.8 the rule's way out is worth less than staying behind, on the 20 roads of Round 2. A
#    bonus of 0.06 reverses that.
# 3. c = {{ SETTINGS.bonus }} raises a demonstrated drive's discounted return by c / (1 − γ)
#    = {{ SETTINGS.bonus / (1 - SETTINGS.gamma) | .0f }}. In our runs of Round 5 the critics' values
#    rose by less, and the values of actions that were not demonstrated rose, too.
# 4. The large-margin loss moves the Q of the expert's action and of its best rival, and is 0 from a
#    lead of {{ settings_for('margin').margin | .0f }} on.
# 5. The printed Q-filter is on where the expert's action has the largest Q already, and off
#    elsewhere. With the margin and this filter, and without the soft constraint, none of the
#    study's ten agents escapes.
# <!-- claim: escaped('margin') == 0 and len(of('margin')) == 10 -->
# <!-- claim: bootstrap.paper_q_filter(torch.tensor([[1, 2, 3]] * 3), torch.arange(3)).tolist()
#   == [0, 0, 1] -->
#
# %%
lead = expert[:2, -1] - rival[:2, -1]
compare_predictions(
    "learning_from_demonstrations",
    {1: "0.05", 2: "19", 3: "10", 4: "4", 5: "off"}
    | {6: f"{lead[0]:.1f} and {lead[1]:.1f}", 7: str(sum(escaping))},
)

# %% [markdown]
# **Three questions to think about**
# - Which c would you choose for γ = 0.95, and by which argument?
# - The bonus is paid in the rule's last seconds, too, on the free road. What does that teach the
#   critic about driving at the rule's speed there?
# - A critic whose values the bonus has raised must unlearn that when β reaches 0. What would you
#   plot to see when it does?
#
# **Read on**: Hester et al., *Deep Q-learning from Demonstrations* (arXiv 1704.03732), for margins;
# Nair et al., *Overcoming Exploration in Reinforcement Learning with Demonstrations* (arXiv
# 1709.10089), for the Q-filter; Reddy et al., *SQIL* (arXiv 1905.11108), for the bonus; Ball et
# al., *Efficient Online Reinforcement Learning with Offline Data* (arXiv 2302.02948), for what half
# a batch of offline data achieves without bonus, margin or filter.

# %% [markdown] tags=["instructor"]
# *Answers to the three questions.* **c for γ = 0.95:** the rule's way has to be worth more than
# staying behind, at each second; the first output of Round 2 has the smallest such c for γ = 0.95.
# A little more than that is enough. And c / (1 − γ) should stay below what an accident costs, or a
# demonstrated drive that crashes may be worth more than one without bonus and accident: with γ =
# 0.95, c below 0.5. **The last seconds:** on the free road the rule keeps its moderate speed and is
# paid c for it, so the critic values the rule's speed above a higher one by up to c / (1 − γ), more
# than a higher speed can earn there. A bonus for the way out alone (until trap 1 is passed) would
# not have this effect. **When it is unlearned:**
# the mean Q of the demonstrated actions on the way out, as in round 5, against the updates, with a
# line where β reaches 0; beside it the discounted return that these drives really earn. Where the
# two meet, it is unlearned.
# <!-- claim: 0.5 / (1 - 0.95) <= -DEFAULT.reward.accident + 1e-9 -->
