"""The moving picture of the README: its frames, its size, its command."""

import io

import pytest
from PIL import Image

from bootcourse.episodes.words import overtaken
from bootcourse.errors import BootcourseError
from bootcourse.plots import animation, readme_picture


def test_the_animation_is_small_has_every_frame_and_is_the_same_each_time(idle, escape, tmp_path):
    drives, until = [idle, escape], 2.0
    path = animation.animate(drives, tmp_path / "clip.gif", until)
    with Image.open(path) as clip:
        assert clip.n_frames == len(animation.frame_times(drives, until)) == 10
        assert clip.info["loop"] == 0 and b"Idle driver" in clip.info["comment"]
        clip.seek(9)
        assert clip.info["duration"] == 1000 * animation.REST
    assert animation.animate(drives, tmp_path / "again.gif", until).read_bytes() == path.read_bytes()


def test_the_animation_goes_on_until_the_trap_is_left(idle, escape):
    assert animation.frame_times([idle, escape])[-1] == pytest.approx(overtaken(escape) + animation.AFTER, abs=0.25)
    assert animation.frame_times([idle])[-1] == pytest.approx(20, abs=0.25)


def test_a_drive_that_ended_stays_as_it_ended(crash):
    figure = animation.frame([crash], 100.0)
    words = [text.get_text() for text in figure.texts]
    assert f"{crash.times[-1]:.0f} s" in words and "collision" in words


def test_an_animation_of_nothing_is_refused(idle, tmp_path):
    with pytest.raises(BootcourseError, match="There is no drive to animate"):
        animation.animate([], tmp_path / "clip.gif")
    with pytest.raises(BootcourseError, match="above 0"):
        animation.animate(idle, tmp_path / "clip.gif", until=0)


def test_the_readme_picture_can_be_drawn_from_two_recorded_drives(idle, crash, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(animation, "frame_times", lambda rollouts, until=None: [0.0, 0.5])
    drives = [str(idle.save(tmp_path / "top.npz")), str(crash.save(tmp_path / "bottom.npz"))]
    assert readme_picture.main([*drives, "--out", str(tmp_path / "out")]) == 0
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["trap.gif", "trap.png"]
    assert readme_picture.main([drives[0]]) == 2
    assert "give two" in capsys.readouterr().err


def test_the_readme_picture_in_the_repository_is_light():
    gif, still = readme_picture.FOLDER / "trap.gif", readme_picture.FOLDER / "trap.png"
    assert gif.stat().st_size <= 1_500_000 and still.stat().st_size <= 100_000
    with Image.open(io.BytesIO(gif.read_bytes())) as clip:
        assert clip.n_frames > 50 and clip.width == 770
