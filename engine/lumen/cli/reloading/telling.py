"""What came of files, told to everybody whom it concerns."""

import logging
from collections.abc import Iterable

from lumen.cli.reloading.bulletin import Bulletin
from lumen.cli.reloading.orders import STATUS, Order
from lumen.cli.reloading.records import Records
from lumen.cli.show import Show
from lumen.cli.transcript import Transcript
from lumen.errors import BusError

_log = logging.getLogger(__name__)


class Herald:
    """Tells the terminal, the bus (`lumen.config.status`), who asked, and the journal; `last` is what was told last."""

    def __init__(self, show: Show, transcript: Transcript, records: Records) -> None:
        self._show, self._transcript, self._records = show, transcript, records
        self.last: Bulletin | None = None

    def tell(self, bulletin: Bulletin, orders: Iterable[Order] = ()) -> None:
        lines, body = list(bulletin.lines()), bulletin.to_json()
        self.last = bulletin.kept()
        for line in lines:
            self.line(line)
        self._records.write({"at": round(self._show.exhibition.clock.now(), 3), **body})
        told = {**body, "lines": lines}
        for order in orders:
            order.answer(told)
        try:
            self._show.exhibition.bus.publish(STATUS, told)
        except BusError as error:
            _log.warning("what came of the saved files was not published: %s", error)

    def line(self, text: str) -> None:
        """To the terminal only."""
        self._transcript.line("reload", text)
