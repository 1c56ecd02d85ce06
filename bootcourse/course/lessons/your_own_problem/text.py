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
# # Your own problem
#
# Does a teacher help elsewhere, too?
#
# **What you will be able to do**
# - give an agent a teacher in an environment of your choice, and compare methods fairly;
# - predict from a teacher's errors whether cloning is enough;
# - compute from which bonus on a loop pays more than the goal.
#
# **Time** 55 minutes, without your own problem and the challenge; running it takes about one
# minute. **It builds on** lessons [[soft_constraint]], [[learning_from_demonstrations]] and
# [[your_teacher]].

# %%
import bootcourse as bc
import gymnasium as gym
from bootcourse.course import (
    check,
    compare_predictions,
    own_code,
    predict,
    predicted,
    progress,
)
from bootcourse.course.lessons.your_own_problem import explorable, figures, loops
from bootcourse.research.problems import PROBLEMS

progress("your_own_problem")

# %% [markdown]
# ## Look first
#
# MountainCar is a car in a valley. It pays −1 per decision until the car reaches the flag, at
# position 0.5, or 200 decisions are over.
#
# > **Predict.** A driver pushes to the right in every decision. How far does the car come?

# %%
choices = ["to the flag", "close to the flag", "not out of the valley"]
predict(
    "your_own_problem.1", "How far does the car come if it is always pushed to the right?", choices
)

# %%
predicted("your_own_problem.1")
bc.show(figures.climbs())

# %% [markdown]
# **See.** To get up, the car first has to drive away from the flag. The reward does not say so:
# all drives that miss the flag earn the same. Where does the rule of one line push to the left,
# where to the right?
# <!-- claim: loops.climbed(lambda position, speed: 2).max() < 0 -->
# <!-- claim: loops.climbed(lambda position, speed: 2 if speed >= 0 else 0)[-1] >= 0.5 -->

# %% [markdown]
# ## Round 1: does a teacher help?
#
# **Exercise (8 min, ●●○).** Write the rule of MountainCar. All 20 episodes must reach the flag.


# %%
def climb_rule(position, speed):
    """0: push left, 1: not at all, 2: right. position: flag at 0.5; speed: + to the right."""
    # solution: the exercise's own


check.climb_rule(climb_rule)

# %% [markdown]
# Now your rule is the teacher. `bc.compare` trains five agents of each method and tests them in the
# same episodes. Look for three things:
#
# - *Equal decisions*: with equal episodes, an agent that finds the flag sooner would practise less.
#   What the teacher drives is not counted.
# - *Controls*: plain SAC has no teacher, and the clone has nothing else.
# - *Intervals* over agents, not episodes: of length 0 where all score alike.

# %% tags=["nbval-ignore-output"]
climb = own_code.yours_or_ours("climb_rule", doing="Teaching")
methods = {
    "plain SAC": bc.settings_for("sac", gamma=0.99),
    "clone": bc.settings_for("bc"),
    "soft constraint": bc.settings_for("soft", gamma=0.99),
}
how = {"seeds": 5, "tests": 20, "progress": False}
car, teacher = PROBLEMS["mountain-car"].make_env, loops.teacher(climb)
bc.compare(methods, decisions=2_000, make_env=car, teacher=teacher, **how)

# %% [markdown]
# **See.** Hardly any drive of plain SAC reaches the flag. With a teacher most do, even the clones'.
# <!-- claim: score('mountain-car', 'good', 'SAC') == 0 and min(score('mountain-car', 'good', m) for
#   m in ('cloning', 'soft')) > 0.9 and abs(score('mountain-car', 'good', 'soft', 'returns') -
#   score('mountain-car', 'good', 'cloning', 'returns')) < 5 -->
#
# **On yours** (write it down): which environment, which rule? How long is the way without reward?

# %% [markdown] tags=["instructor"] minutes=5
# Collect problems of their own first: what is the reward, how long is the way without one, who can
# write a rule? Then ask of each rule which kind of error it makes. Rules that people write may err
# systematically: they forget a situation.

# %% [markdown]
# ## Round 2: what if the teacher errs?
#
# A **random** teacher takes a wrong action in some states, chosen as if at random, and always the
# same there. On MountainCar it is right in {{ 100 *
# elsewhere_claims.PROBLEMS['mountain-car'].right | .0f }} % of the *states*. A **systematic** one
# errs in one region: on MountainCar at each position above 0.1.
#
# > **Predict.** On MountainCar our rule, the good teacher, earns {{ earned('good') | .0f }}, and
# > the random one {{ earned('random') | .0f }}. A network clones the random one, and drives by its
# > most probable action. What does the clone earn?

# %%
choices = ["less than its teacher", "about as much as its teacher", "about as much as the good one"]
predict("your_own_problem.2", "What does the clone of the random teacher earn?", choices)

# %%
predicted("your_own_problem.2")
bc.show(figures.returns())

# %% [markdown]
# **See.** The clones of each random teacher earn nearly what the good one does, or more; those of a
# systematic one about what it does, or less.
#
# *Which way is better depends on the problem.* With the random teacher each agent with the soft
# constraint beats each clone on CartPole (balance a pole: at most 500), and none on Lunar lander
# (land softly). With the systematic one all agents of the three other methods reach 500; on
# MountainCar they earn, on average, about what it does.
# <!-- claim: all(cells().scores(p, 'random', low).max() < cells().scores(p, 'random', high).min()
#   for p, low, high in (('cartpole', 'cloning', 'soft'), ('lander', 'soft', 'cloning'))) -->
# <!-- claim: {len(cells().scores(p, t, m)) for p, t in SHOWN for m in (*FOUR, 'SAC')} == {10} -->
# <!-- claim: all(score(p, 'random', 'cloning', 'returns') > score(p, 'random', 'the teacher',
#   'returns') + 20 and score(p, 'random', 'cloning', 'returns') > score(p, 'good', 'the teacher',
#   'returns') - (10 if p == 'mountain-car' else 25) for p in THREE) -->
# <!-- claim: all(score(p, 'systematic', 'cloning', 'returns') < score(p, 'systematic', 'the
#   teacher', 'returns') + 10 for p in THREE) -->
# <!-- claim: all((cells().scores('cartpole', 'systematic', m) == 500).all() and
#   abs(score('mountain-car', 'systematic', m, 'returns') - score('mountain-car', 'systematic', 'the
#   teacher', 'returns')) < 5 for m in FOUR if m != 'cloning') -->
#
# **Drag** *reach*: each square does what most squares around it say. The line is a drive, a spiral
# out of the valley. Which errors vanish, and which stay?

# %%
explorable.votes()

# %% [markdown]
# **See.** With reach 1 all drives by the random teacher's map reach the flag. The block of the
# systematic one stays: there the majority is wrong. A clone that has to give alike states one
# action takes the majority's, too.
# <!-- claim: [explorable.reached(t, 70, r) for t, r in (('random', 0), ('random', 1), ('systematic',
#   0), ('systematic', 1))] == [8, 20, 15, 15] -->
#
# **Exercise (10 min, ●●○).** Of n labels for two actions each is right with probability q,
# independently. How probable is a right majority?


# %%
def majority_right(right, votes):
    """P(the majority of `votes` labels is right), of each P = `right`; a tie counts half."""
    # solution: the exercise's own


check.majority_right(majority_right)

# %% [markdown]
# **Explain.** If independent labels are right in 70 %, the majority of 25 is right in {{ 100 *
# majority_right(0.7, 25) | .0f }} %.
#
# **On yours:** which kind of error does your rule make? Do states come back?

# %% [markdown] tags=["instructor"] minutes=6
# Let them defend their choice for one picture before they see it. If somebody says "both aids,
# because more is better", CartPole with the random teacher says otherwise. Ask what equal episodes
# mean on CartPole: there an agent that balances longer also practises more.

# %% [markdown]
# ## Round 3: how large may the bonus be?
#
# In DoorKey an agent fetches a key, opens a door and walks to a goal. The goal pays at most 1, the
# sooner the more, and nothing else pays. An episode has at most 100 decisions. Here a random
# teacher drives:

# %%
bc.show(figures.room(loops.longest_loop(), "This drive of the random teacher ends in a loop"))

# %% [markdown]
# The teacher errs in a state *whenever it comes back to it*, so some of its drives end in a loop.
# In a demonstration each decision pays the bonus c.
#
# > **Predict.** Agents learn from this teacher by both aids, soft constraint and demonstrations,
# > with the paper's c = 2. Do they reach the goal more often than agents of plain SAC?

# %%
choices = ["less often than plain SAC", "about as often", "more often"]
predict("your_own_problem.3", "How often do agents with both aids reach the goal?", choices)

# %%
predicted("your_own_problem.3")
bc.show(figures.bonuses())

# %% [markdown]
# **See.** With c = 2 and a flawed teacher the goal is hardly ever reached; with the good one both
# aids bear each c. But agents with its demonstrations *alone*, which hold no loop, reach the goal
# in {{ 100 * score('doorkey', 'good', 'demonstrations, c = 0', 'drawn_success') | .0f }} % of
# drives with c = 0, and in none with c = 2. A step back and forth could pay c again.
#
# These agents draw their actions. By their most probable ones, those with a flawed teacher do worse
# than plain SAC even with c = 0. The random teacher's clones do about as badly as it does ({{ 100 *
# score('doorkey', 'random', 'the teacher') | .0f }} %): DoorKey has few states; each may keep its own
# label.
# <!-- claim: all(np.diff(by_bonus(t)).max() < 0 and round(100 * by_bonus(t)[-1]) == 0 for t in
#   ('random', 'systematic')) and by_bonus('good').min() > 0.99 -->
# <!-- claim: (cells().scores('doorkey', 'good', 'demonstrations', 'drawn_success') == [0] *
#   10).all() and abs(score('doorkey', 'random', 'cloning', 'drawn_success') - score('doorkey',
#   'random', 'the teacher')) < 0.05 and score('doorkey', 'good', 'the teacher') == 1 -->
# <!-- claim: all(score('doorkey', t, 'both, c = 0') < score('doorkey', t, 'SAC') - 0.1 for t in
#   ('random', 'systematic')) -->

# %% [markdown]
# **Drag** c until the loop is worth as much as the way to a goal of 1. Does a longer way change
# this c?

# %%
explorable.loop_or_goal()

# %% [markdown]
# **Exercise (15 min, ●●●).** A loop earns `reward` + c in each decision, for ever: the time limit
# is no end for the critic (lesson [[update_and_loop]]). The way to the goal has `decisions`
# decisions. Each earns `reward` + c, too, and the last one also `goal`; then the episode ends. At
# which c are both worth the same, discounted?


# %%
def drowning_bonus(reward, goal, decisions, gamma):
    """The c above which the loop is worth more than the way to the goal."""
    # solution: the exercise's own


check.drowning_bonus(drowning_bonus)

# %% [markdown]
# **Explain.** For a fixed goal the threshold is c = (1 − γ) · goal / γ − reward, however long the
# way is: here at most {{ drowning_bonus(0, 1, 1, PROBLEMS['doorkey'].gamma) | .2f }}. *It is a
# warning, not an edge.* In training c is not paid for ever: with the random teacher {{ 100 *
# by_bonus('random')[1] | .0f }} % of drives reach the goal at c = 0.03, and {{ 100 *
# by_bonus('random')[2] | .0f }} % at 0.1.
# <!-- claim: math.isclose(drowning_bonus(0, 1, 1, 0.97), drowning_bonus(0, 1, 90, 0.97)) -->
# <!-- claim: list(BONUSES)[1:3] == ['c = 0.03', 'c = 0.1'] -->
#
# **On yours:** what is the threshold, if an episode ends at a goal?

# %% [markdown] tags=["instructor"] minutes=6
# Ask for a bonus that cannot be earned in a circle. A potential (lesson [[the_second_trap]]) is
# one: what a circle gains it gives back.

# %% [markdown]
# ## Round 4: your problem
#
# Any gymnasium environment with vector observations of order one and discrete actions will do. Our
# example: CartPole, with a rule that looks at the pole's angle alone.


# %%
def my_env(n, wrappers=()):
    name = "CartPole-v1"  # yours
    return gym.make_vec(name, n, vectorization_mode="sync", wrappers=wrappers)


def own_rule(seen):
    return int(seen[2] > 0)  # yours: push to where the pole leans


policy = bc.teacher_policy(own_rule, None, n_actions=2)  # yours
driven = bc.drive_episodes(policy, range(50), make_env=my_env)
print(f"the rule itself earns {driven.returns.mean():.1f}")

# %% tags=["nbval-ignore-output"]
with_reward = bc.compare(methods, decisions=1_000, make_env=my_env, teacher=own_rule, **how)
print(with_reward)

# %% [markdown]
# **See.** The agents with the soft constraint earn several times what their teacher does. Did they
# need the reward? A control: in training reward and γ are 0, and so is the critic's target. The
# actor's KL and entropy are left.
#
# > **Predict.** What do they earn now, if the test counts rewards as before?

# %%
choices = ["less than the rule", "about as much as the rule", "several times as much"]
predict("your_own_problem.4", "What do the agents earn that trained without reward?", choices)


# %% tags=["nbval-ignore-output"]
def without_reward(n):
    return my_env(n, [lambda env: gym.wrappers.TransformReward(env, lambda reward: 0.0)])


predicted("your_own_problem.4")
soft = {"soft constraint": bc.settings_for("soft", gamma=0.0)}
control = bc.compare(soft, decisions=1_000, make_env=without_reward, teacher=own_rule, **how)
agents = control.results["soft constraint"].agents
for agent in agents:
    tested = bc.drive_episodes(agent.as_policy(), bc.held_out_seeds(1, 20), make_env=my_env)
    print(f"trained without reward, it earns {tested.returns.mean():.0f}")

# %% [markdown]
# Here is where each changes from left to right.

# %% tags=["nbval-ignore-output"]
clones = with_reward.results["clone"].agents
title = "With the soft constraint they go by angle and speed"
bc.show(figures.edges(agents, clones, title))

# %% [markdown]
# **Explain.** These five, too, earn several times what the rule does: *here that needs no reward*.
# A rule with about their edge, angle + speed > 0, earns {{ speed_rule_earns() | .0f }}. The clones'
# edges are steeper, and they earn less. Why labels by the angle alone teach this edge (own states?
# the loss? entropy?) stays open.
# <!-- claim: speed_rule_earns() > 450 -->
#
# **Now yours.** Exchange environment and rule, run these cells again, not the picture's, and put a
# number beside each of your lines:
#
# 1. *Is there a barrier?* Give plain SAC more decisions and η = 0.3 log(actions) first.
# 2. *What taught the agents?* Set reward and γ to 0.
# 3. *Which kind of error?* If it is random and states do not come back, the clone may be enough. If
#    they do, test drawn actions, too.

# %%
compare_predictions(
    "your_own_problem",
    {
        1: "not out of the valley",
        2: "about as much as the good one",
        3: "less often than plain SAC",
        4: "several times as much",
    },
)

# %% [markdown]
# ## The challenge
#
# Train drivers for the course's road. You choose learner, teacher and training reward.
#
# - **Budget.** Five agents, seeds 0 to 4, one setting for all. Each makes {{ equal_decisions.BOARD
#   | , }} decisions in training; demonstrations are free.
# - **Test.** 1,000 held-out roads of a block that is drawn after everybody has handed in. An agent
#   drives alone, by its most probable actions.
# - **Hand in** the folder that `bc.save_runs(result, "challenge")` writes, and one page: what you
#   changed and why; what you predicted; your table, with intervals, accidents, plain SAC and the
#   clone; one thing that did not work; the decisions of all your tries.
# - **Rank.** By return. Entries that a rank test (lesson [[your_teacher]]) cannot tell from the best
#   share its place; the page decides. An entry with a teacher must beat its teacher's clone.
#
# An example with a tenth of the budget:

# %%
BUDGET, BLOCK = 20_000, 2026  # decisions of each agent: the challenge has ten times as many
settings = bc.with_seeds(bc.settings_for("ppo_cloned", gamma=0.97, batch=512), 5)  # yours
entry = bc.Training(settings, episodes=50_000)
result = entry.run(progress=False, stop=lambda: entry.decisions >= BUDGET * len(settings))

# %% tags=["nbval-ignore-output"]
bc.board(result, block=BLOCK)

# %% [markdown]
# **See.** Which drivers do your agents beat?
#
# ## What you now know
#
# 1. Where no reward tells drives apart, a teacher can show the way. Compare at equal decisions,
#    with controls: plain SAC, the clone.
# 2. A clone can outvote random errors where states are alike; systematic ones stay.
# 3. Whether a clone or the soft constraint is better depends on the problem.
# 4. A bonus for each decision can make a loop worth more than the goal.
# 5. To know whether an agent needs the reward, train it without.
#
# **Three questions to think about**
# - Where does the rule of the road err systematically, and what did the agents correct?
# - The course's road has no goal that ends the drive. What then bounds c?
# - When would you trust one of Round 2's six panels for another problem?

# %% [markdown] tags=["instructor"] minutes=5
# Answers to the three questions. (1) Its sight of 200 m keeps it slow behind the traffic; all good
# agents drive faster. (2) The formula gives no threshold there; what counts is which states are
# paid. Staying behind trap 1 pays about 0.16 a decision and never ends, so every c > 0 that is paid
# there for ever would help staying; the demonstrations leave the trap, so they pay for leaving. (3)
# The horizon without reward, the kind of the error, whether states come back: there are few
# problems, chosen by us. In Round 4, with the larger angle, they earn about what the rule does.

# %% [markdown]
# **Read on**: the report's page *When does a sub-optimal teacher help?*,
# `assets/report/elsewhere.md`. Chevalier-Boisvert et al., *Minigrid & Miniworld* (arXiv
# 2306.13831), where DoorKey is from.

# %% [markdown] tags=["instructor"]
# **On the board.** A table: problems as rows, methods as columns, a colour for the share of the gap
# that is closed; one row left empty for the room's own problem.
#
# **To discuss.** Whose rule errs at random, and whose systematically?
