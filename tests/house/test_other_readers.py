"""The shipped YAML as JavaScript's tools read it, with the npm package `yaml`; PyYAML reads it in `make check`."""

import json

import pytest

from tests import ROOT
from tests.copying import SHIPPED_FOLDERS
from tests.fetched import fetched
from tests.guarded import run_guarded
from tests.provided import program
from tests.scanning import matching

FILES = [
    ROOT / "lumen.yaml",
    *(f for name in SHIPPED_FOLDERS if name != "schemas" for f in matching(ROOT / name, "**/*.yaml")),
]
READ = """
const {parseAllDocuments} = require(process.argv[1]), {readFileSync} = require('fs');
const wrong = [];
for (const file of process.argv.slice(2)) for (const version of ['1.1', '1.2'])
  for (const document of parseAllDocuments(readFileSync(file, 'utf8'), {version}))
    for (const error of document.errors) wrong.push(`${file} ${version}: ${error.message}`);
console.log(JSON.stringify(wrong));
"""


@pytest.mark.npm
def test_the_package_of_npm_reads_them_all() -> None:
    package = fetched("yaml") / "node_modules" / "yaml"
    node = program("node", "npm")
    done = run_guarded([node, "-e", READ, str(package), *map(str, FILES)], capture_output=True, text=True, check=True)
    assert json.loads(done.stdout) == []
