# SPDX-License-Identifier: BSD-3-Clause
"""A headless Chromium that remembers what went wrong on a page."""

import json

from mrp_testing.waiting import DEADLINE, wait_until
from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains

SIZES = {"desktop": (1280, 800), "phone": (360, 740)}

# The browser asks for nothing by itself, and finds no host but this one. Root has no sandbox.
_ARGUMENTS = [
    *"--headless --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run".split(),
    *"--disable-background-networking --disable-component-update --disable-sync".split(),
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
]


class Browser:
    name = "chromium"

    def __init__(self, profile):
        options = webdriver.ChromeOptions()
        options.binary_location = "/usr/bin/chromium"
        for argument in (*_ARGUMENTS, f"--user-data-dir={profile}"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        self.driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        self.driver.set_page_load_timeout(DEADLINE)
        self.driver.set_script_timeout(DEADLINE)

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.driver.quit()

    def open(self, url, size="desktop"):
        """Open a page, and forget what happened on those before."""
        self.driver.get("about:blank")
        width, height = SIZES[size]
        self.command(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=size == "phone",
        )
        self.console()
        self.requests()
        self.driver.get(url)

    def command(self, name, **arguments):
        """Give a command of the browser's own protocol."""
        return self.driver.execute_cdp_cmd(name, arguments)

    def prefer(self, mode):
        """Be the browser of one who prefers pages in light or in dark mode."""
        feature = {"name": "prefers-color-scheme", "value": mode}
        self.command("Emulation.setEmulatedMedia", features=[feature])

    def run(self, script, *arguments):
        """Run a script on the page; return what it returns."""
        return self.driver.execute_script(script, *arguments)

    def find(self, selector):
        return self.driver.find_elements("css selector", selector)

    def press(self, *keys):
        ActionChains(self.driver, duration=0).send_keys(*keys).perform()

    def wait_until(self, condition, what):
        """Wait until the condition holds; return what it returned."""
        return wait_until(condition, what)

    def console(self):
        """Return what was written to the console since the last call: of every level."""
        return [f"{entry['level']}: {entry['message']}" for entry in self.driver.get_log("browser")]

    def requests(self):
        """Return (addresses, failures) of all requests since the last call."""
        addresses, failures = {}, []
        for entry in self.driver.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            method, event = message["method"], message["params"]
            if method == "Network.requestWillBeSent":
                addresses[event["requestId"]] = event["request"]["url"]
            elif method == "Network.loadingFailed":
                address = addresses.get(event["requestId"], "?")
                failures.append(f"{address}: {event['errorText']}")
            elif method == "Network.responseReceived" and event["response"]["status"] >= 400:
                failures.append(f"{event['response']['url']}: {event['response']['status']}")
        return list(addresses.values()), failures
