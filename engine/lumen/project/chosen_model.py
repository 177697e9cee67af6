"""Replace the robot model that lumen.yaml names, for one run: `--model NAME`.

An environment variable holds the choice, so that all processes of the run share it. It is also one of the project's
files, under a name that no real file has, so the result and the hash still depend on the files alone.
"""

import os
from collections.abc import Mapping

CHOSEN_MODEL = "models/.chosen"
MODEL_VARIABLE = "LUMEN_MODEL"


def choice() -> Mapping[str, bytes]:
    """Return the choice as a file, by the file's name; empty if no model was chosen."""
    name = os.environ.get(MODEL_VARIABLE, "")
    return {CHOSEN_MODEL: name.encode("utf-8", "surrogateescape")} if name else {}


def choose(name: str) -> None:
    """Set the model with which this process, and each process that it starts later, reads all projects."""
    os.environ[MODEL_VARIABLE] = name


def chosen(files: Mapping[str, bytes], model: str) -> str:
    """Return the model to use with these files: the chosen one, else `model`, which lumen.yaml names."""
    return files.get(CHOSEN_MODEL, b"").decode("utf-8", "replace") or model
