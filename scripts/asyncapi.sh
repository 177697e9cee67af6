#!/bin/sh
# Fetch the parser of AsyncAPI, which the tests ask whether what `lumen export asyncapi` writes is right. Needs npm; once.
set -eu
version=3.6.3
sum=c83f5628b7b9650b545becb714ef7ce895caff76c4a6cf9ad14927b47ab441cf
folder=.cache/asyncapi
[ -f "$folder/$version" ] && exit 0
mkdir -p .cache
archive=$(cd .cache && npm pack --silent "@asyncapi/parser@$version")
echo "$sum  .cache/$archive" | sha256sum -c --quiet
rm -rf "$folder" "$folder.new"
mkdir "$folder.new"
tar -xzf ".cache/$archive" -C "$folder.new" --strip-components=1
rm ".cache/$archive"
touch "$folder.new/$version"
mv "$folder.new" "$folder"
