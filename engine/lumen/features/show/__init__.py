"""Lamps, screens and sounds of a hall."""

from lumen.feature import Feature, ModuleRow, Section

FEATURE = Feature(
    name="show",
    rules=("lumen.rules.show:check",),
    sections={
        "modules.show": Section(
            read="lumen.loading.show:read_show",
            title="the output to lamps, screens and sound desks (`modules.show`)",
            risk="wiring",
        )
    },
    modules={"show": ModuleRow("lumen.modules.show:ShowControl")},
)
