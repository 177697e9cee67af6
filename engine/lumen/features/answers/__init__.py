"""A language model's answers to questions that no passage answers."""

from lumen.feature import Feature, ModuleRow

FEATURE = Feature(name="answers", modules={"answers": ModuleRow("lumen.features.answers.module:Answers")})
