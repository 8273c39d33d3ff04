#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# The laptop: makes a key, learns the robot's, and launches both halves. Between real hosts do this
# once, by hand, with ssh-copy-id, and compare the fingerprint that ssh shows.
set -e
export HOME=/keys # where ssh and roslaunch look for .ssh
mkdir -p ~/.ssh
[ -e ~/.ssh/id_ecdsa ] || ssh-keygen -q -t ecdsa -m PEM -N "" -f ~/.ssh/id_ecdsa
ssh-keyscan -t ecdsa robot > ~/.ssh/known_hosts
exec roslaunch /several_hosts/remote.launch
