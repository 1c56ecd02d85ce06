#!/bin/sh
# What Binder and the hub's image install: the lessons, and what a live replay needs behind a proxy. sh tools/hub.sh PYTHON
set -eu
cd "$(dirname "$0")/.."
python=${1:?"say which Python: sh tools/hub.sh PYTHON"}

sh tools/install.sh "$python" student.lock
"$python" -m pip --disable-pip-version-check install "jupyter-server-proxy>=4.5,<5"
