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
# # Traffic
#
# **What you will be able to do**
# - write down how the other cars follow (IDM), and simulate a row of them;
# - start a traffic jam with one slow driver, and find out which drivers prevent it;
# - find out when a simulated car swings off the road.
#
# **Time** 37 minutes; running it takes under one minute. An appendix for those who write or choose
# a simulator: no other lesson needs it. **It builds on** [lesson [[the_trap]]](the_trap.ipynb).

# %%
import dataclasses
import math

import bootcourse as bc
import numpy as np
from bootcourse.course import check, compare_predictions, predict, predicted, progress, table
from bootcourse.course.lessons.traffic import figures as figures_traffic
from bootcourse.course.lessons.traffic import simulation as traffic

progress("traffic")

# %% [markdown]
# ## Look first
#
# Thirty drivers go round a ring with one lane. Overtaking is not possible, and each driver follows
# the same formula. They begin at the speed that they can hold at their distance, but for one, which
# begins at 1 m/s. Each line in the picture is one car; half of the cars are drawn. On the left the
# cars are 20 m apart on average, on the right 35 m.

# %% tags=["hide-input"]
rings = {f"{spacing} m apart": traffic.ring(spacing) for spacing in (20, 35)}
title = "At 20\u00a0m a disturbance grows into a jam; at 35\u00a0m it dies out"
bc.show(figures_traffic.space_time(rings, dt=0.5, title=title))

# %% [markdown]
# > **Predict.** At 20 m each car has four car lengths of road, its own included, and yet cars stop.
# > The band of standing cars moves *backwards*, while the cars drive forwards. Why? (Round 3 comes
# > back to it.)

# %%
choices = [
    "the slow driver stays in it and falls back, and the others wait behind",
    "the same cars stay in it and need more and more room, each behind the one ahead",
    "cars leave it at its front and join it at its back",
]
predict("traffic.1", "Why does the band move backwards?", choices)

# %% [markdown] tags=["instructor"] minutes=4
# Let them find the band's speed: from 100 to 400 s it goes back by about 380 m, 1.3 m/s. The band
# is a place where cars stop, not a group of cars: cars leave it at its front and join it at its
# back. A ring of real cars did the same: Sugiyama et al., *New Journal of Physics* 10 (2008)
# 033001.

# %% [markdown]
# ## Round 1: the gap that a driver wants
#
# The other cars follow the **Intelligent Driver Model** (IDM). It begins with the gap that a driver
# wants. The driver's speed is $v$, and $\Delta v$ is $v$ minus the speed of the car ahead:
#
# $$ s^*(v, \Delta v) = s_0 + T v + \frac{v\, \Delta v}{2 \sqrt{a_{\max} b}} $$
#
# Distances go from centre to centre, as highway-env measures them: subtract one car's length to get
# the free space. $s_0$ is the gap at a standstill. $T$ is a **time gap**: the driver wants to be
# $T$ seconds behind the car ahead, which is more metres at a higher speed. The last term asks for
# more room while the driver closes in; $a_{\max}$ is the strongest acceleration, and $b$ a
# comfortable braking.
#
# > **Predict.** $s_0$ = 10 m, $T$ = 1.5 s, $a_{\max} = b$ = 0.5 m/s². At 10 m/s you want 25 m
# > behind a car that drives 10 m/s, too. What gap do you want behind one at 8 m/s?

# %%
predict("traffic.2", "Which gap do you want behind the car at 8 m/s?", unit="m")

# %% [markdown]
# **Exercise (4 min, ●○○).** Write the gap $s^*$ that a driver wants.


# %%
def desired_gap(v, dv, s0, time_gap, a_max, b):
    """s* in m. v and dv (own minus theirs) in m/s, s0 in m, time_gap in s, a_max and b in m/s²."""
    # solution
    return s0 + time_gap * v + v * dv / (2 * math.sqrt(a_max * b))
    # end solution


check.desired_gap(desired_gap)

# %% [markdown]
# **Answer.** {{ formulas.desired_gap(10, 2, 10, 1.5, 0.5, 0.5) | g }} m: a difference of two metres
# per second nearly doubles the gap that the driver wants.
# <!-- claim: formulas.desired_gap(10, 0, 10, 1.5, 0.5, 0.5) == 25 -->
# <!-- claim: 1.7 < formulas.desired_gap(10, 2, 10, 1.5, 0.5, 0.5) / formulas.desired_gap(10, 0, 10,
#   1.5, 0.5, 0.5) < 2 -->

# %% [markdown]
# ## Round 2: how hard to brake
#
# The acceleration weighs two wishes: to drive at the desired speed, and to keep the gap. $s$ is the
# gap that there is. The exponent $\delta$ (here {{ DEFAULT.traffic.delta | g }}) says how late the
# acceleration fades as the driver nears its desired speed: the larger $\delta$, the later.
#
# $$ a = a_{\max} \left[ 1 - \left( \frac{v}{v_\text{desired}} \right)^{\delta} - \left(
# \frac{s^*}{s} \right)^2 \right] $$
#
# > **Predict.** A driver has exactly the desired speed and exactly the desired gap, $s^*$. Does the
# > driver accelerate, hold the speed, or brake?

# %%
predict(
    "traffic.3",
    "At the desired speed and the desired gap, what does the driver do?",
    ["accelerate", "hold", "brake"],
)

# %% [markdown]
# **Answer.** The driver brakes at $a_{\max}$: the bracket is 1 − 1 − 1. So a driver settles at a
# gap longer than $s^*$: where the dashed line of the next picture crosses zero.
# <!-- claim: formulas.idm_acceleration(12.5, 12.5, 25.0, 25.0, 0.5, 4.0) == -0.5 -->

# %%
predicted("traffic.3")
t = bc.DEFAULT.traffic
title = "At 10\u00a0m/s a driver who closes in brakes much earlier"
bc.show(figures_traffic.following(10.0, title))

# %% [markdown]
# A simulation repeats one step. It computes the acceleration a from the present speeds and the
# present gap. Here a is at least −{{ DEFAULT.traffic.braking_limit | g }} m/s²: no car brakes
# harder. For dt seconds both cars move at their present speeds. Then the driver's speed changes by
# a · dt, but it does not fall below 0.
# <!-- claim: traffic.follow(10.0, 10.0, 0.1) == -DEFAULT.traffic.braking_limit -->
#
# **Exercise (15 min, ●●●).** Simulate a driver behind a car whose speeds are given. You need
# both formulas, a loop, and the right order inside it.


# %%
def drive_behind(leader, v, gap, dt, v_desired, s0, time_gap, a_max, b, delta, limit):
    """The gap (m) and the speed (m/s) at the start and after each step: (steps,) -> (steps + 1, 2).

    leader: speeds of the car ahead in each step, m/s; v (m/s) and gap (m): at the start; dt in s;
    limit: the hardest braking, a positive number (m/s²). The other numbers are those of IDM.
    """
    # solution: the exercise's own


check.drive_behind(drive_behind)

# %% [markdown]
# Here eight of the library's drivers follow each other, {{ SETTLED }} m apart, a distance at which
# they hold 10 m/s. Their leader, which follows no formula, drives 10 m/s, brakes to 4 m/s within
# 2 s, stays there for 18 s, and takes 4 s to get back to 10 m/s.
# <!-- claim: abs(traffic.follow(10.0, 0.0, SETTLED)) < 1e-3 -->

# %% tags=["hide-input"]
drivers = traffic.row(traffic.leader(4.0))
title = "Each driver brakes to a lower speed than the one ahead"
bc.show(figures_traffic.row(traffic.leader(4.0), drivers, dt=0.5, title=title))

# %%
# NBVAL_CHECK_OUTPUT
for slowest in (4.0, 8.0):
    lowest = ", ".join(f"{v.min():.2f}" for v in traffic.row(traffic.leader(slowest)))
    print(f"leader down to {slowest:g} m/s, drivers 1 to 8 down to {lowest}")

# %% [markdown]
# **See.** The first driver comes too close and has to open the gap again, so for a moment it is
# slower than the leader. From driver to driver the lowest speed falls. A gentler disturbance dies
# out: behind a leader that slows down to 8 m/s, each driver slows down less than the one ahead.
# <!-- claim: (np.diff([8.0, *lowest_speeds(8.0)]) > 0).all() -->
# <!-- claim: (np.diff([4.0, *lowest_speeds(4.0)]) < 0).all() -->

# %% [markdown]
# ## Round 3: which disturbances grow into a jam?
#
# At which gap does a driver settle, behind a car that drives $v$ all the time?

# %%
# NBVAL_CHECK_OUTPUT
rows = []
for v in (1.0, 6.2, 10.3, 12.0):
    wanted = bc.formulas.desired_gap(v, 0.0, t.s0, t.time_gap, t.a_max, t.b)
    settled = traffic.behind(np.full(20_000, v), v, wanted)[-1, 0]  # 10,000 s behind this speed
    rows.append([f"{v:g} m/s", f"{wanted:.1f} m", f"{settled:.1f} m"])
table(["speed", "wants s*", "settles at"], rows)

# %% [markdown]
# **See.** Cars that settle about 20 m apart drive 6.2 m/s, about 35 m apart 10.3 m/s. That is how
# fast the two rings are without a disturbance. (Set $a = 0$: the gap is $s^* / \sqrt{1 - (v /
# v_\text{desired})^\delta}$, which grows without limit as $v$ nears the desired speed.)
# <!-- claim: abs(28.0 / math.sqrt(1 - (12 / 12.5) ** DEFAULT.traffic.delta) - 72.1) < 0.1 -->
# <!-- claim: round(traffic.settled_speed(20), 1) == 6.2 and round(traffic.settled_speed(35), 1) ==
#   10.3 -->
#
# Here are the rings again for 800 s, with one of 30 m, and with larger and smaller disturbances:

# %%
# NBVAL_CHECK_OUTPUT
rows = []
for words in ("1 m/s", "3 m/s", "0.1 m/s less than the others"):
    row = [words]
    for spacing, dt in ((20, 0.5), (35, 0.5), (30, 0.5), (30, 0.1)):
        first = traffic.settled_speed(spacing) - 0.1 if words.startswith("0") else float(words[0])
        row.append(f"{traffic.ring(spacing, first, seconds=800, dt=dt)[1][-1].min():.1f} m/s")
    rows.append(row)
headings = ["one car begins at", "slowest car in the end, 20 m apart", "35 m", "30 m"]
table([*headings, "30 m, in steps of 0.1 s"], rows)

# %% [markdown]
# **See.** At 20 m a car that is 0.1 m/s too slow is enough for a jam, at 35 m a car at 1 m/s is
# not. At 30 m a car that begins at 1 m/s starts a jam in steps of 0.5 s, and none in steps of 0.1
# s: that jam is made by the simulation, not by the drivers. **Halve the time step and compare**
# before you believe what a simulation shows. (The other results of this round stay with steps of
# 0.1 s.)
# <!-- claim: slowest(20, traffic.settled_speed(20) - 0.1) < 0.1 and slowest(30, 1.0) < 0.1 and
#   slowest(30, 3.0) > 9.5 and slowest(35, 1.0) > 10.3 -->
# <!-- claim: slowest(30, 1.0, dt=0.1) > 9.5 and slowest(20, 1.0, dt=0.1) < 0.1 and slowest(35, 1.0,
#   dt=0.1) > 10.3 and slowest(20, 1.0, 1.5, 0.5 / 3, 0.1) > 6.2 and slowest(20, 1.0, 0.5, 0.5 / 3,
#   0.1) > 6.2 and slowest(20, 1.0, 0.5, 1.5, 0.1) < 0.1 -->
#
# Which drivers prevent the jam at 20 m? Two suspects: drivers react weakly, since $a_{\max}$ scales
# all that they do, speeding up after a jam and braking before it; and they mind the closing speed
# too little, the last term of $s^*$. Change one of the two at a time.
#
# > **Predict.** *A:* $a_{\max}$ is three times as large, so all drivers speed up and brake three
# > times as strongly, and $b$ is a third, so that the last term of $s^*$ stays what it is. *B:* $b$
# > alone is a third, so that this term becomes 1.7 times as large. Which of the two prevents the
# > jam?

# %%
choices = ["A alone", "B alone", "each of them", "neither"]
predict("traffic.4", "Which change prevents the jam?", choices)

# %%
# NBVAL_CHECK_OUTPUT
predicted("traffic.4")
tried = {"as it is": (1, 1), "A: stronger reactions": (3, 1 / 3)}
tried |= {"B: minds the closing speed more": (1, 1 / 3), "minds it less": (1, 3)}
rows = []
for name, (more, other) in tried.items():
    drivers = dataclasses.replace(t, a_max=more * t.a_max, b=other * t.b)
    slowest = traffic.ring(20, seconds=800, traffic=drivers)[1][-1].min()
    term = f"times {1 / math.sqrt(more * other):.1f}"
    rows.append([name, f"{drivers.a_max:g}", f"{drivers.b:.2f}", term, f"{slowest:.1f} m/s"])
table(["drivers", "a_max (m/s²)", "b (m/s²)", "last term of s*", "slowest car in the end"], rows)

# %% [markdown]
# **See.** Each of the two prevents it in this ring. But A changes two reactions at once. Which half
# of it prevents the jam, speeding up or braking? Here one half is stronger, the other as it was:
# <!-- claim: slowest(20, 1.0) < 0.1 and slowest(20, 1.0, 1.5, 0.5 / 3) > 6.2 and slowest(20, 1.0,
#   0.5, 0.5 / 3) > 6.2 and slowest(20, 1.0, 0.5, 1.5) < 0.1 -->

# %%
# NBVAL_CHECK_OUTPUT
rows = []
for factor, words in ((2, "twice as strong"), (3, "three times")):
    halves = traffic.stronger(speeding_up=factor), traffic.stronger(braking=factor)
    rings = [traffic.ring(20, seconds=1600, acceleration=half)[1][-1] for half in halves]
    rows.append([words, *(f"{speeds.min():.1f} m/s" for speeds in rings)])
table(["slowest car after 1,600 s", "only speeding up is stronger", "only braking"], rows)

# %% [markdown]
# **Explain.** Three times is enough in either half. So the jam in this ring needs drivers who are
# weak in both *and* who mind the closing speed little. Twice is enough for speeding up and not for
# braking: here it matters more how fast cars leave the jam than how hard they brake before it. The
# band moves backwards, since cars leave it at its front and join it at its back.
# <!-- claim: in_halves(3, 1) > 6.2 and in_halves(1, 3) > 6.2 and in_halves(2, 1) > 6.2 and
#   in_halves(1, 2) < 0.1 -->

# %% [markdown] tags=["instructor"] minutes=5
# Ask for a ring of 25 m: does the jam stay or dissolve? It depends on how slowly the first car
# begins: `traffic.ring(25, first=5.0)` and `traffic.ring(25, first=1.0)` end differently, with
# `dt=0.1`, too. The ring has two stable states there.
# <!-- claim: slowest(25, 5.0) > 8 and slowest(25, 1.0) < 0.1 and slowest(25, 5.0, dt=0.1) > 8 and
#   slowest(25, 1.0, dt=0.1) < 0.1 -->

# %% [markdown]
# ## Round 4: two steps a second
#
# To change lane, a traffic car turns towards a heading and back. It turns at a rate that is
# proportional to the error: (wanted heading − heading) / τ, where τ is a **time constant**. Our
# simulation makes {{ DEFAULT.clock.simulation_rate }} steps a second, as the paper's does: the rate
# is held for a whole step of dt = {{ DEFAULT.clock.dt }} s.
#
# > **Predict.** highway-env's own τ is 0.2 s, and it usually makes 15 steps a second. What happens
# > with this τ at 2 steps a second to a heading error of 1°?

# %%
choices = ["it settles in one step", "it swings and settles", "it swings and grows"]
predict("traffic.5", "What happens to the heading error at 2 Hz?", choices)

# %% [markdown]
# **Exercise (6 min, ●●○).** Write the heading error after each step of dt.


# %%
def heading_errors(error, tau, dt, steps):
    """The heading error at the start and after each step: (steps + 1,). tau and dt in s."""
    # solution: the exercise's own


check.heading_errors(heading_errors)

# %%
predicted("traffic.5")
bc.show(figures_traffic.swinging(taus=(0.2, 0.3, 0.6), dt=bc.DEFAULT.clock.dt))

# %% [markdown]
# **Explain.** For the heading alone, each step multiplies the error by $1 - dt/\tau$. With a factor
# of 0 the error is gone in one step, and between 0 and 1 it settles; between −1 and 0 it swings and
# settles; at −1 it swings for ever; below −1, that is for **dt / τ above 2**, it swings and grows.
# The differential equation is stable for every positive τ, the *simulation* is not.
#
# A car that keeps its lane corrects its offset from the lane's centre, too, and this outer loop
# depends on the speed. So dt / τ below 2 is necessary, not sufficient: a heading that settles on
# its own can still swing in the full loop, above all in a slow car. That is why the next cell
# drives.
# <!-- claim: 0 < 1 - 0.5 / 0.6 < 1 and -1 < 1 - 0.5 / 0.3 < 0 and 1 - 0.5 / 0.2 < -1 and 0.5 / 0.3
#   < 2 < 0.5 / 0.2 -->


# %%
def broken(tau_heading, tau_lateral, rate=2, roads=100):
    """Shares of roads on which a traffic car leaves the road, and on which traffic collides."""
    traffic = dataclasses.replace(
        bc.DEFAULT.traffic, tau_heading=tau_heading, tau_lateral=tau_lateral
    )
    clock = dataclasses.replace(bc.DEFAULT.clock, simulation_rate=rate)
    scenario, road = dataclasses.replace(bc.DEFAULT, traffic=traffic, clock=clock), bc.DEFAULT.road
    drives = [drive.states for drive in bc.record(bc.idle_policy, range(roads), scenario)]
    middle, half = road.lane_width * (road.lanes - 1) / 2, road.lane_width * road.lanes / 2
    off = [np.any(abs(s[:, bc.state.TRAFFIC :, bc.state.Y] - middle) > half) for s in drives]
    hit = [s[:, bc.state.TRAFFIC :, bc.state.CRASHED].any() for s in drives]
    return np.mean(off), np.mean(hit)


# %% tags=["hide-input"]
tried = {"highway-env's, 2 Hz": (0.2, 0.6, 2), "highway-env's, 15 Hz": (0.2, 0.6, 15)}
tried["ours, 2 Hz"] = (t.tau_heading, t.tau_lateral, 2)
rows = []
for name, numbers in tried.items():
    factor = 1 - 1 / numbers[2] / numbers[0]
    rows.append(
        [name, f"{factor:.2f}".replace("-", "−"), *(f"{share:.0%}" for share in broken(*numbers))]
    )
headings = ["factor of a step", "roads where a car leaves the road", "where cars crash"]
table(["time constants", *headings], rows)

# %% [markdown]
# **See.** With highway-env's time constants at 2 Hz, traffic cars leave the road although you do
# nothing to disturb them. An agent that trains there learns to drive among cars that swerve off the
# road, and its table of results does not show that. So our own cars have longer time constants.
# Before you believe a simulator, look at all of its cars, and not just at the one that you train.
# (`bootcourse.road.formulas.lane_keeping_steering` is the controller.)

# %% [markdown] tags=["instructor"] minutes=3
# Ask where else a rate meets a time step: gradient descent with a learning rate times a curvature
# above 2 diverges in the same way, with the same alternating signs. Draw that on the board.
# <!-- claim: abs(1 - 1.99) < abs(1 - 2) == 1 < abs(1 - 2.01) -->

# %%
backwards = "cars leave it at its front and join it at its back"
compare_predictions(
    "traffic",
    {
        1: backwards,
        2: bc.formulas.desired_gap(10.0, 2.0, 10.0, 1.5, 0.5, 0.5),
        3: "brake",
        4: "each of them",
        5: "it swings and grows",
    },
)

# %% [markdown]
# ## What you now know
#
# 1. IDM brakes for the closing speed as well as for the gap, and settles at more than $s^*$.
# 2. The closer together cars settle, the slower they drive. If they are close, a small disturbance
#    grows into a jam that travels backwards; farther apart a large one does, and a small one dies
#    out; still farther apart both die out in the runs here.
# 3. Drivers who react more strongly, or who mind the closing speed more, prevent the jam in the
#    ring of 20 m. A change of one parameter can change two things: test the halves.
# 4. A simulated heading swings and grows if dt / τ exceeds 2, even though its differential equation
#    is stable. Below 2 it settles on its own; whether the whole car does has to be tested.
# <!-- claim: abs(1 - 1.99) < abs(1 - 2) == 1 < abs(1 - 2.01) -->
#
# **Three questions to think about**
# - The traps are IDM cars, too, with a desired speed of 10 m/s. What would trap 1 do if you
#   stopped behind it? And if you stopped in front of it?
# - The traffic cars react to your car as to any other. How could a learner take advantage of that?
# - Does a traffic jam ahead of the traps make it easier or harder to get out?
#
# **Read on**: Treiber, Hennecke and Helbing, *Congested traffic states in empirical observations
# and microscopic simulations* (2000), for IDM. The cars also change lane, by a rule called MOBIL
# (`bootcourse.road.traffic.worth_changing`): Kesting, Treiber and Helbing, *General lane-changing
# model MOBIL for car-following models* (2007).

# %% [markdown] tags=["instructor"]
# *Model answers to the three questions:*
#
# - **Trap 1 and you.** Behind it you do not exist for trap 1: IDM looks at the car ahead. In front
#   of it you are its leader. If you stop there, it brakes, up to {{ DEFAULT.traffic.braking_limit |
#   g }} m/s², and stops behind you if the gap allows it.
# - **To take advantage.** A learner can push in just ahead of a traffic car and let it brake, since
#   IDM avoids the crash for it. What it learns then fails among drivers who react more slowly.
# - **A jam ahead.** The traps slow down with it, and the jam may reach you. But slower traps are
#   easier to pass, and the left lane may jam as well. Which effect wins is an experiment:
#   `dataclasses.replace(bc.DEFAULT.traffic, headway=20.0, lead=20.0)`.
