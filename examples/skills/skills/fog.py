"""A fog machine on a serial port, which $FOG_PORT names; without it the skill only prints what it would send."""

import os
from contextlib import ExitStack

from lumen.skills import skill

PORT = os.environ.get("FOG_PORT", "")


@skill
def fog(call, duration, power):
    with ExitStack() as closing:
        machine = closing.enter_context(open(PORT, "wb", buffering=0)) if PORT else None

        def order(text):
            print("fog machine:", text)
            if machine:
                machine.write(f"{text}\r\n".encode())

        closing.callback(order, "OFF")  # whatever happens, also when the call is cancelled
        order(f"ON {power}")
        whole = call.wait(duration)
    return {"litres": power / 1000 if whole else 0.0}
