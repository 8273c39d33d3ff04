# SPDX-License-Identifier: BSD-3-Clause
"""Who gets an answer from the viewer, and what its page may do; and whom it asks itself."""

import http.client

import pytest
from mrp_view import access, rpc

pytestmark = pytest.mark.quick


@pytest.mark.parametrize(
    ("host", "listens_on", "allowed"),
    [
        ("localhost:8765", "127.0.0.1", True),
        ("127.0.0.1:8765", "127.0.0.1", True),
        ("[::1]:8765", "127.0.0.1", True),
        ("LOCALHOST", "127.0.0.1", True),
        ("evil.example:8765", "127.0.0.1", False),
        ("localhost.evil.example", "127.0.0.1", False),
        ("127.0.0.1.evil.example:8765", "127.0.0.1", False),
        ("192.168.0.7:8765", "127.0.0.1", False),
        ("", "127.0.0.1", False),
        ("localhost:8765@evil.example", "127.0.0.1", False),
        ("192.168.0.7:8765", "0.0.0.0", True),
        ("[fe80::1]:8765", "0.0.0.0", True),
        ("evil.example:8765", "0.0.0.0", False),
        ("robot.local:8765", "0.0.0.0", True),
    ],
)
def test_host(host, listens_on, allowed):
    assert access.allowed_host(host, listens_on, ["Robot.local"]) == allowed


@pytest.mark.parametrize(
    ("origin", "allowed"),
    [
        ("http://localhost:8765", True),
        ("http://localhost:8766", False),
        ("http://evil.example", False),
        ("null", False),
        (None, False),
        ("http://localhost:8765.evil.example", False),
    ],
)
def test_origin(origin, allowed):
    assert access.allowed_origin(origin, "localhost:8765") == allowed
    assert not access.allowed_origin("http://localhost:8765", "127.0.0.1:8765")


NAME = "lab-8765.app.github.dev"
HERE = ("localhost:8765", "127.0.0.1:8765", "[::1]:8765")


@pytest.mark.parametrize("host", [NAME, NAME.upper(), f"{NAME}:443", *HERE])
def test_origin_where_a_port_is_forwarded(host):
    """One of the two headers may be rewritten on the way, and nothing else is let in."""
    for origin in (f"https://{NAME}", f"http://{NAME}:8765", *("http://" + host for host in HERE)):
        assert access.allowed_origin(origin, host, [NAME]), origin
    other_port = (
        "http://localhost:1234"  # another page of this machine, or the forwarder's own port
    )
    assert access.allowed_origin(other_port, host, [NAME]) == (host not in HERE)
    for origin in ("https://evil.example", f"https://{NAME}.evil.example", "http://8.8.8.8:8765"):
        assert not access.allowed_origin(origin, host, [NAME]), origin
        assert not access.allowed_origin(f"https://{NAME}", origin.partition("//")[2], [NAME])


def test_nobody_there_is_an_error_and_no_hang():
    with pytest.raises(OSError):
        rpc.Proxy("http://127.0.0.1:1/", 5).call("getPid")
    with pytest.raises(OSError):
        rpc.Proxy("no address", 5).call("getPid")
    assert issubclass(http.client.HTTPException, rpc.ERRORS)
