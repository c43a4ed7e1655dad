"""The service at work: what systemd, the journal, LCM and the lines say of it."""

import math
import os
import subprocess

from robot import CONFIG
from steps import Journal, Watch, fails, run, show, until

journal = Journal()


def starts_blind(robot):
    """without sensors it runs, says what it misses, and holds the stop line"""
    robot.configure()
    assert run("systemd-analyze verify --man=no screed.service 2>&1") == ""
    run("systemctl enable --now screed")
    assert show("ActiveState") == "active"
    until(lambda: "blind: nothing has come" in show("StatusText"), "blind in the status")
    journal.says("no packets on UDP port 2368 have come yet")
    journal.says("the serial port /dev/robot-imu is not there")
    levels = run("journalctl -u screed -p warning -o cat --no-pager")
    assert "no packets on UDP port 2368" in levels and "publishing on" not in levels, levels
    assert robot.chip.value("stop") == 1


def is_confined(robot):
    """its own user without capabilities, readers with real-time priority, memory locked"""
    process = show("MainPID")
    with open(f"/proc/{process}/status") as file:
        status = dict(line.rstrip().split(":\t", 1) for line in file if ":\t" in line)
    assert run(f"stat -c %U /proc/{process}") == "scree"
    assert int(status["CapEff"], 16) == 0 and int(status["CapBnd"], 16) == 0, status
    assert int(status["VmLck"].split()[0]) > 100_000, status["VmLck"]
    policies = {}
    for thread in os.listdir(f"/proc/{process}/task"):
        with open(f"/proc/{process}/task/{thread}/stat") as file:
            name, fields = file.read().split("(", 1)[1].rsplit(")", 1)
        policies[name] = int(fields.split()[38])  # 1 is SCHED_FIFO
    wanted = {"lidar": 1, "imu": 1, "encoder": 1, "detector": 0, "publisher": 0}
    assert wanted.items() <= policies.items(), policies
    assert "RLIMIT" not in "".join(journal.lines())


def sees(robot):
    """with all sensors playing, lists of a moving robot come, and the stop line lets go"""
    robot.watch, robot.lists = Watch(), Watch("--json")
    robot.mti.plug_in()
    robot.play()
    robot.watch.says("imu ok (/dev/robot-imu)")
    robot.watch.says("encoder ok (vcan0, bus active)")
    robot.watch.says("health ok")
    first = robot.lists.next_list(robot.lists.mark())
    assert list(first) == ["stamp_ns", "pose", "obstacles"], first

    def moves():
        one = robot.lists.next_list(robot.lists.mark())
        return math.dist(one["pose"]["p"], first["pose"]["p"]) > 0.2

    until(moves, "a pose farther on")
    until(lambda: robot.chip.value("stop") == 0, "the stop line lets go")
    until(lambda: show("StatusText") == "sees", "sees in the status")
    levels = set()
    until(lambda: levels.add(robot.chip.value("heartbeat")) or len(levels) == 2, "the heartbeat")


def hears_pulses(robot):
    """the pulse per second of a GPIO line arrives"""
    robot.pulse(3)
    journal.says("the pulse per second of gpio.pps comes")


def reloads(robot):
    """a wider stop zone takes effect at once: there is an obstacle in it"""
    process, mark = show("MainPID"), journal.mark()
    robot.configure(stop="length = 5.5\nwidth = 50.0\nhold = 0.0", voxel=0.24)
    run("systemctl reload screed")
    journal.says("changed are stop.length, stop.width", mark)
    journal.says("needs a restart: map.voxel", mark)
    until(lambda: robot.chip.value("stop") == 1, "the stop line")
    until(lambda: show("StatusText") == "sees, and says stop", "stop in the status")
    robot.configure()
    run("systemctl reload screed")
    until(lambda: robot.chip.value("stop") == 0, "the stop line lets go")
    assert show("MainPID") == process and show("NRestarts") == "0"


def refuses_a_bad_file(robot):
    """the reload fails with the reason, and the daemon goes on as it was"""
    process, mark = show("MainPID"), journal.mark()
    robot.configure(stop="length = -1.0")
    fails("systemctl reload screed")
    journal.says(f"{CONFIG}:", mark)
    journal.says("stop.length = -1 is out of range", mark)
    assert show("MainPID") == process and show("ActiveState") == "active"
    # Past systemd, too.
    run("systemctl kill --kill-whom=main -s HUP screed")
    journal.says("not reloaded, the old settings stay", mark)
    robot.lists.next_list(robot.lists.mark())
    robot.configure()
    run("systemctl reload screed")


def is_examined(robot):
    """scree doctor finds bus, lines and rights as they should be"""
    found = subprocess.run(["scree", "doctor"], capture_output=True, text=True).stdout
    for words in [
        "2368 is bound by screed (process",
        "vcan0 is up (vcan)",
        "frames a second with identifier 0x",
        "rig:stop is held by screed",
        "the sensors' threads of screed come first",
        "screed has locked",
    ]:
        assert [line for line in found.splitlines() if line.startswith("ok") and words in line], found


def takes_a_replay(robot):
    """scree replay in place of the sensors: the IMU on a terminal, the encoder on the bus"""
    robot.silence()
    robot.mti.unplug()
    mark = robot.watch.mark()
    robot.watch.says("BLIND", mark)
    mark = robot.watch.mark()
    replay = subprocess.Popen(
        ["scree", "replay", robot.capture, "--loop", "--serial", robot.mti.port, "--can", "vcan0"]
    )
    robot.watch.says(f"imu ok ({robot.mti.port})", mark)
    robot.watch.says("encoder ok (vcan0, bus active)", mark)
    robot.watch.says("health ok", mark)
    robot.lists.next_list(robot.lists.mark())
    replay.terminate()
    assert replay.wait() == 0
    assert not os.path.lexists(robot.mti.port)
    robot.mti.plug_in()
    mark = robot.watch.mark()
    robot.play()
    robot.watch.says("health ok", mark)


STEPS = [
    starts_blind,
    is_confined,
    sees,
    is_examined,
    hears_pulses,
    reloads,
    refuses_a_bad_file,
    takes_a_replay,
]
