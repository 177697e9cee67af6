#!/bin/sh
# Install the daemon of Reachy Mini (`reachy-mini` of PyPI) into .cache/reachy_mini, an environment of its own: it pins another
# MuJoCo than Lumen. If that is not possible, the last line of the output says why, and `.cache/reachy_mini.missing` keeps it.
set -eu
cd "$(dirname "$0")/../../.."
place=.cache/reachy_mini
version=1.13.0
log=$place.log
mkdir -p .cache
if [ -x $place/bin/reachy-mini-daemon ] && $place/bin/python -c "import reachy_mini.daemon.app.main" 2>/dev/null; then exit 0; fi

fail() {
    echo "$1" | tee $place.missing
    exit 1
}

rm -f $place.missing
sh scripts/packages.sh tests/features/reachy/packages.txt >"$log" 2>&1 || true
rm -rf $place
"${PYTHON:-python3}" -m venv $place >>"$log" 2>&1 || fail "the daemon of Reachy Mini needs the module venv of Python"
if ! $place/bin/python -m pip install --no-input --progress-bar off "reachy-mini[mujoco]==$version" >>"$log" 2>&1; then
    rm -rf $place
    fail "the daemon of Reachy Mini can't be installed: $(grep -iE 'error' "$log" | tail -n 1)"
fi
if ! $place/bin/python -c "import reachy_mini.daemon.app.main" >>"$log" 2>&1; then
    rm -rf $place
    fail "the daemon of Reachy Mini does not start here: $(tail -n 1 "$log")"
fi
