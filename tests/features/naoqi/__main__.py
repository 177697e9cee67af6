"""A fake NAO in real time, to try `lumen run --robot naoqi` on: `python -m tests.features.naoqi`."""

import signal
import sys

import lumen
from tests.features.naoqi.fake import FakeNao

if __name__ == "__main__":
    nao = FakeNao(lumen.load().body)
    nao.times.run()
    sys.stdout.write(f"lumen run --robot naoqi --robot-url {nao.url}\n")
    sys.stdout.flush()
    signal.sigwait({signal.SIGINT, signal.SIGTERM})
    nao.close()
