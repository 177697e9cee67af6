"""OpenCV, imported late: only the eyes need it."""

from types import ModuleType

from lumen.errors import ModuleError

INSTALL_EYES = "pip install 'lumen-robot[eyes]'"


def opencv() -> ModuleType:
    """Return the module `cv2`. Raises ModuleError if it can't be imported or lacks a feature that the eyes use."""
    try:
        import cv2
    except ImportError as error:
        raise ModuleError(f"the eyes need OpenCV, which cannot be imported ({error}): {INSTALL_EYES}") from None
    for part in ("CascadeClassifier", "HOGDescriptor", "face"):
        if not hasattr(cv2, part):
            raise ModuleError(f"this OpenCV ({cv2.__version__}) has no `{part}`: uninstall it, then {INSTALL_EYES}")
    cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)  # the eyes report errors themselves, in one line
    cv2.setNumThreads(1)  # the robot's physics and the behaviour need the other cores
    module: ModuleType = cv2
    return module
