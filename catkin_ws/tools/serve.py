#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Serves a folder to this machine's own browsers, and prints the address.

Usage: serve.py FOLDER
"""

import functools
import http.server
import sys


class Handler(http.server.SimpleHTTPRequestHandler):
    def log_message(self, format, *args):
        """Say nothing of each request."""


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    handler = functools.partial(Handler, directory=sys.argv[1])
    # Port 0: any that is free.
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        try:
            print(f"Open http://127.0.0.1:{server.server_port}/ (Ctrl-C ends it)", flush=True)
            server.serve_forever()
        except KeyboardInterrupt:
            pass


if __name__ == "__main__":
    main()
