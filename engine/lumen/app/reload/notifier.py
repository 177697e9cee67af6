"""What came of files, told to everybody whom it concerns."""

import logging
from collections.abc import Iterable

from lumen.app.node import Node
from lumen.app.reload.records import RunRecords
from lumen.app.reload.report import ReloadReport
from lumen.app.reload.requests import STATUS, ReloadRequest
from lumen.cli.transcript import Transcript
from lumen.errors import BusError

_log = logging.getLogger(__name__)


class ReloadNotifier:
    """Tells the terminal, the bus (`lumen.config.status`), who asked, and the journal; `last` is what was told last."""

    def __init__(self, show: Node, transcript: Transcript, records: RunRecords) -> None:
        self._node, self._transcript, self._records = show, transcript, records
        self.last: ReloadReport | None = None

    def tell(self, report: ReloadReport, orders: Iterable[ReloadRequest] = ()) -> None:
        lines, body = list(report.lines()), report.to_json()
        self.last = report.kept()
        for line in lines:
            self.line(line)
        self._records.write({"at": round(self._node.exhibition.clock.now(), 3), **body})
        told = {**body, "lines": lines}
        for order in orders:
            order.answer(told)
        try:
            self._node.exhibition.bus.publish(STATUS, told)
        except BusError as error:
            _log.warning("what came of the saved files was not published: %s", error)

    def line(self, text: str) -> None:
        """To the terminal only."""
        self._transcript.line("reload", text)
