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
# # Looking ahead
#
# **What you will be able to do**
# - write a look-ahead and a shield, which change how a trained agent drives, without more training;
# - say why a look-ahead can still crash;
# - say what a wrong or a learned model knows, what it guesses, and why the look-ahead trusts the guess.
#
# **Time** 45 minutes; running it takes about half a minute. **It builds on** the rule (lesson [[the_rule]]),
# the barrier ([[the_barrier]]) and the second trap ([[the_second_trap]]).

# %%
import bootcourse as bc
import numpy as np
from bootcourse.course import (
    check,
    compare_predictions,
    own_code,
    predict,
    predicted,
    progress,
    table,
)
from bootcourse.course.lessons.looking_ahead import explorable, figures, imagined_road
from bootcourse.course.shipped import beginning, shipped_experiment
from bootcourse.learn.road_model import learned_from, transitions_of
from bootcourse.research.experiments.lookahead import shipped_actors
from bootcourse.road.state import Accident

progress("looking_ahead")

# %% [markdown]
# ## Look first
#
# Of the five shipped agents of the paper's method, this one crashes most. It drives on 40 roads; the replay shows
# its first collision. **Can it drive better without learning anything more?**
# <!-- claim: five_accidents()[0] > 4 * sorted(five_accidents())[-2] -->

# %%
agent, roads = bc.shipped_agents("bootstrapped")[0], bc.held_out_seeds(15, 40)
alone = bc.record(agent.as_policy(), roads, label="bootstrapped")
drive = next(each for each in alone if each.accident == Accident.COLLISION)
table(*figures.compared({"alone": alone}))

# %% tags=["nbval-ignore-output"]
bc.recording([drive], height=360)

# %% [markdown]
# ## Round 1: nine futures
#
# The road is a program that can begin in any state. At each decision you can copy it nine times, take another
# action on each copy, and let the agent drive on.
#
# > **Predict.** The drive above ends just after its {{ len(ways_out()) }}th decision. You may change *one*
# > decision; after it the agent drives on. At which decision is the last chance to keep the car unhurt for ten
# > seconds?

# %%
question = "At which decision is the last chance?"
predict("looking_ahead.1", question, unit=f"of {len(drive.actions)}")

# %% [markdown]
# **Drag** the decision. What is the last one with a line that does not end in ✕?

# %%
predicted("looking_ahead.1")
explorable.futures()

# %% [markdown]
# **See.** At decision {{ len(ways_out()) - 1 }}, the last but one, two of the nine futures still have no
# accident for ten seconds. Do these two cars stay unhurt for longer?
# <!-- claim: len(ways_out()) == 19 and ways_out()[-2:] == [2, 0] -->

# %% tags=["nbval-ignore-output"]
unhurt = {f"{s} s": explorable.ways_out(drive, agent.as_policy(), s) for s in (10, 100)}
table(
    ["of nine futures, unhurt for", *range(1, len(drive.actions) + 1)],
    [[seconds, *futures] for seconds, futures in unhurt.items()],
    "The head row is the decision.",
)

# %% [markdown]
# **See.** No, but they escape *this* collision: both leave the road later, one after more than 20 s, one after more
# than 40 s. This agent often does: alone, {{ departs_within(100) }} of its 40 drives leave the road
# within 100 s. Only one decision was changed here; the look-ahead below chooses anew at each.
# <!-- claim: set(ways_out(100)[10:]) == {0} and [later_ends(s) for s in (20, 25, 40, 60)] ==
#   [[0, 0], [0, 2], [0, 2], [2, 2]] and Accident.ROAD_DEPARTURE == 2 -->
#
# Each of the nine imagined drives is a **rollout**. The value of its first action is
#
# $$ \hat Q(s, a) = \sum_{k=0}^{h-1} \gamma^k r_k + \gamma^h\, W(v_h) $$
#
# The **horizon** h is the number of decisions in the rollout, the first included; here γ = 1. An accident
# ends the sum, and W is not added. W(v) is what a whole episode on an empty road earns from the speed v,
# {{ worths().min() | .0f }} to {{ worths().max() | .0f }}: so much that each unhurt drive ranks before each with an
# accident.
# <!-- claim: worths().min() > 2 * 10 * earned_at(15, 1) and earned_at(15, 1) < 1 -->
#
# **Exercise (18 min, ●●●).** Write $\hat Q$ for all nine actions and many roads at once. You have
# - `imagined_road.step(cars, actions)`: one decision. It returns the next cars, the rewards, and whether this
#   decision ended in an accident. It drives on after one, so remember who has crashed;
# - `policy(cars)`: the actions of the base policy, the driver whose drives are imagined;
# - `worth(speeds)`: W. The ego's speed is `cars[:, 0, 3]`.


# %%
def rollout_values(cars, policy, horizon, gamma, worth):
    """The value of each of the nine actions, (roads, 9). cars (roads, vehicles, 10).

    policy(cars) -> actions (roads,) in 0..8. horizon: decisions, the first included.
    gamma: 0 to 1. worth(speeds) -> values (roads,).
    """
    # solution: the exercise's own


check.rollout_values(rollout_values)

# %% [markdown] tags=["instructor"] minutes=5
# Let somebody draw the nine drives as a tree before anybody writes code. Where is the agent asked, and about
# which cars? Two wrong answers to discuss ask it about the real road, or hold the action for all ten seconds.
# Ask what W is for: without it, what would the best action be just before the horizon?

# %% [markdown]
# The **look-ahead** takes the best of the nine at each decision; here ten decisions ahead, with your values.

# %%
values_of = own_code.yours_or_ours("rollout_values", doing="Driving")
improved = imagined_road.driver(values_of, agent.as_policy(), horizon=10)
ahead = bc.record(improved, roads, label="bootstrapped")
table(*figures.compared({"alone": alone, "with the look-ahead": ahead}))

# %% tags=["nbval-ignore-output"]
again = next(each for each in ahead if each.seed == drive.seed)
bc.recording(beginning(again, 40), height=360, futures=agent.as_policy())

# %% [markdown]
# **See.** All ten such agents of the study crash less and earn more with the look-ahead: they crash in
# {{ accidents('bootstrapped') | , }} of {{ drives('bootstrapped', 'alone') | , }} drives, alone in
# {{ accidents('bootstrapped', 'alone') | , }}.
# <!-- claim: (each('bootstrapped', 'rollouts', 'returns') > each('bootstrapped', 'alone',
#   'returns')).all() -->
# <!-- claim: (each('bootstrapped', 'rollouts', 'accidents') < each('bootstrapped', 'alone',
#   'accidents')).all() -->
# <!-- claim: len(each('bootstrapped', 'rollouts', 'roads')) == 10 and drives('bootstrapped') ==
#   drives('bootstrapped', 'alone') -->

# %% [markdown]
# ## Round 2: an agent that is stuck
#
# Nine of the study's ten agents of plain SAC, which had no teacher, stay behind the traps. We imagined all nine
# futures at {{ len(trapped_futures()) | , }} of their decisions there.
# {{ 'None' if not trapped_futures().any() else trapped_futures().sum() }} of these futures has the car ahead
# of trap 1 after ten seconds.
# <!-- claim: trapped_futures().shape[1] == 9 -->
# <!-- claim: (lambda s: (s < 0.01).sum() == 9 and len(s) == 10)(outs('sac', 'alone')) -->
#
# > **Predict.** Now the look-ahead chooses at *every* decision. Do agents get out, and
# > do any crash more often than alone?

# %%
choices = [
    "none gets out",
    "some, and none crashes more",
    "some, and some crash more",
    "all nine, and none crashes more",
]
predict("looking_ahead.2", "Do the nine get out in some drives, and do any crash more?", choices)

# %%
predicted("looking_ahead.2")
study = shipped_experiment("look-ahead")
bc.show(figures.each_agent(study, "sac"))

# %% [markdown]
# **See.** {{ led_out(outs('sac')) }} of the nine now get out in more than a tenth of their drives. But
# {{ less_safe('sac').sum() }} crash *more* often than alone, one in
# {{ each('sac', 'rollouts', 'accidents')[less_safe('sac')].max() | .0f }} of 1,000 drives instead of
# {{ each('sac', 'alone', 'accidents')[each('sac', 'rollouts', 'accidents').argmax()] | .0f }}.
# <!-- claim: less_safe('sac')[each('sac', 'rollouts', 'accidents').argmax()] -->
# <!-- claim: less_safe('sac').sum() == 4 -->
# <!-- claim: (outs('sac', 'alone')[less_safe('sac')] < 0.01).all() and less_safe('sac').any() -->
# <!-- claim: 0 < led_out(outs('sac')) < 9 -->
#
# **Explain.** *Why some get out.* None of the nine futures gets out, but one step can still be worth more than
# another, and the next decision begins where that step ends. Is it that W pays for speed? We drive three of the
# nine agents on eight roads: with W, with the same worth at all speeds, with a worth that pays for *slowness*, and
# with one that goes up and down over the speed:

# %% tags=["nbval-ignore-output"]
worths = {
    "with W": None,
    "the same worth": lambda speeds: 140 + 0 * speeds,
    "slowness": lambda speeds: 280 - imagined_road.worth(speeds),
    "up and down": lambda speeds: 140 + 5 * np.sin(3 * speeds),
}
rows = []
for number in (0, 2, 5):
    base = shipped_actors("sac")[number].as_policy()
    drivers = [imagined_road.driver(values_of, base, 10, after=worth) for worth in worths.values()]
    rows.append([number, *(figures.got_out(bc.record(one, roads[:8])) for one in drivers)])
table(["agent", *worths], rows, "Of 8 drives, so many end out of the trap.")

# %% [markdown]
# **See.** Agents 0 and 2 stay where all speeds have the same worth: there the worth tells unhurt futures apart. It
# need not pay for speed: agent 0 gets out as often with the one that goes up and down, agent 2 with slowness,
# too. Agent 5 needs no W.
#
# **Explain.** *Why they can crash.* As long as one future is unhurt for ten seconds, the look-ahead takes such a
# one. What comes in the eleventh it does not see. In one such crash all nine futures end in an accident at each
# of the last {{ too_late() }} decisions. So before these it took a future that was unhurt for ten seconds, and
# for no longer.
# <!-- claim: too_late() == 10 and free_futures()[-11] > 0 and len(free_futures()) < 100 -->
#
# All nine earn more than alone, two of them by next to nothing.
#
# <details><summary>Must a look-ahead earn more?</summary>
#
# With exact rollouts to the end and γ = 1 no agent would earn less (**policy improvement**): its own action is one of
# the nine, so the best of them is worth at least as much. With ten seconds and W this is not certain: W is a guess of
# what comes after.
#
# </details>
#
# <!-- claim: sorted((each('sac', 'rollouts', 'returns') - each('sac', 'alone', 'returns'))[outs('sac', 'alone') <
#   0.01])[1] < 0.1 -->
# <!-- claim: (lambda nine: (each('sac', 'rollouts', 'returns') > each('sac', 'alone', 'returns'))[nine].all() and
#   nine.sum() == 9)(outs('sac', 'alone') < 0.01) -->
# <!-- claim: set(each('sac', 'rollouts', 'roads')) == {1000} -->

# %% [markdown] tags=["instructor"] minutes=3
# *Policy improvement*, the proof where neither road nor policy draws: let π be the base, T the end of the
# episode, $V^\pi_t$ what π earns from decision t on, and $Q^\pi_t(s, a)$ the same after the action a. π′
# takes the best action by $Q^\pi_t$.
# 1. The best of nine is at least the policy's own: $\max_a Q^\pi_t(s, a) \ge V^\pi_t(s)$.
# 2. At the last decision π′ earns $\max_a Q^\pi_{T-1}(s, a)$, so $V^{\pi'}_{T-1} \ge V^\pi_{T-1}$.
# 3. Assume $V^{\pi'}_{t+1} \ge V^\pi_{t+1}$ in all states.
# 4. π′ takes $a^* = \arg\max_a Q^\pi_t(s, a)$ and earns $V^{\pi'}_t(s) = r + V^{\pi'}_{t+1}(s')$.
# 5. By line 3 this is at least $r + V^\pi_{t+1}(s') = Q^\pi_t(s, a^*)$.
# 6. By line 1 that is at least $V^\pi_t(s)$. By induction it holds for all t.
#
# Ask for the state in which the rollouts of plain SAC *should* show the way out, and which sequence of
# actions they would have to try. Count: nine to the power of how many? The planner of the course searches
# sequences, keeps 200 of them, and takes a hundred times as long.

# %% [markdown]
# ## Round 3: a shield, and a model that is wrong
#
# The **shield** follows the base policy, and takes the best of the nine only where the imagined drive of the
# policy's *own* action ends in an accident.
#
# **Exercise (8 min, ●●○).** Write the shield for many roads at once.


# %%
def shield(actions, values, accidents):
    """The shield's actions, (roads,), from the base's actions (roads,), in 0..8.

    values, accidents (roads, 9): of the nine imagined drives; an accident is True.
    """
    # solution: the exercise's own


check.shield(shield)

# %%
guard = own_code.yours_or_ours("shield", doing="Driving")
guarded = bc.record(imagined_road.shielded(guard, agent.as_policy(), horizon=10), roads)
drives_of = {"alone": alone, "with the look-ahead": ahead, "with the shield": guarded}
table(*figures.compared(drives_of))

# %% [markdown]
# **See.** The look-ahead earns more: it also improves decisions that are safe. But under the shield none of Round
# 2's nine agents crashes in 1,000 drives, and none gets out.
# <!-- claim: each('sac', 'shield', 'accidents').sum() == 0 and set(each('sac', 'shield', 'roads')) == {1000} and
#   (outs('sac', 'shield') < 0.01).sum() == 9 -->
#
# Now the imagined road has one of four errors. We take agents that crash rarely, so that an error can show harm:
# ten of PPO after cloning, alone {{ per_thousand('ppo_cloned', 'alone') | .0f }} accidents in 1,000 drives.
#
# {{ errors_table() }}
#
# > **Predict.** Each agent looks ahead in such a road. Which brings more accidents: noise on the others, or
# > only the four visible cars? (These are the nearest.)

# %%
harmful = ["noise on the others", "only the four visible cars", "both about as many"]
predict("looking_ahead.3", "Which of the two errors brings more accidents?", harmful)

# %% tags=["nbval-ignore-output"]
predicted("looking_ahead.3")
bc.show(figures.wrong_models(study))

# %% [markdown]
# **See.** Noise: {{ per_thousand('ppo_cloned', model=NOISE) | .0f }} accidents in 1,000 drives, the missing cars
# {{ per_thousand('ppo_cloned', model=VISIBLE) | .1f }}.
# <!-- claim: per_thousand('ppo_cloned', model=NOISE) > 100 * per_thousand('ppo_cloned', model=VISIBLE) -->
#
# With all a second late nearly every drive crashes, even under the shield. Here the imagined ego itself stands
# where it was a second ago: its futures are those of another road.
# <!-- claim: accidents('ppo_cloned', 'shield', LATE) > 0.99 * drives('ppo_cloned', 'shield', LATE) -->
#
# And noise? It could be the *optimist's error* of lesson [[discrete_sac]]. **Who guesses?** The noisy road:
# it makes some futures look better than they are, others worse. **Who picks?** The look-ahead, the
# best-looking of nine, so it takes luck for worth. If so, luck should cancel where it sees each future on
# three noisy roads and goes by the mean. And noise should flatter the *picked* future more than the nine. One
# of the ten, with your values:
# <!-- claim: accidents('ppo_cloned') == accidents('ppo_cloned', 'shield') == 0 -->
# <!-- claim: accidents('ppo_cloned', model=LATE) == drives('ppo_cloned', model=LATE) -->
# <!-- claim: len(each('ppo_cloned', 'alone', 'roads')) == 10 and max(WRONG, key=lambda error:
#   accidents('ppo_cloned', model=error)) == LATE -->

# %% tags=["nbval-ignore-output"]
safe = shipped_actors("ppo_cloned")[0].as_policy()
in_noise = {
    "alone": safe,
    "in one noisy road": imagined_road.in_noise(values_of, safe),
    "by the mean of three noisy roads": imagined_road.in_noise(values_of, safe, roads=3),
}
noisy_drives = {name: bc.record(one, roads[:20]) for name, one in in_noise.items()}
nine, picked = imagined_road.flattered(noisy_drives["in one noisy road"], safe)
table(
    *figures.compared(noisy_drives),
    f"Mean change of the values in noise: all nine {nine:.1f}, the picked one {picked:.1f}.",
)

# %% [markdown]
# **See.** Both hold: fewer drives crash by the mean of three, and noise raises the value of the future that is
# picked, though not of the nine on average. The shield picks only where the agent's own future crashes, so it
# goes by fewer guesses: {{ per_thousand('ppo_cloned', 'shield', NOISE) | .0f }} accidents in 1,000 drives.
# <!-- claim: worse_than_alone('ppo_cloned') == 3 and worse_than_alone('ppo_cloned', 'shield') == 2 -->

# %% [markdown] tags=["instructor"] minutes=6
# Which errors can a car measure while it drives? It can compare what it imagined a second ago with what came.
# Ask how it should act when the two differ.

# %% [markdown]
# ## Round 4: a model that is learned
#
# A car has no simulator, but it has its own drives. From an observation and an action five small networks,
# whose mean counts, learn to predict the next observation, the reward, and whether an accident ends the drive.
#
# Round 1's agent learns such a model from 200 of its drives. Where does the model first mislead the look-ahead on
# Round 1's drive?

# %% tags=["nbval-ignore-output"]
own_drives = transitions_of(agent.as_policy(), bc.held_out_seeds(41, 200))
learned = learned_from(own_drives, updates=500)
bc.show(figures.promised(agent, learned, drive))

# %% [markdown]
# **See.** Q̂ counts W, so each unhurt future is worth about 140, and an accident about −10. The car is in the right
# lane, where steering right can leave the road. The agent never steered right in
# {{ right_lane().sum() | , }} decisions there, so the model can only guess. At
# each decision of 20 of the agent's drives we ask model and road how many of the nine futures crash:
# <!-- claim: not right_lane()[TO_THE_RIGHT].any() and in_right_lane(first_collision())[:3].all() and
#   steered_off_the_road()[:3].all() and len(ways_out()) > 13 -->

# %% tags=["nbval-ignore-output"]
table(*figures.own_and_others(agent, learned, alone[:20]))

# %% [markdown]
# **Explain.** *On average the model knows what comes of the agent's own action, and guesses the others.* The
# drives show again and again how the agent's own choice goes on. How another one would go on they hardly ever
# show, and the model says of the others nearly what it says of the own. Who picks? The look-ahead: the
# friendliest of nine, and eight of them are guesses.
#
# > **Predict.** Ten such agents each learn a model from {{ learned_model.ROUNDS * learned_model.DRIVES }} drives.
# > Random actions show all nine, but a drive with many of them ends soon. From whose drives should the model
# > learn, so that with the look-ahead the agents crash least?
# <!-- claim: len(learning()) == 10 and learned_model.DRIVES == 200 and learned_model.ROUNDS == 4 -->

# %%
drives = [
    "all by the agent",
    "all by the agent, 10 % of its actions random",
    "all by the agent, 30 % of its actions random",
    "200 by the agent, then 600 by the look-ahead, whose model learns from all drives so far",
]
predict("looking_ahead.4", "Whose drives make the best model for the look-ahead?", drives)

# %%
predicted("looking_ahead.4")
bc.show(figures.learned(shipped_experiment("learned-model")))

# %% [markdown]
# **See.** The agent's own drives hold the most decisions, and with their model every drive crashes. With the
# look-ahead's drives the agents crash least, on average, but not less than alone.
# <!-- claim: alone().mean() < min(in_last_model().mean(), learned_without(), *map(learned_without,
#   learned_model.RANDOM)) -->
# <!-- claim: learning().measured['rows'].mean() > 2 * max(learned_rows(share).mean() for share in
#   (None, *learned_model.RANDOM)) -->
# <!-- claim: learned_without() == 1000 and in_last_model().mean() < 0.6 *
#   learned_without(share=0.1) and in_last_model().mean() < 0.6 *
#   learned_without(share=0.3) and all(learned_without(share=share) <
#   800 for share in learned_model.RANDOM) -->
# <!-- claim: learned_model.RANDOM == (0.1, 0.3) and len(in_last_model()) == 10 -->
#
# **Explain.** More drives of the agent show more of what the model knows already. The look-ahead's drives show
# where it was wrong: in them the actions that the last model rated too high are taken, and end in accidents.
# Each round's model is better than the one before:
#
# {{ by_round() }}
#
# <!-- claim: (np.diff(learned_model.per_thousand(learning(), figures.LEARNED_FORM).mean(axis=0)) < 0).all() -->
#
# > **Predict.** Now the *shield* drives in the same models. It takes the best of nine only where the model gives
# > the agent's own action more than an even chance of an accident within ten decisions. That happens in
# > {{ overruled('shield') }} of the decisions; the look-ahead replaces {{ overruled(figures.LEARNED_FORM) }}. Do the
# > agents crash more often than alone, on average?

# %%
choices = ["yes, in all four kinds of models", "in some kinds", "no, less often in all four"]
predict("looking_ahead.5", "Do they crash more often under the shield than alone?", choices)

# %%
predicted("looking_ahead.5")
bc.show(figures.learned(shipped_experiment("learned-model"), "shield"))

# %% [markdown]
# **See.** On average they crash less in each kind of model: the four that crash most alone gain. For the other six
# little changes, but with 30 % random actions four of them crash more, one in
# {{ under_shield(0.3)[alone() < 500].max() | .0f }} of 1,000 drives. (A rank test of the ten agents, of which few
# change, shows no gain in any of the four kinds.)
# <!-- claim: min(map(p_of_shield, KINDS)) > 0.05 and len(KINDS) == 4 -->
# <!-- claim: max(under_shield(kind).mean() for kind in KINDS) < alone().mean() -->
# <!-- claim: (lambda most: most.sum() == 4 and all((under_shield(kind) < alone())[most].all() for kind in KINDS) and
#   max(abs(under_shield(kind) - alone())[~most].max() for kind in KINDS[:3]) <= 10 and
#   (under_shield(0.3) > alone())[~most].sum() == 4)(alone() > 500) -->
#
# **Explain.** The shield asks first about the agent's own action, of which a model of its own drives knows most.
# It picks among guesses only where that action looks bad. There it often is bad, so little is lost by a guess.
# *So ask of a model not only how good it is, but what it is asked.*

# %% [markdown] tags=["instructor"] minutes=5
# Ask what an honest learned model would have to say besides a number: how sure it is. Ours is the mean of
# five networks; even five that agree can be wrong together, where none of them has a row.

# %%
compare_predictions(
    "looking_ahead",
    {
        1: explorable.last_chance(drive, agent.as_policy()),
        2: "some, and some crash more",
        3: harmful[0],
        4: drives[3],
        5: "no, less often in all four",
    },
)

# %% [markdown]
# ## What you now know
#
# 1. A rollout takes one action, follows a policy, and adds an estimate of what comes after. The look-ahead takes
#    the best of nine at each decision.
# 2. It improved the return without training, but not always the safety: ten seconds can be too few. It led some
#    agents out, where no single changed decision did within ten seconds. Two of three stayed without W; but worths
#    that do not pay for speed led them out, too.
# 3. It goes by guesses: noise misled it, the mean of several guesses helped, and a shield asks for fewer.
# 4. A model of the agent's own drives knew best what comes of the own action and guessed the others, and the
#    look-ahead crashed.
#    Its own drives made the next model better.
#
# **Three questions to think about**
# - A car knows everything a second late. How could it look ahead without an error?
# - What would rollouts of rollouts do, and what would they cost?
# - A car has learned a model. How would you find out whether it is good enough to look ahead in?
#
# <details><summary>Answers</summary>
#
# 1. It imagines its own last action first, from the late road: this gives the road as it is now. From there the nine.
# 2. A second improvement: what is two decisions away is found, too. Each of 90 imagined decisions needs 90 of its
# own, so a decision costs about 8,000. 3. On new drives, compare what it imagines with what comes, also after the
# actions that the look-ahead would choose: drives of the agent alone do not test it there.
#
# </details>
#
# **Read on**: Tesauro and Galperin (1996), *On-line Policy Improvement using Monte-Carlo Search*. Ross and
# Bagnell (2012, arXiv 1203.1007) and Chua et al. (2018, arXiv 1805.12114), on learned models.
#
# You have seen a pull, demonstrations, cloning, and thinking ahead. Others have thought of more. Does the choice
# matter? [Other ways to use a teacher](other_ways.ipynb).

# %% [markdown] tags=["instructor"]
# **On the board.** A tree: one road, nine first actions, and after each the same driver; one of nine branches
# bold.
#
# **To discuss.** Who checks a shield whose model of the road is wrong?
