"""The checks before every request: its host, its origin, its content type (JSON only) and its size."""

import asyncio
import ipaddress
import json
from collections.abc import Awaitable, Callable, Iterable, Mapping
from typing import Any
from urllib.parse import urlsplit

from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from lumen.features.console.connections import READ_TIMEOUT, cut_off
from lumen.features.console.proxies import TrustedProxies

MAX_BODY = 65_536
"""The largest body of a request [bytes]."""
POLICY = (
    "default-src 'self'; img-src 'self' data: blob:; style-src 'self'; script-src 'self'; connect-src 'self'; "
    "object-src 'none'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
)
HEADERS = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(), microphone=(), geolocation=()",
    "Cache-Control": "no-cache",
}
_HEADERS = [(name.lower().encode(), value.encode()) for name, value in HEADERS.items()]
LOOPBACK = ("localhost", "127.0.0.1", "::1")
WRITING = ("POST", "PUT", "PATCH", "DELETE")


class Gate:
    """Refuses requests from other sites' pages, to unknown host names, or with unsuitable bodies.

    It also adds security headers to responses.

    `hosts` are the console's names and addresses besides the connection's local address. The client addresses that
    `proxies` report are trusted.
    """

    def __init__(self, app: ASGIApp, hosts: Iterable[str], proxies: TrustedProxies | None = None) -> None:
        self._app, self._hosts = app, frozenset(map(str.lower, hosts))
        self._proxies = proxies or TrustedProxies()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        headers = {name.decode("latin-1"): value.decode("latin-1") for name, value in scope["headers"]}
        refusal = self._refusal(scope, headers)
        if refusal is None and scope["method"] in WRITING:
            body, refusal = await _read(receive, headers)
            receive = _given(body, receive)
        if refusal is None:
            await self._app(self._proxies.seen(scope), receive, _guarded(send, scope.get("client")))
        else:
            status, reason = refusal
            await refused(status, reason)(scope, receive, _guarded(send, scope.get("client")))

    def _refusal(self, scope: Scope, headers: Mapping[str, str]) -> tuple[int, str] | None:
        host = headers.get("host", "")
        if not self._known(host, scope):
            return 421, "unknown host: open the console at the address that `lumen console` printed"
        origin = headers.get("origin")
        if origin is not None and urlsplit(origin).netloc.lower() != host.lower():
            return 403, "pages of other sites may not use this console: open it at its own address"
        foreign = headers.get("sec-fetch-site", "same-origin") not in ("same-origin", "none")
        if foreign and (scope["path"].startswith(("/api/", "/camera/")) or scope["method"] in WRITING):
            return 403, "pages of other sites may not use this console: open it at its own address"
        kind = headers.get("content-type", "").partition(";")[0].strip().lower()
        if scope["method"] == "POST" and kind != "application/json":
            return 415, "the request body must be JSON: send `Content-Type: application/json`"
        return None

    def _known(self, host: str, scope: Scope) -> bool:
        name = (urlsplit(f"//{host}").hostname or "") if _readable(host) else ""
        here = (scope.get("server") or ("",))[0]
        return name in self._hosts or (bool(name) and _same_address(name, here))


def refused(status: int, reason: str, **headers: str) -> JSONResponse:
    """Return a JSON response with this status and these headers; `reason` is a sentence."""
    return JSONResponse({"reason": reason}, status, headers)


def _readable(host: str) -> bool:
    try:
        urlsplit(f"//{host}").port  # noqa: B018  it raises if the port is invalid
    except ValueError:
        return False
    return not any(sign in host for sign in "/@?#\\ ")


def _same_address(name: str, here: str) -> bool:
    """Return True if both texts are the same IP address; False if one is not an address."""
    try:
        one, other = ipaddress.ip_address(name), ipaddress.ip_address(here)
    except ValueError:
        return False
    return one == other


async def _read(receive: Receive, headers: Mapping[str, str]) -> tuple[bytes, tuple[int, str] | None]:
    """Return the request body and None.

    If the body is too large or incomplete, return an empty body, and the HTTP status and the reason for the refusal.
    """
    too_large = 413, f"the request body is too large: send at most {MAX_BODY} bytes"
    length = headers.get("content-length", "0")
    if length.isdigit() and int(length) > MAX_BODY:
        return b"", too_large
    body = bytearray()
    while True:
        message = await receive()
        if message["type"] != "http.request":
            return b"", (400, "the request ended early")
        body += message.get("body", b"")
        if len(body) > MAX_BODY:
            return b"", too_large
        if not message.get("more_body"):
            return bytes(body), None


def _given(body: bytes, receive: Receive) -> Receive:
    """Return a `receive` whose first message is the body already read."""
    read: list[Message] = [{"type": "http.request", "body": body, "more_body": False}]

    async def again() -> Message:
        return read.pop() if read else await receive()

    return again


def _guarded(send: Send, client: tuple[str, int] | None) -> Callable[[Message], Awaitable[None]]:
    """Return a `send` that adds our headers, and cuts off a client that does not read for READ_TIMEOUT [s]."""

    async def told(message: Message) -> None:
        if message["type"] == "http.response.start":
            given = {name.lower() for name, _ in message["headers"]}
            message["headers"] = [*message["headers"], *(one for one in _HEADERS if one[0] not in given)]
        late = asyncio.get_running_loop().call_later(READ_TIMEOUT, cut_off, client)
        try:
            await send(message)
        finally:
            late.cancel()

    return told


def json_object(body: bytes) -> dict[str, Any]:
    """Return the JSON object in a body. Raises ValueError if the body is anything else."""
    try:
        data = json.loads(body or b"null")
    except (ValueError, RecursionError):
        raise ValueError("the request body is not JSON") from None
    if not isinstance(data, dict):
        raise ValueError("the request body must be a JSON object")
    return data
