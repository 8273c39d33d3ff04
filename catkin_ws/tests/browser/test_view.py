# SPDX-License-Identifier: BSD-3-Clause
"""mrp_view's page in a browser, with real nodes and a master of its own."""

import base64
import itertools
import os
import signal

import checks
import pytest
import rosgraph
import rospy
from browser import SIZES
from built_site import SITE
from mrp_testing.lab import Lab
from mrp_testing.master import master, uri_of
from mrp_testing.nodes import pid_of
from mrp_testing.ports import free_port
from mrp_testing.viewer import PubSub, Viewer
from mrp_testing.workspace import WORKSPACE
from selenium.webdriver.common.keys import Keys
from std_msgs.msg import String, UInt32

# One worker of pytest: its nodes, its master and its page serve all of these tests.
pytestmark = pytest.mark.xdist_group("view")

SCREENSHOTS = WORKSPACE / "build" / "screenshots"
MARKUP = '<img src="x" onerror="document.title=1"><script>document.title=2</script>'


@pytest.fixture(scope="module")
def core():
    """A master for these tests; they are a node of it."""
    port = free_port()
    os.environ["ROS_MASTER_URI"] = uri_of(port)
    with master(port):
        rospy.init_node("test_page", disable_signals=True)
        yield port
        rospy.signal_shutdown("the tests are done")


@pytest.fixture(scope="module")
def viewer(core):
    with Viewer("--settle", "0", "--tutorial", str(SITE)) as started:
        yield started


@pytest.fixture
def page(browser, viewer):
    """The open page, connected; in the end it must have written nothing to the console."""
    browser.prefer("light")
    yield from opened(browser, viewer)


@pytest.fixture(params=["browser", "firefox"])
def each_page(request, viewer):
    """The same, in Chromium and in Firefox."""
    yield from opened(request.getfixturevalue(request.param), viewer)


def opened(browser, viewer):
    browser.open(viewer.address)
    wait_for_text(browser, "#status", "Master http")
    yield browser
    checks.assert_none(checks.console(browser))
    checks.assert_none(checks.requests(browser, viewer.address))


def text(browser, selector):
    return browser.run("return document.querySelector(arguments[0])?.textContent ?? ''", selector)


def wait_for_text(browser, selector, part):
    browser.wait_until(lambda: part in text(browser, selector), f"{part!r} in {selector}")


def row(browser, table, *names):
    """Return the cells' texts of the table's row that begins with these names, or []."""
    rows = browser.run(
        """
        return [...document.querySelector(arguments[0]).tBodies[0].rows]
          .map((row) => [...row.cells].map((cell) => cell.textContent));
        """,
        table,
    )
    return next((row for row in rows if row[: len(names)] == list(names)), [])


def items(browser):
    """Return the labels of all parts of the graph."""
    return browser.run(
        "return [...document.querySelectorAll('#graph .item')].map((item) => item.ariaLabel ?? "
        "item.getAttribute('aria-label'))"
    )


def sideways(browser, table):
    """Return how far a table must be scrolled to be seen in all its width, in pixels."""
    return browser.run(
        """
        const around = document.querySelector(arguments[0]).parentElement;
        return around.scrollWidth - around.clientWidth;
        """,
        table,
    )


def press_button(browser, name):
    browser.run("document.getElementById(arguments[0]).click()", name)


def test_page_is_open_before_during_and_after_the_launch(each_page):
    with PubSub() as launched:
        each_page.wait_until(
            lambda: sum("alive" in item for item in items(each_page)) == 5,
            "four nodes and the test",
        )
        for language in ("cpp", "py"):
            each_page.wait_until(
                lambda: row(each_page, "#senders", f"/mrp/publisher_{language}_node"),
                "its messages",
            )
        each_page.run("location.reload()")
        each_page.wait_until(
            lambda: len(items(each_page)) >= 6, "the graph after opening the page anew"
        )
        assert launched.stop() == 0
    each_page.wait_until(lambda: len(items(each_page)) < 5, "the graph without them")


def test_counts_are_those_that_were_sent(each_page):
    topic = f"/counted_by_{each_page.name}"
    publisher = rospy.Publisher(topic, UInt32, queue_size=1000)
    each_page.wait_until(lambda: publisher.get_num_connections() == 1, "the viewer")
    for value in range(1, 501):
        publisher.publish(value)
    each_page.wait_until(
        lambda: row(each_page, "#senders", "/test_page", topic)[2:3] == ["500"], "500 messages"
    )
    shown = row(each_page, "#senders", "/test_page", topic)
    assert (shown[4], shown[7]) == ("0", "500")
    publisher.unregister()


def test_fast_sender_is_said_to_be_sampled(each_page):
    publisher = rospy.Publisher("fast", UInt32, queue_size=10000)
    each_page.wait_until(lambda: publisher.get_num_connections() == 1, "the viewer")
    number = itertools.count(1)

    def sampled():
        for _ in range(200):
            publisher.publish(next(number))
        return row(each_page, "#senders", "/test_page", "/fast")[6:7]

    each_page.wait_until(lambda: "1 of" in "".join(sampled()), "that only some are shown")
    publisher.unregister()


def test_markup_is_text(each_page):
    publisher = rospy.Publisher("markup", String, queue_size=10, latch=True)
    publisher.publish(MARKUP)
    each_page.wait_until(
        lambda: row(each_page, "#senders", "/test_page", "/markup")[7:] == [MARKUP],
        "the text itself",
    )
    rospy.logwarn(MARKUP)
    wait_for_text(each_page, "#log", MARKUP)
    assert each_page.run("return document.title") == "mrp_view"
    assert each_page.find("main img, main script") == []
    publisher.unregister()


def test_names_that_are_markup_are_text(each_page):
    """The master takes any name of whoever asks it directly."""
    name, topic = "/<b>node</b>", "/<i>topic</i>"
    api = rosgraph.Master(name)
    api.registerPublisher(topic, "<u>type</u>", "http://localhost:1/")
    each_page.wait_until(lambda: any(name in item for item in items(each_page)), "the node")
    each_page.wait_until(
        lambda: any("<u>type</u>" in item for item in items(each_page)), "the type"
    )
    wait_for_text(each_page, "#findings", f"{name} died")
    assert each_page.find("main :is(b, i, u)") == []
    api.unregisterPublisher(topic, "http://localhost:1/")


def test_log_is_filtered(each_page):
    rospy.loginfo("a line to be filtered")
    rospy.logerr("a line that stays")
    wait_for_text(each_page, "#log", "a line that stays")
    assert "a line to be filtered" in text(each_page, "#log")
    choose = (
        "const item = document.querySelector(arguments[0]); item.value = arguments[1];"
        "item.dispatchEvent(new Event('change'))"
    )
    each_page.run(choose, "#log-level", "ERROR")
    assert "a line to be filtered" not in text(each_page, "#log")
    assert "a line that stays" in text(each_page, "#log")
    each_page.run(choose, "#log-level", "DEBUG")
    each_page.run(choose, "#log-node", "/test_page")
    assert "a line to be filtered" in text(each_page, "#log")


def test_without_a_mouse(page):
    """Tab reaches all that can be pressed, and within the graph the arrow keys go on."""
    publisher = rospy.Publisher("keys", UInt32, queue_size=1)
    page.wait_until(lambda: len(items(page)) >= 2, "a graph")
    page.run("document.activeElement.blur()")
    wanted = {"pause", "show-log", "show-viewer", "plot-topic", "log-node", "log-level", "log"}
    reached = set()
    for _ in range(30):
        page.press(Keys.TAB)
        reached.add(page.run("return document.activeElement.id || document.activeElement.tagName"))
    assert wanted <= reached
    page.run("document.querySelector('#graph .item[tabindex=\"0\"]').focus()")
    first = text(page, "#detail")
    page.press(Keys.RIGHT)
    assert first and text(page, "#detail") not in ("", first)
    page.press(Keys.HOME)
    assert text(page, "#detail") == first
    publisher.unregister()


def test_pause_freezes_what_is_seen_and_nothing_else(page):
    publisher = rospy.Publisher("paused", UInt32, queue_size=1000)
    page.wait_until(lambda: publisher.get_num_connections() == 1, "the viewer")
    publisher.publish(1)
    page.wait_until(
        lambda: row(page, "#senders", "/test_page", "/paused")[2:3] == ["1"], "one message"
    )
    press_button(page, "pause")
    assert "Paused" in text(page, "#status")
    for value in range(2, 101):
        publisher.publish(value)
    # Another page sees them, and this one does not.
    other = page.driver.current_window_handle
    page.driver.switch_to.new_window("tab")
    page.driver.get(page.run("return arguments[0]", viewer_address(page, other)))
    page.wait_until(
        lambda: row(page, "#senders", "/test_page", "/paused")[2:3] == ["100"], "all, elsewhere"
    )
    page.driver.close()
    page.driver.switch_to.window(other)
    assert row(page, "#senders", "/test_page", "/paused")[2] == "1"
    press_button(page, "pause")
    page.wait_until(
        lambda: row(page, "#senders", "/test_page", "/paused")[2:3] == ["100"], "all, here"
    )
    publisher.unregister()


def viewer_address(browser, handle):
    here = browser.driver.current_window_handle
    browser.driver.switch_to.window(handle)
    address = browser.driver.current_url
    browser.driver.switch_to.window(here)
    return address


def test_topics_can_be_chosen(each_page):
    publisher = rospy.Publisher("chosen", UInt32, queue_size=1)
    each_page.wait_until(
        lambda: any("Topic /chosen" in item for item in items(each_page)), "the topic"
    )
    box = "document.querySelector('#topics input[value=\"/chosen\"]').click()"
    each_page.run(box)
    each_page.wait_until(
        lambda: not any("Topic /chosen" in item for item in items(each_page)), "it is hidden"
    )
    each_page.run(box)
    each_page.wait_until(
        lambda: any("Topic /chosen" in item for item in items(each_page)), "it is back"
    )
    press_button(each_page, "show-viewer")
    each_page.wait_until(
        lambda: any("Node /mrp_view" in item for item in items(each_page)), "the viewer"
    )
    press_button(each_page, "show-log")
    each_page.wait_until(
        lambda: any("Topic /rosout" in item for item in items(each_page)), "the log's topic"
    )
    publisher.unregister()


def test_viewer_is_restarted(browser, core):
    port = free_port()
    # Not the name of the other tests' viewer, which would end.
    options = ("--settle", "0", "__name:=restarted_view")
    with Viewer(*options, port=port) as first:
        browser.open(first.address)
        wait_for_text(browser, "#status", "Master http")
        assert first.stop() == 0
        wait_for_text(browser, "#status", "connection to the viewer is lost")
    with Viewer(*options, port=port):
        wait_for_text(browser, "#status", "Master http")
        publisher = rospy.Publisher("after", UInt32, queue_size=1)
        browser.wait_until(lambda: any("Topic /after" in item for item in items(browser)), "live")
        publisher.unregister()
    browser.open("about:blank")


def test_there_is_no_master_yet(browser):
    env = {"ROS_MASTER_URI": f"http://localhost:{free_port()}"}
    with Viewer("--settle", "0", extra_env=env) as alone:
        browser.open(alone.address)
        wait_for_text(browser, "#status", "No master at")
        wait_for_text(browser, "#findings", "No node is running")
    browser.open("about:blank")


def test_what_is_seen_leads_to_the_tutorial(page, viewer):
    publisher = rospy.Publisher("latched", UInt32, queue_size=1, latch=True)
    publisher.publish(1)
    link = "#findings .latched a"
    page.wait_until(lambda: page.find(link), "the finding's link")
    page.run("document.querySelector(arguments[0]).click()", link)
    page.wait_until(lambda: "Latch" in page.run("return document.title"), "the tutorial's page")
    publisher.unregister()


@pytest.fixture(scope="module")
def shown(viewer):
    """The page of something to look at: the tutorial's nodes of which one has died, and a lab."""
    with PubSub() as launched:
        # Two that start at once may both name the run, and then one of them ends.
        launched.wait_for(lambda: pid_of("/mrp/subscriber_cpp_node"), "a node")
        with Lab("type_mismatch.launch") as lab:
            for name in ("other_subscriber_cpp", "other_subscriber_py"):
                lab.wait_for(
                    lambda: any(
                        "do not match" in line and name in line for line in list(lab.lines)
                    ),
                    f"{name} is refused",
                )
            os.kill(pid_of("/mrp/subscriber_cpp_node"), signal.SIGKILL)
            yield viewer


@pytest.fixture(params=itertools.product(SIZES, ("light", "dark")), ids="-".join)
def look(request, browser, shown):
    size, mode = request.param
    browser.prefer(mode)
    browser.open(shown.address, size)
    browser.wait_until(
        lambda: any("Dead" in item or "dead" in item for item in items(browser)), "dead"
    )
    browser.wait_until(lambda: "✗" in text(browser, "#graph"), "a red edge")
    browser.wait_until(lambda: browser.find("#plot .line"), "a plot")
    return size, mode


def test_looks(browser, shown, look):
    size, mode = look
    height = browser.run("return document.scrollingElement.scrollHeight")
    shot = browser.command(
        "Page.captureScreenshot",
        format="png",
        captureBeyondViewport=True,
        clip={"x": 0, "y": 0, "width": SIZES[size][0], "height": height, "scale": 1},
    )
    path = SCREENSHOTS / f"{size}-{mode}" / "view.png"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(base64.b64decode(shot["data"]))
    # Before the checks that add a style to the page, which its policy forbids.
    checks.assert_none(checks.console(browser))
    # Paused: nothing may move while it is looked at.
    press_button(browser, "pause")
    checks.assert_none(checks.width(browser, size))
    checks.assert_none(checks.pictures(browser))
    checks.assert_none(checks.contrast(browser))
    assert sideways(browser, "#senders") == sideways(browser, "#links") == 0
    checks.assert_none(checks.requests(browser, shown.address))
