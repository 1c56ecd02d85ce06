"""Shut the process of an answer in before it runs what a stranger wrote: no network, few files, no other process.

On Linux, without root: a user, network, process and mount namespace (unshare(2)), Landlock (landlock(7)) and a filter
of system calls (seccomp(2)). The process may read Python, this package and the system, and write beneath a small folder
in memory; it starts no process, opens no socket and has no right of root. Elsewhere, and where the system forbids it,
nothing of this applies: `python -m bootcourse.course.classroom.sandbox FOLDER` prints what does.
"""

import contextlib
import ctypes
import json
import os
import platform
import signal
import sys
import tempfile
from pathlib import Path

import numba

from bootcourse.road.compiled import CACHE_FOLDER

NEWNS, NEWIPC, NEWUSER, NEWPID, NEWNET = 0x20000, 0x8000000, 0x10000000, 0x20000000, 0x40000000  # sched.h
THREAD = 0x10000
CREATE_RULESET, ADD_RULE, RESTRICT_SELF = 444, 445, 446  # numbers of the system calls, the same on all processors
DEATH_SIGNAL, SECCOMP, NO_NEW_PRIVS = 1, 22, 38  # of prctl(2)
LIST, READ = 0b1000, 0b1100  # Landlock's rights to list a folder, and to read files, too
WRITE = 0b1_1111_1111_0010  # write, remove, make: all rights of Landlock's first version but execute and read
REFER, TRUNCATE = 1 << 13, 1 << 14  # of its second and third
SCOPES = 0b11  # of its sixth: abstract sockets, and signals to processes outside
FILE = 0b100_0000_0000_0110  # what a rule about a single file may permit: write, read, truncate
SYSTEM = ("/usr", "/lib", "/lib64", "/bin", "/etc", "/opt", "/proc", "/sys", "/dev/zero", "/dev/random", "/dev/urandom")
PACKAGE = Path(__file__).resolve().parents[2]
NOTHING_SPECIAL, ROOM = 0b1110, b"size=64m,nr_inodes=4k"  # no programs, devices, rights of others in that folder
LARGEST, MOST = 2**24, 256  # bytes of a file, and threads, of an answer; the latter not as root
ALLOWED, FAILS, UNKNOWN = 0x7FFF0000, 0x00050001, 0x00050026  # of a filter: go on; fail with EPERM; with ENOSYS
CAPABILITIES = 0x20080522  # the version of capset(2)
HOLDS = {  # what may hold -> what an answer can do if it does not
    "files": "read and change your files",
    "network": "use the network",
    "calls": "start programs and talk to others, and change the dates and permissions of your files",
    "processes": "see and end your programs",
    "disk": "fill your disk",
}
PROCESSORS = {"x86_64": (0xC000003E, 56), "aarch64": (0xC00000B7, 220)}  # -> of a filter, and its number of clone
CLONE3 = 435
REFUSED = {  # system calls by number, on these processors, see asm/unistd.h
    "socket, socketpair, io_uring_setup": ((41, 53, 425), (198, 199, 425)),
    "chmod, chown": ((90, 91, 92, 93, 94, 260, 268, 452), (52, 53, 54, 55, 452)),
    "utime, setxattr, removexattr": ((132, 235, 261, 280, 188, 189, 190, 197, 198, 199, 463, 466, 469),
                                     (88, 5, 6, 7, 14, 15, 16, 463, 466, 469)),
    "fork, vfork, unshare, setns": ((57, 58, 272, 308), (97, 268)),
    "kill and its kin, setpgid, setsid": ((62, 109, 112, 129, 200, 234, 297, 424),
                                          (129, 154, 157, 138, 130, 131, 240, 424)),
    "ptrace, process_vm_readv, process_vm_writev": ((101, 310, 311), (117, 270, 271)),
    "keys": ((248, 249, 250), (217, 218, 219)),
    "memory and queues of several processes": ((29, 64, 68, 240, 319, 447), (194, 190, 186, 180, 279, 447)),
    "bpf, perf_event_open, userfaultfd": ((321, 298, 323), (280, 241, 282)),
}  # fmt: skip


def shut_in(folder: Path) -> list[str]:
    """Shut this process in; it may write beneath a new folder in `folder` alone. Returns what holds: see `HOLDS`.

    Call it while there is one thread. It returns in a child: the parent waits, and ends as the child does.
    """
    if sys.platform != "linux":
        return []
    libc, holds, scratch = ctypes.CDLL(None, use_errno=True), [], Path(tempfile.mkdtemp(dir=folder))
    user, group = os.getuid(), os.getgid()
    if libc.unshare(NEWUSER | NEWNET | NEWPID | NEWNS | NEWIPC) == 0:
        holds += ["network", "processes"]
        with contextlib.suppress(OSError):
            for name, text in ("setgroups", "deny"), ("uid_map", f"0 {user} 1"), ("gid_map", f"0 {group} 1"):
                Path("/proc/self", name).write_text(text)
        if libc.mount(b"tmpfs", bytes(scratch), b"tmpfs", NOTHING_SPECIAL, ROOM) == 0:
            holds.append("disk")
        limit("RLIMIT_NPROC", MOST)  # of these processes alone: others of the same user are not in the namespace
        become_first(libc)
        libc.mount(b"proc", b"/proc", b"proc", NOTHING_SPECIAL, None)  # not where a container hides parts of it
    limit("RLIMIT_FSIZE", LARGEST)
    limit("RLIMIT_CORE", 0)
    os.environ |= dict.fromkeys(("HOME", "TMPDIR", "TEMP", "TMP", "MPLCONFIGDIR"), str(scratch))
    tempfile.tempdir = None
    numba.core.caching.Cache.save_overload = lambda *arguments: None  # what it compiles, nobody else executes
    os.chdir(scratch)
    if restrict_files(libc, scratch):
        holds.append("files")
    no_rights = libc.capset((ctypes.c_uint32 * 2)(CAPABILITIES), (ctypes.c_uint32 * 6)()) == 0  # of root
    if refuse_calls(libc) and no_rights:
        holds.append("calls")
    return holds


def limit(what: str, most: int) -> None:
    import resource  # not on Windows

    hard = resource.getrlimit(getattr(resource, what))[1]
    most = most if hard == resource.RLIM_INFINITY else min(most, hard)
    resource.setrlimit(getattr(resource, what), (most, most))


def become_first(libc: ctypes.CDLL) -> None:
    """Go on as the first process of the new namespace: when it ends, all that were started in it are killed."""
    child = os.fork()
    if child:
        signal.signal(signal.SIGUSR1, signal.SIG_IGN)  # asked where the answer is, the child alone replies
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        if code < 0:  # minus the signal that ended it
            os.kill(os.getpid(), -code)
        os._exit(code)
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
    handled = (ctypes.c_uint64 * 3)(READ | write, 0, SCOPES if version >= 6 else 0)
    size = ctypes.c_size_t(24 if version >= 6 else 8)
    ruleset = libc.syscall(CREATE_RULESET, ctypes.byref(handled), size, 0)
    if ruleset < 0:
        return False
    kit = PACKAGE.parent  # of its source tree, which may hold anything, the package and the results alone
    places = {
        *SYSTEM,
        *filter(None, sys.path),
        sys.prefix,
        sys.base_prefix,
        str(PACKAGE),
        str(kit / "assets"),
        str(CACHE_FOLDER),
    }
    if (kit / "pyproject.toml").exists():
        places -= {str(kit)}
        allow(libc, ruleset, str(kit), LIST)
    for place in places:
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


class Step(ctypes.Structure):  # of a filter, see linux/filter.h
    _fields_ = [("code", ctypes.c_uint16), ("yes", ctypes.c_uint8), ("no", ctypes.c_uint8), ("value", ctypes.c_uint32)]


class Filter(ctypes.Structure):
    _fields_ = [("length", ctypes.c_uint16), ("steps", ctypes.POINTER(Step))]


def refuse_calls(libc: ctypes.CDLL) -> bool:
    """seccomp(2): from now on the system calls of `REFUSED` fail, and a thread is all that clone makes.

    False where this is not possible.
    """
    if platform.machine() not in PROCESSORS:
        return False
    (processor, clone), place = PROCESSORS[platform.machine()], list(PROCESSORS).index(platform.machine())
    load, equal, at_least, any_of, answer = 0x20, 0x15, 0x35, 0x45, 0x06
    allowed, fails = Step(answer, 0, 0, ALLOWED), Step(answer, 0, 0, FAILS)
    steps = [
        Step(load, 0, 0, 4),
        Step(equal, 1, 0, processor),
        fails,
        Step(load, 0, 0, 0),
        Step(at_least, 0, 1, 0x40000000),
        fails,  # another way to call the same on x86_64
        Step(equal, 0, 1, CLONE3),
        Step(answer, 0, 0, UNKNOWN),
    ]  # its flags cannot be seen: libc takes clone
    for numbers in REFUSED.values():
        for number in numbers[place]:
            steps += [Step(equal, 0, 1, number), fails]
    steps += [Step(equal, 1, 0, clone), allowed, Step(load, 0, 0, 16), Step(any_of, 1, 0, THREAD), fails, allowed]
    program = Filter(len(steps), (Step * len(steps))(*steps))
    libc.prctl(NO_NEW_PRIVS, 1, 0, 0, 0)
    return libc.prctl(SECCOMP, 2, ctypes.byref(program), 0, 0) == 0


if __name__ == "__main__":
    print(json.dumps(shut_in(Path(sys.argv[1]))))
