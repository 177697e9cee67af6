"""Routes and message bodies for other tools."""

from lumen.feature import Exporter, Feature

FEATURE = Feature(
    name="formats_routes",
    exporters={"asyncapi": Exporter("project", "lumen.formats.asyncapi:write_asyncapi")},
)
