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
# - give an agent a teacher in an environment of your choice, and compare methods with five seeds,
#   as far as five seeds go;
# - predict from a teacher's errors whether cloning is enough;
# - compute from the reward and γ how large a bonus may be before a loop pays more than the goal.
#
# **Time** 70 minutes; running it takes about one minute. **It builds on** the soft constraint
# (lesson [[soft_constraint]]), learning from demonstrations ([[learning_from_demonstrations]]) and
# your teacher ([[your_teacher]]).

# %%
from dataclasses import replace

import bootcourse as bc
import numpy as np
from bootcourse.course import charts, check, compare_predictions, predict, table
from bootcourse.course.lessons.your_own_problem import loops
from bootcourse.learn.teachers import teacher_policy
from bootcourse.research.elsewhere import settings_of
from bootcourse.research.elsewhere_claims import Cells
from bootcourse.research.elsewhere_page import figure
from bootcourse.research.problems import PROBLEMS
from bootcourse.research.results import experiment

# %% [markdown]
# ## Look first
#
# The course has one road. Does a teacher help elsewhere? Here is another problem with a barrier: a
# car in a valley, MountainCar. It pays −1 a decision until the car reaches the flag, at position
# 0.5, or 200 decisions are over. The engine is weak.
#
# > **Predict.** A driver pushes to the right in every decision. How far does the car come?

# %%
choices = ["to the flag", "close to the flag", "not out of the valley"]
predict("your_own_problem.1", "A car that is pushed right all the time comes", choices)

# %%
ours = PROBLEMS["mountain-car"].teachers()["good"]  # it sees the speed in parts of 0.07
drives = {
    "always to the right": loops.climbed(lambda position, speed: 2),
    "a rule of one line": loops.climbed(lambda *seen: ours(np.array([seen]) / (1, 0.07))[0]),
}
longest = max(len(each) for each in drives.values())
shown = {name: np.r_[x, np.full(longest - len(x), x[-1])] for name, x in drives.items()}
title = "A rule of one line swings the car up to the flag at 0.5"
bc.show(charts.lines(np.arange(longest), shown, title, "decision", "position"))

# %% [markdown]
# **See.** Pushed to the right, the car swings in the valley to the end. To get up it has to drive
# away from the flag in between: a barrier, as on the road of lesson [[the_barrier]]. A rule of one
# line does it. You write it soon; look at the figure, where it drives in which direction.
# <!-- claim: loops.climbed(lambda position, speed: 2).max() < 0 -->
# <!-- claim: loops.climbed(lambda position, speed: 2 if speed >= 0 else 0)[-1] >= 0.5 -->
#
# ## Round 1: choose a problem, write its rule
#
# Four problems, each with a rule of one line. A fifth follows in round 4.

# %% tags=["hide-input"]
about = {
    "chain": ("20 cells, the last pays 10, the wall behind you 0.05", "go right"),
    "mountain-car": ("−1 a decision until the flag", "yours, see below"),
    "acrobot": ("−1 a decision until the tip is high", "turn the joint the way it turns"),
    "cartpole": ("1 a decision while the pole stands", "push to where the pole leans"),
}
rows = [[f'"{name}"', *words, f"{PROBLEMS[name].gamma:g}"] for name, words in about.items()]
table(["problem", "it pays", "rule", "γ"], rows)

# %% [markdown]
# **Exercise (8 min, ●●○).** Write the rule of MountainCar, or your own. The check drives 20
# episodes; all must reach the flag.


# %%
def climb_rule(position, speed):
    """0: push left, 1: not at all, 2: right. position: flag at 0.5; speed: + to the right."""
    # solution: the exercise's own


check.climb_rule(climb_rule)

# %% [markdown]
# A rule may be wrong in two ways. The **random** teacher takes a wrong action in a share of the
# states that looks random. The **systematic** one makes the same error in one region, and nowhere
# else: on MountainCar, to the right of 0.1, it takes the next action instead of the right one.

# %%
PROBLEM = "mountain-car"  # or "chain", "acrobot", "cartpole"
problem, rows = PROBLEMS[PROBLEM], []
teachers = problem.teachers()
# Your own: teachers["mine"] = lambda seen: climb_rule(seen[0], 0.07 * seen[1])
for name, teacher in teachers.items():
    policy = teacher_policy(teacher, None, problem.actions)
    driven = bc.drive_episodes(policy, range(100), make_env=problem.make_env)
    rows.append([name, f"{100 * driven.success.mean():.0f}", f"{driven.returns.mean():.0f}"])
table([f"teacher, {problem.name}", "success, %", "return"], rows)

# %% [markdown] tags=["instructor"] minutes=9
# Collect problems of their own first: what is the reward, how long is the way without one, who can
# write a rule? Then ask of each rule which kind of error it makes. Most rules that people write err
# systematically: they forget a situation.

# %% [markdown]
# ## Round 2: is cloning enough?
#
# > **Predict.** The random teacher of MountainCar reaches the flag in
# > {{ percent('mountain-car', 'random', 'the teacher') }} % of its episodes. A network clones it
# > and drives by its most probable action. How often does the clone reach the flag?

# %%
choices = ["less often than its teacher", "about as often", "in nearly all episodes"]
predict("your_own_problem.2", "The clone of the random teacher reaches the flag", choices)

# %% [markdown]
# A clone sees many alike states with different labels, and its most probable action is what most of
# them say. Think of n labels, each right with probability q, independent of each other, and two
# actions.
#
# **Exercise (10 min, ●●○).** How probable is it that the majority is right?


# %%
def majority_right(right, votes):
    """P(the majority of `votes` labels is right), of each P = `right`; a tie counts half."""
    # solution: the exercise's own


check.majority_right(majority_right)

# %% tags=["hide-input"]
cells = Cells(experiment("elsewhere"))
rows = []
for teacher in ("random", "systematic"):
    row = ("mountain-car", teacher)
    scores = [cells.mean(*row, "the teacher", "success"), cells.mean(*row, "cloning", "success")]
    scores.append(cells.mean(*row, "cloning", "drawn_success"))
    rows.append([teacher, *(f"{100 * score:.0f}" for score in scores)])
headings = ["the teacher", "ten clones, most probable action", "ten clones, drawn action"]
table(["MountainCar, success in %", *headings], rows)

# %% [markdown]
# **See.** Of the random teacher's errors the clones' most probable actions keep next to nothing:
# they reach the flag in {{ percent('mountain-car', 'random', 'cloning') }} % of the
# episodes. Drawn actions repeat the errors. The systematic teacher's clones are as good as their
# teacher, and no better.
# <!-- claim: score('mountain-car', 'random', 'cloning') > 0.95 and
#   score('mountain-car', 'random', 'cloning', 'drawn_success') < 0.8 -->
# <!-- claim: abs(score('mountain-car', 'systematic', 'cloning') -
#   score('mountain-car', 'systematic', 'the teacher')) < 0.05 -->
#
# **Explain.** Where a teacher is right in 70 % of alike states, a majority of 25 labels is right in
# {{ 100 * majority_right(0.7, 25) | .0f }} %. In the region of a systematic error it is right in 0
# %, of one label or a thousand. So ask of your teacher first: which kind is it? If its errors are
# random, clone it, and compare everything else with the clone.
#
# ## Round 3: which one wins?
#
# > **Predict.** The systematic teacher of MountainCar: cloning, the soft constraint,
# > demonstrations, or both? Which reaches the flag most often? Say why before you commit.

# %%
four = ["cloning", "soft", "demonstrations", "both"]
predict("your_own_problem.3", "The flag is reached most often by", four)

# %% [markdown]
# `bc.compare` trains each of them with five seeds and tests them in the same episodes. An interrupt
# keeps what is trained.

# %% tags=["nbval-ignore-output"]
EPISODES = {"chain": 150, "mountain-car": 30, "acrobot": 20, "cartpole": 60}[PROBLEM]
quick = replace(problem, episodes=EPISODES)
compared = bc.compare(
    {name: settings_of(quick, name) for name in four},
    seeds=5,
    episodes=EPISODES,
    tests=20,
    make_env=problem.make_env,
    teacher=teachers["systematic"],
    progress=False,
)
headings, *rows = compared.rows()
table(headings, rows)

# %% tags=["nbval-ignore-output"]
bc.show(compared.figure(f"{problem.name}, the systematic teacher, five seeds"))

# %% [markdown]
# Five seeds and a short training decide little. The study has three to five times as many episodes,
# and ten seeds (of Lunar lander five): `bootcourse study elsewhere`.

# %% tags=["hide-input"]
bc.show(figure(cells))

# %% [markdown]
# **See.** On MountainCar with the systematic teacher, soft reaches the flag in
# {{ percent('mountain-car', 'systematic', 'soft') }} % of the episodes, cloning in
# {{ percent('mountain-car', 'systematic', 'cloning') }} %. On the chain, whose systematic teacher
# never arrives, soft still arrives with all ten agents. The one of CartPole balances for
# {{ score('cartpole', 'systematic', 'the teacher', 'returns') | .0f }} decisions; all agents of
# soft, and of both, balance for all 500.
# <!-- claim: all((cells().scores('cartpole', 'systematic', m) == 500).all()
#   for m in ('soft', 'both')) -->
# <!-- claim: score('mountain-car', 'systematic', 'soft') > 0.95 and
#   score('mountain-car', 'systematic', 'cloning') < 0.85 -->
# <!-- claim: score('chain', 'systematic', 'the teacher') == 0 and
#   (cells().scores('chain', 'systematic', 'soft', 'success') == 1).all() -->
# <!-- claim: max(['cloning', 'soft', 'demonstrations', 'both'],
#   key=lambda m: score('mountain-car', 'systematic', m)) == 'soft' -->
#
# **Explain.** ξ fades, and then the reward corrects the error. We think that it can do so if the
# teacher leads near enough to the reward. On Acrobot the systematic teacher does not: of the ten
# agents of each of cloning, soft, demonstrations and both, none succeeds in any test episode. And
# look at the returns: on MountainCar soft arrives more often than cloning, but later, so that it
# earns no more.
#
# Lunar lander, with five agents in each cell, shows another order: with each teacher soft is behind
# cloning, and both is far ahead of soft. So soft's lead is not a law.
# <!-- claim: all(score('lander', t, 'soft', 'returns') + 30 < score('lander', t, 'both', 'returns')
#   and score('lander', t, 'soft') < score('lander', t, 'cloning') - 0.3 for t in ('good', 'random',
#   'systematic')) and len(cells().scores('lander', 'good', 'soft')) == 5 -->
# <!-- claim: all(score('acrobot', 'systematic', m) == 0 for m in ('cloning', 'soft',
#   'demonstrations', 'both')) -->
# <!-- claim: [c.verdict for c in elsewhere_claims.claims_of('H3', cells())[0] if
#   c.where.startswith('MountainCar')] == ['open', 'open'] -->
#
# Six hypotheses were written down before the study ran. Not all survived: the report,
# `assets/report/elsewhere.md`, has the verdict on each.
# <!-- claim: any(elsewhere_claims.verdict(h, cells()).startswith('fails')
#   for h in ('H1', 'H2', 'H3', 'H4', 'H5', 'H6')) -->

# %% [markdown] tags=["instructor"] minutes=10
# Let them defend their choice for one row of the figure that nobody has looked at yet. Who says
# "both, because more is better"? The rows of MountainCar say otherwise. Ask for the weakest
# opponent: plain SAC here has the paper's target entropy of −1.

# %% [markdown]
# ## Round 4: DoorKey, a goal that pays once
#
# A room, a key, a locked door, a goal behind it that pays 1 − 0.9 t / 100 after t of at most 100
# decisions, and nothing else. The observation is the state, without the time. Plain SAC reaches the
# goal in {{ percent('doorkey', 'random', 'SAC') }} % of the test episodes by its most probable
# actions.
#
# > **Predict.** The teacher is right in 80 % of the states. Ten agents learn by both, soft
# > constraint and demonstrations with the paper's bonus c = 2. How often do they reach the goal, by
# > their most probable actions?

# %%
choices = ["less often than plain SAC", "about as often", "more often"]
predict("your_own_problem.4", "Both, with c = 2, reaches the goal", choices)

# %%
# NBVAL_CHECK_OUTPUT
teacher, rows = PROBLEMS["doorkey"].teachers()["random"], []
for seed in range(6):
    states, reached = loops.rooms(teacher, seed)
    earned = 1 - 0.9 * len(states) / 100 if reached else 0.0
    back = loops.circle(states) or "–"
    paid = f"{earned + 2 * len(states):.1f}"
    rows.append([seed, "the goal" if reached else "a circle", back, f"{earned:.2f}", paid])
table(["drive", "it ends in", "of how many decisions", "return", "with c = 2"], rows)

# %% [markdown]
# The teacher errs in a state *whenever it comes back to it*, so some of its drives turn in circles
# to the end. Such a demonstration is worth 200 with the bonus.
#
# **Exercise (18 min, ●●●).** A loop earns `reward` + c in each decision, for ever: time that is
# over does not terminate. The way to the goal takes `decisions` decisions that earn `reward` each,
# the last one also `goal`; then the episode ends. The first `shown` of them are in the
# demonstrations and earn c, too. At which c are both worth the same, discounted?


# %%
def drowning_bonus(reward, goal, decisions, shown, gamma):
    """The c above which the loop is worth more than the way to the goal. shown: 0 to decisions."""
    # solution: the exercise's own


check.drowning_bonus(drowning_bonus)

# %% tags=["hide-input"]
rows, names = [], ("demonstrations", "both", "both, c = 0", "soft", "SAC")
for teacher in ("good", "random", "systematic"):
    row = [teacher]
    for method in names:
        tests = [cells.mean("doorkey", teacher, method, s) for s in ("success", "drawn_success")]
        row.append(" / ".join(f"{100 * share:.0f}" for share in tests))
    rows.append(row)
below = "The most probable actions / drawn actions. SAC has no teacher: the same in each row."
table(["DoorKey, success in %", *names], rows, below)

# %% [markdown]
# **See.** With c = 2 a flawed teacher drowns the goal: both reaches it in next to no test episode,
# by either kind of action. Without the bonus the picture depends on *how you test*. By their most
# probable actions the agents that the random teacher taught succeed less often than plain SAC; by
# drawn actions they succeed about as often ({{ percent('doorkey', 'random', 'soft',
# 'drawn_success') }} % with the soft constraint, {{ percent('doorkey', 'random', 'SAC',
# 'drawn_success') }} % plain). We think that drawn actions leave a circle that the most probable
# ones repeat. The systematic teacher's agents stay behind plain SAC in both tests.
# <!-- claim: all(score('doorkey', t, 'both', s) < 0.005 for t in ('random', 'systematic') for s in
#   ('success', 'drawn_success')) -->
# <!-- claim: all(score('doorkey', 'random', m) < score('doorkey', 'random', 'SAC') - 0.1 and
#   abs(score('doorkey', 'random', m, 'drawn_success') - score('doorkey', 'random', 'SAC',
#   'drawn_success')) < 0.1 for m in ('soft', 'both, c = 0')) -->
# <!-- claim: all(score('doorkey', 'systematic', m, s) < score('doorkey', 'random', 'SAC', s) for m
#   in ('demonstrations', 'both', 'both, c = 0', 'soft') for s in ('success', 'drawn_success')) -->
#
# **Explain.** If the whole way is shown, the limit is c = (1 − γ) · goal / γ − reward. Here that is
# {{ drowning_bonus(0, 1, 1, 1, 0.97) | .3f }}, and the bonus is 2. On MountainCar, at −1 a
# decision, it is 1. There the bonus is above the limit, too; but a drive of MountainCar hardly ever
# returns to the same state, so its demonstrations hold no circle to learn from. Even the good
# teacher's demonstrations alone fail on DoorKey: an agent can step back and walk the shown way
# again, and half of its decisions earn 2. We think that this is what happens; the figure shows only
# that it fails.
# <!-- claim: score('doorkey', 'good', 'demonstrations') < 0.1 -->

# %% [markdown] tags=["instructor"] minutes=9
# Ask for a bonus that cannot be earned in a circle. A potential (lesson [[the_second_trap]]) is
# one: what a circle gains it gives back.

# %% [markdown]
# ## Before you use it on your problem
#
# 1. **Is there a barrier?** Train plain SAC with a usable target entropy first, 0.3 log |A|. If it
#    does well, a teacher has to be good to be worth it: on DoorKey the good one was, and the
#    systematic one was not.
# <!-- claim: score('doorkey', 'good', 'soft') >
#   score('doorkey', 'good', 'SAC, η = 0.3 log |A|') -->
# 2. **Is the teacher's error random or systematic?** Random, and states do not come back: clone it.
#    Systematic: try the soft constraint, and ask first whether the teacher comes near the reward.
# 3. **Does c drown the reward?** Compute the limit. Above it, take c = 0.
# 4. **Is cloning enough?** Put the clone into every table.
# 5. **Do states come back?** Then test drawn actions, too: the order of methods can change.
#
# **Bring one.** Any gymnasium environment with vector observations and discrete actions:
#
# ```python
# make_env = lambda n: gym.make_vec("LunarLander-v3", n)
# def my_rule(observation): ...  # returns a whole number
# entries = {"cloning": bc.settings_for("bc"), "soft": bc.settings_for("soft", gamma=0.99)}
# bc.compare(entries, seeds=5, episodes=100, make_env=make_env, teacher=my_rule)
# ```
#
# ## What you now know
#
# 1. A teacher, a learner and an environment are three independent choices.
# 2. Cloning takes the majority: random errors vanish where states do not come back, systematic ones
#    stay.
# 3. The soft constraint corrected a systematic error on the chain, on MountainCar and on CartPole,
#    and did not on Acrobot, DoorKey and Lunar lander.
# 4. A bonus a decision can make a circle worth more than the goal, and a formula says when.
#
# **Three questions to think about**
# - Where does the rule of the road err systematically, and what did the agents correct?
# - Is c = 2 above the limit on the road of the course? Which loop would it pay for?
# - What would you need to know to trust one row of the figure for a problem that is not in it?

# %%
compare_predictions(
    "your_own_problem",
    {
        1: "not out of the valley",
        2: "in nearly all episodes",
        3: max(four, key=lambda m: cells.mean("mountain-car", "systematic", m, "success")),
        4: "less often than plain SAC",
    },
)

# %% [markdown] tags=["instructor"] minutes=6
# Answers to the three questions. (1) Its sight of 200 m keeps it slow behind the traffic; all good
# agents drive faster. (2) Staying behind trap 1 pays about 0.16 a decision and never ends, so every
# c > 0 that is paid there for ever would help staying; the demonstrations leave the trap, so they
# pay for leaving. (3) The horizon without reward, the kind of the error, whether states come back:
# the figure has few problems, chosen by us.

# %% [markdown]
# **Read on**: the report's page *When does a sub-optimal teacher help?*,
# `assets/report/elsewhere.md`. Chevalier-Boisvert et al., *Minigrid & Miniworld* (arXiv
# 2306.13831), where DoorKey is from.
