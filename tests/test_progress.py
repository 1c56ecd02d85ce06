"""The progress bar: lines in a pipe, and a bar that ends full when a training ends as planned."""

from tqdm.notebook import tqdm as in_notebook

import bootcourse as bc
from bootcourse.progress import end_full


def test_a_training_of_so_many_updates_counts_them_and_its_bar_ends_full(capsys):
    training = bc.Training([bc.settings_for("sac")], 1000)
    training.run(updates=40)
    shown = capsys.readouterr().err
    assert training.updates == 40 and "40/40" in shown.strip().splitlines()[-1] and "\r" not in shown


def test_a_training_that_is_stopped_as_planned_ends_its_bar_full(capsys):
    training = bc.Training([bc.settings_for("sac")], 1000)
    training.run(stop=lambda: training.curves.finished[0] >= 6)
    last = capsys.readouterr().err.strip().splitlines()[-1]
    assert f"{training.curves.finished[0]}/{training.curves.finished[0]} " in last


def test_a_bar_in_a_notebook_ends_full_when_less_than_its_total_was_done():
    bar = in_notebook(total=1000, display=False)
    bar.update(40)
    end_full(bar)
    _, drawn, _ = bar.container.children
    assert drawn.max == bar.n == 40


def test_a_result_has_three_lines(capsys):
    training = bc.Training(bc.with_seeds(bc.settings_for("sac"), 2), 3)
    lines = repr(training.run(progress=False)).splitlines()
    assert len(lines) == 3 and all(len(line) < 120 for line in lines)
    assert "2 agents of plain SAC on the trap" in lines[0] and lines[1].startswith("6 episodes")
    assert capsys.readouterr().err == ""
