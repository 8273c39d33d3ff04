#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# The entry point of the image mrp-class. The first container makes a certificate, and shares it with the
# others on the volume /etc/dask: a student's program that reaches the scheduler cannot give it work.
set -e
(
  flock 9
  cd /etc/dask
  if [ ! -e tls.yaml ]; then
    openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 3650 -subj /CN=class \
      -keyout key.pem -out cert.pem
    # Root and its group alone can read it. A student's program is neither.
    chmod 640 key.pem
    cp cert.pem ca.pem
    cp /usr/local/share/mrp/tls.yaml .
  fi
) 9> /etc/dask/lock
# What it writes in a mounted folder is to belong to the one whose folder that is.
owner=$(stat --format=%u .)
if [ "$owner" != 0 ]; then
  export HOME=/tmp
  exec setpriv --reuid="$owner" --regid="$(stat --format=%g .)" --groups=0 --inh-caps=-all "$@"
fi
exec "$@"
