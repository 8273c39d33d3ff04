# SPDX-License-Identifier: BSD-3-Clause
"""Decide who may ask for the page, and which headers each answer gets."""

import ipaddress
import re

PAGE_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)

# Sphinx writes scripts and styles into its pages. No text in them comes from a node.
TUTORIAL_POLICY = (
    "default-src 'self' 'unsafe-inline'; img-src 'self' data:; font-src 'self' data:; "
    "base-uri 'none'; frame-ancestors 'none'"
)

HEADERS = {
    "Content-Security-Policy": PAGE_POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cache-Control": "no-cache",
}


def host_name(host):
    """Return the name in a Host header, without its port."""
    match = re.fullmatch(r"\[([0-9A-Fa-f:.]+)\](?::\d+)?|([^:\[\]]*)(?::\d+)?", host)
    return (match[1] or match[2] or "").lower() if match else ""


def is_loopback(name):
    """Say if a name or an address means this machine alone."""
    try:
        return name == "localhost" or ipaddress.ip_address(name).is_loopback
    except ValueError:
        return False


def allowed_host(host, listens_on, names=()):
    """Say if a request with that Host header may be answered.

    A page of another site can make its own name lead to this machine (DNS rebinding), and then ask
    as if it were this one; but what it asks for still bears its name. So only these are answered:
    this machine's loopback; where the server listens on more than that, also any plain address, as
    nobody can make that lead elsewhere; and the names that the user has allowed.
    """
    name = host_name(host)
    if is_loopback(name) or (name and name in {known.lower() for known in names}):
        return True
    if is_loopback(listens_on):
        return False
    try:
        ipaddress.ip_address(name)
        return True
    except ValueError:
        return False


def allowed_origin(origin, host, names=()):
    """Say if a WebSocket may be opened: by a page that this server has served at that Host.

    What forwards a port, such as Codespaces, rewrites one of the two headers: so with a name that
    the user has allowed, each of them may be that name or this machine's loopback. But no other
    page of this machine may open it: beside a Host that is loopback, the port must be the same.
    """
    match = re.fullmatch(r"(https?)://([^/?#@]+)", (origin or "").lower())
    if not match:
        return False
    scheme, at = match.groups()
    if at == host.lower():
        return True
    names = {name.lower() for name in names}
    if not names:
        return False
    by, to = host_name(at), host_name(host)
    if by in names:
        return to in names or is_loopback(to)
    if is_loopback(by) and is_loopback(to):
        return _port(at, scheme) == _port(host, scheme)
    return is_loopback(by) and to in names


def _port(at, scheme):
    match = re.search(r":(\d+)$", at)
    return match[1] if match else {"http": "80", "https": "443"}[scheme]
