"""The head-up display: the numbers of a drive at time t, as HTML, for the live panel and the exported file.

It is HTML and CSS without scripts, and takes its text colour from the page. A rollout's label comes from a file, so
it is escaped.
"""

from html import escape

import numpy as np

from bootcourse.colours import ALARM
from bootcourse.episodes.rollout import series
from bootcourse.episodes.words import ACCIDENTS
from bootcourse.methods import style
from bootcourse.plots.svg import SvgAxes
from bootcourse.replay3d.timeline import Timeline
from bootcourse.road.state import EGO, Accident
from bootcourse.rule import SENTENCES, Reason, stochastic_rule
from bootcourse.scenario import ACTION_NAMES

GREEN = style("rule").colour
STYLE = f"""<style>
.bc {{font:12px/1.35 system-ui,sans-serif;font-variant-numeric:tabular-nums;padding:2px 10px 4px}}
.bc h4 {{margin:2px 0;font-size:13px;font-weight:650;display:flex;gap:6px;align-items:center}}
.bc .dot {{width:10px;height:10px;border-radius:5px;display:inline-block;flex:none}}
.bc .badge {{margin-left:auto;padding:0 7px;border-radius:8px;color:#fff;font-weight:600;font-size:11px}}
.bc .big {{display:grid;grid-template-columns:repeat(4,1fr);gap:2px;margin:3px 0}}
.bc .big b {{font-size:17px;font-weight:650;display:block;line-height:1.1}}
.bc .dim, .bc .big span, .bc th {{opacity:.65;font-size:11px;font-weight:400}}
.bc table {{border-collapse:collapse;width:100%}}
.bc td, .bc th {{padding:0 3px 0 0;text-align:right;white-space:nowrap}}
.bc td:first-child, .bc th:first-child {{text-align:left}}
.bc tr.on td {{font-weight:700}}
.bc .bar {{width:64px;padding:0 4px 0 0}}
.bc .bar i {{display:block;height:5px;border-radius:1px;min-width:1px}}
.bc .bar i + i {{height:3px;margin-top:1px}}
.bc .why {{border-left:3px solid {GREEN};padding-left:6px;margin:3px 0}}
.bc .plot {{position:relative;margin-top:3px}}
.bc .plot svg {{display:block;width:100%;height:44px;overflow:visible}}
.bc .plot .name {{opacity:.65;font-size:11px;display:flex;justify-content:space-between}}
.bc .cursor {{position:absolute;bottom:0;height:44px;width:1px;background:currentColor;opacity:.8;
left:calc(100%*var(--bc-t,0))}}
</style>"""


def cursor(part: float) -> str:
    """A style element that moves the cursor of every plot to a part (0..1) of its width."""
    return f"<style>:root{{--bc-t:{part:.4f}}}</style>"


def kl(policy: np.ndarray, rule_policy: np.ndarray) -> float:
    """KL(π ‖ π̃) in nats: the soft constraint's charge for probability on actions that the rule would not take."""
    likely = policy > 0
    return float(np.sum(policy[likely] * np.log(policy[likely] / rule_policy[likely])))


def status(timeline: Timeline, t: float) -> tuple[str, str]:
    """(how the drive stands at time t, in words, their colour); ("", "") while that is open."""
    rollout, moment = timeline.rollout, timeline.at(t)
    if t >= timeline.duration and rollout.accident != Accident.NONE:
        return ACCIDENTS[Accident(rollout.accident)], ALARM
    if moment.x[EGO] > moment.x[1]:
        return ("escaped" if t >= timeline.duration else "ahead of trap 1"), GREEN
    return ("trapped" if t >= timeline.duration else ""), "#7A1F1F"


def card(timeline: Timeline, t: float) -> str:
    """One drive's numbers at time t."""
    return (
        f'<div class="bc">{_head(timeline, t)}{_numbers(timeline, t)}{_reward(timeline, t)}{_choice(timeline, t)}</div>'
    )


def _head(timeline: Timeline, t: float) -> str:
    rollout = timeline.rollout
    text, colour = status(timeline, t)
    badge = f'<span class="badge" style="background:{colour}">{text}</span>' if text else ""
    dot = f'<span class="dot" style="background:{style(rollout.label).colour}"></span>'
    return f'<h4>{dot}{escape(rollout.label)} <span class="dim">road {rollout.seed}</span>{badge}</h4>'


def _numbers(timeline: Timeline, t: float) -> str:
    moment, t = timeline.at(t), min(t, timeline.duration)
    driven = moment.x[EGO] - timeline.rollout.states[0, EGO, 0]
    cells = [
        (f"{t:.1f}", f"of {timeline.duration:g} s"),
        (f"{moment.speed[EGO]:.1f}", "m/s"),
        (f"{moment.lane[EGO]}", f"lane, 0…{timeline.rollout.scenario.road.lanes - 1}"),
        (f"{driven:.0f}", "m driven"),
    ]
    return (
        '<div class="big">'
        + "".join(f"<div><b>{value}</b><span>{unit}</span></div>" for value, unit in cells)
        + "</div>"
    )


def _reward(timeline: Timeline, t: float) -> str:
    rollout, weights = timeline.rollout, timeline.rollout.scenario.reward
    earned = timeline.earned(t)
    total = f"return <b>{timeline.returns[earned]:.2f}</b>"
    if earned == 0:
        return f'<div>{total} <span class="dim">no reward yet</span></div>'
    reward, (r_v, r_y, r_theta) = rollout.rewards[earned - 1], rollout.terms[earned - 1]
    terms = f"r<sub>v</sub> {r_v:.2f} · r<sub>y</sub> {r_y:.2f} · r<sub>θ</sub> {round(r_theta, 3) + 0.0:.3f}"
    hint = f"the three terms, unweighted; their weights are {weights.w_v:g}, {weights.w_y:g}, {weights.w_theta:g}"
    return f'<div>{total} · reward <b>{reward:.3f}</b></div><div class="dim" title="{hint}">{terms}</div>'


def _choice(timeline: Timeline, t: float) -> str:
    """The nine actions with π, π̃ and Q, KL(π ‖ π̃), and the rule's reason, as far as the drive recorded them."""
    rollout, k = timeline.rollout, timeline.decision(t)
    policy = None if rollout.policy is None else rollout.policy[k]
    q_values = None if rollout.q_values is None else rollout.q_values[k]
    by_rule = None
    if rollout.rule_actions is not None:
        by_rule = stochastic_rule(rollout.rule_actions[k], rollout.rule_p)
    own = style(rollout.label).colour
    rows = []
    for action, name in enumerate(ACTION_NAMES):
        bars = ""
        if policy is not None:
            bars += f'<i style="width:{100 * policy[action]:.0f}%;background:{own}"></i>'
        if by_rule is not None:
            bars += f'<i style="width:{100 * by_rule[action]:.0f}%;background:{GREEN}"></i>'
        cells = f'<td>{"▸" if action == rollout.actions[k] else " "} {name}</td><td class="bar">{bars}</td>'
        cells += f"<td>{policy[action]:.2f}</td>" if policy is not None else ""
        cells += f"<td>{by_rule[action]:.2f}</td>" if by_rule is not None else ""
        cells += f"<td>{q_values[action]:.2f}</td>" if q_values is not None else ""
        rows.append(f"<tr{' class=on' if action == rollout.actions[k] else ''}>{cells}</tr>")
    heads = "<th>action</th><th></th>"
    heads += f'<th style="color:{own}">π</th>' if policy is not None else ""
    heads += f'<th style="color:{GREEN}">π̃</th>' if by_rule is not None else ""
    heads += "<th>Q</th>" if q_values is not None else ""
    text = f"<table><tr>{heads}</tr>{''.join(rows)}</table>"
    if policy is not None and by_rule is not None:
        text += f"<div>KL(π‖π̃) = <b>{kl(policy, by_rule):.2f}</b> nats</div>"
    return text + _why(timeline, k)


def _why(timeline: Timeline, k: int) -> str:
    rollout = timeline.rollout
    if rollout.rule_reasons is None:
        return ""
    text = f"<b>Rule:</b> {SENTENCES[Reason(int(rollout.rule_reasons[k]))]}"
    if rollout.rule_lanes is not None and rollout.rule_speeds is not None:
        text += f' <span class="dim">(lane {int(rollout.rule_lanes[k])}, {rollout.rule_speeds[k]:.1f} m/s)</span>'
    return f'<div class="why">{text}</div>'


def table(timelines: list[Timeline], t: float) -> str:
    """A table that compares the drives at time t, one row each."""
    rows = []
    for timeline in timelines:
        moment, rollout = timeline.at(t), timeline.rollout
        text, colour = status(timeline, t)
        dot = f'<span class="dot" style="background:{style(rollout.label).colour}"></span>'
        driven = moment.x[EGO] - rollout.states[0, EGO, 0]
        rows.append(
            f"<tr><td>{dot} {escape(rollout.label)}</td><td>{moment.speed[EGO]:.1f}</td><td>{driven:.0f}</td>"
            f"<td>{moment.lane[EGO]}</td><td>{timeline.returns[timeline.earned(t)]:.1f}</td>"
            f'<td style="color:{colour};font-weight:650">{text.removesuffix(" of trap 1")}</td></tr>'
        )
    head = "<tr><th>driver</th><th>m/s</th><th>m</th><th>lane</th><th>return</th><th></th></tr>"
    return f'<div class="bc"><table>{head}{"".join(rows)}</table></div>'


def plots(timelines: list[Timeline]) -> str:
    """Small plots over the whole drive, with a mark at each accident and a cursor that `cursor` moves."""
    duration = max(timeline.duration for timeline in timelines)
    parts = []
    for what, name in (("speed", "speed, m/s"), ("lane", "lane (0 is the leftmost)"), ("return", "return")):
        curves = [series(timeline.rollout, what) for timeline in timelines]
        low, high = min(y.min() for _, y in curves), max(y.max() for _, y in curves)
        top, bottom = (low, max(high, low + 1e-6)) if what == "lane" else (max(high, low + 1e-6), low)
        axes = SvgAxes(0, 2, 1000, 40, (0, duration), (bottom, top))
        for (seconds, values), timeline in zip(curves, timelines, strict=True):
            axes.line(seconds, values, style(timeline.rollout.label).colour, 1.1)
            if timeline.rollout.accident != Accident.NONE:
                axes.line([timeline.duration] * 2, axes.y, ALARM, 1.3, ":")
        lines = "".join(axes.parts).replace("<path ", '<path vector-effect="non-scaling-stroke" ')
        parts.append(
            f'<div class="plot"><div class="name"><span>{name}</span><span>{low:.1f} … {high:.1f}</span></div>'
            f'<svg viewBox="0 0 1000 44" preserveAspectRatio="none">{lines}</svg><div class="cursor"></div></div>'
        )
    return f'<div class="bc">{"".join(parts)}</div>'
