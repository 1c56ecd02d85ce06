"""The progress bar: lines in a pipe, and a bar that ends full when a training ends as planned."""

import bootcourse as bc


def test_a_training_of_so_many_updates_counts_them_and_its_bar_ends_full(capsys):
    training = bc.Training([bc.settings_for("sac")], 1000)
    training.run(updates=40)
    last = capsys.readouterr().err.splitlines()[-1]
    assert training.updates == 40 and "40/40" in last


def test_a_training_that_is_stopped_as_planned_ends_its_bar_full(capsys):
    training = bc.Training([bc.settings_for("sac")], 1000)
    training.run(stop=lambda: training.curves.finished[0] >= 6)
    assert f"{training.curves.finished[0]}/{training.curves.finished[0]} " in capsys.readouterr().err.splitlines()[-1]


def test_a_result_has_three_lines(capsys):
    training = bc.Training(bc.with_seeds(bc.settings_for("sac"), 2), 3)
    lines = repr(training.run(progress=False)).splitlines()
    assert len(lines) == 3 and all(len(line) < 120 for line in lines)
    assert "2 agents of plain SAC on the trap" in lines[0] and lines[1].startswith("6 episodes")
    assert capsys.readouterr().err == ""
