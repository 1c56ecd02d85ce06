#!/bin/sh
# Install the course into the environment of a Python, and compile the road: sh tools/install.sh PYTHON [LOCK]
# `make lab`, Binder and the hub's image all call this. LOCK is environment.lock, or student.lock without the tests.
#
# On Linux torch comes first and alone: from what pip is set up to use, if that has the CPU build,
# else from torch's own index. The lock asks for +cpu there, so the CUDA build can never be taken.
set -eu
cd "$(dirname "$0")/.."
python=${1:?"say which Python: sh tools/install.sh PYTHON [LOCK]"}
lock=${2:-environment.lock}

# The lock is complete, so pip has nothing to resolve (--no-deps) and takes only what the hashes allow.
install() { "$python" -m pip --disable-pip-version-check install --quiet --no-deps "$@"; }
stop() { echo "$1"; exit 1; }

echo "Now the packages of $lock are installed; this takes a few minutes."
if [ "$(uname -s)" = Linux ]; then
    torch=$(mktemp)
    trap 'rm -f "$torch"' EXIT
    sed -n '/^torch==.*linux/,/[^\\]$/p' "$lock" > "$torch"
    install --require-hashes -r "$torch" > /dev/null 2>&1 \
        || install --require-hashes --index-url "${TORCH_INDEX:-https://download.pytorch.org/whl/cpu}" -r "$torch" \
        || stop "torch cannot be fetched: check the network, or name a mirror, as in TORCH_INDEX=... make lab"
fi
install --require-hashes -r "$lock" \
    || stop "Some packages cannot be fetched: check the network and the free disk space, then run this again"
install --no-build-isolation --editable .

# JupyterLab reads this file of its environment: no question about news at the first start, and panels are saved
# with their notebook, so that they are still there when it is opened on another day.
settings=$("$python" -c "import sys; print(sys.prefix)")/share/jupyter/lab/settings
mkdir -p "$settings"
[ -e "$settings/overrides.json" ] || cat > "$settings/overrides.json" << 'JSON'
{"@jupyterlab/apputils-extension:notification": {"fetchNews": "false", "checkForUpdates": false},
 "@jupyter-widgets/jupyterlab-manager:plugin": {"saveState": true}}
JSON

echo "Now the road and the learner are compiled, once."
"$python" -c "from bootcourse.doctor import road; print(next(road()).what)"
"$python" -c "from bootcourse.web.bundle import content; content()"
"$python" -c "import bootcourse as bc; t = bc.Training([bc.settings_for('sac')], learner='compiled'); t.run(False, updates=1)"
