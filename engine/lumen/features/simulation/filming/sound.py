"""The sound of a film, added to the finished pictures."""

import os
import subprocess
import tempfile
from pathlib import Path

from lumen.errors import RobotFailedError
from lumen.run.audio_track import AudioTrack
from lumen.run.sound import save
from lumen.upkeep.private_folder import private_folder


def add_sound(film: Path, track: AudioTrack, length: float) -> None:
    """Give the MP4 of that length [s] this track, as AAC; the pictures stay. Raises RobotFailedError where it can't."""
    import imageio_ffmpeg

    with tempfile.TemporaryDirectory(dir=film.parent, prefix=".lumen-film-") as folder:
        private_folder(Path(folder))
        heard, whole = Path(folder, "heard.wav"), Path(folder, "whole.mp4")
        save(heard, track.mixed(length))
        command = [imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", "-y", "-i", str(film), "-i", str(heard)]
        command += ["-map", "0:v", "-map", "1:a", "-c:v", "copy", "-c:a", "aac", str(whole)]
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        if done.returncode:
            raise RobotFailedError(
                f"{film} has no sound; ffmpeg's error: {(done.stderr.strip().splitlines() or ['nothing'])[-1]}"
            )
        os.replace(whole, film)
