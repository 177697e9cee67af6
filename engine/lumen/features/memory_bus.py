"""A bus inside one process."""

from lumen.feature import BusRow, Feature

FEATURE = Feature(
    name="memory_bus",
    buses={
        "memory": BusRow(
            "lumen.bus.memory:open_bus", ("memory://", "memory://NAME"), example="memory://", within_process=True
        )
    },
)
