"""A broker's address, and one-line reasons why the broker can't be used."""

import logging
import os
import re
import socket
import ssl
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any
from urllib.parse import SplitResult, parse_qsl, urlencode, urlsplit

import pika
from pika import exceptions

from lumen.errors import BusAddressError, BusError, BusRefusedError, BusUnreachableError
from lumen.language.addresses import fault_of_broker, public

HEARTBEAT_INTERVAL = 10
"""The time between heartbeats in each direction [s], unless the address sets a different time."""
SOCKET_TIMEOUT = 5.0
"""The time limit for the TCP connection [s]."""
BROKER_TIMEOUT = 2 * SOCKET_TIMEOUT
"""The time limit for a whole login, and for the broker's answer to a request [s]."""
CREDENTIALS_VARIABLE = "LUMEN_BUS_CREDENTIALS"
"""The environment variable with the path of a file that contains `NAME:PASSWORD`."""
MIN_RABBITMQ_VERSION = (3, 10)
"""The first RabbitMQ version that supports a message's time to live in quorum queues."""

logging.getLogger("pika").setLevel(logging.CRITICAL)  # pika logs a traceback for every failure that we report


class BrokerAddress:
    """The parts of a broker's URL; `str` shows its host and port only.

    Raises BusAddressError if the URL, its certificates or the credentials file is unusable.
    """

    def __init__(self, url: str) -> None:
        shown = public(url)
        try:
            if fault := fault_of_broker(url):
                raise ValueError(fault)
            parts = urlsplit(url)
            authority, url = _authority(parts)
            self.parameters = pika.URLParameters(url)
        except (ValueError, TypeError, KeyError) as error:
            raise BusAddressError(
                f"`{shown}` is not the address of a broker ({error}): write amqp://USER:PASSWORD@HOST:PORT/VHOST"
            ) from None  # the original error may quote the password
        options = self.parameters
        options.connection_attempts = 1
        options.socket_timeout = SOCKET_TIMEOUT
        options.stack_timeout = BROKER_TIMEOUT
        options.heartbeat = options.heartbeat if "heartbeat=" in parts.query else HEARTBEAT_INTERVAL
        options.client_properties = {"connection_name": "lumen"}
        if options.ssl_options:
            options.ssl_options = pika.SSLOptions(_trusting(authority), parts.hostname)
        if not parts.username and (file := os.environ.get(CREDENTIALS_VARIABLE)):
            options.credentials = _credentials(file)
        self.user = options.credentials.username
        self.vhost = options.virtual_host
        self.place = f"{options.host}:{options.port}"

    def __str__(self) -> str:
        return self.place

    def check_version(self, server: Mapping[str, Any]) -> None:
        """Raise BusUnreachableError if the broker is RabbitMQ before MIN_RABBITMQ_VERSION."""
        version = server.get("version", b"")
        text = version.decode(errors="replace") if isinstance(version, bytes) else str(version)
        numbers = tuple(int(n) for n in re.findall(r"\d+", text)[:2])
        if "RabbitMQ" in str(server.get("product")) and numbers < MIN_RABBITMQ_VERSION:
            least = ".".join(map(str, MIN_RABBITMQ_VERSION))
            raise BusUnreachableError(
                f"the broker at {self} is RabbitMQ {text}, which is too old: install {least} or newer"
            )

    def explain(self, error: BaseException) -> BusError:
        """Return the BusError, with the remedy, for a failure to connect; if `error` is a BusError, return it."""
        if isinstance(error, BusError):
            return error
        found = filter(None, map(self._explained, _causes(error)))
        return next(found, None) or BusUnreachableError(f"the broker at {self} cannot be used: {error!r}")

    def _explained(self, cause: BaseException) -> BusError | None:
        code = cause.reply_code if isinstance(cause, exceptions.ConnectionClosed) else 0
        if isinstance(cause, exceptions.ProbableAuthenticationError | exceptions.AuthenticationError):
            return BusRefusedError(
                f"the broker at {self} refuses user `{self.user}`: check the name and the password in the address"
            )
        if isinstance(cause, exceptions.ProbableAccessDeniedError) or code == 530 or "vhost" in str(cause):
            return BusRefusedError(
                f"user `{self.user}` may not use the virtual host `{self.vhost}` at {self}, or it does not exist"
            )
        reason = self._unreachable(cause)
        return BusUnreachableError(reason) if reason else None

    def short_of(self, what: str) -> str:
        """Return the message that the broker is short of the resource `what` and accepts no messages."""
        more = "run `rabbitmqctl status` to see its alarms and limits"
        return f"the broker at {self} is short of {what} and accepts no messages until it has enough: {more}"

    def _unreachable(self, cause: BaseException) -> str:
        if isinstance(cause, exceptions.ConnectionBlockedTimeout):
            return self.short_of(str(cause.args[0]))
        if isinstance(cause, ConnectionRefusedError):
            return f"no broker listens at {self}: start RabbitMQ there"
        if isinstance(cause, socket.gaierror):
            return f"the host `{self.parameters.host}` is unknown: check the address of the broker"
        if isinstance(cause, ssl.SSLCertVerificationError):
            what = cause.verify_message.rstrip(".")
            if "self-signed" in what or "issuer" in what:
                what += "; pass the certificate of its signer, as in amqps://HOST/?ca=FILE"
            return f"the certificate of the broker at {self} cannot be trusted: {what}"
        if isinstance(cause, ssl.SSLError):
            return f"the broker at {self} does not speak TLS: use amqp://, or the port for TLS (5671)"
        if isinstance(cause, exceptions.IncompatibleProtocolError | exceptions.StreamLostError):
            return f"the program at {self} is not an AMQP 0-9-1 broker, or it closed the connection at once"
        if isinstance(cause, TimeoutError) or "Timeout" in type(cause).__name__:
            return f"the broker at {self} does not answer: check the host, the port and the network"
        return ""


def shortage(reason: str) -> str:
    """Return the scarce resources in a broker's reason for blocking: memory, disk or both, else `resources`."""
    return " and ".join(word for word in ("memory", "disk") if word in reason) or "resources"


def _authority(parts: SplitResult) -> tuple[str, str]:
    """Return the file of trusted certificates from `?ca=FILE`, empty if missing, and the URL without `ca`."""
    query = dict(parse_qsl(parts.query))
    authority = query.pop("ca", "")
    return authority, parts._replace(query=urlencode(query)).geturl()


def _trusting(authority: str) -> ssl.SSLContext:
    """Return a TLS context that always checks certificates and host names.

    Raises BusAddressError if the file `authority` has no usable certificates.
    """
    try:
        return ssl.create_default_context(cafile=authority or None)
    except (OSError, ssl.SSLError) as error:
        reason = getattr(error, "strerror", None) or error
        raise BusAddressError(f"`{authority}` has no certificates that can check the broker's: {reason}") from None


def _credentials(file: str) -> Any:
    try:
        name, separator, password = Path(file).read_text("utf-8").strip().partition(":")
    except (OSError, UnicodeDecodeError) as error:
        raise BusAddressError(f"the file `{file}` that {CREDENTIALS_VARIABLE} names cannot be read: {error}") from None
    if not separator or not name or "\n" in password:
        raise BusAddressError(
            f"the file `{file}` that {CREDENTIALS_VARIABLE} names must contain one line `NAME:PASSWORD`"
        )
    if os.name == "posix" and Path(file).stat().st_mode & 0o077:
        logging.getLogger(__name__).warning("other users can read the password in `%s`: run `chmod 600 %s`", file, file)
    return pika.PlainCredentials(name, password)


def _causes(error: BaseException) -> Iterator[BaseException]:
    """Yield the error's nested causes, innermost first, then the error itself."""
    packed = [getattr(error, "exception", None), *getattr(error, "exceptions", ())]
    inner: list[Any] = [*error.args, *packed, error.__cause__]
    for item in inner:
        if isinstance(item, BaseException):
            yield from _causes(item)
    yield error
