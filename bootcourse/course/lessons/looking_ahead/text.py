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
# - write a look-ahead that improves trained drivers without more training, and a shield;
# - explain what one better decision at a time can do, and what it cannot;
# - say what a wrong model costs, and a model that is learned from drives.
#
# **Time** 50 minutes; running it takes about one minute. **It builds on** the rule (lesson
# [[the_rule]]), the barrier ([[the_barrier]]) and the second trap ([[the_second_trap]]).

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
from bootcourse.learn.road_model import ImaginedAhead, learned_from, transitions_of
from bootcourse.road.state import Accident

progress("looking_ahead")

# %% [markdown]
# ## Look first
#
# Five agents of the paper's method ship with the course. They get out of the trap in most of their
# drives, but they have accidents.

# %%
agents = bc.shipped_agents("bootstrapped")
roads = bc.held_out_seeds(15, 40)
before = [bc.drive_episodes(each.as_policy(), roads) for each in agents]
names = [f"agent {number}" for number in range(1, len(agents) + 1)]
table([f"{len(roads)} drives of each", *names], [["accidents", *map(figures.accidents, before)]])

# %% [markdown]
# We follow agent 1, which crashes by far the most. It mostly leaves the road; here is its first
# collision.
# <!-- claim: (how_five_end()[0] == Accident.ROAD_DEPARTURE).sum() > 20 -->
# <!-- claim: five_accidents()[0] > 4 * sorted(five_accidents())[-2] -->

# %%
agent, alone = agents[0].as_policy(), before[0]
first = int((alone.accident == Accident.COLLISION).argmax())
drive = bc.record(agent, [roads[first]], label="bootstrapped")[0]

# %% tags=["nbval-ignore-output"]
bc.recording([drive], height=360)

# %% [markdown]
# ## Round 1: nine futures
#
# The road is a fast program, and it can begin in any state. So at each decision you can copy the
# road nine times, take a different action on each copy, and let the agent drive on from there.

# > **Predict.** The drive above ends just after its {{ len(ways_out()) }}th decision. You may change
# > *one*; after it the agent drives on. Which is the last decision that can still save the drive, for
# > ten seconds? Then **drag** the decision: where is the last blue line?

# %%
question = "Which is the last decision that can save the drive?"
predict("looking_ahead.1", question, unit=f"of {len(drive.actions)}")

# %%
predicted("looking_ahead.1")
explorable.futures(drive, agent)

# %% [markdown]
# **See.** The last decision but one can still save this drive: two of its nine futures have no
# accident in ten seconds.
# <!-- claim: len(ways_out()) == 19 and ways_out()[-2:] == [2, 0] -->
#
# Such an imagined drive is called a **rollout**. Its return says what the first action is worth:
#
# $$ \hat Q(s, a) = \sum_{k=0}^{h-1} r_k + W(v_h) $$
#
# The **horizon** h is the number of decisions in the drive: with h = 10 the agent decides nine more
# times after the action a. An accident ends the sum. Otherwise $W(v)$ stands for what comes after
# the horizon: the return of a whole episode on an empty road that starts with the last speed v. W is
# so large that a drive without an accident is always worth more.
#
# **Exercise (18 min, ●●●).** Write $\hat Q$ for all nine actions and many roads at once. You have
# - `imagined_road.step(cars, actions)`: one decision. It returns the next cars, the rewards, and
#   whether this decision ended in an accident;
# - `policy(cars)`: the actions of the base policy, the driver whose drives are imagined;
# - `imagined_road.worth(speeds)`: W. The ego's speed is `cars[:, 0, 3]`.


# %%
def rollout_values(cars, policy, horizon):
    """The value of each of the nine actions, (roads, 9). cars (roads, vehicles, 10).

    policy(cars) -> actions (roads,) in 0..8. horizon: decisions, the first included.
    """
    # solution
    values = np.zeros((len(cars), 9))
    for action in range(9):
        imagined, alive = cars, np.ones(len(cars), dtype=bool)
        for decision in range(horizon):
            actions = np.full(len(cars), action) if decision == 0 else policy(imagined)
            imagined, rewards, crashed = imagined_road.step(imagined, actions)
            values[:, action] += alive * rewards
            alive &= ~crashed
        values[:, action] += alive * imagined_road.worth(imagined[:, 0, 3])
    return values
    # end solution


check.rollout_values(rollout_values)

# %% [markdown] tags=["instructor"] minutes=7
# Let somebody draw the nine drives as a tree before anybody writes code. Where is the agent asked,
# and about which cars? Two wrong answers to discuss ask it about the real road, or hold the action
# for all ten seconds. Ask why W has to be there: without it, what would the best action be just
# before the horizon?

# %% [markdown]
# ## Round 2: the best of nine
#
# The driver that takes the best of the nine values at each decision is the **look-ahead**.
#
# > **Predict.** The same agent decides by your nine values, ten decisions ahead, on the same roads.
# > On how many does it have an accident?

# %%
predict(
    "looking_ahead.2",
    "On how many roads does the look-ahead have an accident?",
    unit=f"of {len(roads)} drives",
)

# %%
predicted("looking_ahead.2")
values_of = own_code.yours_or_ours("rollout_values", doing="Driving")
improved = imagined_road.driver(values_of, agent, horizon=10)
ahead = bc.drive_episodes(improved, roads)
table(*figures.compared({"alone": alone, "with the look-ahead": ahead}))

# %% tags=["nbval-ignore-output"]
again = bc.record(improved, [drive.seed], label="bootstrapped")[0]
bc.recording(beginning(again, 40), height=360, futures=agent)

# %% [markdown]
# The replay shows the nine imagined drives of each decision; the bold one is driven.
#
# **See.** In the study each of ten such agents crashes less and earns more with the look-ahead:
# together {{ ahead('bootstrapped', 'alone').accidents | , }} accidents in {{ ahead('bootstrapped',
# 'alone').drives | , }} drives alone, {{ ahead('bootstrapped').accidents | , }} with it.
# <!-- claim: (earned('bootstrapped') > earned('bootstrapped', 'alone')).all() -->
# <!-- claim: (each('bootstrapped', 'rollouts', 'accidents') < each('bootstrapped', 'alone',
#   'accidents')).all() -->
# <!-- claim: ahead('bootstrapped').agents == ahead('bootstrapped', 'alone').agents == 10 -->
#
# Of the study's ten plain SAC agents nine stay behind the traps.
# <!-- claim: (lambda s: (s < 0.01).sum() == 9 and len(s) == 10)(outs('sac', 'alone')) -->
#
# > **Predict.** Let these nine look ahead. Do they get out, and does any crash more often than alone?
# > Think of who drives after the first of the ten decisions.

# %%
choices = [
    "none gets out",
    "some, and none crashes more",
    "some, and some crash more",
    "all nine, and none crashes more",
]
predict("looking_ahead.3", "Do the nine get out in some drives, and do any crash more?", choices)

# %%
predicted("looking_ahead.3")
study = shipped_experiment("look-ahead")
bc.show(figures.each_agent(study, ("sac", "demos")))

# %% [markdown]
# **See.** Each line is an agent. Of the nine, {{ (of_the_nine() > 0).sum() }} get out in some
# drives. So do four of five agents of demonstrations only, which had not got out once. All fifteen
# agents in the picture earn more (not shown). But {{ less_safe('sac').sum() }} of the nine crash
# *more* than alone: those that are out in about half of their drives. *Open*: why these?
# <!-- claim: (outs('sac', 'alone')[less_safe('sac')] < 0.01).all() and less_safe('sac').any() and
#   ((abs(outs('sac') - 0.53) < 0.06) == less_safe('sac')).all() -->
# <!-- claim: all((earned(base) > earned(base, 'alone')).all() for base in ('sac', 'demos')) -->
# <!-- claim: 0 < (of_the_nine() > 0).sum() < 9 -->
# <!-- claim: (outs('demos', 'alone') == 0).all() and len(outs('demos')) == 5 and
#   (outs('demos') > 0).sum() == 4 -->
#
# **Explain.** The look-ahead improves *one* decision: from the second on, the imagined drive is the
# base policy's. If the base goes on where the first action leads, a rollout shows the way out. If
# it steers back, each step towards the way out has to raise the imagined return by itself.
#
# With rollouts to the end of the episode, on the true road, the look-ahead would earn at least what
# its base earns, from every state: this is **policy improvement**. It speaks of the return, not of
# accidents. Ours stop after ten decisions, so nothing is guaranteed here.

# %% [markdown] tags=["instructor"] minutes=5
# *The proof of policy improvement*, where neither road nor policy draws. Let π be the base, T the
# end of the episode, $V^\pi_t$ what π earns from decision t on, and $Q^\pi_t(s, a)$ the same after
# the action a. π′ takes the best action by $Q^\pi_t$.
# 1. The best of nine is at least the policy's own: $\max_a Q^\pi_t(s, a) \ge V^\pi_t(s)$.
# 2. At the last decision π′ earns $\max_a Q^\pi_{T-1}(s, a)$, so $V^{\pi'}_{T-1} \ge V^\pi_{T-1}$.
# 3. Assume $V^{\pi'}_{t+1} \ge V^\pi_{t+1}$ in all states.
# 4. π′ takes $a^* = \arg\max_a Q^\pi_t(s, a)$ and earns $V^{\pi'}_t(s) = r + V^{\pi'}_{t+1}(s')$.
# 5. By line 3 this is at least $r + V^\pi_{t+1}(s') = Q^\pi_t(s, a^*)$.
# 6. By line 1 that is at least $V^\pi_t(s)$. By induction it holds for all t.
#
# Ask for the state in which the rollouts of plain SAC *should* show the way out, and which sequence
# of actions they would have to try. Count: nine to the power of how many? The planner of the course
# searches sequences, keeps 200 of them, and takes a hundred times as long.

# %% [markdown]
# ## Round 3: a shield, and a model that is wrong
#
# The **shield** does less: it follows the base policy, and takes the best of the nine only where the
# imagined drive of the policy's *own* action ends in an accident.
#
# **Exercise (8 min, ●●○).** Write the shield for many roads at once.


# %%
def shield(actions, values, accidents):
    """The shield's actions, (roads,), from the base's actions (roads,), in 0..8.

    values: of the nine imagined drives, (roads, 9); accidents: whether each ends in one, the same.
    """
    # solution: the exercise's own


check.shield(shield)

# %%
guard = own_code.yours_or_ours("shield", doing="Driving")
guarded = bc.drive_episodes(imagined_road.shielded(guard, agent, horizon=10), roads)
drives_of = {"alone": alone, "with the look-ahead": ahead, "with the shield": guarded}
table(*figures.compared(drives_of))

# %% [markdown]
# **See.** Where the agent's own drive ends in an accident, both take the best of nine. So they first
# differ at a decision with no accident in sight. In these drives the look-ahead earns more.
#
# So far the imagined road was the true one, which a real car does not have. Now we change the
# *imagined* road in six of the study's nine ways; the true one stays.
# <!-- claim: len(MODELS) == 1 + 9 and len(WRONG) == 6 -->

# %% tags=["hide-input"]
table(["the imagined road", "what is wrong with it"], figures.MEANINGS.items())

# %% [markdown]
# > **Predict.** Ten agents of PPO after cloning (lesson [[the_second_trap]]) drive with each of
# > the wrong models. With one model every drive with the look-ahead ends in an accident. Which one?

# %%
predict("looking_ahead.4", "Which error ends every drive in an accident?", list(figures.MEANINGS))

# %% tags=["nbval-ignore-output"]
predicted("looking_ahead.4")
bc.show(figures.wrong_models(study))

# %% [markdown]
# **See.** With the exact model these agents have no accident. With everything a second late each of
# {{ ahead('ppo_cloned', model=LATE).drives | , }} drives has one, and nearly each with the shield.
# With {{ worse_than_alone('ppo_cloned', 'rollouts') }} of the six wrong models the look-ahead
# crashes more often than the agents alone (the dashed line), the shield with {{
# worse_than_alone('ppo_cloned', 'shield') }}. With each of them the shield changes fewer actions
# (not shown), and crashes less.
# <!-- claim: ahead('ppo_cloned').accidents == ahead('ppo_cloned', 'shield').accidents == 0 -->
# <!-- claim: ahead('ppo_cloned', model=LATE).accidents == ahead('ppo_cloned', model=LATE).drives and
#   per_thousand('ppo_cloned', 'shield', model=LATE) > 990 -->
#
# **Explain.** If everything is late, the ego's last action is missing. Whether that is why is open:
# the late others are also moved on.
# <!-- claim: all(per_thousand('ppo_cloned', 'shield', m) < per_thousand('ppo_cloned', model=m) for m
#   in WRONG) -->
# <!-- claim: all(ahead('ppo_cloned', 'shield', model=m).overruled < ahead('ppo_cloned',
#   model=m).overruled for m in WRONG) -->

# %% [markdown] tags=["instructor"] minutes=5
# Which errors can a car measure while it drives? It can compare what it imagined a second ago with
# what came. Ask how it should act when the two differ. And who checks the checker: a shield whose
# model is late does not know that it is late.

# %% [markdown]
# ## Round 4: a model that is learned
#
# A car has no simulator of its neighbours, but it has its own drives. From them five small networks
# learn what follows the agent's 26 numbers and an action: the next 26 numbers, the reward, and
# whether an accident ends the drive. Each future is imagined in all five; the mean value counts.
#
# Our agent learns such a model from 200 of its own drives, and looks ahead in it.

# %% tags=["nbval-ignore-output"]
learned = learned_from(transitions_of(agent, bc.held_out_seeds(41, 200)), updates=500)
drives_of = {"alone": alone}
for name, form in figures.LEARNED_FORMS.items():
    drives_of[f"with {name}"] = bc.drive_episodes(ImaginedAhead(agents[0], learned, form), roads)
table(*figures.compared(drives_of))

# %% tags=["nbval-ignore-output"]
table(*figures.promised(agents[0], learned, roads))

# %% [markdown]
# **See.** The look-ahead now crashes more often than the agent alone. At the first decision $\hat
# Q$ (ten seconds and W) is about right for the agent's own action, and too high for the other
# eight: the best of nine picks such guesses, as a critic's target can (lesson [[recorded_drives]]).
# (Yours can differ a little.)
#
# > **Predict.** The model gets {{ further() }} more drives.
# > Either the agent drives them alone, and two of three end well. Or the look-ahead drives them, in
# > the model that it has so far, and most end in an accident. After which does it crash less?
# <!-- claim: abs(per_thousand('bootstrapped', 'alone') - 333) < 33 -->
# <!-- claim: (learned('mean of five')[:-1] > 800).all() -->

# %%
choices = ["the agent's drives", "the look-ahead's drives", "no difference"]
predict("looking_ahead.5", "After which does the look-ahead crash less?", choices)

# %%
predicted("looking_ahead.5")
bc.show(figures.learned(shipped_experiment("learned-model"), study))

# %% [markdown]
# **See.** Means of ten agents (with models: {{ learned_model.TESTS }} roads each):
#
# | who drives | accidents in 1,000 | return |
# | --- | --- | --- |
# | the agents alone | {{ per_thousand('bootstrapped', 'alone') | .0f }} | {{
# ahead('bootstrapped', 'alone').returns.value | .0f }} |
# | the shield, after {{ learned_model.DRIVES }} drives of the agent | {{ learned('shield')[0] | .0f
# }} | {{ learned('shield', 'returns')[0] | .0f }} |
# | the look-ahead, after these and {{ further() }} drives of its own | {{
# learned('mean of five')[-1] | .0f }} | {{ learned('mean of five', 'returns')[-1] | .0f }} |
# | the control: after {{ learned_model.ROUNDS * learned_model.DRIVES }} drives of the agent | {{
# learned_without('mean of five') | ,.0f }} | {{ learned_without('mean of five', 'returns') | .0f }} |
#
# With the look-ahead's drives {{ fewer_rows() }} of the ten models learned from *fewer* decisions.
# <!-- claim: learned('mean of five')[0] > 990 and learned_without('mean of five') > 990 and
#   learned('mean of five')[-1] < 0.5 * learned_without('mean of five') and
#   (np.diff(learned('mean of five')) < 0).all() -->
# <!-- claim: len(learning()) == 10 and learned_model.ROUNDS == 4 -->
#
# **Explain.** It looks like the remedy of lesson [[demonstrations]]: learn where the driver's own
# decisions lead. *Open*: would drives with other new actions do as well? {{ still_worse() }} of the
# ten still crash more than alone. The shield gains little from more drives of either kind.
# <!-- claim: abs(learned('shield')[-1] - learned('shield')[0]) < 30 and
#   abs(learned_without('shield') - learned('shield')[0]) < 30 -->

# %% [markdown] tags=["instructor"] minutes=4
# Ask what an honest learned model would have to say besides a number: how sure it is. Five networks
# that agree can be wrong together, where none of them has a row.

# %%
compare_predictions(
    "looking_ahead",
    {
        1: explorable.last_chance(drive, agent),
        2: figures.accidents(ahead),
        3: "some, and some crash more",
        4: "everything a second late",
        5: "the look-ahead's drives",
    },
)

# %% [markdown]
# ## What you now know
#
# 1. A rollout takes one action, follows a policy, and adds an estimate of what comes after the
#    horizon.
# 2. The best of nine improves one decision, without training. The rest of each imagined drive is the
#    base policy's: of nine stuck agents some get out, and some do not.
# 3. A wrong model costs: with four of six the look-ahead crashes more often than PPO's agents alone.
# 4. With each of the six the shield crashes less than the look-ahead.
# 5. With a model from the agent's own drives the look-ahead crashes nearly always. Its own drives
#    correct it in part.
# <!-- claim: worse_than_alone('ppo_cloned', 'rollouts') == 4 and len(WRONG) == 6 -->
#
# **Three questions to think about**
# - The late car knows which action it took a second ago. How could it look ahead without an error?
# - What would rollouts of rollouts do, and what would they cost?
# - Your agent collects its drives with a tenth of its actions drawn at random. What would its model
#   learn that it did not know, and what would it no longer see?

# %% [markdown] tags=["instructor"] minutes=3
# Answers to the three questions. (1) In the exact model it imagines that action first, from the late
# road: this gives the road as it is now, and from there the nine. (2) A second improvement: each of
# the 90 imagined decisions needs 90 of its own, so a decision costs about 8,000; it would find what is
# two decisions away. (3) It would see the other eight actions near the agent's path. But an agent
# that acts at random now and then crashes early, so the drives would say little about later seconds.
# Whether it helps has to be tried, with each agent: `transitions_of` takes any policy.

# %% [markdown]
# **Read on**: Tesauro and Galperin (1996), *On-line Policy Improvement using Monte-Carlo Search*.
# Ross and Bagnell (2012), *Agnostic System Identification for Model-Based Reinforcement Learning*
# (arXiv 1203.1007). Chua et al. (2018), *Deep Reinforcement Learning in a Handful of Trials* (arXiv
# 1805.12114).
#
# **Try**: `bootcourse evaluate runs/mine --lookahead 10`, with your own agents.
# Next: [other ways to use a teacher](other_ways.ipynb).

# %% [markdown] tags=["instructor"]
# **On the board.** A tree: one road, nine first actions, and after each the same driver; one of
# nine branches bold.
#
# **To discuss.** Who checks a shield whose model of the road is wrong?
