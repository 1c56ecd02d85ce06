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
# **What you will be able to do**
# - give an agent a teacher in an environment of your choice, and compare methods fairly;
# - tell which of a teacher's errors its clone outvotes, and what an agent answers that its teacher ignores;
# - compute the bonus above which a loop pays more than the goal.
#
# **Time** 50 minutes, without your own problem and the challenge; running it takes about half a minute. **It
# builds on** lessons [[soft_constraint]], [[learning_from_demonstrations]] and [[your_teacher]].

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
    table,
)
from bootcourse.course.lessons.your_own_problem import explorable, figures, loops
from bootcourse.research.problems import PROBLEMS

progress("your_own_problem")

# %% [markdown]
# ## Look first
#
# Five questions to ask of any teacher, one in each round:
# 1. Does it help?
# 2. Did the agents need the reward?
# 3. Which errors does it make?
# 4. Do states come back?
# 5. What pays in a loop?
#
# We begin with MountainCar, a car in a valley. Each decision pays −1 until the car reaches the flag at
# position 0.5, or 200 decisions are over.

# %%
bc.show(figures.climbs())

# %% [markdown]
# **See.** The car has to drive *away* from the flag for a while, and the reward does not say so.
# <!-- claim: loops.climbed(lambda position, speed: 2).max() < 0 -->
# <!-- claim: loops.climbed(lambda position, speed: 2 if speed >= 0 else 0)[-1] >= 0.5 -->

# %% [markdown]
# ## Round 1: does a teacher help?
#
# **Exercise (8 min, ●●○).** Write a rule for MountainCar. All 20 episodes must reach the flag.


# %%
def climb_rule(position, speed):
    """0: push left, 1: not at all, 2: right. position: flag at 0.5; speed: + to the right."""
    # solution: the exercise's own


check.climb_rule(climb_rule)

# %% [markdown]
# Your rule is the teacher. `bc.compare` trains five agents of each method for equally many *decisions*;
# demonstrations are free. Two methods are controls: plain SAC has no teacher, the clone no reward.

# %% tags=["nbval-ignore-output"]
climb = own_code.yours_or_ours("climb_rule", doing="Teaching")
methods = {
    "plain SAC": bc.settings_for("sac", gamma=0.99),
    "clone": bc.settings_for("bc", demonstration_episodes=50),
    "soft constraint": bc.settings_for("soft", gamma=0.99),
}
how = {"seeds": 5, "tests": 5, "progress": False}
car, teacher = PROBLEMS["mountain-car"].make_env, loops.teacher(climb)
print(f"the rule itself earns {loops.earns(teacher, car):.0f}")
table(*loops.brief(bc.compare(methods, decisions=1_000, make_env=car, teacher=teacher, **how)))

# %% [markdown]
# **See.** (Yours will differ.) Without a teacher no drive reaches the flag; with your rule most do. A drive
# that reaches it sooner earns more. The clone, which saw no reward, earns no less than the soft constraint. So
# far the rule did the work.
# <!-- claim: score('mountain-car', 'good', 'SAC') == 0 and min(score('mountain-car', 'good', m) for
#   m in ('cloning', 'soft')) > 0.9 -->
#
# **On yours.** Write a rule for an environment of your choice. Ours is CartPole: balance a pole, where each
# of at most 500 decisions pays 1.


# %% tags=["nbval-ignore-output"]
def pole(n):  # yours: a gymnasium environment with discrete actions
    return gym.make_vec("CartPole-v1", n, vectorization_mode="sync")


def angle_rule(seen):  # seen: a vector, whose numbers should be about −1 to 1
    return int(seen[2] > 0)  # push to where the pole leans


my_env, own_rule = pole, angle_rule  # yours
print(f"the rule itself earns {loops.earns(own_rule, my_env):.0f}")
table(*loops.brief(bc.compare(methods, decisions=1_000, make_env=my_env, teacher=own_rule, **how)))

# %% [markdown]
# **See.** The clone earns what the rule earns, the soft constraint many times as much. Did its reward do
# that?

# %% [markdown] tags=["instructor"] minutes=5
# Collect problems of their own first: what is the reward, does it tell early drives apart, who can write a
# rule? Then ask of each rule which kind of error it makes. Rules that people write may err systematically:
# they forget a situation.

# %% [markdown]
# ## Round 2: did the agents need the reward?
#
# We take the reward away (all rewards 0, γ = 0). Only the soft constraint pulls five agents to the angle
# rule.
#
# > **Predict.** We test them after 500, 1,000 and 3,000 decisions. How do they compare with the rule?

# %%
more = "more, most after 1,000 decisions"
choices = ["less", "about as much", "more, most after 3,000 decisions", more]
predict("your_own_problem.1", "What do agents without reward earn?", choices)

# %% tags=["nbval-ignore-output"]
budgets = (500, 1_000, 3_000)
predicted("your_own_problem.1")
bc.show(figures.edges(loops.trained(budgets, pole, angle_rule, pays=0, gamma=0)))

# %% [markdown]
# **See.** On one side of its line an agent pushes left, on the other right. The teacher's is upright, because
# for it only the angle counts. The agents' lines are nearly level at first and turn upright later. The return
# rises and falls: *one budget can mislead.*
#
# Does it fall because the lines turn upright? We let rules with such lines drive:

# %% tags=["nbval-ignore-output"]
for slope in (1, 3, 6):
    line = loops.earns(lambda seen, slope=slope: int(slope * seen[2] + seen[3] > 0), pole)
    print(f"slope · angle + speed > 0, slope {slope}: return {line:.0f}")

# %% [markdown]
# **See.** No: these rules earn almost the most possible, 500. The picture shows the agents with the cart at
# rest in the middle, and the rules do not look at the cart at all.
# <!-- claim: loops.earns(lambda seen: int(4 * seen[2] + seen[3] > 0), pole) > 490 -->
#
# > **Predict.** We test the agents of 3,000 decisions once more and hide the cart: its place and speed are 0
# > in what they see. What do they earn?

# %%
choices = ["less than before", "about as much: their teacher ignores the cart", "almost 500"]
predict("your_own_problem.2", "What do they earn with the cart hidden?", choices)

# %% tags=["nbval-ignore-output"]
predicted("your_own_problem.2")
agents, earned = loops.trained(budgets, pole, angle_rule, pays=0, gamma=0)[3_000]
tests = {"as it is": earned, "hidden": loops.cart_hidden(agents, pole)}
rows = [[name, *(f"{each:.0f}" for each in returns)] for name, returns in tests.items()]
table(["the cart", *(f"agent {i}" for i in range(1, 6))], rows)

# %% [markdown]
# **See.** With the cart hidden they earn almost 500. So it is their answer to the *cart* that ends their
# drives early, although their teacher ignores the cart.
# <!-- claim: unpaid('hidden', 3_000).min() > 450 and unpaid('returns', 3_000).max() < 400 -->
#
# **Explain.** The reaction to the cart makes them better copies. We have ten such agents. They do as their
# teacher in {{ 100 * unpaid('copied', 3_000).mean() | .0f }} % of their decisions; in the same states with the
# cart hidden, in {{ 100 * unpaid('copied hidden', 3_000).mean() | .0f }} %. How can that be? The teacher acts by
# the angle alone, but the agents also react to the pole's speed. In their drives the cart moves to one side
# when the pole turns to the other (correlation
# {{ f"{unpaid('together', 3_000).mean():.2f}".replace('-', '−') }}). If an agent reacts to both speeds in the
# same way, the two reactions can cancel, so that only the angle decides. But this teacher earns only
# {{ teacher_earns() | .0f }}.
# <!-- claim: unpaid('together', 3_000).mean() < -0.7 and unpaid('copied', 3_000).mean() > unpaid('copied
#   hidden', 3_000).mean() + 0.15 and teacher_earns() < 60 -->
#
# The same with the reward:

# %% tags=["nbval-ignore-output"]
for pays, gamma in ((0, 0), (1, 0.99)):  # on yours
    earned = loops.returns(budgets, my_env, own_rule, pays=pays, gamma=gamma)
    print("with reward   " if pays else "without reward", earned)

# %% [markdown]
# **See.** Up to 3,000 decisions the rows are about alike: what the agents earn there, the reward did not
# bring. Ten agents of each kind went on (means):
#
# {{ by_budget() }}
#
# After 8,000 decisions the reward helps: with it each of the ten earns more than each of the ten without. But
# they earned more after 1,000, on average. To stop at the best budget, find it on other roads than the test's.
# <!-- claim: unpaid('returns', 1_000, 'with reward').mean() > 2 * unpaid('returns', 8_000, 'with reward').mean() -->
# <!-- claim: unpaid('returns', 8_000, 'with reward').min() > unpaid('returns', 8_000).max() -->
# <!-- claim: all(abs(unpaid('returns', n, 'with reward').mean() - unpaid('returns', n).mean()) < 60 for n in
#   (500, 1_000, 3_000)) and len(unpaid('returns', 500)) == len(unpaid('returns', 500, 'with reward')) == 10 -->

# %% [markdown] tags=["instructor"] minutes=5
# Ask before the cart is hidden: which of the four numbers does the teacher use, and which *can* an agent use
# to do the same? Teacher and copy agree where the copy drives; the answer to the cart is a shortcut there.
# Read the table's last two rows together: the agents earn most when they copy least, half of the decisions.
# <!-- claim: 0.4 < unpaid('copied', 1_000).mean() < 0.6 and unpaid('returns', 1_000).mean() > 2 *
#   max(unpaid('returns', n).mean() for n in (500, 3_000, 8_000)) -->

# %% [markdown]
# ## Round 3: which errors does the teacher make?
#
# A **random** teacher errs in states drawn at random, each time that it comes there. A **systematic** teacher
# errs everywhere in one region. The **good** teacher makes neither error.
#
# > **Predict.** On MountainCar the good teacher earns {{ earned('good') | .0f }}. The random teacher is right in
# > {{ 100 * elsewhere_claims.PROBLEMS['mountain-car'].right | .0f }} % of the states and earns
# > {{ earned('random') | .0f }}. What does its clone earn?

# %%
choices = ["less than its teacher", "about as much as its teacher", "about as much as the good one"]
predict("your_own_problem.3", "What does the random teacher's clone earn?", choices)

# %%
predicted("your_own_problem.3")
bc.show(figures.clones())

# %% [markdown]
# **See.** Clones of the random teachers earn far more than their teachers. Clones of the systematic teachers
# earn about as much as theirs, on Lunar lander far less.
# <!-- claim: {len(cells().scores(p, t, 'cloning')) for p, t in SHOWN} == {10} -->
# <!-- claim: all(score(p, 'random', 'cloning', 'returns') > score(p, 'random', 'the teacher',
#   'returns') + 20 and score(p, 'random', 'cloning', 'returns') > score(p, 'good', 'the teacher',
#   'returns') - (10 if p == 'mountain-car' else 25) for p in THREE) -->
# <!-- claim: all(abs(score(p, 'systematic', 'cloning', 'returns') - score(p, 'systematic', 'the
#   teacher', 'returns')) < 10 for p in THREE if p != 'lander') and cells().scores('lander', 'systematic',
#   'cloning', 'returns').max() < score('lander', 'systematic', 'the teacher', 'returns') -->
# <!-- claim: score('lander', 'systematic', 'cloning', 'returns') < score('lander', 'systematic', 'the
#   teacher', 'returns') / 2 -->
#
# **Drag** *reach*: each square now does what most squares within this distance say. Which errors vanish?

# %%
explorable.votes()

# %% [markdown]
# **See.** With reach 1 all drives by the random teacher's map reach the flag. The systematic teacher's block
# of errors stays: there the majority is wrong.
# <!-- claim: [explorable.reached(t, 70, r) for t, r in (('random', 0), ('random', 1), ('systematic',
#   0), ('systematic', 1))] == [8, 20, 15, 15] -->
#
# > **Predict.** So far a clone took the most probable action of its policy π. Now the random
# > teachers' clones *draw* from π. What do they earn?

# %%
choices = ["as much as the good teacher", "about as much as their teacher", "less than both"]
predict("your_own_problem.4", "What do clones that draw earn?", choices)

# %%
predicted("your_own_problem.4")
bc.show(figures.clones_that_draw())

# %% [markdown]
# **Explain.** The errors are still in π. The most probable action follows the majority of similar states; a
# drawn action follows one of them, right or wrong.
# <!-- claim: all(abs(score(p, 'random', 'cloning', 'drawn_returns') - score(p, 'random', 'the
#   teacher', 'returns')) < 15 for p in THREE) -->

# %% [markdown] tags=["instructor"] minutes=3
# Ask before the panel: what does a clone do with two labels that contradict each other?

# %% [markdown]
# ## Round 4: do states come back?
#
# In DoorKey an agent fetches a key, opens a door and walks to a goal, in at most 100 decisions. Only the goal
# pays: at most 1, the sooner the more.

# %%
bc.show(figures.room(loops.drive_in_a_loop(), "Here DoorKey's random teacher ends in a loop"))

# %% [markdown]
# **See.** The agent stands still: here the teacher answers "pick up", which changes nothing. So it answers the
# same again, and gives one wrong label {{ loops.drive_in_a_loop().count(loops.drive_in_a_loop()[-1]) }} times.
# <!-- claim: answer_in_the_loop() == PICK_UP -->
#
# How many of the teacher's wrong labels does the clone outvote?

# %% tags=["nbval-ignore-output"]
for name in ("mountain-car", "doorkey"):
    seen, taught, cloned, good = loops.labels(name)
    outvoted = (cloned == good)[taught != good].mean()
    print(f"{name}: {len(seen):,} labels, {loops.states(seen):,} states, {outvoted:.0%} outvoted")

# %% [markdown]
# **See.** A vote helps where similar states need the same action. In
# {{ 100 * like_the_nearest('mountain-car') | .0f }} % of MountainCar's states the nearest state does, in DoorKey
# only in {{ 100 * like_the_nearest('doorkey') | .0f }} %.
# <!-- claim: like_the_nearest('mountain-car') > 0.9 and like_the_nearest('doorkey') < 0.5 -->
# <!-- claim: outvoted('mountain-car').mean() > 0.9 and not outvoted('doorkey').any() -->
# <!-- claim: [len(seen) > 50 * loops.states(seen) for seen, *_ in map(labels, ('mountain-car',
#   'doorkey'))] == [False, True] -->

# %% tags=["nbval-ignore-output"]
# On yours: do the states of your rule come back? If the two numbers are equal, none does exactly.
seen = bc.demonstrate(50, None, teacher=own_rule, make_env=my_env).observations
print(f"{len(seen):,} labels, {loops.states(seen):,} states")

# %% [markdown] tags=["instructor"] minutes=3
# Ask for the vote in DoorKey before the count: which states are similar there, and do they need the same
# action?

# %% [markdown]
# ## Round 5: what pays in a loop?
#
# > **Predict.** Agents get both aids from DoorKey's random teacher, soft constraint and demonstrations, with
# > the paper's bonus, c = 2. In the test they draw their actions. Do they reach the goal more often than plain
# > SAC?

# %%
choices = ["less often than plain SAC", "about as often", "more often"]
predict("your_own_problem.5", "How often do agents with both aids reach the goal?", choices)

# %%
predicted("your_own_problem.5")
bc.show(figures.bonuses())

# %% [markdown]
# **See.** With c = 2 and a flawed teacher hardly any drive reaches the goal, with the good teacher nearly
# all. Each decision of a demonstration earns c, so a loop earns it again and again. In Round 4's drives
# {{ wrong_states() }} wrong states hold {{ 100 * wrong_labels() | .0f }} % of the labels.
#
# That is with drawn actions. With the most probable ones the random teacher's agents reach the goal in
# {{ 100 * by_bonus('random', 'success')[0] | .0f }} of 100 drives at c = 0, in
# {{ 100 * by_bonus('random', 'success')[3] | .0f }} at 0.3 and in
# {{ 100 * by_bonus('random', 'success')[-1] | .0f }} at 2; plain SAC in
# {{ 100 * score('doorkey', 'none', 'SAC') | .0f }}. So the bonus is not all that harms.
# <!-- claim: by_bonus('random', 'success').max() < score('doorkey', 'none', 'SAC') - 0.2 -->
# <!-- claim: wrong_labels() > 0.8 and wrong_states() < 10 -->
# <!-- claim: all(np.diff(by_bonus(t)).max() < 0 and round(100 * by_bonus(t)[-1]) == 0 for t in
#   ('random', 'systematic')) and by_bonus('good').min() > 0.99 -->

# %% [markdown]
# **Drag** c until the loop and the way to the goal are worth the same.

# %%
explorable.loop_or_goal()

# %% [markdown]
# **Exercise (15 min, ●●●).** A demonstrated loop earns `reward` + c in each decision, for ever: the time
# limit is no end for the critic (lesson [[update_and_loop]]). The way to the goal has `decisions` decisions.
# Each earns `reward` + c, and the last one also `goal`; then the episode ends. At which c are both worth the
# same, discounted?


# %%
def drowning_bonus(reward, goal, decisions, gamma):
    """The c above which the loop is worth more than the way to the goal."""
    # solution: the exercise's own


check.drowning_bonus(drowning_bonus)

# %% [markdown]
# **Explain.** Your threshold depends on the reward, the goal's pay and γ, not on the way's length. In DoorKey
# it is at most {{ drowning_bonus(0, 1, 1, PROBLEMS['doorkey'].gamma) | .3f }} (the goal's pay itself falls
# with the way's length), on MountainCar
# {{ drowning_bonus(-1, 0, 120, PROBLEMS['mountain-car'].gamma) | .0f }}.
#
# The threshold is a warning, not a forecast: at c = 0.3, ten times DoorKey's,
# {{ 100 * by_bonus('random')[3] | .0f }} % of the drives with the random teacher still reach the goal.
# <!-- claim: list(BONUSES)[3] == 'c = 0.3' and 9 < 0.3 / drowning_bonus(0, 1, 1, 0.97) < 11 -->
# <!-- claim: math.isclose(drowning_bonus(0, 1, 1, 0.97), drowning_bonus(0, 1, 90, 0.97)) -->
#
# **Is it the loop?** With c = 2, goals in 100 drives:
#
# {{ loops_table() }}
#
# Without loops the agents reach the goal again if they draw their actions. With the most probable ones they
# stay far below plain SAC; why is open. And the bonus can harm without a loop: with demonstrations alone the
# good teacher's agents reach no goal; with c = 0 they do in
# {{ 100 * score('doorkey', 'good', 'demonstrations, c = 0', 'drawn_success') | .0f }} drives, drawn.
# <!-- claim: score('doorkey', 'random', elsewhere.WITHOUT_LOOPS) < 0.5 * score('doorkey', 'none', 'SAC') -->
# <!-- claim: score('doorkey', 'random', elsewhere.WITHOUT_LOOPS, 'drawn_success') > 0.8 and score('doorkey',
#   'random', 'both', 'drawn_success') == 0 -->
# <!-- claim: all(score('doorkey', 'good', 'demonstrations', of) == 0 for of in ('success', 'drawn_success')) and
#   min(score('doorkey', 'good', 'demonstrations, c = 0', of) for of in ('success', 'drawn_success')) > 0.5 -->

# %%
threshold = own_code.yours_or_ours("drowning_bonus", doing="Computing")
at = threshold(reward=-1, goal=0, decisions=120, gamma=0.99)  # yours, if it has a goal
print(f"MountainCar: {at:.2f}")

# %% [markdown] tags=["instructor"] minutes=6
# Ask for a bonus that cannot be earned in a circle. A potential (lesson [[the_second_trap]]) is one: what a
# circle gains it gives back. Ask how a bonus harms without a demonstrated loop. *Perhaps* the agent closes a
# loop of its own: a demonstrated decision, which pays c, and the way back.

# %%
compare_predictions(
    "your_own_problem",
    {
        1: more,
        2: "almost 500",
        3: "about as much as the good one",
        4: "about as much as their teacher",
        5: "less often than plain SAC",
    },
)

# %% [markdown]
# ## Finale: the challenge
#
# Train five drivers for the course's road, with any learner, teacher and training reward. Our entries with a
# teacher earn {{ entry_scores()[0] | .0f }} to {{ entry_scores()[-3] | .0f }}. Without one PPO earns
# {{ entry_scores()[-2] | .0f }}, plain SAC {{ entry_scores()[-1] | .0f }}.
#
# - **Budget**: five agents of one setting, seeds 0 to 4; {{ BOARD | , }} decisions each; demonstrations are
#   free.
# - **Test**: 1,000 held-out roads, drawn when all have handed in; most probable actions. If yours asks its
#   teacher there, say so.
# - **Hand in**: one page, and the folder that `bc.save_runs(enter(200_000), "challenge")` writes.
# - **Bar**: an entry with a teacher must beat plain SAC, {{ entry_scores()[-1] | .0f }}, else it has not shown
#   that it needs the teacher, and the teacher's clone (that of the course's rule earns
#   {{ clone_earns() | .0f }}).
#
# **The page** says what you predicted, what you changed and why, and what failed, and answers the five
# questions.


# %%
def enter(decisions):
    settings = bc.with_seeds(bc.settings_for("ppo_cloned", gamma=0.97, batch=512), 5)  # yours
    entry = bc.Training(settings, episodes=50_000)
    return entry.run(progress=False, stop=lambda: entry.decisions >= decisions * len(settings))


# %% [markdown]
# Rehearse (15 s): `bc.board(enter(20_000), block=7)`.
#
# ## What you now know
#
# 1. *Does a teacher help?* Compare with plain SAC and the clone, at equal decisions and several budgets.
# 2. *Did the agents need the reward?* Train without it, at several budgets. To see what else an agent learned,
#    hide what its teacher ignores.
# 3. *Which errors does the teacher make?* A clone's most probable action can outvote random errors where
#    similar states need the same action.
# 4. *Do states come back?* Then a loop can fill the demonstrations, and earn the bonus for ever.
# 5. *What pays in a loop?* Compute the bonus above which a loop is worth more than the goal.
#
# **Three questions to think about**
# - A driver of this course learns from a rule, too. How would you find out what it answers that the rule
#   ignores?
# - The course's road has no goal that ends the drive. What then bounds c?
# - Take the result of this course that you believe most. Which of the five questions has nobody asked of it?

# %% [markdown] tags=["instructor"] minutes=5
# Answers to the three questions. (1) Find the numbers of the observation that the rule does not use, keep
# each at a typical value in the test, and compare returns and actions. It is not tried here. (2) The formula
# gives no threshold there; what counts is which states are paid. Staying behind trap 1 pays about 0.16 a
# decision and never ends, so every c > 0 that is paid there for ever would help staying; the demonstrations
# leave the trap, so they pay for leaving. (3) Open. Let each group name a result, and the control that it
# would train.

# %% [markdown]
# **Read on**: where else a teacher helps, `assets/report/elsewhere.md`. Chevalier-Boisvert et al., *Minigrid
# & Miniworld* (arXiv 2306.13831), where DoorKey is from.

# %% [markdown] tags=["instructor"]
# **On the board.** A table: problems as rows, methods as columns, a colour for the share of the gap that is
# closed; one row left empty for the room's own problem.
#
# **To discuss.** Whose rule errs at random, and whose systematically?
