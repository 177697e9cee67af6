"""Another body than lumen.yaml's, chosen for one run: `--model NAME`.

The choice stands in the environment, so that all processes of the run make it, and among the files that are read, under
a name that no file has: what is built still depends on the files alone, and so does their hash.
"""

import os
from collections.abc import Mapping

CHOSEN_MODEL = "models/.chosen"
MODEL_VARIABLE = "LUMEN_MODEL"


def choice() -> Mapping[str, bytes]:
    """The choice as one of the files, none where there is none."""
    name = os.environ.get(MODEL_VARIABLE, "")
    return {CHOSEN_MODEL: name.encode("utf-8", "surrogateescape")} if name else {}


def choose(name: str) -> None:
    """Read all projects with this body from now on, in this process and those that it starts."""
    os.environ[MODEL_VARIABLE] = name


def chosen(files: Mapping[str, bytes], model: str) -> str:
    """The body that these files are read with, where lumen.yaml names `model`."""
    return files.get(CHOSEN_MODEL, b"").decode("utf-8", "replace") or model
