"""The addresses of buses: each scheme is a row of a feature."""

from collections.abc import Mapping

from lumen.bus.checked_bus import CheckedBus
from lumen.errors import BusAddressError
from lumen.feature import BusRow, distribution_of, owner, table
from lumen.ports import Bus
from lumen.project.broken_features import called, faulty, need_made


def open_bus(url: str, sender: str) -> Bus:
    """Return the bus at that address. Raises BusError if it can't be opened.

    Raises LumenError with the name of the installed package if the code of the bus is faulty.
    """
    row = row_of(url)
    if row and "://" in url:
        scheme = url.partition(":")[0]
        feature = owner("buses", scheme)
        bus: Bus = called(feature, row.open, url, sender)
        need_made(feature, row.open, bus, Bus, "a bus")
        if distribution_of(feature):
            return CheckedBus(bus, lambda what: faulty(feature, f"its bus `{scheme}` {what}"))
        return bus
    schemes: Mapping[str, BusRow] = table("buses")
    begins = [f"`{scheme}://`" for scheme, row in schemes.items() if row.example]
    scheme, separator, _ = url.partition("://")
    what = f"`{scheme}://` is not a bus" if separator else f"the address of a bus begins with {_either(begins)}"
    raise BusAddressError(f"{what}: write {_either([form for row in schemes.values() for form in row.forms])}")


def row_of(url: str) -> BusRow | None:
    """Return the row for the scheme of an address; None if no feature has that scheme."""
    row: BusRow | None = table("buses").get(url.partition(":")[0])
    return row


def within_process(url: str) -> bool:
    """Return whether only this process can be on the bus with that address."""
    return (row := row_of(url)) is not None and row.within_process


def examples() -> str:
    """Return a text with an example of each kind of address, for `--help`."""
    return _either([row.example for row in table("buses").values() if row.example])


def _either(texts: list[str]) -> str:
    *first, last = texts
    return f"{', '.join(first)} or {last}" if first else last
