"""Requests that are turned down with a reason, as a new name that is taken or a text that is another by now: an answer,
and no fault of the server."""

import logging

from pygls.exceptions import JsonRpcContentModified, JsonRpcInvalidParams

_REFUSALS = (JsonRpcInvalidParams, JsonRpcContentModified)


class RefusalFilter(logging.Filter):
    """Keeps refusals out of the log, into which the protocol's library writes a traceback of whatever is raised."""

    def filter(self, record: logging.LogRecord) -> bool:
        return not (record.exc_info and isinstance(record.exc_info[1], _REFUSALS))


def quiet() -> None:
    """Log what went wrong, and nothing else."""
    logging.getLogger("pygls").setLevel(logging.ERROR)
    logging.getLogger("pygls.protocol.json_rpc").addFilter(RefusalFilter())
