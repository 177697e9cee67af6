"""Updates of the robots of many houses."""

from lumen.feature import Feature

FEATURE = Feature(
    name="fleet",
    rules=("lumen.rules.fleet:check",),
    codes=("lumen.loading.fleet",),
)
