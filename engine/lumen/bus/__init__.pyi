from lumen.errors import BusError as BusError
from lumen.errors import Refused as Refused
from lumen.ports import Bus as Bus
from lumen.ports import Message as Message
from lumen.run.joining import JoinedModule as JoinedModule
from lumen.run.joining import join as join
from lumen.standalone.bus import connect as connect

__all__ = ["Bus", "BusError", "JoinedModule", "Message", "Refused", "connect", "join"]
