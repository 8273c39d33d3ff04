# SPDX-License-Identifier: BSD-3-Clause
"""A headless Firefox, asked by WebDriver BiDi, which it speaks itself.

Debian has no geckodriver, which Selenium would need.
"""

import json
import re

import websocket
from browser import SIZES
from mrp_testing.process import Process
from mrp_testing.waiting import DEADLINE, wait_until

# The browser asks for nothing by itself: no updates, no telemetry, no page of its own.
_SETTINGS = {
    "app.normandy.enabled": False,
    "app.update.disabledForTesting": True,
    "browser.safebrowsing.update.enabled": False,
    "browser.shell.checkDefaultBrowser": False,
    "browser.startup.homepage_override.mstone": "ignore",
    "datareporting.policy.dataSubmissionEnabled": False,
    "extensions.update.enabled": False,
    "network.captive-portal-service.enabled": False,
    "network.connectivity-service.enabled": False,
    "services.settings.server": "data:,#remote-settings-dummy/v1",
    "toolkit.telemetry.server": "data:,",
}


class Firefox:
    """Has what the tests for both browsers need of `Browser`."""

    name = "firefox"

    def __init__(self, profile):
        lines = (
            f'user_pref("{key}", {json.dumps(setting)});\n' for key, setting in _SETTINGS.items()
        )
        (profile / "user.js").write_text("".join(lines))
        command = ["firefox-esr", "--headless", "--no-remote", "--remote-debugging-port", "0"]
        self._process = Process(*command, "--profile", str(profile), "about:blank")
        self._number, self._lines, self._requested = 0, [], {}
        self._process.wait_for(self._address, "Firefox listens")
        self._socket = websocket.create_connection(
            f"{self._address()}/session", timeout=DEADLINE, suppress_origin=True
        )
        self._ask("session.new", capabilities={})
        self._ask("session.subscribe", events=["log.entryAdded", "network"])
        self._page = self._ask("browsingContext.getTree")["contexts"][0]["context"]

    def _address(self):
        """Return the address that Firefox has printed, or None."""
        found = re.search(r"WebDriver BiDi listening on (ws://\S+)", "\n".join(self._process.lines))
        return found and found[1]

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        with self._process:
            self._ask("browser.close")
            self._process.wait()

    def _ask(self, method, **parameters):
        self._number += 1
        command = {"id": self._number, "method": method, "params": parameters}
        self._socket.send(json.dumps(command))
        while True:
            answer = json.loads(self._socket.recv())
            if answer["type"] == "event":
                self._keep(answer["method"], answer["params"])
            elif answer["id"] == self._number:
                if answer["type"] == "error":
                    raise RuntimeError(f"{method}: {answer['message']}")
                return answer["result"]

    def _keep(self, method, event):
        if method == "log.entryAdded":
            self._lines.append(f"{event['level']}: {event['text']}")
        elif method.startswith("network."):
            address, request = event["request"]["url"], event["request"]["request"]
            self._requested.setdefault(request, (address, None))
            if method == "network.fetchError":
                self._requested[request] = address, event["errorText"]
            elif method == "network.responseCompleted" and event["response"]["status"] >= 400:
                self._requested[request] = address, event["response"]["status"]

    def open(self, url, size="desktop"):
        """Open a page, and forget what happened on those before."""
        self._ask(
            "browsingContext.navigate", context=self._page, url="about:blank", wait="complete"
        )
        width, height = SIZES[size]
        viewport = {"width": width, "height": height}
        self._ask("browsingContext.setViewport", context=self._page, viewport=viewport)
        self.console()
        self.requests()
        self._ask("browsingContext.navigate", context=self._page, url=url, wait="complete")

    def run(self, script, *arguments):
        """Run a script on the page; return what it returns."""
        answer = self._ask(
            "script.callFunction",
            functionDeclaration="(json) => JSON.stringify((function () {" + script + "})"
            ".apply(null, JSON.parse(json)) ?? null)",
            arguments=[{"type": "string", "value": json.dumps(arguments)}],
            target={"context": self._page},
            awaitPromise=False,
        )
        if answer["type"] == "exception":
            raise RuntimeError(answer["exceptionDetails"]["text"])
        return json.loads(answer["result"]["value"])

    def find(self, selector):
        """Return the HTML of each element that a selector finds."""
        script = "return [...document.querySelectorAll(arguments[0])].map((item) => item.outerHTML)"
        return self.run(script, selector)

    def wait_until(self, condition, what):
        """Wait until the condition holds; return what it returned."""
        return wait_until(condition, what)

    def console(self):
        """Return what was written to the console since the last call: of every level."""
        self._ask("session.status")  # what has happened before has been told then
        lines, self._lines = self._lines, []
        return lines

    def requests(self):
        """Return (addresses, failures) of all requests since the last call."""
        self._ask("session.status")
        requested, self._requested = list(self._requested.values()), {}
        failures = [f"{address}: {why}" for address, why in requested if why]
        return [address for address, _ in requested], failures
