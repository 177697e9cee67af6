"""Fixtures for all tests, their marks and measurements, and the fixed seed of hypothesis' examples."""

import signal

from hypothesis import HealthCheck, settings

from tests.environment import settle

pytest_plugins = [
    "tests.provided",  # first, since others import it
    "tests.leftovers",
    "tests.suites",
    "tests.marking",
    "tests.servers",
    "tests.cpu_time",
    "tests.garbage",
    "tests.progress",
    "tests.stranger.exhibiting",
    "tests.stranger.installing",
]

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # as in the background of a script
    signal.signal(signal.SIGINT, signal.default_int_handler)

settle()

settings.register_profile(
    "seeded",
    derandomize=True,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],  # on a slow machine
)
settings.register_profile("quick", settings.get_profile("seeded"), max_examples=10)
settings.load_profile("seeded")
