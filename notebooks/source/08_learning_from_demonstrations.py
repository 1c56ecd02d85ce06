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
# # 8 · Learning from demonstrations
#
# **What you will be able to do**
# - mix a teacher's drives into a learner's memory, and let them fade;
# - work out from which bonus c on a demonstrated action is worth more than staying behind, and what
#   c = {{ SETTINGS.bonus }} does to a critic;
# - write the large-margin loss and two Q-filters, and say when each of them is silent.
#
# **Time** 50 minutes, about one of them the machine's. **You need** the critic's target of lesson
# 4, and the demonstrations of lesson 6.

# %%
import bootcourse as bc
import numpy as np
import torch
from bootcourse.lessons import charts, check, figures, source
from bootcourse.panels.bonus_numbers import bonus_numbers

# %% [markdown]
# ## Look first
#
# A **demonstration** is a drive of somebody else, here the rule's, that a learner may learn from.
# The thick line is what a critic is told that the rule's drive is worth, second by second, if each
# of its seconds is paid a **bonus** c on top of the reward. The dashed line is the same without a
# bonus. The line in another colour is a drive that stays behind trap 1 for ever. Move c.

# %%
bc.panels.bonus_panel()

# %% [markdown]
# > **Predict.** Set c to 0. At the start of the drive, does the critic prefer the rule's way out,
# > or staying behind? How large must c be for the rule's way to lead: 0.05, 0.5 or 5?

# %% [markdown]
# ## Round 1: two memories, one batch
#
# A learner keeps what it drove in a **replay memory**: a long table, one row for each decision,
# with the state, the action, the reward and the next state. For each update it draws a **batch** of
# {{ SETTINGS.batch }} rows. Now there is a second table, with the rule's drives in it.

# %%
demonstrations = bc.collect(200)
print(f"{len(demonstrations):,} transitions of 200 drives of the rule")

# %% [markdown]
# A share β ("beta") of each batch comes from the second table. It starts at
# {{ SETTINGS.beta_start }} and falls in a straight line to 0 over {{ SETTINGS.beta_episodes | , }}
# episodes, so that in the end the learner is alone.
# <!-- claim: demonstration_share(1000, 0.6, 1000) == 0 -->
#
# > **Predict.** How many of the 64 rows are the rule's after 500 episodes? After 2,000?
#
# **Exercise 8.1 (3 min, ●○○).** Write β.


# %%
def demonstration_share(episode, beta_start, beta_episodes):
    """β after `episode` episodes, a number or an array. Returns the same kind, in [0, 1]."""
    # solution
    return beta_start * np.clip(1 - episode / beta_episodes, 0, 1)
    # end solution


check.demonstration_share(demonstration_share)

# %%
for episode in (0, 250, 500, 999, 2000):
    beta = bc.bootstrap.demonstration_share(episode, 0.6, 1000)
    print(f"episode {episode:4}: β = {beta:.3f}, {round(64 * beta):2} of 64 rows are the rule's")
bc.show(figures.fading(bc.settings_for("bootstrapped")))

# %% [markdown]
# **Explain.** Nobody tells the learner to *do* what the rule did. The rows only teach the critic
# what such seconds led to. If the critic finds that the rule's way leads nowhere good, it will say
# so, and the actor will not take it. Would it?

# %% [markdown]
# ## Round 2: the bonus
#
# The paper does not leave that to chance. Each demonstrated action is paid a bonus:
#
# $$ r'(s, a_E) = r(s, a_E) + c, \qquad c = {{ SETTINGS.bonus }} $$
#
# ($a_E$, the *expert's* action, is the demonstrator's. Ours is no expert, but the word has stuck.)
#
# **Exercise 8.2 (3 min, ●○○).** Write the reward that the critic is told, for a mixed batch.


# %%
def augmented_reward(reward, is_demonstration, bonus):
    """r'. reward, is_demonstration (1 where the rule drove, else 0): (batch,); bonus: float, c."""
    # solution
    return reward + bonus * is_demonstration
    # end solution


check.augmented_reward(augmented_reward)

# %% [markdown]
# > **Predict.** Without a bonus, with the paper's γ = 0.8: on how many of 20 roads is the rule's
# > way out worth more, at the first second, than doing nothing? On all, on half, on none?

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
# **See.** Somebody who discounts by {{ SETTINGS.gamma }} a second looks about five seconds ahead,
# and in those the rule only falls back and loses. To such a learner the demonstrations are *bad*
# examples. A bonus of a few hundredths would change that.
# <!-- claim: round(1 / (1 - SETTINGS.gamma)) == 5 -->
#
# > **Predict.** The paper takes c = 2. If every second from now on is demonstrated, by how much
# > does that raise the critic's target? Compare with the −10 of an accident.

# %%
drive, idle = by_rule[10], stays[10]
for c in (0.0, 0.05, 0.5, 2.0):
    each = bonus_numbers(drive, idle, bc.settings_for("bootstrapped", bonus=c))
    values = f"the rule's way {each.augmented[0]:5.2f}, staying {each.trapped[0]:.2f}"
    print(f"c = {c:4}: {values}; the bonus adds {c * each.weight[0]:5.2f} = c / (1 - γ)")

# %%
each = bonus_numbers(drive, idle, bc.settings_for("bootstrapped", bonus=0.05))
named = {
    "rule, c = 0.05": each.augmented[:60],
    "rule, no bonus": each.plain[:60],
    "idle: stays behind": each.trapped[:60],
}
title = "A small bonus is enough to make the way out look good"
bc.show(charts.lines(np.arange(60), named, title, "second of the drive", "critic's target"))

# %% [markdown]
# **Explain.** With c = {{ SETTINGS.bonus }} the critic is told that the rule's way is worth about
# ten more than it is: as much as an accident costs. What the rule's own rewards say, tenths, drowns
# in that. So the bonus is not a hint about rewards. It is an order, given to the critic, and it
# holds for as long as β is above 0. When the demonstrations have faded, nobody is paid the bonus
# any more, and the critic has to climb down again: everything that it believed about these states
# was ten too high.
# <!-- claim: round(SETTINGS.bonus / (1 - SETTINGS.gamma)) == 10 -->
# <!-- claim: math.isclose(SETTINGS.bonus / (1 - SETTINGS.gamma), -DEFAULT.reward.accident) -->
# <!-- claim: demonstration_share(1000, 0.6, 1000) == 0 -->

# %% [markdown] tags=["instructor"] minutes=10
# SQIL (Reddy et al.) pays 1 for demonstrations and 0 for everything else, and no reward at all.
# Ask what survives here of its argument: with c = 2 and rewards below 1, nearly all of it. A good
# question is what a bonus for *everybody* would do: it pays for staying alive, since only
# accidents end an episode.
# <!-- claim: SETTINGS.bonus == 2 and max(map(second_pays, np.arange(0, 25, 0.1))) < 1 -->

# %% [markdown]
# ## Round 3: a margin instead of a bonus
#
# There is another way to make a critic prefer the expert's action: demand it. In each demonstrated
# state the expert's Q shall lead every other by a **margin** of
# {{ settings_for('margin').margin }}.
#
# $$ J_E(Q) = \max_a \big[ Q(s,a) + l(a_E, a) \big] - Q(s,a_E), \qquad
# l = 0 \text{ for } a_E, \text{ else } 1 $$
#
# > **Predict.** Three actions with Q = 3, 2.4 and 0. The expert took the first. What is the loss?
# > And if it took the third? Which Q does the gradient move then, and in which direction?

# %%
for expert in (0, 2):
    q = torch.tensor([[3.0, 2.4, 0.0]], requires_grad=True)
    loss = bc.bootstrap.large_margin_loss(q, torch.tensor([expert]))
    slope = torch.autograd.grad(loss.sum(), q)[0][0].tolist()
    print(f"expert took {expert}: loss {loss.item():.1f}, slope in Q {slope}")

# %% [markdown]
# **Explain.** The loss is 0 once the expert leads by the whole margin. Until then it pushes the
# expert's Q up and the *best rival's* down, and leaves the others alone. It says nothing about how
# much a state is worth, only which action leads.
# <!-- claim: bool(bootstrap.large_margin_loss(torch.tensor([[3.0, 2.0, 0.0]]), torch.tensor([0]))
#   == 0) -->
#
# **Exercise 8.3 (8 min, ●●○).** Write the loss of each state.


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
# ## Round 4: when not to listen
#
# The rule is not always right. A **Q-filter** switches the margin loss off in states where the
# critic knows better. The paper prints: on where
#
# $$ Q(s,a_E) \ge \max_a Q(s,a). $$
#
# > **Predict.** The expert's action has the second largest Q of nine. Is the loss on or off? In
# > which states is it on at all, and what is left for it to do there?
#
# **Exercise 8.4 (3 min, ●○○).** Write the filter as it is printed.


# %%
def paper_q_filter(q, expert_action):
    """1 where the loss counts, else 0, (batch,). q: (batch, actions); expert_action: (batch,)."""
    # solution
    q_expert = q.gather(-1, expert_action.unsqueeze(-1)).squeeze(-1)
    return (q_expert >= q.amax(-1)).to(q.dtype)
    # end solution


check.paper_q_filter(paper_q_filter)

# %% [markdown]
# No action can be worth more than the best, so ≥ means =. The printed filter listens to the teacher
# only where the learner agrees with it already. The usual filter (Nair et al.) compares with what
# the *policy* would get, $\sum_a \pi(a|s) Q(s,a)$: listen where the expert's action looks better
# than what I would do myself.
#
# **Exercise 8.5 (5 min, ●●○).** Write the usual one.


# %%
def q_filter(q, expert_action, log_pi):
    """1 where the loss counts, else 0, (batch,). q, log_pi: (batch, actions)."""
    # solution
    q_expert = q.gather(-1, expert_action.unsqueeze(-1)).squeeze(-1)
    return (q_expert > (log_pi.exp() * q).sum(-1)).to(q.dtype)
    # end solution


check.q_filter(q_filter)

# %%
q = [0.2, 1.1, 0.3, 0.6, 0.9, 0.4, 0.5, 1.4, 0.1]
expert = bc.ACTION_NAMES.index("brake straight")
margin = [value + (action != expert) for action, value in enumerate(q)]
qs, who, even = torch.tensor([q]), torch.tensor([expert]), torch.full((1, 9), 1 / 9).log()
print(f"J_E = {bc.bootstrap.large_margin_loss(qs, who).item():.2f}", end="; ")
print(f"printed filter {bc.bootstrap.paper_q_filter(qs, who).item():.0f}", end=", ")
print(f"usual filter for an even policy {bc.bootstrap.q_filter(qs, who, even).item():.0f}")
title = "The expert brakes, with the second largest Q of nine"
bc.show(charts.action_bars({"Q": q, "rule: Q + l": margin}, title, "value"))

# %% [markdown]
# How often are they on at the beginning, when help is needed most? Ask four learners that have
# learned nothing yet, in the first 20 seconds of the rule's drives: the way out.

# %%
way = np.concatenate([drive.observations[:20] for drive in by_rule])
rule_did = torch.from_numpy(np.concatenate([drive.rule_actions[:20] for drive in by_rule]))
newborns = bc.Training(bc.with_seeds(bc.settings_for("demos"), 4), episodes=1)
for seed in range(4):
    agent = newborns.agent(seed)
    q = torch.from_numpy(agent.q_values(way))
    log_pi = torch.from_numpy(agent.probabilities(way)).log()
    printed = bc.bootstrap.paper_q_filter(q, rule_did).mean()
    usual = bc.bootstrap.q_filter(q, rule_did, log_pi).mean()
    print(f"seed {seed}: printed on in {100 * printed:2.0f} %, usual in {100 * usual:2.0f} %")

# %% [markdown]
# **Explain.** A state here and there, where luck has put the expert's action first: that is all
# that the printed filter hears of the teacher. The paper finds that the margin teaches less than
# the bonus. With this filter, that is no surprise.

# %% [markdown] tags=["instructor"] minutes=8
# `settings_for("margin")` and `settings_for("margin", paper_q_filter=False)` train the two. Let the
# class guess the success of both, then let two groups find out. (In the study no agent with the
# printed filter escapes; the usual one is not in it.)
# <!-- claim: escaped('margin') == 0 and settings_for('margin').paper_q_filter -->

# %% [markdown]
# ## Round 5: what c = 2 does to a critic
#
# Four learners with demonstrations, side by side: two with c = {{ SETTINGS.bonus }}, two with c =
# 0. No soft constraint. After every 200 updates we ask their critics about the first 20 seconds of
# the rule's drives: what is the demonstrated action worth to you, and what the best of the other
# eight?
#
# > **Predict.** With c = 2, how far will the demonstrated action lead its best rival: by about 10,
# > by about 2, or not at all? Who finds the way out?

# %%
UPDATES, EVERY = 5000, 200
agents = bc.with_seeds(bc.settings_for("demos"), 2)
agents += bc.with_seeds(bc.settings_for("demos", bonus=0.0), 2)
places = rule_did.numpy()[:, None]
noted = {"update": [], "expert": [], "rival": []}


def note(training):
    """Every 200 updates: the mean Q of what the rule did, and of the best other action."""
    if training.updates % EVERY or training.updates in noted["update"]:
        return
    expert, rival = [], []
    for i in range(len(agents)):
        q = training.agent(i).q_values(way)
        expert.append(np.take_along_axis(q, places, 1).mean())
        np.put_along_axis(q, places, -np.inf, 1)
        rival.append(q.max(1).mean())
    for name, value in (("update", training.updates), ("expert", expert), ("rival", rival)):
        noted[name].append(value)


# %%
training = bc.Training(agents, episodes=20_000)
result = training.run(callback=note, stop=lambda: training.updates > UPDATES)
print(f"{result.seconds:.0f} s; episodes of each: {training.curves.finished.tolist()}")

# %%
expert, rival = np.array(noted["expert"]).T, np.array(noted["rival"]).T
named = {"demos, c = 2: demonstrated": expert[:2], "best rival, c = 2": rival[:2]}
named |= {"demonstrated, c = 0": expert[2:]}
title = "The bonus lifts the demonstrated action, and rivals that nobody demonstrated"
bc.show(charts.lines(noted["update"], named, title, "update", "mean Q(s,a) on the way out"))

# %%
print("               Q demonstrated   Q best rival   success %   return   accidents %   β")
for i, agent in enumerate(result.agents):
    r = bc.evaluate(agent.as_policy(), 200, seed=8)
    accidents = r.collision.value + r.road_departure.value + r.stoppage.value
    words = f"c = {agent.settings.bonus:g}, seed {agent.settings.seed}"
    row = f"{words:13}{expert[i, -1]:16.2f}{rival[i, -1]:15.2f}{100 * r.success.value:12.1f}"
    print(f"{row}{r.returns.value:9.1f}{100 * accidents:14.1f}{training.beta[i]:6.2f}")

# %% [markdown]
# **Explain.** The memory of demonstrations says what the rule's action is worth and is silent about
# the other eight. A network has to guess those, and it guesses that they are worth about as much:
# the state is good, so everything in it is. An actor that follows the best *guess* then does
# something that nobody has tried, finds out at {{ DEFAULT.reward.accident }}, and with every crash
# learns a little more about one of the eight. A seed gets through this, or drowns in it. Look at
# the last column, too: β counts episodes, and an agent that crashes after a few seconds is through
# with them, and with its teacher, in no time. That is why the paper's method has a second
# ingredient: the pull of lesson 7 keeps the actor where the critic knows something. (And why
# offline learners are built to be pessimistic: lesson 10.)

# %% tags=["nbval-ignore-output"]
source("bootcourse.learn.bootstrap", "augmented_reward", "large_margin_loss", "q_filter")

# %% [markdown]
# With that you have seen all of `bootcourse/learn/textbook.py`. Here is its loop, from reset to
# update: β and the demonstrations are in its last five lines.

# %% tags=["nbval-ignore-output"]
source("bootcourse.learn.textbook", "train")

# %% [markdown]
# ## What you now know
#
# 1. β mixes the teacher's rows into every batch and fades in a straight line.
# 2. At γ = 0.8 the rule's way out is worth less than staying, until a small bonus turns it round.
# 3. c = {{ SETTINGS.bonus }} raises the targets of demonstrated drives by c / (1 − γ) =
#    {{ SETTINGS.bonus / (1 - SETTINGS.gamma) }}, and everything near them.
# 4. The large margin moves the expert's action and its best rival, and stops at a lead of
#    {{ settings_for('margin').margin }}.
# 5. The printed Q-filter is on only where the expert's action is greedy already.
#
# **Three questions to think about**
# - Which c would you choose for γ = 0.95, and by which argument?
# - The bonus is paid in the rule's last seconds, too, far out on the free road. What does that tell
#   the critic about driving at the rule's speed there?
# - A critic that was told 10 too much must unlearn it when β reaches 0. What would you look at to
#   see whether it does?
#
# **Read on**: Hester et al., *Deep Q-learning from Demonstrations* (arXiv 1704.03732), for margins;
# Nair et al., *Overcoming Exploration in Reinforcement Learning with Demonstrations* (arXiv
# 1709.10089), for the Q-filter; Reddy et al., *SQIL* (arXiv 1905.11108), for the bonus; Ball et
# al., *Efficient Online Reinforcement Learning with Offline Data* (arXiv 2302.02948), for how far
# half a batch of demonstrations can go without any of it.
