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
# What does a bonus buy?
#
# **What you will be able to do**
# - mix the rule's drives into a learner's batches, and pay a bonus for them;
# - train *bootstrapped SAC*, the paper's method, in your own code, and say what demonstrations bring;
# - say what the bonus buys and costs, and write the large-margin loss.
#
# **Time** 35 minutes. **It builds on** lesson [[demonstrations]], and on your parts of lessons
# [[discrete_sac]], [[update_and_loop]] and [[soft_constraint]].

# %%
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
# A learner now also uses the rule's demonstrations, and the paper adds a **bonus** c to the reward in them.
#
# The chart adds up the discounted rewards from each second on. When is the rule's drive worth less than
# staying behind the traps? **Drag** c up to 2. What changes?

# %%
bc.panels.bonus_panel(c=0)

# %% [markdown]
# **See.** *In the first {{ (bonus_needed() > 0).sum() }} seconds the rule's drive is worth less than staying.* A
# bonus of about {{ needed_on().max() | .2f }} a second changes that on each of the roads 0 to 39. What does the
# paper's buy?
# <!-- claim: (bonus_needed()[:15] > 0).all() and (bonus_needed()[15:] < 0).all() -->

# %% [markdown] tags=["instructor"] minutes=3
# Let them drag γ towards 1 as well: the rule's drive needs no bonus then. Ask why the learner does not take
# such a γ (lesson [[the_trap]]). If each later second is demonstrated, c = 2 adds c / (1 − γ) = 10 to the drive's
# worth, as much as an accident costs.
# <!-- claim: math.isclose(SETTINGS.bonus / (1 - SETTINGS.gamma), -DEFAULT.reward.accident) -->

# %% [markdown]
# ## Round 1: how do the rule's actions reach the policy?
#
# For each update a learner draws a batch of {{ SETTINGS.batch }} rows. Now a share β of these comes from a
# table of the rule's drives. β falls evenly from {{ SETTINGS.beta_start }} to 0 by
# episode {{ SETTINGS.beta_episodes | , }}.
#
# The rule's *action* in a row reaches the policy through the critics' loss: this moves the Q of the row's action to
# its target, and the actor follows Q. Three rows that differ in their action alone, before and after one gradient
# step on Q; the best π is softmax(Q / α):

# %%
alpha, rows = 0.5, []
for action in range(3):
    q = torch.tensor([[1.0, 2.0, 0.0]], requires_grad=True)
    bc.sac.critic_loss(q[:, action], target=torch.tensor([3.0])).backward()
    after = q - 0.1 * q.grad
    both = [[each[0, action], (each / alpha).softmax(-1)[0, action]] for each in (q, after)]
    rows.append([f"{action}", *(f"{a:.2f} → {b:.2f}" for a, b in zip(*both, strict=True))])
table(["the row's action", "its Q", "its π"], rows)

# %% [markdown]
# **Exercise (10 min, ●●○).** Write the mixed batch. Draw n rows from the table of demonstrations, uniformly
# with replacement, and the others from your own replay buffer, `own.sample(..., rng)`. Raise each
# demonstration's reward by the bonus, but do not change the table. Return the rows, demonstrations first, and
# the marks.

# %%
REWARD = -4  # the column of a row that holds the reward


def mixed_batch(own, demonstrations, size, beta, bonus, rng):
    """(rows (size, n), marks (size,)), tensors. rng: a NumPy generator.

    demonstrations: a tensor (m, n), a row is (s, s', a, r, terminated, μ(s), μ(s')).
    """
    n = round(beta * size)
    marks = (torch.arange(size) < n).float()  # 1 for a demonstration, else 0
    # solution
    theirs = demonstrations[torch.from_numpy(rng.integers(len(demonstrations), size=n))]
    theirs[:, REWARD] += bonus
    return torch.cat([theirs, own.sample(size - n, rng)]), marks
    # end solution


check.mixed_batch(mixed_batch)

# %% [markdown] tags=["instructor"] minutes=4
# SQIL (Reddy et al.) pays 1 for demonstrations, 0 for everything else, and does not use the road's reward.
# Ask how much of its argument applies here: with c = 2 and rewards below 1, most of it. A good question is
# what a bonus on *all* rows would do: it pays for each second without an accident.
# <!-- claim: SETTINGS.bonus == 2 and max(map(second_pays, np.arange(0, 25, 0.1))) < 1 -->

# %% [markdown]
# ## Round 2: what do demonstrations bring?
#
# > **Bootstrapped SAC.** In lesson [[update_and_loop]]'s algorithm 1 to 3 are new, 4 to 6 from lesson
# > [[soft_constraint]]:
# >
# > 1. *First:* the rule (in the paper the stochastic rule) drives {{ SETTINGS.demonstration_episodes }}
# >    episodes, the demonstrations.
# > 2. *Batch:* a share β of the rows are demonstrations.
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
# Train two agents with the soft constraint, one with demonstrations and one without.
#
# > **Predict.** Twenty trained agents without demonstrations found the way out after
# > {{ median_found('none') }} episodes in the median. With demonstrations the rule drives
# > {{ SETTINGS.demonstration_episodes }} episodes first, and
# > {{ round(SETTINGS.batch * SETTINGS.beta_start) }} of the first {{ SETTINGS.batch }} rows are from these
# > drives, which get out. How many episodes of its own does an agent save?
# <!-- claim: of('rule').scores('success').min() >= ESCAPES -->

# %%
choices = ["none", "some, but fewer than the rule drove", "more than the rule drove"]
predict("learning_from_demonstrations.1", "How many episodes does an agent save?", choices)

# %%
predicted("learning_from_demonstrations.1")
both = [bc.settings_for("bootstrapped"), bc.settings_for("soft")]
training, live = own_code.training(both, episodes=20_000), figures.LiveDemonstrations()
training.run(progress=False, callback=live, updates=2700)
live.show(training)

# %% [markdown]
# Compare them at the same episode: both stop after 2,700 updates. The dots show twenty agents of each kind, the
# study's ten and ten *others* (other seeds, another implementation).
#
# **See.** *Demonstrations save the agent episodes, but fewer than the rule drove.* In the median it finds the way
# out after {{ median_found('c = 2') }} episodes of its own, not {{ median_found('none') }}; most of the gain needs
# no bonus (c = 0).
# <!-- claim: len(found('c = 0')) == 20 and found('c = 0').max() < np.median(found('none')) and
#   np.median(found('c = 0')) < (np.median(found('none')) + np.median(found('c = 2'))) / 2 -->
# <!-- claim: len(found('c = 2')) == len(found('none')) == 20 and found('c = 2').max() < found('none').min() -->
# <!-- claim: found('c = 2').min() + SETTINGS.demonstration_episodes > found('none').max() -->
#
# And how many escape after training? In brackets: the study's + the others, which trained twice as long.

# %%
table(measures.ESCAPE, measures.escaped())

# %% [markdown]
# **See.** *With the soft constraint as many escape without demonstrations as with them.*
#
# **Explain.** *Finding is not the problem.* With the pull all twenty find the way out in each row; demonstrations
# only make it sooner. Who is missing at the end has found it and not kept it (lesson [[found_and_kept]]). From
# episode {{ SETTINGS.beta_episodes | , }} on no batch holds demonstrations.
#
# Without the pull, *paid* demonstrations help to find: {{ find_alone('c = 2') }} do with c = 2,
# {{ find_alone('c = 0') }} with c = 0, {{ find_alone('none') }} without demonstrations. With the stochastic rule's
# demonstrations and {{ updates_ratio() }} times as many updates for each decision all of ten others escape without
# it.
# <!-- claim: len(found('c = 2')) == len(found('c = 0')) == len(found('none')) == 20 and
#   min(found(name).min() for name in ('c = 2', 'c = 0', 'none')) > 0 -->
# <!-- claim: [find_alone(name) for name in ('c = 2', 'c = 0', 'none')] == ['12 of 20', '2 of 10', '1 of 20'] and
#   fisher(12, 1, of=20) < 0.01 -->
# <!-- claim: of_the_stochastic_rule('demos').escapers('demos') == 6 and all(
#   clocks()['2', 'π̃'].of(m).escapers(m) == len(clocks()['2', 'π̃'].of(m)) == 10 for m in ('demos', 'bootstrapped'))
#   -->
# <!-- claim: all(len(of_the_stochastic_rule(m)) == 10 for m in ('demos', 'bootstrapped')) -->
# <!-- claim: in_all('c = 2') == in_all('c = 0') == in_all('none') == '16 of 20' -->
# <!-- claim: [alone(name) for name in ('c = 2', 'c = 0', 'none')] == ['5 of 20', '0 of 10', '1 of 20'] -->

# %% [markdown] tags=["instructor"] minutes=3
# Put the box on the wall. While the agents train, ask of each of its six lines: what happens without it? Some
# of these are experiments of the study (lesson [[found_and_kept]]).

# %% [markdown]
# ## Round 3: what does the bonus buy?
#
# A second of lesson [[soft_constraint]]'s fast agents pays {{ fast_pays_more() | .1f }} more than one of the
# rule's. A demonstrated second pays c = {{ SETTINGS.bonus | g }} more. An agent's own seconds are never paid
# it.
#
# > **Predict.** Ten agents learn with c = {{ SETTINGS.bonus | g }}, ten with c = 0. By episode 300 all have
# > found the way out. Which earn more in the next 200 episodes, the bonus not counted?
# <!-- claim: max(found('c = 2').max(), found('c = 0').max()) < 300 -->

# %%
choices = ["c = 2", "c = 0", "about the same"]
predict("learning_from_demonstrations.2", "Which earn more from episode 300 to 500?", choices)

# %%
predicted("learning_from_demonstrations.2")
bc.show(figures.returns(measures.paid_and_not()))

# %% [markdown]
# **See.** *Up to episode 600 the bonus holds the return down and the agents on the way out.*
#
# **Explain.** *A bonus is a leash.* A second of the teacher's is paid {{ SETTINGS.bonus | g }} more, a faster
# second earns only {{ fast_pays_more() | .1f }} more. While demonstrations fill much of each batch, being where the
# rule was pays better than being fast. This keeps an agent from running ahead: its return stays near the rule's,
# and rises as β falls. And it keeps an agent from running back: none of twenty loses the way out before episode
# 600, without the bonus {{ losing_until('c = 0', 600) }} do. *If so*, a longer leash holds longer:
# <!-- claim: losing_until('c = 2', 600) == 0 and
#   fisher(0, losing_until('c = 0', 600), of=20) < 0.01 -->
# <!-- claim: training('c = 2', 'return', 300, 600).max() < training('c = 0', 'return', 300, 600).min() -->
# <!-- claim: (abs(training('c = 2', 'return', 300, 500) - of('rule').scores('returns').mean()) < 5).all() -->
# <!-- claim: all(training('c = 2', 'success', 300, 600, which).mean() > training('c = 0', 'success', 300,
#   600, which).mean() + 0.05 and stats.mannwhitneyu(training('c = 2', 'success', 300, 600, which),
#   training('c = 0', 'success', 300, 600, which)).pvalue < 0.01 for which in (False, True)) -->
#
# %%
table(measures.LEASH, measures.leash_rows())

# %% [markdown]
# *The bonus holds, not the rows.* The longer demonstrations are paid, the nearer to the rule's is the return. Paid
# for ever, none of ten loses the way out in all its training (of ten others, trained twice as long,
# {{ losers(paid_for_ever_others()) }}). The ten whose leash ends at episode 1,000 lose it, too, just before that or
# after it; unpaid for ever, all ten lose it, too.
# <!-- claim: training('c = 2', 'return', 750, 800).min() > 75 and
#   lost_by(leashes()['until episode 1,000, c = 2'], 1000) ==
#   3 -->
# <!-- claim: [held(agents)[1] for agents in leashes().values()][1] == 10 and
#   [lost_by(agents, 900) for agents in leashes().values()] == [3, 0, 0, 8] -->
# <!-- claim: [held(agents)[1] for agents in leashes().values()][2:] == [0, 10] and
#   all(len(agents) == 10 for agents in leashes().values()) -->
# <!-- claim: (lambda paid: paid[0] > paid[1] + 20 > paid[2] + 25 and paid[3] > paid[2] + 20)([held(agents)[0]
#   for agents in leashes().values()]) and losers(paid_for_ever_others()) == 2 -->
# <!-- claim: paid_for_ever_others().curves['success'].shape[1] == 2 * 2000 and len(paid_for_ever_others()) == 10 -->
#
# **Slide.** Train two agents in the panel. When their success is near 100 %, set c to 0, and watch the
# return.

# %%
bc.panels.train_panel("bootstrapped", seeds=2, episodes=600)

# %% [markdown] tags=["instructor"] minutes=3
# By episode 900 none of twenty agents with c = 2 has lost the way out, but {{ losing_until('c = 0', 900) }}
# with c = 0 have. Ask for a schedule of c that holds the way out and not the return, and let a group try it
# in the panel.
# <!-- claim: losing_until('c = 2', 900) == 0 and
#   fisher(0, losing_until('c = 0', 900), of=20) < 0.01 -->

# %% [markdown]
# ## Round 4: what does a margin change?
#
# *In place of the bonus* the paper tries a loss on Q. A demonstration shows *one* action. Where no row shows
# another one, its Q is a guess, with an **extrapolation error**, and the actor picks the highest: lesson
# [[discrete_sac]]'s optimist's error. So the demonstrated action $a_E$ should lead every other action by a
# **margin** of {{ settings_for('margin').margin | .0f }} (the brackets). The loss is the distance between the
# dashed lines.
#
# **Drag** through the rule's drive. Where is another action ahead for this trained agent? Then drag the margin.
# When is the loss 0?

# %%
explorable.nine_values()

# %% [markdown]
# $$ J_E(Q) = \max_a \big[ Q(s,a) + l(a_E, a) \big] - Q(s,a_E), \qquad
# l = 0 \text{ for } a_E, \text{ else } 1 $$
#
# This loss pushes the demonstrated bar up and the *highest other* bar down.
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
# *Is the action ahead an error?* Five trained agents look at the first {{ ahead().seconds // 5 }} seconds of this
# drive: {{ ahead().seconds }} looks. In {{ ahead().others }} another action leads, and in {{ ahead().more }} of
# these it does earn more, if the agent drives on from there. The *order* is mostly right: any other action, at
# random, earns more in {{ 100 * ahead().at_random | .0f }} %. The *size* is not: on average Q promises
# {{ ahead().promised | .2f }} more, the road pays {{ ahead().paid | .2f }}.
#
# The paper's **Q-filter** drops the loss wherever another action leads.
# <!-- claim: ahead().more > 0.65 * ahead().others > 0.5 * ahead().seconds and ahead().at_random < 0.4 -->
# <!-- claim: ahead().promised > 2 * ahead().paid > 0 -->
# <!-- claim: bootstrap.paper_q_filter(torch.tensor([[1, 2, 3]] * 3), torch.arange(3)).tolist()
#   == [0, 0, 1] -->
# <!-- claim: settings_for('margin_soft').paper_q_filter and settings_for('margin').paper_q_filter -->
#
# *The paper finds the bonus better than this loss.* Here neither is shown to help more agents out: with the loss in
# its place {{ of_the_study('margin') }} escape, with the bonus {{ in_all('c = 2') }}, with neither
# {{ in_all('c = 0') }}.
# <!-- claim: of_the_study('margin') == '10 of 10' == of_the_study('c = 0') and fisher(10, 7) > 0.05 -->
# <!-- claim: settings_for('margin_soft').bonus == 0 and
#   settings_for('margin_soft').xi_multiplier == settings_for('soft').xi_multiplier > 0 -->

# %%
compare_predictions(
    "learning_from_demonstrations",
    {
        1: "some, but fewer than the rule drove",
        2: "c = 0",
    },
)

# %% [markdown]
# ## What you now know
#
# 1. A share β of each batch is the rule's, and falls to 0. Its actions reach the policy through Q.
# 2. Demonstrations saved fewer episodes than the rule had driven. With the soft constraint no more agents escaped;
#    without it {{ find_alone('c = 2') }} found the way out (without demonstrations {{ find_alone('none') }}), and
#    {{ alone('c = 2')[0] }} escaped.
# 3. The bonus is a leash: up to episode 600 it held agents on the way out, and at the rule's return.

# %% [markdown]
# **Three questions to think about**
# - Which c would you choose for γ = 0.95? (Try γ in the first panel.)
# - Where would you pay the bonus, so that it holds no agent back?
# - In which states would you count the margin loss?
#
# <details><summary>Answers</summary>
#
# - A little more than the first panel needs at γ = 0.95. Much more holds the agent near the rule: a demonstrated second
#   should not be paid more than a faster one earns (c below {{ fast_pays_more() | .1f }}).
# - On the way out alone, until trap 1 is passed. On the free road it pays for the rule's moderate speed.
# - Where the demonstrated action is worth more than the policy's on average (the usual Q-filter): also where another
#   action leads wrongly.
#
# </details>
# <!-- claim: bootstrap.q_filter(torch.tensor([[0.0, 2, 3]]), torch.tensor([1]), torch.ones(1, 3).div(3).log())
#   .tolist() == [1] and bootstrap.paper_q_filter(torch.tensor([[0.0, 2, 3]]), torch.tensor([1])).tolist() == [0] -->
#
# **Read on**: Hester et al. (arXiv 1704.03732): margins. Reddy et al. (arXiv 1905.11108): a bonus as the reward.
#
# You have read "16 of 20" and "7 of 10" many times by now. What may one conclude? [](how_many_seeds.ipynb).

# %% [markdown] tags=["instructor"] minutes=2
# No agent of the study uses the usual filter (`paper_q_filter=False`). In the paper's own, ≥ means =: no action's Q
# exceeds the largest. Early in training the actions ahead were not measured.
# <!-- claim: settings_for('margin').paper_q_filter and settings_for('margin_soft').paper_q_filter -->
#
# **On the board.** One batch of 64 as a row of boxes, the demonstrated ones shaded, and how many are shaded
# after 0, 500 and 1,000 episodes.
#
# **To discuss.** The bonus pays for *who* acted, not for what happened. Where else do rewards do that?
