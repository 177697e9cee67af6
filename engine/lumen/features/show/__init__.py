"""Control of a hall's lamps, screens and sound desks."""

from lumen.feature import Feature, ModuleRow, Section

FEATURE = Feature(
    name="show",
    pages=("lumen.features.show.pages",),
    section_rules={"modules.show": "lumen.features.show.rules:check"},
    sections={
        "modules.show": Section(
            read="lumen.features.show.reading:read_show",
            title="the output to lamps, screens and sound desks (`modules.show`)",
            risk="wiring",
        )
    },
    modules={"show": ModuleRow("lumen.features.show.module:ShowControl")},
)
