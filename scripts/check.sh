#!/bin/sh
# Check style, types, floors, the repository's order and goldens: a line if all is well, otherwise everything that the failing checks printed.
set -u
cd "$(dirname "$0")/.."
bin=.venv/bin
failed=

check() {  # what it is about, and the command
    name=$1
    shift
    if printed=$("$@" 2>&1); then return; fi
    failed="$failed $name"
    echo "--- $name: $*"
    printf '%s\n' "$printed"
}

check style $bin/ruff check .
check format $bin/ruff format --check .
check types $bin/mypy
check floors $bin/lint-imports --no-logo
check order $bin/python scripts/check.py
check prose $bin/python scripts/prose.py --list
check goldens $bin/python scripts/golden_guard.py
if [ -n "$failed" ]; then
    echo "not well:$failed"
    exit 1
fi
echo "style, types, floors, order and prose: well"
