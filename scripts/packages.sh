#!/bin/sh
# Provide the Debian packages listed in a file where they are missing: installed by root, unpacked into .cache/debian by
# anybody else (scripts/with_packages.sh runs what uses them). Where neither can be, one line says what is missing, also in
# .cache/missing for the tests, which leave out what needs it.
#
# For tests: AS_USER=1 does what is done without root, STATUS is another list of what is installed.
set -eu
status=${STATUS:-/var/lib/dpkg/status}
here=$(cd "$(dirname "$0")/.." && pwd)
unpacked=${UNPACKED:-$here/.cache/debian}
rm -f "$unpacked.missing"

absent() {  # the packages of the list that are neither installed nor unpacked
    for package in $wanted; do
        awk -v package="$package" 'BEGIN { RS = ""; found = 1 }
            $0 ~ "(^|\n)Package: " package "\n" && /\nStatus: [a-z]+ ok installed\n/ { found = 0 } END { exit found }' \
            "$status" 2>/dev/null || [ -e "$unpacked/$package" ] || printf ' %s' "$package"
    done
}

wanted=$(cat "$1")
missing=$(absent)
[ -z "$missing" ] && exit 0

lacking() {
    mkdir -p "$(dirname "$unpacked")"
    echo "not on this machine, so tests that need it are left out:$missing ($1)" | tee "$unpacked.missing" >&2
    exit 0
}

command -v apt-get >/dev/null && command -v dpkg >/dev/null || lacking "there is no apt-get: install it with your system's packages"
if [ "$(id -u)" = 0 ] && [ -z "${AS_USER:-}" ]; then
    echo "installing$missing …"
    apt-get update -qq
    # RUNLEVEL=1 keeps the broker's own service from starting: the tests start a private one on loopback.
    RUNLEVEL=1 DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $missing >/dev/null
    exit 0
fi

echo "unpacking$missing into .cache/debian, without root …"
mkdir -p "$unpacked/lists/partial" "$unpacked/archives/partial" "$unpacked/root"
apt="apt-get -qq -o Dir::State::lists=$unpacked/lists -o Dir::State::status=$status -o Dir::Cache=$unpacked
    -o Debug::NoLocking=1 -o APT::Sandbox::User="
log=$unpacked/log
{
    $apt update &&
    names=$($apt -s --no-install-recommends install $missing | awk '$1 == "Inst" { print $2 }') &&
    (cd "$unpacked/archives" && rm -f ./*.deb && $apt download $names && for archive in *.deb; do
        dpkg -x "$archive" "$unpacked/root"
    done)
} >"$log" 2>&1 || lacking "apt-get could not fetch it: $(tail -n 1 "$log")"
rm -f "$unpacked/archives/"*.deb
# Erlang's scripts have the folder of an installed one in them.
erlang=$unpacked/root/usr/lib/erlang
if [ -d "$erlang" ]; then
    sed -i "s|=/usr/lib/erlang$|=$erlang|" $(grep -lIr '=/usr/lib/erlang$' "$erlang/bin" "$erlang"/erts-*/bin)
fi
for package in $missing; do touch "$unpacked/$package"; done
