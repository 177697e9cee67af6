"""The figure of names that mean two things, for a small package of which everything can be counted by hand."""

import ast

from scripts.one_meaning import names_of_two_meanings
from scripts.source_files import SourceFile

HOUSE = {
    "language/commands.py": "class Rest: ...\n",
    "project/home.py": "def home_of(root): ...\n",
    "lint/word_tables.py": "def home_of(draft):\n    home_of, _, rest = draft.partition('.')\n",
    "run/node.py": "class Node:\n    rest: float\n\n    def __init__(self):\n        self._came = []\n",
    "run/recording.py": "",
}
FILES = [SourceFile(path, path, text, ast.parse(text)) for path, text in HOUSE.items()]


def test_a_definition_outside_the_home_of_its_word_is_counted_and_a_local_name_is_not() -> None:
    found = [
        str(place).replace(" means something else here than elsewhere", "").split(":")[:3]
        for place in names_of_two_meanings(FILES)
    ]
    assert found == [
        ["lint/word_tables.py", "1", " `home_of`"],
        ["run/node.py", "2", " `rest`"],
        ["run/node.py", "5", " `_came` is an image"],
        ["run/recording.py", "1", " `recording`"],
    ]
