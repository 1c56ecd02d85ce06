"""The one writer and the one reader of files: what a kill leaves, and what is refused before anything is unpacked."""

import errno
import io
import os
import sys
import time
import zipfile

import numpy as np
import pytest

from bootcourse import files
from bootcourse.errors import BootcourseError
from bootcourse.files import (
    MEMBERS,
    UNPACKED,
    check_replaceable,
    read_arrays,
    read_bytes,
    read_json,
    remove_temporary,
    sha256,
    write_arrays,
    write_bytes,
)

CHANGES = {"open", "os.rename", "os.remove"}  # audit events of what changes files


def refusal(read, *given) -> str:
    """The sentence of a refusal, which must come at once: within two seconds of this process's own work."""
    started = time.process_time()
    with pytest.raises(BootcourseError) as error:
        read(*given)
    sentence = str(error.value)
    assert str(given[0]) in sentence and "\n" not in sentence and time.process_time() - started < 2.0
    return sentence


# Writing --------------------------------------------------------------------------------------------


def killed_at(operation: int, path, data: bytes) -> bool:
    """Write in a fork that is killed before its n-th operation on files: whether it had so many."""
    child = os.fork()
    if child == 0:
        begun, synced = [], os.fsync

        def begin(event: str) -> None:
            begun.append(event)
            if len(begun) > operation:
                os._exit(9)

        os.fsync = lambda file: (begin("fsync"), synced(file))
        sys.addaudithook(lambda event, arguments: begin(event) if event in CHANGES else None)
        write_bytes(path, data)
        os._exit(0)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 9


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_a_process_that_is_killed_between_any_two_operations_leaves_the_old_file_or_the_new_one(tmp_path):
    path, old, new, operation, left = tmp_path / "mine.json", b"old" * 1000, b"new" * 1000, 0, []
    write_bytes(path, old)
    while killed_at(operation, path, new):
        left.append(path.read_bytes())
        remove_temporary(tmp_path)
        assert [each.name for each in tmp_path.iterdir()] == ["mine.json"], "what it left can be cleaned up"
        operation += 1
    assert operation >= 3 and set(left) <= {old, new} and path.read_bytes() == new


def full(*_):
    raise OSError(errno.ENOSPC, "No space left on device")


def read_only(*_):
    raise PermissionError(errno.EACCES, "Permission denied")


def ctrl_c(*_):
    raise KeyboardInterrupt


class FillsUp(io.FileIO):
    """A disk that is full in the middle of a file."""

    def write(self, data):
        super().write(data[: len(data) // 2])
        full()


REFUSES = {  # a disk: (where it refuses, how, what is raised, words)
    "full when it is synced": (os, "fsync", full, BootcourseError, "No space left on device. Free some space"),
    "full when it is renamed": (os, "replace", full, BootcourseError, "No space left on device. Free some space"),
    "full in the middle": (files, "open", FillsUp, BootcourseError, "Free some space"),
    "read-only": (files, "open", read_only, BootcourseError, "Permission denied"),
    "interrupted": (os, "fsync", ctrl_c, KeyboardInterrupt, None),
}


@pytest.mark.parametrize("case", REFUSES)
def test_a_disk_that_refuses_leaves_the_old_file_alone_and_one_sentence(case, tmp_path, monkeypatch):
    place, name, fault, error, words = REFUSES[case]
    write_bytes(tmp_path / "mine.json", b"old")
    monkeypatch.setattr(place, name, fault, raising=False)
    with pytest.raises(error, match=words):
        write_bytes(tmp_path / "mine.json", b"new")
    monkeypatch.undo()
    assert [each.read_bytes() for each in tmp_path.iterdir()] == [b"old"]


def test_numbers_booleans_and_texts_are_read_as_they_were_written(tmp_path):
    arrays = {"a": np.asfortranarray(np.arange(6.0).reshape(2, 3)), "b": np.array("ä"), "c": np.zeros((0, 3), bool)}
    write_arrays(tmp_path / "a.npz", arrays)
    for name, values in read_arrays(tmp_path / "a.npz").items():
        np.testing.assert_array_equal(values, arrays[name])
        assert values.dtype == arrays[name].dtype and values.flags.writeable


def test_a_picture_replaces_a_picture_and_nothing_else(tmp_path):
    (tmp_path / "thesis.png").write_text("Chapter 1")
    (tmp_path / "old.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    (tmp_path / "folder.png").mkdir()
    assert "is not a png file" in refusal(check_replaceable, tmp_path / "thesis.png", ".png")
    assert "is a folder" in refusal(check_replaceable, tmp_path / "folder.png", ".png")
    assert "does not end in .png or .svg" in refusal(check_replaceable, tmp_path / "thesis.tex", ".png", ".svg")
    for name in ("old.png", "new.png"):
        assert check_replaceable(tmp_path / name, ".png") == tmp_path / name


# Reading --------------------------------------------------------------------------------------------

READERS = [read_arrays, read_json, read_bytes, sha256]
NO_FILE = {
    ".": "is a folder, not a file", "nowhere": "is not there", "nowhere/deeper": "is not there",
    "x" * 300: "File name too long", "a\0b": "null", "pipe": "is a device, not a file",
}  # fmt: skip


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="Windows has neither pipes nor devices in folders")
@pytest.mark.parametrize("read", READERS)
@pytest.mark.parametrize("name", NO_FILE)
def test_what_is_not_a_file_is_refused_at_once(read, name, tmp_path):
    os.mkfifo(tmp_path / "pipe")
    assert NO_FILE[name] in refusal(read, tmp_path / name)


def packed(path, members: dict[str, bytes], compression: int = zipfile.ZIP_DEFLATED):
    with zipfile.ZipFile(path, "w", compression) as file:
        for name, data in members.items():
            file.writestr(name, data)
    return path


def header(text: str) -> bytes:
    """The header of an .npy file that declares this."""
    return b"\x93NUMPY\x01\x00" + (len(text) + 1).to_bytes(2, "little") + text.encode() + b"\n"


def one_of(shape: str, descr: str = "|i1") -> bytes:
    return header(f"{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}") + b"1"


NO_ARRAYS = {
    "more numbers than there are": ({"a.npy": one_of("(1000000000,)", "<f8")}, zipfile.ZIP_DEFLATED),
    "a pickle": ({"a.npy": one_of("()", "|O")}, zipfile.ZIP_DEFLATED),
    "a very deep header": ({"a.npy": header("(" * 5000)}, zipfile.ZIP_DEFLATED),
    "no header": ({"a.npy": header("1 +")}, zipfile.ZIP_DEFLATED),
    "another packing": ({"a.npy": one_of("(1,)")}, zipfile.ZIP_BZIP2),
    "too many arrays": ({f"{i}.npy": one_of("(1,)") for i in range(MEMBERS + 1)}, zipfile.ZIP_STORED),
}


@pytest.mark.parametrize("case", NO_ARRAYS)
def test_arrays_that_numpy_would_not_write_are_refused(case, tmp_path):
    assert "a.npz is damaged" in refusal(read_arrays, packed(tmp_path / "a.npz", *NO_ARRAYS[case]))


def test_a_file_that_would_fill_the_memory_is_refused_before_it_is_unpacked(tmp_path):
    with zipfile.ZipFile(tmp_path / "bomb.npz", "w", zipfile.ZIP_DEFLATED, compresslevel=1) as file:
        with file.open("a.npy", "w") as member:
            for _ in range(UNPACKED // 2**24 + 1):
                member.write(bytes(2**24))
    assert "it declares 1 arrays of" in refusal(read_arrays, tmp_path / "bomb.npz")
    assert "at most 1,000 can be right" in refusal(read_bytes, tmp_path / "bomb.npz", 1000)


@pytest.mark.parametrize("text", [b"", b"{", b"\xff\xfe", b"[" * 10**6, b"NaN", b"1e999", b"9" * 5000, b'"\xff"'])
def test_what_is_not_json_is_refused(tmp_path, text):
    (tmp_path / "a.json").write_bytes(text)
    assert "restore it from a copy" in refusal(read_json, tmp_path / "a.json")
