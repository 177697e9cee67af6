"""Trusted proxies in front of the console, which report each request's client address and protocol."""

import ipaddress
from collections.abc import Iterable, MutableMapping
from typing import Any

from lumen.errors import UsageError

AsgiScope = MutableMapping[str, Any]
"""The ASGI scope of a request."""
Network = ipaddress.IPv4Network | ipaddress.IPv6Network
Address = ipaddress.IPv4Address | ipaddress.IPv6Address


def network_of(text: str) -> Network:
    """Return a network such as `10.0.0.0/8`, or a single address as a network. Raises ValueError for other texts."""
    return ipaddress.ip_network(text, strict=False)


class TrustedProxies:
    """Reads `X-Forwarded-For` and `X-Forwarded-Proto` of requests that come from these addresses or networks.

    They are ignored in requests from other addresses, because anyone can forge them. Raises UsageError for a text that
    is neither an address nor a network.
    """

    def __init__(self, said: Iterable[str] = ()) -> None:
        try:
            self._networks = [network_of(one) for one in said]
        except ValueError as error:
            raise UsageError(f"`proxies` of the console: {error}; write an address such as 127.0.0.1") from None

    def seen(self, scope: AsgiScope) -> AsgiScope:
        """Return the request with the `client` and the `scheme` that a trusted proxy reports.

        A request from any other address is returned unchanged.
        """
        client = scope.get("client")
        if not client or not self._trusts(_address(client[0])):
            return scope
        seen: dict[str, Any] = dict(scope)
        if address := self._first_stranger(_values(scope, b"x-forwarded-for")):
            seen["client"] = (address, 0)
        protocols = _values(scope, b"x-forwarded-proto")
        if protocols and protocols[-1].lower() in ("http", "https"):
            seen["scheme"] = protocols[-1].lower()
        return seen

    def _first_stranger(self, addresses: list[str]) -> str:
        """Return the last address that is not a trusted proxy's. Each proxy appends its peer's address.

        Return an empty text if there is none, or if a text after it is not an address.
        """
        for text in reversed(addresses):
            address = _address(text)
            if address is None:
                return ""
            if not self._trusts(address):
                return str(address)
        return ""

    def _trusts(self, address: Address | None) -> bool:
        return address is not None and any(address in network for network in self._networks)


def _values(scope: AsgiScope, name: bytes) -> list[str]:
    """Return the comma-separated values of all headers of that name, in order."""
    said = b",".join(value for header, value in scope["headers"] if header == name).decode("latin-1")
    return [value.strip() for value in said.split(",") if value.strip()]


def _address(text: str) -> Address | None:
    """Return the address in a text, without its port; None for other texts. IPv4 within IPv6 becomes IPv4."""
    host = text
    if text.startswith("["):
        host = text[1:].partition("]")[0]
    elif text.count(":") == 1:
        host = text.partition(":")[0]
    try:
        found = ipaddress.ip_address(host)
    except ValueError:
        return None
    return getattr(found, "ipv4_mapped", None) or found
