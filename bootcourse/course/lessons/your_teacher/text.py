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
# # Your teacher
#
# **What you will be able to do**
# - write a rule controller of your own, and let agents learn from it;
# - judge a teacher by its students, by success and by return;
# - say which teachers were enough, for which learner.
#
# **Time** 55 minutes, 25 of them for Round 4, which can wait; running it takes about one minute.
# **It builds on** the rule (lesson [[the_rule]]), the soft constraint ([[soft_constraint]]) and
# learning from demonstrations ([[learning_from_demonstrations]]).

# %%
import bootcourse as bc
import numpy as np
from bootcourse.course import (
    check,
    compare_predictions,
    predict,
    predicted,
    progress,
    source,
    table,
)
from bootcourse.course.lessons.your_teacher import (
    asking,
    example_teachers,
    figures,
    taught_agents,
)
from bootcourse.course.shipped import beginning
from bootcourse.learn.teachers import ahead, teacher_policy, toward
from bootcourse.research.teachers import TEACHERS
from bootcourse.road.state import EGO, LANE, SPEED, X, Y

progress("your_teacher")

# %% [markdown]
# ## Look first
#
# So far the teacher was the rule of lesson [[the_rule]]. Here are two others. `reckless` always
# accelerates. `racer` gets out, then aims for 20 m/s and ignores the other cars.

# %% tags=["nbval-ignore-output"]
ROAD = 10
pair = (example_teachers.racer, example_teachers.reckless)
drives = [bc.record(teacher_policy(each), [ROAD], label=each.__name__)[0] for each in pair]
bc.recording([beginning(drive, 30) for drive in drives], height=360)

# %% [markdown]
# Three more: `careful` goes left as soon as there is room, then drives 15 m/s. `timid` keeps
# straight behind trap 1. The last is the rule with a shorter sight, {{ taught_agents.NEAR | g }} m.

# %%
figures.exam_of_all()

# %% [markdown]
# **See.** The racer gets out on each of these roads, and on each earns *less* than `timid`: the
# reward pays next to nothing for 20 m/s.
# <!-- claim: speed_reward(17) < 0.02 -->
# <!-- claim: all(teacher_exam(n).success.all() for n in ('careful', 'racer')) -->
# <!-- claim: not any(teacher_exam(n).success.any() for n in ('timid', 'reckless')) -->
# <!-- claim: teacher_exam('racer').returns.max() < teacher_exam('timid').returns.min() and
#   teacher_exam('racer').accident.any() -->
#
# **The question**: what must a teacher be good at, so that its students get out?

# %% [markdown] tags=["instructor"] minutes=3
# Ask for a ranking of the students, on the board. The ranking to discuss is that of the teachers
# themselves, by what they earn. Keep it visible until Round 2. The one training of this lesson
# comes out differently on another processor; the groups of ten ship with the course.

# %% [markdown]
# ## Round 1: a rule of your own
#
# A rule reads the true state: a table with a row for each car. Row 0 is the ego. Lane 0 is the
# leftmost.
# <!-- claim: range(DEFAULT.road.lanes)[0] == 0 -->

# %%
# NBVAL_CHECK_OUTPUT
cars = drives[0].states[0]  # as the road begins
figures.cars_in_rows(cars)

# %% [markdown]
# `ahead` says how much road is free ahead in a lane: the gap, bumper to bumper, and the speed of
# the car at its end. Below 0 that car is beside you. Without a car both are infinite.

# %%
# NBVAL_CHECK_OUTPUT
for lane in (2, 1, 0):
    gap, speed = ahead(cars, lane)
    print(f"lane {lane}: free for {gap:5.1f} m, then a car at {speed:.1f} m/s")

# %% [markdown]
# Your rule decides on a **speed** and a **lane**. `toward(cars, speed, lane, scenario)` finds the
# action that brings the car there. In lane 0 ask for lane 0: it refuses a lane that does not exist.
# Two of the teachers are rules in one line:

# %% tags=["nbval-ignore-output"]
source("bootcourse.course.lessons.your_teacher.example_teachers", "timid", "racer")

# %% [markdown]
# > **Predict.** A simple rule aims for *one* speed everywhere, and for the next lane to the left.
# > We try each whole speed from 8 to 15 m/s. At the best of them, on how many of 100 roads does it
# > get out?

# %%
predict("your_teacher.1", "At its best speed it gets out on ...", ["none", "about half", "all"])

# %% [markdown]
# **Exercise (12 min, ●●○).** Write a rule that gets out. The check drives it on 24 roads: it
# has to be ahead of trap 1 at the end of every one, without an accident. It must answer the same
# road the same way each time, and leave `cars` as it is. How would you use `ahead`, `toward`,
# `cars[EGO, LANE]` and `cars[EGO, Y]`?
# <!-- claim: len(registry()['my_rule'].worked) +
#   len([*registry()['my_rule'].cases(np.random.default_rng(0))]) == 24 -->


# %%
def my_rule(cars, scenario):
    """One of the nine actions, 0 to 8, for one road. cars: (vehicles, 10), see Round 1."""
    # solution
    lane = int(cars[EGO, LANE])
    gap, v = ahead(cars, lane, scenario)
    if lane == 0:  # the free lane: 0.5 m/s slower than a car that is near
        return toward(cars, 15.0 if gap > 25 else min(15.0, v - 0.5), 0, scenario)
    left_gap, left_v = ahead(cars, lane - 1, scenario)
    settled = abs(cars[EGO, Y] - lane * scenario.road.lane_width) < 0.5
    goal = lane - 1 if settled and left_gap > 4 else lane
    return toward(cars, min(v, left_v, 14.0) - 1.5, goal, scenario)
    # end solution


check.my_rule(my_rule)

# %%
predicted("your_teacher.1")
figures.of_speeds()

# %% [markdown]
# **Explain.** Up to 10 m/s the car is no faster than the traps. At 11 m/s or more it crashes on
# each of these roads. Two speeds are enough (last row), *without a look at any gap*, but earn
# little.
# <!-- claim: not any(one_situation(v).success.any() for v in range(8, 16)) and
#   all((one_situation(v).accident > 0).all() for v in range(11, 16)) -->
# <!-- claim: DEFAULT.traps.speed == 10 -->
# <!-- claim: two_situations(9.0).success.all() and not two_situations(9.0).accident.any() and
#   two_situations(9.0).returns.mean() < teacher_exam('careful').returns.mean() / 4 -->

# %% [markdown] tags=["instructor"] minutes=4
# A first attempt that changes left at once, at 10 m/s, hits a car on {{ 100 *
# (two_situations(10.0).accident > 0).mean() | .0f }} % of the roads. Let them print the seconds
# before such an accident. With 1 m/s less the same rule passes. A group that finds this has a
# rule of two speeds: let the others say why it works. A rule that passes but brakes to 6 m/s is
# worth keeping, too: look whether its students are slow as well.
# <!-- claim: (two_situations(10.0).accident == Accident.COLLISION).sum() ==
#   (two_situations(10.0).accident > 0).sum() > 0 -->

# %% [markdown]
# Watch your rule beside the course's. Until yours has passed, `careful` stands in for it.

# %%
mine = my_rule if check.my_rule(my_rule).passed else example_teachers.careful
print(example_teachers.examine(mine))

# %% tags=["nbval-ignore-output"]
both = {"yours": teacher_policy(mine), "the rule": bc.rule_policy(bc.DEFAULT)}
driven = [bc.record(driver, [ROAD], label=name)[0] for name, driver in both.items()]
bc.recording([beginning(drive, 60) for drive in driven], height=360)

# %% [markdown]
# ## Round 2: its students
#
# A teacher enters the learner in three places. It **drives** the demonstrations. It **labels** the
# states that the agent reaches, for the KL. It labels the states that come next, for the KL in the
# critic's target. `Training(..., teacher=my_rule)` swaps all three. So does
# `bootcourse train --teacher my_rule.py:my_rule`.
#
# Three agents learn from your rule with the paper's method, for {{ taught_agents.UPDATES | , }}
# updates. **Yours will differ** with your processor.

# %% tags=["nbval-ignore-output"]
settings = bc.with_seeds(bc.settings_for("bootstrapped"), 3)
mine_taught = taught_agents.teach(mine, settings, learner="compiled").agents
learned = taught_agents.tested(mine_taught)
figures.of_each(learned)

# %% [markdown]
# Three taught agents come out above three that learn alone by luck once in {{ math.comb(6, 3) }}
# times. So here are ten students of each teacher, which ship with the course, and ten agents that
# learned alone, at equal decisions.
# <!-- claim: len({(s.learning_starts, s.envs_per_agent, s.updates) for s in
#   map(settings_for, ('sac', 'bootstrapped'))}) == 1 -->
#
# > **Predict.** The racer earns next to nothing itself, and those that learned alone
# > {{ students('alone')['returns'].mean() | .0f }}. What do the racer's students earn?

# %%
choices = ["less than those alone", "about as much", "more"]
predict("your_teacher.2", "What do the students of the racer earn?", choices)

# %% [markdown]
# An agent *escapes* if it gets out on {{ 100 * ESCAPES | .0f }} % of {{ len(taught_agents.ROADS)
# }} held-out roads. ▲ and ▼ are verdicts, on success and on return: the teacher helps, or hurts.
# Each comes from a rank test (Mann and Whitney) against those that learned alone, at 5 % for all
# *twelve* together, after Holm (lesson [[how_many_seeds]]).

# %%
predicted("your_teacher.2")
groups = taught_agents.reference()
verdicts = taught_agents.verdicts(groups)
bc.show(figures.students(groups | {"yours, 3 here": learned}, verdicts))

# %% [markdown]
# **See.** Of these six teachers only those that get out have students that escape, and of the ten
# without a teacher one does.
# - Three teachers get out without an accident. {{ sum(map(student_escapes, ('the rule',
#   'the rule, 30 m', 'careful'))) }} of their 30 students escape.
# - The racer's students get out in {{ 100 * students('racer')['success'].mean() | .0f }} % of the
#   drives, and crash in {{ 100 * students('racer')['accident'].mean() | .0f }} %.
# - `timid` is the reverse. Its students stay behind trap 1, without an accident: it helps by
#   return, and none escapes.
# <!-- claim: student_escapes('alone') == 1 -->
# <!-- claim: student_escapes('timid') == student_escapes('reckless') == 0 and
#   (students('timid')['alike'] == 1).all() and not students('timid')['accident'].any() and
#   not students('timid')['success'].any() -->
# <!-- claim: students('racer')['success'].mean() > 3 * students('alone')['success'].mean() and
#   students('racer')['accident'].mean() > 3 * students('alone')['accident'].mean() -->
# <!-- claim: len(verdicts()) == 6 and verdicts()['racer'] == {'success': 'helps', 'returns':
#   'hurts'} and verdicts()['timid'] == {'success': 'not shown', 'returns': 'helps'} -->
#
# This was a short training: the aids are still at work. After {{ taught_agents.LONG | , }} updates,
# when both have faded, the racer's students earn {{
# students(taught_agents.RACER_LONG)['returns'].mean() | .0f }}, and {{
# student_escapes(taught_agents.RACER_LONG) }} of ten escape. Nobody
# learned alone as long, so it is no verdict.
# <!-- claim: students('racer')['beta'].min() > 0.3 and students('racer')['xi'].min() > 0.2 -->
# <!-- claim: students('racer, long')['beta'].max() == 0 and
#   students('racer, long')['xi'].max() < 1e-5 and len(students('racer, long')['returns']) == 10 -->

# %% [markdown] tags=["instructor"] minutes=4
# Ask which of the columns a paper would print, and what a reader would then miss. Let each group
# defend one verdict, and say which measurement would overturn it.

# %% [markdown]
# ## Round 3: a teacher that crashes
#
# Beside the rule there are now **a quarter random** and **half random**: in so many of the states a
# random action replaces the rule's, the same one whenever that state comes. **Mirrored**, the rule
# with left and right exchanged, stays in the right lane, behind trap 1.
# <!-- claim: all((drive.states[:, EGO, LANE] == DEFAULT.road.lanes - 1).all() and not drive.success
#   for drive in demonstrated('mirrored')) -->

# %%
figures.records()

# %% [markdown]
# **See.** One random action in nine is the rule's, so half random gives the rule's action with
# p = 1/2 + 1/18 = {{ 1 / 2 + 1 / 18 | .2f }}. The learners are told p = {{ SETTINGS.rule_p }} for
# all four.
# <!-- claim: settings_for('soft').rule_p == SETTINGS.rule_p and
#   abs(figures.like_the_rule(demonstrated('random-50')) - 1 / 2 - 1 / 18) < 0.02 -->
#
# > **Predict.** We take the {{ gets_ahead('random-50') }} drives that end ahead out of the
# > half-random teacher's {{ len(demonstrated('random-50')) }}. An agent learns as in Round 2, from
# > the drives that are left and its labels. On how many roads does it get out?
# <!-- claim: all(drive.accident > 0 for drive in demonstrated('random-50')) and
#   gets_ahead('random-50') == 2 -->

# %%
choices = ["about none", "about half", "almost all"]
predict("your_teacher.3", "On how many roads does it get out?", choices)

# %% [markdown]
# Two controls lack a part: the labels, or the bonus.

# %% tags=["nbval-ignore-output"]
predicted("your_teacher.3")
half_random = TEACHERS["random-50"].rule
crashes = [drive for drive in taught_agents.demonstrated("random-50") if not drive.success]
kinds = {
    "drives, labels, bonus": bc.settings_for("bootstrapped"),
    "without the labels": bc.settings_for("demos"),
    "without the bonus": bc.settings_for("bootstrapped", bonus=0),
}
shown = {"demonstrations": crashes, "learner": "compiled"}
of_crashes = taught_agents.teach(half_random, [*kinds.values()], **shown).agents
after = taught_agents.tested(of_crashes)
figures.of_each(after, [*kinds])

# %% tags=["nbval-ignore-output"]
both = {"its teacher": teacher_policy(half_random), "the student": of_crashes[0].as_policy()}
driven = [bc.record(driver, [ROAD], label=name)[0] for name, driver in both.items()]
bc.recording([beginning(drive, 60) for drive in driven], height=360)

# %% [markdown]
# **See.** Each drive that they saw ends in an accident. But most reach the free lane, and
# more than half of the labels are the rule's. Has the first student accidents, too? Does
# it earn more than `timid`?
# <!-- claim: reach_free_lane('random-50') > len(demonstrated('random-50')) / 2 + 2 -->
#
# One agent each is few. Here are ten of each of two learners, after a whole training with all
# drives: {{ budget() }} thousand decisions an agent.
#
# > **Predict.** All ten bootstrapped students of the half-random teacher escape. How many of ten
# > escape with its labels alone, by the soft constraint?

# %%
choices = ["none", "1 to 3", "4 to 7", "8 to 10"]
predict("your_teacher.4", "How many of ten escape with the labels alone?", choices)

# %%
predicted("your_teacher.4")
worth = taught_agents.of_two_learners()
bc.show(figures.learners(worth))

# %% [markdown]
# **See.** Students can earn more than their teacher (green line). Bootstrapped, 10, 8 and 7 of ten
# escape as labels improve: ten cannot rank them. None of the mirrored teacher's students escapes.
# Without a teacher {{ escaped('sac') }} of the study's ten escapes, as with the half-random labels.
# Which teacher was enough depended on the learner:
#
# | learner | takes | the worst that was enough for most of ten agents |
# |---|---|---|
# | bootstrapped SAC | drives, labels | half random: p = {{ 1 / 2 + 1 / 18 | .2f }} |
# | soft constraint only | labels | a quarter random: p = {{ 3 / 4 + 1 / 36 | .2f }} |
# <!-- claim: [worth()[one, 'bootstrapped'].escapers('bootstrapped') for one in ('random-50',
#   'random-25', 'rule')] == [10, 8, 7] -->
# <!-- claim: worth()['random-50', 'bootstrapped'].escapers('bootstrapped') == 10 and
#   worth()['random-50', 'soft'].escapers('soft') == 1 -->
# <!-- claim: all(worth()['mirrored', m].escapers(m) == 0 and len(worth()['mirrored', m]) == 10
#   for m in ('soft', 'bootstrapped')) -->
# <!-- claim: worth()['random-25', 'soft'].escapers('soft') > 5 -->
#
# **Explain.** For bootstrapped SAC a teacher need not get out often. Your table says, for one agent
# each, whether the crashes were enough without labels, or without the bonus.

# %% [markdown] tags=["instructor"] minutes=4
# Let each group name one experiment that could change a verdict: more updates, c = 0 (with `timid`
# the bonus pays for staying), p = 0.5 (a teacher that is less sure). c and p are arguments of
# `settings_for`. Of the seeds 0 to 5 on the crashes, five agents escaped with drives, labels and
# bonus, none without the labels and none without the bonus (on one processor).

# %% [markdown]
# ## Round 4: a road on which blind rules fail
#
# The rule of two speeds gets out without a look to the side. Here ten cars fill the left lane, in
# a queue. They are faster than the traps, so they pass you.
# <!-- claim: example_teachers.DENSE.traffic.cars == 10 and slowest_in_queues() > 10 ==
#   DEFAULT.traps.speed -->

# %%
dense = example_teachers.dense_road(1_300_000)
queue = dense[dense[:, LANE] == 0]
print("cars in the left lane, m ahead of you:", np.round(queue[:, X]))
print("their speeds, m/s:", np.round(queue[:, SPEED], 1))

# %% [markdown]
# **Exercise (25 min, ●●●).** Write a rule that gets out of the trap on such roads, too. The
# check drives it on {{ len(registry()['watchful_rule'].all_arguments) }} of them, chosen to
# separate rules: ahead of trap 1 at the end of every one, without an accident. The rule of two
# speeds collides on {{ dense('without_a_look')[COLLIDES] }}, and `careful`, which does not look
# behind, on {{ dense('careful')[COLLIDES] }}.
# <!-- claim: [*dense('watchful')] == [OUT] -->


# %%
def watchful_rule(cars, scenario):
    """One of the nine actions, for one road with a dense left lane. cars: (vehicles, 10)."""
    # solution: the exercise's own


check.watchful_rule(watchful_rule)

# %%
earned = {name: groups[name]["returns"].mean() for name in ("alone", "racer")}
word = "less than those alone" if earned["racer"] < earned["alone"] else "more"
compare_predictions(
    "your_teacher",
    {
        1: "none",
        2: f"{word}: {earned['racer']:.1f}, alone {earned['alone']:.1f}",
        3: f"on {after['success'][0]:.0%}",
        4: f"{worth['random-50', 'soft'].escapers('soft')} of ten",
    },
)

# %% [markdown]
# ## What you now know
#
# 1. A teacher is a function of the true state. It enters the learner in three places: swap it in
#    each of them.
# 2. A teacher need not get out often: all ten bootstrapped students of one that did in {{
#    gets_ahead('random-50') }} of {{ len(demonstrated('random-50')) }} drives escaped. Most of its
#    drives reach the free lane, and most labels are right: which of these counts is open.
# 3. Success and return can give opposite verdicts on a teacher: give both, from more than three
#    students.
# 4. Which teacher is enough can depend on the learner: with the half-random labels alone,
#    {{ worth()['random-50', 'soft'].escapers('soft') }} of ten agents escaped.
# 5. A rule that looks at no other car can pass a test. Test it on a road where looking matters.
#
# **Three questions to think about**
# - Could two bad teachers together be a good one? Which two of the six, and how mixed?
# - Would the half-random teacher's labels teach more if the learner were told its true p?
# - Below, the worst of your three students *asks its teacher* when they disagree, or as often at
#   random. Does disagreement mark better seconds?

# %%
worst_first = [mine_taught[place] for place in learned["success"].argsort()]
table(asking.HEADINGS, asking.compared(worst_first, mine, taught_agents.ROADS[:50]))

# %% [markdown] tags=["instructor"] minutes=3
# Answers to the three questions. (1) Ask what is missing. Once it is out, the racer looks at no
# car, and `timid` looks at none anywhere, so these two mixed do not look either. Let them try a
# mixture with `example_teachers.examine`. (2) Open. A lower p pulls more weakly towards each label,
# the right ones too: `settings_for("soft", rule_p=0.56)`. (3) Count
# the questions beside the accidents, too. Students of one teacher may agree and all be wrong.

# %% [markdown]
# **Read on**: teachers that are left behind on purpose: Uchendu et al., *Jump-Start Reinforcement
# Learning* (arXiv 2204.02372). Imitation where it pays: Nair et al., *Overcoming Exploration in
# Reinforcement Learning with Demonstrations* (arXiv 1709.10089). Counting seeds: Colas et al., *How
# Many Random Seeds?* (arXiv 1806.08295). Next: [the second trap](the_second_trap.ipynb).

# %% [markdown] tags=["instructor"]
# **On the board.** Three arrows from the teacher into the learner: actions in the memory, labels
# for the KL, drives at the start.
#
# **To discuss.** Would you rather have a teacher that is right in nine states of ten, or one that
# knows when it is wrong?
