"""The visitors whom the exhibition remembers, and the journal of what happened."""

from lumen.feature import Feature, ModuleRow

FEATURE = Feature(name="visitors", modules={"memory": ModuleRow("lumen.features.visitors.module:Memory")})
