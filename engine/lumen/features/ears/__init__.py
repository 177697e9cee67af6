"""Speech recognition."""

from lumen.feature import Feature, ModuleRow

FEATURE = Feature(name="ears", modules={"ears": ModuleRow("lumen.features.ears.module:Ears")})
