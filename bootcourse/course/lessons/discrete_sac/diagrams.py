"""The parts of soft actor-critic, and what passes between them."""

from collections.abc import Mapping

from bootcourse.plots.diagrams import Diagram, arrow, box, label

SAC_PARTS: Mapping[str, tuple] = {  # name -> left, top, lines, tint; each 140 wide and 64 high
    "world": (8, 30, ("world", "such as the road"), "world"),
    "actor": (230, 30, ("actor π", "chooses actions"), "learned"),
    "temperature": (452, 30, ("temperature α", "weight of entropy"), "learned"),
    "buffer": (8, 220, ("replay buffer", "what happened"), "stored"),
    "critics": (230, 220, ("critics Q₁, Q₂", "judge actions"), "learned"),
    "targets": (452, 220, ("target critics", "slow copies"), "stored"),
}


DECISIONS = [  # what passes while the agent drives, and from the buffer to the critics
    arrow(230, 50, 150, 50), label(190, 42, "action"),
    arrow(150, 76, 228, 76), label(190, 96, "state"),
    arrow(78, 96, 78, 218), label(86, 150, "s, a, r, s′,", "start"), label(86, 168, "terminated", "start"),
    arrow(150, 252, 228, 252), label(190, 272, "batch"),
]  # fmt: skip


def boxes(*names: str) -> list[str]:
    """The boxes of these parts."""
    return [box(left, top, 140, 64, lines, tint) for left, top, lines, tint in (SAC_PARTS[name] for name in names)]


def four_parts() -> Diagram:
    """What acts, what keeps the rows, and what judges."""
    left, top, _, tint = SAC_PARTS["critics"]
    critics = box(left, top, 140, 64, ("critics", "judge actions"), tint)
    parts = [*boxes("world", "actor", "buffer"), critics, *DECISIONS]
    parts += [arrow(300, 218, 300, 97), label(308, 162, "Q", "start")]
    alt = (
        "The actor sends actions to the world and sees its states. What happened goes into the replay buffer. "
        "Batches of it train the critics, whose Q the actor learns from."
    )
    return Diagram(380, 296, parts, alt)


def sac_diagram() -> Diagram:
    """Soft actor-critic: what acts, what is learned, what is stored, and what passes between them."""
    parts = [
        *boxes(*SAC_PARTS), *DECISIONS,
        arrow(146, 218, 244, 97), label(206, 158, "states of", "start"), label(206, 176, "the batch", "start"),
        arrow(300, 218, 300, 97), label(308, 200, "min Q", "start"),
        arrow(370, 50, 450, 50), label(411, 42, "entropy"),
        arrow(452, 76, 372, 76), label(411, 96, "α"),
        arrow(452, 240, 372, 240), label(411, 216, "min Q:"), label(411, 232, "targets"),
        arrow(370, 268, 450, 268, dashed=True), label(411, 290, "copied"),
        arrow(366, 96, 470, 218), label(426, 150, "π in s′", "start"),
        arrow(566, 96, 566, 218), label(574, 150, "α", "start"),
    ]  # fmt: skip
    alt = (
        "Soft actor-critic. The actor sends actions to the world and sees its states. Transitions go "
        "into the replay buffer; batches of them train two critics, and the actor, which makes the smaller of their "
        "values large. The critics' targets come from their slow copies, the target critics, from the actor's policy "
        "in s′ and from the temperature α, which follows the actor's entropy."
    )
    return Diagram(600, 296, parts, alt)
