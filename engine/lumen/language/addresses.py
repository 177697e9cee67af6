"""Addresses of brokers and servers (RFC 3986): the parts that may be shown, and the signs that need %XX."""

import re
from ipaddress import ip_address
from urllib.parse import quote, unquote, urlsplit

_FILE = re.compile(r"(?<=[?&])ca=[^&]*")
"""The parameter that names a file, whose path may hold an `@`."""
_PORT = re.compile(r"(\[[^\]]*\]|[^:/?#\[\]]*):(?!\d*(?:[/?#]|$))(.*)", re.DOTALL)
"""A host followed by a text that is not a port: it may be a name and a password whose host is missing."""
_ENDING = "/?#[]"
"""The signs that end a host, or enclose a numeric one: a name or a password must write them as %XX."""


def credentials_of(url: str) -> str:
    """Return the part of an address that may be a name and password; empty if the address has none."""
    return _FILE.sub("", url.partition("://")[2] or url).rpartition("@")[0]


def public(url: str) -> str:
    """Return the address without any part that may be a name or a password."""
    scheme, separator, rest = url.partition("://")
    rest = rest.rpartition("@")[2]
    if not separator:
        return url.rpartition("@")[2]
    if found := _PORT.fullmatch(rest):
        rest = f"{found[1]}:…"
    return f"{scheme}{separator}{rest}"


def unescaped(url: str) -> str:
    """Return how to spell the characters that end a name or a password too early, such as "%2F for `/`".

    The text is empty if the address has no such character in its name and password.
    """
    signs = [sign for sign in _ENDING if sign in credentials_of(url)]
    return ", ".join(f"{quote(sign, safe='')} for `{sign}`" for sign in signs)


def fault_of_broker(url: str) -> str:
    """Return the fault of an address that can't be a broker's, with the remedy; empty for a possible address."""
    if signs := unescaped(url):
        return f"in the user name and password, write {signs}; after the host, write %40 for `@`"
    try:
        parts = urlsplit(url)
        host = parts.hostname
    except ValueError:  # the text of the error may hold the password
        return "its host is not valid, or it contains a character that is not allowed in an address"
    if not host:
        return "it has no host"
    try:
        parts.port  # noqa: B018  it raises if the port is not valid
    except ValueError:
        return "its port is not a number from 0 to 65535"
    if parts.fragment:
        return "write %23 for `#`"
    segment = parts.path[1:]
    if "/" in segment.removesuffix("/") or segment == "/":
        meant, bare = quote(unquote(segment), safe=""), segment.strip("/")
        other = f" (or /{bare})" if bare and "/" not in bare else ""
        return f"a virtual host is one segment, with %2F for each slash: write /{meant}{other} instead of /{segment}"
    return ""


def loopback(host: str) -> bool:
    """Return True if a host is `localhost` or a loopback address."""
    try:
        return host == "localhost" or ip_address(host).is_loopback
    except ValueError:
        return False
