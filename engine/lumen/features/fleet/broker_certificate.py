"""Until when a broker's certificate is good, asked of the broker itself: no user is needed for that."""

import socket
import ssl
import time
from datetime import UTC, datetime
from typing import Any

from lumen.features.fleet.broker_finding import BrokerFinding
from lumen.features.rabbitmq.broker import BrokerAddress

NOTICE = 30
"""How long before its end a certificate is told as wrong [days]."""
DAY = 86_400.0
RENEW = (
    "put a new server.pem and server.key into /etc/rabbitmq; then run rabbitmqctl eval 'ssl:clear_pem_cache().', so "
    "that the broker reads them"
)


def check_certificate(address: BrokerAddress) -> BrokerFinding:
    """Whether the certificate of a broker that is reached by TLS can be trusted, and for how long yet."""
    what, options = "the certificate", address.parameters
    context = options.ssl_options.context
    try:
        with (
            socket.create_connection((options.host, options.port), options.socket_timeout) as plain,
            context.wrap_socket(plain, server_hostname=options.host) as secure,
        ):
            shown: Any = secure.getpeercert()
    except OSError as error:
        expired = isinstance(error, ssl.SSLCertVerificationError) and "expired" in error.verify_message
        return BrokerFinding(what, str(address.explain(error)), mend=RENEW if expired else "")
    ends = ssl.cert_time_to_seconds(shown["notAfter"])
    left, day = (ends - time.time()) / DAY, datetime.fromtimestamp(ends, UTC).date().isoformat()
    if left < NOTICE:
        return BrokerFinding(what, f"it expires on {day}, in {left:.0f} days", mend=RENEW)
    return BrokerFinding(what, note=f"it is valid until {day}")
