#!/bin/sh
# Run a command with the programs and libraries that scripts/packages.sh has unpacked without root, where it has.
root=${UNPACKED:-$(cd "$(dirname "$0")/.." && pwd)/.cache/debian}/root
if [ -d "$root" ]; then
    for libraries in "$root"/lib/*-linux-* "$root"/usr/lib/*-linux-*; do
        if [ -d "$libraries" ]; then
            export LD_LIBRARY_PATH="$libraries${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}" LIBGL_DRIVERS_PATH="$libraries/dri"
        fi
    done
    if [ -d "$root/usr/share/glvnd/egl_vendor.d" ]; then
        export __EGL_VENDOR_LIBRARY_DIRS="$root/usr/share/glvnd/egl_vendor.d"
    fi
    export NODE_PATH="$root/usr/share/nodejs${NODE_PATH:+:$NODE_PATH}"
    export PATH="$root/usr/bin:$root/usr/sbin:$root/bin:$PATH"
fi
exec "$@"
