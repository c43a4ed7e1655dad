"""What a daemon stands on and may be taken from it: routes, disk, descriptors, the processor and
whoever reads its log. Each has begin() and end()."""

import ctypes
import os
import resource
import signal
import subprocess
import threading
import time

from programs import fill

NEW_MOUNTS, NEW_NETWORK = 0x00020000, 0x40000000  # sched.h: CLONE_NEWNS, CLONE_NEWNET
ADD_ROUTE, REMOVE_ROUTE = (f"ip route {verb} 239.0.0.0/8 dev lo" for verb in ("add", "del"))
PREPARE = ("mount --make-rprivate /", "ip link set lo up", ADD_ROUTE)


def run(command):
    subprocess.run(command.split(), check=True, capture_output=True)


def take_namespaces():
    """Routes and mounts of this program's own from now on, for its later threads and programs, too;
    False where it may not."""
    tried = " && ".join((*PREPARE, "mount -t tmpfs tmpfs /mnt"))
    if subprocess.run(["unshare", "-mn", "sh", "-c", tried], capture_output=True).returncode != 0:
        return False
    if ctypes.CDLL(None).unshare(NEW_MOUNTS | NEW_NETWORK) != 0:
        return False
    for command in PREPARE:
        run(command)
    return True


class Route:
    """To LCM's multicast groups."""

    def begin(self):
        run(REMOVE_ROUTE)

    def end(self):
        run(ADD_ROUTE)


class SmallDisk:
    """Of 32 MB; full from begin() on."""

    def __init__(self, folder):
        os.makedirs(folder)
        run(f"mount -t tmpfs -o size=32m tmpfs {folder}")
        self.folder, self.file = folder, os.path.join(folder, "full")

    def begin(self):
        with open(self.file, "wb", buffering=0) as file:
            try:
                while True:
                    file.write(bytes(4096))
            except OSError:
                pass

    def end(self):
        os.remove(self.file)

    def unmount(self):
        run(f"umount --lazy {self.folder}")


class Descriptors:
    """The process gets no new ones."""

    def __init__(self, process):
        self.process = process

    def begin(self):
        used = 8  # it has more, and poll() refuses to watch more than the limit
        self.limits = resource.prlimit(self.process, resource.RLIMIT_NOFILE)
        resource.prlimit(self.process, resource.RLIMIT_NOFILE, (used, self.limits[1]))

    def end(self):
        resource.prlimit(self.process, resource.RLIMIT_NOFILE, self.limits)


class Processor:
    """Half of its time is somebody else's, whatever the process's priority."""

    PAUSE = 0.01  # seconds

    def __init__(self, process):
        self.process = process

    def begin(self):
        self.ended = threading.Event()
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()

    def _run(self):
        while not self.ended.wait(self.PAUSE):
            os.kill(self.process, signal.SIGSTOP)
            time.sleep(self.PAUSE)
            os.kill(self.process, signal.SIGCONT)

    def end(self):
        self.ended.set()
        self.thread.join()


class LogReader:
    """A program between a log's pipe and `lines`, which stops reading; the pipe is full at once."""

    def __init__(self, process):
        self.process = process.pid
        self.cat = subprocess.Popen(["cat"], stdin=process.stderr, stdout=subprocess.PIPE, text=True)
        self.lines = self.cat.stdout

    def begin(self):
        self.cat.send_signal(signal.SIGSTOP)
        pipe = os.open(f"/proc/{self.process}/fd/2", os.O_WRONLY | os.O_NONBLOCK)
        fill(pipe)
        os.close(pipe)

    def end(self):
        self.cat.send_signal(signal.SIGCONT)

    def stop(self):
        self.cat.kill()
        self.cat.communicate()
