"""Shut a process in before it runs what strangers wrote: no network, few files, no other process.

On Linux, without root: a user, network and process namespace (unshare(2)), and Landlock (landlock(7)): the process and
its children may write beneath one folder, and read Python, this package and the system. Elsewhere, and where the
system forbids it, nothing of this applies: `shut_in` says what does.
"""

import contextlib
import ctypes
import os
import signal
import sys
from pathlib import Path

NEWUSER, NEWPID, NEWNET = 0x10000000, 0x20000000, 0x40000000  # sched.h
CREATE_RULESET, ADD_RULE, RESTRICT_SELF = 444, 445, 446  # numbers of the system calls, the same on all processors
NO_NEW_PRIVS, DEATH_SIGNAL = 38, 1  # of prctl(2)
READ = 0b1100  # read a file, list a folder
WRITE = 0b1_1111_1111_0010  # write, remove, make: all rights of Landlock's first version but execute and read
REFER, TRUNCATE = 1 << 13, 1 << 14  # of its second and third
FILE = 0b100_0000_0000_0110  # what a rule about a single file may permit: write, read, truncate
SYSTEM = ("/usr", "/lib", "/lib64", "/bin", "/etc", "/opt", "/proc", "/sys", "/dev")


def shut_in(folder: Path) -> list[str]:
    """Shut this process in; it may write beneath `folder` alone. Returns what holds: network, processes, files.

    Call it while there is one thread. It may return in a child: the parent then waits and ends as the child does.
    """
    if sys.platform != "linux":
        return []
    libc = ctypes.CDLL(None, use_errno=True)
    holds = []
    if libc.unshare(NEWUSER | NEWNET | NEWPID) == 0:
        become_first(libc)
        holds += ["network", "processes"]
    if restrict_files(libc, folder):
        holds.append("files")
    return holds


def become_first(libc: ctypes.CDLL) -> None:
    """Go on as the first process of the new namespace: when it ends, all that were started in it are killed."""
    child = os.fork()
    if child:
        for descriptor in (0, 1):
            os.close(descriptor)
        os._exit(max(0, os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])))
    libc.prctl(DEATH_SIGNAL, signal.SIGKILL, 0, 0, 0)


class PathBeneath(ctypes.Structure):
    _pack_ = 1
    _fields_ = [("allowed", ctypes.c_uint64), ("folder", ctypes.c_int32)]


def restrict_files(libc: ctypes.CDLL, folder: Path) -> bool:
    """Landlock: read what Python needs, write beneath `folder`. False where the kernel has no Landlock."""
    version = libc.syscall(CREATE_RULESET, None, ctypes.c_size_t(0), 1)
    if version < 1:
        return False
    write = WRITE | (REFER if version >= 2 else 0) | (TRUNCATE if version >= 3 else 0)
    handled = ctypes.c_uint64(READ | write)
    ruleset = libc.syscall(CREATE_RULESET, ctypes.byref(handled), ctypes.c_size_t(8), 0)
    if ruleset < 0:
        return False
    package = str(Path(__file__).resolve().parents[3])
    for place in {*SYSTEM, *filter(None, sys.path), sys.prefix, sys.base_prefix, package}:
        allow(libc, ruleset, place, READ)
    allow(libc, ruleset, os.devnull, READ | (write & FILE))
    allow(libc, ruleset, str(folder), READ | write)
    libc.prctl(NO_NEW_PRIVS, 1, 0, 0, 0)
    return libc.syscall(RESTRICT_SELF, ruleset, 0) == 0


def allow(libc: ctypes.CDLL, ruleset: int, place: str, rights: int) -> None:
    """Permit these rights beneath a place; a place that does not exist is left out."""
    with contextlib.suppress(OSError):
        descriptor = os.open(place, os.O_PATH | os.O_CLOEXEC)
        rule = PathBeneath(rights if os.path.isdir(place) else rights & FILE, descriptor)
        libc.syscall(ADD_RULE, ruleset, 1, ctypes.byref(rule), 0)
        os.close(descriptor)
