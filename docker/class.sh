#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# The entry point of the image mrp-class. The first container makes a certificate, which it shares with
# the others on the volume /etc/dask: a student's program that reaches the scheduler cannot give it work.
set -e
umask 077
cd /etc/dask
if [ ! -e tls.yaml ]; then
  openssl req -x509 -newkey rsa:2048 -nodes -days 365 -subj /CN=class -keyout key.pem -out cert.pem \
    2> /dev/null
  cp cert.pem ca.pem
  cp /usr/local/share/mrp/tls.yaml tls.yaml
fi
cd /mrp/catkin_ws
exec "$@"
