"""Which OpenGL draws without a screen; chosen when this is imported, which has to be before mujoco is."""

import ctypes
import os

REMEDY = "install libegl1 and libgl1 (apt-get install -y --no-install-recommends libegl1 libgl1)"

_LIBRARIES = {"egl": ("libEGL.so.1", "libGL.so.1"), "osmesa": ("libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so")}


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def choose() -> str:
    """`egl` where its libraries load, else `osmesa`, else `disable`: physics without pictures."""
    if all(_loads(library) for library in _LIBRARIES["egl"]):
        return "egl"
    if any(_loads(library) for library in _LIBRARIES["osmesa"]):
        return "osmesa"
    return "disable"


BACKEND = os.environ.setdefault("MUJOCO_GL", choose())


def missing() -> str | None:
    """Why nothing can be drawn and what to do about it; None where it can."""
    if BACKEND.lower() in ("disable", "off", "false", "0"):
        return f"there is no OpenGL library to draw camera images with: {REMEDY}"
    return None
