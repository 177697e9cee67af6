#!/bin/sh
# Fetch a folder of scripts/fetched.txt, or all of them: sh scripts/fetch.sh [FOLDER]. Needs npm; each is fetched once.
set -eu
grep "^${1:-.cache}" scripts/fetched.txt | while read -r folder package version sum; do
    [ -f "$folder/$version" ] && continue
    mkdir -p "$(dirname "$folder")"
    archive=$(cd .cache && npm pack --silent "$package@$version" </dev/null)
    echo "$sum  .cache/$archive" | sha256sum -c --quiet
    rm -rf "$folder" "$folder.new"
    mkdir "$folder.new"
    tar -xzf ".cache/$archive" -C "$folder.new" --strip-components=1
    rm ".cache/$archive"
    touch "$folder.new/$version"
    mv "$folder.new" "$folder"
done
