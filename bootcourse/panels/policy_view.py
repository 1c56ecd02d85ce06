"""The nine actions of `PolicyNumbers`, drawn: bars of π, π̃ and the optimum, each action's share of the KL, Q."""

from bootcourse.methods import style
from bootcourse.panels.policy_numbers import PolicyNumbers
from bootcourse.plots.svg import GRID, INK, QUIET, line, rect, text
from bootcourse.scenario import ACTION_NAMES, N_ACTIONS

GREEN, OPTIMUM = style("rule").colour, INK
WIDTH, ROAD, ROWS, ROW = 1036, 84, 176, 22  # pixels: the drawing, the road's height, where the rows begin, one row
BAR, COLUMNS = 128, (148, 338, 528)  # a whole bar's length; where the bars of π, π̃ and the optimum begin
SHARE, PER_NAT, Q, WORTH = 738, 17, 928, 1032  # the KL's bars from here, so long for a nat; right ends of two columns
MOST_NATS = 8  # a longer bar is cut
HEIGHT = ROWS + N_ACTIONS * ROW + 50


def policy_chart(seen: PolicyNumbers, p: float, xi: float, alpha: float, who: str, own: str) -> list[str]:
    """The table of the nine actions, bars and numbers; who drove, in which colour."""
    parts, bottom = [], ROWS + N_ACTIONS * ROW
    for row in range(0, N_ACTIONS + 1, 3):
        parts.append(line(0, ROWS + row * ROW, WIDTH, ROWS + row * ROW, GRID))
    parts += [text(20, ROWS + a * ROW + 15, action, size=12.5) for a, action in enumerate(ACTION_NAMES)]
    weights = f"ξ = {xi:g}, α = {alpha:.3g}"
    columns = (
        (seen.policy, own, "π", f"the policy: {who}", "no π recorded"),
        (seen.rule, GREEN, "π̃", f"the rule, p = {p:g}", ""),
        (seen.optimum, OPTIMUM, "optimum", weights, "needs Q"),
    )
    for x, (values, colour, symbol, words, otherwise) in zip(COLUMNS, columns, strict=True):
        parts += _title(x, symbol, words if values is not None else otherwise, colour)
        for a, value in enumerate([] if values is None else values):
            y = ROWS + a * ROW
            parts.append(rect(x, y + 4, BAR * value, ROW - 8, colour, 'rx="1.5"'))
            parts.append(text(x + BAR * value + 5, y + 15, f"{value:.3f}", fill=QUIET, size=11))
    if seen.shares is not None:
        parts += _title(SHARE - 8, "π log(π/π̃)", "adds up to the KL (nats)", own)
        for a, share in enumerate(seen.shares):
            y, long = ROWS + a * ROW, PER_NAT * min(abs(share), MOST_NATS)
            parts.append(rect(SHARE - long * (share < 0), y + 4, long, ROW - 8, own if share >= 0 else GREEN))
            parts.append(text(SHARE + max(long * (share > 0), 0) + 5, y + 15, _two(share), fill=QUIET, size=11))
        parts.append(line(SHARE, ROWS, SHARE, bottom, QUIET))
    for x, symbol, values in ((Q, "Q", seen.q), (WORTH, "Q + ξ log π̃", seen.worth)):
        parts.append(text(x, ROWS - 25, symbol, "end", bold=True, size=13))
        for a, value in enumerate([] if values is None else values):
            parts.append(text(x, ROWS + a * ROW + 15, _two(value), "end", size=12))
        if values is None:
            parts.append(text(x, ROWS - 9, "not recorded" if symbol == "Q" else "needs Q", "end", QUIET, 11))
    dear, cheap = seen.price.max(), seen.price.min()
    price = f"Price of an action, −log π̃: {cheap:.2f} nats for the rule's own, {dear:.2f} nats for any other."
    formula = "optimum: the policy with the most Q + α·entropy − ξ·KL."
    return [*parts, text(0, bottom + 20, price, bold=True), text(0, bottom + 39, formula, fill=QUIET)]


def marks(driven: int, by_rule: int, own: str) -> list[str]:
    """Which action was driven, and which is the rule's own."""
    y = [ROWS + action * ROW + 15 for action in (driven, by_rule)]
    return [
        text(0, y[0], "▸", fill=own, size=14, bold=True),
        f'<circle cx="13" cy="{y[1] - 4}" r="4" fill="{GREEN}"/>',
        text(0, ROWS - 9, "▸", fill=own, size=13, bold=True),
        text(10, ROWS - 9, "driven", fill=QUIET, size=11),
        f'<circle cx="62" cy="{ROWS - 13}" r="4" fill="{GREEN}"/>',
        text(70, ROWS - 9, "the rule's", fill=QUIET, size=11),
    ]


def _two(value: float) -> str:
    words = f"{round(float(value), 2) + 0.0:.2f}" if abs(value) < 1e4 else f"{value:.1e}"
    return words.replace("-", "−")


def _title(x: float, symbol: str, words: str, colour: str) -> list[str]:
    return [text(x, ROWS - 25, symbol, fill=colour, size=13, bold=True), text(x, ROWS - 9, words, fill=QUIET, size=11)]
