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
# # Other ways to use a teacher
#
# **What you will be able to do**
# - write a piece of three other methods: RLPD, IBRL and jump-start RL;
# - name what has to be equal before methods can be compared;
# - compare by decisions and by seconds, and say what the comparison leaves open.
#
# **Time** 45 minutes; running it takes a quarter of a minute. **It builds on** learning from
# demonstrations (lesson [[learning_from_demonstrations]]) and the number of seeds
# ([[how_many_seeds]]); Round 1 refers to [[recorded_drives]].

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
)
from bootcourse.course.lessons.other_ways import explorable, figures, measures
from bootcourse.research import equal_decisions

progress("other_ways")

# %% [markdown]
# ## Look first
#
# Five ways to use a teacher: what each takes from the rule of lesson [[the_rule]], and until when.

# %%
bc.show(figures.what_is_taken())

# %% [markdown]
# PPO here is that of lesson [[the_second_trap]], begun as a clone of the rule ([[demonstrations]]).
#
# **Does it matter how you use a teacher?**

# %% [markdown] tags=["instructor"] minutes=2
# Ask what each of the five would do with a teacher that is wrong in one place, and what a person
# who pays for computing time would count instead of decisions.

# %% [markdown]
# ## Round 1: what keeps Q in bounds?
#
# RLPD (*reinforcement learning with prior data*) is SAC with half of each batch demonstrations,
# without bonus, margin and KL. Lesson [[recorded_drives]] showed the danger: untried actions may be
# guessed too high. The policy follows the highest of nine guesses, and the target the policy.
#
# One remedy is an **ensemble**: {{ settings_for('rlpd').critics }} critics instead
# of two. Each update draws {{ settings_for('rlpd').target_critics }} of them, and the target takes
# the smaller of their values.
# <!-- claim: (lambda s: s.bonus == s.margin == s.xi_multiplier == 0 and s.beta_start == 0.5 and
#   s.beta_episodes is None)(settings_for('rlpd')) -->
#
# **Exercise (4 min, ●○○).** Write the ensemble's part of the target: the smallest value of the
# chosen critics.


# %%
def smallest_of(q, chosen):
    """(batch, 9), from q (critics, batch, 9) and chosen (k,), the numbers of the critics drawn."""
    # solution: the exercise's own


check.smallest_of(smallest_of)

# %% [markdown]
# To show it in 500 updates, these critics learn from the rule's drives alone, with targets ten
# times as fast as RLPD's (τ). With its γ no drive is worth more than
# {{ worth_at_most(settings_for('rlpd').gamma) | .0f }}.
# <!-- claim: 0.05 == 10 * settings_for('rlpd').tau -->
#
# > **Predict.** Does the ensemble alone keep Q of the rule's actions below this bound?

# %%
predict("other_ways.1", "Does the ensemble alone keep Q below 32?", ["yes", "no"])

# %% [markdown]
# RLPD has a second remedy, **layer normalisation**: in each state a hidden layer's outputs are
# shifted and scaled to mean 0 and variance 1. Then the last layer's weights limit Q, whatever the
# state. Both agents below have the ensemble; one is also normalised.

# %% tags=["nbval-ignore-output"]
predicted("other_ways.1")
torch.set_num_threads(1)  # small matrices are faster on one thread
settings, updates = bc.settings_for("rlpd", tau=0.05), np.arange(0, 501, 25)
training = own_code.training([settings, settings])  # two agents, the second not normalised
values = measures.from_drives_alone(training, updates)
bc.show(figures.believed(updates, values, measures.worth_at_most(settings.gamma)))

# %% [markdown]
# **See.** (Yours will differ.) In 500 updates of one agent each, Q passes what any drive can earn
# only without layer normalisation; with it, Q still rises.
#
# **Explain.** The smaller of two guesses is still too high if both are.

# %% [markdown] tags=["instructor"] minutes=4
# Ask why the critics agree on a wrong value: they learn from the same rows, and none of these says
# what an untried action earns. Ask what a drive of one's own with that action would change.

# %% [markdown]
# ## Round 2: the better of two
#
# IBRL (*imitation-bootstrapped RL*) keeps the teacher to the end. In each state there are two
# candidates, the rule's action μ(s) and an action a that the agent draws from its policy π. Q
# decides: the one that it values more is taken.
# <!-- claim: METHODS['ibrl'].learner_class().needs_teacher -->
#
# > **Predict.** There are three actions, of which the rule takes the second. The others have Q = 1
# > and Q = 3. You raise Q of the rule's action from 0 to 4. How does the probability that it is
# > taken grow?

# %%
predict("other_ways.2", "How does it grow?", ["smoothly", "in one step", "in two steps"])

# %% [markdown]
# **Drag** Q of the rule's action. Where does the picture change, and by how much?

# %%
predicted("other_ways.2")
explorable.which_of_two()

# %% [markdown]
# **See.** The probability jumps where Q of the rule's action reaches another action's, by what π
# gives to that action.
#
# **Explain.** In a formula:
#
# $$ a^* = \mathrm{argmax}_{a' \in \{\mu(s),\, a\}}\; Q(s, a') $$
#
# A KL pulls towards the teacher also where it is wrong. Here the teacher's action gives way as soon
# as Q puts the agent's above it. The target makes the same choice in the next state.
#
# **Exercise (12 min, ●●●).** Write the choice as a *distribution* over the nine actions: an
# action that is better than μ(s) keeps its probability; if another is drawn, μ(s) is taken.


# %%
def better_of_two(pi, q, rule_actions):
    """The choice's distribution (batch, 9). pi, q (batch, 9); rule_actions (batch,): μ(s).

    With three actions: pi [0.5, 0.3, 0.2], q [1, 2, 3], μ(s) = 1, the second: [0.0, 0.8, 0.2].
    """
    # solution: the exercise's own


check.better_of_two(better_of_two)

# %% [markdown] tags=["instructor"] minutes=4
# Ask what IBRL does at first, while Q is wrong and may put actions above the rule's although they
# are worse. What would make the first hour safer (a pessimistic Q: the smaller of two, an ensemble;
# a margin that an own action must exceed)?

# %% [markdown]
# ## Round 3: when does the teacher hand over?
#
# In jump-start RL the rule makes the first h decisions of each episode, and then the agent takes
# over, in a place that it seldom reaches alone. At first h is
# {{ settings_for('jsrl').guide_decisions }}. As soon as the two together earn about as much as at
# their best, h shrinks by a tenth of its first value, down to 0.
#
# **Exercise (6 min, ●●○).** Write the judgement: does h shrink now?


# %%
def guide_shrinks(returns, best, window, tolerance):
    """True if the mean of the last `window` returns is at least the best mean less a tolerance.

    returns: a list, since h last shrank; with fewer than `window` of them h stays. best: a float,
    which may be negative, and -inf at first. tolerance: a share of the size of best, 0.05 for 5 %.
    """
    # solution: the exercise's own


check.guide_shrinks(guide_shrinks)

# %% tags=["nbval-ignore-output"]
training = own_code.training([bc.settings_for("jsrl", envs_per_agent=8)], 80)
bc.show(figures.handing_over(measures.handed_over(training)))

# %% [markdown]
# **See.** (Yours will differ.) The rule's part shrinks in steps, although most of these episodes
# end in an accident: the judgement compares with the best mean so far, not with a goal.
#
# **Explain.** A **curriculum** like this one begins with the end of the way and moves backwards.
# The paper's β fades by the number of episodes, h by the *return*.

# %% [markdown] tags=["instructor"] minutes=3
# Ask what h does if the teacher is the planner of lesson [[the_barrier]], which is out after ten
# seconds, and what it does if the teacher never gets out.

# %% [markdown]
# ## Round 4: which of the five is best?
#
# A comparison needs the same number of decisions, the same search for settings and the same roads
# in the test. The search matters: jump-start RL earns {{ min(search('jsrl').values()) | .0f }} with
# one of its three settings, {{ max(search('jsrl').values()) | .0f }} with another. Here each method's
# best of three is trained again, with ten new agents.
# <!-- claim: {len(each) for each in equal_decisions.TRIES.values()} == {3} and
#   {len(each) for each in compared().values()} == {10} and len({a['gamma'] for each in
#   compared().values() for a in each.agents}) == 1 and all(set(one) == {'envs_per_agent' if
#   'ppo' in m else 'target_entropy'} for m, t in equal_decisions.TRIES.items() for one in t) -->
#
# Not everything is equal:
#
# {{ not_equal() }}
# <!-- claim: drives_before('jsrl') == 0 and {drives_before(m) for m in TAUGHT if m != 'jsrl'} ==
#   {200} and DEFAULT.clock.decision_rate == 1 and {m for m in TAUGHT if
#   METHODS[m].learner_class().needs_teacher} == {'ibrl'} -->
#
# > **Predict.** After {{ FIRST | , }} decisions each agent drives on {{ roads() | , }} held-out
# > roads. Which of the five earns the most, or can ten agents of each not tell?

# %%
learners = [bc.display_name(method) for method in figures.TAKES]
predict("other_ways.3", "Which earns the most in the test?", [*learners, "ten agents cannot tell"])

# %%
predicted("other_ways.3")
compared = equal_decisions.by_method(shipped.shipped_experiment("beyond"))
by_rule = bc.drive_episodes(bc.rule_policy(bc.DEFAULT), bc.held_out_seeds(1, 200))
bc.show(figures.in_the_test(compared, by_rule.returns.mean()))

# %% [markdown]
# **See.** Having a teacher matters more than how it is used: all five earn more than twice what the
# rule earns, PPO and plain SAC without a teacher, after the same search, less than it. Return is
# not safety: all agents of the five have accidents.
# <!-- claim: min(map(middle, TAUGHT)) > 2 * of('rule').scores('returns').mean() > 2 *
#   max(score_at(m).high for m in compared() if m not in TAUGHT) and all(at(m, 'accident').min() > 0
#   for m in TAUGHT) -->
# <!-- claim: min(at(m, 'returns').min() for m in TAUGHT) > of('rule').scores('returns').mean() >
#   max(at(m, 'returns').max() for m in compared() if m not in TAUGHT) -->
#
# **Explain.** Jump-start RL without the rule's first seconds is plain SAC, with the same other
# settings: it earns {{ middle('sac') | .0f }}, not {{ middle('jsrl') | .0f }}.
# <!-- claim: taught_by('jsrl') == {'guide_decisions', 'stages', 'window', 'tolerance'} and
#   list(compared())[-1] == 'sac' and score_at('sac').high < score_at('jsrl').low -->
#
# Which of the five earns the most stays *open*. **Rank tests** of all ten pairs (lesson
# [[your_teacher]]), corrected for their number (lesson [[how_many_seeds]]), show only that
# bootstrapped SAC and IBRL earn more than PPO after cloning. After {{ SECOND | , }} decisions they
# show no difference. A larger search may find more: four of the five best settings stand at the
# edge of what was tried.
# <!-- claim: {pair for pair, p in pairs(FIRST).items() if p < 0.05} == {('bootstrapped',
#   'ppo_cloned'), ('ibrl', 'ppo_cloned')} and min(pairs(SECOND).values()) > 0.05 and
#   len(pairs(FIRST)) == 10 and all(middle(m) > middle('ppo_cloned') for m in ('bootstrapped',
#   'ibrl')) -->
# <!-- claim: at_edge() == {'bootstrapped', 'jsrl', 'rlpd', 'ppo_cloned'} -->

# %% [markdown] tags=["instructor"] minutes=3
# Each group defends one method: with a slow car and a safe test track, with a fleet whose accidents
# are in the papers, with drives on a disk and nothing to drive. What does the picture not show:
# what it costs to ask the teacher, how much code it is, what three more settings would change.

# %% [markdown]
# ## Round 5: does the choice matter at all?
#
# > **Predict.** After {{ FIRST | , }} decisions PPO after cloning earns the least of the five in
# > training. Which place does it take after {{ equal_decisions.SECONDS }} seconds of computing?
# <!-- claim: below_all_others('ppo_cloned', FIRST, explorable.DECISIONS) and explorable.LATER ==
#   FIRST -->

# %%
predict("other_ways.4", "Where is PPO after cloning?", ["first", "in the middle", "last"])

# %% [markdown]
# **Switch** from decisions to seconds of computing, with our fast simulator. On a road a decision
# takes a second, so decisions count its time. Which curve is on top after
# {{ equal_decisions.SECONDS }} s, which at the bottom? (PPO's
# {{ settings_for('ppo_cloned').cloning_updates }} updates of cloning are not counted; in this time it
# makes about {{ round(updates_in('ppo_cloned', equal_decisions.SECONDS), -2) | ,.0f }}. Jump-start
# RL's training episodes may begin with the rule.)

# %%
predicted("other_ways.4")
explorable.TwoCounts(compared, by_rule.returns.mean())

# %% [markdown]
# **See.** In {{ equal_decisions.SECONDS }} s of computing PPO after cloning earns the most, RLPD the
# least. In {{ on_road(explorable.EARLY) | .0f }} h on a road PPO after cloning earns less than
# bootstrapped SAC and IBRL; RLPD's lead there may be chance. Jump-start RL falls by half on its way: *perhaps*
# because the agent must now begin by itself.
# <!-- claim: (lambda of: of['ppo_cloned'].low > max(of[m].high for m in of if m != 'ppo_cloned')
#   and of['rlpd'].high < min(of[m].low for m in of if m != 'rlpd'))(training_scores(
#   equal_decisions.SECONDS, explorable.SECONDS)) and equal_decisions.SECONDS == 5 -->
# <!-- claim: (lambda of: of['ppo_cloned'].high < min(of[m].low for m in ('bootstrapped', 'ibrl'))
#   and max(of, key=lambda m: of[m].value) == 'rlpd')(training_scores(explorable.EARLY,
#   explorable.DECISIONS)) and first_may_be_chance(explorable.EARLY, explorable.DECISIONS) -->
# <!-- claim: 0.4 < left_of('jsrl') < 0.6 -->
#
# **Explain.** PPO's decisions cost little computing. That it learns from its last drives alone may
# be why it needs more of them. So if little can be spent the way does matter, and what is scarce
# decides: computing time, or seconds on the road.

# %% [markdown] tags=["instructor"] minutes=4
# Ask who in the room has which clock: a simulator and one night, or a car and one day. A faster
# computer makes the computing cheaper, and the road no faster: who gains?

# %%
compare_predictions(
    "other_ways",
    {1: "no", 2: "in two steps", 3: "ten agents cannot tell", 4: "first"},
)

# %% [markdown]
# ## What you now know
#
# 1. A teacher can give data, a start, a second opinion, the first seconds or a pull.
# 2. From the rule's drives alone, at ten times RLPD's τ, an ensemble let Q out of bounds in 500
#    updates; with layer normalisation it stayed in.
# 3. IBRL's critics choose between the teacher's action and the agent's. Jump-start RL hands over
#    where the return is about its best.
# 4. In the test after {{ FIRST | , }} decisions all five earn over twice what the rule earns,
#    without a teacher PPO and SAC less than it. Which of the five is best is open.
# 5. In {{ equal_decisions.SECONDS }} s of computing after its cloning PPO earns the most in training;
#    on a road, in {{ on_road(explorable.EARLY) | .0f }} h, less than bootstrapped SAC and IBRL.
#
# **Three questions to think about**
# - Your teacher is a person who can drive for one hour. Which of these methods do you choose?
# - What happens if IBRL's critic is wrong about the rule's action?
# - Which method could win by a larger search? How would you find out?

# %% [markdown] tags=["instructor"] minutes=3
# Answers to the three questions. (1) An hour of driving is 3,600 decisions, an eighth of what RLPD,
# IBRL, bootstrapped SAC and the clone had: nothing here shows that it is enough for them. IBRL
# wants the person beside the learner for as long as it drives. (2) If the critic thinks too little
# of it, the agent's own action is taken, and its value corrected. If it thinks too much of it, the
# rule's action is taken, and its value is corrected, too. What is not corrected are the values of
# actions that neither of the two takes. (3) One whose three settings differ much, or whose best
# stands at the edge of what was tried; search again on the search's roads, and test once.

# %% [markdown]
# **Read on**: Ball et al., *Efficient Online Reinforcement Learning with Offline Data* (RLPD, arXiv
# 2302.02948); Hu, Mirchandani and Sadigh, *Imitation Bootstrapped Reinforcement Learning* (IBRL,
# arXiv 2311.02198); Uchendu et al., *Jump-Start Reinforcement Learning* (arXiv 2204.02372).

# %% [markdown] tags=["instructor"]
# **On the board.** A teacher in the middle, an arrow for each thing that a learner takes from it,
# and on the arrow until when.
#
# **To discuss.** Your teacher can be asked a thousand questions. When do you ask them?
