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
# - give an agent a teacher in an environment of your choice;
# - tell which errors a clone outvotes, and above which bonus a loop pays more than the goal;
# - answer the course's two questions.
#
# **Time** 43 minutes, 6 of them voluntary (*Further*); your own problem and the challenge take longer. Running it
# takes about half a minute. **It builds on** lessons [[soft_constraint]], [[learning_from_demonstrations]] and
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
    table,
)
from bootcourse.course.lessons.your_own_problem import explorable, figures, loops
from bootcourse.research.problems import PROBLEMS

progress("your_own_problem")

# %% [markdown]
# ## Look first
#
# MountainCar is a car in a valley. Each decision pays −1 until the car reaches the flag at position 0.5, or 200
# decisions are over.

# %%
bc.show(figures.climbs())

# %% [markdown]
# **See.** The car has to drive *away* from the flag first; the reward does not say so.
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
# Your rule is the teacher. `bc.compare` trains five agents of each method for 1,000 decisions; demonstrations are
# free. Two methods are controls: plain SAC has no teacher, the clone no reward.
#
# > **Predict.** 1,000 decisions are at least five episodes. In how many test drives does plain SAC reach the flag?

# %%
predict("your_own_problem.1", "How many drives reach the flag?", ["none", "half", "nearly all"])

# %% tags=["nbval-ignore-output"]
predicted("your_own_problem.1")
climb = own_code.yours_or_ours("climb_rule", doing="Teaching")
methods = {
    "plain SAC": bc.settings_for("sac", gamma=0.99),
    "clone": bc.settings_for("bc", demonstration_episodes=50),
    "soft constraint": bc.settings_for("soft", gamma=0.99),
}
how = {"seeds": 5, "tests": 20, "progress": False}
car, teacher = PROBLEMS["mountain-car"].make_env, loops.teacher(climb)
print(f"the rule itself earns {loops.earns(teacher, car):.0f}")
table(*loops.brief(bc.compare(methods, decisions=1_000, make_env=car, teacher=teacher, **how)))

# %% [markdown]
# **See.** (Yours will differ.) Without a teacher no drive reaches the flag; with your rule many do. In the
# study ten agents of plain SAC had {{ PROBLEMS['mountain-car'].episodes }} episodes, and no test drive reached it.
# <!-- claim: score('mountain-car', 'good', 'SAC') == 0 and len(cells().scores('mountain-car', 'good', 'SAC')) == 10
#   and min(score('mountain-car', 'good', m) for m in ('cloning', 'soft')) > 0.9 -->
#
# **Explain.** Before the flag each decision pays −1, whatever the car does. So until a drive has reached the flag, the
# reward says nothing about a swing. The teacher does (gates **Try** and **See** of lesson [[values]]).
#
# What does the reward add? Five agents with this constraint and no reward earn as much: here it adds nothing that
# shows. (For the clone 1,000 decisions are few: after 3,000 five clones earned −129.)
# <!-- claim: score('mountain-car', 'good', 'cloning', 'returns') > score('mountain-car', 'good', 'soft', 'returns') -->

# %% [markdown] tags=["instructor"] minutes=4
# Collect problems of their own first: what is the reward, does it tell early drives apart, who can write a
# rule? Then ask of each rule which kind of error it makes. Rules that people write may err systematically:
# they forget a situation.

# %% [markdown]
# ## Round 2: which errors does the teacher make?
#
# For a **random** teacher we draw once in which states it errs: there it errs each time. A **systematic** teacher
# errs in one whole region. The **good** teacher makes neither error.
#
# > **Predict.** On MountainCar the good teacher earns {{ earned('good') | .0f }}. The random teacher is right in
# > {{ 100 * elsewhere_claims.PROBLEMS['mountain-car'].right | .0f }} % of the states and earns
# > {{ earned('random') | .0f }}. What does its clone earn by its most probable actions?

# %%
choices = ["less than its teacher", "about as much as its teacher", "about as much as the good one"]
predict("your_own_problem.2", "What does the random teacher's clone earn?", choices)

# %%
predicted("your_own_problem.2")
bc.show(figures.clones())

# %% [markdown]
# **See.** The random teachers' clones earn far more than their teachers. But if they *draw* their actions from π,
# they earn about what the teacher does. The systematic teachers' clones earn about as much as theirs.
#
# On CartPole {{ above_the_good() }} of ten beat even the good teacher.
# <!-- claim: len(cells().scores('cartpole', 'random', 'cloning')) == 10 and above_the_good() > 0 -->
# <!-- claim: all(abs(score(p, 'random', 'cloning', 'drawn_returns') - score(p, 'random', 'the
#   teacher', 'returns')) < 15 for p in TWO) -->
# <!-- claim: {len(cells().scores(p, t, 'cloning')) for p, t in SHOWN} == {10} -->
# <!-- claim: all(score(p, 'random', 'cloning', 'returns') > score(p, 'random', 'the teacher',
#   'returns') + 20 and score(p, 'random', 'cloning', 'returns') > score(p, 'good', 'the teacher',
#   'returns') - (10 if p == 'mountain-car' else 25) for p in TWO) -->
# <!-- claim: all(abs(score(p, 'systematic', 'cloning', 'returns') - score(p, 'systematic', 'the
#   teacher', 'returns')) < 10 for p in TWO) -->
#
# **Drag** *reach*: each square now does what most squares within this distance say. Which errors vanish?

# %%
explorable.votes()

# %% [markdown]
# **See.** With reach 1 all drives by the random teacher's map reach the flag. The systematic teacher's block
# of errors stays.
#
# **Explain.** A clone gives similar states similar answers. So its most probable action is mostly what most of the
# states around were taught. If errors fall *here and there*, most labels around them are right. If they fall *in one
# place*, most labels there are wrong. (π keeps the errors: a drawn action is wrong at least as
# often as a label.)
# <!-- claim: [explorable.reached(t, 70, r) for t, r in (('random', 0), ('random', 1), ('systematic',
#   0), ('systematic', 1))] == [8, 20, 15, 15] -->
#
# %% [markdown] tags=["instructor"] minutes=3
# Ask before the panel: what does a clone do with two labels that contradict each other?

# %% [markdown]
# ## Round 3: what pays in a loop?
#
# In DoorKey an agent fetches a key, opens a door and walks to a goal, in at most 100 decisions. Only the goal
# pays: at most 1, the sooner the more.

# %%
bc.show(figures.room(loops.drive_in_a_loop(), "Here DoorKey's random teacher ends in a loop"))

# %% [markdown]
# **See.** Here the teacher answers "pick up", which changes nothing. So it answers the same again, and gives one
# wrong label {{ loops.drive_in_a_loop().count(loops.drive_in_a_loop()[-1]) }} times.
# <!-- claim: answer_in_the_loop() == PICK_UP -->
#
# **Explain.** Why is it not outvoted? A vote helps where alike states need the same action. In DoorKey a state's
# nearest neighbour needs the same in only {{ 100 * like_the_nearest('doorkey') | .0f }} % of the cases, on
# MountainCar in {{ 100 * like_the_nearest('mountain-car') | .0f }} %.
#
# The loop does something else: it *comes back*, and fills the demonstrations with its own error.
# <!-- claim: like_the_nearest('mountain-car') > 0.9 and like_the_nearest('doorkey') < 0.5 -->
# <!-- claim: outvoted('mountain-car').mean() > 0.9 and not outvoted('doorkey').any() -->
# <!-- claim: [len(seen) > 50 * loops.states(seen) for seen, *_ in map(labels, ('mountain-car',
#   'doorkey'))] == [False, True] -->
#
# > **Predict.** Agents get both aids from DoorKey's random teacher: soft constraint, and demonstrations with the
# > paper's bonus, c = 2, for each of their decisions. Do the agents reach the goal more often than plain SAC?

# %% [markdown] tags=["instructor"] minutes=2
# Ask for the vote in DoorKey before the answer: which states are similar there, and do they need the same action?

# %%
choices = ["less often than plain SAC", "about as often", "more often"]
predict("your_own_problem.3", "How often do agents with both aids reach the goal?", choices)

# %%
predicted("your_own_problem.3")
table(*figures.two_bonuses())

# %% [markdown]
# **See.** With c = 2 and a flawed teacher hardly any drive reaches the goal, with the good teacher nearly all.
#
# **Explain.** A bonus pays for being where the teacher was. The random teacher stands still in its loop, so the bonus
# pays for standing still, again and again.
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

# %%
threshold = own_code.yours_or_ours("drowning_bonus", doing="Computing")
bc.show(figures.bonuses(threshold(reward=0, goal=1, decisions=12, gamma=0.97)))

# %% [markdown]
# **Explain.** `decisions` drops out: however near the goal, the threshold is the same. It is a warning, not a
# forecast: at c = 0.3, ten times as much, {{ 100 * by_bonus('random')[3] | .0f }} % of the drives with the random
# teacher still reach the goal.
# <!-- claim: list(BONUSES)[3] == 'c = 0.3' and 9 < 0.3 / drowning_bonus(0, 1, 1, 0.97) < 11 -->
# <!-- claim: math.isclose(drowning_bonus(0, 1, 1, 0.97), drowning_bonus(0, 1, 90, 0.97)) -->
#
# *Is it the loop?* Take the loops away: as many drives as before, but all to the goal.
#
# | the random teacher: goals in 100 drives | drawn actions | most probable ones |
# | --- | --- | --- |
# | all its drives, c = 0 | {{ goals('both, c = 0', 'drawn_') }} | {{ goals('both, c = 0') }} |
# | only those to the goal, c = 2 | {{ goals(FREE_OF_LOOPS, 'drawn_') }} | {{ goals(FREE_OF_LOOPS) }} |
# | all its drives, c = 2 | {{ goals('both', 'drawn_') }} | {{ goals('both') }} |
# | plain SAC, no teacher | {{ plain('drawn_') }} | {{ plain() }} |
#
# <!-- claim: all(len(cells().scores('doorkey', 'random', m)) == 10 for m in ('both, c = 0', 'both',
#   FREE_OF_LOOPS)) -->
#
# So without the loops most of the harm is gone, not all.
# <!-- claim: abs(goals(FREE_OF_LOOPS, 'drawn_') - goals('both, c = 0', 'drawn_')) < 10 and goals('both') ==
#   goals('both', 'drawn_') == 0 and goals('both, c = 0') / 2 < goals(FREE_OF_LOOPS) < goals('both, c = 0') -->

# %% [markdown] tags=["instructor"] minutes=5
# Ask for a bonus that cannot be earned in a circle. A potential (lesson [[the_second_trap]]) is one: what a
# circle gains it gives back.

# %% [markdown]
# ## Your problem in five questions
#
# 1. *Does a teacher help?* Compare with plain SAC and the clone.
# 2. *Did the agents need the reward?* Train without it (γ = 0), for several budgets.
# 3. *Which errors does the teacher make?* Here and there, or in one place?
# 4. *Do states come back?* Then a loop can fill the demonstrations.
# 5. *What pays in a loop?* Compute the bonus above which it does.
#
# Our example is CartPole, which pays 1 for each of at most 500 decisions in which a pole stands. The teacher pushes to
# where the pole leans.


# %% tags=["nbval-ignore-output"]
def pole(n):
    return gym.make_vec("CartPole-v1", n, vectorization_mode="sync")


def angle_rule(seen):
    return int(seen[2] > 0)


my_env, own_rule = pole, angle_rule  # yours: with discrete actions; the rule sees a vector
budgets = (500, 1_000, 3_000)
print(f"the rule itself: return {loops.earns(own_rule, my_env):.0f}")
for decisions, (_, earned) in loops.trained(budgets, my_env, own_rule, pays=0, gamma=0).items():
    print(f"without reward, {decisions:,} decisions: return {earned.mean():.0f}")
seen = bc.demonstrate(50, None, teacher=own_rule, make_env=my_env).observations
print(f"{len(seen):,} labels in {loops.states(seen):,} different states")
table(*loops.brief(bc.compare(methods, decisions=1_000, make_env=my_env, teacher=own_rule, **how)))

# %% [markdown]
# **See.** (Yours will differ.) The five answers for CartPole:
#
# 1. It helps: with it agents earn hundreds, plain SAC and the clone less than 100.
# 2. No: without it they earn hundreds, too, after 1,000 decisions. After 3,000 they earn far less (in the study with
#    reward, too).
# 3. In one place: where the pole leans one way and already moves back fast, the rule errs each time.
# 4. No: no state comes twice.
# 5. No goal ends the episode, so there is no such threshold.
# <!-- claim: all(abs(unpaid('returns', n, 'with reward').mean() - unpaid('returns', n).mean()) < 60 for n in
#   (500, 1_000, 3_000)) and len(unpaid('returns', 500)) == len(unpaid('returns', 500, 'with reward')) == 10 -->
# <!-- claim: all(unpaid('returns', 3_000, kind).mean() < 0.5 * unpaid('returns', 1_000, kind).mean() for kind in
#   ('with reward', 'without reward')) -->
#
# Now put your own problem into the cell, and write five such answers.

# %% [markdown]
# ## Further: hide the cart
#
# Voluntary; if you skip it, leave prediction 18.4 open.
#
# Why do these agents earn ten times as much as their teacher, and then less? Draw the pole's angle to the right and its
# speed upwards. A line divides where an agent pushes left from where it pushes right. The teacher looks at the angle
# alone: its line is upright.

# %% tags=["nbval-ignore-output"]
for k in (1, 4, 20):
    found = loops.earns(lambda seen, k=k: int(k * seen[2] + seen[3] > 0), pole)
    print(f"right if {k} · angle + speed > 0: return {found:.0f}")
bc.show(figures.edges(loops.trained(budgets, pole, angle_rule, pays=0, gamma=0)))

# %% [markdown]
# **Explain.** A half-learned copy is *another* rule: after 1,000 decisions ten agents do as their teacher in only
# {{ 100 * unpaid('copied', 1_000).mean() | .0f }} % of their decisions. Where its line leans, an agent reacts to the
# pole's *speed*, too. The three rules above the figure do so, and balance.
# <!-- claim: all(loops.earns(lambda seen: int(k * seen[2] + seen[3] > 0), pole) > 450 for k in (1, 20)) -->
# <!-- claim: 0.4 < unpaid('copied', 1_000).mean() < 0.6 and teacher_earns() < 45 and
#   unpaid('returns', 1_000).mean() > 9 * teacher_earns() -->
#
# The lines are drawn for a cart at rest in the middle. In a drive it moves, and the agents see its place and speed.
#
# > **Predict.** In the test we put the cart's place and speed to 0 in what ten agents of 3,000 decisions see. They
# > earn {{ unpaid('returns', 3_000).mean() | .0f }} as they are. And now?

# %%
predict(
    "your_own_problem.4",
    "What do they earn with the cart hidden?",
    ["less", "as much", "about 500"],
)

# %%
predicted("your_own_problem.4")
bc.show(figures.hidden())

# %% [markdown]
# **See.** With the cart hidden all ten earn 500, after 5,000 decisions, too. (With its place or its speed alone hidden,
# most of five agents stayed below 250.)
# <!-- claim: min(unpaid('hidden', n).min() for n in (3_000, 5_000)) > 495 and len(unpaid('hidden', 3_000)) == 10 -->
#
# **Explain.** So what they see of the cart makes them fall. How can agents copy a rule that ignores both speeds, while
# they react to both? In their drives the two go together: when the cart moves to the right at 1 m/s, the pole moves to
# the left at about {{ -pole_for_cart() | .1f }} rad/s (correlation {{ unpaid('together', 5_000).mean() | .1f }}; in the
# teacher's drives, too: a push moves the two oppositely). In a linear fit of five agents the reactions to these two
# speeds nearly cancel, and the angle is left. Hide the cart, and the reaction to the pole's speed stands alone: that
# balances.
# <!-- claim: together_with(angle_rule)[1] < -0.95 and -1.4 < pole_for_cart() < -1.2 -->
#
# They do as their teacher in {{ 100 * unpaid('copied', 5_000).mean() | .0f }} % of their decisions, with the cart
# hidden, in the same states, in {{ 100 * unpaid('copied hidden', 5_000).mean() | .0f }} %. *As the copy gets better,
# the return nears the teacher's*: {{ unpaid('returns', 5_000).mean() | .0f }} beside {{ teacher_earns() | .0f }}.
# <!-- claim: unpaid('together', 5_000).max() < -0.9 and unpaid('copied', 5_000).mean() > 0.9 >
#   0.1 + unpaid('copied hidden', 5_000).mean() -->
#
# *So judge a helped agent at several budgets, and beside its twin without reward.*

# %% [markdown] tags=["instructor"] minutes=6
# Ask which of the four numbers the teacher uses, and which an agent *can* use to do the same. Let them say what the
# lines are drawn for before the prediction: with the cart hidden, the agents *are* their lines. After 5,000 decisions
# a linear fit of five agents' logits in their own drives gives weights of about 2 to the pole's speed and 3 to the
# cart's, which moves −1 for 1.3 of the pole's: together about 0.

# %%
compare_predictions(
    "your_own_problem",
    {
        1: "none",
        2: "about as much as the good one",
        3: "less often than plain SAC",
        4: "about 500",
    },
)

# %% [markdown]
# ## What you now know
#
# 1. A clone, and a twin without reward, show what the reward adds.
# 2. Errors here and there can be outvoted; errors in one place are learned.
# 3. A bonus pays for being where the teacher was: in a loop, again and again.
#
# **Three questions to think about**
# - How would you find out to what a driver of this course reacts that its rule ignores?
# - The course's road has no goal that ends the drive. What then bounds c?
# - Take the result of this course that you believe most. Which of the five questions has nobody asked of it?
#
# <details><summary>Answers</summary>
#
# - *Reacts to?* In the test, hold what the rule does not use at a typical value, one number by one and together.
# - *What bounds c?* Not this threshold. Look at which states the bonus pays for: in the trap, or beyond it.
# - *Nobody asked?* Open: name the control that you would train.
#
# </details>
#
# **Read on**: `assets/report/elsewhere.md`. Chevalier-Boisvert et al., *Minigrid & Miniworld* (arXiv 2306.13831),
# where DoorKey is from.

# %% [markdown]
# ## Finale: the challenge
#
# Train five drivers for the course's road, with any learner, teacher and training reward. Five agents of each
# method with a teacher of lesson [[other_ways]] earn {{ entry_scores()[0] | .0f }} to
# {{ entry_scores()[-3] | .0f }}.
#
# - **Budget**: five agents of one setting, seeds 0 to 4; {{ BOARD | , }} decisions each; free demonstrations.
# - **Test**: 1,000 held-out roads, drawn when all have handed in; most probable actions. If yours asks its
#   teacher there, say so.
# - **Hand in**: one page that answers the five questions, and the folder that
#   `bc.save_runs(enter(200_000), "challenge")` writes.
# - **Bar**: an entry with a teacher must beat plain SAC, {{ entry_scores()[-1] | .0f }}, and the teacher's clone
#   ({{ clone_earns() | .0f }} with the course's rule).


# %%
def enter(decisions):
    settings = bc.with_seeds(bc.settings_for("ppo_cloned", gamma=0.97, batch=512), 5)  # yours
    entry = bc.Training(settings, episodes=50_000)
    return entry.run(progress=False, stop=lambda: entry.decisions >= decisions * len(settings))


# %% [markdown]
# Rehearse (15 s): `bc.board(enter(20_000), block=7)`.

# %% [markdown]
# ## What you can now answer
#
# Lesson [[start]] asked two questions.
#
# *Why does a program that learns stay behind slow cars, although the left lane is free?* Lesson [[values]]
# sorts by four gates, and at each something speaks for staying.
#
# | gate | for staying speaks | lesson |
# | --- | --- | --- |
# | **Try** an attempt | a crash costs {{ -DEFAULT.reward.accident | .0f }} | [[the_barrier]] |
# | **See** the free road | most attempts crash before | [[the_barrier]] |
# | **Carry** its value back | on the way, turning back looks better | [[values]] |
# | **Keep** to the way out | the rule's is worth {{ worths_by_the_rule() }} | [[the_trap]] |
#
# *How can an imperfect teacher help it out, without the learner becoming a copy?* By taking it through the gates, and
# then letting go. From there a learner goes uphill, and two hills are near: a faster way out, and staying (lesson
# [[found_and_kept]]). *A teacher is not the goal of the learning but its place of departure: where it goes matters more
# than what it earns.* So it can help although its way is worth less than the trap, lesson [[the_trap]]'s riddle: it
# puts you down on the slope of the higher hill.
#
# <details><summary>And the paper? What became of its sentences</summary>
#
# {{ what_became() }}
#
# <!-- claim: [PRINTED[m]['success'].mean for m in ('sac', 'soft', 'demos', 'bootstrapped', 'cql', 'gail')] ==
#   [0, 0, 100, 100, 0, 0] -->
#
# *Its idea, to help a learner with an imperfect rule*, held with each of five methods (lesson [[other_ways]]) and on
# MountainCar.
#
# </details>
#
# You began with a car in a trap. You can now find out what a teacher adds, and costs, on a problem of your own.

# %% [markdown] tags=["instructor"]
# **On the board.** A table: problems as rows, methods as columns, a colour for the share of the gap that is
# closed; one row left empty for the room's own problem.
#
# **To discuss.** Whose rule errs at random, and whose systematically?
