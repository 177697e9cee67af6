"""Chooses, on import, the OpenGL library for drawing without a screen; import this module before mujoco."""

import ctypes
import importlib
import os
import sys

OPENGL_HINT = "install libegl1 and libgl1 (apt-get install -y --no-install-recommends libegl1 libgl1)"

_LIBRARIES = {"egl": ("libEGL.so.1", "libGL.so.1"), "osmesa": ("libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so")}


_WITH_SCREEN = ("glfw", "glx", "on", "true", "1", "enable", "enabled")
_OFF = ("disable", "disabled", "off", "false", "0")
_REMEDY = "unset it, or set it to egl, osmesa or disable"


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def _there(backend: str) -> bool:
    """Return True if the backend's libraries load: for EGL all of them, for OSMesa any version."""
    return (all if backend == "egl" else any)(_loads(library) for library in _LIBRARIES[backend])


def choose() -> str:
    """Return `egl` if its libraries load, else `osmesa`, else `disable`: physics without pictures."""
    return next((backend for backend in _LIBRARIES if _there(backend)), "disable")


def _settle() -> tuple[str, str]:
    """Choose a backend, from MUJOCO_GL if set; return it and the reason why the first choice does not work.

    The reason is empty if the choice works; otherwise, the backend is `disable`, with which only the physics works. If
    mujoco was already imported and MUJOCO_GL is not set, mujoco repeats its own choice.
    """
    wanted = os.environ.get("MUJOCO_GL", "").strip().lower()
    late = not wanted and sys.modules.get("mujoco.rendering.classic.gl_context")
    os.environ["MUJOCO_GL"] = backend = wanted or choose()
    if late:
        importlib.reload(late)
    why = _fault(backend)
    if why:
        os.environ["MUJOCO_GL"] = backend = "disable"
        importlib.import_module("mujoco")
    return backend, why


def _fault(backend: str) -> str:
    """Return the reason why mujoco and dm_control can't be imported with this backend.

    The reason is empty if the imports work or if the packages are not installed.
    """
    screen = os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY") or sys.platform != "linux"
    if backend in _WITH_SCREEN and not screen:
        return f"MUJOCO_GL={backend} draws on a screen, but this machine has none: {_REMEDY}"
    if backend in _LIBRARIES:
        if not _there(backend):
            return f"MUJOCO_GL={backend} needs {_LIBRARIES[backend][0]}, which is not installed: {_REMEDY}"
        os.environ["PYOPENGL_PLATFORM"] = backend
    try:
        for module in ("mujoco", "dm_control._render"):
            importlib.import_module(module)
    except ModuleNotFoundError as error:
        if error.name in ("mujoco", "dm_control"):
            return ""
        return f"MUJOCO_GL={backend} needs {error.name}, which is not installed: {_REMEDY}"
    except Exception as error:
        # PyOpenGL and the drivers raise exceptions of any type, such as AttributeError if a library is missing.
        return f"MUJOCO_GL={backend} does not work here ({' '.join(str(error).split())[:120]}): {_REMEDY}"
    return ""


BACKEND, _WHY = _settle()


def missing() -> str | None:
    """Return the reason why nothing can be drawn, with the remedy; None if drawing works."""
    if _WHY:
        return _WHY
    if BACKEND in _OFF:
        return f"there is no OpenGL library: {OPENGL_HINT}"
    return None
