"""A headless browser for the pages of scree report and scree view."""

import shutil
import time
import unittest

BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


class Page:
    """A page that is shown, and what it complained of."""

    def __init__(self, test, url, width=1500, height=900):
        try:
            from playwright.sync_api import sync_playwright
        except ImportError as error:
            raise unittest.SkipTest("there is no module playwright (tests/requirements.txt)") from error
        if BROWSER is None:
            raise unittest.SkipTest("there is no Chromium (tools/packages.txt)")
        playwright = sync_playwright().start()
        test.addCleanup(playwright.stop)
        browser = playwright.chromium.launch(executable_path=BROWSER, args=["--no-sandbox"])
        test.addCleanup(browser.close)
        self.page = browser.new_page(viewport={"width": width, "height": height})
        self.complaints, self.asked_for = [], []
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("console", lambda message: self._hear(message))
        self.page.on("request", lambda request: self.asked_for.append(request.url))
        self.page.goto(url)
        self.page.wait_for_selector("body[data-ready=yes]", timeout=60_000)

    def _hear(self, message):
        is_own = "willReadFrequently" in message.text  # of colour_at()
        if message.type in ("error", "warning") and not is_own:
            self.complaints.append(message.text)

    def of(self, script):
        """What the script evaluates to in the page."""
        return self.page.evaluate(script)

    def text(self, selector):
        return self.page.inner_text(selector)

    def click(self, selector):
        self.page.click(selector)

    def wait_for(self, script, seconds=60):
        end = time.monotonic() + seconds
        while not self.of(script):  # the page forbids what would wait inside of it
            if time.monotonic() > end:
                raise AssertionError(f"it never came to: {script}")
            self.page.wait_for_timeout(30)

    def colour_at(self, x, y):
        """Red, green, blue of a place of `odom` on the map."""
        self.page.wait_for_timeout(150)  # the map is drawn with the next frame
        return self.of(
            f"""(() => {{ const map = page.map, view = map.view;
            const at = [view.across({y}), view.down({x})].map((v) => Math.round(v * view.ratio));
            return [...map.canvas.getContext('2d').getImageData(...at, 1, 1).data].slice(0, 3); }})()"""
        )

    def screenshot(self, path):
        self.page.wait_for_timeout(150)
        self.page.screenshot(path=path)
