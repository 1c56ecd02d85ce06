"""The road from above as a moving picture, and the picture of the README."""

import io

import pytest
from PIL import Image

from bootcourse.episodes.words import overtaken
from bootcourse.plots import animation
from bootcourse.storage.assets import FOLDER


def words_of(figure) -> list[str]:
    return [text.get_text() for text in figure.texts]


def test_the_animation_has_every_frame_and_is_the_same_each_time(idle, escape, tmp_path, monkeypatch):
    monkeypatch.setattr(animation, "AFTER", 0.5 - overtaken(escape))
    path = animation.animate([idle, escape], tmp_path / "clip.gif")
    with Image.open(path) as clip:
        assert clip.n_frames == len(animation.frame_times([idle, escape])) == 3
        assert clip.info["loop"] == 0 and b"Idle driver" in clip.info["comment"]
        clip.seek(2)
        assert clip.info["duration"] == 1000 * animation.REST
    assert animation.animate([idle, escape], tmp_path / "again.gif").read_bytes() == path.read_bytes()


def test_the_animation_goes_on_until_the_trap_is_left(idle, escape):
    assert animation.frame_times([idle, escape])[-1] == pytest.approx(overtaken(escape) + animation.AFTER, abs=0.25)
    assert animation.frame_times([idle])[-1] == pytest.approx(20, abs=0.25)


def test_a_drive_that_ended_stays_as_it_ended(crash):
    words = words_of(animation.frame([crash], 100.0))
    assert f"{crash.times[-1]:.0f} s" in words and "collision" in words


def test_the_key_frame_is_the_accident_the_overtaking_or_the_middle(idle, escape, crash):
    assert "collision" in words_of(animation.key_frame([crash]))
    assert f"{overtaken(escape):.0f} s" in words_of(animation.key_frame([idle, escape]))
    assert "75 s" in words_of(animation.key_frame([idle]))


def test_the_readme_s_picture_is_light():
    gif, still = FOLDER / "readme/trap.gif", FOLDER / "readme/trap.png"
    assert gif.stat().st_size <= 1_500_000 and still.stat().st_size <= 100_000
    with Image.open(io.BytesIO(gif.read_bytes())) as clip:
        assert clip.n_frames > 50 and clip.width == 770
