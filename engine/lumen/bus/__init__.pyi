from lumen.errors import BusError as BusError
from lumen.errors import Refused as Refused
from lumen.ports import Bus as Bus
from lumen.ports import Message as Message
from lumen.standalone.bus import connect as connect

__all__ = ["Bus", "BusError", "Message", "Refused", "connect"]
