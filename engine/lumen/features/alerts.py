"""Messages to people about trouble of an exhibition."""

from lumen.feature import Feature

FEATURE = Feature(
    name="alerts",
    rules=("lumen.rules.alerts:check",),
)
