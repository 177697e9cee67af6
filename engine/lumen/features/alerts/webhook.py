"""Alerts as a POST with JSON."""

import json
import os
import urllib.error
import urllib.request
from http.client import HTTPException
from typing import Any

from lumen.errors import UndeliveredError

POST_TIMEOUT = 10.0
"""The time for which the server may be silent [s]."""
PASSING = (408, 425, 429, *range(500, 600))
"""The HTTP statuses after which another attempt may succeed."""
TOKEN = "LUMEN_ALERT_TOKEN"
"""The environment variable with the token that is sent to each webhook, as `Authorization: Bearer`."""


class _Stay(urllib.request.HTTPRedirectHandler):
    """Follows no redirect: it may lead anywhere, and a POST would become a GET."""

    def redirect_request(self, *arguments: Any) -> None:
        """Return None: do not redirect."""
        return None


def post(url: str, body: dict[str, Any]) -> None:
    """Send the body; any status from 200 to 299 is a success. Raises UndeliveredError."""
    if url.startswith("$"):
        url = _of_variable(url[1:])
    head = {"Content-Type": "application/json", "User-Agent": "lumen"}
    if token := os.environ.get(TOKEN):
        head["Authorization"] = f"Bearer {token}"
    try:
        request = urllib.request.Request(url, json.dumps(body).encode(), head, method="POST")
        with urllib.request.build_opener(_Stay).open(request, timeout=POST_TIMEOUT):
            pass
    except urllib.error.HTTPError as error:
        error.close()
        raise UndeliveredError(
            f"the server answers {error.code} {error.reason}", final=error.code not in PASSING
        ) from None
    except urllib.error.URLError as error:
        raise UndeliveredError(f"the server can't be reached: {error.reason}") from None
    except (TimeoutError, ConnectionError) as error:
        raise UndeliveredError(f"the server can't be reached: {error}") from None
    except (OSError, ValueError, HTTPException) as error:  # its text may contain the address, which may be a secret
        raise UndeliveredError(f"the request failed: {type(error).__name__}") from None


def _of_variable(name: str) -> str:
    """Return the URL in an environment variable; errors do not quote it, since it may be a secret."""
    url = os.environ.get(name, "").strip()
    if not url:
        raise UndeliveredError(f"the environment variable {name} is not set", final=True)
    if not url.startswith(("https://", "http://")):
        why = f"the address in the environment variable {name} must begin with https:// or http://"
        raise UndeliveredError(why, final=True)
    return url
