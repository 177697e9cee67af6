#!/bin/sh
# Provide the Debian packages listed in a file (packages.txt) where they are missing: installed by root, unpacked into
# .cache/debian by anybody else (scripts/with_packages.sh runs what uses them). First it prints what it installs, what for,
# and how much is downloaded. What it cannot provide it prints as well, and lists in .cache/debian.missing with the reason:
# tests that need it are skipped.
#
# A line of the file is a package, a program or library that serves in its place where that is there (or `-`), and words.
#
# For tests: AS_USER=1 does what is done without root, STATUS is another list of what is installed, PAUSE is the time
# between two attempts to get apt's lock [s].
set -eu
export LC_ALL=C  # the words of apt-get are compared
status=${STATUS:-/var/lib/dpkg/status}
here=$(cd "$(dirname "$0")/.." && pwd)
unpacked=${UNPACKED:-$here/.cache/debian}
log=$unpacked.log
mkdir -p "$(dirname "$unpacked")"
wanted=$(sed 's/#.*//' "$1")
if [ -f "$unpacked.missing" ]; then  # what another list lacks stays
    for package in $(printf '%s\n' "$wanted" | awk '{ print $1 }'); do sed -i "/^$package /d" "$unpacked.missing"; done
    [ -s "$unpacked.missing" ] || rm -f "$unpacked.missing"
fi

is_there() {  # a package, or what serves in its place
    if [ -e "$unpacked/$1" ] || awk -v package="$1" 'BEGIN { RS = ""; found = 1 }
        $0 ~ "(^|\n)Package: " package "\n" && /\nStatus: [a-z]+ ok installed\n/ { found = 0 } END { exit found }' \
        "$status" 2>/dev/null; then return 0; fi
    case "$2" in
    "" | -) return 1 ;;
    *.so.*) PATH="$PATH:/sbin:/usr/sbin" ldconfig -p 2>/dev/null | grep -q "^[[:space:]]*$2 " ;;
    *) command -v "$2" >/dev/null ;;
    esac
}

absent() {  # the packages of the list that are neither installed nor unpacked
    echo "$wanted" | while read -r package program purpose; do
        if [ -n "$package" ] && ! is_there "$package" "$program"; then printf '%s ' "$package"; fi
    done
}

list() {  # packages, each with what it is for
    for package in $1; do
        echo "$wanted" | while read -r name program purpose; do
            if [ "$name" = "$package" ]; then printf '  %-16s %s\n' "$package" "$purpose"; fi
        done
    done
}

lack() {  # these packages, for this reason
    echo "Tests of these are skipped, since this machine lacks them ($2):"
    list "$1"
    for package in $1; do echo "$package is not on this machine: $2" >>"$unpacked.missing"; done
}

complaint() {  # the line of the log that says what went wrong
    awk '/Failed to fetch|Could not/ && !network { network = $0 } /^E: / { error = $0 } { last = $0 }
        END { line = network ? network : error ? error : last; sub(/^[EW]: /, "", line); print substr(line, 1, 120) }' "$log"
}

logged() {  # run a command into the log; if another program has apt's lock, try again for 10 minutes
    attempts=120
    until "$@" >"$log" 2>&1; do
        if ! grep -q "Could not get lock" "$log" || [ $attempts = 1 ]; then return 1; fi
        [ $attempts -lt 120 ] || echo "waiting until apt's lock is free: $(complaint) …"
        attempts=$((attempts - 1))
        sleep "${PAUSE:-5}"
    done
}

missing=$(absent)
[ -n "$missing" ] || exit 0
if ! command -v apt-get >/dev/null || ! command -v dpkg >/dev/null; then
    lack "$missing" "there is no apt-get, so install it with your system's packages"
    exit 0
fi

apt="apt-get -qq"
as_root=true
if [ "$(id -u)" != 0 ] || [ -n "${AS_USER:-}" ]; then
    as_root=false
    mkdir -p "$unpacked/lists/partial" "$unpacked/archives/partial" "$unpacked/root"
    apt="$apt -o Dir::State::lists=$unpacked/lists -o Dir::State::status=$status -o Dir::Cache=$unpacked
        -o Debug::NoLocking=1 -o APT::Sandbox::User="
fi
echo "asking apt-get for$(for package in $missing; do printf ' %s' "$package"; done) …"
logged $apt update || true
finds() { $apt -s --no-install-recommends install "$@" >>"$log" 2>&1; }
possible=$missing impossible=
if ! finds $missing; then
    possible=
    for package in $missing; do
        if finds "$package"; then possible="$possible $package"; else impossible="$impossible $package"; fi
    done
    if [ -n "$impossible" ]; then lack "$impossible" "apt-get does not find it: $(complaint)"; fi
fi
[ -n "$possible" ] || exit 0

size=$($apt --print-uris --no-install-recommends install $possible 2>/dev/null | awk '{ sum += $3 } END { print int(sum / 1e6 + 1) }')
if $as_root; then
    echo "Installing Debian packages, $size MB to download (once):"
else
    echo "Unpacking Debian packages into .cache/debian, without root, $size MB to download (once):"
fi
list "$possible"

install() {
    # RUNLEVEL=1 keeps the broker's own service from starting: the tests start a private one on loopback.
    RUNLEVEL=1 DEBIAN_FRONTEND=noninteractive $apt install -y --no-install-recommends $possible
}

unpack() {
    names=$($apt -s --no-install-recommends install $possible | awk '$1 == "Inst" { print $2 }') &&
        (cd "$unpacked/archives" && rm -f ./*.deb && $apt download $names && for archive in *.deb; do
            dpkg -x "$archive" "$unpacked/root" || exit
        done)
}

if $as_root; then
    logged install || lack "$possible" "apt-get could not install it: $(complaint)"
    exit 0
fi
if ! logged unpack; then
    lack "$possible" "apt-get could not fetch it: $(complaint)"
    exit 0
fi
rm -f "$unpacked/archives/"*.deb
# Erlang's scripts have the folder of an installed one in them.
erlang=$unpacked/root/usr/lib/erlang
if [ -d "$erlang" ]; then
    sed -i "s|=/usr/lib/erlang$|=$erlang|" $(grep -lIr '=/usr/lib/erlang$' "$erlang/bin" "$erlang"/erts-*/bin)
fi
for package in $possible; do touch "$unpacked/$package"; done
