"""What goes wrong on a robot, and that it is got over."""

import hung_thread
from robot import BUS_OFF, SerialMti, usb_adapter
from steps import Journal, fails, run, show, until

journal = Journal()


def lists_go_on(robot):
    robot.lists.next_list(robot.lists.mark())


def lidar_is_cut(robot):
    """blind is said, the stop line is on; with the packets it sees again"""
    mark = robot.watch.mark()
    robot.silence()
    robot.watch.says("BLIND (no packets on UDP port 2368)", mark)
    until(lambda: robot.chip.value("stop") == 1, "the stop line")
    until(lambda: show("StatusText").startswith("blind: no packets"), "blind in the status")
    mark = robot.watch.mark()
    robot.play()
    robot.watch.says("health ok", mark)
    until(lambda: robot.chip.value("stop") == 0, "the stop line lets go")
    lists_go_on(robot)


def imu_is_cut(robot):
    """its terminal goes and comes back; lists go on meanwhile"""
    mark, line = robot.watch.mark(), journal.mark()
    robot.mti.unplug()
    robot.watch.says("imu silent", mark)
    journal.says("no messages from the IMU on /dev/robot-imu any more", line)
    lists_go_on(robot)
    mark = robot.watch.mark()
    robot.mti.plug_in()
    robot.watch.says("imu ok", mark)
    lists_go_on(robot)


def encoder_link_goes_down(robot):
    """the interface is down, and up again"""
    mark = robot.watch.mark()
    run("ip link set vcan0 down")
    robot.watch.says("encoder silent (vcan0, bus down)", mark)
    mark = robot.watch.mark()
    run("ip link set vcan0 up")
    robot.watch.says("encoder ok (vcan0, bus active)", mark)


def encoder_interface_goes(robot):
    """the adapter is unplugged, and plugged in again under its name"""
    mark = robot.watch.mark()
    robot.can.remove()
    robot.watch.says("encoder silent (vcan0, bus", mark)
    mark = robot.watch.mark()
    robot.can.add()
    robot.watch.says("encoder ok (vcan0, bus active)", mark)


def bus_goes_off(robot):
    """the controller reports bus-off, then frames again"""
    line = journal.mark()
    robot.can.send(BUS_OFF)
    journal.says("encoder: bus bus_off", line)
    journal.says("encoder: bus active", line)
    robot.watch.says("encoder ok (vcan0, bus active)", robot.watch.mark())
    lists_go_on(robot)


def the_clock_is_set(robot):
    """an hour ahead, and back again: lists go on, each with the clock's time of now"""
    for by in ["1 hour", "1 hour ago"]:
        mark = robot.watch.mark()
        run(f"date -s '{by}'")
        lists_go_on(robot)
        robot.watch.says("health ok", mark)


def a_thread_hangs(robot):
    """whichever it is: systemd ends the process, starts it anew, and it sees again"""
    for name in ["detector", "publisher", "lidar"]:
        restarts, line, mark = int(show("NRestarts")), journal.mark(), robot.watch.mark()
        thread = hung_thread.hang(int(show("MainPID")), name)
        journal.says(f"the {name} thread hangs", line)
        journal.says("Watchdog timeout", line)
        hung_thread.bury(thread)
        until(lambda: int(show("NRestarts")) > restarts, "a restart")
        robot.watch.says("health ok", mark)
        lists_go_on(robot)


def the_process_is_killed(robot):
    """it is started anew"""
    restarts, mark = int(show("NRestarts")), robot.watch.mark()
    run("systemctl kill --kill-whom=main -s KILL screed")
    until(lambda: int(show("NRestarts")) > restarts, "a restart")
    robot.watch.says("health ok", mark)


def a_usb_adapter_is_the_imus(robot):
    """udev has set it up; the service may open it, and gets over its unplugging"""
    assert run("cat /sys/bus/usb-serial/devices/ttyUSB0/latency_timer") == "1"
    assert run(f"stat -c '%G %a' /dev/{robot.chip.name}") == "gpio 660"
    robot.mti.unplug()
    robot.mti = SerialMti("/dev/ttyUSB0")
    robot.mti.plug_in()
    robot.configure(device="/dev/ttyUSB0")
    robot.silence()
    mark = robot.watch.mark()
    run("systemctl restart screed")
    robot.play()
    robot.watch.says("imu ok (/dev/ttyUSB0)", mark)
    mark = robot.watch.mark()
    usb_adapter(plugged=False)
    robot.watch.says("imu silent", mark)
    mark = robot.watch.mark()
    usb_adapter(plugged=True)
    robot.watch.says("imu ok (/dev/ttyUSB0)", mark)
    robot.watch.says("health ok", mark)


def gpio_chip_goes(robot):
    """the adapter of the lines is unplugged, which is said, and plugged in again"""
    mark = journal.mark()
    robot.chip.unplug()
    journal.says("line cannot be set", mark)
    robot.chip.plug_in()
    journal.says("line can be set again", mark)
    robot.silence()
    until(lambda: robot.chip.value("stop") == 1, "the stop line")
    robot.chip.unplug()
    robot.chip.plug_in()
    until(lambda: robot.chip.value("stop") == 1, "the stop line of a robot that is still blind")
    robot.play()
    until(lambda: robot.chip.value("stop") == 0, "the stop line lets go")


def a_bad_start_is_tried_again(robot):
    """a broken file at the start: systemd tries until it is mended"""
    robot.configure(stop="length = -1.0")
    fails("systemctl restart screed")
    robot.configure(device="/dev/ttyUSB0")
    until(lambda: show("ActiveState") == "active", "the service")


STEPS = [
    lidar_is_cut,
    imu_is_cut,
    encoder_link_goes_down,
    encoder_interface_goes,
    bus_goes_off,
    the_clock_is_set,
    a_thread_hangs,
    the_process_is_killed,
    a_usb_adapter_is_the_imus,
    gpio_chip_goes,
    a_bad_start_is_tried_again,
]
