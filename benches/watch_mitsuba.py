"""How soon Mitsuba 3 shows an edit of a camera: one sample per pixel of a large mesh.

    python watch_mitsuba.py large.ply texture.hdr
"""

import statistics
import subprocess
import sys
import time

WIDTH, HEIGHT = 960, 540
EDITS = 24


def camera(mi, n):
    look = mi.ScalarTransform4f().look_at(origin=[0, 2, 3 + 0.01 * n], target=[0, 0, 0], up=[0, 1, 0])
    film = {"type": "hdrfilm", "width": WIDTH, "height": HEIGHT, "rfilter": {"type": "box"}}
    sampler = {"type": "independent", "sample_count": 1}
    return {"type": "perspective", "fov": 40, "fov_axis": "y", "to_world": look, "film": film, "sampler": sampler}


def scene(mi, mesh, texture, n):
    at = mi.ScalarTransform4f()
    soil = {"type": "diffuse", "reflectance": {"type": "bitmap", "filename": texture}}
    floor = at.translate([0, -0.1, 0]).rotate([1, 0, 0], -90).scale(2)
    return {
        "type": "scene",
        "integrator": {"type": "path"},
        "sensor": camera(mi, n),
        "mesh": {"type": "ply", "filename": mesh, "bsdf": {"type": "diffuse"}},
        "sky": {"type": "constant", "radiance": 0.5},
        "lamp": {"type": "sphere", "center": [0, 5, 0], "emitter": {"type": "area", "radiance": 9}},
        "gold": {"type": "sphere", "center": [-0.5, 0.3, 0], "radius": 0.25, "bsdf": {"type": "roughconductor", "material": "Au"}},
        "glass": {"type": "sphere", "center": [0.5, 0.3, 0.5], "radius": 0.2, "bsdf": {"type": "dielectric"}},
        "floor": {"type": "rectangle", "to_world": floor, "bsdf": soil},
    }


def times(mi, show):
    """Median and largest milliseconds of many edits, the first left out."""
    import numpy

    ms = []
    for n in range(EDITS + 1):
        start = time.perf_counter()
        numpy.array(show(n))
        ms.append((time.perf_counter() - start) * 1e3)
    return statistics.median(ms[1:]), max(ms[1:])


def once(variant, mesh, texture):
    import mitsuba as mi

    mi.set_variant(variant)
    loaded = mi.load_dict(scene(mi, mesh, texture, 0))

    def sensor(n):
        return mi.render(loaded, sensor=mi.load_dict(camera(mi, n)), spp=1, seed=n)

    def anew(n):
        return mi.render(mi.load_dict(scene(mi, mesh, texture, n)), spp=1, seed=n)

    for name, show in (("another camera for the loaded scene", sensor), ("the scene loaded anew", anew)):
        median, most = times(mi, show)
        print(f"Mitsuba {mi.__version__} {variant}, {name}, 1 spp: median {median:.0f} ms, most {most:.0f}")


def main():
    if len(sys.argv) == 4:
        return once(sys.argv[3], sys.argv[1], sys.argv[2])
    for variant in ("scalar_rgb", "llvm_ad_rgb"):
        run = subprocess.run([sys.executable, __file__, *sys.argv[1:3], variant], capture_output=True, text=True)
        print(run.stdout or f"Mitsuba {variant}: {run.stderr.strip().splitlines()[-1]}", end="" if run.stdout else "\n")


if __name__ == "__main__":
    main()
