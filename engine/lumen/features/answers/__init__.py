"""Answers to questions that no phrase matches, from passages and language models."""

from lumen.feature import Feature, ModuleRow

FEATURE = Feature(name="answers", modules={"answers": ModuleRow("lumen.features.answers.module:Answers")})
