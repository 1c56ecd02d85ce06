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
# **Time** 41 minutes, 4 of them voluntary (*Further*), without your own problem and the challenge; running it takes
# about half a minute. **It builds on** lessons [[soft_constraint]], [[learning_from_demonstrations]] and
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
# Your rule is the teacher. `bc.compare` trains five agents of each method for equally many decisions;
# demonstrations are free. Two methods are controls: plain SAC has no teacher, the clone no reward.
#
# > **Predict.** In how many test drives does plain SAC reach the flag?

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
how = {"seeds": 5, "tests": 5, "progress": False}
car, teacher = PROBLEMS["mountain-car"].make_env, loops.teacher(climb)
print(f"the rule itself earns {loops.earns(teacher, car):.0f}")
table(*loops.brief(bc.compare(methods, decisions=1_000, make_env=car, teacher=teacher, **how)))

# %% [markdown]
# **See.** (Yours will differ.) Without a teacher no drive reaches the flag; with your rule most do. The clone,
# which saw no reward, earns no less than the soft constraint.
#
# **Explain.** Before the flag each decision pays −1, whatever the car does, so the reward cannot tell a good swing
# from a bad one. A teacher can: it opens the gate **Try** of lesson [[values]]. What the reward adds to a good
# teacher shows only beside the clone.
# <!-- claim: score('mountain-car', 'good', 'cloning', 'returns') > score('mountain-car', 'good', 'soft', 'returns') -->
# <!-- claim: score('mountain-car', 'good', 'SAC') == 0 and min(score('mountain-car', 'good', m) for
#   m in ('cloning', 'soft')) > 0.9 -->

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
# > {{ earned('random') | .0f }}. What does its clone earn?

# %%
choices = ["less than its teacher", "about as much as its teacher", "about as much as the good one"]
predict("your_own_problem.2", "What does the random teacher's clone earn?", choices)

# %%
predicted("your_own_problem.2")
bc.show(figures.clones())

# %% [markdown]
# **See.** The random teachers' clones earn far more than their teachers. But if they *draw* their actions from π,
# they earn about what the teacher does. The systematic teachers' clones earn about as much as theirs.
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
# **Explain.** A clone gives similar states similar answers, so its most probable action is what most of them were
# taught. If errors fall *here and there*, the majority is right; if they fall *in one place*, it is wrong. (In π the
# errors remain: a drawn action finds them, and a long training learns some by heart, lesson [[demonstrations]].) Half
# random of lesson [[your_teacher]] errs here and there, timid and mirrored systematically.
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
# **Explain.** Why is it not outvoted? In DoorKey a state's nearest neighbour needs the same action in only
# {{ 100 * like_the_nearest('doorkey') | .0f }} % of the cases, on MountainCar in
# {{ 100 * like_the_nearest('mountain-car') | .0f }} %: here nobody outvotes the error. And where states *come back*,
# a loop fills the demonstrations with its own error.
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
# **Explain.** A bonus pays for being where the teacher was. In lesson [[your_teacher]] this made a teacher's
# accidents cheap, and its drives went on to the free lane. Here the teacher stands still, so the bonus pays for
# standing still, again and again.
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
# teacher still reach the goal, with the systematic one {{ 100 * by_bonus('systematic')[3] | .0f }} %.
# <!-- claim: list(BONUSES)[3] == 'c = 0.3' and 9 < 0.3 / drowning_bonus(0, 1, 1, 0.97) < 11 -->
# <!-- claim: math.isclose(drowning_bonus(0, 1, 1, 0.97), drowning_bonus(0, 1, 90, 0.97)) -->
#
# *Is it the loop?* If so, c = 2 should do no harm when all demonstrations reach the goal. By drawn actions it does
# none: the agents reach it as often as plain SAC. By most probable ones they do in
# {{ 100 * score('doorkey', 'random', elsewhere.WITHOUT_LOOPS, 'success') | .0f }} of 100 drives, plain SAC in
# {{ 100 * score('doorkey', 'none', 'SAC', 'success') | .0f }}: the loop is most of it, not all.
# <!-- claim: abs(score('doorkey', 'random', elsewhere.WITHOUT_LOOPS, 'drawn_success') - score('doorkey', 'none', 'SAC',
#   'drawn_success')) < 0.05 -->

# %% [markdown] tags=["instructor"] minutes=5
# Ask for a bonus that cannot be earned in a circle. A potential (lesson [[the_second_trap]]) is one: what a
# circle gains it gives back.

# %%
compare_predictions(
    "your_own_problem",
    {1: "none", 2: "about as much as the good one", 3: "less often than plain SAC"},
)

# %% [markdown]
# ## Further: help without reward
#
# CartPole pays 1 for each of at most 500 decisions in which a pole stands. The teacher pushes to where it leans. We
# take the reward away (γ = 0), so that only the soft constraint pulls five agents to this rule. On one side of its
# line an agent pushes left, on the other right.


# %% tags=["nbval-ignore-output"]
def pole(n):
    return gym.make_vec("CartPole-v1", n, vectorization_mode="sync")


def angle_rule(seen):
    return int(seen[2] > 0)


budgets = (500, 1_000, 3_000)
print(f"the rule itself earns {loops.earns(angle_rule, pole):.0f}")
bc.show(figures.edges(loops.trained(budgets, pole, angle_rule, pays=0, gamma=0)))

# %% [markdown]
# **See.** (Yours will differ.) Without reward they earn hundreds, then less. Ten others with reward earn about as
# much.
# <!-- claim: all(abs(unpaid('returns', n, 'with reward').mean() - unpaid('returns', n).mean()) < 60 for n in
#   (500, 1_000, 3_000)) and len(unpaid('returns', 500)) == len(unpaid('returns', 500, 'with reward')) == 10 -->
# <!-- claim: unpaid('returns', 1_000).mean() > 9 * teacher_earns() -->
#
# **Explain.** How can a pull to a poor rule bring so much? A half-learned copy is *another* rule. Where its line
# leans, it reacts to the pole's *speed*, too, and pushes before the pole leans far: "right if angle + speed > 0"
# balances almost to the end. Learning passed through such rules by luck, and went on to the faithful copy: after
# 5,000 decisions ten agents do as their teacher in {{ 100 * unpaid('copied', 5_000).mean() | .0f }} % of their
# decisions, and earn {{ unpaid('returns', 5_000).mean() | .0f }}. *So judge a helped agent at several budgets, and
# beside its twin without reward.*
# <!-- claim: loops.earns(lambda seen: int(seen[2] + seen[3] > 0), pole) > 450 -->
# <!-- claim: 0.4 < unpaid('copied', 1_000).mean() < 0.6 and teacher_earns() < 45 -->

# %% [markdown] tags=["instructor"] minutes=4
# Ask which of the four numbers the teacher uses, and which an agent *can* use to do the same. With the cart's place
# and speed hidden in the test, agents of 3,000 decisions earn {{ unpaid('hidden', 3_000).mean() | .0f }} in place of
# {{ unpaid('returns', 3_000).mean() | .0f }}: in what they see the speeds of cart and pole go together, and they copy
# their teacher with the help of both.
# <!-- claim: unpaid('hidden', 3_000).min() > 450 and unpaid('returns', 3_000).max() < 400 and
#   unpaid('together', 3_000).mean() < -0.5 -->

# %% [markdown]
# ## Your problem in five questions
#
# 1. *Does a teacher help?* Compare with plain SAC and the clone, at several budgets.
# 2. *Did the agents need the reward?* Train without it.
# 3. *Which errors does the teacher make?* Here and there, or in one place?
# 4. *Do states come back?* Then a loop can fill the demonstrations.
# 5. *What pays in a loop?* Compute the bonus above which it does.

# %% tags=["nbval-ignore-output"]
my_env, own_rule = pole, angle_rule  # yours: with discrete actions; the rule sees a vector
_, earned = loops.trained((1_000,), my_env, own_rule, pays=0, gamma=0)[1_000]
print(f"soft constraint without reward: return {earned.mean():.0f}")
seen = bc.demonstrate(50, None, teacher=own_rule, make_env=my_env).observations
print(f"{len(seen):,} labels, {loops.states(seen):,} states")
most = threshold(reward=-1, goal=0, decisions=120, gamma=0.99)  # MountainCar's
print(f"a loop pays above c = {most:.2f}")
table(*loops.brief(bc.compare(methods, decisions=1_000, make_env=my_env, teacher=own_rule, **how)))

# %% [markdown]
# ## What you can now answer
#
# Lesson [[start]] asked two questions.
#
# *Why does a program that learns stay behind slow cars, although the left lane is free?* We sort by the four gates of
# lesson [[values]], and at each staying is reasonable. **Try**: attempts cost, so it soon makes few. **See**: most
# crash before the free road has paid. **Carry**: what it pays must walk back past states where turning back looks
# better. **Keep**: in the learner's own count (γ = 0.8) the rule's slow way out is worth
# {{ worth_of_the_rule() | .2f }}, staying {{ discounted(idle(), 0.8) | .2f }}.
#
# *How can an imperfect teacher help it out, without the learner becoming a copy?* By taking it through the gates, and
# then letting go. From there a learner goes uphill, and two hills are near: a faster way out, and staying (lesson
# [[found_and_kept]]). *A teacher is not the goal of the learning but its place of departure: what it earns matters
# little, where it goes matters much.* So it can help although its way is worth less than the trap, lesson
# [[the_trap]]'s riddle: it puts you down on the slope of the higher hill.
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
#
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
# - *Reacts to?* Hold each number that the rule does not use at a typical value in the test, and compare the returns.
# - *What bounds c?* No threshold; what counts is which states are paid. The demonstrations leave the trap, so they
# pay for leaving.
# - *Nobody asked?* Open: name the control that you would train.
#
# </details>
#
# **Read on**: `assets/report/elsewhere.md`. Chevalier-Boisvert et al., *Minigrid & Miniworld* (arXiv 2306.13831),
# where DoorKey is from.
#
# You began with a car in a trap that plain SAC did not leave. You can now find out what a teacher adds, and costs, on
# a problem of your own.

# %% [markdown] tags=["instructor"]
# **On the board.** A table: problems as rows, methods as columns, a colour for the share of the gap that is
# closed; one row left empty for the room's own problem.
#
# **To discuss.** Whose rule errs at random, and whose systematically?
