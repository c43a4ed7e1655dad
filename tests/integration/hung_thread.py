"""Stops one thread of a process, as if it hung, and lets it go on or takes note of its death."""

import contextlib
import ctypes
import glob
import os

SEIZE, INTERRUPT, DETACH = 0x4206, 0x4207, 17
WAIT_FOR_ANY_THREAD = 0x40000000  # __WALL

libc = ctypes.CDLL(None, use_errno=True)
libc.ptrace.argtypes = [ctypes.c_long] * 4
libc.ptrace.restype = ctypes.c_long


def ptrace(request, thread):
    if libc.ptrace(request, thread, 0, 0) != 0:
        raise OSError(ctypes.get_errno(), "ptrace: " + os.strerror(ctypes.get_errno()))


def thread_of(process, name):
    for folder in glob.glob(f"/proc/{process}/task/*"):
        with open(f"{folder}/comm") as file:
            if file.read().strip() == name:
                return int(os.path.basename(folder))
    raise LookupError(f"process {process} has no thread {name}")


def hang(process, name):
    """The thread hangs from now on, until let_go() or the end of this program. When its process is
    killed it needs bury(), for the process to be gone."""
    thread = thread_of(process, name)
    ptrace(SEIZE, thread)
    ptrace(INTERRUPT, thread)
    os.waitpid(thread, WAIT_FOR_ANY_THREAD)
    return thread


def let_go(thread):
    ptrace(DETACH, thread)


def bury(thread):
    os.waitpid(thread, WAIT_FOR_ANY_THREAD)


@contextlib.contextmanager
def hung(process, name):
    thread = hang(process, name)
    try:
        yield
    finally:
        let_go(thread)
