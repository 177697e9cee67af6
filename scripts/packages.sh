#!/bin/sh
# Install the Debian packages listed in a file where they are missing; without root, say what to type.
set -eu
missing=""
for package in $(cat "$1"); do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
done
[ -z "$missing" ] && exit 0
install="apt-get install -y --no-install-recommends$missing"
if [ "$(id -u)" != 0 ]; then
    echo "The tests need Debian packages that are not installed. Type:" >&2
    echo "    sudo $install" >&2
    exit 2
fi
echo "installing$missing …"
apt-get update -qq
# RUNLEVEL=1 keeps the broker's own service from starting: the tests start a private one on loopback.
RUNLEVEL=1 DEBIAN_FRONTEND=noninteractive $install >/dev/null
