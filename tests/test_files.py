"""The one reader of files: what it refuses before it unpacks anything, and the sentence that it gives."""

import os
import time
import zipfile

import numpy as np
import pytest

from bootcourse.cli.driving import drive
from bootcourse.errors import BootcourseError
from bootcourse.files import MEMBERS, UNPACKED, check_replaceable, read_arrays, read_bytes, read_json, sha256
from bootcourse.storage.sealed import read_sealed, write_sealed


def refusal(read, *given) -> str:
    """The sentence of a refusal, which must come at once: within two seconds of this process's own work."""
    started = time.process_time()
    with pytest.raises(BootcourseError) as error:
        read(*given)
    sentence = str(error.value)
    assert str(given[0]) in sentence and "\n" not in sentence and time.process_time() - started < 2.0
    return sentence


READERS = [read_arrays, read_json, read_bytes, sha256]


@pytest.mark.parametrize("read", READERS)
def test_what_is_not_a_file_is_refused_at_once(read, tmp_path):
    assert "is a folder, not a file" in refusal(read, tmp_path)
    assert "is not there" in refusal(read, tmp_path / "nowhere")
    assert "is not there" in refusal(read, tmp_path / "nowhere" / "deeper")
    assert "File name too long" in refusal(read, tmp_path / ("x" * 300))
    assert "null" in refusal(read, tmp_path / "a\0b")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="Windows has neither pipes nor devices in folders")
@pytest.mark.parametrize("read", READERS)
def test_a_device_and_a_pipe_are_refused_at_once(read, tmp_path):
    os.mkfifo(tmp_path / "pipe")
    assert "is a device, not a file" in refusal(read, tmp_path / "pipe")
    assert refusal(read, "/dev/zero").startswith("/dev/zero is a device, not a file")


def packed(path, members: dict[str, bytes], compression: int = zipfile.ZIP_DEFLATED):
    with zipfile.ZipFile(path, "w", compression) as file:
        for name, data in members.items():
            file.writestr(name, data)
    return path


def header(text: str) -> bytes:
    """The header of an .npy file that declares this."""
    return b"\x93NUMPY\x01\x00" + (len(text) + 1).to_bytes(2, "little") + text.encode() + b"\n"


def test_a_file_that_would_fill_the_memory_is_refused_before_it_is_unpacked(tmp_path):
    with zipfile.ZipFile(tmp_path / "bomb.npz", "w", zipfile.ZIP_DEFLATED, compresslevel=1) as file:
        with file.open("a.npy", "w") as member:
            for _ in range(UNPACKED // 2**24 + 1):
                member.write(bytes(2**24))
    assert "it declares 1 arrays of" in refusal(read_arrays, tmp_path / "bomb.npz")


def test_an_array_that_declares_more_numbers_than_it_has_is_refused(tmp_path):
    declared = header("{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000,), }")
    assert "should have the shape" in refusal(read_arrays, packed(tmp_path / "a.npz", {"a.npy": declared + bytes(80)}))


@pytest.mark.parametrize("text", ["(" * 5000, "{'descr': '|O', 'fortran_order': False, 'shape': ()}", "'", "{}", "1 +"])
def test_an_array_with_a_damaged_header_is_refused(tmp_path, text):
    refusal(read_arrays, packed(tmp_path / "a.npz", {"a.npy": header(text)}))


def test_other_packings_and_repeated_names_are_refused(tmp_path):
    one = header("{'descr': '|i1', 'fortran_order': False, 'shape': (1,), }") + b"1"
    refusal(read_arrays, packed(tmp_path / "a.npz", {"a.npy": one}, zipfile.ZIP_BZIP2))
    refusal(read_arrays, packed(tmp_path / "b.npz", {"a.npy": one, "a": one}))
    refusal(read_arrays, packed(tmp_path / "c.npz", {f"{i}.npy": one for i in range(MEMBERS + 1)}))


@pytest.mark.parametrize("text", [b"", b"{", b"\xff\xfe", b"[" * 10**6, b"NaN", b"1e999", b"9" * 5000, b'"\xff"'])
def test_what_is_not_json_is_refused(tmp_path, text):
    (tmp_path / "a.json").write_bytes(text)
    assert "restore it from a copy" in refusal(read_json, tmp_path / "a.json")


def test_numbers_booleans_and_texts_are_read_as_they_were_written(tmp_path):
    arrays = {"a": np.asfortranarray(np.arange(6.0).reshape(2, 3)), "b": np.array("ä"), "c": np.zeros((0, 3), bool)}
    np.savez_compressed(tmp_path / "a.npz", **arrays)
    found = read_arrays(tmp_path / "a.npz")
    for name, values in arrays.items():
        np.testing.assert_array_equal(found[name], values)
        assert found[name].dtype == values.dtype and found[name].flags.writeable


def test_a_drive_is_refused_before_it_begins_if_its_picture_has_another_ending(tmp_path):
    for name in ("thesis.tex", "q.npz"):
        (tmp_path / "thesis.tex").write_text("Chapter 1")
        with pytest.raises(BootcourseError, match="does not end in .png"):
            drive("rule", tmp_path / "q.npz", 0, "", tmp_path / name)
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]
    assert (tmp_path / "thesis.tex").read_text() == "Chapter 1"


def test_a_picture_replaces_a_picture_and_nothing_else(tmp_path):
    (tmp_path / "thesis.png").write_text("Chapter 1")
    (tmp_path / "old.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    (tmp_path / "folder.png").mkdir()
    assert "is not a png file" in refusal(check_replaceable, tmp_path / "thesis.png", ".png")
    assert "is a folder" in refusal(check_replaceable, tmp_path / "folder.png", ".png")
    assert "does not end in .png or .svg" in refusal(check_replaceable, tmp_path / "thesis.tex", ".png", ".svg")
    for name in ("old.png", "new.png"):
        assert check_replaceable(tmp_path / name, ".png") == tmp_path / name


def test_a_flipped_bit_of_a_sealed_file_is_noticed(tmp_path):
    path, content = tmp_path / "sealed.json", {"format": "a format", "made": {"seed": 3, "seconds": 1.5}, "by": "ä"}
    write_sealed(path, content)
    whole = path.read_bytes()
    for place in range(len(whole)):
        for bit in range(8):
            flipped = bytearray(whole)
            flipped[place] ^= 1 << bit
            path.write_bytes(flipped)
            try:
                assert read_sealed(path, "a format") == content  # one space became another
            except BootcourseError as error:
                assert "sealed.json" in str(error)
