"""Detection of faces and people in a camera's images."""

from lumen.feature import Feature, ModuleRow

FEATURE = Feature(
    name="eyes",
    modules={"eyes": ModuleRow("lumen.features.eyes.module:Eyes")},
    file_forgetters=("lumen.features.eyes.eyes:forget_faces",),
)
