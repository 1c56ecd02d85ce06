"""The progress bar: lines in a pipe, and a bar that ends full when a training ends as planned."""

import bootcourse as bc
from bootcourse import progress


def test_a_pipe_gets_one_line_every_ten_seconds(monkeypatch, capsys):
    now = [0.0]
    bar = progress.progress_bar(total=300, unit="job")
    monkeypatch.setattr(bar, "_time", lambda: now[0])
    bar.start_t = bar.last_print_t = 0.0
    for _ in range(300):
        now[0] += 0.1
        bar.update()
    bar.close()
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 4 and "0/300" in lines[0] and "300/300" in lines[-1]  # at 0, 10, 20 and 30 s
    assert not any("\r" in line for line in lines)


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
