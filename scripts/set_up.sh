#!/bin/sh
# Set up .venv for `run`, `test` or `docs`: print what is installed, how much is downloaded, and about how long it takes;
# then nothing, unless it fails. What pip prints is in .cache/set_up.log.
set -eu
cd "$(dirname "$0")/.."
stage=$1
python=${PYTHON:-python3}
log=.cache/set_up.log
mkdir -p .cache

fail() {
    echo "$1" >&2
    exit 1
}

is_new_enough() { "$1" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; }

packages() {  # how many packages these files pin
    cat "$@" | grep -cE '^[A-Za-z0-9_.-]+(\[[^]]*\])?=='
}

announce() {  # what for, how many packages, what they download, what they take on the disk, how long that takes
    echo "setting up .venv for $1: $2 Python packages, $3 to download, $4 on the disk, about $5 (once) …"
}

make_environment() {
    if [ -x .venv/bin/python ] && .venv/bin/python -c "" 2>/dev/null; then return; fi
    if ! is_new_enough "$python"; then
        for python in python3.11 python3.12 python3.13 ""; do
            if [ -n "$python" ] && is_new_enough "$python"; then break; fi
        done
    fi
    if [ -z "$python" ]; then
        found=$("${PYTHON:-python3}" --version 2>/dev/null || echo "not there")
        fail "Lumen needs Python 3.11 or later, and ${PYTHON:-python3} is ${found}. Install one (Debian and Ubuntu: \
sudo apt install python3.11 python3.11-venv), or name yours: make PYTHON=/path/to/python3.11"
    fi
    version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
    if ! "$python" -c "import venv, ensurepip" 2>/dev/null; then
        fail "Python $version is here, but its module venv is not. Install it (Debian and Ubuntu: \
sudo apt install python$version-venv), then repeat the command."
    fi
    rm -rf .venv
    if ! "$python" -m venv .venv >"$log" 2>&1; then
        rm -rf .venv
        fail "Python $version could not make .venv: $(tail -n 1 "$log")"
    fi
}

install() {
    if PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_ROOT_USER_ACTION=ignore PIP_NO_COLOR=1 \
        .venv/bin/python -m pip install --no-input --progress-bar off "$@" >>"$log" 2>&1; then return; fi
    error=$(grep '^ *ERROR:' "$log" | tail -n 1 || true)
    if grep -qE 'Temporary failure in name resolution|Name or service not known|NewConnectionError|Failed to establish' "$log"; then
        fail "pip could not reach the package index: is there a network, or does it need a proxy (HTTPS_PROXY)? \
What it printed is in $log. Repeat the command when there is one."
    elif grep -qE 'timed out|Connection (aborted|reset)|IncompleteRead' "$log"; then
        fail "The network broke off while pip downloaded. Repeat the command: what is there already is kept ($log)."
    elif grep -q 'No space left on device' "$log"; then
        fail "The disk is full: .venv needs 2 GB beside what is downloaded, and so does the folder ${TMPDIR:-/tmp}."
    elif grep -q 'No matching distribution found' "$log"; then
        version=$(.venv/bin/python -c 'import sys; print("%d.%d" % sys.version_info[:2])')
        fail "A package cannot be had for Python $version on this machine. Lumen is tested with Python 3.11, 3.12 and 3.13 \
on Linux. pip printed: $error ($log)"
    fi
    tail -n 15 "$log" >&2
    fail "pip failed; all that it printed is in $log."
}

case $stage in
run)
    make_environment
    announce "the engine and the simulated robot" "$(packages locks/core.txt locks/run.txt)" 270\ MB 850\ MB 2\ minutes
    : >"$log"
    install --no-deps --require-hashes -r locks/run.txt
    install --no-deps --no-build-isolation -e .
    ;;
test)
    announce "the tests" "$(packages locks/test.txt)" 310\ MB 800\ MB 2\ minutes
    : >"$log"
    install --no-deps --require-hashes -r locks/test.txt
    ;;
docs)
    announce "the documentation" "$(packages locks/docs.txt)" 20\ MB 60\ MB "20 s"
    : >"$log"
    install --no-deps --require-hashes -r locks/docs.txt
    ;;
*) fail "usage: sh scripts/set_up.sh run|test|docs" ;;
esac
touch ".venv/$stage"
