"""Export of routes and message bodies for other tools."""

from lumen.feature import Exporter, Feature

FEATURE = Feature(
    name="formats_routes",
    exporters={"asyncapi": Exporter("project", "lumen.features.formats_routes.asyncapi:write_asyncapi")},
)
