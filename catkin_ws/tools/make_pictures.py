#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Make the pictures of README.md and of the pages, from the real thing: the live graph of the four
nodes in Chromium, and `make learn` in a terminal. Each is made for light and for dark mode.

Usage: make_pictures.py [FOLDER]    (src/mrp/doc/static, if it is left out)
"""

import base64
import html
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from mrp_testing import contract
from mrp_testing.master import master, uri_of
from mrp_testing.ports import free_port
from mrp_testing.viewer import PubSub, Viewer
from mrp_testing.waiting import wait_until
from mrp_testing.workspace import WORKSPACE

sys.path.append(str(WORKSPACE / "tests" / "browser"))
from browser import Browser

WIDTH = 1000
COLUMNS, ROWS = 92, 21
THEMES = {  # background, text, and the colours 0 to 7 of a terminal
    "light": (
        "#ffffff",
        "#24292f",
        "#24292f #b3261e #1a7f37 #8a5a00 #0969da #8250df #0b7285 #57606a",
    ),
    "dark": (
        "#0d1117",
        "#e6edf3",
        "#6e7681 #ff7b72 #56d364 #e3b341 #79c0ff #d2a8ff #76e3ea #e6edf3",
    ),
}
HOME = "/home/you"  # stands for the scratch folder on the picture
_SGR = re.compile(r"\x1b\[([\d;]*)m")


def save(browser, path, selector):
    """Write a picture of what a selector finds on the page."""
    box = browser.run(
        "const box = document.querySelector(arguments[0]).getBoundingClientRect();"
        "return {x: box.x, y: box.y, width: box.width, height: box.height}",
        selector,
    )
    clip = {**box, "scale": 1}
    shot = browser.command("Page.captureScreenshot", format="webp", quality=88, clip=clip)
    path.write_bytes(base64.b64decode(shot["data"]))
    print(f"{path}: {path.stat().st_size // 1000} kB")


def graph(browser, folder):
    """Photograph the viewer's graph while the four nodes run."""
    port = free_port()
    os.environ["ROS_MASTER_URI"] = uri_of(port)
    with master(port), PubSub(), Viewer("--settle", "0") as viewer:
        browser.open(viewer.address)
        nodes = "return document.querySelectorAll('#graph .node').length"
        pulse = "return document.querySelectorAll('#graph circle').length"
        wait_until(
            lambda: browser.run(nodes) == len(contract.NODES), "all nodes are on the picture"
        )
        unknown = "return document.querySelectorAll('#graph .node .second').length"
        wait_until(lambda: not browser.run(unknown), "each node has answered")
        for mode in THEMES:
            browser.prefer(mode)
            wait_until(lambda: browser.run(pulse), "messages move on the picture")
            save(browser, folder / f"graph-{mode}.webp", "#graph svg")


def learn(browser, folder):
    """Photograph the first exercise, as `make learn` shows it at a terminal."""
    with tempfile.TemporaryDirectory() as scratch:
        text = at_terminal(
            f"PYTHONPATH={WORKSPACE}/src/mrp_check/src "
            "/usr/bin/python3 -m mrp_check.cli.learn exercises",
            pathlib.Path(scratch),
            until="SyntaxError",
        ).replace(scratch, HOME)
    for mode in THEMES:
        browser.driver.get("data:text/html;base64," + base64.b64encode(page(text, mode)).decode())
        save(browser, folder / f"learn-{mode}.webp", "pre")


def at_terminal(command, folder, until):
    """Run a command in tmux until its screen has a text; return the screen with its colours."""
    tmux = ["tmux", "-L", f"mrp-pictures-{os.getpid()}", "-f", "/dev/null"]
    size = ["-x", str(COLUMNS), "-y", str(ROWS)]
    subprocess.run([*tmux, "new-session", "-d", *size, "-c", str(folder), command], check=True)
    try:

        def screen(*options):
            shown = [*tmux, "capture-pane", "-p", *options]
            return subprocess.run(shown, check=True, stdout=subprocess.PIPE, text=True).stdout

        wait_until(lambda: until in screen(), f"{until!r} on the screen of {command}")
        return screen("-e", "-N")
    finally:
        subprocess.run([*tmux, "kill-server"], check=False)


def page(text, mode):
    """Return a page that looks like the terminal's screen."""
    background, foreground, colours = THEMES[mode]
    parts, style = [], {}
    for index, part in enumerate(_SGR.split(text.rstrip("\n"))):
        if index % 2:
            for code in map(int, (part or "0").split(";")):
                style = {} if code == 0 else style
                if code == 1:
                    style["font-weight"] = "bold"
                elif code == 4:
                    style["text-decoration"] = "underline"
                elif code == 7:
                    style.update({"background": foreground, "color": background})
                elif code % 10 < 8 and code // 10 in (3, 9):
                    style["color"] = colours.split()[code % 10]
        else:
            css = ";".join(f"{key}:{value}" for key, value in style.items())
            parts.append(f'<span style="{css}">{html.escape(part)}</span>')
    return (
        f'<!doctype html><meta charset="utf-8"><title>make learn</title><body style="margin:0;'
        f'background:{background};color:{foreground}"><pre style="margin:0;display:inline-block;'
        f'padding:16px;font:14px/1.35 monospace">{"".join(parts)}</pre>'
    ).encode()


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else WORKSPACE / "src/mrp/doc/static")
    with tempfile.TemporaryDirectory() as profile, Browser(profile) as browser:
        browser.command(
            "Emulation.setDeviceMetricsOverride",
            width=WIDTH,
            height=900,
            deviceScaleFactor=1,
            mobile=False,
        )
        learn(browser, folder)
        graph(browser, folder)


if __name__ == "__main__":
    main()
