"""How long Mitsuba 3 takes to read a PLY and build its tree, and the peak memory, Python's included.

    python load_ply.py mesh.ply

prints JSON: variant -> [seconds, MiB].
"""

import json
import resource
import statistics
import subprocess
import sys
import time


def once(variant, path):
    import mitsuba as mi

    mi.set_variant(variant)
    mi.load_dict({"type": "scene", "shape": {"type": "sphere"}})
    start = time.perf_counter()
    scene = mi.load_dict({"type": "scene", "mesh": {"type": "ply", "filename": path}})
    ray = mi.Ray3f([0, 2, 3], [0, -0.5, -0.8])
    str(scene.ray_intersect(ray).t)
    seconds = time.perf_counter() - start
    print(seconds, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)


def main():
    if len(sys.argv) == 3:
        return once(sys.argv[2], sys.argv[1])
    found = {}
    for variant in ("scalar_rgb", "llvm_ad_rgb"):
        runs = [
            subprocess.run([sys.executable, __file__, sys.argv[1], variant], capture_output=True, text=True, check=True)
            for _ in range(3)
        ]
        times, peaks = zip(*(map(float, run.stdout.split()) for run in runs))
        found[variant] = statistics.median(times), max(peaks)
    print(json.dumps(found))


if __name__ == "__main__":
    main()
