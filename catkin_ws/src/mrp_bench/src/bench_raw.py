#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""The limit in Python: what bench_raw.cpp does."""

import signal
import socket
import struct
import time

from mrp_bench.program import Answers, Samples, obey, options

LENGTH = struct.Struct("<I")
LENGTH_AND_STAMP = struct.Struct("<Iq")


class RawSender:
    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port))
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def resize(self, size):
        self.frame = bytearray(LENGTH.size + size)
        self.size = size

    def send(self, stamp):
        LENGTH_AND_STAMP.pack_into(self.frame, 0, self.size, stamp)
        self.socket.sendall(self.frame)


def receive(answers):
    listener = socket.socket()
    listener.bind(("127.0.0.1", 0))
    listener.listen(1)
    answers.write("port", [listener.getsockname()[1]])
    connection, _ = listener.accept()

    samples = Samples(answers)
    buffer = bytearray(1 << 16)
    filled = 0
    while True:
        received = connection.recv_into(memoryview(buffer)[filled:])
        if not received:
            return
        arrival = time.monotonic_ns()
        filled += received
        begin = 0
        while filled - begin >= LENGTH.size:
            (length,) = LENGTH.unpack_from(buffer, begin)
            end = begin + LENGTH.size + length
            if end > filled:
                if length + LENGTH.size > len(buffer):
                    buffer.extend(bytes(length + LENGTH.size - len(buffer)))
                break
            _, stamp = LENGTH_AND_STAMP.unpack_from(buffer, begin)
            samples.add(stamp, arrival)
            begin = end
        buffer[: filled - begin] = buffer[begin:filled]
        filled -= begin


def main():
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    answers = Answers()
    if options().get("receive"):
        receive(answers)
        return
    sender = RawSender(options()["send"])
    answers.write("ready")
    obey(sender, answers)


if __name__ == "__main__":
    main()
