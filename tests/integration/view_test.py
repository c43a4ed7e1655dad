"""scree view in a browser: python3 view_test.py SCREED SCREE TYPES [TEST ...]"""

import json
import os
import signal
import sys
import time
import urllib.error
import urllib.request

from browser import Page
from live_daemon import LiveDaemonTest
from live_sensors import Player
from programs import PATIENCE, main

LiveDaemonTest.screed, LiveDaemonTest.scree, TYPES = sys.argv[1:4]
sys.path.insert(0, TYPES)
import scree  # noqa: E402
from lcm_sender import Sender  # noqa: E402


class ViewTest(LiveDaemonTest):
    def view(self, *arguments):
        self.viewer = self.start(self.scree, "view", "--url", self.url, "--port", "0", *arguments)
        return self.viewer.stdout.readline().strip()

    def status(self, url, host=None):
        request = urllib.request.Request(url, headers={"Host": host} if host else {})
        try:
            with urllib.request.urlopen(request, timeout=10) as answer:
                return answer.status
        except urllib.error.HTTPError as error:
            return error.code

    def test_a_replay_is_shown_and_a_new_start_of_screed(self):
        capture = self.simulate()
        page = Page(self, self.view("--config", self.config))
        page.wait_for("document.getElementById('state').textContent.includes('screed says nothing')")
        self.start_daemon()
        self.assertTrue(self.mti.measures.wait(PATIENCE))
        player = Player(capture, self.port, self.position_port, self.mti, loop=True)
        self.addCleanup(player.stop)
        page.wait_for("page.latest && page.latest.obstacles.length > 3 && page.image")
        page.wait_for("page.trail.length > 20")
        page.page.wait_for_timeout(3000)  # it is the rate of three seconds
        rate = page.of("page.rates.list.perSecond()")
        print(f"{rate:.1f} lists a second were shown")
        shown = page.of("JSON.stringify(page.latest.obstacles.map((it) => it.id))")
        stamp = page.of("page.latest.stamp")
        same = [json.loads(line) for line in self.lists.lines if abs(json.loads(line)["stamp_ns"] - stamp) < 1000]
        self.assertIn(json.loads(shown), [[it["id"] for it in one["obstacles"]] for one in same] or [json.loads(shown)])
        page.screenshot(os.environ.get("SCREE_SCREENSHOT", self.path("view.png")))

        self.daemon.send_signal(signal.SIGTERM)
        self.daemon.wait(PATIENCE)
        page.wait_for("document.getElementById('state').textContent.includes('screed says nothing')")
        at = time.time_ns()
        self.daemon = self.start(self.screed, "--config", self.config)
        page.wait_for(f"page.latest.stamp > {at} && page.rates.list.age() < 0.5")
        page.click("#tab-Health")
        self.assertIn("lidar", page.text("#panel"))
        self.viewer.send_signal(signal.SIGTERM)
        self.assertEqual(self.viewer.wait(PATIENCE), 0)
        page.wait_for("document.getElementById('state').textContent.includes('No connection')")
        # The connection that ended is told by the browser itself.
        self.assertEqual([it for it in page.complaints if "ERR_" not in it], [])

    def test_blind_stop_and_what_is_wrong_are_shown(self):
        health, found = scree.health_t(), scree.obstacle_list_t()
        found.q = [1, 0, 0, 0]
        health.state, health.reason = health.BLIND, "no packets <i>on port 2368"
        sender = Sender(self.url, {"SCREE_HEALTH": health, "SCREE_OBSTACLES": found})
        self.addCleanup(sender.stop)
        page = Page(self, self.view())
        page.wait_for("document.getElementById('state').textContent === 'BLIND: no packets <i>on port 2368'")
        health.state = health.OK
        page.wait_for("document.getElementById('state').textContent === 'OK'")
        self.assertIn("nothing there", page.text("#panel"))
        health.stop = True
        page.wait_for("document.getElementById('state').textContent.startsWith('STOP')")
        sender.messages = {"SCREE_HEALTH": health}
        page.wait_for("document.getElementById('state').textContent.includes('stale')")
        self.assertEqual(page.complaints, [])

    def test_ground_is_shaded_where_it_changes_as_if_all_were(self):
        page = Page(self, self.view())
        differing, painted = page.of(
            """(() => {
            const live = new LiveGround(0.25, 10);
            let seed = 7;
            const any = (most) => (seed = (seed * 48271) % 2147483647) % most;
            for (let i = 0; i < 40; ++i) {
              const [columns, rows] = [20 + any(9), 20 + any(9)];
              const state = Uint8Array.from({ length: columns * rows }, () => any(4));
              const p = [i / 4, -i / 5, 0.1];
              live.add({ columns, rows, state, ground: Array.from(state, () => any(100) - 50),
                         pose: { p }, origin: [p[0] - any(12), p[1] - any(12)] });
            }
            const pixels = ({ image }) => image.getContext('2d').getImageData(0, 0, live.size, live.size).data;
            const { cell, size, heights } = live;
            const whole = pixels(drawnGround({ x: 0, y: 0, cell, columns: size, rows: size, heights }));
            const parts = pixels(live.drawn());
            return [parts.filter((value, i) => value !== whole[i]).length, whole.filter((value) => value > 0).length];
            })()"""
        )
        self.assertEqual(differing, 0)
        self.assertGreater(painted, 4000)

    def test_only_who_may_gets_in(self):
        url = self.view()
        self.assertTrue(url.startswith("http://127.0.0.1:"))
        self.assertEqual(self.status(url), 200)
        self.assertEqual(self.status(url, "evil.example:80"), 403)
        self.assertEqual(self.status(url + "../../etc/passwd"), 404)
        other = self.view("--token", "s3cret")
        self.assertTrue(other.endswith("?token=s3cret"))
        self.assertEqual(self.status(other), 200)
        for wrong in ("", "?token=s3cre", "?token=s3crets"):
            self.assertEqual(self.status(other.split("?")[0] + wrong), 403)
            self.assertEqual(self.status(other.split("?")[0] + "events" + wrong), 403)
        port = url.rsplit(":", 1)[1].rstrip("/")
        taken = self.run_to_end(self.scree, "view", "--url", self.url, "--port", port)
        self.assert_fails(taken, "the port is taken")
        self.done(self.scree, "view", "--token", "a b", code=2)


if __name__ == "__main__":
    main(sys.argv[4:])
