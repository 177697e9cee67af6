"""Social media posts."""

from lumen.feature import Feature, ModuleRow

FEATURE = Feature(name="social", modules={"social": ModuleRow("lumen.features.social.module:Social")})
