"""The head-up display: the numbers of a drive at time t, as HTML, for the live panel and the exported file.

In plain words, or with what a driver thinks (π, π̃, Q, the KL) and the terms of its reward. It is HTML and CSS without
scripts, and takes its text colour from the page.
"""

import scipy

from bootcourse.colours import ALARM, TRAP
from bootcourse.episodes.rollout import series
from bootcourse.episodes.words import ACCIDENTS
from bootcourse.markup import Markup, html, joined
from bootcourse.methods import display_name, driver_of, style
from bootcourse.plots.futures import LEGEND
from bootcourse.plots.svg import SvgAxes
from bootcourse.replay3d.timeline import Timeline
from bootcourse.road.state import EGO, LANE, SPEED, TRAP_1, Accident, X
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


def cursor(part: float) -> Markup:
    """A style element that moves the cursor of every plot to a part (0..1) of its width."""
    return html("<style>:root{{--bc-t:{:.4f}}}</style>", part)


def status(timeline: Timeline, t: float) -> tuple[str, str]:
    """(how the drive stands at time t, in words, their colour); ("", "") while that is open."""
    accident, over, cars = Accident(timeline.rollout.accident), t >= timeline.duration, timeline.at(t)
    if over and accident != Accident.NONE:
        return ACCIDENTS[accident], ALARM
    if cars[EGO, X] > cars[TRAP_1, X]:
        return ("escaped" if over else "ahead of trap 1"), GREEN
    return ("trapped" if over else ""), TRAP


def page(timelines: list[Timeline], t: float, details: bool) -> Markup:
    """The drives at time t: in plain words a table of several or the card of one; with details the first one's too."""
    if len(timelines) == 1:
        return card(timelines[0], t, details)
    return table(timelines, t) + (card(timelines[0], t, details) if details else Markup(""))


def card(timeline: Timeline, t: float, details: bool = True) -> Markup:
    """One drive's numbers at time t."""
    rollout, (words, colour) = timeline.rollout, status(timeline, t)
    badge = html('<span class="badge" style="background:{}">{}</span>', colour, words) if words else ""
    road = html('<span class="dim">road {}</span>', rollout.seed)
    parts = [html("<h4>{}{} {}{}</h4>", _dot(timeline), display_name(rollout.label), road, badge)]
    shown = (_numbers, _reward, _choice, _reason) if details else (_numbers, _does)
    parts += [part(timeline, t) for part in shown]
    if not details and driver_of(rollout.label) == "rule":
        parts.append(_reason(timeline, t))
    if timeline.imagined is not None:
        parts.append(html('<div class="dim">imagined drives: {}; broad: driven</div>', LEGEND))
    return html('<div class="bc">{}</div>', joined(parts))


def _dot(timeline: Timeline) -> Markup:
    return html('<span class="dot" style="background:{}"></span>', timeline.colour)


def _driven(timeline: Timeline, t: float) -> str:
    return f"{timeline.at(t)[EGO, X] - timeline.rollout.states[0, EGO, X]:.0f}"


def _numbers(timeline: Timeline, t: float) -> Markup:
    ego = timeline.at(t)[EGO]
    cells = [
        (f"{min(t, timeline.duration):.1f}", f"of {timeline.duration:g} s"),
        (f"{ego[SPEED]:.1f}", "m/s"),
        (f"{ego[LANE]:.0f}", f"lane, 0…{timeline.rollout.scenario.road.lanes - 1}"),
        (_driven(timeline, t), "m driven"),
    ]
    each = (html("<div><b>{}</b><span>{}</span></div>", value, unit) for value, unit in cells)
    return html('<div class="big">{}</div>', joined(each))


def _return(timeline: Timeline, t: float) -> float:
    return timeline.rollout.rewards[: timeline.earned(t)].sum()


def _action(timeline: Timeline, t: float) -> str:
    return ACTION_NAMES[timeline.rollout.actions[timeline.decision(t)]]


def _does(timeline: Timeline, t: float) -> Markup:
    """What it has earned, and what it does now, in words."""
    return html("<div>return <b>{:.1f}</b> · {}</div>", _return(timeline, t), _action(timeline, t))


def _reward(timeline: Timeline, t: float) -> Markup:
    rollout, weights, earned = timeline.rollout, timeline.rollout.scenario.reward, timeline.earned(t)
    total = html("return <b>{:.2f}</b>", _return(timeline, t))
    if earned == 0:
        return html('<div>{} <span class="dim">no reward yet</span></div>', total)
    r_v, r_y, r_theta = rollout.terms[earned - 1]
    terms = "r<sub>v</sub> {:.2f} · r<sub>y</sub> {:.2f} · r<sub>θ</sub> {:.3f}"
    terms = html(terms, r_v, r_y, round(r_theta, 3) + 0.0)
    hint = f"the three terms, unweighted; their weights are {weights.w_v:g}, {weights.w_y:g}, {weights.w_theta:g}"
    page = '<div>{} · reward <b>{:.3f}</b></div><div class="dim" title="{}">{}</div>'
    return html(page, total, rollout.rewards[earned - 1], hint, terms)


def _choice(timeline: Timeline, t: float) -> Markup:
    """The nine actions with π, π̃ and Q, and KL(π ‖ π̃); π and Q if the driver has them."""
    rollout, k = timeline.rollout, timeline.decision(t)
    own, columns = timeline.colour, {}  # {heading: (its colour, the nine numbers)}
    if rollout.policy is not None:
        columns["π"] = own, rollout.policy[k]
    columns["π̃"] = GREEN, stochastic_rule(rollout.rule_actions[k], rollout.rule_p)
    bars = list(columns.values())
    if rollout.q_values is not None:
        columns["Q"] = "inherit", rollout.q_values[k]
    heads = (html('<th style="color:{}">{}</th>', colour, name) for name, (colour, _) in columns.items())
    rows = [html("<tr><th>action</th><th></th>{}</tr>", joined(heads))]
    for action, name in enumerate(ACTION_NAMES):
        bar = '<i style="width:{:.0f}%;background:{}"></i>'
        drawn = joined(html(bar, 100 * numbers[action], colour) for colour, numbers in bars)
        cells = joined(html("<td>{:.2f}</td>", numbers[action]) for _, numbers in columns.values())
        taken = action == rollout.actions[k]
        row = '<tr class="{}"><td>{} {}</td><td class="bar">{}</td>{}</tr>'
        rows.append(html(row, "on" if taken else "", "▸" if taken else " ", name, drawn, cells))
    page = html("<table>{}</table>", joined(rows))
    if len(bars) == 2:
        kl = scipy.special.rel_entr(*(numbers for _, numbers in bars)).sum()
        page += html("<div>KL(π‖π̃) = <b>{:.2f}</b> nats</div>", kl)
    if rollout.policy is not None and rollout.q_values is None:
        page += Markup('<div class="dim">No Q: this agent has none, or it was not recorded.</div>')
    return page


def _reason(timeline: Timeline, t: float) -> Markup:
    """What the rule would do now, and why."""
    rollout, k = timeline.rollout, timeline.decision(t)
    aim = f"(lane {int(rollout.rule_lanes[k])}, {rollout.rule_speeds[k]:.1f} m/s)"
    why = '<div class="why"><b>Rule:</b> {} <span class="dim">{}</span></div>'
    return html(why, SENTENCES[Reason(int(rollout.rule_reasons[k]))], aim)


def table(timelines: list[Timeline], t: float) -> Markup:
    """A table that compares the drives at time t, one row each."""
    rows = [Markup("<tr><th>driver</th><th>m/s</th><th>return</th><th>does</th></tr>")]
    for timeline in timelines:
        rollout, ego, (words, colour) = timeline.rollout, timeline.at(t)[EGO], status(timeline, t)
        cells = [
            html("{} {}", _dot(timeline), display_name(rollout.label)),
            f"{ego[SPEED]:.1f}",
            f"{_return(timeline, t):.1f}",
            html('<span style="color:{};font-weight:650">{}</span>', colour, words.removesuffix(" of trap 1"))
            if words
            else _action(timeline, t),
        ]
        rows.append(html("<tr>{}</tr>", joined(html("<td>{}</td>", cell) for cell in cells)))
    return html('<div class="bc"><table>{}</table></div>', joined(rows))


def plots(timelines: list[Timeline]) -> Markup:
    """Small plots over the whole drive, with a mark at each accident and a cursor that `cursor` moves."""
    duration = max(timeline.duration for timeline in timelines)
    parts = []
    for what, name in (("speed", "speed, m/s"), ("lane", "lane (0 is the leftmost)"), ("return", "return")):
        curves = [series(timeline.rollout, what) for timeline in timelines]
        low, high = min(y.min() for _, y in curves), max(y.max() for _, y in curves)
        top, bottom = (low, max(high, low + 1e-6)) if what == "lane" else (max(high, low + 1e-6), low)
        axes = SvgAxes(0, 2, 1000, 40, (0, duration), (bottom, top))
        for (seconds, values), timeline in zip(curves, timelines, strict=True):
            axes.line(seconds, values, timeline.colour, 1.1)
            if timeline.rollout.accident != Accident.NONE:
                axes.line([timeline.duration] * 2, axes.y, ALARM, 1.3, ":")
        lines = Markup("".join(axes.parts).replace("<path ", '<path vector-effect="non-scaling-stroke" '))
        page = (
            '<div class="plot"><div class="name"><span>{}</span><span>{:.1f} … {:.1f}</span></div>'
            '<svg viewBox="0 0 1000 44" preserveAspectRatio="none">{}</svg><div class="cursor"></div></div>'
        )
        parts.append(html(page, name, low, high, lines))
    return html('<div class="bc">{}</div>', joined(parts))
