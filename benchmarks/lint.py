"""How long `lumen lint` takes: cold beside the imports of yaml and jsonschema, over more and more files, and warm.

Cold is a process of its own, by CPU time, run in turn with `python -c "import yaml, jsonschema"` on the same machine;
medians. Grown projects have so many behaviours and motions beside the shipped ones. Warm is what `--watch` and an
editor pay: one file of the project has changed, everything else is remembered.

    python benchmarks/lint.py
"""

import json
import os
import platform
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from lumen.loading.files import read_files
from lumen.rules import check_files

ROOT = Path(__file__).parents[1]
RUNS = 9
BEHAVIOR = """id: part{n}
context: {{asked: 0}}
states:
  idle: {{on: {{face: greet}}}}
  greet:
    do: [{{say: {{en: "Hello, {{{{ context.asked }}}}", id: Halo}}}}, {{play: wave{n}}}]
    on: {{heard: {{guard: "context.asked < 3", target: greet, actions: {{assign: {{asked: context.asked + 1}}}}}}}}
    onDone: idle
    onError: idle
"""
MOTION = """units: {angle: deg}
start: Stand
keyframes:
  - {at: 1s, joints: {RShoulderPitch: -60, RShoulderRoll: -30}}
  - {at: 1.5s, joints: {RElbowRoll: 20}}
  - {at: 2s, joints: {RElbowRoll: 60}}
  - {at: 3s, posture: Stand}
"""


def main() -> int:
    print(f"{platform.processor() or platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}")
    imports, lint = cold()
    print(f"\ncold, CPU time, median of {RUNS}:")
    print(f"  python -c 'import yaml, jsonschema'   {imports:6.3f} s")
    print(f"  lumen lint, the shipped project       {lint:6.3f} s   {lint / imports:.2f} x the imports")
    print("\ngrown projects, CPU time in one process:")
    for count in (250, 500, 1_000):
        files = grown(count)
        took = timed(lambda files=files: check_files(ROOT, files))  # type: ignore[misc]
        print(f"  {len(files):5,} files   {took:6.3f} s   {1e3 * took / len(files):.2f} ms a file")
    print("\nwarm, one file changed, wall time, median and worst of 20:")
    took = sorted(warm())
    print(f"  {1e3 * statistics.median(took):.0f} ms, {1e3 * took[-1]:.0f} ms")
    return 0


def cold() -> tuple[float, float]:
    """The medians of the imports and of lint [s of CPU]; the two take turns."""
    imports, lint = [], []
    for _ in range(RUNS):
        imports.append(process(sys.executable, "-c", "import yaml, jsonschema"))
        lint.append(process(sys.executable, "-m", "lumen", "lint", str(ROOT)))
    return statistics.median(imports), statistics.median(lint)


def process(*words: str) -> float:
    """The CPU time of a process [s]."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "engine")}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL, env=environment, cwd=tempfile.gettempdir())
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def grown(count: int) -> dict[str, bytes]:
    """The shipped project with further behaviours and motions, `count` files in all; each behaviour plays one."""
    files = dict(read_files(ROOT))
    for n in range((count - len(files)) // 2):
        files[f"behaviors/part{n}.yaml"] = BEHAVIOR.format(n=n).encode()
        files[f"motions/wave{n}.yaml"] = MOTION.encode()
    return files


def timed(work: Callable[[], object]) -> float:
    began = time.process_time()
    work()
    return time.process_time() - began


def warm() -> list[float]:
    """The times of checks in which only a text of the tour is another than before [s]."""
    files = read_files(ROOT)
    check_files(ROOT, files)
    took = []
    for n in range(20):
        changed = files["behaviors/tour.yaml"].replace(b"I am glad to hear that.", b"I am glad to hear that %d." % n)
        began = time.perf_counter()
        _, found = check_files(ROOT, {**files, "behaviors/tour.yaml": changed})
        took.append(time.perf_counter() - began)
        assert not found, json.dumps([str(d) for d in found])
    return took


if __name__ == "__main__":
    sys.exit(main())
