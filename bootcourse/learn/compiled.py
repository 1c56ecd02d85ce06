"""One update of one agent in compiled code: forward, backward by hand, Adam, Polyak averaging.

The same as `textbook.py`, with no torch: numba compiles it natively and, from this very text, to WebAssembly for the
page. A test holds its slopes against the textbook's. Every argument is a record of records.py; `m` is a record's
matrix. Numbers are float32: one Python float such as 0.0 would make a loop float64, so constants stand below.
"""

import math

import numpy as np

from bootcourse.learn.records import ACTIONS, BATCH
from bootcourse.learn.vectorised import vectorised

ZERO, ONE, TWO, ROWS = np.float32(0), np.float32(1), np.float32(2), np.float32(BATCH)
TENTH, THOUSANDTH = np.float32(0.1), np.float32(0.001)  # 1 - β1 and 1 - β2 of Adam: torch's defaults
KEPT = np.float32(0.999)  # β2
SMALL = np.float32(1e-8)  # ε of Adam
TINY = np.float32(1e-30)  # smaller averages count as 0: arithmetic on denormal numbers is slow


@vectorised
def add_product(x, y, out):
    """out += x y: matrices (n, k), (k, m), (n, m). Tiles of two rows and four columns of x keep the processor busy."""
    for i in range(0, x.m.shape[0], 2):
        for k in range(0, x.m.shape[1], 4):
            a, b, c, d = x.m[i, k], x.m[i, k + 1], x.m[i, k + 2], x.m[i, k + 3]
            e, f, g, h = x.m[i + 1, k], x.m[i + 1, k + 1], x.m[i + 1, k + 2], x.m[i + 1, k + 3]
            for j in range(y.m.shape[1]):
                p, q, r, s = y.m[k, j], y.m[k + 1, j], y.m[k + 2, j], y.m[k + 3, j]
                out.m[i, j] += a * p + b * q + c * r + d * s
                out.m[i + 1, j] += e * p + f * q + g * r + h * s


@vectorised
def clear(out):
    """Set a matrix to 0."""
    for i in range(out.m.shape[0]):
        for j in range(out.m.shape[1]):
            out.m[i, j] = ZERO


@vectorised
def product(x, y, out):
    """out = x y."""
    clear(out)
    add_product(x, y, out)


@vectorised
def transpose(x, out):
    """Set a matrix to the transpose of another: a product runs along the rows of both its factors."""
    for j in range(x.m.shape[1]):
        for i in range(x.m.shape[0]):
            out.m[j, i] = x.m[i, j]


@vectorised
def dense(w, b, x, out):
    """out = W x + b; each column of x and out belongs to one state."""
    for i in range(out.m.shape[0]):
        for j in range(out.m.shape[1]):
            out.m[i, j] = b.m[0, i]
    add_product(w, x, out)


@vectorised
def sum_columns(x, out):
    """Set the one row of `out` to the sums of another matrix's rows, over its columns."""
    for i in range(x.m.shape[0]):
        total = ZERO
        for j in range(x.m.shape[1]):
            total += x.m[i, j]
        out.m[0, i] = total


@vectorised
def relu(x):
    """max(x, 0), in place."""
    for i in range(x.m.shape[0]):
        for j in range(x.m.shape[1]):
            x.m[i, j] = max(x.m[i, j], ZERO)


@vectorised
def through_relu(x, slopes):
    """The slopes before a ReLU from those behind it, in place; x is what it returned."""
    for i in range(x.m.shape[0]):
        for j in range(x.m.shape[1]):
            slopes.m[i, j] = slopes.m[i, j] if x.m[i, j] > ZERO else ZERO


@vectorised
def forward(network, states, layers):
    """What each layer of a network holds for these states, with ReLU between the layers: `layers`."""
    dense(network.w_1, network.b_1, states, layers.one)
    relu(layers.one)
    dense(network.w_2, network.b_2, layers.one, layers.two)
    relu(layers.two)
    dense(network.w_3, network.b_3, layers.two, layers.out)


@vectorised
def backward(network, states, layers, work, slopes):
    """The slopes of a loss in a network's weights and biases, by the chain rule from the last layer to the first.

    With y = W x + b: dL/dW = dL/dy xᵀ, dL/db = dL/dy summed over the batch, dL/dx = Wᵀ dL/dy. work.out_slopes are the
    loss's slopes in the outputs; states (batch, inputs) are the transpose of what `forward` was given.
    """
    transpose(layers.two, work.hidden_across)
    product(work.out_slopes, work.hidden_across, slopes.w_3)
    sum_columns(work.out_slopes, slopes.b_3)

    transpose(network.w_3, work.w_3_across)
    product(work.w_3_across, work.out_slopes, work.two_slopes)
    through_relu(layers.two, work.two_slopes)
    transpose(layers.one, work.hidden_across)
    product(work.two_slopes, work.hidden_across, slopes.w_2)
    sum_columns(work.two_slopes, slopes.b_2)

    transpose(network.w_2, work.w_2_across)
    product(work.w_2_across, work.two_slopes, work.one_slopes)
    through_relu(layers.one, work.one_slopes)
    product(work.one_slopes, states, slopes.w_1)
    sum_columns(work.one_slopes, slopes.b_1)


@vectorised
def policy(logits, pi, log_pi):
    """π(a|s), softmax, and its logarithm: the columns of three matrices."""
    for i in range(logits.m.shape[1]):
        highest = logits.m[0, i]
        for a in range(1, ACTIONS):
            highest = max(highest, logits.m[a, i])
        total = ZERO
        for a in range(ACTIONS):
            pi.m[a, i] = math.exp(logits.m[a, i] - highest)
            total += pi.m[a, i]
        norm = highest + math.log(total)
        for a in range(ACTIONS):
            pi.m[a, i] /= total
            log_pi.m[a, i] = logits.m[a, i] - norm


@vectorised
def log_rule(action, rule_action, s):
    """log π̃(a|s) (Equation 16): log p for the rule's action, log((1-p)/8) for each other."""
    return s.log_p if action == rule_action else s.log_others


@vectorised
def strength(alpha, s):
    """ξ = 200 α (Equation 15), or a fixed one; at least s.xi_min."""
    return max(s.xi_multiplier * alpha if math.isnan(s.xi_fixed) else s.xi_fixed, s.xi_min)


@vectorised
def kl_to_rule(work, i, rule_action, s):
    """D_KL(π(·|s) ‖ π̃(·|s)) in state i, the soft constraint of Equation 15, in nats."""
    kl = ZERO
    for a in range(ACTIONS):
        kl += work.pi.m[a, i] * (work.log_pi.m[a, i] - log_rule(a, rule_action, s))
    return kl


@vectorised
def critic_targets(q_1, q_2, batch, s, work):
    """y = r + c + γ V(s'), with the entropy and the KL in V (Equations 6, 15, 20): work.targets (batch,)."""
    for i in range(BATCH):
        value = ZERO  # Σ π (Q - α log π), an exact expectation over the nine actions
        for a in range(ACTIONS):
            value += work.pi.m[a, i] * (min(q_1.m[a, i], q_2.m[a, i]) - work.alpha * work.log_pi.m[a, i])
        value -= s.kl_in_target * work.xi * kl_to_rule(work, i, batch.next_rule_actions[i], s)
        reward = batch.rewards[i] + s.bonus * batch.is_demonstration[i]  # Equation 20: c for demonstrations
        work.targets[i] = reward + s.gamma * (ONE - batch.terminated[i]) * value


@vectorised
def add_margin(q, i, expert, s, work):
    """The filtered large margin of a demonstration (Equations 17 to 19): returns its loss and adds its slopes in Q."""
    best, highest, greedy, mean = expert, q.m[expert, i], q.m[expert, i], ZERO
    for a in range(ACTIONS):
        if a != expert and q.m[a, i] + ONE > highest:  # Q + l(a_E, a), Equation 17
            best, highest = a, q.m[a, i] + ONE
        greedy = max(greedy, q.m[a, i])
        mean += work.pi.m[a, i] * q.m[a, i]
    keep = q.m[expert, i] >= greedy if s.paper_q_filter > ZERO else q.m[expert, i] > mean  # Equation 19, or the usual
    if not keep:
        return ZERO
    work.out_slopes.m[best, i] += s.margin / ROWS
    work.out_slopes.m[expert, i] -= s.margin / ROWS
    return s.margin * (highest - q.m[expert, i]) / ROWS


@vectorised
def critic_loss(q, batch, s, work):
    """Mean (Q(s,a) - y)², plus the margin if its weight is above 0: returns the loss and sets its slopes in Q."""
    loss = ZERO
    clear(work.out_slopes)
    for i in range(BATCH):
        action = batch.actions[i]
        error = q.m[action, i] - work.targets[i]
        loss += error * error / ROWS
        work.out_slopes.m[action, i] = TWO * error / ROWS
        if s.margin > ZERO and batch.is_demonstration[i] > ZERO:
            loss += add_margin(q, i, action, s, work)
    return loss


@vectorised
def actor_loss(q_1, q_2, batch, s, work):
    """Minus the mean objective of the policy, Q + α H - ξ KL (Equation 15): sets the losses and the slopes in logits.

    With f(a) = α log π - Q + ξ (log π - log π̃), a state's loss is Σ π f, and its slope in logit a is π (f - Σ π f).
    """
    work.actor_loss = work.entropy = work.kl = ZERO
    clear(work.out_slopes)
    for i in range(BATCH):
        loss, entropy = ZERO, ZERO
        for a in range(ACTIONS):
            pi, log_pi = work.pi.m[a, i], work.log_pi.m[a, i]
            f = work.alpha * log_pi - min(q_1.m[a, i], q_2.m[a, i])
            f += work.xi * (log_pi - log_rule(a, batch.rule_actions[i], s))
            work.out_slopes.m[a, i] = f
            loss += pi * f
            entropy -= pi * log_pi
        for a in range(ACTIONS):
            work.out_slopes.m[a, i] = work.pi.m[a, i] * (work.out_slopes.m[a, i] - loss) / ROWS
        work.actor_loss += loss / ROWS
        work.entropy += entropy / ROWS
        work.kl += kl_to_rule(work, i, batch.rule_actions[i], s) / ROWS


@vectorised
def adam(weights, slopes, mean, square, rate, root):
    """A step of Adam in one matrix; rate: learning rate / (1 - β1^t), root: 1 / √(1 - β2^t)."""
    for i in range(weights.m.shape[0]):
        for j in range(weights.m.shape[1]):
            slope = slopes.m[i, j]
            first = mean.m[i, j] + TENTH * (slope - mean.m[i, j])
            second = KEPT * square.m[i, j] + THOUSANDTH * slope * slope
            mean.m[i, j] = first if abs(first) > TINY else ZERO
            square.m[i, j] = second if second > TINY else ZERO
            weights.m[i, j] -= rate * first / (math.sqrt(second) * root + SMALL)


@vectorised
def step(network, slopes, moments, rate, root):
    """A step of Adam in all weights and biases of a network."""
    mean, square = moments.mean, moments.square
    adam(network.w_1, slopes.w_1, mean.w_1, square.w_1, rate, root)
    adam(network.b_1, slopes.b_1, mean.b_1, square.b_1, rate, root)
    adam(network.w_2, slopes.w_2, mean.w_2, square.w_2, rate, root)
    adam(network.b_2, slopes.b_2, mean.b_2, square.b_2, rate, root)
    adam(network.w_3, slopes.w_3, mean.w_3, square.w_3, rate, root)
    adam(network.b_3, slopes.b_3, mean.b_3, square.b_3, rate, root)


@vectorised
def draw_near(old, new, tau):
    """Polyak averaging of one matrix: old += τ (new - old)."""
    for i in range(old.m.shape[0]):
        for j in range(old.m.shape[1]):
            old.m[i, j] += tau * (new.m[i, j] - old.m[i, j])


@vectorised
def follow(target, critic, tau):
    """Polyak averaging of a target network."""
    draw_near(target.w_1, critic.w_1, tau)
    draw_near(target.b_1, critic.b_1, tau)
    draw_near(target.w_2, critic.w_2, tau)
    draw_near(target.b_2, critic.b_2, tau)
    draw_near(target.w_3, critic.w_3, tau)
    draw_near(target.b_3, critic.b_3, tau)


@vectorised
def find_slopes(agent, batch, s, work):
    """All losses of an agent on a batch, and their slopes in all weights: no weight changes."""
    work.alpha = math.exp(agent.log_alpha)
    work.xi = strength(work.alpha, s)

    transpose(batch.next_states, work.states)
    forward(agent.actor, work.states, work.actor)
    forward(agent.target_1, work.states, work.critic_1)
    forward(agent.target_2, work.states, work.critic_2)
    policy(work.actor.out, work.pi, work.log_pi)
    critic_targets(work.critic_1.out, work.critic_2.out, batch, s, work)

    transpose(batch.states, work.states)
    forward(agent.actor, work.states, work.actor)
    forward(agent.critic_1, work.states, work.critic_1)
    forward(agent.critic_2, work.states, work.critic_2)
    policy(work.actor.out, work.pi, work.log_pi)

    work.critic_loss = critic_loss(work.critic_1.out, batch, s, work)
    backward(agent.critic_1, batch.states, work.critic_1, work, work.critic_1_slopes)
    work.critic_loss += critic_loss(work.critic_2.out, batch, s, work)
    backward(agent.critic_2, batch.states, work.critic_2, work, work.critic_2_slopes)
    actor_loss(work.critic_1.out, work.critic_2.out, batch, s, work)
    backward(agent.actor, batch.states, work.actor, work, work.actor_slopes)
    # α (H - η), which is also its own slope in log α:
    work.temperature_loss = work.alpha * (work.entropy - s.target_entropy)


@vectorised
def step_temperature(agent, slope, rate, root):
    """A step of Adam in log α."""
    agent.log_alpha_mean += TENTH * (slope - agent.log_alpha_mean)
    agent.log_alpha_square = KEPT * agent.log_alpha_square + THOUSANDTH * slope * slope
    agent.log_alpha -= rate * agent.log_alpha_mean / (math.sqrt(agent.log_alpha_square) * root + SMALL)


@vectorised
def update(agent, batch, s, work):
    """One gradient step of an agent. All losses are computed before the first weight changes."""
    find_slopes(agent, batch, s, work)
    agent.fade_1 *= 0.9
    agent.fade_2 *= 0.999
    whole, root = np.float32(1 / (1 - agent.fade_1)), np.float32(1 / math.sqrt(1 - agent.fade_2))
    step(agent.critic_1, work.critic_1_slopes, agent.critic_1_moments, s.critic_lr * whole, root)
    step(agent.critic_2, work.critic_2_slopes, agent.critic_2_moments, s.critic_lr * whole, root)
    step(agent.actor, work.actor_slopes, agent.actor_moments, s.actor_lr * whole, root)
    step_temperature(agent, work.temperature_loss, s.alpha_lr * whole, root)
    follow(agent.target_1, agent.critic_1, s.tau)
    follow(agent.target_2, agent.critic_2, s.tau)


@vectorised
def update_all(agents, batches, settings, works):
    """One gradient step of each agent: `AGENT`, `BATCHES`, `COEFFICIENTS` and `WORK` records, each (agents,)."""
    for i in range(len(agents)):
        update(agents[i], batches[i], settings[i], works[i])
