"""Foxglove's protobuf schemas for images, frames and shapes."""

from functools import cache
from typing import Any

from lumen.features.mcap.files.recorded import RecordedChannel

NANO = 1_000_000_000


@cache
def foxglove_channel(topic: str, form: str) -> RecordedChannel:
    """Return a channel with one of Foxglove's schemas, such as `CompressedImage`, and the schemas it depends on."""
    from google.protobuf.descriptor_pb2 import FileDescriptorSet

    found = FileDescriptorSet()
    _collect(form_class(form).DESCRIPTOR.file, found, set())
    return RecordedChannel(topic, "protobuf", f"foxglove.{form}", "protobuf", found.SerializeToString())


def form_class(form: str) -> Any:
    """Return the protobuf class of one of Foxglove's schemas."""
    from importlib import import_module

    return getattr(import_module(f"foxglove_schemas_protobuf.{form}_pb2"), form)


def compressed_image(jpeg: bytes, frame: str, at: int) -> bytes:
    """Return a serialized `foxglove.CompressedImage` of a JPEG, in a frame of reference, at a time [ns since 1970]."""
    image = form_class("CompressedImage")(frame_id=frame, data=jpeg, format="jpeg")
    stamp(image.timestamp, at)
    return bytes(image.SerializeToString())


def stamp(field: Any, at: int) -> None:
    """Set a protobuf timestamp to a time [ns since 1970, in UTC]."""
    field.seconds, field.nanos = divmod(at, NANO)


def _collect(file: Any, found: Any, seen: set[str]) -> None:
    """Add a descriptor file to `found`, after its dependencies; skip the names in `seen`."""
    if file.name not in seen:
        seen.add(file.name)
        for other in file.dependencies:
            _collect(other, found, seen)
        file.CopyToProto(found.file.add())
