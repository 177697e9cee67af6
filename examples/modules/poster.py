"""A module that takes the place of another: social media that print what they would post.

LUMEN_BUS=amqp://NAME:PASSWORD@HOST/ python poster.py
"""

import os
import platform
import sys
import time
import uuid

from lumen.bus import BusError, Message, Refused, connect

try:
    bus = connect(os.environ["LUMEN_BUS"])
except BusError as error:
    sys.exit(f"poster: {error}")
here = {"robot": "NAO", "parts": ["social"], "session": uuid.uuid4().hex[:12], "host": platform.node()}


def post(message: Message) -> None:
    if not isinstance(message.body, dict) or "text" not in message.body:
        raise Refused("a post has a `text`")
    print(message.body["text"], flush=True)
    bus.publish("lumen.NAO.social.perception", {"kind": "posted", "text": message.body["text"]})


bus.subscribe("lumen.NAO.social.expression", post)
while True:  # twice a second it says that it is there: who does not for 2.5 s is lost
    bus.publish("lumen.presence", {**here, "state": "here"}, ttl=2.0)
    time.sleep(0.5)
