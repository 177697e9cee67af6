"""The words that come with Lumen: `words: [common]`, and the word lists that every `hears` uses.

They are added as one more file to a project that uses them and has no `behaviors/words/common.yaml` of its own. That
file is then hashed, kept in bundles and replayed like any other.
"""

import re
from collections.abc import Mapping
from functools import cache

from lumen.project.packaged import PACKAGE
from lumen.project.project_folders import BEHAVIORS, WORDS_FOLDER

COMMON = "common"
COMMON_FILE = f"{WORDS_FOLDER}/{COMMON}.yaml"

_USED = re.compile(
    rb"""(^|[\s{,])["']?hears["']?\s*:|\bwords["']?\s*:[^\n]*\bcommon\b|^\s*-\s+common\s*$""", re.MULTILINE
)


@cache
def common_words() -> bytes:
    """Return the content of the words file that comes with Lumen."""
    return (PACKAGE / "words/common.yaml").read_bytes()


def with_common_words(files: Mapping[str, bytes]) -> Mapping[str, bytes]:
    """Return the files of a project; if a behaviour uses the words that come with Lumen, their file is added."""
    behaviors = (content for file, content in files.items() if _is_behavior(file))
    likely = (content for content in behaviors if b"hears" in content or b"common" in content)  # the pattern is slow
    if COMMON_FILE in files or not any(map(_USED.search, likely)):
        return files
    return dict(sorted({**files, COMMON_FILE: common_words()}.items()))


def own_files(files: Mapping[str, bytes]) -> Mapping[str, bytes]:
    """Return the files of a project that people can edit: all but the words that come with Lumen."""
    return (
        {file: content for file, content in files.items() if file != COMMON_FILE}
        if is_shipped(files, COMMON)
        else files
    )


def is_shipped(files: Mapping[str, bytes], name: str) -> bool:
    """Return True if the words file of that name comes with Lumen and is not the project's own."""
    return name == COMMON and files.get(COMMON_FILE) == common_words()


def _is_behavior(file: str) -> bool:
    folder, _, name = file.rpartition("/")
    return folder == BEHAVIORS and name.endswith(".yaml")
