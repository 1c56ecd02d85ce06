"""What each learner takes from a teacher, and until when."""

from bootcourse.plots.diagrams import TINTS, Diagram, label

START, TRAINED, END = 210, 560, 690  # pixels: the training begins and ends, and the trained agent drives
ROW, TOP, THICK = 44, 44, 26
COLOUR = TINTS["world"]
TAKES = {  # learner: (what it takes, from, until, whether it fades)
    "PPO after cloning": ("a first policy", START - 34, START, False),
    "bootstrapped SAC": ("a KL, and demonstrations with a bonus", START, TRAINED - 110, True),
    "jump-start RL": ("the first seconds of each episode", START, TRAINED - 60, True),
    "RLPD": ("half of each batch", START, TRAINED, False),
    "IBRL": ("a second action to choose from", START, END, False),
}


def what_is_taken() -> Diagram:
    """A row for each learner: a bar while it uses the teacher, which gets thinner where that fades."""
    height = TOP + ROW * len(TAKES) + 4
    parts = [label((START + TRAINED) / 2, 18, "training"), label((TRAINED + END) / 2, 18, "driving")]
    for x in (START, TRAINED):
        dash = 'stroke="currentColor" stroke-dasharray="4 4" opacity="0.6"'
        parts.append(f'<line x1="{x}" y1="26" x2="{x}" y2="{height}" {dash}/>')
    alt_parts = []
    for i, (learner, (words, first, last, fades)) in enumerate(TAKES.items()):
        top = TOP + ROW * i
        end = top + (2 if fades else THICK)
        corners = f"{first},{top} {last},{top} {last},{end} {first},{top + THICK}"
        parts += [f'<polygon points="{corners}" fill="{COLOUR}" fill-opacity="0.3"/>']
        parts += [label(START - 44, top + 18, learner, "end", bold=True), label(START + 12, top + 18, words, "start")]
        until = {START: "before the training", END: "in training and afterwards"}.get(last, "in training")
        alt_parts.append(f"{learner} takes {words}, {until}{', which fades' * fades}.")
    return Diagram(END + 10, height, parts, " ".join(alt_parts))
