"""Measure `lumen lint`: cold compared with the imports of yaml and jsonschema, on growing projects, and warm.

Cold is the CPU time of a process, run in turn with `python -c "import yaml, jsonschema"` on the same machine; medians.
It is measured with an empty cache, with a cache for the same files, and with a cache from before a change of one file,
which requires all checks again. Python's bytecode exists before. Grown projects have further behaviours and motions.
Warm is the cost for `--watch` and editors: one value has changed, in a file of each kind, and everything else is
cached. The last figure is that of `lumen lint --watch` itself, from the replacement of the file to the line that it
waits again.

    python benchmarks/lint.py
"""

import gc
import os
import platform
import re
import resource
import shutil
import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.guarded import DEVNULL, PIPE, Guarded, run_guarded

from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.project.kept_contents import SETTLED_NS
from lumen.project.project_folders import MAIN_FILE, PROJECT_FOLDERS

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
TURNS = 10
EDITS = (
    ("behaviors/tour.yaml", "I am glad", "%d"),
    ("behaviors/tour.yaml", "after: {", "4%ds"),
    ("behaviors/stories/silence.yaml", "wait: ", "11.%ds"),
    ("motions/dance.yaml", "tempo: 1", "2%d.5"),
    ("motions/goodbye.yaml", "at: 3.2", "%ds"),
    ("models/passages/sit-straddle.yaml", "at: 2", ".%ds"),
    ("models/nao.yaml", "speed: 24.6", "%d"),
    ("fuzzy/head.yaml", "resolution: ", "100%d1"),
    ("lumen.yaml", "patience: ", "5%ds"),
    ("schemas/messages/face.recognition.schema.json", "Whose face it is", "%d"),
)
"""A value in a file of each kind: the text before it, and a format of its n-th value."""
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
    imports, nothing, same, changed = cold()
    print(f"\ncold, CPU time, median of {RUNS}:")
    print(f"  python -c 'import yaml, jsonschema'   {imports:6.3f} s")
    for what, took in (("nothing kept", nothing), ("one file changed", changed), ("the same files", same)):
        print(f"  {f'lumen lint, {what}':37s} {took:6.3f} s   {took / imports:.2f} x the imports")
    print("\ngrown projects, CPU time in one process:")
    for count in (250, 500, 1_000):
        files = grown(count)
        took = timed(lambda files=files: check_files(ROOT, files))  # type: ignore[misc]
        print(f"  {len(files):5,} files   {took:6.3f} s   {1e3 * took / len(files):.2f} ms a file")
    print(f"\nwarm, one value changed, CPU time, median and worst of {TURNS}:")
    for file, before, value in EDITS:
        print(f"  {file:46s} {before:17s} {shown(warm(file, before, value))}")
    print("\nlumen lint --watch, from saved to said, wall time, median and worst of them all:")
    print(f"  {shown(watched())}")
    return 0


def shown(took: list[float]) -> str:
    """Return the median and the maximum as text."""
    return f"{1e3 * statistics.median(took):4.0f} ms {1e3 * max(took):4.0f} ms"


def cold() -> tuple[float, ...]:
    """Return medians of the imports and of lint [s of CPU], in turns: no cache, same files, one file changed."""
    took: list[tuple[float, ...]] = []
    with copied() as root, tempfile.TemporaryDirectory() as cache:
        lint = sys.executable, "-m", "lumen", "lint", str(root)
        for n in range(RUNS):
            shutil.rmtree(cache, ignore_errors=True)
            imports = process(cache, sys.executable, "-c", "import yaml, jsonschema")
            time.sleep(SETTLED_NS / 1e9)  # files that changed a moment ago are not cached
            kept = [process(cache, *lint) for _ in range(2)]
            file, before, value = EDITS[0]
            (root / file).write_bytes(edited((root / file).read_bytes(), before, value, n))
            took.append((imports, *kept, process(cache, *lint)))
    return tuple(map(statistics.median, zip(*took, strict=True)))


@contextmanager
def copied() -> Iterator[Path]:
    """Yield a copy of the shipped project."""
    with tempfile.TemporaryDirectory() as name:
        root = Path(name)
        shutil.copy(ROOT / MAIN_FILE, root)
        for folder in (folder for folder in PROJECT_FOLDERS if (ROOT / folder).is_dir()):
            shutil.copytree(ROOT / folder, root / folder)
        yield root


def process(cache: str, *words: str) -> float:
    """Return the CPU time of a process [s], which has its cache in the folder `cache`."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "engine"), "XDG_CACHE_HOME": cache}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run_guarded(words, check=True, stdout=DEVNULL, env=environment, cwd=tempfile.gettempdir())
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def grown(count: int) -> dict[str, bytes]:
    """Return the shipped project with more behaviours and motions, `count` files in all."""
    files = dict(read_files(ROOT))
    for n in range((count - len(files)) // 2):
        files[f"behaviors/part{n}.yaml"] = BEHAVIOR.format(n=n).encode()
        files[f"motions/wave{n}.yaml"] = MOTION.encode()
    return files


def timed(work: Callable[[], object]) -> float:
    """Return the processor time of a call [s]."""
    began = time.process_time()
    work()
    return time.process_time() - began


def warm(file: str, before: str, value: str) -> list[float]:
    """Return the times of checks after a change of one value each [s of CPU]; garbage is collected between them."""
    files, took = read_files(ROOT), []
    check_files(ROOT, files)
    for n in range(TURNS):
        changed = edited(files[file], before, value, n)
        gc.collect()
        gc.disable()
        took.append(timed(lambda changed=changed: check_files(ROOT, {**files, file: changed})))  # type: ignore[misc]
        gc.enable()
    return took


def watched() -> list[float]:
    """Return the response times of `lumen lint --watch` to the same edits [s]."""
    with copied() as root:
        command = [sys.executable, "-m", "lumen", "lint", "--watch", "--format", "concise", str(root)]
        environment = {**os.environ, "PYTHONPATH": str(ROOT / "engine")}
        with Guarded(command, stdout=PIPE, text=True, env=environment) as process:
            assert process.stdout
            try:
                answered(process.stdout)
                time.sleep(1)  # until the system reports changes; before that it polls
                return [saved(root, *edit, n, process.stdout) for n in range(3) for edit in EDITS]
            finally:
                process.terminate()


def saved(root: Path, file: str, before: str, value: str, n: int, said: Iterable[str]) -> float:
    """Return the time from the replacement of a file to the answer [s]."""
    (root / ".new").write_bytes(edited((root / file).read_bytes(), before, value, n))
    time.sleep(0.3)  # as people pause: the edit before has been processed
    began = time.perf_counter()
    (root / ".new").replace(root / file)
    answered(said)
    return time.perf_counter() - began


def answered(said: Iterable[str]) -> None:
    """Return when the watcher waits for the next change."""
    for line in said:
        if "waiting for the next change" in line:
            return
    raise SystemExit("lumen lint --watch ended")


def edited(content: bytes, before: str, value: str, n: int) -> bytes:
    """Return the file with the n-th value after the text `before`."""
    text, count = re.subn(f"({re.escape(before)})[\\w.]*", rf"\g<1>{value % n}", content.decode(), count=1)
    assert count, before
    assert text.encode() != content, f"{before} is that already"
    return text.encode()


if __name__ == "__main__":
    sys.exit(main())
