import socket
import time

import lcm
import pytest

import scree


@pytest.fixture
def bus():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        url = f"udpm://239.255.76.67:{probe.getsockname()[1]}?ttl=0"
    try:
        return url, lcm.LCM(url)
    except RuntimeError as error:
        pytest.skip(f"LCM cannot be opened: {error}")


def health(ok=True, reason=""):
    message = scree.health_t()
    message.state, message.reason = message.OK if ok else message.BLIND, reason
    return message.encode()


def found():
    rock, message = scree.obstacle_t(), scree.obstacle_list_t()
    rock.id, rock.kind, rock.center, rock.extent = 7, rock.POSITIVE, [10, 8, 0], [1, 1, 1]
    message.p, message.q = [10, 5, 0], [0.5**0.5, 0, 0, 0.5**0.5]
    message.size, message.obstacles = 1, [rock]
    return message.encode()


def wait_for(condition):
    end = time.monotonic() + 20
    while not condition():
        assert time.monotonic() < end, "it never came"
        time.sleep(0.02)


def test_obstacles_come_in_base_while_it_sees(bus):
    url, sender = bus
    heard = []
    with scree.subscribe(url, stale_after=0.3, on_list=heard.append) as subscription:
        assert subscription.view().stop == "no health yet"
        sender.publish("SCREE_HEALTH", health())
        wait_for(lambda: subscription.view().stop == "no list yet")
        sender.publish("SCREE_OBSTACLES", found())
        wait_for(lambda: subscription.view().sees)
        (rock,) = subscription.view().obstacles
        assert rock.center == pytest.approx((3, 0, 0))
        assert heard[0].obstacles[0].id == 7
        wait_for(lambda: subscription.view().stop == "the lists are stale")
        view = subscription.view()
        assert (view.sees, view.obstacles, view.latest.obstacles[0].id) == (False, (), 7)


def test_blind_is_never_an_empty_list(bus):
    url, sender = bus
    with scree.subscribe(url) as subscription:
        sender.publish("SCREE_OBSTACLES", found())
        sender.publish("SCREE_HEALTH", health(False, "no packets"))
        wait_for(lambda: subscription.view().stop == "blind: no packets")
        assert not subscription.view().sees


def test_a_wrong_url_is_named():
    with pytest.raises(RuntimeError, match="rubbish://x"):
        scree.subscribe("rubbish://x")


def test_garbage_is_refused_and_counted(bus):
    url, sender = bus
    with scree.subscribe(url) as subscription:
        for data in (b"", b"x" * 40, found()[:30]):
            sender.publish("SCREE_OBSTACLES", data)
        wait_for(lambda: subscription.refused == 3)
        sender.publish("SCREE_HEALTH", health())
        wait_for(lambda: subscription.view().stop == "no list yet")
