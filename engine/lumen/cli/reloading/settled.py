"""Python's collector of garbage, kept from stopping the robot."""

import gc


def settled() -> None:
    """Called once when everything stands: what is there now is never looked through again for garbage.

    A full collection of all that was imported and loaded takes 20 ms and more, a tick; of what has come since, under 1.
    """
    gc.collect()
    gc.freeze()
