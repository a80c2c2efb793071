"""Kills a run again and again, and lets it go on: nothing may be lost.

    python docs/kills.py target/release/carom 200

In the end its files and its final state are compared with those of one run.
"""

import filecmp
import json
import os
import random
import subprocess
import sys
import tempfile

SCENE = """
duration = DURATION
seed = 3
surface.kind = "rough"
equilibrate = 2.0
periodic = { lower = [0, 0, 0], upper = [6, 6, 6] }
[[spheres]]
count = 80
arrangement = "random"
radius = [0.3, 0.4]
temperature = 1.0
"""

ON_THE_WAY = "--json --series-every 0.13 --record-every 0.5"
KEPT = "--snapshot run.snapshot --snapshot-wall 0.0005"


def files(name):
    return f"--events {name}.csv --series {name}-series.csv --record {name}.xyz"


def main(program, kills, engine):
    start = f"run scene.toml {engine} {ON_THE_WAY}"
    whole = subprocess.run([program, *f"{start} {files('whole')}".split()],
                           check=True, capture_output=True)
    killed = 0
    while True:
        is_kept = os.path.exists("run.snapshot")
        begin = f"run --resume run.snapshot {ON_THE_WAY}" if is_kept else start
        run = subprocess.Popen([program, *f"{begin} {files('cut')} {KEPT}".split()],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        if killed < kills:
            try:
                # Whatever it is doing: setting up, running, keeping itself.
                run.wait(random.random() * 0.1)
            except subprocess.TimeoutExpired:
                run.kill()
                killed += 1
        output, errors = run.communicate()
        if run.returncode == 0:
            break
        assert run.returncode == -9, errors.decode()
    one, other = json.loads(whole.stdout), json.loads(output)
    for key in ["state_hash", "collisions", "energy", "momentum", "statistics"]:
        assert one[key] == other[key], f"{key}: {one[key]} {other[key]}"
    for ending in [".csv", "-series.csv", ".xyz"]:
        assert filecmp.cmp(f"whole{ending}", f"cut{ending}", shallow=False), ending
    left = [name for name in os.listdir() if name.endswith((".part", ".tmp"))]
    assert not left, left
    print(f"{engine}: killed {killed} times, the same files and state {one['state_hash']}")


if __name__ == "__main__":
    program = os.path.abspath(sys.argv[1])
    for engine in ["--engine event-driven", "--dt 0.002"]:
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            with open("scene.toml", "w") as file:
                # Long enough to be killed that often.
                file.write(SCENE.replace("DURATION", str(80.0 * int(sys.argv[2]))))
            main(program, int(sys.argv[2]), engine)
            os.chdir("/")
