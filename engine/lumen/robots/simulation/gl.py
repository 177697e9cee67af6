"""Which OpenGL draws without a screen; chosen when this is imported, best before mujoco is."""

import ctypes
import importlib
import os
import sys

OPENGL_HINT = "install libegl1 and libgl1 (apt-get install -y --no-install-recommends libegl1 libgl1)"

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


def _settle() -> str:
    """The choice, the user's where there is one; mujoco chooses again where it was imported before."""
    late = "MUJOCO_GL" not in os.environ and sys.modules.get("mujoco.rendering.classic.gl_context")
    backend = os.environ.setdefault("MUJOCO_GL", choose())
    if late:
        importlib.reload(late)
    return backend


BACKEND = _settle()


def missing() -> str | None:
    """Why nothing can be drawn and what to do about it; None where it can."""
    if BACKEND.lower() in ("disable", "off", "false", "0"):
        return f"there is no OpenGL library: {OPENGL_HINT}"
    return None
