"""The routes that come with Lumen: those of Lumen Server in 2015, with the robot's name in their keys.

The lumen.yaml of the tour lists all of them with their purposes. To any other project, `lumen.project.used_routes` adds
those that its behaviours use.
"""

from collections.abc import Mapping
from dataclasses import replace

from lumen.language.routes import Carried, Direction, Route

_IN, _OUT = Direction.IN, Direction.OUT
_DATA, _EVENT = "avatar.{robot}.data", "avatar.{robot}.event"
_AUDIO, _VISUAL = "lumen.{robot}.audio", "lumen.{robot}.visual"
_STORED = "lumen.{robot}.persistence"

_ROWS = (
    Route("image", f"{_DATA}.image", _OUT, "image", every=0.066, ttl=0.05, keep=1),
    Route("joint", f"{_DATA}.joint", _OUT, "joint", every=0.06, ttl=1.0, keep=1),
    Route("sonar", f"{_DATA}.sonar", _OUT, "sonar", every=0.1, ttl=1.0, keep=1),
    Route("tactile", f"{_DATA}.tactile", _OUT, "tactile", every=0.1, ttl=1.0, keep=1),
    Route("battery", f"{_DATA}.battery", _OUT, "battery", every=5.0, ttl=10.0, keep=1),
    Route("recording", f"{_DATA}.recording", _OUT, "recording"),
    Route("command", "avatar.{robot}.command", _IN, "command", ttl=2.0, keep=10, carried=Carried.COMMAND),
    Route("stop", "avatar.{robot}.stop", _IN, "command", ttl=5.0, carried=Carried.STOP),
    Route("aim", "avatar.{robot}.aim", _IN, "command", ttl=0.2, keep=1),
    Route("report", f"{_EVENT}.command", _OUT, "report", ttl=10.0),
    Route("noticed", f"{_EVENT}.noticed", _OUT, "noticed", ttl=10.0),
    Route("hall", "avatar.{robot}.hall", _IN, "hall", ttl=2.0),
    Route("seen", "avatar.{robot}.hall.seen", _OUT, "seen", ttl=2.0, keep=1),
    Route("presence", "lumen.{robot}.presence", _OUT, "presence", ttl=2.0, alias="lumen.presence"),
    Route("state", "lumen.{robot}.state", _OUT, "state", ttl=10.0, alias="lumen.state"),
    Route("motion", "lumen.motion.{robot}.command", _IN, "motion", ttl=2.0, carried=Carried.COMMAND),
    Route("heard", f"{_AUDIO}.speech.recognition", _IN, "speech.recognition", "heard", ttl=5.0,
          alias="lumen.audio.speech.recognition"),
    Route("listening", f"{_AUDIO}.listening", _IN, "listening", "listening", ttl=5.0),
    Route("gender", f"{_AUDIO}.gender.identification", _IN, "gender.identification", "gender", ttl=5.0,
          alias="lumen.audio.gender.identification"),
    Route("wav_stream", f"{_AUDIO}.wav.stream", _OUT, "wav.stream", ttl=5.0, alias="lumen.audio.wav.stream"),
    Route("text_stream", f"{_AUDIO}.text.stream", _OUT, "text.stream", ttl=5.0, alias="lumen.audio.text.stream"),
    Route("text_to_speech", f"{_AUDIO}.text.to.speech", _IN, "text.to.speech", ttl=5.0,
          alias="lumen.audio.text.to.speech"),
    Route("face", f"{_VISUAL}.face.detection", _IN, "face.detection", "face", ttl=1.0, keep=1,
          alias="lumen.visual.face.detection"),
    Route("recognised", f"{_VISUAL}.face.recognition", _IN, "face.recognition", "recognised", ttl=5.0,
          alias="lumen.visual.face.recognition"),
    Route("face_tracking", f"{_VISUAL}.face.tracking", _IN, "face.tracking", ttl=1.0, keep=1,
          alias="lumen.visual.face.tracking"),
    Route("human", f"{_VISUAL}.human.detection", _IN, "human.detection", ttl=1.0, keep=1,
          alias="lumen.visual.human.detection"),
    Route("visual_command", f"{_VISUAL}.command", _OUT, ttl=5.0, alias="lumen.visual.command"),
    Route("social_perception", "lumen.{robot}.social.perception", _IN, "social.perception", ttl=60.0),
    Route("social_expression", "lumen.{robot}.social.expression", _OUT, "social.expression", ttl=60.0),
    Route("fact", f"{_STORED}.fact", _OUT, "fact", ttl=5.0, carried=Carried.COMMAND),
    Route("forgotten", f"{_STORED}.forgotten", _OUT, "forgotten"),
    Route("journal", f"{_STORED}.journal", _OUT, "journal", carried=Carried.JOURNAL),
    Route("trouble", "lumen.{robot}.trouble", _OUT, "trouble", ttl=10.0, alias="lumen.trouble"),
)  # fmt: skip

BUILT_IN_ROUTES: Mapping[str, Route] = {
    row.name: replace(row, built_in=True, must_arrive=row.carried is not Carried.TELEMETRY) for row in _ROWS
}
"""The routes by name, each as the row that a project would write for it."""
