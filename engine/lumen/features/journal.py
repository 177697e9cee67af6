"""The journal of inputs, from which `lumen replay` repeats visits."""

from lumen.feature import Feature, Section

FEATURE = Feature(
    name="journal",
    file_forgetters=("lumen.run.forgetting.files:forget_inputs",),
    sections={"journal": Section(read="lumen.project.retention:read_journal", of_house=True)},
)
