"""The loop of an agent and its environment."""

from bootcourse.plots.diagrams import Diagram, arrow, box, label, line


def agent_loop(observation: str, action: str, reward: str) -> Diagram:
    """The loop of an agent and its environment, with a few words about what passes between them each second."""
    parts = [
        box(195, 8, 170, 60, ("agent", "its policy chooses"), "learned"),
        box(195, 152, 170, 60, ("road", "one second passes"), "world"),
        *(line(365, 38, 440, 38), line(440, 38, 440, 182), arrow(440, 182, 366, 182)),
        *(line(195, 170, 130, 170), line(130, 170, 130, 50), arrow(130, 50, 194, 50)),
        *(line(195, 194, 108, 194), line(108, 194, 108, 26), arrow(108, 26, 194, 26)),
        *(label(452, 106, "action", "start", bold=True), label(452, 124, action, "start")),
        *(label(142, 106, "observation", "start", bold=True), label(142, 124, observation, "start")),
        *(label(98, 106, "reward", "end", bold=True), label(98, 124, reward, "end")),
    ]
    alt = (
        "The agent and the road in a loop. Each second the road gives the agent an observation and a reward, and the "
        f"agent gives the road an action. Observation: {observation}. Reward: {reward}. Action: {action}."
    )
    return Diagram(560, 220, parts, alt)
