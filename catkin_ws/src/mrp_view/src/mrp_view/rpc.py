# SPDX-License-Identifier: BSD-3-Clause
"""Calls to the XML-RPC servers of the master and of the nodes, none of which may hang."""

import http.client
import xml.parsers.expat
import xmlrpc.client

# What a call may raise: nobody answers, or what answers is no node.
ERRORS = (OSError, http.client.HTTPException, xmlrpc.client.Error, xml.parsers.expat.ExpatError)


class _Transport(xmlrpc.client.Transport):
    def __init__(self, timeout):
        super().__init__()
        self._timeout = timeout

    def make_connection(self, host):
        connection = super().make_connection(host)
        connection.timeout = self._timeout
        return connection


class Proxy:
    """The XML-RPC server at a URI. For one thread at a time.

    timeout: seconds that it may take for anything
    """

    def __init__(self, uri, timeout):
        self.uri = uri
        try:
            self._server = xmlrpc.client.ServerProxy(uri, _Transport(timeout))
        except OSError:  # no address that XML-RPC can have
            self._server = None

    def call(self, method, *arguments):
        """Return what the method of the ROS API returns, without its code and its message.

        Raises one of ERRORS.
        """
        if self._server is None:
            raise OSError(f"{self.uri} isn't an address")
        answer = getattr(self._server, method)("/mrp_view", *arguments)
        if not isinstance(answer, list) or len(answer) not in (2, 3):
            raise xmlrpc.client.Error(f"{method} returned {answer!r}")
        # roscpp's getBusStats alone has no code and no message in front.
        if isinstance(answer[0], list):
            return answer
        if answer[0] != 1 or len(answer) != 3:
            raise xmlrpc.client.Error(f"{method}: {answer[1]}")
        return answer[2]
