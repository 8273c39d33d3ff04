#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# The robot's ssh server, run by the user who is to log in, with keys of this run alone.
set -e
ssh-keygen -q -t ecdsa -N "" -f /tmp/host_key
exec /usr/sbin/sshd -D -e -p 22 -h /tmp/host_key -o PidFile=none -o PasswordAuthentication=no \
  -o AuthorizedKeysFile=/keys/.ssh/id_ecdsa.pub -o StrictModes=no
