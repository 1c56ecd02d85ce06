"""What a class predicted, as bars in HTML: one group of bars for each question."""

from collections import Counter, defaultdict
from collections.abc import Sequence
from html import escape

from bootcourse.lessons.predictions import worded

MOST = 12  # answers to a question that get a bar of their own


def histograms(classes: Sequence[dict[str, dict]]) -> str:
    """One histogram for each prediction; nothing if nobody made one. classes: each student's predictions."""
    answers, asked = defaultdict(Counter), {}
    for own in classes:
        for number, one in own.items():
            answers[number][worded(one["answer"], one.get("unit"))] += 1
            asked.setdefault(number, one["question"])
    if not answers:
        return ""
    order = sorted(answers, key=lambda number: tuple(map(int, number.split("."))))
    return "<h2>Predictions</h2>" + "".join(histogram(number, asked[number], answers[number]) for number in order)


def histogram(number: str, question: str, answers: Counter) -> str:
    """Bars, the most frequent answer first; those that stand alone at the end are counted together."""
    total, rows = sum(answers.values()), []
    for answer, count in answers.most_common(MOST):
        bar = f'<div class="of"><div class="bar" style="width: {100 * count / total:.0f}%"></div></div>'
        rows.append(f"<tr><td>{bar}</td><td>{count}</td><td>{escape(answer[:200])}</td></tr>")
    rest = sum(count for _, count in answers.most_common()[MOST:])
    rows += [f"<tr><td></td><td>{rest}</td><td><small>other answers</small></td></tr>"] * bool(rest)
    head = f"<p><strong>{number}</strong> {escape(question)}</p>"
    return f'{head}<table class="short">{"".join(rows)}</table>'
