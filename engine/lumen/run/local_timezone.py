"""Where this machine's clock hangs."""

import logging
import os
from datetime import datetime
from pathlib import Path

from lumen.errors import UsageError
from lumen.expressions.wall_clock import zone

_log = logging.getLogger(__name__)

_LINK, _NAME = Path("/etc/localtime"), Path("/etc/timezone")


def local_timezone() -> str:
    """The IANA name of this machine's time zone; `UTC+02:00` where it has none to tell, as it is now."""
    wanted = os.environ.get("TZ", "").removeprefix(":")
    found = next((name for name in (wanted, _linked(), _named()) if name and _known(name)), "")
    if not found:
        offset = datetime.now().astimezone().strftime("%z")
        found = f"UTC{offset[:3]}:{offset[3:5]}"
    if wanted not in ("", found):
        _log.warning("TZ=%s is not a known time zone: times of day are in %s", wanted, found)
    return found


def _linked() -> str:
    try:
        return _LINK.resolve().as_posix().partition("/zoneinfo/")[2]
    except OSError:
        return ""


def _named() -> str:
    try:
        return _NAME.read_text(encoding="ascii").strip()
    except (OSError, UnicodeDecodeError):
        return ""


def _known(name: str) -> bool:
    try:
        zone(name)
    except UsageError:
        return False
    return True
