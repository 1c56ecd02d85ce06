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
# - mix the rule's drives into a learner's batches, and pay a bonus for them;
# - train *bootstrapped SAC*, the paper's method, in your own code, and say what demonstrations bring;
# - write the large-margin loss, and see where the paper applies it.
#
# **Time** 48 minutes. **It builds on** lesson [[demonstrations]], and on your parts of lessons
# [[discrete_sac]], [[update_and_loop]] and [[soft_constraint]].

# %%
import inspect

import bootcourse as bc
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
from bootcourse.course.lessons.learning_from_demonstrations import explorable, figures, measures

progress("learning_from_demonstrations")

# %% [markdown]
# ## Look first
#
# A learner now also uses the rule's demonstrations. The paper adds a **bonus** c to the reward of each
# demonstrated second.
#
# The chart adds up the discounted rewards from each second on. When is the rule's drive worth less than
# staying behind the traps? **Drag** c up to 2. What changes?

# %%
bc.panels.bonus_panel(c=0)

# %% [markdown]
# **See.** *On this road the rule's drive is worth less than staying behind in the first
# {{ (bonus_needed() > 0).sum() }} seconds*, in the last five of them by very little. On half of the roads 0 to 39
# it is worth less in {{ np.sort((needed_on() > 0).sum(axis=1))[20] }} or more of the first 40 seconds, on
# {{ ((needed_on() > 0).sum(axis=1) == 40).sum() }} of them in all. A bonus of {{ needed_on().max() | .3f }} a
# second would be enough on all 40 roads. *The
# paper's c = {{ SETTINGS.bonus | g }} is {{ SETTINGS.bonus / needed_on().max() | .0f }} times as much*: it adds
# {{ SETTINGS.bonus / (1 - SETTINGS.gamma) | .0f }} to the drive's worth, as much as an accident costs. (At the
# hump the rule speeds up for a few seconds.)
# <!-- claim: bonus_needed()[10:].max() < 0.004 < bonus_needed()[:10].min() -->
# <!-- claim: 14.5 < speeds_of_the_rule()[34:44].max() and speeds_of_the_rule()[:34].max() < 11
#   and speeds_of_the_rule()[43:50].max() < 13 -->
# <!-- claim: discounted(by_rule(), SETTINGS.gamma) < discounted(idle(), SETTINGS.gamma) -->
# <!-- claim: SETTINGS.bonus > 30 * bonus_needed().max() and (bonus_needed()[:15] > 0).all() and
#   (bonus_needed()[15:] < 0).all() -->
# <!-- claim: math.isclose(SETTINGS.bonus / (1 - SETTINGS.gamma), -DEFAULT.reward.accident) -->

# %% [markdown] tags=["instructor"] minutes=3
# Let them drag γ towards 1 as well: the rule's drive needs no bonus then. Ask why the learner does not take
# such a γ (lesson [[the_trap]]).

# %% [markdown]
# ## Round 1: how do the rule's actions reach the policy?
#
# For each update a learner draws a batch of {{ SETTINGS.batch }} rows. Now a share β of these comes from a
# table of the rule's drives.

# %%
bc.show(figures.batches(bc.settings_for("bootstrapped"), (0, 500, 1000)))

# %% [markdown]
# Leave out the soft constraint for now. The actor's loss, which changes the policy, reads:


# %%
def reads(loss):
    return f"{loss.__name__} reads {', '.join(inspect.signature(loss).parameters)}"


print(reads(bc.sac.actor_loss))

# %% [markdown]
# > **Predict.** A row of the table holds a state, the rule's *action* and a reward. How can the actions
# > change the policy?

# %%
choices = [
    "not at all: a term is missing",
    "directly: the actor's loss raises them",
    "through the critics' Q",
    "through the temperature α",
]
predict("learning_from_demonstrations.1", "How can the rule's actions change the policy?", choices)

# %% tags=["hide-input"]
predicted("learning_from_demonstrations.1")
print(reads(bc.sac.critic_loss))
print(reads(bc.sac.temperature_loss))

# %% [markdown]
# **Explain.** Through the critics' Q: `q_taken` is the Q of the row's action, and `target` contains its
# reward. No other loss reads them. An action that the critics value more becomes more probable.
#
# **Exercise (20 min, ●●●).** Write the mixed batch. Draw `round(beta * size)` rows from the table of
# demonstrations, uniformly with replacement, and the others from your own replay buffer,
# `own.sample(n, rng)`. Raise each demonstration's reward by the bonus, but do not change the table. Return
# the rows, and a mark for each: 1 for a demonstration, else 0.

# %%
REWARD = -4  # the column of a row that holds the reward


def mixed_batch(own, demonstrations, size, beta, bonus, rng):
    """(rows (size, n), marks (size,)), tensors. rng: a NumPy generator.

    demonstrations: a tensor (m, n), a row is (s, s', a, r, terminated, μ(s), μ(s')).
    """
    # solution: the exercise's own


check.mixed_batch(mixed_batch)

# %% [markdown] tags=["instructor"] minutes=5
# SQIL (Reddy et al.) pays 1 for demonstrations, 0 for everything else, and does not use the road's reward.
# Ask how much of its argument applies here: with c = 2 and rewards below 1, most of it. A good question is
# what a bonus on *all* rows would do: it pays for each second without an accident.
# <!-- claim: SETTINGS.bonus == 2 and max(map(second_pays, np.arange(0, 25, 0.1))) < 1 -->

# %% [markdown]
# ## Round 2: what do demonstrations bring?
#
# > **Bootstrapped SAC.** In the algorithm of lesson [[update_and_loop]] change six lines:
# >
# > 1. *First:* the rule drives {{ SETTINGS.demonstration_episodes }} episodes, the
# >    demonstrations.
# > 2. *Batch:* a share β of the rows, falling to 0, are demonstrations.
# > 3. *Bonus:* in demonstrated rows r becomes r + c.
# > 4. *Target:* subtract ξ D<sub>KL</sub>(π ‖ π̃), in **s'**, from V(s').
# > 5. *Actor:* add the mean of ξ D<sub>KL</sub>(π ‖ π̃), in **s**, to the loss.
# > 6. *Fading:* at each update ξ is {{ SETTINGS.xi_multiplier | g }} α.
#
# Lines 2 and 3 are your `mixed_batch`, line 4 is `constrained_target`, line 5 `constrained_loss`:

# %%
own_code.load()
own_code.compare()

# %% [markdown]
# Train two agents with the soft constraint, one with demonstrations and one without, for equally many
# updates (not episodes: an agent that crashes early has more of these).
#
# > **Predict.** Count an agent's own episodes, not the rule's {{ SETTINGS.demonstration_episodes }}. Does it
# > find the way out sooner with demonstrations?

# %%
choices = ["sooner", "about as soon", "later"]
predict("learning_from_demonstrations.2", "With demonstrations, when is it found?", choices)

# %%
predicted("learning_from_demonstrations.2")
both = [bc.settings_for("bootstrapped"), bc.settings_for("soft")]
training, live = own_code.training(both, episodes=20_000), figures.LiveDemonstrations()
yours = training.run(progress=False, callback=live, updates=2700).agents
live.show(training)

# %% [markdown]
# The dots show twenty agents of each kind: the study's ten, and ten *others* (other seeds, another
# implementation, twice the episodes).
# <!-- claim: others('soft').sizes[1] == 2 * of('soft').sizes[1] -->
#
# **See.** *With demonstrations agents find the way out after fewer episodes of their own*: in the median
# {{ median_found('c = 2') }} with c = {{ SETTINGS.bonus | g }}, {{ median_found('none') }} without
# demonstrations. With c = 0 it is {{ median_found('c = 0') }}: most of the gain needs no bonus. With the rule's
# {{ SETTINGS.demonstration_episodes }} episodes counted it is
# {{ median_found('c = 2') + SETTINGS.demonstration_episodes }} against {{ median_found('none') }}:
# demonstrations save episodes of the learner, not episodes in all.
# <!-- claim: len(found('c = 0')) == 20 and found('c = 0').max() < np.median(found('none')) and
#   np.median(found('c = 0')) < (np.median(found('none')) + np.median(found('c = 2'))) / 2 -->
# <!-- claim: len(found('c = 2')) == len(found('none')) == 20 and found('c = 2').max() < found('none').min() -->
# <!-- claim: found('c = 2').min() + SETTINGS.demonstration_episodes > found('none').max() -->
#
# > **Predict.** Of these twenty agents of each kind, do more escape in the end with demonstrations (c =
# > {{ SETTINGS.bonus | g }}) than without?

# %%
choices = ["at least 4 more", "fewer than 4 apart", "at least 4 fewer"]
predict("learning_from_demonstrations.3", "Of twenty, how many more escape?", choices)

# %%
predicted("learning_from_demonstrations.3")
table(measures.ESCAPE, measures.escaped())

# %% [markdown]
# **See.** *In this training no more of them escape in the end*: with the soft constraint {{ in_all('none') }} do
# in each row. Without it fewer do (last column). With two updates for each decision, and demonstrations by the
# stochastic rule (lesson [[found_and_kept]]), the answers differ: there all twenty agents with demonstrations
# escape, ten with the soft constraint and ten without it, and {{ of_the_paper('soft') }} with it alone.
# <!-- claim: [of_the_paper(m) for m in ('bootstrapped', 'demos', 'soft')] == ['10 of 10', '10 of 10', '5 of 10']
#   and fisher(10, 5) < 0.05 -->
# <!-- claim: in_all('c = 2') == in_all('c = 0') == in_all('none') == '16 of 20' -->
# <!-- claim: all(stats.mannwhitneyu(earned('none'), earned(name)).pvalue > 0.1 for name in
#   ('c = 2', 'c = 0')) -->
# <!-- claim: [measures.escape([each]) for name in ('c = 2', 'c = 0', 'none') for each in
#   kinds()[{'none': 'no demonstrations'}.get(name, f'demonstrations, {name}')][0]] == ['7 of 10', '9
#   of 10', '10 of 10', '6 of 10', '8 of 10', '8 of 10'] -->
# <!-- claim: [alone(name) for name in ('c = 2', 'c = 0', 'none')] == ['5 of 20', '0 of 10', '1 of 20'] -->
# <!-- claim: stats.fisher_exact([[16, 4], [5, 15]]).pvalue < 0.01 -->

# %% [markdown] tags=["instructor"] minutes=4
# Put the box on the wall. While the agents train, ask of each of its six lines: what happens without it? Some
# of these are experiments of the study (lesson [[found_and_kept]]).

# %% [markdown]
# ## Round 3: what does the bonus cost?
#
# > **Predict.** Ten agents learn with c = {{ SETTINGS.bonus | g }}, ten with c = 0. Near episode 400 all have
# > found the way out. Which then earn more, the bonus not counted?
# <!-- claim: abs(of('rule').scores('speed').mean() - 12) < 0.5 and max(map(second_pays, np.arange(0,
#   30, 0.1))) <= second_pays(15) -->
# <!-- claim: max(found('c = 2').max(), found('c = 0').max()) < 400 -->

# %%
choices = ["c = 2", "c = 0", "about the same"]
predict("learning_from_demonstrations.4", "Which agents earn more near episode 400?", choices)

# %%
predicted("learning_from_demonstrations.4")
bc.show(figures.returns(*measures.paid_and_not()))
table(measures.COST, measures.cost())

# %% [markdown]
# **See.** *The bonus holds the agents at the rule's speed.* From episode 300 to 500 the ten with c = 2 drive
# about {{ training('c = 2', 'speed', 300, 500).mean() | .0f }} m/s and earn about what the rule earns. (The
# others' returns were not kept.) A second at 15 m/s pays
# {{ second_pays(15) - second_pays(12) | .1f }} more than one at 12; a demonstrated second pays
# {{ SETTINGS.bonus | g }} more. The agent itself never gets c, but its critics learn from these seconds, and the
# actor follows the critics (Round 4 shows their Q).
# <!-- claim: (abs(training('c = 2', 'speed', 300, 500) - of('rule').scores('speed').mean()) < 0.4).all() -->
# <!-- claim: training('c = 2', 'return', 300, 600).max() < training('c = 0', 'return', 300, 600).min() -->
# <!-- claim: abs(training('c = 2', 'return', 300, 500).mean() -
#   of('rule').scores('returns').mean()) < 5 -->
#
# *For a while it also keeps them on the way out*: near episode 475 success with c = 0 dips to
# {{ 100 * training('c = 0', 'success', 450, 500).mean() | .0f }} % (of the others to
# {{ 100 * training('c = 0', 'success', 450, 500, True).mean() | .0f }} %), with c = 2 it does not. From 300 to 350
# and from 600 to 650 it is above 90 % in all four tens. As the demonstrations run out, success with c = 2 falls,
# too.
# <!-- claim: all(training(c, 'success', first, first + 50, which).mean() > 0.9 for c in ('c = 2', 'c = 0') for
#   first in (300, 600) for which in (False, True)) -->
# <!-- claim: min(training('c = 2', 'success', 450, 500, which).mean() for which in (False, True)) > 0.98 and
#   abs(training('c = 0', 'success', 450, 500).mean() - 2 / 3) < 0.03 and
#   abs(training('c = 0', 'success', 450, 500, True).mean() - 0.8) < 0.03 -->
# <!-- claim: abs(training('c = 2', 'success', 1000, 1050).mean() - 0.5) < 0.1 -->
# <!-- claim: SETTINGS.beta_episodes == 1000 -->
# <!-- claim: all(training('c = 2', 'success', 300, 600, which).mean() > training('c = 0', 'success', 300,
#   600, which).mean() + 0.05 and stats.mannwhitneyu(training('c = 2', 'success', 300, 600, which),
#   training('c = 0', 'success', 300, 600, which)).pvalue < 0.01 for which in (False, True)) -->
# <!-- claim: all(training('c = 0', 'success', 450, 500, which).mean() < training('c = 0', 'success', 300, 400,
#   which).mean() - 0.15 and training('c = 2', 'success', 450, 500, which).mean() > 0.98 > 0.9 > training('c = 2',
#   'success', 1000, 1050, which).mean() for which in (False, True)) -->
#
# **Slide.** Train two agents in the panel. When their success is near 100 %, set c to 0, and watch the
# return.

# %%
bc.panels.train_panel("bootstrapped", seeds=2, episodes=600)

# %% [markdown] tags=["instructor"] minutes=4
# By episode 900 none of twenty agents with c = 2 has lost the way out, but {{ losing_until('c = 0', 900) }}
# with c = 0 have. By 1,500 it is {{ losing_until('c = 2', 1500) }} with c = 2 and
# {{ losing_until('c = 0', 1500) }} with c = 0. The bonus buys some
# {{ round(np.median(found('c = 0')) - np.median(found('c = 2')), -1) | .0f }} episodes at the start and a
# safer middle, and costs return for hundreds of episodes. Ask for a schedule of c that has all three, and let
# a group try it in the panel.
# <!-- claim: losing_until('c = 2', 900) == 0 and stats.fisher_exact([[0, 20], [losing_until('c = 0', 900),
#   20 - losing_until('c = 0', 900)]]).pvalue < 0.01 -->
# <!-- claim: len(found('c = 2')) == len(found('c = 0')) == 20 and losing_until('c = 2', 1100) >= 8 -->

# %% [markdown]
# ## Round 4: where can a margin teach?
#
# A demonstration shows *one* action. Where no row shows another one, its Q is a guess, whose error is called
# an **extrapolation error**. We look at the first 20 seconds of a drive of the rule. First your agent without
# demonstrations:

# %% tags=["nbval-ignore-output"]
by_rule = bc.record(bc.rule_policy(bc.DEFAULT), [10], label="rule")[0]
helped, alone = yours
print(measures.says_ahead(alone, by_rule, seconds=20))

# %% [markdown]
# > **Predict.** Your other agent's critics were paid c = {{ SETTINGS.bonus | g }} for the rule's actions in such
# > states. In how many of these 20 seconds does *another* action still have the largest Q?

# %%
predict("learning_from_demonstrations.5", "In how many of 20 seconds is another ahead?", unit="s")

# %% [markdown]
# **Drag** through the rule's drive. Where is another action ahead? Some may be better than the rule's: your
# agent has rows of its own, too.

# %% tags=["nbval-ignore-output"]
predicted("learning_from_demonstrations.5")
ahead = measures.behind(helped, by_rule, seconds=20)
explorable.nine_values(helped, by_rule, seconds=20)

# %% tags=["nbval-ignore-output"]
table(measures.RAISED, measures.raised({"with": helped, "without": alone}, by_rule, seconds=20))

# %% [markdown]
# **See.** *With the bonus all nine Q are higher, and the rule's lead grows by much less.* The actor follows the
# lead. In three such pairs of ours the mean of the nine was 2.4 to 2.9 higher, the lead 0.4 to 0.5 (first 20 s on
# ten roads). With demonstrations and c = 0 this mean was about as low as without demonstrations.
#
# *In place of the bonus* the paper tries a loss. It asks that the demonstrated action $a_E$ lead every other
# action by a **margin** of {{ settings_for('margin').margin | .0f }} (the brackets). The loss is the distance
# between the dashed lines. **Drag** the margin.
#
# $$ J_E(Q) = \max_a \big[ Q(s,a) + l(a_E, a) \big] - Q(s,a_E), \qquad
# l = 0 \text{ for } a_E, \text{ else } 1 $$
#
# This loss pushes the demonstrated bar up and the *highest other* bar down, until the demonstrated one leads
# by the margin.
# <!-- claim: bool(bootstrap.large_margin_loss(torch.tensor([[3.0, 2.0, 0.0]]), torch.tensor([0]))
#   == 0) -->
#
# **Exercise (8 min, ●●○).** Write this loss for each state.


# %%
def large_margin_loss(q, expert_action):
    """J_E, margin 1. q: (batch, actions); expert_action: (batch,) int64. Returns (batch,), ≥ 0."""
    # solution
    is_expert = torch.arange(q.shape[-1]) == expert_action.unsqueeze(-1)
    q_expert = q.gather(-1, expert_action.unsqueeze(-1)).squeeze(-1)
    return (q + (~is_expert)).amax(-1) - q_expert
    # end solution


check.large_margin_loss(large_margin_loss)

# %% [markdown] tags=["instructor"] minutes=2
# Three bars for Q on the board, the margin on top of two of them. Let the class say for each of the three
# actions as the expert's which bar is pushed, and in which direction.

# %% [markdown]
# The paper's **Q-filter** counts this loss only where $Q(s,a_E) \ge \max_a Q(s,a)$, the usual one where
# $Q(s,a_E) > \sum_a \pi(a|s)\, Q(s,a)$. In how many of the 20 seconds does the loss still push?

# %% tags=["nbval-ignore-output"]
loss = own_code.yours_or_ours("large_margin_loss", doing="Judging")
table(measures.PUSHED, measures.pushed(loss, helped, by_rule, seconds=20))

# %% [markdown]
# **See.** *With the paper's filter the loss pushes only where the demonstrated action already leads.* It is
# silent where this action is behind, although the loss is largest there, over 1. The usual filter can count it
# there, too. No agent of the study uses that one.
# <!-- claim: bootstrap.q_filter(torch.tensor([[0.0, 2, 3]]), torch.tensor([1]), torch.ones(1, 3).div(3).log())
#   .tolist() == [1] and bootstrap.paper_q_filter(torch.tensor([[0.0, 2, 3]]), torch.tensor([1])).tolist() == [0] -->
#
# *The paper finds the bonus better than this loss* in its training curves. *The study does not*, in tests after
# training. With the soft constraint the ten agents with the loss all return
# {{ of('margin_soft').scores('returns').min() | .0f }} to {{ of('margin_soft').scores('returns').max() | .0f }}.
# Of those with the bonus seven do about as well, and three lose the way out. But with neither all ten return
# {{ with_neither().min() | .0f }} to {{ with_neither().max() | .0f }}: nothing shows here that the loss helps. So
# many escape:
# <!-- claim: (lambda paid: paid[3] > 120 > 60 > paid[2])(np.sort(of('bootstrapped').scores('returns'))) and
#   with_neither().min() > 120 and of('margin_soft').scores('returns').min() > 120 -->
#
# | demonstrations with | soft constraint: study | others | without it: study | others |
# |---|---|---|---|---|
# | the loss | {{ in_all('margin') }} | | {{ alone('margin') }} | |
# | the bonus | {{ of_the_study('c = 2') }} | {{ of_the_others('c = 2') }} | 0 of 10 | 5 of 10 |
# | neither | {{ of_the_study('c = 0') }} | {{ of_the_others('c = 0') }} | {{ alone('c = 0') }} | |
#
# With the soft constraint chance could explain each of these differences from the loss.
# <!-- claim: all(fisher(10, escape) > 0.05 for escape in (10, 9, 7, 6)) -->
# <!-- claim: stats.fisher_exact([[10, 0], [16, 4]]).pvalue > 0.1 and fisher(10, 7) > 0.05 -->
# <!-- claim: [measures.escape([each]) for each in kinds()['demonstrations, c = 2'][1]] == ['0 of 10', '5 of 10'] -->
# <!-- claim: settings_for('margin_soft').bonus == settings_for('margin').bonus == 0 and
#   settings_for('margin_soft').paper_q_filter and settings_for('margin').paper_q_filter and
#   settings_for('margin_soft').xi_multiplier == settings_for('soft').xi_multiplier > 0 -->
# <!-- claim: in_all('margin') == '10 of 10' == of_the_study('c = 0') and
#   alone('margin') == '0 of 10' == alone('c = 0') -->
# <!-- claim: bootstrap.paper_q_filter(torch.tensor([[1, 2, 3]] * 3), torch.arange(3)).tolist()
#   == [0, 0, 1] -->

# %%
compare_predictions(
    "learning_from_demonstrations",
    {
        1: "through the critics' Q",
        2: "sooner",
        3: "fewer than 4 apart",
        4: "c = 0",
        5: ahead,
    },
)

# %% [markdown]
# ## What you now know
#
# 1. A share β of each batch is the rule's, and falls to 0. Without the soft constraint its actions reach the
#    policy only through the critics' Q.
# 2. With demonstrations these agents found the way out after fewer episodes of their own. Whether more escape
#    depends on the training (lesson [[found_and_kept]]).
# 3. The bonus held agents at the rule's speed: from episode 300 to 500 those with c = 2 earned about what the
#    rule earns.
# 4. The paper's filter drops the margin loss where another action has the largest Q, so the loss corrects
#    nothing there. With the soft constraint the study's agents escaped no less often with it than with the bonus.

# %% [markdown]
# **Three questions to think about**
# - Which c would you choose for γ = 0.95, and why?
# - Where would you pay the bonus, so that it holds no agent back?
# - In which states would you count the margin loss?
#
# **Read on**: [the next lesson](how_many_seeds.ipynb). Hester et al. (arXiv 1704.03732): margins. Nair et al.
# (arXiv 1709.10089): the usual Q-filter. Reddy et al. (arXiv 1905.11108): a bonus in place of the reward.
# Ball et al. (arXiv 2302.02948): prior data in half of each batch, no bonus.

# %% [markdown] tags=["instructor"] minutes=2
# *Answers to the three questions.* **c for γ = 0.95:** the rule's drive has to be worth more than staying
# behind, at each second; the first panel shows the smallest such c when you drag γ. A little more than that
# is enough. And c / (1 − γ) should stay below what an accident costs, or a demonstrated drive that crashes
# may be worth more than one without bonus and accident: with γ = 0.95, c below 0.5. **Where to pay:** on the
# free road the rule keeps its moderate speed and is paid c for each second of it, more than a higher speed
# can earn there. A bonus for the way out
# alone (until trap 1 is passed) would not have this effect. **The filter:** the usual one (Nair et al.;
# `paper_q_filter=False`) asks that $Q(s,a_E)$ exceed the mean Q of the policy's actions. So it is on also
# where another action has the largest Q and the demonstrated one is above the mean. No agent of the study
# uses it. (In the paper's own, ≥ means =: no action's Q exceeds the largest.)
# <!-- claim: 0.5 / (1 - 0.95) <= -DEFAULT.reward.accident + 1e-9 -->
# <!-- claim: settings_for('margin').paper_q_filter and settings_for('margin_soft').paper_q_filter
#   -->

# %% [markdown] tags=["instructor"]
# **On the board.** One batch of 64 as a row of boxes, the demonstrated ones shaded, and how many are shaded
# after 0, 500 and 1,000 episodes.
#
# **To discuss.** The bonus pays for *who* acted, not for what happened. Where else do rewards do that?
