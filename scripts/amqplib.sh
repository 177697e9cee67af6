#!/bin/sh
# Fetch amqplib, with which a module in JavaScript speaks to the broker in the tests. Needs npm; once.
set -eu
version=2.3.1
sum=ecefb9c47b59df9d38e78b5e1a67fa4b9e7d280b37cf2fb1f5db17409bd5afc2
folder=.cache/node_modules/amqplib
[ -f "$folder/$version" ] && exit 0
mkdir -p .cache/node_modules
archive=$(cd .cache && npm pack --silent "amqplib@$version")
echo "$sum  .cache/$archive" | sha256sum -c --quiet
rm -rf "$folder" "$folder.new"
mkdir "$folder.new"
tar -xzf ".cache/$archive" -C "$folder.new" --strip-components=1
rm ".cache/$archive"
touch "$folder.new/$version"
mv "$folder.new" "$folder"
